"""Runs of one case: with its own step, and its references with a fine step, over the same time.

The time marched is limited by the cost of the references: some rounds, or the first part of one
round, which is then marched as a round of fewer steps.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from geometry.settings import check_settings
from rom.model import Rom
from simulate.halving import finer
from simulate.run import Outcome, march
from simulate.scene import CentralDifference, PiecewiseExact, Scene
from simulate.setup import Setup, check_scene, prepare
from workflow.study.stability.cases import EXACT, EXPLICIT, SAMPLES, Case

FINE = 0.1  # largest step of the references over the limit
FINER, FINEST = 8, 5000  # least and largest ratio of the case's step to that of the references
# Bounds of the cost of a case
LIMITS = 3e4  # time marched over the limit step
STEPS = 4e5  # of a reference
RODS = 1.5e8  # rods passed in all steps of a reference


@dataclass(frozen=True)
class Ready:
    """A valid case: its scene and set-up, cut to the time that is marched."""

    rom: Rom
    scene: Scene
    setup: Setup
    finer: int  # ratio of its step to that of the references


def ready(case: Case, rom: Rom) -> Ready:
    """Check and prepare a case as a sweep does, and cut the time marched to bound its cost.

    Raises
    ------
    SettingsError, SceneError
        When the case is refused.
    """
    without = {**case.scene, "contact": {**case.scene["contact"], "friction": None}}
    any_step = {"scheme": EXACT, "steps_per_round": SAMPLES}
    _, setup = _prepared(replace(case, scene=without), rom, any_step)
    limit = setup.limit or 2 / setup.omega.max()  # of the free blade for a rigid liner
    scene, setup = _prepared(case, rom, _integrator(case, rom, limit))
    times = min(max(FINER, int(np.ceil(setup.h / (FINE * limit)))), FINEST)
    return _cut(case, Ready(rom, scene, setup, times), _seconds(limit, setup, times))


def _prepared(case: Case, rom: Rom, integrator: Mapping[str, Any]) -> tuple[Scene, Setup]:
    """The case's scene and set-up with an integrator, checked."""
    scaled = {**integrator, "mass_scaling_hz": case.mass_scaling_hz}
    values = {**case.scene, "blade": rom.provenance.blade, "integrator": scaled}
    scene = check_settings(Scene, values, "scene.yaml")
    check_scene(scene, rom)
    return scene, prepare(scene, rom, float(scene.speeds.omega(rom.f1)[0]))


def _integrator(case: Case, rom: Rom, limit: float) -> dict[str, Any]:
    """Settings of the integrator; ``limit`` of central differences, s."""
    if case.scheme == EXPLICIT and case.as_fraction:
        step = {"fraction_of_limit": case.step_over_limit}
    else:
        round_time = 1 / (case.scene["speeds"]["over_f1"][0] * rom.f1)
        steps = round_time / (case.step_over_limit * limit) / SAMPLES
        step = {"steps_per_round": max(round(steps), 1) * SAMPLES}
    return {"scheme": case.scheme} | step


def _seconds(limit: float, setup: Setup, times: int) -> float:
    """Simulated time that may be marched, s."""
    rods = len(setup.strips.g0) * (setup.strips.rods_covered + 10)  # 10: cost of a strip without
    return min(LIMITS * limit, setup.h / times * min(STEPS, RODS / rods))


def _cut(case: Case, of: Ready, seconds: float) -> Ready:
    """Cut to the rounds, or the part of the first, within ``seconds``; at least SAMPLES steps."""
    rounds = min(int(seconds / (of.setup.h * of.setup.steps)), of.scene.rounds)
    steps = of.setup.steps
    if rounds == 0:
        rounds, steps = 1, min(max(int(seconds / of.setup.h / SAMPLES), 1) * SAMPLES, steps)
    scene = of.scene.but(rounds=rounds, **case.grows(rounds))
    return replace(of, scene=scene, setup=replace(of.setup, steps=steps))


def references(of: Ready) -> tuple[Outcome, Outcome]:
    """Runs with a fine step by both schemes; by piecewise-exact alone at two steps.

    This for a rigid liner, and with friction.
    """
    exact = _by(EXACT, of, of.finer)
    if of.scene.liner.rigid_key or of.scene.contact.friction is not None:
        return exact, _by(EXACT, of, 2 * of.finer)
    return exact, _by(EXPLICIT, of, of.finer)


def _by(scheme: str, of: Ready, times: int) -> Outcome:
    """March by ``scheme`` with a step ``times`` shorter."""
    by = CentralDifference if scheme == EXPLICIT else PiecewiseExact
    scaled = of.scene.integrator.mass_scaling_hz
    # steps_per_round is replaced by the steps of the set-up
    of_scheme = by(scheme=scheme, steps_per_round=SAMPLES, mass_scaling_hz=scaled)
    scene = of.scene.but(integrator=of_scheme)
    return march(scene, finer(scene, of.rom, of.setup, times))
