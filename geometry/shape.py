"""The blade as a solid in gmsh: its faces, with their radii and mesh."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from tempfile import TemporaryDirectory

import gmsh
import numpy as np
from numpy.typing import NDArray

from geometry.base import MeshError, ProvenanceError, anew, intact, require
from geometry.file_mesh import Physics

SAMPLES = 200  # points on each curve
MESH = b"$MeshFormat\n"  # begins a mesh of gmsh
SOURCE = b"$Comments\nsource %b\n$EndComments\n"  # in one, with a hash
CELL, FACET = 11, 9  # gmsh's numbers of ten-node tetrahedra and six-node triangles


@dataclass(frozen=True)
class Shape:
    """Tags of the solid and of its faces at the root and at the tip."""

    solid: int
    root: tuple[int, ...]
    tip: tuple[int, ...]
    physics: Physics = field(default_factory=Physics)  # that a mesh file has besides


@contextmanager
def session(remedy: str) -> Iterator[None]:
    """A gmsh session without output; errors of gmsh become ``MeshError`` with a ``remedy``.

    ``.gmshrc`` and ``.gmsh-options`` are not read: they would change meshes, or call programs.
    """
    gmsh.initialize(readConfigFiles=False, interruptible=False)
    gmsh.option.setNumber("General.Terminal", 0)
    try:
        yield
    except Exception as error:
        if type(error) is not Exception:  # gmsh raises plain exceptions
            raise
        raise MeshError(f"gmsh: {error}; {remedy}") from None
    finally:
        gmsh.finalize()


def merge(path: str | Path) -> None:
    """Read a ``blade.msh`` into the session.

    gmsh runs a text without the head of a mesh as a script of its own, which may call any program,
    and likewise a ``blade.msh.opt`` beside the mesh: the head is checked, and gmsh is given a copy.

    Raises
    ------
    ProvenanceError
        When the file is no mesh, or not as it was written.
    """
    data = intact(path).read_bytes()
    require(
        (data.startswith(MESH), f"is no mesh of gmsh; {anew(path)}"),
        kind=ProvenanceError,
        file=path,
    )
    with TemporaryDirectory() as folder:
        copy = Path(folder, "blade.msh")
        copy.write_bytes(data)
        gmsh.merge(str(copy))


def source_of(mesh_path: str | Path) -> str:
    """Hash of the geometry file that a ``blade.msh`` was made of; empty of parameters."""
    before, _, rest = Path(mesh_path).read_bytes().rpartition(SOURCE.partition(b"%b")[0])
    return rest.partition(b"\n")[0].decode("ascii", "replace") if before else ""


def wire(suction: NDArray, pressure: NDArray, add_curve: Callable[[list[int]], int]) -> int:
    """Closed outline of a section: suction side, trailing edge, pressure side, leading edge.

    Parameters
    ----------
    suction, pressure : (n, 3), m, points of each side from the leading edge
    add_curve : function of OpenCASCADE that adds a curve through points
    """
    occ = gmsh.model.occ
    behind = [occ.addPoint(*point) for point in suction]
    ahead = [occ.addPoint(*point) for point in pressure]
    curves = [
        add_curve(behind),
        occ.addLine(behind[-1], ahead[-1]),
        add_curve(ahead[::-1]),
        occ.addLine(ahead[0], behind[0]),
    ]
    return occ.addWire(curves)


def faces_of(solid: int) -> list[int]:
    """Tags of the faces of a solid."""
    return [tag for _, tag in gmsh.model.getBoundary([(3, solid)], oriented=False)]


def by_radius(tags: Iterable[int], dimension: int) -> list[int]:
    """Tags of faces or curves (``dimension``), sorted by the radius of their centre of mass."""

    def radius(tag: int) -> float:
        """Distance of the centre of mass from the axis, m."""
        return float(np.hypot(*gmsh.model.occ.getCenterOfMass(dimension, tag)[:2]))

    return sorted(tags, key=radius)


def sampled(curve: int) -> NDArray[np.float64]:
    """Points (SAMPLES, 3), m, along a curve from end to end."""
    (first,), (last,) = gmsh.model.getParametrizationBounds(1, curve)
    parameters = np.linspace(first, last, SAMPLES)
    return np.reshape(gmsh.model.getValue(1, curve, parameters), (-1, 3))


def radii(face: int) -> tuple[float, float]:
    """Smallest and largest radius, m, of a face, from its edges and its middle."""
    centre, _ = gmsh.model.getClosestPoint(2, face, gmsh.model.occ.getCenterOfMass(2, face))
    curves = gmsh.model.getBoundary([(2, face)], oriented=False)
    points = np.vstack([[centre], *(sampled(tag) for _, tag in curves)])
    r = np.hypot(points[:, 0], points[:, 1])
    return float(r.min()), float(r.max())


def facets_of(faces: Sequence[int]) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Mesh nodes (n, 3), m, of ``faces``, and their second-order triangles (k, 6)."""
    tags = np.concatenate([gmsh.model.mesh.getElementsByType(FACET, face)[1] for face in faces])
    nodes, facets = np.unique(tags, return_inverse=True)
    points = np.array([gmsh.model.mesh.getNode(node)[0] for node in nodes])
    return points, facets.reshape(-1, 6)


def jacobian_ratios() -> NDArray[np.float64]:
    """Smallest over largest Jacobian determinant (cells,) of the ten-node tetrahedra.

    By gmsh's bounds on its polynomial: positive only where no point of the cell is inside out; nan
    where the cell is flat.
    """
    cells, _ = gmsh.model.mesh.getElementsByType(CELL)
    smallest, largest = (
        np.array(gmsh.model.mesh.getElementQualities(cells, measure))
        for measure in ("minDetJac", "maxDetJac")
    )
    with np.errstate(invalid="ignore"):
        return smallest / np.maximum(abs(smallest), abs(largest))
