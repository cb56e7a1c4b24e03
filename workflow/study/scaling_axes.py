"""Axes of the study of cost: each stage in processes of its own, over what its cost depends on."""

import json
import shutil
import sys
import tempfile
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import yaml

from workflow.study import scaling_plan as plan
from workflow.study.scaling_child import measured, run_stage

OF_MESH = ("mesh", "assemble", "reduce", "full_model")
OF_PATCHES = ("mesh", "assemble", "reduce")
COPIED = ("Snakefile", "geometry", "fem", "rom", "simulate", "workflow")  # of a workflow to plan

type Point = dict[str, Any]  # of one measured process: x, seconds, peak_MB, what it told
type Stages = dict[str, list[Point]]  # points by stage, x ascending


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
