"""Marches of one case: as drawn, at half its step, and at a fine one; each of the same stretch.

A case is marched for as long as its reference can be afforded: some rounds, or the first part of
one, which is marched as a round of that many steps.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from geometry.settings import check_settings
from rom.model import Rom
from simulate.run import Outcome, Setup, check_scene, march, prepare
from simulate.scene import CentralDifference, PiecewiseExact, Scene
from workflow.study.stability_cases import EXACT, EXPLICIT, SAMPLES, Case

FINE = 0.1  # step of the reference over the limit, at most,
FINER = 8  # and at least so many times finer than the case's,
FINEST = 5000  # but no more: for steps of more than 500 limits


@dataclass(frozen=True)
class Budget:
    """What may be spent on a case."""

    limits: float = 3e4  # time marched over the limit step
    steps: float = 4e5  # of the reference
    rods: float = 1.5e8  # met by the reference


@dataclass(frozen=True)
class Stretch:
    """What of a case is marched."""

    rounds: int
    part: float  # of a round: 1, or less where rounds is 1


@dataclass(frozen=True)
class Ready:
    """A case that its scene and scheme take."""

    case: Case
    rom: Rom
    scene: Scene
    setup: Setup
    limit: float  # s, of central differences


def ready(case: Case, rom: Rom) -> Ready:
    """Check and prepare as a sweep does.

    Raises
    ------
    SettingsError, SceneError
        Where the case is refused.
    """
    limit = _limit(case, rom)
    scene = _scene(case, _integrator(case, rom, limit))
    check_scene(scene, rom)
    return Ready(case, rom, scene, prepare(scene, rom, _speed(scene, rom)), limit)


def _scene(case: Case, integrator: Mapping[str, Any]) -> Scene:
    return check_settings(Scene, {**case.scene, "integrator": integrator}, "scene.yaml")


def _speed(scene: Scene, rom: Rom) -> float:
    return float(scene.speeds.omega(rom.f1)[0])


def _limit(case: Case, rom: Rom) -> float:
    """Limit of central differences, s; of the free blade where the liner is rigid."""
    step = {"scheme": EXACT, "steps_per_round": SAMPLES}
    scene = _scene(case, step | _mass_scaling(case))
    check_scene(scene, rom)
    setup = prepare(scene, rom, _speed(scene, rom))
    return setup.limit or 2 / setup.omega.max()


def _mass_scaling(case: Case) -> dict[str, float]:
    return {} if case.mass_scaling_hz is None else {"mass_scaling_hz": case.mass_scaling_hz}


def _integrator(case: Case, rom: Rom, limit: float) -> dict[str, Any]:
    if case.scheme == EXPLICIT and case.as_fraction:
        step = {"fraction_of_limit": case.step_over_limit}
    else:
        round_time = 1 / (case.scene["speeds"]["over_f1"][0] * rom.f1)
        steps = round_time / (case.step_over_limit * limit) / SAMPLES
        step = {"steps_per_round": max(round(steps), 1) * SAMPLES}
    return {"scheme": case.scheme} | step | _mass_scaling(case)


def refinement(of: Ready) -> int:
    """How many times finer the reference is than the case."""
    return min(max(FINER, int(np.ceil(of.setup.h / (FINE * of.limit)))), FINEST)


def stretch(of: Ready, budget: Budget) -> Stretch:
    """As much of the case's rounds as the budget has room for; at least SAMPLES steps."""
    fine = of.setup.h / refinement(of)
    rods = len(of.setup.radial) * (of.setup.strips.m + 10)  # 10: what a node costs without
    time = min(budget.limits * of.limit, fine * min(budget.steps, budget.rods / rods))
    rounds = int(time / (of.setup.h * of.setup.steps))
    if rounds >= 1:
        return Stretch(min(rounds, of.scene.rounds), 1.0)
    steps = max(int(time / of.setup.h / SAMPLES), 1) * SAMPLES
    return Stretch(1, steps / of.setup.steps)


def at(of: Ready, span: Stretch, scheme: str, finer: int = 1) -> tuple[Scene, Setup]:
    """The stretch of the case by a scheme at a finer step, past what a scene file may ask for."""
    steps = of.setup.steps * finer
    fields = {"steps_per_round": steps, **_mass_scaling(of.case)}
    casing = of.scene.casing.model_copy(update={"ramp_rounds": of.case.ramp * span.rounds})
    changes = {
        "rounds": span.rounds,
        "casing": casing,
        "integrator": PiecewiseExact.model_construct(scheme=EXACT, **fields),
    }
    scene = of.scene.model_copy(update=changes)
    setup = prepare(scene, of.rom, of.setup.Omega)
    if scheme == EXPLICIT:
        explicit = CentralDifference.model_construct(scheme=EXPLICIT, **fields)
        scene = scene.model_copy(update={"integrator": explicit})
    return scene, replace(setup, steps=round(steps * span.part))


def run(of: Ready, span: Stretch, scheme: str, finer: int = 1) -> Outcome:
    """March it."""
    return march(*at(of, span, scheme, finer))


def observables(outcome: Outcome) -> dict[str, float]:
    """Largest displacement, m, wear, m summed over the rods, mean force, N; of all nodes."""
    return {
        "displacement": float(np.nanmax(np.abs(outcome.u_r))),
        "wear": float(outcome.wear.sum()),
        "force": float(np.nansum(outcome.force_mean) / len(outcome.force_mean)),
    }


def distance(values: Mapping[str, float], *others: Mapping[str, float]) -> dict[str, float]:
    """How far values lie outside what others span, relative to the largest of them."""
    return {name: _distance(value, [o[name] for o in others]) for name, value in values.items()}


def _distance(value: float, others: list[float]) -> float:
    away = max(min(others) - value, value - max(others), 0.0)
    return away / max(abs(value), *map(abs, others)) if away else 0.0
