"""Peaks of one and of several blades over one liner: a row of an experiment, and its table."""

from collections.abc import Sequence
from typing import Any

import pandas as pd
import xarray as xr

from rom.model import Rom
from simulate.errors.observables import numbers
from simulate.errors.run import Case
from simulate.marching import prepare
from simulate.scene import OF_LAST_ROUNDS, STEADY, Scene
from simulate.signals import leading_gap, leading_wear
from simulate.sweeps.peak import Peak, peak_of
from workflow import markdown
from workflow.many.quantiles import SHARES, needed, quantile
from workflow.many.row import ComputedRow
from workflow.many.table import frame

UM = 1e6
ORDERS = (4, 5)
LEAST = 1e-2  # um, shown
PASSES = 3200  # most of the tips, of a run that goes on until it is steady
COLUMNS = {  # of the page, by number
    "speed": "EO {}: Ω / f₁(0)",
    "amplitude_um": "amplitude, µm",
    "median_um": "median",
    "largest_um": "largest u_r, µm",
    "steady": "later, µm",
}


def at_peaks(runs: xr.Dataset, scene: Scene, rom: Rom) -> dict[str, Any]:
    """The peaks of mode 1 along ``ORDERS`` after the runs' revolutions, and there when steady.

    Speed over f1(0), lengths in um: of the worst blade, the amplitude also of the median blade and
    of the blade with least. The steady motion goes on to ``PASSES`` of the tips at most.
    """
    found = {k: peak_of(runs, rom, k) for k in ORDERS}
    return {f"EO {k}": _at(runs, scene, rom, peak) for k, peak in found.items() if peak}


def _at(runs: xr.Dataset, scene: Scene, rom: Rom, peak: Peak) -> dict[str, Any]:
    """Numbers at a peak."""
    at, count = runs.isel(speed_over_f1=peak.index), scene.stage.count if scene.stage else 1
    amplitude = (peak.amplitude or 0.0) * leading_gap(runs)
    along = at["blade_along"].sel(order=peak.k) if scene.stage else xr.DataArray([amplitude])
    return {
        "speed": peak.Omega_c,
        "stands_out": int(peak.reported),
        "amplitude_um": UM * amplitude,
        "median_um": UM * float(along.median()),
        "least_um": UM * float(along.min()),
        "largest_um": UM * float(at["displacement"]),
        "wear_um": UM * float(leading_wear(at).max()),
        "worst": int(at["worst"]) if scene.stage else 0,
        "steady": _steady(scene, rom, float(at["speed"]), peak.k, PASSES // count),
    }


def _steady(scene: Scene, rom: Rom, Omega: float, k: float | None, rounds: int) -> dict[str, Any]:
    """The same at one speed, of a run from rest that ends when it is steady."""
    unused = dict.fromkeys(OF_LAST_ROUNDS)
    scene = scene.but(until="steady", rounds=rounds, record=unused)
    run = Case(scene, rom, prepare(scene, rom, Omega)).march()
    of = numbers(run, k)
    return {
        "status": run.outcome.status,
        "trend": run.outcome.trend,
        "rounds": run.outcome.rounds,
        "amplitude_um": UM * of["amplitude"] if "amplitude" in of else None,
        "wear_um": UM * of["wear"],
    }


def table(rows: Sequence[ComputedRow]) -> str:
    """Table of the page: a line for each row; of draws lines of quantiles with their intervals.

    Those of which the draws are enough, and that of 90 %.
    """
    lines = []
    for group, these in frame(rows).groupby("group", sort=False):
        if these["row"].str.startswith("draw").all():
            shares = [s for s in SHARES if s == 0.9 or needed(s) <= len(these)]
            lines += [
                [f"{group}: {100 * share:.0f} % of {len(these)} draws", *_cells(these, share)]
                for share in shares
            ]
        else:
            lines += [
                [f"{group}: {row}", *_cells(one, 0.5)]
                for row, one in these.groupby("row", sort=False)
            ]
    heads = [head.format(k) for k in ORDERS for head in COLUMNS.values()]
    return markdown.table(["blades", *heads], lines)


def _cells(rows: pd.DataFrame, share: float) -> list[str]:
    """Cells of one row, or of a quantile of draws."""
    return [
        _later(rows, k, share) if name == "steady" else _shown(rows[f"EO {k} {name}"], share)
        for k in ORDERS
        for name in COLUMNS
    ]


def _later(rows: pd.DataFrame, k: int, share: float) -> str:
    """Amplitude of the runs that go on, and how many of them are steady in the end."""
    of = rows.filter(like=f"EO {k} steady").rename(columns=lambda name: name.split()[-1])
    steady, amplitudes = int((of["trend"] == STEADY).sum()), of["amplitude_um"].dropna()
    shown = _shown(amplitudes, share) if len(amplitudes) else of["status"].iloc[0]
    if len(rows) > 1:
        return f"{shown}; {steady} steady"
    return f"{shown}{'' if steady else ', not steady'} after {of['rounds'].iloc[0]:.0f} rev."


def _shown(values: pd.Series, share: float) -> str:
    """A value; of draws their quantile with its interval. Less than ``LEAST`` is 0."""
    known = values.dropna().astype(float)
    if not len(known):
        return "-"
    found = quantile(known, share)[:3] if len(values) > 1 else known
    value, *interval = (f"{of if of >= LEAST else 0:.3g}" for of in found)
    return f"{value} ({' to '.join(interval)})" if interval else value
