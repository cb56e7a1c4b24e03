"""NASA rotor 67 rubs where engine order 2 crosses f1: the scene `rotor67` on a coarse mesh."""

from collections.abc import Iterator
from tempfile import TemporaryDirectory

import numpy as np
import peer
from by_calculix import cells_of, theirs
from cases import Case, Row
from rotor67 import coarse, mesh_at_rest

from geometry.blade import RPM
from geometry.project import ROOT
from rom.model import Rom
from rom.reduce import reduce
from simulate import Scene, march, sweep
from simulate.sweeps.peak import crossing
from workflow.jobs.full_model import assembled

SCENE = ROOT / "workflow/scenes/rotor67.yaml"
BESIDE = 1730.0, 1800.0  # rad/s, below and above the crossing
PEAK = 17140.0  # rpm, near the peak
BY_A_SPEED = 0.1  # a test allows a tenth of it: the next speed of the sweep is 0.07 % away


def rows() -> Iterator[Row]:
    """The crossing, the peak of the sweep, and one run near it by two programs."""
    scene, (rom, of_calculix) = Scene.load(SCENE), models()
    linear = RPM * rom.omega1 * crossing(rom, 2)
    yield Row("linear crossing of EO 2 with f1, rpm", meeting(of_calculix), linear, 1e-3)
    runs = sweep(scene, rom)
    peak = runs.peaks()[2]
    largest = runs.dataset["largest"].values[peak.index]
    gap = scene.clearance.leading_edge_m
    yield Row("speed of the peak, rpm", None, RPM * rom.omega1 * peak.Omega_c, BY_A_SPEED)
    yield Row("amplitude of EO 2 there, um", None, 1e6 * gap * peak.amplitude, BY_A_SPEED)
    yield Row("largest displacement there, um", None, 1e6 * float(largest), BY_A_SPEED)
    yield from near_the_peak(rom, scene)


def models() -> tuple[Rom, list[float]]:
    """Reduced model, and f1 of CalculiX, Hz, at the speeds ``BESIDE`` the crossing."""
    blade = coarse()
    with TemporaryDirectory() as folder:
        mesh = mesh_at_rest(blade, folder)
        rom, _ = reduce(assembled(blade, "rotor67", mesh), blade.basis, "r")
        found = theirs("rotor67 at its crossing", cells_of(mesh), blade.material, BESIDE)
    return rom, [f1 for f1, *_ in found]


def meeting(f1: list[float]) -> float:
    """Speed, rpm, at which f1, Hz, is twice it: f1^2 is linear in Omega^2 between two speeds."""
    squares, of_f1 = np.square(BESIDE), np.square(2 * np.pi * np.array(f1))
    slope, start = np.polyfit(squares, of_f1, 1)
    return float(RPM * np.sqrt(start / (4 - slope)))


def near_the_peak(rom: Rom, scene: Scene) -> Iterator[Row]:
    """Wear of a run by the independent program and ours."""
    alone, Omega = scene.but(peaks=None), PEAK / RPM
    steps = scene.integrator.steps_per_round
    their = peer.piecewise_exact(rom, alone, Omega, steps, steps * scene.rounds).wear
    our = march(alone, rom, Omega).wear
    for name, of in (("deepest wear", np.max), ("mean worn depth", np.mean)):
        yield Row(f"{name} at {PEAK:g} rpm, um", 1e6 * float(of(their)), 1e6 * float(of(our)), 1e-5)


CASE = Case(
    title="Rub of NASA rotor 67 (CalculiX, NumPy)",
    source="crossing: f1 by CalculiX 2.20 at 1730 and 1800 rad/s; wear: [an independent program in "
    "plain NumPy](simulate/peer.py) on the same reduced model",
    compared="`workflow/scenes/rotor67.yaml`: a casing with two lobes rubs 0.1 mm from the tip, "
    "60 revolutions, elements of 6 mm. The model needs nine speeds, as the blade untwists by two "
    "degrees.",
    reason="the reduced model errs by up to 0.05 % in f1 (its check), in the crossing by twice as "
    "much; both programs integrate the same equations; numbers that only we have may change by a "
    "tenth of the tolerance, as by another speed of the sweep.",
    rows=rows,
    nightly=True,
)
