"""Boxes of solid elements, clamped where it is said."""

from fem.petsc import MPI

import h5py  # noqa: F401  loads its HDF5 before DOLFINx loads its own
import numpy as np

from dolfinx import fem
from dolfinx.mesh import create_box, exterior_facet_indices, locate_entities_boundary

from fem.solid import Solid, _facet_nodes, make_solid
from geometry.blade import Material

TITANIUM = Material(young_modulus_GPa=113.8, poisson_ratio=0.342, density_kg_m3=4430)


def make_box(
    cells, size, material=TITANIUM, clamped="hub", hub=0.0, half_tip=np.inf, moved=None
) -> Solid:
    """Return a box from radius ``hub`` (m) outward along x, centred in y and z.

    ``clamped``: at the "hub" (x = hub), "all" around, or "nowhere". The tip is the outer end, as
    far as |z| does not exceed ``half_tip`` (m). ``moved`` takes the corners (n, 3) of the mesh
    elsewhere beforehand.
    """
    low = np.array([hub, -size[1] / 2, -size[2] / 2])
    mesh = create_box(MPI.COMM_SELF, [low, low + size], cells)
    if moved:
        mesh.geometry.x[:] = moved(mesh.geometry.x)
    V = fem.functionspace(mesh, ("Lagrange", 2, (3,)))
    if clamped == "hub":
        nodes = fem.locate_dofs_geometrical(V, lambda x: np.isclose(x[0], hub, rtol=1e-13))
    elif clamped == "all":
        mesh.topology.create_connectivity(2, 3)
        nodes = fem.locate_dofs_topological(V, 2, exterior_facet_indices(mesh.topology))
    else:
        nodes = np.empty(0, dtype=np.int32)
    end = mesh.geometry.x[:, 0].max()
    tip = locate_entities_boundary(
        mesh, 2, lambda x: np.isclose(x[0], end, rtol=1e-13) & (abs(x[2]) < half_tip + 1e-9)
    )
    return make_solid(mesh, material, V, nodes, _facet_nodes(V, tip))
