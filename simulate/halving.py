"""Error of a run due to its step, from a second run with half the step.

Central differences are of order one in contact: halving the step halves the error, so that the
error is twice the change. Three times the change is taken as its bound (Roache 1994, grid
convergence index: safety factor 1.5). Piecewise-exact is of order two: its error is 4/3 of the
change, and the same bound has a safety factor of 2.25, as on hard liners its order is lower at long
steps. Steps too long for this estimate show as numerical energy in the ledger.
"""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from rom.model import Rom
from simulate.compare import distance
from simulate.run import Outcome, march
from simulate.scene import Scene
from simulate.setup import Setup, prepare

SAFETY = 3  # bound of the error over the change
LEAST = {"displacement": 1e-9, "wear": 1e-9, "force": 1e-2}  # m, m, N: smaller values count as 0
STATED = 0.1  # largest error bound of a run that is `ok`: above, it is `inaccurate`


def finer(scene: Scene, rom: Rom, setup: Setup, times: int) -> Setup:
    """``setup`` with a step ``times`` shorter; more steps than a scene may have are allowed."""
    of_round = round(2 * np.pi / (setup.Omega * setup.h))
    fine = prepare(scene, rom, setup.Omega, times * of_round)
    return replace(fine, steps=times * setup.steps)


type Observables = dict[str, NDArray[np.float64]]


def observables(outcome: Outcome) -> Observables:
    """u_r (samples, places), m; worn depth (m, nu), m; mean t_N on eighths of the chord (8,), N."""
    return {
        "displacement": outcome.u_r,
        "wear": outcome.wear,
        "force": outcome.force_mean.mean(axis=0),
    }


def beside_halved(
    scene: Scene, rom: Rom, setup: Setup, outcome: Outcome
) -> tuple[Outcome, dict[str, float]]:
    """March with half the step: the run, `inaccurate` where the bound exceeds 0.1, and the changes.

    The scene must record a history and the contact force.
    """
    half = march(scene, finer(scene, rom, setup, 2))
    changed_by = changes(observables(outcome), observables(half))
    too_far = half.status != "ok" or not SAFETY * max(changed_by.values()) <= STATED
    if outcome.status == "ok" and too_far:
        outcome = replace(outcome, status="inaccurate")
    return outcome, changed_by


def changes(one: Observables, other: Observables) -> dict[str, float]:
    """Relative difference of each observable in L2 (``distance``), over ``LEAST`` at least."""
    return {
        name: distance(values, other[name], least=LEAST[name] * np.sqrt(values.size))
        for name, values in one.items()
    }
