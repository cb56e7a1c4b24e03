import dolfinx_solver  # noqa: F401  orders MPI ahead of the compiled bindings

from mpi4py import MPI

import h5py  # noqa: F401  loads its HDF5 before DOLFINx loads its own
import numpy as np
import pytest

from dolfinx import fem
from dolfinx.mesh import create_box, exterior_facet_indices

from fem.solid import Solid, make_solid
from geometry.blade import Material

TITANIUM = Material(young_modulus_GPa=113.8, poisson_ratio=0.342, density_kg_m3=4430)


def make_box(cells, size, material=TITANIUM, clamped="axis") -> Solid:
    """Return a box from the axis outward along x, centred in y and z.

    ``clamped``: on the "axis" (x = 0), "all" around, or "nowhere".
    """
    half = np.array([0, size[1] / 2, size[2] / 2])
    mesh = create_box(MPI.COMM_SELF, [-half, np.array(size) - half], cells)
    V = fem.functionspace(mesh, ("Lagrange", 2, (3,)))
    if clamped == "axis":
        nodes = fem.locate_dofs_geometrical(V, lambda x: np.isclose(x[0], 0))
    elif clamped == "all":
        mesh.topology.create_connectivity(2, 3)
        nodes = fem.locate_dofs_topological(V, 2, exterior_facet_indices(mesh.topology))
    else:
        nodes = np.empty(0, dtype=np.int32)
    return make_solid(mesh, material, V, nodes)


@pytest.fixture(scope="session")
def box():
    """Make boxes with ``make_box``."""
    return make_box
