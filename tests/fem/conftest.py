import pytest
from boxes import make_box

from fem.solid import Solid, read_solid


@pytest.fixture(scope="session")
def box():
    """Make boxes with ``make_box``."""
    return make_box


@pytest.fixture(scope="session")
def solid(coarse_blade, coarse_mesh) -> Solid:
    """Return the coarse blade, clamped at its hub."""
    return read_solid(str(coarse_mesh.mesh), coarse_blade.material)
