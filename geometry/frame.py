"""Transformation from a file's axes and unit to the frame of the blade, in m.

x is radial, y in the sense of rotation, z downstream.
"""

import numpy as np
from numpy.typing import NDArray

from geometry.base import require
from geometry.blade import Frame, SourceFile
from geometry.tetrahedra import MIRRORED

LENGTHS = (1e-3, 5.0)  # m; for blades outside this range the unit is taken to be wrong
MOST_ANGLE = 45.0  # deg from `radial`; one of the four axes is always within


def rotation(frame: Frame) -> NDArray[np.float64]:
    """R (3, 3), a signed permutation: a point x of the file is R x in the blade's frame.

    det R = -1 if the rotation is left-handed: R then mirrors, which turns cells inside out.
    """
    z, x = _unit(frame.downstream), _unit(frame.radial)
    y = np.cross(z, x) if frame.rotation == "right-handed" else np.cross(x, z)
    return np.array([x, y, z])


def axes(source: SourceFile) -> NDArray[np.float64]:
    """A (3, 3): a point x of the file is A x in the blade's frame, m."""
    return rotation(source.frame) * source.metres


def to_blade(
    points: NDArray, source: SourceFile, remedy: str = "choose another unit"
) -> NDArray[np.float64]:
    """Points (n, 3) of a file, in its unit and axes, in the blade's frame, m.

    ``remedy``: advice of the message if the length is out of range.

    Raises
    ------
    MeshError
        When the length is not in ``LENGTHS``, or the blade is not along ``frame.radial``.
    """
    placed = np.asarray(points) @ axes(source).T
    length = float(np.ptp(placed, axis=0).max())
    require(
        (
            LENGTHS[0] <= length <= LENGTHS[1],
            f"the blade is {length:.3g} m long with unit: {source.unit}; "
            f"allowed {LENGTHS[0]:g} to {LENGTHS[1]:g} m: {remedy}",
        ),
        allowed=LENGTHS,
    )
    # the mean angle from `radial`: a wrong axis gives a quarter or half turn
    x, y, _ = placed.mean(axis=0)
    angle = float(np.arctan2(y, x))
    quarter = np.round(angle / (np.pi / 2)) * np.pi / 2
    near = _axis(rotation(source.frame).T @ [np.cos(quarter), np.sin(quarter), 0])
    require(
        (
            abs(np.degrees(angle)) <= MOST_ANGLE,
            f"the blade stands {np.degrees(angle):.0f} degrees from frame.radial "
            f"{source.frame.radial} about the engine axis: correct frame.downstream if it is not "
            f"{source.frame.downstream}; if it is, choose frame.radial: {near}",
        ),
        allowed=near,
    )
    return placed


def to_file(vectors: NDArray, source: SourceFile) -> NDArray[np.float64]:
    """Vectors (..., 3 k), m, x, y, z of k of them in turn, in the file's unit and axes.

    The inverse of ``to_blade``.
    """
    return (vectors.reshape(-1, 3) @ np.linalg.inv(axes(source)).T).reshape(vectors.shape)


def turned(cells: NDArray, source: SourceFile) -> NDArray[np.int64]:
    """Cells (n, 10) of a file for the blade's frame, or back: a left-handed frame mirrors them."""
    return cells[:, MIRRORED] if np.linalg.det(axes(source)) < 0 else cells


def box(points: NDArray) -> str:
    """Box of points (n, 3) of a file, and the axis on which it is farthest from the origin."""
    sides = list(zip("xyz", points.min(axis=0), points.max(axis=0), strict=True))
    name, low, high = max(sides, key=lambda side: abs(side[1] + side[2]))
    return (
        f"box {', '.join(f'{axis} {a:.5g} to {b:.5g}' for axis, a, b in sides)}; "
        f"radial {'-' if low + high < 0 else ''}{name} (assumed: farthest from 0)"
    )


def _unit(axis: str) -> NDArray:
    return np.eye(3)["xyz".index(axis[-1])] * (-1 if axis[0] == "-" else 1)


def _axis(unit: NDArray) -> str:
    i = int(np.argmax(np.abs(unit)))
    return ("-" if unit[i] < 0 else "") + "xyz"[i]
