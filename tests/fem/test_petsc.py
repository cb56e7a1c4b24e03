"""What is said where DOLFINx is missing, of another version or complex."""

import importlib.metadata
import runpy
import sys
from pathlib import Path

from fem.petsc import PETSc

import numpy as np
import pytest

ROOT = Path(__file__).parents[2]
FILE = ROOT / "fem" / "petsc.py"


def take_petsc(patch):
    patch.setitem(sys.modules, "petsc4py", None)


def take_dolfinx(patch):
    patch.setattr(sys, "path", [])  # no metadata of any package


def make_old(patch):
    patch.setattr(importlib.metadata, "version", lambda _: "0.10.1")


def make_complex(patch):
    patch.setattr(PETSc, "ScalarType", np.complex128)


@pytest.mark.parametrize(
    ("change", "found"),
    [
        (take_petsc, "petsc4py is not installed: "),
        (take_dolfinx, "fenics-basix is not installed: "),
        (make_old, "DOLFINx 0.10.1 is installed: "),
        (make_complex, "PETSc is installed with complex128: "),
    ],
)
def test_another_dolfinx_is_refused_with_where_it_may_come_from(monkeypatch, change, found):
    change(monkeypatch)
    with pytest.raises(ImportError) as refusal:
        runpy.run_path(str(FILE))
    (line,) = str(refusal.value).splitlines()
    assert line.startswith(found)
    assert line.endswith("or from Debian, Ubuntu or conda-forge as fem/dolfinx.md says")


def test_the_wheel_need_not_be_there(monkeypatch):
    monkeypatch.setitem(sys.modules, "dolfinx_solver", None)
    assert runpy.run_path(str(FILE))["PETSc"] is PETSc


def test_wheel_and_conda_environment_are_of_the_version_needed():
    needed = runpy.run_path(str(FILE))["NEEDED"]
    assert f'"dolfinx-solver-real>={needed},' in (ROOT / "pyproject.toml").read_text()
    assert f"- fenics-dolfinx={needed}\n" in (ROOT / "environment.yml").read_text()
