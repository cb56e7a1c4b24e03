"""What a run's step costs it: what its observables change by when the step is halved.

Both schemes are of order one in contact, so half of the step takes half of the error away. Twice
the change is the error of the run, and half as much again a bound that nearly all keep (Roache
1994, grid convergence index). The ledger tells of steps so long that those of half their length do
no better.
"""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from rom.model import Rom
from simulate.compare import distance
from simulate.run import Outcome, march
from simulate.scene import Scene
from simulate.setup import Setup, prepare

SAFETY = 3  # times the change
LEAST = {"displacement": 1e-9, "wear": 1e-9, "force": 1e-2}  # m, m, N: what is less is nothing
STATED = 0.1  # error of a run that is `ok`: beyond, it is `inaccurate`


def finer(scene: Scene, rom: Rom, setup: Setup, times: int) -> Setup:
    """The march of ``setup`` at a step ``times`` shorter, also past what a scene may ask for."""
    of_round = round(2 * np.pi / (setup.Omega * setup.h))
    fine = prepare(scene, rom, setup.Omega, times * of_round)
    return replace(fine, steps=times * setup.steps)


type Observables = dict[str, NDArray[np.float64]]


def observables(outcome: Outcome) -> Observables:
    """u_r at every place and sample, m; worn depth of every rod, m; mean force on eighths, N."""
    return {
        "displacement": outcome.u_r,
        "wear": outcome.wear,
        "force": outcome.force_mean.mean(axis=0),
    }


def beside_halved(
    scene: Scene, rom: Rom, setup: Setup, outcome: Outcome
) -> tuple[Outcome, dict[str, float]]:
    """March a run at half its step: the run, `inaccurate` where it is, and what has changed.

    The scene records a history and the contact force.
    """
    half = march(scene, finer(scene, rom, setup, 2))
    changed_by = changes(observables(outcome), observables(half))
    too_far = half.status != "ok" or not SAFETY * max(changed_by.values()) <= STATED
    if outcome.status == "ok" and too_far:
        outcome = replace(outcome, status="inaccurate")
    return outcome, changed_by


def changes(one: Observables, other: Observables) -> dict[str, float]:
    """Difference of each over the larger of the two, or over ``LEAST`` where that is more; L2."""
    return {
        name: distance(values, other[name], least=LEAST[name] * np.sqrt(values.size))
        for name, values in one.items()
    }
