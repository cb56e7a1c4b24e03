"""Error and CPU time of settings on all scenes: the cheapest for each level, tables for pages."""

from collections.abc import Iterator, Mapping, Sequence
from math import inf
from typing import Any

import pandas as pd

from workflow.many.row import ComputedRow
from workflow.markdown import cell, percent, table, two_digits

OBSERVABLES = ["amplitude", "Omega_c", "wear", "lobes", "force", "history"]  # of the tables
JUDGED = ["amplitude", "wear", "force", "history"]  # over which the largest error is taken
SCENES = ("calm", "resonance", "stiff", "tangential")
PEAK = "peak"  # scene of the sweep whose critical speed belongs to the run at resonance
COARSER, OTHER_SCHEME = "one level coarser", "central-difference, 0.2 of the limit"
LEVELS = {"draft": 0.1, "standard": 0.03, "reference": 0.01}  # largest error over all scenes
# Runs of the target `paper`, with twins, by the most similar scene. calm: coatings of the grid up
# to E = 4.55 and the sweep of E = 1; stiff: coatings above, E = 10 and the rigid liner; tangential:
# both scenes with a tilted tip.
MARCHES = {"calm": 1700, "stiff": 3400, "tangential": 250}
FLOOR = "uncertainty of the reference"
COUNTED = "lobes"  # given as a number, all others in per cent
HEADS = [name.replace("_", " ") for name in OBSERVABLES]


def group_rows(rows: Sequence[ComputedRow], *groups: str) -> pd.DataFrame:
    """Rows of groups on the scenes, with their errors in columns, nan where not known.

    That of Omega_c at resonance is from the sweep over the peak. `worst`: largest of those in
    ``JUDGED``; inf if one is not known.
    """
    frame = pd.DataFrame(rows)
    frame = frame[frame["group"].isin(groups)].reset_index(drop=True)
    errors = frame["numbers"].map(lambda numbers: numbers.get("errors"))
    errors_by_name = pd.DataFrame([each or {} for each in errors], columns=OBSERVABLES, dtype=float)
    peaks = errors_by_name["Omega_c"].where(frame["scene"] == PEAK)
    largest = peaks.groupby([frame["group"], frame["row"]]).transform("max")
    errors_by_name["Omega_c"] = largest.where(frame["scene"] == "resonance")
    errors_by_name["worst"] = errors_by_name[JUDGED].max(axis=1, skipna=False).fillna(inf)
    return frame.join(errors_by_name)[frame["scene"].isin(SCENES) & errors.notna()]


def uncertainty(rows: Sequence[ComputedRow]) -> pd.DataFrame:
    """Uncertainty of the reference by scene: change by one level coarser or another scheme.

    `worst` is inf where neither is known.
    """
    runs = group_rows(rows, "finest", "scheme")
    changes = runs[runs["row"].isin([COARSER, OTHER_SCHEME])].groupby("scene")[OBSERVABLES].max()
    worst = changes[JUDGED].max(axis=1, skipna=False)
    return changes.assign(worst=worst).reindex(SCENES).fillna({"worst": inf})


def levels(rows: Sequence[ComputedRow]) -> Iterator[dict[str, Any]]:
    """For each level the cheapest setting that meets it on all scenes, or the most accurate.

    With its rows (`of`), its largest error, and its time for all of `paper`, CPU min.
    """
    tried = group_rows(rows, "front")
    minutes = tried["cpu_s"] * tried["scene"].map(MARCHES) / 60
    by_setting = tried.assign(paper_min=minutes).groupby("row", sort=False)
    settings = by_setting.agg({"worst": "max", "paper_min": "sum"})
    for level, allowed in LEVELS.items():
        meet = settings[settings["worst"] < allowed]
        best = settings["worst"].idxmin() if meet.empty else meet["paper_min"].idxmin()
        about = {"level": level, "allowed": allowed, "met": not meet.empty, "row": best}
        yield about | {"of": tried[tried["row"] == best]} | settings.loc[best].to_dict()


def by_level(rows: Sequence[ComputedRow]) -> str:
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


def requirements(rows: Sequence[ComputedRow]) -> str:
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


def fewer_rounds(rows: Sequence[ComputedRow]) -> str:
    """Error of the amplitude and CPU time of a run, by revolutions before those of the spectrum."""
    runs = group_rows(rows, "rounds").set_index("scene").groupby("row", sort=False)
    by_scene = {name: of.reindex(SCENES) for name, of in runs}
    lines = [
        [name, *of["amplitude"].map(percent), ", ".join(of["cpu_s"].map(two_digits))]
        for name, of in by_scene.items()
    ]
    return table(["revolutions before", *SCENES, "CPU s per run"], lines)


def fewer_speeds(rows: Sequence[ComputedRow]) -> str:
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
