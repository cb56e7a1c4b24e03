"""Key ``accuracy`` of a scene: choice of step, density and strips, and the error of each run.

Step, density and strips are chosen from pilot runs at the speeds where errors are largest; coarser
companion runs estimate the errors (``simulate.companion``), again with the values chosen. Patches
and natural modes belong to the reduced model: one whose error exceeds the accuracy is refused. Each
run of the sweep then has a companion that is coarser in all of these. If the estimated error
exceeds the accuracy, a companion of twice the step refines the estimate, then the run is repeated
with shorter steps; if it still does, the run is `sensitive`. The error of the mesh is estimated
separately, from frequencies and compliances on a coarser mesh (``mesh-error.json``); a mesh whose
error exceeds the accuracy is refused.
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
    RunWithError,
    error_of_model,
    error_of_rods,
    error_of_strips,
    incommensurate_rods,
    march_with_error,
    march_with_step_error,
    multiple_of_samples,
    refine_estimate,
    with_settings,
)
from simulate.scene import Scene
from simulate.setup import SceneError, check_scene, edge_slope, least_gap

PRELIMINARY_STEPS, LEAST_STEPS = 1024, 512  # per round
PRELIMINARY_LENGTH = 1.5  # least length of a footprint, rods
PRELIMINARY_STRIPS = (
    32  # the error of 16 strips is still of second order near a peak, of 8 it is not
)
EDGE_FALL = 0.1  # of the gap: largest fall of the tip's edge over a rod of a preliminary run
PRELIMINARY_SPEEDS, HARDEST = 8, 2  # number of speeds; the first at most a third of the scene's
STEP_SHARE = 0.9  # of the error left by strips and model; the rest is the density's: rods cost less
STRIP_SHARE = 0.4  # of the error left by the model
LEAST_REMAINING = 0.2  # share of the error kept for step and density
MODEL_SHARE = 0.5  # largest share of the error for patches and natural modes
MOST_GROWTH = 4  # of steps and rods from one try to the next: orders hold for small errors only
TARGET = 0.95  # of the accuracy: errors at other speeds may be larger
TRIES = 5  # of the pilot
REPEATS, MOST_REFINED = 2, 2  # of a run with shorter steps, and how much shorter each time
LEAST_ORDER = 0.25  # least order in the step of a converging error; 2 for small steps
MOST_STEPS, MOST_RODS = 2**20, 2**21  # per round
LEAST_STRIPS, MOST_STRIPS = 8, 64  # multiples of 8: outputs are means over eighths of the chord


@dataclass(frozen=True)
class Choice:
    """Step, density and strips chosen by the pilot, with the errors that they are chosen by."""

    accuracy: float
    steps_per_round: int
    rods_per_round: int
    strips: int
    basis_error: float  # relative error of the reduced model, from its check
    mesh_error: float | None  # relative, of frequencies and compliances; None where it is not known
    model_error: float  # relative error of the observables due to patches and natural modes
    speeds: list[float]  # rad/s, of the pilot
    expected: float  # relative error at these speeds, extrapolated from the tries before
    # largest error at these speeds with the choice, by observable; None where runs end differently
    observed: dict[str, float | None]
    runs: dict[float, RunWithError] = field(default_factory=dict, repr=False)  # by speed

    def plain(self) -> dict[str, Any]:
        """All fields but the runs, as plain values for JSON."""
        return {name: value for name, value in vars(self).items() if name != "runs"}

    @classmethod
    def load(cls, path: str | Path) -> Self:
        """Read a JSON file of ``plain``."""
        return cls(**read_json(path))

    def scene(self, scene: Scene) -> Scene:
        """The scene with the chosen settings."""
        return with_settings(scene, self.fineness)

    @property
    def fineness(self) -> Fineness:
        """The chosen steps, rods and strips."""
        return Fineness(self.steps_per_round, self.rods_per_round, self.strips)


def basis_error(check: str | Path, rom: Rom) -> float:
    """Largest relative error of frequencies and tip compliances in the check of a reduced model.

    Raises
    ------
    geometry.provenance.ProvenanceError
        When there is no check, or it belongs to another model.
    """
    with opened(check) as (checked, provenance):
        provenance.require(rom.provenance, check)
        frequencies = abs(checked["reduced"] / checked["full"] - 1)
        return float(np.max([frequencies.max(), abs(checked["compliance_error"]).max()]))


def mesh_error(path: str | Path, rom: Rom) -> float | None:
    """Relative error of the mesh of a reduced model, read from ``path``; None without the file.

    Raises
    ------
    geometry.provenance.ProvenanceError
        When the file belongs to another mesh.
    """
    if not Path(path).is_file():
        return None
    values = read_json(path)
    if values["mesh"] != rom.provenance.mesh:
        raise ProvenanceError(f"{path}: belongs to another mesh; {anew(path)}")
    return values["error"]


def require_model(accuracy: float, basis_error: float, mesh_error: float | None) -> None:
    """Refuse an accuracy below the error of the reduced model or of its mesh.

    Raises
    ------
    SceneError
        If it is; the message names the error and the remedy.
    """
    if not basis_error <= accuracy:
        raise SceneError(
            f"accuracy: {accuracy:g}: the relative error of the reduced model is "
            f"{basis_error:.3g}; allowed from that value, or raise basis.natural_modes in the "
            f"blade's file"
        )
    if mesh_error is not None and mesh_error > accuracy:
        raise SceneError(
            f"accuracy: {accuracy:g}: the relative error of the mesh is {mesh_error:.3g}, in "
            f"frequencies or compliances of the tip; allowed from that value, or lower "
            f"mesh.element_size_mm in the blade's file"
        )


def choose(scene: Scene, rom: Rom, basis_error: float, mesh_error: float | None) -> Choice:
    """Choose step, density and strips for ``scene.accuracy`` at the speeds with the largest errors.

    Raises
    ------
    SceneError
        When the scene does not fit the reduced model, or the error of the model, of its mesh or of
        the most strips allowed leaves too little of the accuracy.
    """
    require_model(scene.accuracy, basis_error, mesh_error)
    models, steps = Models.of(rom), multiple_of_samples(scene, PRELIMINARY_STEPS)
    preliminary = Fineness(
        steps,
        incommensurate_rods(_preliminary_rods(scene, rom), steps),
        _preliminary_strips(scene, rom),
    )
    check_scene(with_settings(scene, preliminary), rom)
    drafts = _hardest(scene, models, preliminary)
    of_model = _error(error_of_model(scene, models, run) for run in drafts)
    _require_interface(scene.accuracy, of_model)
    of_strips = _error(error_of_strips(scene, models, run) for run in drafts)
    strips, of_strips = _strips_for(scene, rom, preliminary.strips, of_strips, of_model)
    left = scene.accuracy - of_model - of_strips
    of_step = _error(run.largest_error for run in drafts)
    of_rods = _error([error_of_rods(scene, models, drafts[-1])])
    rods, runs = preliminary.rods, {run.setup.Omega: run for run in drafts}
    for _ in range(TRIES):
        finer, denser = _steps_for(scene, steps, of_step, left), _rods_for(rods, of_rods, left)
        denser = incommensurate_rods(denser, finer)
        growth = finer / steps
        of_step, of_rods = of_step / growth**2, of_rods * (rods / denser) ** 2
        steps, rods, expected = finer, denser, of_step + of_rods + of_strips + of_model
        before, now = runs, Fineness(steps, rods, strips)
        runs = {Omega: march_with_error(scene, models, Omega, now) for Omega in runs}
        observed_error = _largest_converging_error(before, runs, growth)
        if observed_error <= scene.accuracy or steps >= MOST_STEPS:
            break
        # the excess is ascribed to step and density: the errors of strips and model are fixed
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
            f"accuracy: {accuracy:g}: patches and natural modes of the reduced model cause a "
            f"relative error of about {of_model:.2g} in the recorded outputs; allowed up to "
            f"{MODEL_SHARE:g} of the accuracy: raise interface.patches or basis.natural_modes in "
            f"the blade's file"
        )


def _preliminary_strips(scene: Scene, rom: Rom) -> int:
    return min(PRELIMINARY_STRIPS, len(rom.xi)) if scene.liner.rigid_key else PRELIMINARY_STRIPS


def _strips_for(
    scene: Scene, rom: Rom, drafted: int, of_strips: float, of_model: float
) -> tuple[int, float]:
    """Number of strips whose error, of second order in their width, is its share; and that error.

    Raises
    ------
    SceneError
        When a rigid casing would need more strips than there are patches, or the most strips
        allowed leave too little of the error to step and density.
    """
    allowed = STRIP_SHARE * TARGET * (scene.accuracy - of_model)
    needed = drafted * sqrt(of_strips / allowed)
    strips = int(min(max(LEAST_STRIPS * ceil(needed / LEAST_STRIPS), LEAST_STRIPS), MOST_STRIPS))
    if scene.liner.rigid_key and strips > len(rom.xi):
        raise SceneError(
            f"accuracy: {scene.accuracy:g}: needs {strips} strips; against a rigid casing "
            f"({scene.liner.rigid_key}) at most as many as the {len(rom.xi)} patches of the "
            f"reduced model are allowed: raise interface.patches in the blade's file"
        )
    of_strips *= (drafted / strips) ** 2
    if of_strips > (1 - LEAST_REMAINING) * scene.accuracy - of_model:
        raise SceneError(
            f"accuracy: {scene.accuracy:g}: needs more than {MOST_STRIPS} strips, whose relative "
            f"error is {of_strips:.2g}: give integrator, liner.rods_per_round and liner.strips "
            f"instead"
        )
    return strips, of_strips


def march_to_accuracy(scene: Scene, rom: Rom, Omega: float, choice: Choice) -> RunWithError:
    """March at ``Omega`` (rad/s), with shorter steps where the accuracy needs them.

    A run that ends ok but does not meet the accuracy gets the status `sensitive`.
    """
    models, run = Models.of(rom), choice.runs.get(Omega)
    run = run or march_with_error(scene, models, Omega, choice.fineness)
    if run.largest_error > choice.accuracy:
        run = refine_estimate(scene, models, run)
    for _ in range(REPEATS):
        if run.largest_error <= choice.accuracy:
            return run
        finer = min(run.largest_error / choice.accuracy, MOST_REFINED) / TARGET
        steps = multiple_of_samples(scene, finer * run.setup.steps)
        run = march_with_error(scene, models, Omega, replace(choice.fineness, steps=steps))
    if run.outcome.status == "ok" and not run.largest_error <= choice.accuracy:
        return replace(run, outcome=replace(run.outcome, status="sensitive"))
    return run


def _hardest(scene: Scene, models: Models, fineness: Fineness) -> list[RunWithError]:
    """Preliminary runs at the ``HARDEST`` speeds: those with the largest errors of the step."""
    speeds = scene.speeds.omega(models.own.f1)
    most = min(PRELIMINARY_SPEEDS, max(len(speeds) // 3, HARDEST))
    some = speeds[np.unique(np.linspace(0, len(speeds) - 1, most).round().astype(int))]
    runs = [march_with_step_error(scene, models, Omega, fineness) for Omega in some]
    return sorted(runs, key=lambda run: run.largest_error)[-HARDEST:]


def _largest_converging_error(
    before: dict[float, RunWithError], now: dict[float, RunWithError], growth: float
) -> float:
    """Largest error of the runs whose error falls with ``growth`` times the steps.

    Chaotic motion does not converge with the step: such runs are left out.
    """
    least = growth**LEAST_ORDER if growth > 1 else 0.0
    return _error(
        [
            run.largest_error
            for k, run in now.items()
            if run.largest_error * least <= before[k].largest_error
        ]
    )


def _steps_for(scene: Scene, steps: int, error: float, left: float) -> int:
    """Steps per round whose error, of second order, is its share of the error ``left``."""
    finer = min(sqrt(error / (TARGET * STEP_SHARE * left)), MOST_GROWTH)
    return multiple_of_samples(scene, min(max(finer * steps, LEAST_STEPS), MOST_STEPS))


def _rods_for(rods: int, error: float, left: float) -> int:
    """Rods per round whose error, of second order in their width, is the rest of ``left``."""
    denser = min(sqrt(error / (TARGET * (1 - STEP_SHARE) * left)), MOST_GROWTH)
    return ceil(min(max(denser, 1.0) * rods, MOST_RODS))


def _preliminary_rods(scene: Scene, rom: Rom) -> int:
    """Rods per round of a preliminary run: they resolve the footprint and a tilted tip's edge."""
    around = 2 * np.pi * rom.camber[:, 0].max()
    gap = least_gap(scene, rom)
    edge = around * edge_slope(scene) / (EDGE_FALL * gap) if gap > 0 else 0.0
    return ceil(min(max(PRELIMINARY_LENGTH * around / scene.liner.footprint_m, edge), MOST_RODS))


def _observed(runs: Iterable[RunWithError], name: str) -> float | None:
    """Largest error of the observable ``name``; None where runs end differently."""
    largest = max(run.errors[name] for run in runs)
    return largest if isfinite(largest) else None


def _error(errors: Iterable[float]) -> float:
    """The largest error, at most 1 (run and companion end differently); 0 without errors."""
    return max((min(error, 1.0) for error in errors), default=0.0)
