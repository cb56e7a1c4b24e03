"""Stress of a run at the worst node of its blade, as ``workflow.stress.write`` found it."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fem.worst_node import NodeStress
from geometry.base import known
from geometry.blade import Fatigue
from simulate.errors.observables import Numbers
from simulate.errors.run import Run
from simulate.marching.states import every

OF_STRESS = {"mean_stress", "alternating", "margin", "damage"}  # numbers of a peak


def at_node(stress: Mapping[str, Any], speed: int) -> NodeStress | None:
    """The stress over reduced displacements at the worst node of a speed; None if not told."""
    sigma, fatigue = stress["speeds"][speed].get("sigma"), stress["fatigue"]
    return sigma and NodeStress(np.array(sigma), fatigue and Fatigue.model_validate(fatigue))


def mesh_errors(stress: Mapping[str, Any], speed: int) -> Numbers:
    """Relative errors by the mesh there; that of the damage follows from the margin's."""
    errors, k = stress["speeds"][speed]["mesh"], (stress["fatigue"] or {}).get("slope_k")
    return errors | ({"damage": (1 - errors["margin"]) ** -k - 1} if k else {})


def through(at: NodeStress | None, T: NDArray[np.float64] | None) -> NodeStress | None:
    """The same over displacements u' (n',) of another model, u = T u'; the same without T."""
    if at is None or T is None:
        return at
    return NodeStress(np.vstack([at.sigma[:1], T.T @ at.sigma[1:]]), at.fatigue)


def stress_of(run: Run, at: NodeStress) -> Numbers:
    """Mean and alternating stress, Pa, and margin, of the worst revolution that a run keeps.

    And with a slope of the S-N line the damage of the run, whose states are all recorded.
    """
    outcome, record, setup = run.outcome, run.scene.record, run.setup
    states, samples = outcome.states, record.samples_per_round
    step = every(known(record.motion, "motion"), samples, setup.omega, setup.Omega)
    rounds = states.reshape(-1, samples, states.shape[1])[:, step - 1 :: step]
    strained = outcome.strained[outcome.strained_rounds > 0]
    of_rounds = map(with_rotation, [*rounds, *strained])
    slope = at.fatigue and at.fatigue.slope_k
    return at.worst(of_rounds) | ({"damage": at.damage(with_rotation(states))} if slope else {})


def with_rotation(u: NDArray[np.float64]) -> NDArray[np.float64]:
    """Amplitudes (times, 1 + n) of displacements (times, n): 1, of rotation, before them."""
    return np.hstack([np.ones((len(u), 1)), u])
