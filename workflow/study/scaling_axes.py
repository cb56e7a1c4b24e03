"""Axes of the study of cost: each stage in processes of its own, over what its cost depends on.

CPU time and peak memory of a process are measured when it has ended, whatever else runs.
"""

import json
import os
import shutil
import sys
import tempfile
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from subprocess import PIPE, STDOUT, run
from typing import Any

import yaml

from geometry.project import UserError
from workflow.study import scaling_plan as plan

OF_MESH = ("mesh", "assemble", "reduce", "full_model")
OF_PATCHES = ("mesh", "assemble", "reduce")
COPIED = ("Snakefile", "geometry", "fem", "rom", "simulate", "workflow")  # of a workflow to plan

MB = 1e6

# A process counts the memory of what started it as its own peak, until it has its program: a small
# starter, for that of tests and studies is large.
SEPARATOR = "\nused: "
STARTER = f"""
import os, subprocess, sys
_, status, usage = os.wait4(subprocess.Popen(sys.argv[1:]).pid, 0)
print({SEPARATOR!r}, usage.ru_utime + usage.ru_stime, " ", usage.ru_maxrss, sep="")
sys.exit(os.waitstatus_to_exitcode(status))
"""

type Point = dict[str, Any]  # of one measured process: x, seconds, peak_MB, what it told
type Stages = dict[str, list[Point]]  # points by stage, x ascending


class StageError(UserError):
    """A measured process failed; the message has the end of its output."""


def run_stage(name: str, **values: Any) -> dict[str, Any]:
    """What a stage of ``scaling_stages`` told, with the peak memory of its process, MB.

    Raises
    ------
    StageError
        When it fails.
    """
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "values.json")
        path.write_text(json.dumps(values))
        command = [sys.executable, "-m", "workflow.study.scaling_stages", name, str(path)]
        output, of_process = measured(command)
    return of_process | json.loads(output.splitlines()[-1])


def measured(
    command: Sequence[str], folder: str | None = None, environment: Mapping[str, str] | None = None
) -> tuple[str, dict[str, float]]:
    """Output of a process, and its CPU time, s, and peak memory, MB, with those of its children.

    Raises
    ------
    StageError
        When it fails.
    """
    ran = run(
        [sys.executable, "-I", "-S", "-c", STARTER, *command],
        cwd=folder,
        env=os.environ | dict(environment or {}),
        stdout=PIPE,
        stderr=STDOUT,
        text=True,
        check=False,
    )
    if ran.returncode != 0:
        raise StageError(f"{' '.join(command)}: {ran.stdout[-800:]}")
    output, _, used = ran.stdout.rpartition(SEPARATOR)
    seconds, kilobytes = map(float, used.split())
    return output, {"seconds": seconds, "peak_MB": kilobytes * 1024 / MB}


def of_mesh(files: Any, blade: str) -> Stages:
    """Each stage up to the reduced model, by nodes."""
    return _by_stage(
        point for size in plan.SIZES for point in _on_mesh(OF_MESH, blade, size, **plan.OF_SIZES)
    )


def _on_mesh(stages: Iterable[str], blade: str, size: float, **changes: Any) -> list[Point]:
    points, nodes = [], 0
    changes = {"mesh__element_size_mm": size} | changes
    with tempfile.TemporaryDirectory() as folder:
        for stage in stages:
            told = run_stage(stage, folder=folder, blade=blade, **changes)
            nodes = told.pop("nodes", nodes)
            points.append({"stage": stage, "x": nodes, "size_mm": size} | told)
    return points


def of_patches(files: Any, blade: str) -> Stages:
    """Assembly and reduction, by patches along the chord."""
    points = []
    for patches in plan.PATCHES:
        on_mesh = _on_mesh(OF_PATCHES, blade, plan.OF_PATCHES, interface__patches=patches)
        points += [point | {"x": patches} for point in on_mesh[1:]]
    return _by_stage(points)


def of_march(files: Any, scene: Mapping[str, Any]) -> Stages:
    """One run, by strips, rods per round and rounds."""
    history = {"record__history": {"chord": [0.0625]}}
    few = {"integrator__steps_per_round": plan.FEW_STEPS, **history}
    varied = {
        "strips": ("liner__strips", plan.STRIPS, {}),
        "rods": ("liner__rods_per_round", plan.RODS, {}),
        "rounds": ("rounds", plan.ROUNDS, few),
    }
    return {
        name: [
            {"x": x} | run_stage("march", rom=files.rom, scene=scene, **{key: x}, **changes)
            for x in values
        ]
        for name, (key, values, changes) in varied.items()
    }


def of_speeds(files: Any, scene: Mapping[str, Any]) -> Stages:
    """The merge of the blocks of a sweep, by speeds."""
    points = []
    for speeds in plan.SPEEDS:
        with tempfile.TemporaryDirectory() as folder:
            run_stage(
                "blocks",
                folder=folder,
                rom=files.rom,
                scene=scene,
                speeds=speeds,
                blocks=plan.BLOCKS,
            )
            points.append({"x": speeds} | run_stage("merge", folder=folder))
    return {"merge": points}


def of_rows(files: Any, scene: Mapping[str, Any]) -> Stages:
    """What a block of a design costs beside its runs, and its tables, by rows."""
    points = []
    for rows in plan.ROWS:
        with tempfile.TemporaryDirectory() as folder:
            for stage in ("design", "tables"):
                values = {"folder": folder, "rom": files.rom, "scene": scene, "rows": rows}
                points.append({"stage": stage, "x": rows} | run_stage(stage, **values))
    return _by_stage(points)


def of_jobs(files: Any, scene: Mapping[str, Any]) -> Stages:
    """The plan of a workflow, `snakemake -n`, by sweep blocks."""
    points = []
    with _workflow(scene) as folder:
        for jobs in plan.JOBS:
            asked = ["--config", "scenes=[many]", f"blocks={jobs}", "--", "sweeps"]
            command = [sys.executable, "-m", "snakemake", "-n", "--quiet", "all", *asked]
            _, of_process = measured(command, folder, {"PYTHONPATH": folder})
            points.append({"x": jobs} | of_process)
    return {"plan": points}


@contextmanager
def _workflow(scene: Mapping[str, Any]) -> Iterator[str]:
    """A copy of this workflow with one more scene, `many`, of as many speeds as there are jobs."""
    speeds = {"over_f1": {"first": 0.1, "last": 0.4, "count": max(plan.JOBS)}}
    with tempfile.TemporaryDirectory() as folder:
        for name in COPIED:
            copy = shutil.copytree if Path(name).is_dir() else shutil.copy2
            copy(name, Path(folder, name))
        path = Path(folder, "workflow/scenes/many.yaml")
        path.write_text(yaml.safe_dump(json.loads(json.dumps(dict(scene) | {"speeds": speeds}))))
        yield folder


def _by_stage(points: Iterable[Point]) -> Stages:
    stages: Stages = {}
    for point in points:
        stages.setdefault(point.pop("stage"), []).append(point)
    return {name: sorted(of, key=lambda point: point["x"]) for name, of in stages.items()}
