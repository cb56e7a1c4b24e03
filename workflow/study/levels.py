"""Error and CPU time of settings on all scenes, and the cheapest one for each level."""

from collections.abc import Iterator, Sequence
from math import inf
from typing import Any

import pandas as pd

from workflow.experiment.row import ExperimentRow

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


def group_rows(rows: Sequence[ExperimentRow], *groups: str) -> pd.DataFrame:
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


def uncertainty(rows: Sequence[ExperimentRow]) -> pd.DataFrame:
    """Uncertainty of the reference by scene: change by one level coarser or another scheme.

    `worst` is inf where neither is known.
    """
    runs = group_rows(rows, "finest", "scheme")
    changes = runs[runs["row"].isin([COARSER, OTHER_SCHEME])].groupby("scene")[OBSERVABLES].max()
    worst = changes[JUDGED].max(axis=1, skipna=False)
    return changes.assign(worst=worst).reindex(SCENES).fillna({"worst": inf})


def levels(rows: Sequence[ExperimentRow]) -> Iterator[dict[str, Any]]:
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
