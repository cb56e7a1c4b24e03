"""NASA rotor 67 rubs where engine order 2 crosses f1: the scene `rotor67` on a coarse mesh."""

from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import peer
from blades import facets_of
from by_calculix import cells_of, theirs
from cases import Case, Row
from meshio import read
from numpy.typing import NDArray
from rotor67 import coarse, mesh_at_rest
from scipy.spatial import KDTree

from fem.matrices import Matrices
from geometry.blade import RPM
from geometry.interface import tip_of
from geometry.project import ROOT
from rom.model import Rom
from rom.reduce import reduce
from simulate import Scene, march, sweep
from simulate.sweeps.peak import crossing
from workflow.jobs.full_model import assembled

SCENE = ROOT / "workflow/scenes/rotor67.yaml"
BESIDE = 1730.0, 1800.0  # rad/s, below and above the crossing
PEAK = 17600.0  # rpm, on the way to the peak
BY_A_SPEED = 0.1  # a test allows a tenth of it: the next speed of the sweep is 0.07 % away
BY_ROWS = 5e-3  # S_r - s S_z is not quite the projection of u_r - s u_z
PARTS = 12  # along each side of a facet, in whose parts' middles it is integrated


def rows() -> Iterator[Row]:
    """The crossing, the peak of the sweep, and one run near it by two programs."""
    scene, (rom, P, of_calculix) = Scene.load(SCENE), models()
    linear = RPM * rom.omega1 * crossing(rom, 2)
    yield Row("linear crossing of EO 2 with f1, rpm", meeting(of_calculix), linear, 1e-3)
    runs = sweep(scene, rom)
    peak = runs.peaks()[2]
    largest = runs.dataset["largest"].values[peak.index]
    gap = scene.clearance.leading_edge_m
    yield Row("speed of the peak, rpm", None, RPM * rom.omega1 * peak.Omega_c, BY_A_SPEED)
    yield Row("amplitude of EO 2 there, um", None, 1e6 * gap * peak.amplitude, BY_A_SPEED)
    yield Row("largest displacement there, um", None, 1e6 * float(largest), BY_A_SPEED)
    yield from near_the_peak(rom, P, scene)


def models() -> tuple[Rom, NDArray[np.float64], list[float]]:
    """Reduced model, ``closing`` rows, and f1 of CalculiX, Hz, at the speeds ``BESIDE``."""
    blade = coarse()
    with TemporaryDirectory() as folder:
        mesh = mesh_at_rest(blade, folder)
        fom = assembled(blade, "rotor67", mesh)
        rom, T = reduce(fom, blade.basis, "r")
        P = closing(mesh, fom, T, rom)
        found = theirs("rotor67 at its crossing", cells_of(mesh), blade.material, BESIDE)
    return rom, P, [f1 for f1, *_ in found]


def closing(mesh: Path, fom: Matrices, T: NDArray[np.float64], rom: Rom) -> NDArray[np.float64]:
    """P (strips, n): what closes the gap to the cone over each strip, from places of nodes.

    u_r - (dr/dz) u_z is projected on the hats as it is on the facets, by sums over small parts of
    these; dr/dz is that of the camber line at the same z.
    """
    points, facets = read(mesh).points, facets_of(read(mesh), "tip")
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
    line = rom.camber
    slope = np.interp(z, line[:, 2], np.gradient(line[:, 0], line[:, 2]))
    normal = np.column_stack([places[:, 0] / r, places[:, 1] / r, -slope])
    phi = tents(tip_of(facets, points).xi(places), len(rom.xi))
    weighted = areas[:, None] * phi
    _, at = KDTree(fom.coordinates).query(points[facets])
    u = T.reshape(-1, 3, T.shape[1])[at]  # facets, nodes, xyz, DoFs
    moved = np.einsum("qn,fncd->fqcd", v, u).reshape(len(places), 3, -1)
    B = weighted.T @ np.einsum("pc,pcd->pd", normal, moved)
    return tents((np.arange(16) + 0.5) / 16, len(rom.xi)) @ np.linalg.solve(phi.T @ weighted, B)


def shape(x: NDArray[np.float64], y: NDArray[np.float64]) -> NDArray[np.float64]:
    """Shape functions (places, 6) of a quadratic triangle: corners, middles of 01, 12, 20."""
    a, b, c = 1 - x - y, x, y
    corners = [one * (2 * one - 1) for one in (a, b, c)]
    return np.column_stack([*corners, 4 * a * b, 4 * b * c, 4 * c * a])


def tents(xi: NDArray[np.float64], n: int) -> NDArray[np.float64]:
    """Hat functions (places, n) of equally spaced nodes from 0 to 1."""
    return np.maximum(0, 1 - abs((n - 1) * np.clip(xi, 0, 1)[:, None] - np.arange(n)))


def meeting(f1: list[float]) -> float:
    """Speed, rpm, at which f1, Hz, is twice it: f1^2 is linear in Omega^2 between two speeds."""
    squares, of_f1 = np.square(BESIDE), np.square(2 * np.pi * np.array(f1))
    slope, start = np.polyfit(squares, of_f1, 1)
    return float(RPM * np.sqrt(start / (4 - slope)))


def near_the_peak(rom: Rom, P: NDArray[np.float64], scene: Scene) -> Iterator[Row]:
    """Wear of a run by the independent program and ours; and by contact along the radius."""
    alone, Omega = scene.but(peaks=None), PEAK / RPM
    steps = scene.integrator.steps_per_round
    their = peer.piecewise_exact(rom, alone, Omega, steps, steps * scene.rounds, P).wear
    our = march(alone, rom, Omega).wear
    along = march(alone.but(casing__slope=0.0), rom, Omega).wear
    for name, of in (("deepest wear", np.max), ("mean worn depth", np.mean)):
        at = f"{name} at {PEAK:g} rpm, um"
        yield Row(at, 1e6 * float(of(their)), 1e6 * float(of(our)), BY_ROWS)
        yield Row(f"{at}, by contact along the radius", None, 1e6 * float(of(along)), BY_A_SPEED)


CASE = Case(
    title="Rub of NASA rotor 67 (CalculiX, NumPy)",
    source="crossing: f1 by CalculiX 2.20 at 1730 and 1800 rad/s; wear: [an independent program in "
    "plain NumPy](simulate/peer.py) on the same reduced model, whose motion towards the cone is "
    "that of the tip's facets",
    compared="`workflow/scenes/rotor67.yaml`: a casing with two lobes rubs 0.1 mm from the tip, "
    "60 revolutions, elements of 6 mm. The model needs ten speeds, as the blade untwists by two "
    "degrees. Contact is along the normal of the casing. Along the radius, as up to 0.3.0, it "
    "leaves out the axial motion, seven to fourteen times the radial one at the leading edge.",
    reason="the reduced model errs by up to 0.05 % in f1 (its check), in the crossing by twice as "
    "much; both programs integrate the same equations, with rows that differ by the projection of "
    "a product; numbers that only we have may change by a "
    "tenth of the tolerance, as by another speed of the sweep.",
    rows=rows,
    nightly=True,
)
