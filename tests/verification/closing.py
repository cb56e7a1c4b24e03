"""Rows of what closes the gap to a cone, from the places of a tip's nodes; not the product's."""

from pathlib import Path

import numpy as np
from exports import groups
from meshio import read
from numpy.typing import NDArray
from scipy.spatial import KDTree

from fem.matrices import Matrices
from geometry.interface import tip_of

PARTS = 12  # along each side of a facet, in whose parts' middles it is integrated

type Facets = tuple[NDArray[np.float64], NDArray[np.int64]]  # points of a mesh; nodes of each


def tip_facets(mesh: Path) -> Facets:
    """Points of a mesh, and the six nodes of each facet of its tip."""
    return read(mesh).points, groups(read(mesh))["tip"]


def closing(
    of: Facets, fom: Matrices, T: NDArray[np.float64], xi: NDArray[np.float64], edges: bool = False
) -> NDArray[np.float64]:
    """P (k, n): what closes the gap to the cone at chord fractions ``xi`` (k,), by the basis ``T``.

    u_r - (dr/dz) u_z is projected on the hats as it is on the facets, by sums over small parts of
    these; dr/dz is that of the camber line at the same z. With ``edges`` (2, k, n), of the edges
    behind and ahead: the hats times a share that goes from edge to edge at the same z.
    """
    points, facets = of
    i, j = np.indices((PARTS, PARTS))
    up, down = i + j < PARTS, i + j < PARTS - 1
    x, y = (np.concatenate([(k[up] + 1 / 3) / PARTS, (k[down] + 2 / 3) / PARTS]) for k in (i, j))
    v, e = shape(x, y), 1e-3
    nodes = points[facets]
    along = [(shape(*plus) - shape(*minus)) / (2 * e) for plus, minus in (
        ((x + e, y), (x - e, y)), ((x, y + e), (x, y - e)),
    )]  # fmt: skip
    places = (v @ nodes).reshape(-1, 3)
    areas = np.linalg.norm(np.cross(*(of @ nodes for of in along)), axis=2).ravel()
    r, z = np.hypot(places[:, 0], places[:, 1]), places[:, 2]
    line, n = fom.camber, len(fom.xi)
    slope = np.interp(z, line[:, 2], np.gradient(line[:, 0], line[:, 2]))
    normal = np.column_stack([places[:, 0] / r, places[:, 1] / r, -slope])
    tip = tip_of(facets, points)
    if edges:
        behind, ahead = sides(tip.outline, z)
        eta = (np.arctan2(places[:, 1], places[:, 0]) - behind) / (ahead - behind)
        of_line = tents(np.interp(z, line[:, 2], np.linspace(0, 1, len(line))), n)
        phi = np.hstack([of_line * share[:, None] for share in (1 - eta, eta)])
    else:
        phi = tents(tip.xi(places), n)
    weighted = areas[:, None] * phi
    _, at = KDTree(fom.coordinates).query(nodes)
    u = T.reshape(-1, 3, T.shape[1])[at]  # facets, nodes, xyz, DoFs
    moved = np.einsum("qn,fncd->fqcd", v, u).reshape(len(places), 3, -1)
    B = weighted.T @ np.einsum("pc,pcd->pd", normal, moved)
    coefficients = np.linalg.solve(phi.T @ weighted, B).reshape(phi.shape[1] // n, n, -1)
    P = tents(xi, n) @ coefficients
    return P if edges else P[0]


def sides(outline: NDArray[np.float64], z: NDArray[np.float64]) -> NDArray[np.float64]:
    """Least and largest angle (2, k), rad, of the closed ``outline`` (r, theta, z) at ``z``."""
    a, b = outline[:, 1:], np.roll(outline, -1, axis=0)[:, 1:]
    share = (z[:, None] - a[:, 1]) / (b[:, 1] - a[:, 1])
    crossed = (share >= 0) & (share <= 1)
    theta = a[:, 0] + share * (b[:, 0] - a[:, 0])
    least = np.where(crossed, theta, np.inf).min(axis=1)
    return np.stack([least, np.where(crossed, theta, -np.inf).max(axis=1)])


def shape(x: NDArray[np.float64], y: NDArray[np.float64]) -> NDArray[np.float64]:
    """Shape functions (places, 6) of a quadratic triangle: corners, middles of 01, 12, 20."""
    a, b, c = 1 - x - y, x, y
    corners = [one * (2 * one - 1) for one in (a, b, c)]
    return np.column_stack([*corners, 4 * a * b, 4 * b * c, 4 * c * a])


def tents(xi: NDArray[np.float64], n: int) -> NDArray[np.float64]:
    """Hat functions (places, n) of equally spaced nodes from 0 to 1."""
    return np.maximum(0, 1 - abs((n - 1) * np.clip(xi, 0, 1)[:, None] - np.arange(n)))
