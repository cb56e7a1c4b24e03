"""Meshes of other programs, written from the coarse blade and built."""

import exports
import pytest
from exports import as_meshed

from geometry.errors import MeshError
from geometry.mesh import build_mesh


@pytest.fixture(scope="module")
def parts(coarse_mesh):
    return exports.parts(coarse_mesh.mesh)


@pytest.fixture
def build(coarse_blade, tmp_path):
    """Write a file, build the blade from it; its summary and groups."""

    def build(file, write=None, *what, **keys):
        if write:
            write(tmp_path / file, *what)
        out = tmp_path / "out/blade.msh"
        blade = as_meshed(coarse_blade, file, **keys)
        return build_mesh(blade, out, tmp_path / file), exports.parts(out)

    return build


@pytest.fixture
def refusal(build, tmp_path):
    """Return the message, after the name of the file; nothing was written."""

    def refusal(file, *what, **keys):
        with pytest.raises(MeshError) as caught:
            build(file, *what, **keys)
        assert not list((tmp_path / "out").glob("*"))
        assert "\n" not in str(caught.value)
        assert str(caught.value).startswith(f"{file}: ")
        return str(caught.value).removeprefix(f"{file}: ")

    return refusal
