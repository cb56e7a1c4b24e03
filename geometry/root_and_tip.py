"""Root and tip among the facets of a mesh's surface, by the name of a group or by radius."""

import numpy as np
from numpy.typing import NDArray

from geometry.base import MeshError, require
from geometry.blade import Face, MeshFile
from geometry.facets import normals
from geometry.file_mesh import FileMesh
from geometry.tetrahedra import neighbours, outlines, patches

ON_RADIUS = 1e-5  # relative; files hold six digits or more
MOST_NAMES = 20  # in a message
SMOOTH = 5.0  # degrees between facets of one face; a rounded edge of up to eight facets has more
BEYOND = {  # sign of the radius, and words for messages: outside is inside with the opposite sign
    "root": (1, "inside", "innermost reaches out"),
    "tip": (-1, "outside", "outermost reaches in"),
}


def root_and_tip(
    source: MeshFile, mesh: FileMesh, points: NDArray, surface: NDArray
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Facets (k, 6) of ``surface`` (n, 6) that are clamped, and those of the tip.

    ``points``: nodes (n, 3), m, in the blade's frame.

    Raises
    ------
    MeshError
        When a group is unknown, empty or not on the surface, no facet is within the radius, root
        and tip share facets, the root is outside the tip, or the tip is a part of its face.
    """
    corners = np.hypot(points[:, 0], points[:, 1])[surface[:, :3]]
    root, tip = (
        np.any([_of_group(key, name, mesh, surface) for name in face.groups], axis=0)
        if face.groups
        else within_radius(key, face.radius_mm, corners, ON_RADIUS * face.radius_mm * 1e-3)
        for key, face in (("root", source.root), ("tip", source.tip))
    )
    inner, outer = corners[root].mean(), corners[tip].mean()
    require(
        (not np.any(root & tip), f"root and tip share {np.sum(root & tip)} facets"),
        (
            inner < outer,
            f"the root is at radius {inner * 1e3:.4g} mm and the tip at {outer * 1e3:.4g} mm: "
            f"check frame.downstream, or exchange root and tip",
        ),
    )
    _check_whole(source.tip, surface, tip, points)
    return surface[root], surface[tip]


def _check_whole(face: Face, surface: NDArray, tip: NDArray, points: NDArray) -> None:
    """Check that the tip ends at edges of the surface, not within a smooth face.

    Else its group is not complete, as in a file that is cut short, or names one of several faces.
    """
    normal = normals(surface, points)
    area = np.linalg.norm(normal, axis=1)
    one, other = neighbours(surface)
    ends = tip[one] != tip[other]
    cosine = np.cos(np.radians(SMOOTH)) * area[one] * area[other]
    smooth = ends & ((normal[one] * normal[other]).sum(axis=1) > cosine)
    require(
        (
            not np.any(smooth),
            f"at {np.sum(smooth)} of the {np.sum(ends)} edges around the tip its face goes on, "
            f"within {SMOOTH:g} degrees: give all of its facets",
        ),
        key=f"tip.{'radius_mm' if face.group is None else 'group'}",
    )


def outline_of(facets: NDArray, points: NDArray) -> NDArray[np.int64]:
    """Nodes (m,) of the outer boundary of the tip's facets (k, 6), in order, without holes.

    Raises
    ------
    MeshError
        When the facets are not connected.
    """
    if count := patches(facets).max():
        raise MeshError(f"the tip is in {count + 1} pieces: give the facets of one")
    return max(
        outlines(facets),
        key=lambda line: np.linalg.norm(points[line] - points[np.roll(line, 1)], axis=1).sum(),
    )


def within_radius(
    key: str, radius_mm: float, r: NDArray[np.float64], tolerance: float
) -> NDArray[np.bool_]:
    """Whether faces (n,) with radii ``r`` (n, k), m, are entirely inside (root) or outside (tip).

    ``key`` ends in ``root`` or ``tip``; ``tolerance`` in m.

    Raises
    ------
    MeshError
        When none is; the message names the radius of the closest face.
    """
    sign, where, nearest = BEYOND[key.split(".")[-1]]
    farthest = (sign * r).max(axis=1)
    chosen = farthest <= sign * radius_mm * 1e-3 + tolerance
    require(
        (
            np.any(chosen),
            f"no face lies wholly {where} that; the {nearest} to "
            f"{abs(farthest.min()) * 1e3:.6g} mm",
        ),
        key=f"{key}.radius_mm",
        value=radius_mm,
    )
    return chosen


def _of_group(key: str, given: str, mesh: FileMesh, surface: NDArray) -> NDArray[np.bool_]:
    # in decks case does not matter
    group = given if given in mesh.groups else given.upper()
    if len(mesh.face_groups.get(group, ())):
        chosen = _matched(key, group, mesh.face_groups[group], surface)
    elif group in mesh.node_groups:
        chosen = np.isin(surface, mesh.node_groups[group]).all(axis=1)
    else:
        names = sorted(mesh.groups)
        more = f" and {len(names) - MOST_NAMES} more" if len(names) > MOST_NAMES else ""
        empty = {given, group} & mesh.face_groups.keys()
        fault = "holds no triangles" if empty else "no such group"
        raise MeshError(
            f"{fault}; groups of faces or nodes: {', '.join(names[:MOST_NAMES]) or 'none'}{more}",
            key=f"{key}.group",
            value=given,
        )
    require(
        (np.any(chosen), "no facet of the surface has all its nodes in it"),
        key=f"{key}.group",
        value=given,
    )
    return chosen


def _matched(key: str, group: str, faces: NDArray, surface: NDArray) -> NDArray[np.bool_]:
    """Whether facets of the surface (n,) are faces of the group, by their corner nodes."""
    corners = np.sort(np.vstack([surface[:, :3], faces]), axis=1)
    _, number = np.unique(corners, axis=0, return_inverse=True)
    outside, chosen = np.split(number.ravel(), [len(surface)])
    astray = np.sum(~np.isin(chosen, outside))
    require(
        (
            not astray,
            f"{astray} of its {len(faces)} faces are not on the surface of the tetrahedra: they "
            "must share its nodes",
        ),
        key=f"{key}.group",
        value=group,
    )
    return np.isin(outside, chosen)
