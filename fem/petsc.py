"""MPI, PETSc and SLEPc of the installed DOLFINx, to be imported ahead of DOLFINx.

DOLFINx may be the wheel of requirements.lock, or of Debian, Ubuntu or conda-forge
(fem/dolfinx.md). ./run tries a Python by this file alone: it imports no other of the project.

Raises
------
ImportError
    When there is no DOLFINx of this version with real PETSc and SLEPc.
"""

from contextlib import suppress
from importlib.metadata import PackageNotFoundError, version

with suppress(ModuleNotFoundError):
    import dolfinx_solver  # noqa: F401  the wheel's: orders MPI ahead of the compiled bindings

NEEDED = "0.11"  # of DOLFINx
SOURCES = (
    f"DOLFINx {NEEDED} with real PETSc and SLEPc comes with ./run, or from Debian, Ubuntu or "
    "conda-forge as fem/dolfinx.md says"
)

try:
    from mpi4py import MPI
    from petsc4py import PETSc
    from slepc4py import SLEPc

    # Basix has the version of its DOLFINx, whose own name differs between the sources.
    installed = version("fenics-basix")
except (ModuleNotFoundError, PackageNotFoundError) as error:
    raise ImportError(f"{error.name} is not installed: {SOURCES}") from None
if installed.split(".")[:2] != NEEDED.split("."):
    raise ImportError(f"DOLFINx {installed} is installed: {SOURCES}")
if PETSc.ScalarType.__name__ != "float64":
    raise ImportError(f"PETSc is installed with {PETSc.ScalarType.__name__}: {SOURCES}")

__all__ = ["MPI", "PETSc", "SLEPc"]
