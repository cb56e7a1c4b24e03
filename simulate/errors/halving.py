"""Error of a run due to its step, from runs with half and, in doubt, a quarter of it.

Central differences are of order one in contact: halving the step halves the error, so that the
error is twice the change. Piecewise-exact is of order two: its error is 4/3 of the change, but at
long steps on hard liners its order is lower, too. The bound is that of order one for both, with a
safety factor of 1.5 (Roache 1994, grid convergence index).

A bound with such a factor stops runs that are right by little, and of two runs no order can be
seen. So where the bound is near what may be stated, a third run marches a quarter of the step. What
it is off itself is at most what the last halving changed, if the order is at least one: the bound
is the change from the run to the third, and that of the last halving.

A contact shorter than a step may be seen, or missed, by both runs alike, since they share every
second instant. Its steps then are as many in both, though the time in contact should be the same:
the share of steps with contact tells. Not in central differences, whose rods throw the tip back
within few steps at any step near their limit.
"""

from dataclasses import replace
from math import inf

import numpy as np
from numpy.typing import NDArray

from rom.model import Rom
from simulate.errors.compare import distance
from simulate.errors.signals import spectrum
from simulate.marching.run import Outcome, march
from simulate.marching.setup import Setup, prepare
from simulate.marching.status import WITH_RESULT
from simulate.scene import Record, Scene

SAFETY = 3.0  # bound of the error over the change
# smaller values count as 0: m, but N for forces
LEAST = {"spectrum": 1e-9, "wear": 1e-9, "history": 1e-9, "states": 1e-9, "force_mean": 1e-2}
STATED = 0.1  # largest error bound of a run that is `ok`: above, it is `inaccurate`
NEAR = (STATED / 2, SAFETY * STATED)  # of a bound by half the step: a quarter of the step decides
CONTACT_CHANGE = 0.25  # relative, of the share of steps with contact: above, it is `inaccurate`

type Observables = dict[str, NDArray[np.float64]]


def finer(scene: Scene, rom: Rom, setup: Setup, times: int) -> Setup:
    """``setup`` with a step ``times`` shorter; more steps than a scene may have are allowed."""
    of_round = round(2 * np.pi / (setup.Omega * setup.h))
    fine = prepare(scene, rom, setup.Omega, times * of_round)
    return replace(fine, steps=times * setup.steps)


def observables(record: Record, outcome: Outcome) -> Observables:
    """What is recorded: displacements and worn depth, m; mean t_N on eighths of the chord, N."""
    last = record.samples_per_round * (record.spectrum_rounds or 0)
    found: Observables = {}
    if record.spectrum_rounds:
        found["spectrum"] = spectrum(outcome.u_r[-last:, 0])[1:]
    if record.wear:
        found["wear"] = outcome.wear
    if record.history:
        found["history"] = outcome.u_r[:, 1:]
    if record.states_rounds:
        found["states"] = outcome.states
    if record.contact_force:
        found["force_mean"] = outcome.force_mean.mean(axis=0)
    return found


def beside_halved(
    scene: Scene, rom: Rom, setup: Setup, outcome: Outcome
) -> tuple[Outcome, dict[str, float]]:
    """March with half the step: the run, and bounds of its relative errors by observable.

    With a quarter of the step, too, where the bounds are near 0.1, unless the run is `sensitive`.
    It is `inaccurate` where a bound exceeds 0.1, where its share of steps with contact changes by
    over a quarter, or where it and that with half the step end differently.
    """
    if outcome.status not in WITH_RESULT:
        return outcome, dict.fromkeys(observables(scene.record, outcome), inf)
    half = march(scene, finer(scene, rom, setup, 2))
    errors = bounds(scene, outcome, half)
    differ = half.status != outcome.status or _other_contact(scene, outcome, half)
    if not differ and NEAR[0] < max(errors.values()) <= NEAR[1]:
        quarter = march(scene, finer(scene, rom, setup, 4))
        errors = bounds(scene, outcome, half, quarter)
    if outcome.status != "sensitive" and (differ or not max(errors.values()) <= STATED):
        outcome = replace(outcome, status="inaccurate", reason="")
    return outcome, errors


def _other_contact(scene: Scene, outcome: Outcome, half: Outcome) -> bool:
    """Whether steps in contact are not twice as many at half the step."""
    shares = outcome.contact_share, half.contact_share
    chatters = scene.integrator.scheme == "central-difference"
    return not chatters and abs(shares[1] - shares[0]) > CONTACT_CHANGE * max(shares)


def bounds(
    scene: Scene, outcome: Outcome, half: Outcome, quarter: Outcome | None = None
) -> dict[str, float]:
    """Bounds of the relative errors of a run, from those with half and a quarter of its step.

    Infinite where one of these failed.
    """
    runs = (outcome, half) if quarter is None else (outcome, half, quarter)
    own, *others = (observables(scene.record, run) for run in runs)
    if any(run.status not in WITH_RESULT for run in runs):
        return dict.fromkeys(own, inf)
    from_last = changes(own, others[-1])
    if quarter is None:
        return {name: SAFETY * of for name, of in from_last.items()}
    of_last_halving = changes(*others)
    return {name: of + of_last_halving[name] for name, of in from_last.items()}


def changes(one: Observables, other: Observables) -> dict[str, float]:
    """Relative difference of each observable in L2 (``distance``), over ``LEAST`` at least."""
    return {
        name: distance(values, other[name], least=LEAST[name] * np.sqrt(values.size))
        for name, values in one.items()
    }
