"""||Y|| and Omega_c over Table 1's grid of E and K, Figs. 13a, 13b; its worst coatings for longer.

Claims C17 to C19, C25 and C26.
"""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from rom.model import Rom
from simulate.contact.gaps import given_gaps
from simulate.marching import march, prepare
from simulate.scene import LEADING, Scene
from simulate.signals import amplitude, spectrum
from simulate.sweeps.dataset import statuses
from simulate.sweeps.over_speeds import as_sweep, at_speeds
from workflow.paper.peaks import departure, peak
from workflow.paper.published import WORST, E, K

ORDER = "4"  # engine order of the peaks that are compared
ROUNDS = 200  # ten times the paper's
WINDOW = 10  # revolutions of each Fourier transform

type Case = dict[str, Any]


def of_coating(runs: xr.Dataset, rom: Rom, scene: Scene) -> Case:
    """One coating of the grid: E and K, number of runs, statuses, peaks with their twins."""
    peaks = {str(k): peak(runs, rom, k) for k in scene.peaks.orders}
    return {
        "E": scene.liner.law.E,
        "K": scene.liner.law.K,
        "runs": runs.sizes["speed_over_f1"],
        "statuses": statuses(runs),
        "peaks": {k: p and p | _predictable(rom, scene, p) for k, p in peaks.items()},
    }


def _predictable(rom: Rom, scene: Scene, numbers: Case) -> dict[str, Any]:
    """Status of the run at a peak, and its difference from its twin."""
    with_twin = at_speeds(scene.but(twin=True), rom, [numbers["Omega_c"] * rom.omega1])
    run = as_sweep(with_twin, check=False).isel(speed_over_f1=0)
    return {"status": str(run["status"].item()), "departure": departure(run)}


def of_rows(rows: Sequence[Case]) -> dict[str, Any]:
    """The table from the rows of an experiment, those on the scene `grid`."""
    cases = [row["numbers"] for row in rows if row["scene"] == "grid"]
    orders = sorted({int(k) for case in cases for k in case["peaks"]})
    return {"E": list(E), "K": list(K), "orders": orders, "cases": cases}


def worst(table: Mapping[str, Any]) -> Case | None:
    """The case with the highest peak; None where none has a peak."""
    with_peak = [case for case in table["cases"] if case["peaks"][ORDER]]
    return max(with_peak, key=lambda case: case["peaks"][ORDER]["amplitude"], default=None)


def coating_of(table: Mapping[str, Any], young: float, plastic: float) -> Case:
    """The case of one coating."""
    return next(c for c in table["cases"] if (c["E"], c["K"]) == (young, plastic))


def long_cases(table: Mapping[str, Any]) -> dict[str, Case]:
    """The cases whose growth is followed, by name; none where the paper's has no peak."""
    paper = coating_of(table, *WORST)
    cases = {"worst found": worst(table), "the paper's worst": paper}
    return cases if paper["peaks"][ORDER] else {}


def growth(scene: Scene, rom: Rom, name: str, case: Mapping[str, Any]) -> dict[str, Any]:
    """Amplitudes of a coating over the revolutions, at its Omega_c.

    ``scene``: that of the coating; ``case``: its numbers, as of the table of E and K.

    Returns
    -------
    dict
        ``rounds``, the ends of the windows, and the ``amplitude`` over the gap in each, None after
        the end of a run; name, coating, speed and status.
    """
    speed = case["peaks"][ORDER]["Omega_c"]
    long = scene.but(rounds=ROUNDS, record__history={"chord": [LEADING]})
    outcome = march(long, prepare(long, rom, speed * rom.omega1))
    windows = outcome.u_r[:, 0].reshape(ROUNDS // WINDOW, -1)
    gap = float(given_gaps(scene.gaps, rom, LEADING))
    amplitudes = [amplitude(spectrum(window), WINDOW, int(ORDER)) / gap for window in windows]
    return {
        "name": name,
        "E": case["E"],
        "K": case["K"],
        "Omega_c": speed,
        "status": outcome.status,
        "rounds": [WINDOW * (i + 1) for i in range(len(amplitudes))],
        "amplitude": [None if np.isnan(value) else float(value) for value in amplitudes],
    }
