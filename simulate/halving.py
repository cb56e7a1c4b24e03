"""What a run's step costs it: what its observables change by when the step is halved.

Both schemes are of order one in contact, so half of the step takes half of the error away. Twice
the change is the error of the run, and half as much again a bound that nearly all keep (Roache
1994, grid convergence index). The ledger tells of steps so long that those of half their length do
no better.
"""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from rom.model import Rom
from simulate.run import Outcome, Setup, march, prepare
from simulate.scene import PiecewiseExact, Scene

SAFETY = 3  # times the change
LEAST = {"displacement": 1e-9, "wear": 1e-9, "force": 1e-2}  # m, m, N: what is less is nothing
STATED = 0.1  # error of a run that is `ok`: beyond, it is `inaccurate`


def finer(scene: Scene, rom: Rom, setup: Setup, times: int) -> Setup:
    """The march of ``setup`` at a step ``times`` shorter, also past what a scene may ask for."""
    of_round = round(2 * np.pi / (setup.Omega * setup.h))
    integrator = PiecewiseExact.model_construct(  # the scheme whose set-up has no limits
        scheme="piecewise-exact",
        steps_per_round=times * of_round,
        mass_scaling_hz=scene.integrator.mass_scaling_hz,
    )
    fine = prepare(scene.model_copy(update={"integrator": integrator}), rom, setup.Omega)
    return replace(fine, steps=times * setup.steps)


def observables(outcome: Outcome) -> dict[str, float]:
    """Largest displacement kept, m; wear summed over all rods, m; mean force of all nodes, N."""
    return {
        "displacement": float(np.nanmax(np.abs(outcome.u_r))),
        "wear": float(outcome.wear.sum()),
        "force": float(np.nansum(outcome.force_mean) / len(outcome.force_mean)),
    }


def beside_halved(
    scene: Scene, rom: Rom, setup: Setup, outcome: Outcome
) -> tuple[Outcome, dict[str, float]]:
    """March a run at half its step: the run, `inaccurate` where it is, and what has changed.

    The scene records a history and the contact force.
    """
    half = march(scene, finer(scene, rom, setup, 2))
    found = changes(observables(outcome), observables(half))
    too_far = half.status != "ok" or SAFETY * max(found.values()) > STATED
    if outcome.status == "ok" and too_far:
        outcome = replace(outcome, status="inaccurate")
    return outcome, found


def changes(values: Mapping[str, float], others: Mapping[str, float]) -> dict[str, float]:
    """Difference of each over the larger of the two, or over ``LEAST`` where that is more."""
    return {
        name: abs(value - others[name]) / max(abs(value), abs(others[name]), LEAST[name])
        for name, value in values.items()
    }
