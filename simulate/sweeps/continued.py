"""Ends of the runs of another sweep, from which those of a scene start."""

from collections.abc import Callable

import numpy as np
import xarray as xr

from geometry.base import Fault, require
from rom.model import Rom
from simulate.marching import WITH_RESULT, AnyEnd, SceneError, Worn
from simulate.scene.own_laws import Unread
from simulate.scene.scene import Scene, Start
from simulate.sweeps.dataset import final_state_of, require_rom, scene_of

SAME_SPEED = 1e-9  # relative
# Keys in which a run that goes on may differ from the one before
MAY_DIFFER = {"speeds", "rounds", "until", "record", "peaks", "verify", "start"}
OF_LINER = ("strips", "rods_per_round", "thickness_mm")  # keys that a worn liner must have alike

type Before = Callable[[float], AnyEnd | None]  # start of the run at a speed, rad/s


def before(scene: Scene, rom: Rom, runs: xr.Dataset | None) -> Before:
    """Start of each run of ``scene`` in the sweep ``runs``, by its speed in rad/s.

    Without a `start` that is a blade at rest over an unworn liner, at each speed.

    Raises
    ------
    ProvenanceError
        When the sweep is of another reduced model.
    SceneError
        When it is missing, holds no ends or is of a scene that cannot go on as this one, or when
        this one has no `start`; on a call, when it has no run with a result at that speed.
    """
    if (start := scene.start) is None:
        if runs is not None:
            raise SceneError("missing: give the scene to continue from", key="start")
        return lambda Omega: None
    if runs is None:
        raise SceneError(
            "its sweep is missing: `python -m simulate` takes it with --start, simulate.sweep "
            "with start=, and ./run snakemake makes it",
            key="start.scene",
            value=start.scene,
        )
    require_rom(runs, rom)
    if "end_solver" not in runs:
        raise SceneError(
            "its sweep holds no ends that this version reads; set `record: {end: true}` there, and "
            "run it again",
            key="start.scene",
            value=start.scene,
        )
    ran = scene_of(runs)
    if isinstance(ran.liner.law, Unread) and not start.liner_only:
        raise SceneError(ran.liner.law.why, key="start.scene", value=start.scene)
    if faults := _differences(scene, start, ran):
        raise SceneError(*faults)

    def at(Omega: float) -> AnyEnd:
        """Start of the run at a speed, rad/s."""
        given = start.speed_over_f1
        run = _run_at(runs, Omega / rom.omega1 if given is None else given, start.scene)
        final = final_state_of(run)
        return Worn(final.eps_p) if start.liner_only else final

    return at


def _differences(scene: Scene, start: Start, before: Scene) -> list[Fault]:
    """A fault for each key in which ``scene`` cannot go on from ``before``, by its ``start``."""
    values, values_before = scene.model_dump(mode="json"), before.model_dump(mode="json")
    if start.liner_only:
        values, values_before = (
            {"blade": settings["blade"]}
            | {f"liner.{key}": settings["liner"][key] for key in OF_LINER}
            for settings in (values, values_before)
        )
    return [
        Fault(
            f"in {start.scene}, from which it starts, it is {values_before[key]}; allowed the same",
            key,
            values[key],
            values_before[key],
        )
        for key in values
        if key not in MAY_DIFFER and values[key] != values_before[key]
    ]


def _run_at(runs: xr.Dataset, speed_over_f1: float, name: str) -> xr.Dataset:
    """The run of a sweep at a speed."""
    speeds = runs["speed_over_f1"].values
    index = int(np.abs(speeds - speed_over_f1).argmin())
    run = runs.isel(speed_over_f1=index)
    require(
        (
            abs(speeds[index] / speed_over_f1 - 1) <= SAME_SPEED,
            f"has no run at {speed_over_f1:.6g} f1(0); its nearest is at {speeds[index]:.6g}: "
            "give start.speed_over_f1, or the same speeds",
        ),
        (
            run["status"].item() in WITH_RESULT,
            f"its run at {speed_over_f1:.6g} f1(0) ended {run['status'].item()}: no run can "
            "continue from there",
        ),
        kind=SceneError,
        key="start.scene",
        value=name,
    )
    return run
