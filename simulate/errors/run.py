"""Runs: the inputs of each, and its errors and departures."""

from dataclasses import dataclass, field, replace
from math import ceil

import numpy as np

from rom.model import Rom
from simulate.errors.neighbour import Neighbour
from simulate.marching import AnyEnd, Outcome, Setup, march, prepare
from simulate.scene import Scene


def as_long(scene: Scene, rounds: float) -> Scene:
    """The scene without `until`, for as many ``rounds`` as a run of it took.

    Of a run that broke off the last is whole, and there are as many as the spectrum needs.
    """
    if scene.until is None:
        return scene
    whole = max(ceil(rounds), scene.record.rounds_of_spectrum)
    states = min(scene.record.states_rounds or 0, whole) or None
    return scene.but(until=None, rounds=whole, record__states_rounds=states)


@dataclass(frozen=True)
class Case:
    """Inputs of a run."""

    scene: Scene
    rom: Rom
    setup: Setup
    start: AnyEnd | None = None  # start of the run

    @property
    def steps_of_a_turn(self) -> int:
        """Steps in which the blade turns once."""
        return round(2 * np.pi / (self.setup.Omega * self.setup.h))

    def neighbour(self, other: Neighbour) -> "Case":
        """The case of a second run.

        Raises
        ------
        simulate.marching.setup.SceneError
            As ``prepare``.
        """
        scene, rom, setup = other.scene(self.scene), other.rom(self.rom), self.setup
        if scene is not self.scene or rom is not self.rom or other.steps != 1:
            Omega, steps = setup.Omega, None
            if other.along:
                Omega = min(Omega * rom.f1 / self.rom.f1, rom.Omega_m)
            # more steps than a scene may ask for are allowed; a blade of its own, or other settings
            # at no other number of steps, have their own step
            if other.blade is None and (scene is self.scene or other.steps != 1):
                steps = round(other.steps * self.steps_of_a_turn)
            made = prepare(scene, rom, Omega, steps)
            setup = replace(made, steps=round(other.steps * setup.steps)) if steps else made
        return Case(scene, rom, other.setup(setup), self.start)

    def march(self) -> "Run":
        """Run the case."""
        return Run(**vars(self), outcome=march(self.scene, self.setup, self.start))


@dataclass(frozen=True, kw_only=True)
class Run(Case):
    """A run that is done, with the findings of its second runs."""

    outcome: Outcome
    departures: dict[str, float] = field(default_factory=dict)  # from a twin, by observable
    errors: dict[str, float] = field(default_factory=dict)  # relative, by observable; where known
    steps: float = 0.0  # of the run and of those beside it; 0 before ``judged``
    seconds: float = 0.0  # wall time of the run and of those beside it

    def neighbour(self, other: Neighbour) -> Case:
        """As of a case, for as many revolutions as the run took."""
        scene = as_long(self.scene, self.outcome.rounds)
        if scene.stage:  # whose worst blade may be another one
            scene = scene.but(record={"blades": "all"})
        return Case(scene, self.rom, self.setup, self.start).neighbour(other)

    @property
    def largest_error(self) -> float:
        """Largest error of all observables; inf where run and companion end differently."""
        return max(self.errors.values())

    @property
    def line(self) -> str:
        """Speed, status and why, whether it is steady, and wall time, for logs."""
        why = f" ({self.outcome.reason})" if self.outcome.reason else ""
        end = f"{self.outcome.status}{why}, {self.outcome.trend}"
        blades = len(self.outcome.blades)
        worst = f"blade {self.outcome.worst} of {blades}: " if blades else ""
        return f"{self.setup.Omega:.6g} rad/s: {worst}{end}, {self.seconds:.2f} s"
