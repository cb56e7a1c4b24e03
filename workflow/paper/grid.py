"""Peaks of a sweep as plain values; those over Table 1's grid of E and K, Figs. 13a, 13b.

And its worst coatings for longer: claims C17 to C19, C25 and C26. Speeds are over f1(0),
displacements and wear over the gap at xi = 1/16. Displacements are those at xi = 1/16, wear is the
mean over the leading eighth of the chord.
"""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from rom.model import Rom
from simulate.contact.gaps import given_gaps
from simulate.marching import march, prepare
from simulate.scene import LEADING, Scene
from simulate.signals import (
    LOBE_BLUR,
    amplitude,
    blurred,
    leading_gap,
    leading_wear,
    lobe_count,
    spectrum,
)
from simulate.sweeps.dataset import statuses
from simulate.sweeps.over_speeds import as_sweep, at_speeds
from simulate.sweeps.peak import peak_of
from workflow.paper.published import ENGINE_ORDER, WORST, E, K

OF_PEAK = ("Omega_c", "over_crossing", "amplitude", "at_end", "clear")  # of ``Peak.plain``
ORDER = str(ENGINE_ORDER)  # of the peaks that are compared
ROUNDS = 200  # ten times the paper's
WINDOW = 10  # revolutions of each Fourier transform

type Numbers = dict[str, Any]


def peak(runs: xr.Dataset, rom: Rom, k: int) -> dict[str, Any] | None:
    """The peak along engine order ``k``; None if no run near it has a result."""
    # the two diameters of the paper's casing couple k to k - 2 and k + 2
    main = peak_of(runs, rom, k, harmonics=[2])
    if main is None:
        return None
    run, values = runs.isel(speed_over_f1=main.index), main.plain()
    return (
        {name: values[name] for name in OF_PEAK}
        | _end(run)
        | ({"largest": float(run["largest"]) / leading_gap(runs)} if "largest" in runs else {})
        | (worn_at(runs, main.index) if "wear" in runs else {})
    )


def _end(run: xr.Dataset) -> dict[str, Any]:
    """Status of a run, and its largest relative difference from its twin, inf as 1e300.

    None for the difference without a twin.
    """
    largest = float(np.max(run["departure"].values)) if "departure" in run else np.nan
    return {
        "status": str(run["status"].item()),
        "departure": None if np.isnan(largest) else min(largest, 1e300),
    }


def worn_at(runs: xr.Dataset, index: int) -> dict[str, Any]:
    """Worn profile at the speed with this index.

    ``between_lobes``: shallowest over deepest depth of the blurred profile, 1 for uniform wear, 0
    without.
    """
    (wear,) = leading_wear(runs.isel(speed_over_f1=[index])) / leading_gap(runs)
    smooth = blurred(wear, LOBE_BLUR)
    return {
        "lobes": lobe_count(wear),
        "deepest_wear": float(wear.max()),
        "between_lobes": float(smooth.min() / smooth.max()) if smooth.max() > 0 else 0.0,
    }


def of_coating(runs: xr.Dataset, rom: Rom, scene: Scene) -> Numbers:
    """One coating of the grid: E and K, number of runs, statuses, peaks with their twins."""
    peaks = {str(k): peak(runs, rom, k) for k in scene.peaks.orders}
    return {
        "E": scene.liner.law.E,
        "K": scene.liner.law.K,
        "runs": runs.sizes["speed_over_f1"],
        "statuses": statuses(runs),
        "peaks": {k: p and p | _predictable(rom, scene, p) for k, p in peaks.items()},
    }


def _predictable(rom: Rom, scene: Scene, numbers: Numbers) -> dict[str, Any]:
    """Status of the run at a peak, and its difference from its twin."""
    with_twin = at_speeds(
        scene.but(verify={"predictable": True}), rom, [numbers["Omega_c"] * rom.omega1]
    )
    return _end(as_sweep(with_twin, check=False).isel(speed_over_f1=0))


def of_rows(rows: Sequence[Numbers]) -> dict[str, Any]:
    """The table from the rows of an experiment, those on the scene `grid`."""
    cases = [row["numbers"] for row in rows if row["scene"] == "grid"]
    orders = sorted({int(k) for case in cases for k in case["peaks"]})
    return {"E": list(E), "K": list(K), "orders": orders, "cases": cases}


def worst(table: Mapping[str, Any]) -> Numbers | None:
    """The case with the highest peak; None where none has a peak."""
    return max(
        (case for case in table["cases"] if case["peaks"][ORDER]),
        key=lambda case: case["peaks"][ORDER]["amplitude"],
        default=None,
    )


def long_cases(table: Mapping[str, Any]) -> dict[str, Numbers]:
    """The cases whose growth is followed, by name; none where the paper's has no peak."""
    (paper,) = [case for case in table["cases"] if (case["E"], case["K"]) == WORST]
    followed = {"worst found": worst(table), "the paper's worst": paper}
    return followed if paper["peaks"][ORDER] else {}


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
    gap = float(given_gaps(scene.gaps, rom, LEADING))
    amplitudes = [
        float(amplitude(spectrum(window), WINDOW, ENGINE_ORDER) / gap)
        for window in outcome.u_r[:, 0].reshape(ROUNDS // WINDOW, -1)
    ]
    return {
        "name": name,
        "E": case["E"],
        "K": case["K"],
        "Omega_c": speed,
        "status": outcome.status,
        "rounds": [*range(WINDOW, ROUNDS + 1, WINDOW)],
        "amplitude": [None if np.isnan(value) else value for value in amplitudes],
    }
