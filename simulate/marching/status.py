"""Status of a run, from its facts and its second runs; why it has no contact."""

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from simulate.contact.ledger import Ledger
from simulate.contact.travelling import farthest
from simulate.marching.kernel import RUNNING, WORN_THROUGH
from simulate.marching.setup import Setup
from simulate.scene import Scene

if TYPE_CHECKING:  # which imports this module
    from simulate.marching.course import Outcome

# in the order in which tables number them
STATUSES = (
    "ok",
    "sensitive",
    "inaccurate",
    "liner-exhausted",
    "diverged",
    "unstable",
    "no-contact",
)
# from the least on: the worst blade of a stage is that of the last of them
SEVERITY = (
    *("no-contact", "ok", "sensitive", "inaccurate"),
    *("diverged", "unstable", "liner-exhausted"),
)
# statuses of the runs whose numbers are results; without contact, those of a blade at rest, or of
# one that forces alone move
WITH_RESULT = ("ok", "sensitive", "no-contact")
TO_THE_END = (*WITH_RESULT, "inaccurate")  # of those that can be compared

# Numerical energy over that given (``Ledger.given``): limits of an `ok` run
CREATED = 0.1  # above, the run is `unstable`
LOST = 0.2  # above, it is `inaccurate`: energy is quadratic, so 20 % is 10 % of the amplitude
SLIDES = 0.1  # least sliding speed over Omega r of an `ok` run with friction
SENSITIVE_FROM = 0.01  # relative difference from a twin above which nothing can be predicted
STATED = 0.1  # largest bound of the error of a run that is `ok`: above, it is `inaccurate`

MICRO = 1e6


@dataclass(frozen=True)
class Facts:
    """Facts of a run, without second runs."""

    end: int  # RUNNING, or why the kernel ended it
    ledger: Ledger
    unsolved: int = 0  # steps in which the solver of the contact forces did not converge
    untouched: bool = False  # the tip never touched, though it should: at rest, or in forces alone
    least_sliding: float = np.inf  # of a tip with friction in contact, over Omega r


def judge(
    facts: Facts, twin: float = 0.0, error: float = 0.0, accurate: bool = True, lost: float = LOST
) -> str:
    """Status of a run, from its facts and the findings of second runs.

    ``twin``: largest relative difference from its twin; ``error``: largest bound of the error of
    its step; ``accurate``: whether its errors are within the accuracy asked for; ``lost``: share of
    the energy given that its steps may lose.

    ``liner-exhausted``
        The tip has worn through the liner.
    ``unstable``
        The scheme created energy, the energy is negative or nan, or steps are unsolved: a numerical
        failure.
    ``diverged``
        The displacement exceeded its bound, driven by the work of the casing, of friction, of
        forces, or of damping below 0: physical.
    ``inaccurate``
        The scheme lost energy in contact, or the bound of the error is too large: the step is too
        long. Or the vibration of the tip came near its sliding speed, where friction would change
        its direction.
    ``sensitive``
        A twin departs: the run cannot be predicted. Or its accuracy is not met.
    ``no-contact``
        The tip has not touched: the blade has stayed at rest, or forces alone have moved it.
    ``ok``
        None of these.
    """
    ledger = facts.ledger
    given = ledger.given
    created = not ledger.numerical <= CREATED * given  # true for nan as well
    verdicts = (
        (facts.end == WORN_THROUGH, "liner-exhausted"),
        (created or not ledger.blade >= 0 or facts.unsolved > 0, "unstable"),
        (facts.end != RUNNING, "diverged"),
        (ledger.numerical < -LOST * given or facts.least_sliding < SLIDES, "inaccurate"),
        (twin > SENSITIVE_FROM or not accurate, "sensitive"),
        (not error <= STATED or ledger.numerical < -lost * given, "inaccurate"),
        (facts.untouched, "no-contact"),
    )
    return next((status for holds, status in verdicts if holds), "ok")


def judged(outcome: "Outcome", *found: Any) -> "Outcome":
    """The outcome with the status that follows from what second runs have ``found``.

    As of ``judge``, of each blade; that of the whole is the worst.
    """
    verdicts = [judge(blade.facts, *found) for blade in outcome.each_blade]
    pairs = zip(outcome.blades, verdicts, strict=False)
    blades = [replace(blade, status=verdict) for blade, verdict in pairs]
    return replace(outcome, status=max(verdicts, key=SEVERITY.index), blades=blades)


def why_no_contact(scene: Scene, setup: Setup, eps_p: NDArray[np.float64], rounds: int) -> str:
    """Reason why the tip did not touch: the key, its value and the change needed.

    A blade without forces starts at rest, and nothing has moved it: its smallest gap counts, the
    largest inward distortion up to the last revolution, and the wear.

    ``eps_p`` (strips, nu): plastic strains at the end; ``rounds``: since the casing began to
    distort.
    """
    inward, gap = farthest(setup.strips), float(setup.strips.g0.min())
    ramp, key = setup.ramp, "ramp_rounds" if scene.casing.ramp is None else "ramp"
    share = float(ramp.bounds(ramp.numbers, 0.0, float(rounds))[1])
    smallest_gap = f"the smallest gap is {MICRO * gap:.4g} um"
    what = "scale: 0" if scene.casing.scale == 0 else "the distortion is nowhere inward"
    reasons = (
        (
            not scene.liner.law.has_strength and eps_p.any(),
            "liner.law: sigma_Y and K are 0: the tip wears the liner without any force",
        ),
        (
            setup.forced is not None,
            f"force: the blade vibrates under its forces alone, and does not reach the liner; "
            f"{smallest_gap}: raise the force, widen casing or scale, or narrow the gap",
        ),
        (inward <= 0, f"casing.{what}: nothing brings the liner to the tip; {smallest_gap}"),
        (
            inward <= gap,
            f"clearance: {smallest_gap}, the largest inward distortion {MICRO * inward:.4g} um: a "
            "blade at rest is not reached; widen casing or scale, or narrow the gap",
        ),
        (
            share * inward <= gap,
            f"casing.{key}: the casing does not reach the tip within the {rounds} revolutions: the "
            f"distortion has grown to {MICRO * share * inward:.4g} um of "
            f"{MICRO * inward:.4g} um; {smallest_gap}",
        ),
        (
            eps_p.any(),
            f"start: the liner is worn by more than the casing's distortion; {smallest_gap}",
        ),
        (
            scene.casing.travelling,
            f"casing.harmonics: the travelling harmonics did not add up to the gap; {smallest_gap}",
        ),
        (
            True,
            "integrator: the tip passes over the liner between two steps: shorten the step",
        ),
    )
    return next(reason for holds, reason in reasons if holds)
