"""The coarse reference blade, meshed, assembled and reduced once for all tests that want it."""

from pathlib import Path
from typing import NamedTuple

import pytest

from geometry.blade import Blade
from geometry.settings import read_settings

ROOT = Path(__file__).parents[1]


class BladeFiles(NamedTuple):
    """What the stages wrote."""

    mesh: Path
    interface: Path
    matrices: Path  # at the three speeds of the basis


@pytest.fixture(scope="session")
def coarse_blade() -> Blade:
    """Return the reference blade on 800 cells: seconds, and f1 within 0.5 % of a fine mesh.

    On 500 cells (12 mm) the seventh mode already asks for more than eta = 9.
    """
    blade = read_settings(Blade, ROOT / "workflow/blades/reference.yaml")
    mesh = blade.mesh.model_copy(update={"element_size_mm": 10.0})
    return blade.model_copy(update={"mesh": mesh})


@pytest.fixture(scope="session")
def coarse_files(coarse_blade, tmp_path_factory) -> BladeFiles:
    """Mesh and assemble the coarse blade."""
    from fem.assemble import assemble
    from geometry.mesh import build_mesh
    from rom.speeds import basis_speeds

    folder = tmp_path_factory.mktemp("coarse-blade")
    files = BladeFiles(folder / "blade.msh", folder / "interface.csv", folder / "matrices.h5")
    build_mesh(coarse_blade, files.mesh, files.interface)
    speeds = basis_speeds(coarse_blade.max_speed_rad_s)
    assemble(coarse_blade, files.mesh, files.interface, speeds).save(files.matrices)
    return files


@pytest.fixture(scope="session")
def coarse_matrices(coarse_files):
    """Load the full model at the three speeds of the basis."""
    from fem.matrices import Matrices

    return Matrices.load(coarse_files.matrices)


@pytest.fixture(scope="session")
def coarse_reduced(coarse_blade, coarse_matrices):
    """Reduce the coarse blade as its settings ask: the model and its basis T."""
    from rom.reduce import reduce

    basis = coarse_blade.basis
    return reduce(
        coarse_matrices, basis.fixed_interface_modes, basis.rank_tolerance, coarse_blade.span
    )


@pytest.fixture(scope="session")
def coarse_rom(coarse_reduced):
    """Return the reduced model alone."""
    return coarse_reduced[0]
