"""Ten-node tetrahedra of a CAD solid by gmsh, as good as its faces allow, and its volume.

Round edges smaller than an element are the difficulty. Cells there may turn inside out when their
middle nodes are placed on the faces: these are moved along the faces, or off them. The volume
that the mesh then misses is known, from an integral over the faces of the CAD themselves.
OpenCASCADE's own volume is 0.1 to 3 % off where they are lofted through splines.
"""

import gmsh
import numpy as np
from numpy.typing import NDArray

from geometry.facets import shape_functions, shape_gradients
from geometry.shape import CELL, FACET, faces_of, jacobian_ratios
from geometry.tetrahedra import EDGES, GMSH

FINER = (1, 2)  # times finer where faces are curved, tried in turn until the volume is right
ROUND = 6  # elements in a full circle there
VOLUME_TOLERANCE = 8e-4  # of the mesh against the CAD; the integral over coarse facets errs by 3e-5
RULE = "Gauss20"  # of the integral over the CAD's face within a facet
STEPS = 12  # that halve the bend of the edges of cells inside out
CLOSED, OPEN = 1e-6, 1e12  # m, between the ends of a closed face; half the period of others


def generate(solid: int, size: float) -> float:
    """Mesh a solid by ``size`` (m), finer where curved if needed; return its CAD volume, m3."""
    for finer in FINER:
        _mesh(size, finer)
        cad = volume() + sum(_missed(solid, face) for face in faces_of(solid))
        _turn_right()
        if abs(volume() / cad - 1) <= VOLUME_TOLERANCE:
            break
    return cad


def volume() -> float:
    """Volume of the mesh, m3, by a quadrature of degree 4; cells inside out count negative."""
    points, weights = gmsh.model.mesh.getIntegrationPoints(CELL, "Gauss4")
    _, determinants, _ = gmsh.model.mesh.getJacobians(CELL, points)
    return float((np.reshape(determinants, (-1, len(weights))) @ weights).sum())


def _mesh(size: float, finer: int) -> None:
    """Second-order tetrahedra by HXT; cells on curved faces are curved."""
    for option, value in {
        "Mesh.MeshSizeMin": size / finer,
        "Mesh.MeshSizeMax": size,
        "Mesh.MeshSizeFromCurvature": ROUND if finer > 1 else 0,
        "Mesh.Algorithm3D": 10,
        "Mesh.ElementOrder": 2,
        "Mesh.HighOrderOptimize": 0,
        "Mesh.RandomSeed": 1,
        "General.NumThreads": 1,
        "General.AbortOnError": 0,  # else it ends the process where it cannot turn cells right
    }.items():
        gmsh.option.setNumber(option, value)
    gmsh.model.mesh.clear()
    gmsh.model.mesh.generate(3)


def _turn_right() -> None:
    """Turn cells right that are inside out: first along the faces, then by edges less bent."""
    if not len(_wrong()):
        return
    gmsh.model.mesh.optimize("HighOrder")  # of all cells or, where it cannot, none
    for _ in range(STEPS):
        for middle, ends in _middles(_wrong()).items():
            place, *others = (gmsh.model.mesh.getNode(node)[0] for node in (middle, *ends))
            gmsh.model.mesh.setNode(middle, (place + sum(others) / 2) / 2, [])


def _wrong() -> NDArray[np.uint64]:
    """Tags of the cells that are inside out somewhere."""
    return gmsh.model.mesh.getElementsByType(CELL)[0][~(jacobian_ratios() > 0)]


def _middles(cells: NDArray[np.uint64]) -> dict[int, tuple[int, int]]:
    """Middle nodes of the edges of ``cells``, with the ends of the edges."""
    nodes = [gmsh.model.mesh.getElement(cell)[1] for cell in cells]
    middles = [(GMSH[4 + edge], *ends) for edge, ends in enumerate(EDGES)]
    return {ten[middle]: (ten[a], ten[b]) for ten in nodes for middle, a, b in middles}


def _missed(solid: int, face: int) -> float:
    """Volume, m3, between the facets on a face and the face itself; positive outside of them.

    A facet maps to the plane of the face's parameters as it does to space. One at a pole, where
    these are not defined, counts as exact.
    """
    tags, places, parameters = gmsh.model.mesh.getNodes(2, face, True, True)
    row = np.zeros(int(tags.max()) + 1, dtype=int)
    row[tags] = np.arange(len(tags))
    facets = np.reshape(gmsh.model.mesh.getElementsByType(FACET, face)[1], (-1, 6))
    x, uv = np.reshape(places, (-1, 3))[row[facets]], np.reshape(parameters, (-1, 2))[row[facets]]
    low, period = _periods(face)
    uv = uv - period * np.round((uv - uv[:, :1]) / period)  # across a seam, where they jump
    points, weights = gmsh.model.mesh.getIntegrationPoints(FACET, RULE)
    xi = np.reshape(points, (-1, 3))[:, :2]
    (flat, sides), (uv_points, slopes) = _mapped(xi, x), _mapped(xi, uv)
    uv_points = (uv_points - period * np.floor((uv_points - low) / period)).ravel()
    on_face = np.reshape(gmsh.model.getValue(2, face, uv_points), flat.shape)
    by_u, by_v = np.moveaxis(
        np.reshape(gmsh.model.getDerivative(2, face, uv_points), (*flat.shape[:2], 2, 3)), 2, 0
    )
    normal = np.cross(by_u, by_v) * np.linalg.det(slopes)[..., None]
    facet_normal = np.cross(sides[..., 0], sides[..., 1])
    missed = (_flux(on_face, normal) - _flux(flat, facet_normal)) @ weights
    off, size = np.linalg.norm(on_face - flat, axis=2), np.linalg.norm(np.ptp(x, axis=1), axis=1)
    return _sign(solid, facets[0, :3]) * float(missed[off.max(axis=1) < size].sum())


def _periods(face: int) -> tuple[NDArray, NDArray]:
    """Least parameters (2,) of a face, and their periods: huge where it is not closed."""
    low, high = map(np.array, gmsh.model.getParametrizationBounds(2, face))
    middle, period = (low + high) / 2, high - low
    for d in range(2):
        ends = np.array([middle, middle])
        ends[:, d] = low[d], high[d]
        a, b = np.reshape(gmsh.model.getValue(2, face, ends.ravel()), (2, 3))
        if np.linalg.norm(a - b) > CLOSED:
            low[d], period[d] = -OPEN, 2 * OPEN
    return low, period


def _flux(x: NDArray, normal: NDArray) -> NDArray:
    """Of (0, y, z) / 2, whose divergence is one.

    Root and tip, across the radius, add next to nothing to it: the area that facets miss,
    along their outline, is not in the integral over the face.
    """
    return (x[..., 1:] * normal[..., 1:]).sum(axis=-1) / 2


def _mapped(xi: NDArray, nodes: NDArray) -> tuple[NDArray, NDArray]:
    """Places (k, q, d) of ``xi`` (q, 2) on facets with ``nodes`` (k, 6, d), and derivatives."""
    places = np.einsum("qn,knd->kqd", shape_functions(xi), nodes)
    return places, np.einsum("qne,knd->kqde", shape_gradients(xi), nodes)


def _sign(solid: int, corners: NDArray) -> int:
    """1 where a facet's ``corners`` are anticlockwise seen from outside the solid, else -1."""
    cells = np.reshape(gmsh.model.mesh.getElementsByType(CELL, solid)[1], (-1, 10))[:, :4]
    (cell,) = cells[np.isin(cells, corners).sum(axis=1) == 3]
    (opposite,) = np.setdiff1d(cell, corners)
    a, b, c, inner = (gmsh.model.mesh.getNode(node)[0] for node in (*corners, opposite))
    return 1 if np.cross(b - a, c - a) @ (inner - a) < 0 else -1
