"""What a run's step costs it, measured: what its observables change by when the step is halved.

Both schemes are of order one in contact, so half of the step takes half of the error away. Twice
the change is the error of the run, and half as much again a bound that nearly all keep (Roache
1994, grid convergence index). What the ledger calls lost tells of steps so long that those of half
their length do no better.
"""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from rom.model import Rom
from simulate.run import Outcome, Setup, march, prepare
from simulate.scene import PiecewiseExact, Scene

SAFETY = 3  # times the change
LEAST = 0.05  # error that is stated: two steps do not tell a smaller one
ALLOWED = 0.1  # stated error beyond which a run is `inaccurate`


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
    """March a run at half its step: the run, `inaccurate` where it is, and its stated errors.

    The scene records a history and the contact force.
    """
    half = march(scene, finer(scene, rom, setup, 2))
    errors = stated_errors(observables(outcome), observables(half))
    if outcome.status == "ok" and (half.status != "ok" or max(errors.values()) > ALLOWED):
        outcome = replace(outcome, status="inaccurate")
    return outcome, errors


def stated_errors(values: Mapping[str, float], at_half: Mapping[str, float]) -> dict[str, float]:
    """Relative error of each value, from the same at half the step."""
    return {name: max(SAFETY * relative(values[name], at_half[name]), LEAST) for name in values}


def relative(value: float, other: float) -> float:
    """Difference over the larger of the two; 0 where both are 0."""
    return abs(value - other) / max(abs(value), abs(other)) if value != other else 0.0
