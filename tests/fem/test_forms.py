"""Forms that are compiled once: what a killed compile left, and a folder without room."""

import boxes  # noqa: F401  loads HDF5 ahead of DOLFINx
import pytest
from mpi4py import MPI
from refused import refused

import ufl
from dolfinx.mesh import create_unit_cube

from fem import forms
from geometry.base import WriteError


@pytest.fixture
def volume(tmp_path, monkeypatch):
    """The form of a volume, to be compiled in an empty folder."""
    monkeypatch.setattr(forms, "FOLDER", tmp_path / "tiprub/forms")
    return 1.0 * ufl.dx(create_unit_cube(MPI.COMM_SELF, 1, 1, 1))


@pytest.mark.parametrize("left", [(".c",), (".c", ".o"), (".c.failed", ".o"), (".o",)])
def test_what_a_killed_compile_left_is_removed(volume, left):
    """FFCx itself waits for the end of the one that made the source."""
    forms.compiled(volume)
    whole = {path.name for path in forms.FOLDER.iterdir()}
    (ended,) = forms.FOLDER.glob("*.c.cached")
    name = ended.name.removesuffix(".c.cached")
    for path in forms.FOLDER.iterdir():
        path.unlink()
    for suffix in left:
        (forms.FOLDER / f"{name}{suffix}").write_text("half of ")
    forms.compiled(volume)
    assert {path.name for path in forms.FOLDER.iterdir()} == whole


def test_forms_that_ended_stay(volume):
    forms.compiled(volume)
    before = {path.name: path.stat().st_mtime_ns for path in forms.FOLDER.iterdir()}
    forms.compiled(volume)
    forms.compiled(2 * volume)
    after = {path.name: path.stat().st_mtime_ns for path in forms.FOLDER.iterdir()}
    assert before.items() < after.items() and len(after) == 2 * len(before)


def without_a_compiler(monkeypatch):
    monkeypatch.setenv("CC", "false")


def without_a_folder(monkeypatch):
    forms.FOLDER.parent.write_text("a file")


@pytest.mark.parametrize("without", [without_a_compiler, without_a_folder])
def test_a_compile_that_fails_is_one_line(volume, monkeypatch, without):
    without(monkeypatch)
    error = refused(WriteError, forms.compiled, volume)
    assert error.file == str(forms.FOLDER) and "XDG_CACHE_HOME" in error.text
    monkeypatch.undo()
