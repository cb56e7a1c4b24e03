"""Key ``accuracy`` of a scene: choice of step, rods and strips, and the error of each run.

Step, rods and strips are chosen from pilot runs at some of the speeds: first a step in which the
tip passes no more than its footprint and which resolves contact, then, where a coarser companion
run (``errors.companion``) says that the error exceeds the accuracy, the values for which the errors
of step, strips and reduced model ask. There are as many rods as steps. Patches and natural modes
belong to the reduced model. Where they, or the most strips, err too much for an accuracy, it is
refused: only once a run misses it on the finest steps and strips, too, since on long steps and few
strips model and strips seem to err by more than they do. Each run of the sweep has a companion that
is coarser in all of these. If the estimated error exceeds the accuracy, the run is repeated with
shorter steps; if it still does, the run is `sensitive`. The error of the mesh is estimated
separately, from frequencies and compliances on a coarser mesh (``mesh-error.json``); a mesh whose
error exceeds the accuracy is refused.
"""

from dataclasses import dataclass, field, fields, replace
from math import cbrt, ceil, hypot, isfinite, sqrt
from operator import attrgetter
from pathlib import Path
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from geometry.base import ProvenanceError, anew, read_json
from rom.coarser import coarser
from rom.model import Rom
from simulate.contact.places import mean_footprint
from simulate.errors.companion import (
    Coarser,
    Fineness,
    Parts,
    error_by_part,
    march_with_errors,
    multiple_of_samples,
    quick_times,
    with_errors,
)
from simulate.errors.model_errors import ModelError, ModelErrors
from simulate.errors.run import Run
from simulate.marching import SceneError, check_scene, edge_slope, least_gap, prepare
from simulate.marching.piecewise_exact import stiffness_in_a_step
from simulate.scene import Scene

NOT_KNOWN = (
    "accuracy: of a reduced model from elsewhere the errors against its full model and of its mesh "
    "are not known; the accuracy is that of step, rods, strips, patches and modes"
)


@dataclass(frozen=True)
class Tuning:
    """Numbers of the choice: value, meaning, and in brackets the commit that set the value.

    Those "tuned" come from runs of random scenes, others than those that test them; the log says so
    in titles alone, and no table of these runs is kept. Of those "chosen" the log names no study.
    """

    # of the first try
    steps: float = 0.46  # in a footprint, times the cubic root of the accuracy [tuned, 2f7c2ab]
    stiffness: float = 400.0  # of contact in a step, times the accuracy [tuned, 7728636]
    strips: float = 6.5  # over the root of the accuracy [tuned, fc507bb]
    edge_fall: float = 0.1  # of the gap: fall of the tip's edge over a rod [chosen, 096acdf]
    # On a casing that tapers more modes respond. A first try whose step passes more than `long` of
    # the footprint then errs by up to `doubt` times the estimate [5784a50: 512 steps on rotor 37;
    # with 768 the error is the estimate]
    long: float = 0.6
    doubt: float = 3.0
    # of the pilot
    pilot_speeds: int = 8  # most of its speeds [chosen, 096acdf]
    pilot_share: int = 6  # one in so many of the scene's speeds [chosen, 06f729e]
    tries: int = 4  # at most [chosen, 06f729e]
    met: float = 0.85  # of the accuracy: errors at other speeds may be larger [tuned, c25c932]
    target: float = 0.75  # of the accuracy, for the next try [tuned, c25c932]
    # shares of the accuracy; errors add up as the root of their squares
    strip_share: float = 0.5  # [chosen, 06f729e]
    model_share: float = 0.5  # [chosen, before 1339e26]
    least_remaining: float = 0.2  # squared, for the step [chosen, before 1339e26]
    # from one try to the next
    most_growth: int = 4  # of steps, strips: orders hold for small errors only [chosen, 096acdf]
    little_growth: float = 1.4  # of steps whose error is small, or seems so [tuned, 21ea74b]
    least_order: float = 0.5  # in the step, where errors converge; 2 if small [chosen, 06f729e]
    # of each run
    repeats: int = 2  # with shorter steps [chosen, before 1339e26]
    most_refined: int = 2  # how much shorter each time, at most [chosen, before 1339e26]
    # limits
    strips_by: int = 8  # outputs are means over eighths of the chord: by definition
    most_strips: int = 64  # [chosen, e8500d7]
    most_steps: int = 2**20  # per revolution [chosen, 096acdf]
    most_rods: int = 2**21  # per revolution [chosen, 096acdf]


TUNED = Tuning()

_error = attrgetter("largest_error")  # of a run


@dataclass(frozen=True, kw_only=True)
class Choice(Fineness):
    """Step, density and strips chosen by the pilot, with the errors that they are chosen by."""

    accuracy: float
    # relative error of the reduced model, from its check; None where not known, from elsewhere
    basis_error: float | None
    mesh_error: float | None  # relative, of frequencies and compliances; None where it is not known
    speeds: list[float]  # rad/s, of the pilot
    expected: float  # error at these speeds, extrapolated from the try before the last, if any
    # largest error at these speeds with the choice, by observable; None where runs end differently
    observed: dict[str, float | None]
    # difference of a run from its companion in errors, by observable; None: companions of twice
    # the step
    times: dict[str, float] | None = None
    runs: dict[float, Run] = field(default_factory=dict, repr=False)  # by speed

    def plain(self) -> dict[str, Any]:
        """All fields but the runs, as plain values for JSON."""
        return {name: value for name, value in vars(self).items() if name != "runs"}

    @classmethod
    def load(cls, path: str | Path) -> Self:
        """Read a JSON file of ``plain``.

        Raises
        ------
        geometry.base.provenance.ProvenanceError
            When it is missing, damaged, or no choice of this version.
        """
        values = read_json(path)
        names = {field.name for field in fields(cls)} - {"runs"}
        if not isinstance(values, dict) or values.keys() != names:
            raise ProvenanceError(f"is no choice of a pilot; {anew(path)}", file=path)
        return cls(**values)


def require_model(accuracy: float, model_error: ModelError) -> None:
    """Refuse an accuracy below the error of the reduced model or of its mesh.

    Raises
    ------
    SceneError
        If it is; the message names the error and the remedy.
    """
    remedies = {
        "reduced model": "raise basis.natural_modes",
        "mesh": "lower mesh.element_size_mm",
    }
    for (part, remedy), error in zip(remedies.items(), model_error, strict=True):
        if error is not None and not error <= accuracy:
            raise SceneError(
                f"the relative error of the {part} is {error:.3g}, in frequencies or compliances "
                f"of the tip; allowed from that value, or {remedy} in the blade's file",
                key="accuracy",
                value=accuracy,
                allowed={"ge": error},
            )


def pilot(scene: Scene, rom: Rom, check: str | Path, mesh: str | Path | None) -> Choice:
    """``choose`` with the errors of the model that its check and the study of its mesh found.

    ``check``, ``mesh``: as of ``ModelErrors.of``.

    Raises
    ------
    geometry.base.provenance.ProvenanceError
        As ``ModelErrors.of``.
    SceneError
        As ``choose``, and when no coarser mesh could be made.
    """
    if rom.elsewhere:
        print(NOT_KNOWN)
    errors = ModelErrors.of(check, mesh, rom)
    if errors.no_mesh:
        raise SceneError(f"the error of the mesh is not known: {errors.no_mesh}", key="accuracy")
    return choose(scene, rom, errors.largest)


def choose(scene: Scene, rom: Rom, model_error: ModelError) -> Choice:
    """Choose step, rods and strips for ``scene.accuracy`` at some of the scene's speeds.

    ``model_error``: errors of frequencies and compliances.

    Raises
    ------
    SceneError
        When the scene does not fit the reduced model, or the error of the model, of its mesh or of
        the most strips allowed leaves too little of the accuracy.
    """
    require_model(scene.allowed_error, model_error)
    coarse = coarser(rom)
    speeds = _pilot_speeds(scene, rom)
    fineness = _first(scene, rom, speeds)
    runs = {Omega: march_with_errors(scene, rom, coarse, Omega, fineness) for Omega in speeds}
    worst = max(runs.values(), key=_error)
    expected = min(worst.largest_error, 1.0)
    for attempt in range(TUNED.tries):
        long = TUNED.long * fineness.steps_per_round < _around(scene, rom)
        doubt = TUNED.doubt if attempt == 0 and long and worst.setup.places.slope.any() else 1.0
        if (
            doubt * worst.largest_error <= TUNED.met * scene.allowed_error
            or fineness.steps_per_round >= TUNED.most_steps
        ):
            break
        parts = error_by_part(worst, coarse)
        if attempt > 1:  # else the steps may be too long to tell
            _require_finest(worst, scene, rom, coarse, parts)
        before, old = runs, fineness
        fineness, expected = _finer(scene, rom, old, parts)
        runs = {Omega: march_with_errors(scene, rom, coarse, Omega, fineness) for Omega in before}
        converging = _converging(before, runs, fineness.steps_per_round / old.steps_per_round)
        worst = max(converging or [min(runs.values(), key=_error)], key=_error)
    worst = max(runs.values(), key=_error)
    if worst.largest_error > TUNED.met * scene.allowed_error:
        _require_finest(worst, scene, rom, coarse, error_by_part(worst, coarse))
    return Choice(
        accuracy=scene.allowed_error,
        **vars(fineness),
        basis_error=model_error.basis,
        mesh_error=model_error.mesh,
        speeds=[*runs],
        expected=expected,
        times=quick_times(runs.values(), coarse),
        observed={
            name: largest
            if isfinite(largest := max(run.errors[name] for run in runs.values()))
            else None
            for name in scene.record.observables
        },
        runs=runs,
    )


def _pilot_speeds(scene: Scene, rom: Rom) -> NDArray[np.float64]:
    """Speeds of the pilot, rad/s: evenly among those of the scene, without its ends."""
    speeds = scene.speeds.omega(rom.f1)
    count = min(TUNED.pilot_speeds, max(len(speeds) // TUNED.pilot_share, 2), len(speeds))
    return speeds[((np.arange(count) + 0.5) * len(speeds) / count).astype(int)]


def _finer(scene: Scene, rom: Rom, fineness: Fineness, parts: Parts) -> tuple[Fineness, float]:
    """Steps, rods and strips that meet the accuracy, and the error expected with them.

    Raises
    ------
    SceneError
        As ``choose``.
    """
    strips = _strips_for(scene, rom, fineness.strips, parts)
    of_strips = parts.strips * (fineness.strips / strips) ** 2
    fixed = of_strips**2 + parts.model**2
    remaining = sqrt(
        max(
            (TUNED.target * scene.allowed_error) ** 2 - fixed,
            TUNED.least_remaining * scene.allowed_error**2,
        )
    )
    growth = min(max(sqrt(parts.step / remaining), 1.0), TUNED.most_growth)
    steps = multiple_of_samples(scene, min(growth * fineness.steps_per_round, TUNED.most_steps))
    if (steps, strips) == (fineness.steps_per_round, fineness.strips):  # they are small, or seem so
        steps = multiple_of_samples(scene, min(TUNED.little_growth * steps, TUNED.most_steps))
        strips = _most_strips(scene, rom)
    of_step = parts.step * (fineness.steps_per_round / steps) ** 2
    return _with_rods(scene, rom, steps, strips), sqrt(of_step**2 + fixed)


def _require_finest(worst: Run, scene: Scene, rom: Rom, coarse: Coarser, parts: Parts) -> None:
    """Refuse an accuracy that the ``worst`` run misses with the finest steps and strips, too.

    ``parts``: of that run. Where model or strips err too much by them, it is repeated with
    shorter steps and most strips: on long steps the coarser model can move in another way.

    Raises
    ------
    SceneError
        As ``choose``.
    """
    most, fineness = _most_strips(scene, rom), Fineness.of(worst.setup)
    if not _refusal(scene, parts, fineness.strips, most):
        return
    finest = _with_rods(
        scene, rom, min(TUNED.most_growth * fineness.steps_per_round, TUNED.most_steps), most
    )
    run = march_with_errors(scene, rom, coarse, worst.setup.Omega, finest)
    missed = run.largest_error > TUNED.met * scene.allowed_error
    if missed and (why := _refusal(scene, error_by_part(run, coarse), most, most)):
        raise SceneError(why, key="accuracy", value=scene.allowed_error)


def _refusal(scene: Scene, parts: Parts, strips: int, most: int) -> str:
    """Why model and ``most`` strips leave too little of the accuracy to the step; empty if not."""
    if parts.model > TUNED.model_share * scene.allowed_error:
        return (
            "patches and natural modes of the reduced model cause a relative error of about "
            f"{parts.model:.2g} in the recorded outputs; allowed up to {TUNED.model_share:g} of "
            "the accuracy: raise interface.patches or basis.natural_modes in the blade's file"
        )
    fixed = hypot(parts.strips * (strips / most) ** 2, parts.model)
    if fixed <= sqrt(1 - TUNED.least_remaining) * scene.allowed_error:
        return ""
    needs = f"needs more than {most} strips, whose relative error is {fixed:.2g}"
    if rigid := scene.liner.rigid_key:
        return (
            f"{needs}; against a rigid casing ({rigid}) there are as many as patches of the "
            "reduced model: raise interface.patches in the blade's file"
        )
    return f"{needs}: give integrator, liner.rods_per_round and liner.strips instead"


def _most_strips(scene: Scene, rom: Rom) -> int:
    """As many as the patches against a rigid casing, else more."""
    patches = len(rom.xi)
    return patches if scene.liner.rigid_key else max(TUNED.most_strips, patches)


def _first_strips(scene: Scene, rom: Rom) -> int:
    """Strips of the first try, at least one for each patch."""
    least = max(TUNED.strips / sqrt(scene.allowed_error), len(rom.xi))
    return min(TUNED.strips_by * ceil(least / TUNED.strips_by), _most_strips(scene, rom))


def _strips_for(scene: Scene, rom: Rom, drafted: int, parts: Parts) -> int:
    """Number of strips whose error, of second order in their width, is its share."""
    growth = min(sqrt(parts.strips / (TUNED.strip_share * scene.allowed_error)), TUNED.most_growth)
    needed = TUNED.strips_by * ceil(growth * drafted / TUNED.strips_by)
    return max(min(needed, _most_strips(scene, rom)), drafted)


def march_to_accuracy(scene: Scene, rom: Rom, Omega: float, choice: Choice) -> Run:
    """March at ``Omega`` (rad/s), with shorter steps where the accuracy needs them."""
    coarse, run = coarser(rom), choice.runs.get(Omega)
    run = run or march_with_errors(scene, rom, coarse, Omega, choice, choice.times)
    for _ in range(TUNED.repeats):
        if run.largest_error > choice.accuracy:
            run = with_errors(run, coarse)
        if run.largest_error <= choice.accuracy:
            return run
        growth = min(run.largest_error / choice.accuracy, TUNED.most_refined) / TUNED.target
        steps = multiple_of_samples(scene, growth * run.setup.steps)
        finer = replace(choice, steps_per_round=steps)
        run = march_with_errors(scene, rom, coarse, Omega, finer)
    return run


def _converging(before: dict[float, Run], after: dict[float, Run], growth: float) -> list[Run]:
    """Runs whose error falls with ``growth`` times the steps.

    Chaotic motion does not converge with the step: such runs are left out.
    """
    least = growth**TUNED.least_order if growth > 1 else 0.0
    return [
        run
        for Omega, run in after.items()
        if run.largest_error * least <= before[Omega].largest_error
    ]


def _around(scene: Scene, rom: Rom) -> float:
    """Footprints in a revolution."""
    return float(2 * np.pi * rom.camber[:, 0].max() / mean_footprint(scene.liner, rom))


def _first(scene: Scene, rom: Rom, speeds: NDArray[np.float64]) -> Fineness:
    """Steps, rods and strips of the first try at the ``speeds`` (rad/s) of the pilot.

    The tip passes no more than its footprint in a step, less for a higher accuracy. Where a step of
    one footprint is too long for the stiffness of contact, it is shortened as if that went with the
    square of the step: the error does, the compliance of fast modes in a step does not.

    Raises
    ------
    SceneError
        When the scene does not fit the reduced model.
    """
    steps, strips = multiple_of_samples(scene, _around(scene, rom)), _first_strips(scene, rom)
    case = _with_rods(scene, rom, steps, strips).scene(scene)
    check_scene(case, rom)
    weights = (prepare(case, rom, Omega).strips.w_end for Omega in speeds)
    stiffness = max(float(stiffness_in_a_step(w_end).sum()) for w_end in weights)
    if isfinite(stiffness):  # not of a rigid law
        steps *= max(sqrt(stiffness / (TUNED.stiffness * scene.allowed_error)), 1.0)
    least = TUNED.steps / cbrt(scene.allowed_error) * _around(scene, rom)
    steps = multiple_of_samples(scene, min(max(steps, least), TUNED.most_steps))
    return _with_rods(scene, rom, steps, strips)


def _with_rods(scene: Scene, rom: Rom, steps: int, strips: int) -> Fineness:
    """As many rods as steps, or more where a tilted tip's edge needs them."""
    gap = least_gap(scene.gaps, rom, scene.liner.m, scene.speeds.omega(rom.f1))
    footprint = mean_footprint(scene.liner, rom)
    fall = edge_slope(scene.contact.profile, footprint) * footprint
    edge = fall / (TUNED.edge_fall * gap) if gap > 0 else 0.0
    rods = max(edge * _around(scene, rom), steps - 1)
    return Fineness(steps, min(ceil(rods), TUNED.most_rods), strips)
