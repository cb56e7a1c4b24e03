"""The blade as a solid in gmsh, whatever it came from, and what its faces say of themselves."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass

import gmsh
import numpy as np
from numpy.typing import NDArray

from geometry.errors import MeshError

SAMPLES = 200  # points on each curve of an outline
JOINED = 1e-6  # m, ends of curves this close are one point


@dataclass(frozen=True)
class Shape:
    """Tags of the solid and of its faces at the root and at the tip."""

    solid: int
    root: tuple[int, ...]
    tip: tuple[int, ...]


@contextmanager
def session(remedy: str) -> Iterator[None]:
    """One gmsh model, quiet; gmsh's own errors are bare ``Exception``s and become ``MeshError``."""
    gmsh.initialize(interruptible=False)
    gmsh.option.setNumber("General.Terminal", 0)
    try:
        yield
    except Exception as error:
        if type(error) is not Exception:  # gmsh raises nothing finer
            raise
        raise MeshError(f"gmsh: {error}; {remedy}") from None
    finally:
        gmsh.finalize()


def faces_of(solid: int) -> list[int]:
    """Faces of a solid."""
    return [tag for _, tag in gmsh.model.getBoundary([(3, solid)], oriented=False)]


def curves_of(faces: Sequence[int]) -> list[int]:
    """Curves about ``faces``, without those between two of them."""
    boundary = gmsh.model.getBoundary([(2, face) for face in faces], oriented=False)
    return [tag for _, tag in boundary]


def sampled(curve: int) -> NDArray[np.float64]:
    """Points (SAMPLES, 3), m, from one end of a curve to the other."""
    (first,), (last,) = gmsh.model.getParametrizationBounds(1, curve)
    at = np.linspace(first, last, SAMPLES)
    return np.reshape(gmsh.model.getValue(1, curve, at), (-1, 3))


def outline(faces: Sequence[int]) -> NDArray[np.float64]:
    """Points (m, 3), m, around ``faces``, in order; the last is not the first.

    Raises
    ------
    MeshError
        When the curves do not chain up to one closed outline.
    """
    curves = [sampled(curve) for curve in curves_of(faces)]
    chain = [curves.pop(0)]
    while curves:
        ends = np.array([[curve[0], curve[-1]] for curve in curves])
        gaps = np.linalg.norm(ends - chain[-1][-1], axis=2)
        i, end = np.unravel_index(gaps.argmin(), gaps.shape)
        if gaps[i, end] > JOINED:
            raise MeshError("the tip has more than one outline; give interface.points_mm")
        chain.append(curves.pop(i)[:: -1 if end else 1])
    return np.vstack([curve[:-1] for curve in chain])


def radii(face: int) -> tuple[float, float]:
    """Smallest and largest distance, m, of a face from the engine axis: its edges and middle."""
    centre, _ = gmsh.model.getClosestPoint(2, face, gmsh.model.occ.getCenterOfMass(2, face))
    points = np.vstack([[centre], *(sampled(curve) for curve in curves_of([face]))])
    r = np.hypot(points[:, 0], points[:, 1])
    return float(r.min()), float(r.max())
