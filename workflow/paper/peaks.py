"""Peaks and wear of a sweep as plain values.

Speeds are over f1(0), displacements and wear over the gap at xi = 1/16. Displacements are those at
xi = 1/16, wear is the mean over the leading eighth of the chord.
"""

from typing import Any

import numpy as np
import xarray as xr

from rom.model import Rom
from simulate.signals import LOBE_BLUR, blurred, leading_gap, leading_wear, lobe_count
from simulate.sweeps.peak import peak_of

OF_PEAK = ("Omega_c", "over_crossing", "amplitude", "at_end", "clear")  # of ``Peak.plain``


def peak(runs: xr.Dataset, rom: Rom, k: int) -> dict[str, Any] | None:
    """The peak along engine order ``k``; None if no run near it has a result."""
    # the two diameters of the paper's casing couple k to k - 2 and k + 2
    main = peak_of(runs, rom, k, harmonics=[2])
    if main is None:
        return None
    run, values = runs.isel(speed_over_f1=main.index), main.plain()
    values = {name: values[name] for name in OF_PEAK} | {
        "status": str(run["status"].item()),
        "departure": departure(run),
    }
    if "largest" in runs:
        values["largest"] = float(run["largest"]) / leading_gap(runs)
    return values | (worn_at(runs, main.index) if "wear" in runs else {})


def departure(run: xr.Dataset) -> float | None:
    """Largest relative difference of a run from its twin; None without a twin, inf as 1e300."""
    if "departure" not in run:
        return None
    largest = float(np.max(run["departure"].values))
    return None if np.isnan(largest) else min(largest, 1e300)


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
