"""Interface operator S: from displacements of the mesh to those of the tip's patches or points.

With the hat functions phi_i of ``geometry.hats`` over the chord fraction xi, the shape functions v
of the tip's facets and the local e = e_r, e_theta or e_z,

    B_i = int phi_i e.v dA,    G_ij = int phi_i phi_j dA,    S = G^-1 B,    c = S u

With two rows across the thickness the functions are phi_i(xi) {1 - eta, eta}, eta from the edge
behind to the edge ahead at equal z, and xi the chord fraction of the camber line at that z. First
come those of the edge behind.

c are the coefficients of the L2 projection of the tip's displacement on the hat functions: S is
exact for constants and fields linear along the chord. Its transpose gives the nodal loads of forces
on the coefficients, the dual traction, with equal virtual work. For a point, S has the shape
functions at its place instead.
"""

from fem.petsc import MPI  # noqa: F401  ahead of DOLFINx

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_matrix, csr_matrix, hstack, vstack
from scipy.spatial.transform import Rotation

import basix

from fem.matrices import InterfaceOperator
from fem.solid import Solid
from geometry.base import require
from geometry.blade import Blade
from geometry.facets import shape_functions, shape_gradients
from geometry.hats import hat_nodes, hats
from geometry.interface import on_facets, places_of, require_patches, tip_of

DEGREE = 24  # of the quadrature: hat functions have kinks within facets
BEYOND = 1e-3  # of the chord, by which a facet may bulge beyond the outline's extremes


def interface_of(solid: Solid, blade: Blade) -> InterfaceOperator:
    """Interface of the blade on the facets ``solid.tip``.

    Raises
    ------
    MeshError
        When the facets do not allow it.
    """
    points, facets = solid.V.tabulate_dof_coordinates(), solid.tip
    if blade.of_points:
        tip = tip_of(facets, points)
        nodes, values, there = on_facets(points, facets, tip, places_of(blade.interface, tip))
        x, y, z = there.T
        rtz = np.column_stack([np.hypot(x, y), np.arctan2(y, x), z])
        S = at_places(_spread(values, nodes, len(points)), there, solid.free)
        line = tip.camber_line()
        return InterfaceOperator(S, tip.xi(there), rtz, line, tip.at_z(line[:, 2]))
    xi = hat_nodes(blade.interface.patches)
    S, camber, sides = on_patches(points, facets, solid.free, len(xi), blade.interface.across)
    return InterfaceOperator(S, xi, np.empty((0, 3)), camber, sides)


def on_patches(
    points: NDArray[np.float64], facets: NDArray, free: NDArray, patches: int, across: int
) -> tuple[csr_matrix, NDArray[np.float64], NDArray[np.float64]]:
    """S (3 across patches, n_full) on the tip's ``facets`` (k, 6) between ``points`` (n, 3), m.

    ``free``: numbers of the free DoFs among all, three for each point. Then the camber line
    (places, 3), r, theta, z at equally spaced xi from 0 to 1, and the angles of both sides at its z
    (2, places), rad.

    Raises
    ------
    MeshError
        When the facets do not allow so many.
    """
    tip, xi = tip_of(facets, points), hat_nodes(patches)
    require_patches(len(xi), tip.xi(points[np.unique(facets)]))
    at, dA, values = quadrature(points[facets])
    at_xi = tip.xi(at.reshape(-1, 3))
    beyond = max(-at_xi.min(), at_xi.max() - 1)
    require(
        (
            beyond <= BEYOND,
            f"a facet of the tip bulges {100 * beyond:.2g} % of the chord beyond its outline; "
            f"allowed {100 * BEYOND:g} %: refine the mesh of the tip",
        )
    )
    phi, e, line = hats(at_xi, xi), directions(at.reshape(-1, 3)), tip.camber_line()
    if across == 2:
        there, eta = tip.across(at.reshape(-1, 3))
        phi = np.hstack([hats(there, xi) * part[:, None] for part in (1 - eta, eta)])
    G = phi.T @ (phi * dA.reshape(-1, 1))
    v = _spread(
        np.tile(values, (len(facets), 1)), np.repeat(facets, len(values), axis=0), len(points)
    )
    weighted = np.linalg.solve(G, (phi * dA.reshape(-1, 1)).T)
    rows = [csr_matrix((weighted * e[:, d, c]) @ v) for d in range(3) for c in range(3)]
    return _assembled(rows, free), line, tip.at_z(line[:, 2])


def at_places(weights: csr_matrix, places: NDArray[np.float64], free: NDArray) -> csr_matrix:
    """S (3 places, n_full) at ``places`` (places, 3), m, in radial, tangential, axial direction.

    ``weights`` (places, nodes): of the displacements of the mesh's nodes; ``free``: as of
    ``on_patches``.
    """
    e = directions(places)
    rows = [weights.multiply(e[:, d, c][:, None]) for d in range(3) for c in range(3)]
    return _assembled(rows, free)


def quadrature(nodes: NDArray) -> tuple[NDArray, NDArray, NDArray]:
    """Places (facets, points, 3), m, areas (facets, points), m2, and shape functions (points, 6).

    ``nodes`` (facets, 6, 3), m, are the nodes of the facets.
    """
    x, weights = map(np.asarray, basix.make_quadrature(basix.CellType.triangle, DEGREE))
    values = shape_functions(x)
    places = np.einsum("qn,knd->kqd", values, nodes)
    tangents = np.einsum("qne,knd->ekqd", shape_gradients(x), nodes)
    return places, np.linalg.norm(np.cross(*tangents), axis=2) * weights, values


def directions(points: NDArray[np.float64]) -> NDArray[np.float64]:
    """e_r, e_theta, e_z (n, 3, 3) at ``points`` (n, 3)."""
    theta = np.arctan2(points[:, [1]], points[:, [0]])
    return Rotation.from_euler("z", -theta).as_matrix()


def _spread(values: NDArray, nodes: NDArray, n: int) -> csr_matrix:
    """Rows (places, n) of shape functions ``values`` (places, 6) at their ``nodes``."""
    row = np.repeat(np.arange(len(values)), values.shape[1])
    return coo_matrix((values.ravel(), (row, nodes.ravel())), shape=(len(values), n)).tocsr()


def _assembled(rows: list[csr_matrix], free: NDArray) -> csr_matrix:
    """S (3 n, n_full) from its nine blocks (n, nodes): direction by direction, x, y, z in each."""
    n, nodes = rows[0].shape
    by_direction = vstack([hstack(rows[i : i + 3]) for i in (0, 3, 6)], format="csr")
    row, column = (np.arange(3 * size).reshape(3, size).T.ravel() for size in (n, nodes))
    S = by_direction[row][:, column[free]]
    S.eliminate_zeros()
    S.sort_indices()
    return S
