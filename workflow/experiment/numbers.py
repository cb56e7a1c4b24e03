"""Functions of experiments: from the results of a row to its numbers.

Their arguments are named after what they use: ``runs``, the sweep of the row; ``single``, its run
at the first speed alone; ``scene``; ``rom``, its model; ``reference``, the row with which it is
compared; and files of the model that the experiment ``needs``.
"""

from collections import Counter
from typing import Any

import xarray as xr

from rom.model import Rom
from simulate.errors.signals import amplitude, leading_gap, leading_wear
from simulate.scene import Scene
from simulate.sweeps.peak_results import asked


def peaks(runs: xr.Dataset, rom: Rom, scene: Scene) -> dict[str, Any]:
    """Number of runs by status, and the reported peaks; without one the largest response.

    Of each Omega_c over f1(0), ||Y|| and the deepest wear of the leading eighth there over the gap
    at xi = 1/16, as far as they are recorded.
    """
    found: dict[str, Any] = dict(Counter(map(str, runs["status"].values)))
    for peak in asked(runs, rom):
        run, gap, at = (
            runs.isel(speed_over_f1=[peak.index]),
            leading_gap(runs),
            {"Omega_c": peak.Omega_c},
        )
        if "spectrum" in runs:
            rounds = scene.record.spectrum_rounds
            at["amplitude"] = float(amplitude(run["spectrum"].values[0], rounds, peak.k)) / gap
        if "wear" in runs:
            at["wear"] = float(leading_wear(run).max()) / gap
        found[f"k = {peak.k}" if peak.k else "largest"] = at
    return found
