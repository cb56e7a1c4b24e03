"""The coarse reference blade, meshed, assembled and reduced once for all tests that want it."""

from pathlib import Path
from typing import Any, NamedTuple

import pytest

from geometry.blade import Blade
from geometry.settings import read_settings

ROOT = Path(__file__).parents[1]


class MeshFiles(NamedTuple):
    """What the geometry wrote and measured."""

    mesh: Path
    interface: Path
    summary: Any  # geometry.mesh.MeshSummary, whose module needs gmsh


class BladeFiles(NamedTuple):
    """What geometry and finite elements wrote."""

    mesh: Path
    interface: Path
    matrices: Path  # at the speeds of the basis


@pytest.fixture(scope="session")
def coarse_blade() -> Blade:
    """Return the reference blade on 800 cells: seconds, and f1 within 0.5 % of a fine mesh.

    On 500 cells (12 mm) the seventh mode already asks for more than eta = 9.
    """
    blade = read_settings(Blade, ROOT / "workflow/blades/reference.yaml")
    mesh = blade.mesh.model_copy(update={"element_size_mm": 10.0})
    return blade.model_copy(update={"mesh": mesh})


@pytest.fixture(scope="session")
def coarse_mesh(coarse_blade, tmp_path_factory) -> MeshFiles:
    """Mesh the coarse blade."""
    from geometry.mesh import build_mesh

    folder = tmp_path_factory.mktemp("coarse-blade")
    mesh, interface = folder / "blade.msh", folder / "interface.csv"
    return MeshFiles(mesh, interface, build_mesh(coarse_blade, mesh, interface))


@pytest.fixture(scope="session")
def coarse_files(coarse_blade, coarse_mesh) -> BladeFiles:
    """Assemble the coarse blade."""
    from fem.assemble import assemble
    from rom.speeds import basis_speeds

    mesh, interface, _ = coarse_mesh
    matrices = mesh.with_name("matrices.h5")
    speeds = basis_speeds(coarse_blade.basis, coarse_blade.max_speed_rad_s)
    assemble(coarse_blade, mesh, interface, speeds).save(matrices)
    return BladeFiles(mesh, interface, matrices)


@pytest.fixture(scope="session")
def coarse_matrices(coarse_files):
    """Load the full model at the four speeds of the basis."""
    from fem.matrices import Matrices

    return Matrices.load(coarse_files.matrices)


@pytest.fixture(scope="session")
def coarse_reduced(coarse_blade, coarse_matrices):
    """Reduce the coarse blade as its settings ask: the model and its basis T."""
    from rom.reduce import reduce

    return reduce(coarse_matrices, coarse_blade.basis)


@pytest.fixture(scope="session")
def coarse_rom(coarse_reduced):
    """Return the reduced model alone."""
    return coarse_reduced[0]


@pytest.fixture(scope="session")
def paper_matrices(coarse_matrices):
    """Return the full model at the three speeds of the paper's basis."""
    return coarse_matrices.at([0, 325, 650])


@pytest.fixture(scope="session")
def paper_reduced(paper_matrices):
    """Reduce the coarse blade to the paper's basis: the model and its basis T."""
    from geometry.blade import PaperBasis
    from rom.reduce import reduce

    return reduce(paper_matrices, PaperBasis(kind="paper"))
