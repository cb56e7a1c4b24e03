"""Functions of numbers: from the results of a row to its numbers.

Their arguments are named after their values: ``runs``, the sweep of the row; ``single``, its run
at the first speed alone; ``scene``; ``rom``, its model; ``reference``, the row with which it is
compared; and files of the model that the experiment ``needs``.
"""

from typing import Any

import numpy as np
import xarray as xr

from rom.model import Rom
from simulate.signals import leading_gap, leading_wear
from simulate.sweeps.dataset import statuses
from simulate.sweeps.peak import along_order, reported
from simulate.sweeps.result_types import mode_name


def peaks(runs: xr.Dataset, rom: Rom) -> dict[str, Any]:
    """Number of runs by status; the largest response, and the reported peaks by engine order.

    Of each its speed, Omega over f1(0), the amplitude of u_r at xi = 1/16, and the deepest wear of
    the leading eighth of the chord, over the gap there, as far as they are recorded.
    """
    outputs = {  # the variable of the sweep that each needs, and how it follows, of an order
        "speed": ("speed_over_f1", lambda _: runs["speed_over_f1"].values),
        "amplitude": ("spectrum", lambda k: along_order(runs, k)),
        "wear": ("wear", lambda _: leading_wear(runs).max(axis=1) / leading_gap(runs)),
    }

    def over_speeds(k: float | None = None) -> dict[str, Any]:
        """Arrays (speeds,) by name; the amplitude is along ``k``, or the largest of all orders."""
        return {name: make(k) for name, (needed, make) in outputs.items() if needed in runs}

    def values_at(index: int, k: float | None = None) -> dict[str, float]:
        """The same at one speed."""
        return {name: float(values[index]) for name, values in over_speeds(k).items()}

    numbers: dict[str, Any] = {**statuses(runs)}
    found = reported(runs, rom)
    _, *responses = over_speeds().values()
    if responses:
        has_result = np.isfinite(responses[0]).any()
        numbers["largest"] = values_at(int(np.nanargmax(responses[0]))) if has_result else {}
    names = (
        ", ".join([f"k = {peak.k:g}", *[mode_name(peak.modes)] * (tuple(peak.modes) != (1,))])
        for peak in found
    )
    return numbers | {
        name: values_at(peak.index, peak.k) for name, peak in zip(names, found, strict=True)
    }
