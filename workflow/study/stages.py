"""The trade by stage: error of each choice of model and run alone, over the CPU time it costs."""

from collections.abc import Sequence
from math import isfinite
from pathlib import Path
from typing import Any

import pandas as pd

from workflow import markdown
from workflow.experiment.row import ExperimentRow
from workflow.study.levels import LEVELS, group_rows, scheme_of
from workflow.usage import read_usage

STAGES = {  # group of the experiment, by stage
    "mesh": "mesh",
    "basis": "modes",
    "patches and strips": "interface",
    "rods": "rods",
    "step": "scheme",
}
MODEL, FLAT, TILTED = "model", "flat tip", "tilted tip"
OF = {"calm": FLAT, "resonance": FLAT, "stiff": FLAT, "tangential": TILTED}  # runs, by scene
OF_STAGE = {"mesh": MODEL, "basis": MODEL}  # stages of the model, on all scenes
JOBS = ("mesh", "assemble", "reduce-r")  # of a model
BEFORE, AFTER = "before", "after"

type Row = dict[str, Any]  # plain values, of a JSON file


def records(rows: list[ExperimentRow], before: list[Row]) -> list[Row]:
    """Settings of each stage, ``before`` and after: largest error, CPU time (s).

    The time is that of a model, or of one run of each scene.
    """
    versions = {AFTER: tried(rows).to_dict("records"), BEFORE: before}
    every = [{"version": name} | row for name, of in versions.items() for row in of]
    return [row for row in every if isfinite(row["error"])]


def tried(rows: Sequence[ExperimentRow]) -> pd.DataFrame:
    """Settings of each stage, and of each scheme."""
    runs = pd.concat(group_rows(rows, name).assign(stage=stage) for stage, name in STAGES.items())
    schemes = "step, " + runs["settings"].map(scheme_of)
    stage, of = runs["stage"], runs["stage"].map(OF_STAGE).fillna(runs["scene"].map(OF))
    runs = runs.assign(stage=stage.mask(stage == "step", schemes), of=of)
    by_setting = runs.groupby(["stage", "of", "row"], sort=False)
    found = by_setting.agg(error=("worst", "max"), cpu_s=("cpu_s", "sum"), rom=("rom", "first"))
    found["cpu_s"] = found["cpu_s"].where(
        found.index.get_level_values("of") != MODEL, found.pop("rom").map(model_seconds)
    )
    return found.reset_index()


def model_seconds(rom: str) -> float:
    """CPU time of the jobs of a reduced model, from their logs."""
    return sum(read_usage(Path(rom).parent / f"logs/{job}.log")["seconds"] for job in JOBS)


def table(stages: Sequence[Row]) -> str:
    """Markdown: of each stage the cheapest setting that meets each level, and its CPU time (s)."""
    by_stage = pd.DataFrame(stages).groupby(["stage", "of"], sort=False)
    return markdown.table(
        ["stage", "CPU s of", *(f"{allowed:.0%}" for allowed in LEVELS.values())],
        [[*names, *(_cell(same, level) for level in LEVELS.values())] for names, same in by_stage],
    )


def _cell(settings: pd.DataFrame, allowed: float) -> str:
    """Setting and time before and after; the setting once where it is the same."""
    meet = settings[settings["error"] < allowed].sort_values("cpu_s")
    best = [meet[meet["version"] == version].head(1) for version in (BEFORE, AFTER)]
    names = " → ".join(dict.fromkeys(name for each in best for name in each["row"]))
    times = (markdown.cell(each["cpu_s"].max()) for each in best)
    return f"{names or 'none'}: {' → '.join(times)}"
