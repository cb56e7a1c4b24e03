"""Functions of experiments: from the results of a row to its numbers.

Their arguments are named after what they use: ``runs``, the sweep of the row; ``single``, its run
at the first speed alone; ``scene``; ``rom``, its model; ``reference``, the row with which it is
compared; and files of the model that the experiment ``needs``.
"""

from typing import Any

import numpy as np
import xarray as xr

from rom.model import Rom
from simulate.errors.signals import amplitude, leading_gap, leading_wear
from simulate.scene import Scene
from simulate.sweeps.dataset import statuses
from simulate.sweeps.peak import peaks_of


def peaks(runs: xr.Dataset, rom: Rom, scene: Scene) -> dict[str, Any]:
    """Number of runs by status; the largest response, and the reported peaks by engine order.

    Of each its speed, Omega over f1(0), the amplitude of u_r at xi = 1/16, and the deepest wear of
    the leading eighth of the chord, over the gap there, as far as they are recorded.
    """
    found: dict[str, Any] = {**statuses(runs)}
    gap, speeds, rounds = (
        leading_gap(runs),
        runs["speed_over_f1"].values,
        scene.record.spectrum_rounds,
    )
    if "wear" in runs:
        worn = leading_wear(runs).max(axis=1) / gap

    def at(index: int, k: int | None) -> dict[str, float]:
        of = {"speed": float(speeds[index])}
        if rounds:
            bins = runs["spectrum"].values[index]
            of["amplitude"] = float(amplitude(bins, rounds, k)) / gap
        return of | ({"wear": float(worn[index])} if "wear" in runs else {})

    if rounds:
        along = amplitude(runs["spectrum"].values, rounds)
        found["largest"] = at(int(np.nanargmax(along)), None) if np.isfinite(along).any() else {}
        for k, peak in peaks_of(runs, rom).items():
            if peak.reported:
                found[f"k = {k}"] = at(peak.index, k)
    elif "wear" in runs:
        found["largest"] = at(int(worn.argmax()), None)
    return found
