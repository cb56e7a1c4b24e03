"""``accuracy``: step, density and strips that meet a relative error, and what each run errs by.

A pilot on the hardest speeds chooses them from what companions say there (``simulate.companion``),
and looks again at what it chose. Patches and natural modes are the reduced model's: a model that
errs by more than is asked is refused. Then each run of the sweep has a companion, coarser in all of
these; where that says more than was asked, a closer one of twice the step, then shorter steps; and
it is `sensitive` where these do not help. What the mesh errs by no run can tell: it is told beside,
from frequencies and compliances on a coarser mesh (``mesh-error.json``), and refused where it is
more than is asked.
"""

from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from math import ceil, isfinite, sqrt
from pathlib import Path
from typing import Any, Self

import numpy as np

from geometry.files import read_json
from geometry.provenance import ProvenanceError, anew
from rom.model import Rom
from rom.stored import opened
from simulate.companion import (
    Fineness,
    Models,
    Within,
    beside,
    closer,
    draft,
    model_apart,
    multiple,
    rods_apart,
    strips_apart,
    unlike_steps,
    with_settings,
)
from simulate.scene import Scene
from simulate.setup import SceneError, check_scene, edge_slope, least_gap

DRAFT_STEPS, LEAST_STEPS = 2048, 512  # per round
DRAFT_LENGTH = 1.5  # of a footprint, rods
DRAFT_STRIPS = 32  # half as many still err with their square near a peak, as 8 do not
SEEN = 0.1  # of the gap: what the tip's edge falls by over a rod of a draft
DRAFTED, HARDEST = 8, 2  # speeds, of at least three times as many
STEP_SHARE = 0.9  # of what strips and model leave; the rest is the density's: rods cost less
STRIP_SHARE = 0.4  # of what the model leaves
LEAST_LEFT = 0.2  # of the error, for step and density
MODEL_SHARE = 0.5  # of the error, of patches and natural modes at most
GROWTH = 4  # from one try to the next: errors go as they should only where they are small
AIM = 0.95  # of what is asked: other speeds may be as hard
TRIES, AGAIN, MOST_FINER = 5, 2, 2  # a pilot's, a run's, and how much finer these
SETTLES = 0.25  # least power of the step that an error goes with; 1 where steps are small
MOST_STEPS, MOST_RODS = 2**20, 2**21  # per round
LEAST_STRIPS, MOST_STRIPS = 8, 64  # eighths of the chord are told: strips by eights


@dataclass(frozen=True)
class Choice:
    """What a pilot has chosen, and why."""

    accuracy: float
    steps_per_round: int
    rods_per_round: int
    strips: int
    basis_error: float  # relative, of the reduced model itself, from its check
    mesh_error: float | None  # relative, of frequencies and compliances; None where it is not known
    model_error: float  # of patches and natural modes, in what is recorded, on a draft
    speeds: list[float]  # rad/s, of the pilot
    expected: float  # relative error there, from coarser drafts
    # largest error there, by observable, after the choice; None where runs end differently
    observed: dict[str, float | None]
    runs: dict[float, Within] = field(default_factory=dict, repr=False)  # by speed

    def plain(self) -> dict[str, Any]:
        """All but the runs, for files."""
        return {name: value for name, value in vars(self).items() if name != "runs"}

    @classmethod
    def load(cls, path: str | Path) -> Self:
        """Read what ``plain`` gives, as JSON."""
        return cls(**read_json(path))

    def scene(self, scene: Scene) -> Scene:
        """The scene with the settings that were chosen."""
        return with_settings(scene, self.fineness)

    @property
    def fineness(self) -> Fineness:
        """Steps, rods and strips."""
        return Fineness(self.steps_per_round, self.rods_per_round, self.strips)


def basis_error(check: str | Path, rom: Rom) -> float:
    """Largest relative error of a reduced model, frequencies and tip compliances, in its check.

    Raises
    ------
    geometry.provenance.ProvenanceError
        When there is no check, or it is of another model.
    """
    with opened(check) as (checked, provenance):
        provenance.require(rom.provenance, check)
        frequencies = abs(checked["reduced"] / checked["full"] - 1)
        return float(np.max([frequencies.max(), abs(checked["compliance_error"]).max()]))


def mesh_error(path: str | Path, rom: Rom) -> float | None:
    """What a file of ``rom.mesh_error`` tells of the mesh of a reduced model; None without it.

    Raises
    ------
    geometry.provenance.ProvenanceError
        When the file is of another mesh.
    """
    if not Path(path).is_file():
        return None
    told = read_json(path)
    if told["mesh"] != rom.provenance.mesh:
        raise ProvenanceError(f"{path}: of another mesh; {anew(path)}")
    return told["error"]


def require_model(accuracy: float, basis_error: float, mesh_error: float | None) -> None:
    """Refuse an accuracy that the reduced model or its mesh does not have.

    Raises
    ------
    SceneError
        With the error and the remedy.
    """
    if not basis_error <= accuracy:
        raise SceneError(
            f"accuracy: {accuracy:g}: the reduced model errs by {basis_error:.3g}; allowed from "
            f"that, or raise basis.natural_modes in the blade's file"
        )
    if mesh_error is not None and mesh_error > accuracy:
        raise SceneError(
            f"accuracy: {accuracy:g}: the mesh errs by {mesh_error:.3g} in frequencies or "
            f"compliances of the tip; allowed from that, or lower mesh.element_size_mm of the "
            f"blade"
        )


def choose(scene: Scene, rom: Rom, basis_error: float, mesh_error: float | None) -> Choice:
    """Choose step, density and strips for ``scene.accuracy`` on its hardest speeds.

    Raises
    ------
    SceneError
        When the scene does not fit the reduced model, or that model errs by more than is asked.
    """
    require_model(scene.accuracy, basis_error, mesh_error)
    models, steps = Models.of(rom), multiple(scene, DRAFT_STEPS)
    of_draft = Fineness(
        steps, unlike_steps(_draft_rods(scene, rom), steps), _draft_strips(scene, rom)
    )
    check_scene(with_settings(scene, of_draft), rom)
    drafts = _hardest(scene, models, of_draft)
    of_model = _error(model_apart(scene, models, run) for run in drafts)
    _require_interface(scene.accuracy, of_model)
    of_strips = _error(strips_apart(scene, models, run) for run in drafts)
    strips, of_strips = _strips(scene, rom, of_draft.strips, of_strips, of_model)
    left = scene.accuracy - of_model - of_strips
    of_step = _error(run.worst for run in drafts)
    of_rods = _error([rods_apart(scene, models, drafts[-1])])
    rods, runs = of_draft.rods, {run.setup.Omega: run for run in drafts}
    for _ in range(TRIES):
        finer, denser = _finer(scene, steps, of_step, left), _denser(rods, of_rods, left)
        denser = unlike_steps(denser, finer)
        growth = finer / steps
        of_step, of_rods = of_step / growth, of_rods * (rods / denser) ** 2
        steps, rods, expected = finer, denser, of_step + of_rods + of_strips + of_model
        before, now = runs, Fineness(steps, rods, strips)
        runs = {Omega: beside(scene, models, Omega, now) for Omega in runs}
        observed_error = _settling(before, runs, growth)
        if observed_error <= scene.accuracy or steps >= MOST_STEPS:
            break
        # what is too much is the step's and the density's: the others are as they are
        share = of_step / (of_step + of_rods) if of_step + of_rods > 0 else 1.0
        over = max(observed_error - of_strips - of_model, of_step + of_rods)
        of_step, of_rods = over * share, over * (1 - share)
    observed = {name: _observed(runs.values(), name) for name in scene.record.observables}
    return Choice(
        accuracy=scene.accuracy,
        steps_per_round=steps,
        rods_per_round=rods,
        strips=strips,
        basis_error=basis_error,
        mesh_error=mesh_error,
        model_error=of_model,
        speeds=list(runs),
        expected=expected,
        observed=observed,
        runs=runs,
    )


def _require_interface(accuracy: float, of_model: float) -> None:
    if of_model > MODEL_SHARE * accuracy:
        raise SceneError(
            f"accuracy: {accuracy:g}: patches and natural modes of the reduced model err by some "
            f"{of_model:.2g} in what the scene records; allowed {MODEL_SHARE:g} of what is asked: "
            f"raise interface.patches or basis.natural_modes in the blade's file"
        )


def _draft_strips(scene: Scene, rom: Rom) -> int:
    return min(DRAFT_STRIPS, len(rom.xi)) if scene.liner.rigid_key else DRAFT_STRIPS


def _strips(
    scene: Scene, rom: Rom, drafted: int, of_strips: float, of_model: float
) -> tuple[int, float]:
    """Strips whose error, which goes with their width squared, is its share; and that error.

    Raises
    ------
    SceneError
        When a rigid casing would need more than there are patches, or as many as are allowed leave
        too little of the error to step and density.
    """
    allowed = STRIP_SHARE * AIM * (scene.accuracy - of_model)
    needed = drafted * sqrt(of_strips / allowed)
    strips = int(min(max(LEAST_STRIPS * ceil(needed / LEAST_STRIPS), LEAST_STRIPS), MOST_STRIPS))
    if scene.liner.rigid_key and strips > len(rom.xi):
        raise SceneError(
            f"accuracy: {scene.accuracy:g}: needs {strips} strips, and a rigid casing "
            f"({scene.liner.rigid_key}) no more than the {len(rom.xi)} patches of the reduced "
            f"model: raise interface.patches in the blade's file"
        )
    of_strips *= (drafted / strips) ** 2
    if of_strips > (1 - LEAST_LEFT) * scene.accuracy - of_model:
        raise SceneError(
            f"accuracy: {scene.accuracy:g}: needs more than {MOST_STRIPS} strips, which would err "
            f"by {of_strips:.2g}: give integrator, liner.rods_per_round and liner.strips instead"
        )
    return strips, of_strips


def march_within(scene: Scene, rom: Rom, Omega: float, choice: Choice) -> Within:
    """March at ``Omega`` (rad/s), at shorter steps where needed; `sensitive` where not met."""
    models, run = Models.of(rom), choice.runs.get(Omega)
    run = run or beside(scene, models, Omega, choice.fineness)
    if run.worst > choice.accuracy:
        run = closer(scene, models, run)
    for _ in range(AGAIN):
        if run.worst <= choice.accuracy:
            return run
        finer = min(run.worst / choice.accuracy, MOST_FINER) / AIM
        steps = multiple(scene, finer * run.setup.steps)
        run = beside(scene, models, Omega, replace(choice.fineness, steps=steps))
    if run.outcome.status == "ok" and not run.worst <= choice.accuracy:
        return replace(run, outcome=replace(run.outcome, status="sensitive"))
    return run


def _hardest(scene: Scene, models: Models, fineness: Fineness) -> list[Within]:
    """Drafts at those of the scene's speeds where they err most by their step."""
    speeds = scene.speeds.omega(models.own.f1)
    most = min(DRAFTED, max(len(speeds) // 3, HARDEST))
    drafted = speeds[np.unique(np.linspace(0, len(speeds) - 1, most).round().astype(int))]
    drafts = [draft(scene, models, Omega, fineness) for Omega in drafted]
    return sorted(drafts, key=lambda run: run.worst)[-HARDEST:]


def _settling(before: dict[float, Within], now: dict[float, Within], growth: float) -> float:
    """Largest error where ``growth`` times the steps made it less: nothing settles chaos."""
    least = growth**SETTLES if growth > 1 else 0.0
    return _error([run.worst for k, run in now.items() if run.worst * least <= before[k].worst])


def _finer(scene: Scene, steps: int, error: float, left: float) -> int:
    """Steps per round at which an error that goes with the step is its share of what is left."""
    finer = min(error / (AIM * STEP_SHARE * left), GROWTH)
    return multiple(scene, min(max(finer * steps, LEAST_STEPS), MOST_STEPS))


def _denser(rods: int, error: float, left: float) -> int:
    """Rods per round at which an error that goes with their square is the rest of it."""
    denser = min(sqrt(error / (AIM * (1 - STEP_SHARE) * left)), GROWTH)
    return ceil(min(max(denser, 1.0) * rods, MOST_RODS))


def _draft_rods(scene: Scene, rom: Rom) -> int:
    """Rods of a draft: enough for the footprint, and to see the edge of a tilted tip."""
    around = 2 * np.pi * rom.camber[:, 0].max()
    gap = least_gap(scene, rom)
    edge = around * edge_slope(scene) / (SEEN * gap) if gap > 0 else 0.0
    return ceil(min(max(DRAFT_LENGTH * around / scene.liner.footprint_m, edge), MOST_RODS))


def _observed(runs: Iterable[Within], name: str) -> float | None:
    largest = max(run.errors[name] for run in runs)
    return largest if isfinite(largest) else None


def _error(errors: Iterable[float]) -> float:
    """The largest, 1 where runs end differently; 0 of none."""
    return max((min(error, 1.0) for error in errors), default=0.0)
