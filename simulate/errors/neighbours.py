"""Second runs beside a run: a twin, half and a quarter of its step, other models; its status.

A twin is the same run with all gaps changed by 1e-10, far less than any manufacturing tolerance.
The computation is deterministic, so that only this change makes the two differ. Where they differ
by more than 1 %, the motion is chaotic: the results hold for these exact gaps only, and another
blade's will differ. Reference: Shaw and Holmes 1983, a periodically forced piecewise linear
oscillator.

The error of the step is bounded by runs with half and, in doubt, a quarter of it. Central
differences are of order one in contact: halving the step halves the error, so that the error is
twice the change. Piecewise-exact is of order two: its error is 4/3 of the change, but at long steps
on hard liners its order is lower, too. The bound is that of order one for both, with a safety
factor of 1.5 (Roache 1994, grid convergence index).

A bound with such a factor stops runs that are right by little, and of two runs no order can be
seen. So where the bound is near its limit, a third run takes a quarter of the step. Its own error
is at most the change by the last halving, if the order is at least one: the bound is the change
from the run to the third, and that of the last halving.

A contact shorter than a step may be seen, or missed, by both runs alike, since they share every
second instant. Its steps then are as many in both, though the time in contact should be the same:
the share of steps with contact tells. Not in central differences, whose rods throw the tip back
within few steps at any step near their limit.
"""

from dataclasses import replace
from functools import partial
from math import inf

import numpy as np

from rom.model import Rom
from simulate.errors.neighbour import Neighbour
from simulate.errors.observables import differences
from simulate.errors.resolution import LOST
from simulate.errors.run import Run
from simulate.marching import SENSITIVE_FROM, STATED, WITH_RESULT, Setup, status

GAP_CHANGE = 1e-10  # of the gaps: a million times round-off, a millionth of any tolerance
SAFETY = 3.0  # bound of the error over the change by half the step
NEAR = (STATED / 2, SAFETY * STATED)  # of a bound by half the step: a quarter of the step decides
CONTACT_CHANGE = 0.25  # relative, of the share of steps with contact: above, it is `inaccurate`


def shifted(setup: Setup) -> Setup:
    """``setup`` with every gap g0 changed by ``GAP_CHANGE`` of the widest gap or distortion."""
    g0, d = setup.strips.g0, setup.strips.d
    change = GAP_CHANGE * max(g0.max(), np.abs(d).max())  # all gaps may be 0
    return replace(setup, strips=setup.strips._replace(g0=g0 + change))


ITSELF = Neighbour("as it is")
TWIN = Neighbour("a twin", setup=shifted)
HALF = Neighbour("half the step", steps=2, cost=2.0)
QUARTER = Neighbour("a quarter of the step", steps=4, cost=4.0)


def raised(share: float, along: bool = False) -> Neighbour:
    """The run on a model with all natural frequencies higher by a ``share`` of themselves."""
    made = partial(_raised, share=share, along=along)
    return Neighbour(f"frequencies by {share:g}", rom=made, along=along)


def _raised(rom: Rom, share: float, along: bool) -> Rom:
    # f1(0), by which speeds and tables of thermal growth may be given, stays where the speed does
    f1 = rom.f1 * (1 + share) if along else rom.f1
    return replace(rom, K=rom.K * (1 + share) ** 2, f1=f1)


def judged(run: Run, met: bool = True) -> Run:
    """March the second runs that the scene asks for beside a run, and decide on its status.

    ``met``: whether the errors that it has are within its ``accuracy``. A run without second runs
    and errors may lose less energy (``resolution``).
    """
    scene, outcome, errors, departures = run.scene, run.outcome, run.errors, {}
    if scene.twin:
        departures = differences(run, run.beside(TWIN).march())
    apart, bound = max(departures.values(), default=0.0), 0.0
    alone = not errors and not scene.halving
    if scene.halving:
        errors, bound = halved(run, sensitive=apart > SENSITIVE_FROM)
    lost = LOST[scene.integrator.scheme] if alone else status.LOST
    word = status.judge(outcome.facts, apart, bound, met, lost)
    reason = outcome.reason if word == outcome.status else ""
    outcome = replace(outcome, status=word, reason=reason)
    return replace(run, outcome=outcome, departures=departures, errors=errors)


def halved(run: Run, sensitive: bool = False) -> tuple[dict[str, float], float]:
    """Run with half the step: bounds of relative errors by observable, and the one that counts.

    With a quarter of the step, too, where the bounds are near 0.1. The largest counts; inf
    where the run, or that with half the step, fails, where they end differently, and where the
    share of steps with contact changes by over a quarter. For a ``sensitive`` run half is enough.
    """
    if run.outcome.status not in WITH_RESULT:
        return dict.fromkeys(run.scene.record.observables, inf), inf
    half = run.beside(HALF).march()
    errors = bounds(run, half)
    ends = {of.outcome.status for of in (run, half)}
    if sensitive or len(ends) > 1 or _other_contact(run, half):
        return errors, inf
    if NEAR[0] < max(errors.values()) <= NEAR[1]:
        errors = bounds(run, half, run.beside(QUARTER).march())
    return errors, max(errors.values())


def _other_contact(run: Run, half: Run) -> bool:
    """Whether steps in contact are not twice as many at half the step."""
    shares = run.outcome.contact_share, half.outcome.contact_share
    chatters = run.scene.integrator.scheme == "central-difference"
    return not chatters and abs(shares[1] - shares[0]) > CONTACT_CHANGE * max(shares)


def bounds(run: Run, half: Run, quarter: Run | None = None) -> dict[str, float]:
    """Bounds of the relative errors of a run, from those with half and a quarter of its step.

    Infinite where one of these failed.
    """
    if quarter is None:
        return {name: SAFETY * of for name, of in differences(run, half, neither=inf).items()}
    to_finest = differences(run, quarter, neither=inf)
    of_last_halving = differences(half, quarter, neither=inf)
    return {name: of + of_last_halving[name] for name, of in to_finest.items()}
