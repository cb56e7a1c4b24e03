"""Cases of the stability study: scenes drawn at random over wide ranges of every quantity.

E 1e-3 to 1.25e3 and K 0 to 1e6 (in units of 8e9 Pa, as the scene `hand`), K infinite (elastic) and
rigid, sigma_Y 0 to 1e3, one strip, as many as patches or twice as many, gaps 0 to 1e3 of the
paper's, casing amplitude from 0 to more than the liner's thickness, damping 0 to 1, speeds 1e-3 f1
to Omega_m and above, 1 to 5000 rounds, 1 to 1e6 rods, steps 0.05 to 20 times the limit of central
differences or, for piecewise-exact, up to 2000 times.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from geometry.base import shifted
from geometry.hats import middles
from simulate.scene import LEADING, Clearance

SAMPLES = 64  # of a round, or of its part that is marched
GAPS = (1.5e-4, 4.3e-4)  # of the paper, over the span
SPAN = 0.14  # m, of the reference blade
F1 = 258.0  # Hz, its f1(0)
# Angle of the blade at the first strip, by number of strips
FIRST_STRIP_DEG = {1: 0.07, 8: 2.15, 16: 2.30, 32: 2.38}
THICKNESS = 5e-3  # m
UNIT = 8e9  # Pa
EXPLICIT, EXACT = "central-difference", "piecewise-exact"
SEED = 20_261_127  # of none of the cases by which the limits of the checks were chosen


@dataclass(frozen=True)
class Case:
    """One scene at one speed and step."""

    scene: dict[str, Any]  # as in its YAML file, without blade and integrator
    scheme: str
    step_over_limit: float  # of central differences with contact
    as_fraction: bool  # step given as fraction_of_limit, not as steps_per_round
    ramp: float = 0.0  # part of the time marched over which the casing distorts
    # or parts of it, and factors of the distortion there
    table: tuple[Sequence[float], Sequence[float]] | None = None
    footprints: float | None = None  # that the tip passes in a step, in place of the above

    def grows(self, rounds: float) -> dict[str, Any]:
        """Keys of the casing by which its distortion changes over the ``rounds`` marched."""
        if self.table is None:
            return {"casing__ramp_rounds": self.ramp * rounds}
        parts, factors = self.table
        ramp = {"rounds": [rounds * part for part in parts], "factor": [*factors]}
        return {"casing__ramp_rounds": None, "casing__ramp": ramp}


class Dice(np.random.Generator):
    """Random numbers of one case."""

    def chance(self, share: float) -> bool:
        """Whether something of this probability happens."""
        return bool(self.random() < share)

    def decades(self, low: float, high: float) -> float:
        """A value with a uniformly distributed logarithm."""
        return float(np.exp(self.uniform(np.log(low), np.log(high))))

    def among(self, options: Mapping[Any, float]) -> Any:
        """A key, with the probability given by its value."""
        shares = np.array(list(options.values()))
        return list(options)[self.choice(len(options), p=shares / shares.sum())]


def draw(number: int, patches: int) -> Case:
    """Case ``number``, from 0, for a model with ``patches``; reproducible.

    No number of strips is refused as such: one, as many as patches, or twice as many.
    """
    dice = Dice(np.random.PCG64([SEED, number]))
    scheme = dice.among({EXPLICIT: 1, EXACT: 1})
    law = _law(dice)
    profile = law["kind"] == "plastic" and dice.chance(0.2)
    drawn = dice.among({1: 0.3, patches: 0.45, 2 * patches: 0.25})
    strips = patches if law["kind"] == "rigid" else drawn
    case = Case(
        scene={
            "speeds": {"over_f1": [_speed(dice)]},
            "rounds": round(dice.decades(1, 5000)),
            "damping_ratio": _some(dice, 0.005, (1e-4, 0.9), 0.0, 1.0),
            **_gap_and_casing(dice, strips),
            "liner": {
                "law": law,
                "thickness_mm": shifted(THICKNESS, 3),
                "strips": strips,
                "footprint_mm": 5.0,
                "rods_per_round": _rods(dice),
                "worn_through": _worn_through(dice, scheme, law, profile),
            },
            "contact": _contact(dice) if profile else {},
            "record": {
                "samples_per_round": SAMPLES,
                "contact_force": True,
                "history": {"chord": [LEADING]},
            },
        },
        scheme=scheme,
        step_over_limit=_step(dice, scheme),
        as_fraction=dice.chance(0.5),
    )
    if dice.chance(0.3):  # of a key that is gone: what is drawn after it stays
        dice.decades(3e3, 3e5)
    grows = dice.chance(0.95 if law["kind"] == "rigid" else 0.6)
    return replace(case, ramp=dice.uniform(0.02, 0.6)) if grows else case


def _some(
    dice: Dice, usual: float, decades: tuple[float, float], none: float, refused: float
) -> float:
    """The usual value, one of the range ``decades``, ``none``, or ``refused``."""
    kind = dice.among({"usual": 0.4, "any": 0.42, "none": 0.15, "refused": 0.03})
    return {"usual": usual, "any": dice.decades(*decades), "none": none, "refused": refused}[kind]


def _law(dice: Dice) -> dict[str, Any]:
    kind = dice.among({"plastic": 0.74, "elastic": 0.18, "rigid": 0.08})
    stiff = dice.chance(0.03)  # refused above 1250: 1e13 Pa
    E = dice.decades(2e3, 1e6) if stiff else dice.decades(1e-3, 1.25e3)
    if kind == "rigid":
        return {"kind": kind}
    law = {"kind": kind, "E": E, "unit_MPa": shifted(UNIT, -6)}
    if kind == "plastic":
        of_paper, any_K = 0.45 * E, dice.decades(1e-3, 1e6)
        law["K"] = {"paper": of_paper, "any": any_K, "perfect": 0.0}[
            dice.among({"paper": 0.35, "any": 0.5, "perfect": 0.15})
        ]
        law["sigma_Y"] = dice.among({1e-8: 0.4, dice.decades(1e-8, 1e3): 0.5, 0.0: 0.1})
    return law


def _speed(dice: Dice) -> float:
    """Speed over f1(0); refused above Omega_m, about 0.4."""
    return dice.among(
        {
            dice.decades(1e-3, 0.4): 0.5,
            dice.uniform(0.05, 0.4): 0.47,
            dice.uniform(0.41, 3): 0.03,  # too fast
        }
    )


def _gap_and_casing(dice: Dice, strips: int) -> dict[str, Any]:
    """Most casings close the gap of the first strip at its start, some by more than the liner."""
    scale = dice.among({1.0: 0.3, dice.decades(1e-3, 1e3): 0.67, 0.0: 0.03})
    first, last = (scale * value for value in GAPS)
    clearance = {"leading_edge_over_span": first, "trailing_edge_over_span": last}
    gap = float(Clearance(**clearance).gaps(middles(strips)[0], SPAN))
    beyond = dice.among(
        {
            dice.decades(1e-7, 1e-3): 0.8,
            dice.uniform(0.2, 1.3) * THICKNESS: 0.14,
            -0.1 * gap: 0.03,
            -gap: 0.03,
        }
    )
    phase = dice.uniform(-180, 180) if dice.chance(0.15) else 0.0
    order = int(dice.uniform(0, 13))
    harmonic = {
        "order": order,
        "amplitude_um": shifted(max(gap + beyond, 0.0), 6),
        "phase_deg": -order * FIRST_STRIP_DEG[strips] + phase,
    }
    return {
        "clearance": clearance,
        "casing": {"harmonics": [harmonic], "ramp_rounds": 0.0},
    }


def _rods(dice: Dice) -> int:
    """Rods per round; refused if wider than twice the footprint."""
    return round(dice.among({dice.decades(1, 350): 0.05, dice.decades(700, 1e6): 0.5, 2048: 0.45}))


def _worn_through(dice: Dice, scheme: str, law: Mapping[str, Any], profile: bool) -> str:
    """``casing`` in some cases, which is refused for central differences."""
    exact = 0.2 if law["kind"] == "plastic" and not profile else 0.0
    share = exact if scheme == EXACT else 0.02
    return "casing" if dice.chance(share) else "stop"


def _contact(dice: Dice) -> dict[str, Any]:
    drop = {"edge_drop_um": shifted(dice.decades(1e-6, 1e-3), 6)}
    tilt = {"tilt": dice.uniform(-0.1, 0.1)} if dice.chance(0.5) else {}
    return {"profile": drop | tilt, "tangential": True}


def _step(dice: Dice, scheme: str) -> float:
    """Step over the limit; one in five of central differences exceeds it and is refused."""
    within, past, coarse = dice.decades(0.05, 1), dice.decades(1, 20), dice.decades(20, 2000)
    if scheme == EXPLICIT:
        return dice.among({within: 0.8, past: 0.2})
    return dice.among({within: 0.35, past: 0.45, coarse: 0.2})
