"""Meshes of other programs, written from the coarse blade and built."""

import exports
import pytest
from exports import as_meshed
from refused import refused

from geometry.base import MeshError
from geometry.mesh import build_mesh


@pytest.fixture(scope="module")
def parts(coarse_mesh):
    return exports.parts(coarse_mesh.mesh)


@pytest.fixture
def build(coarse_blade, tmp_path):
    """Write a file, change its text, build the blade from it; its summary and groups."""

    def build(file, write=None, *what, change=None, **keys):
        if write:
            write(tmp_path / file, *what)
        if change:
            (tmp_path / file).write_text(change((tmp_path / file).read_text()))
        out = tmp_path / "out/blade.msh"
        blade = as_meshed(coarse_blade, file, **keys)
        return build_mesh(blade, out, tmp_path / file), exports.parts(out)

    return build


@pytest.fixture
def refusal(build, tmp_path):
    """Return the error, which has the name of the file; nothing was written."""

    def refusal(file, *what, **keys):
        error = refused(MeshError, build, file, *what, **keys)
        assert not list((tmp_path / "out").glob("*"))
        assert error.file == file
        return error

    return refusal
