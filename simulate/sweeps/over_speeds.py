"""One scene at given speeds: checks, the cost beforehand, and a run at each speed."""

from collections.abc import Collection, Sequence
from dataclasses import replace
from time import perf_counter

import xarray as xr

from geometry.base import Say, progress, silent
from rom.model import Rom
from simulate.errors.accuracy import Choice, march_to_accuracy
from simulate.errors.checked import checked
from simulate.errors.neighbours import judged
from simulate.errors.resolution import check_resolution
from simulate.errors.run import Case, Run
from simulate.marching import AnyEnd, check_scene, make_kernel, prepare
from simulate.marching.refusals import require_sweep
from simulate.scene import Scene
from simulate.sweeps.continued import before
from simulate.sweeps.cost import cost
from simulate.sweeps.dataset import attributes, of_run
from simulate.sweeps.unusual import doubts, warn_of

LONG = 1.0  # s, wall time above which a compilation is logged


def tell_before(scene: Scene, rom: Rom, report: Say) -> None:
    """Warn of doubtful values, and report the cost of the sweep."""
    check_scene(scene, rom)
    warn_of(doubts(scene, rom).values())
    for line in cost(scene, rom).lines():
        report(line)


def check_sweep(scene: Scene, rom: Rom, report: Say = silent) -> None:
    """Check a scene against its reduced model once, before its blocks: all keys, extreme speeds.

    Doubtful values are warned of, and ``report`` gets the cost of the sweep.

    Raises
    ------
    simulate.marching.setup.SceneError
        When the scene does not fit the reduced model or the step is above its limit.
    """
    tell_before(scene, rom, report)
    check_steps(scene, rom)


def check_steps(scene: Scene, rom: Rom, choice: Choice | None = None) -> None:
    """Refuse steps that are too long at the lowest or at the highest speed.

    Raises
    ------
    simulate.marching.setup.SceneError
        As ``check_sweep``.
    """
    speeds = scene.speeds.omega(rom.f1)
    for Omega in sorted({speeds.min(), speeds.max()}):
        set_up(scene, rom, Omega, choice)


def at_speeds(
    scene: Scene,
    rom: Rom,
    speeds: Collection[float],
    report: Say = silent,
    choice: Choice | None = None,
    start: xr.Dataset | None = None,
) -> list[Run]:
    """Runs of a scene that ``tell_before`` has checked at ``speeds`` (rad/s).

    All set-ups are made before the first run. Speeds in turn end with the first run that leaves
    nothing to go on from.

    Raises
    ------
    simulate.marching.setup.SceneError
        As ``check_sweep``.
    """
    if choice:
        scene = choice.scene(scene)
    require_sweep(scene.blade, scene.design, scene.accuracy)
    start_at = before(scene, rom, start)
    in_turn = scene.speeds.in_turn
    from_start = 1 if in_turn else len(speeds)  # in turn only the first: others go on from it
    cases = [
        set_up(scene, rom, Omega, choice, start_at(Omega) if i < from_start else None)
        for i, Omega in enumerate(speeds)
    ]
    for case in cases[:1]:
        if (seconds := make_kernel(scene, case.setup)) > LONG:
            report(f"time integration compiled for this scheme and law: {seconds:.1f} s")
    runs, last, begun = [], None, perf_counter()
    for done, case in enumerate(cases, 1):
        run = march_one(replace(case, start=last or case.start), choice)
        far = progress.remaining(done, len(cases), perf_counter() - begun)
        report(f"{run.line}; speed {far}")
        runs.append(run)
        last = run.outcome.final if in_turn else None
        if in_turn and last is None:
            break
    return runs


def as_sweep(
    runs: Sequence[Run],
    report: Say = silent,
    choice: Choice | None = None,
    check: bool = True,
) -> xr.Dataset:
    """The ``runs`` of a scene as a dataset, speeds ascending; some are checked beforehand."""
    scene, rom = runs[0].scene, runs[0].rom
    runs_checked, _ = checked(runs, scene.checked_share if check else 0.0, report=report)
    merged = xr.concat([of_run(run) for run in runs_checked], dim="speed_over_f1", join="outer")
    return merged.assign_attrs(attributes(scene, rom, choice))


def set_up(
    scene: Scene,
    rom: Rom,
    Omega: float,
    choice: Choice | None = None,
    start: AnyEnd | None = None,
) -> Case:
    """``prepare``, and without a ``choice`` of the steps a check that they resolve the rub.

    ``start``: start of the run.

    Raises
    ------
    simulate.marching.setup.SceneError
        As ``check_sweep``.
    """
    setup = prepare(scene, rom, Omega)
    if choice is None:
        check_resolution(setup, scene.record.samples_per_round, scene.halves)
    return Case(scene, rom, setup, start)


def march_one(case: Case, choice: Choice | None = None) -> Run:
    """March one run, and its twin, companion or finer runs where the scene asks for it."""
    start, accurate = perf_counter(), True
    if choice:
        run = march_to_accuracy(case.scene, case.rom, case.setup.Omega, choice)
        accurate = run.largest_error <= choice.accuracy
    else:
        run = case.march()
    return replace(judged(run, accurate), seconds=perf_counter() - start)
