"""NASA rotor 67 rubs where engine order 2 crosses f1: the scene `rotor67` on a coarse mesh."""

from collections.abc import Iterator
from tempfile import TemporaryDirectory

import numpy as np
import peer
from by_calculix import cells_of, theirs
from cases import Case, Row
from closing import closing, sides, tip_facets
from numpy.typing import NDArray
from rotor67 import coarse, mesh_at_rest

from geometry.base import ROOT, RPM
from geometry.interface import tip_of
from rom.crossings import crossing
from rom.model import Rom
from rom.reduce import reduce
from simulate import Scene, march, sweep
from workflow.jobs.full_model import assembled

SCENE = ROOT / "workflow/scenes/rotor67.yaml"
BESIDE = 1730.0, 1800.0  # rad/s, below and above the crossing
BELOW = 17000.0  # rpm, where the tip's second order is 5 % of its motion, that 2 gaps
EDGES = 1 / 16, 15 / 16
BY_A_SPEED = 0.1  # a test allows a tenth of it: the next speed of the sweep is 0.07 % away
BY_ROWS = 5e-3  # S_r - s S_z is not quite the projection of u_r - s u_z
NAMES = (
    *("motion at xi = 1/16", "motion at xi = 15/16"),
    *("deepest wear", "mean worn depth"),
)
MIDDLES = (np.arange(16) + 0.5) / 16  # of the strips


def rows() -> Iterator[Row]:
    """The crossing, the peak of the sweep, and one run near it by two programs."""
    scene, (rom, P, edges, of_calculix) = Scene.load(SCENE), models()
    linear = RPM * rom.omega1 * crossing(rom, 2)
    yield Row("linear crossing of EO 2 with f1, rpm", meeting(of_calculix), linear, 1e-3)
    runs = sweep(scene, rom)
    peak = runs.peaks()[2]
    largest = runs.dataset["largest"].values[peak.index]
    gap = scene.clearance.leading_edge_m
    yield Row("speed of the peak, rpm", None, RPM * rom.omega1 * peak.Omega_c, BY_A_SPEED)
    yield Row("amplitude of EO 2 there, um", None, 1e6 * gap * peak.amplitude, BY_A_SPEED)
    yield Row("largest displacement there, um", None, 1e6 * float(largest), BY_A_SPEED)
    yield from near_the_peak(rom, P, edges, scene)


def models() -> tuple[Rom, NDArray[np.float64], NDArray[np.float64], list[float]]:
    """Reduced model, ``closing`` rows, ``sides``; f1 of CalculiX, Hz, at the speeds ``BESIDE``."""
    blade = coarse()
    with TemporaryDirectory() as folder:
        mesh = mesh_at_rest(blade, folder)
        fom = assembled(blade, "rotor67", mesh)
        rom, T = reduce(fom, blade.basis, "r")
        points, facets = tip_facets(mesh)
        P = closing((points, facets), fom, T, np.array([*MIDDLES, *EDGES]), edges=True)
        there = sides(tip_of(facets, points).outline, rom.line(MIDDLES)[:, 2])
        found = theirs("rotor67 at its crossing", cells_of(mesh), blade.material, BESIDE)
    return rom, P, there, [f1 for f1, *_ in found]


def meeting(f1: list[float]) -> float:
    """Speed, rpm, at which f1, Hz, is twice it: f1^2 is linear in Omega^2 between two speeds."""
    squares, of_f1 = np.square(BESIDE), np.square(2 * np.pi * np.array(f1))
    slope, start = np.polyfit(squares, of_f1, 1)
    return float(RPM * np.sqrt(start / (4 - slope)))


def near_the_peak(
    rom: Rom, P: NDArray[np.float64], edges: NDArray[np.float64], scene: Scene
) -> Iterator[Row]:
    """Motion and wear by the independent program and ours; and by contact along the radius.

    ``P`` (2, strips + ends, n): as of ``closing``; ``edges`` (2, strips), rad: of ``sides``.
    """
    kept = {"history": {"chord": [*EDGES]}}
    alone, Omega = scene.but(peaks=None, record=kept), BELOW / RPM
    steps, m = scene.integrator.steps_per_round, len(MIDDLES)
    of = rom, alone, Omega, steps, steps * scene.rounds
    their = peer.piecewise_exact(*of, P[:, :m], P[:, m:].mean(axis=0), edges)
    ours, along = (march(case, rom, Omega) for case in (alone, alone.but(casing__slope=0.0)))

    def numbers(ends: NDArray[np.float64], wear: NDArray[np.float64]) -> Iterator[float]:
        """Half the range at both ends in the last revolution, deepest and mean wear, um."""
        yield from 1e6 * np.ptp(ends[-steps:], axis=0) / 2
        yield from (1e6 * float(wear.max()), 1e6 * float(wear.mean()))

    found = (numbers(run.u_r[:, 1:], run.wear) for run in (ours, along))
    for name, one, other, radial in zip(NAMES, numbers(their.out, their.wear), *found, strict=True):
        at = f"{name} at {BELOW:g} rpm, um"
        yield Row(at, one, other, BY_ROWS)
        yield Row(f"{at}, by contact along the radius", None, radial, BY_A_SPEED)


CASE = Case(
    title="Rub of NASA rotor 67 (CalculiX, NumPy)",
    source="crossing: f1 by CalculiX 2.20 at 1730 and 1800 rad/s; wear: [an independent program in "
    "plain NumPy](simulate/peer.py) on the same reduced model, whose motion towards the cone, of "
    "the edges behind and ahead, is that of the tip's facets",
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
