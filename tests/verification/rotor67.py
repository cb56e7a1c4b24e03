"""NASA rotor 67 on a coarse mesh: frequencies at rest and at speed, and untwist, by CalculiX."""

from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory

import calculix
import numpy as np
from blades import given
from by_calculix import beside, cells_of, kept, theirs
from cases import Case, Row
from exports import groups
from meshio import read
from numpy.typing import NDArray
from scipy.spatial import KDTree

from fem.assemble import assemble
from fem.at_rest import build_mesh_at_rest
from fem.matrices import Matrices
from geometry.base import ROOT, RPM
from geometry.blade import Blade
from rom.modes import ShiftInvert

FILE = ROOT / "workflow/blades/rotor67.yaml"
MODES = 10
TOLERANCE = 1e-4


def coarse() -> Blade:
    """The blade on some 2,800 cells."""
    return given(Blade.load(FILE), mesh={"element_size_mm": 6.0})


def mesh_at_rest(blade: Blade, folder: str) -> Path:
    """Mesh of the shape at rest, in a folder."""
    mesh = Path(folder) / "blade.msh"
    build_mesh_at_rest(blade, mesh, FILE.parent / blade.file)
    return mesh


def rows() -> Iterator[Row]:
    """Ten frequencies at rest and at design speed, and what the speed does to the tip."""
    blade = coarse()
    speeds = 0.0, blade.geometry_at_rpm / RPM
    with TemporaryDirectory() as folder:
        mesh = mesh_at_rest(blade, folder)
        cells, tip = cells_of(mesh), np.unique(groups(read(mesh))["tip"])
        matrices = assemble(blade, "rotor67", mesh, speeds)
    omega = [ShiftInvert(K, matrices.M).modes(MODES).omega for K in matrices.K]
    of_calculix = theirs("rotor67", cells, blade.material, speeds)
    yield from beside(speeds, of_calculix, np.array(omega) / (2 * np.pi), TOLERANCE)

    def by_calculix() -> dict[str, float]:
        return at_speed(cells.points, calculix.deflection(cells, blade.material, speeds[1]), tip)

    ours = at_speed(cells.points, deflection(matrices, cells.points), tip)
    for quantity, number in kept("rotor67 at speed", by_calculix).items():
        yield Row(f"at speed: {quantity}", number, ours[quantity], TOLERANCE)


def deflection(matrices: Matrices, points: NDArray) -> NDArray[np.float64]:
    """Displacement (n, 3), m, of the points of the mesh at the last speed; zero at the root."""
    away, at = KDTree(matrices.coordinates).query(points)
    u = matrices.u_static[-1].reshape(-1, 3)
    return np.where((away < 1e-9)[:, None], u[at], 0.0)


def at_speed(points: NDArray, u: NDArray, tip: NDArray) -> dict[str, float]:
    """Untwist and growth of the tip by the displacements ``u`` (n, 3), m, of the points."""
    edges = tip[[points[tip, 2].argmin(), points[tip, 2].argmax()]]
    angles, radii = zip(*(chord(places[edges]) for places in (points, points + u)), strict=True)
    growth = radii[1] - radii[0]
    return {
        "rotation of the tip's chord towards the axis, degrees": angles[0] - angles[1],
        "largest displacement, mm": 1e3 * float(np.linalg.norm(u, axis=1).max()),
        "growth of the tip's radius at the leading edge, mm": 1e3 * growth[0],
        "growth of the tip's radius at the trailing edge, mm": 1e3 * growth[1],
    }


def chord(edges: NDArray) -> tuple[float, NDArray]:
    """Angle from the axis, degrees, and radii, m, of the line between edges (2, 3)."""
    radii, theta = np.hypot(*edges.T[:2]), np.arctan2(edges[:, 1], edges[:, 0])
    along = radii.mean() * (theta[0] - theta[1]), edges[1, 2] - edges[0, 2]
    return float(np.degrees(np.arctan2(*along))), radii


CASE = Case(
    title="NASA rotor 67 (CalculiX)",
    source="CalculiX 2.20 on the cells of our mesh (C3D10), at speed about the equilibrium that it "
    "finds itself",
    compared="`workflow/blades/rotor67.yaml` with elements of 6 mm, in its shape at rest, which is "
    "computed from the coordinates at design speed.",
    reason="CalculiX integrates a cell at four points, which is not exact where its sides are "
    "curved.",
    rows=rows,
    nightly=True,
)
