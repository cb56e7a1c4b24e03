"""Pareto front of error and time of each scene, and the cheapest setting for each level."""

from collections.abc import Sequence
from itertools import accumulate
from math import inf
from typing import Any

from geometry.project import read_json
from workflow.study.trade_plan import CENTRAL, SCENES
from workflow.study.trade_runs import JUDGED, Row, worst

LEVELS = {"draft": 0.1, "standard": 0.03, "reference": 0.01}  # largest error over all scenes
# Runs of the target `paper`, with twins, by the most similar scene. calm: coatings of the grid up
# to E = 4.55 and the sweep of E = 1; stiff: coatings above, E = 10 and the rigid liner; tangential:
# both scenes with a tilted tip.
MARCHES = {"calm": 1700, "stiff": 3400, "tangential": 250}


def numbers(files: Any) -> Row:
    """The whole study from the results of its scenes, ``files.scenes`` in the order of SCENES."""
    parts = dict(zip(SCENES, map(read_json, files.scenes), strict=True))
    runs = [row for part in parts.values() for row in part["runs"]]
    return {
        "scenes": {name: part["scene"] for name, part in parts.items()},
        "runs": runs,
        "front": {name: front(runs, name) for name in parts},
        "levels": levels(runs),
    }


def cost(row: Row) -> float:
    """CPU time of a run, s: the median of its repetitions."""
    return row["cpu_s"][1]


def scheme_of(row: Row) -> str:
    """Scheme of a run: `piecewise-exact`, `central`, or `mass-scaled` central differences."""
    if row["scheme"] != CENTRAL:
        return row["scheme"]
    return "central" if row["mass_scaling_hz"] is None else "mass-scaled"


def front(runs: Sequence[Row], scene: str) -> list[int]:
    """Indices of the Pareto-optimal runs of a scene: no other has less cost and less error."""
    own = [i for i, r in enumerate(runs) if r["scene"] == scene and r["study"] == "front"]
    own.sort(key=lambda i: (cost(runs[i]), worst(runs[i]["errors"])))
    errors = [worst(runs[i]["errors"]) for i in own]
    cheaper = accumulate(errors, min, initial=inf)  # least error of all with less cost
    return [i for i, error, least in zip(own, errors, cheaper, strict=False) if error < least]


def levels(runs: Sequence[Row]) -> list[Row]:
    """For each level the cheapest setting that meets it on all scenes, or the most accurate."""
    tried = [row for row in runs if row["study"] == "front"]
    labels = dict.fromkeys(row["label"] for row in tried)
    settings = [_setting(label, [r for r in tried if r["label"] == label]) for label in labels]
    return [{"level": level} | _cheapest(settings, allowed) for level, allowed in LEVELS.items()]


def _cheapest(settings: list[Row], allowed: float) -> Row:
    meet = [s for s in settings if s["worst"] < allowed]
    best = min(meet or settings, key=lambda s: s["paper_min"] if meet else s["worst"])
    return {"allowed": allowed, "met": bool(meet)} | best


def _setting(label: str, rows: list[Row]) -> Row:
    """Results of one setting over all scenes."""
    cpu = {row["scene"]: cost(row) for row in rows}
    errors = {row["scene"]: row["errors"] for row in rows}
    scene = max(errors, key=lambda name: worst(errors[name]))
    return {
        "label": label,
        "settings": _shown_settings(rows),
        "worst": worst(errors[scene]),
        "worst_of": [scene, max(JUDGED, key=lambda name: errors[scene][name] or 0.0)],
        "errors": errors,
        "cpu_s": cpu,
        "paper_min": paper_minutes(cpu),
    }


def _shown_settings(rows: list[Row]) -> Row:
    """Settings with a flat tip, and those that differ with the tilted tip."""
    flat = next((row for row in rows if row["directions"] == "r"), rows[0])
    keys = ("scheme", "steps", "blade", "modes", "patches", "strips", "mesh_mm", "n", "rods")
    tilted = next((row for row in rows if row["directions"] != "r"), flat)
    return {key: flat[key] for key in keys} | {
        "rods_tilted": tilted["rods"],
        "n_tilted": tilted["n"],
    }


def paper_minutes(cpu_s: dict[str, float]) -> float:
    """CPU time, min, of all runs of the target `paper`; ``cpu_s``: s per run, by scene."""
    return sum(count * cpu_s.get(scene, 0.0) for scene, count in MARCHES.items()) / 60
