"""Interface nodes on the tip of a solid in gmsh: where they belong, and how they become nodes."""

from collections.abc import Sequence

import gmsh
import numpy as np
from numpy.typing import NDArray

from geometry.blade import Blade
from geometry.errors import MeshError
from geometry.interface import InterfaceNodes
from geometry.profile import interface_points
from geometry.shape import Shape, curves_of, faces_of, outline, sampled
from geometry.tip import camber_points, pressure_points

ON_TIP = 1e-8  # m, how far an interface node may lie off its place
ON_EDGE = 1e-6  # m, a place this close to the outline of the tip is on it
LISTED = 1e-4  # m, how far a listed point may lie off the tip
OFF = np.inf


def interface_places(blade: Blade, shape: Shape) -> NDArray[np.float64]:
    """Places (nodes, 3), m, on the tip, leading edge first, by the blade's rule.

    Raises
    ------
    MeshError
        When the tip folds over its chord, or a listed point is off the tip.
    """
    rule = blade.interface
    if rule.points_mm:
        return _listed(np.array(rule.points_mm) * 1e-3, shape.tip)
    if rule.along == "camber-line" and blade.sections:
        return interface_points(blade.sections, rule.nodes)  # in closed form
    if rule.along == "camber-line":
        points = camber_points(outline(shape.tip), rule.nodes)
        return np.array([_on_faces(point, shape.tip) for point in points])
    points = pressure_points(outline(shape.tip), rule.nodes)
    return np.array([_on_outline(point, shape.tip) for point in points])


def embed(places: NDArray, shape: Shape) -> Shape:
    """Make the places mesh nodes: curves are split there, faces get points; the shape that results.

    gmsh embeds points in faces but not in curves.
    """
    edge = [_off(place, _on_outline(place, shape.tip)) <= ON_EDGE for place in places]
    if any(edge):
        shape = _split(shape, places[edge])
    for face, inside in _by_face(places[np.logical_not(edge)], shape.tip).items():
        tags = [gmsh.model.occ.addPoint(*place) for place in inside]
        gmsh.model.occ.synchronize()
        gmsh.model.mesh.embed(0, tags, 2, face)
    return shape


def on_mesh(places: NDArray, shape: Shape) -> InterfaceNodes:
    """Mesh nodes at the places, leading edge first.

    Raises
    ------
    MeshError
        When the mesh has no node there.
    """
    nodes = nodes_of(shape.tip)
    gap = np.linalg.norm(nodes[None] - places[:, None], axis=2)
    if gap.min(axis=1).max() > ON_TIP:
        raise MeshError(
            f"an interface node lies {gap.min(axis=1).max():.1e} m off its place on the tip"
        )
    return InterfaceNodes(points=nodes[gap.argmin(axis=1)])


def nodes_of(faces: Sequence[int]) -> NDArray[np.float64]:
    """Mesh nodes (n, 3), m, of second-order triangles on ``faces``."""
    kind = gmsh.model.mesh.getElementType("triangle", 2)
    found = np.concatenate([gmsh.model.mesh.getElementsByType(kind, face)[1] for face in faces])
    return np.array([gmsh.model.mesh.getNode(node)[0] for node in np.unique(found)])


def _listed(points: NDArray, tip: Sequence[int]) -> NDArray:
    """Listed points, moved onto the tip."""
    on_tip = np.array([_nearest(point, tip) for point in points])
    off = np.linalg.norm(on_tip - points, axis=1)
    if off.max() > LISTED:
        raise MeshError(
            f"interface.points_mm: point {off.argmax() + 1} lies {1e3 * off.max():.3g} mm off the "
            f"tip; allowed {1e3 * LISTED:g} mm"
        )
    return on_tip


def _nearest(point: NDArray, tip: Sequence[int]) -> NDArray:
    """The tip's nearest point: on its outline where that is as near, else inside."""
    edge, inside = _on_outline(point, tip), _on_faces(point, tip)
    return edge if _off(point, edge) <= _off(point, inside) + ON_EDGE else inside


def _on_faces(point: NDArray, faces: Sequence[int]) -> NDArray:
    """Nearest point within ``faces``; infinitely far when ``point`` is beside all of them."""
    found = [np.full(3, OFF)]
    for face in faces:
        place, _ = gmsh.model.getClosestPoint(2, face, point)
        if gmsh.model.isInside(2, face, place):
            found.append(place)
    return min(found, key=lambda place: _off(point, place))


def _on_outline(point: NDArray, faces: Sequence[int]) -> NDArray:
    """Nearest point on the curves about ``faces``."""
    found = []
    for curve in curves_of(faces):
        samples = sampled(curve)
        first = samples[np.linalg.norm(samples - point, axis=1).argmin()]
        place, _ = gmsh.model.getClosestPoint(1, curve, point)
        inside = gmsh.model.isInside(1, curve, place)
        found += [first, place] if inside else [first]
    return min(found, key=lambda place: _off(point, place))


def _off(point: NDArray, place: NDArray) -> float:
    return float(np.linalg.norm(np.subtract(place, point)))


def _by_face(places: NDArray, faces: Sequence[int]) -> dict[int, list[NDArray]]:
    """Places by the face that holds them."""
    held: dict[int, list[NDArray]] = {}
    for place in places:
        face = min(faces, key=lambda face: _off(place, _on_faces(place, [face])))
        held.setdefault(face, []).append(place)
    return held


def _split(shape: Shape, places: NDArray) -> Shape:
    """Split the curves of the tip at ``places``; faces there get new tags, and are found again."""
    occ = gmsh.model.occ
    root, tip = ([_centre(face) for face in faces] for faces in (shape.root, shape.tip))
    points = [(0, occ.addPoint(*place)) for place in places]
    parts, _ = occ.fragment([(3, shape.solid)], points)
    occ.synchronize()
    (solid,) = (tag for dimension, tag in parts if dimension == 3)
    faces = {face: _centre(face) for face in faces_of(solid)}

    def again(centres: list[NDArray]) -> tuple[int, ...]:
        return tuple(min(faces, key=lambda face: _off(faces[face], at)) for at in centres)

    return Shape(solid, again(root), again(tip))


def _centre(face: int) -> NDArray:
    return np.array(gmsh.model.occ.getCenterOfMass(2, face))
