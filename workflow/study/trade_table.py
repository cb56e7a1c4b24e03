"""Tables of the study of accuracy and time, for the README."""

from collections.abc import Mapping, Sequence
from typing import Any

import pandas as pd

from workflow.experiment.row import ExperimentRow
from workflow.markdown import cell, percent, table, two_digits
from workflow.study.levels import (
    OBSERVABLES,
    SCENES,
    group_rows,
    levels,
    uncertainty,
)

FLOOR = "uncertainty of the reference"
COUNTED = "lobes"  # given as a number, all others in per cent
HEADS = [name.replace("_", " ") for name in OBSERVABLES]


def by_level(rows: Sequence[ExperimentRow]) -> str:
    """Settings, largest error of each observable over all scenes, time per run and of `paper`.

    Errors are those of mesh, patches, natural modes, strips, step and rods together.
    """
    lines = [
        [
            _level(level),
            _settings(level["of"]),
            *_cells(level["of"][OBSERVABLES].max()),
            ", ".join(level["of"].sort_values("scene")["cpu_s"].map(two_digits)),
            f"{level['paper_min']:.0f}",
        ]
        for level in levels(rows)
    ]
    floor = _cells(uncertainty(rows).max())
    return table(
        ["level", "settings", *HEADS, f"CPU s per run: {', '.join(SCENES)}", "paper, CPU min"],
        [*lines, [FLOOR, "", *floor, "", ""]],
    )


def requirements(rows: Sequence[ExperimentRow]) -> str:
    """Changes of each scene without a feature, and the ratio of CPU times."""
    times = {(row["scene"], row["row"]): row["cpu_s"] for row in rows}
    lines = [
        [
            *row["row"].split(": "),
            row["scene"],
            *_cells(row),
            f"{row['cpu_s'] / times[row['scene'], row['against']]:.2f}",
        ]
        for row in group_rows(rows, "feature").to_dict("records")
    ]
    return table(
        ["left out", "instead", "scene", *HEADS, "time ratio"],
        sorted(lines, key=lambda line: line[0]),
    )


def fewer_rounds(rows: Sequence[ExperimentRow]) -> str:
    """Error of the amplitude and CPU time of a run, by revolutions before those of the spectrum."""
    lines = []
    for name, runs in group_rows(rows, "rounds").set_index("scene").groupby("row", sort=False):
        by_scene = runs.reindex(SCENES)
        times = ", ".join(by_scene["cpu_s"].map(two_digits))
        lines.append([name, *by_scene["amplitude"].map(percent), times])
    return table(["revolutions before", *SCENES, "CPU s per run"], lines)


def fewer_speeds(rows: Sequence[ExperimentRow]) -> str:
    """Errors of the peaks and CPU times of full sweeps, and of coarse ones refined around peaks."""
    lines = [
        [
            row["row"],
            row["numbers"]["marches"],
            f"{row['cpu_s']:.1f}",
            *(percent(row["numbers"]["errors"][name]) for name in ("Omega_c", "amplitude")),
        ]
        for row in rows
        if row["group"] == "speeds" and "errors" in row["numbers"]
    ]
    return table(["sweep", "runs", "CPU s", "Omega c", "amplitude"], lines)


def _level(level_row: Mapping[str, Any]) -> str:
    """The level and its error; if no setting meets it, a note that this is the most accurate."""
    level = f"{level_row['level']}, {level_row['allowed']:.0%}"
    return level if level_row["met"] else f"{level}: not met, most accurate setting"


def _settings(rows: pd.DataFrame) -> str:
    """Settings with a flat tip, and the rods with the tilted tip, the last of the ``rows``."""
    flat, tilted = rows.iloc[0], rows.iloc[-1]
    numbers, liner = flat["numbers"], flat["settings"]["liner"]
    rods = tilted["settings"]["liner"]["rods_per_round"]
    return (
        f"blade {flat['blade']}: {numbers['patches']} patches (n = {numbers['n']}), "
        f"{liner['strips']} strips, {numbers['steps']} steps, "
        f"{liner['rods_per_round']} rods ({rods} tilted)"
    )


def _cells(errors: Mapping[str, float]) -> list[str]:
    return [(cell if name == COUNTED else percent)(errors[name]) for name in OBSERVABLES]
