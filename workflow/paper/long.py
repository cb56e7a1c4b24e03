"""Numbers of long times: runs that go on from others, beyond the paper's twenty revolutions."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr

from simulate.signals import leading_gap, leading_wear
from simulate.sweeps.dataset import Sweep, scene_of
from simulate.sweeps.peak import along_order
from workflow.markdown import cell, records, table as rows_of
from workflow.paper.published import ENGINE_ORDER

SWEEPS = {"rest": "from rest", "run_up": "run-up", "run_down": "run-down", "on_worn": "worn liner"}


def numbers(
    long: list[Sweep], rest: Sweep, run_up: Sweep, run_down: Sweep, on_worn: Sweep
) -> dict[str, Any]:
    """Amplitudes along EO 4 over the revolutions and on ways through its peak; speeds over f1(0).

    ``long``: sweeps at the same speeds, each from where the one before ended; the others go through
    the peak, as ``SWEEPS`` calls them.
    """
    through = zip(SWEEPS, (rest, run_up, run_down, on_worn), strict=True)
    return {
        "rounds": np.cumsum([scene_of(runs).rounds for runs in long]).tolist(),
        "speeds": long[0]["speed_over_f1"].values.tolist(),
        "amplitude": [along_order(runs, ENGINE_ORDER).tolist() for runs in long],
        "wear": [_deepest(runs).tolist() for runs in long],
        "status": [runs["status"].values.tolist() for runs in long],
        "through": {name: _way(runs) for name, runs in through},
    }


def _deepest(runs: xr.Dataset) -> np.ndarray:
    return leading_wear(runs).max(axis=1) / leading_gap(runs)


def _way(runs: xr.Dataset) -> dict[str, float]:
    """Largest amplitude and its speed, amplitude at the last speed, deepest wear."""
    along = along_order(runs, ENGINE_ORDER)
    best = int(np.nanargmax(along))
    return {
        "largest": float(along[best]),
        "at": float(runs["speed_over_f1"][best]),
        "at_highest": float(along[-1]),
        "deepest_wear": float(_deepest(runs).max()),
    }


def table(numbers: Mapping[str, Any]) -> str:
    """Two tables: over the revolutions, or how a run ended before, and through the peak."""
    speeds = [f"{speed:.3f}" for speed in numbers["speeds"]]
    lines = [
        [f"after {rounds} revolutions", *map(cell, along, ends)]
        for rounds, along, ends in zip(
            numbers["rounds"], numbers["amplitude"], numbers["status"], strict=True
        )
    ]
    by_way = [
        {
            "": SWEEPS[name],
            "largest ‖Y‖ / gap": f"{way['largest']:.2f}",
            "at Ω / f₁(0)": f"{way['at']:.3f}",
            "at the highest speed": f"{way['at_highest']:.2f}",
            "worn depth / gap": f"{way['deepest_wear']:.2f}",
        }
        for name, way in numbers["through"].items()
    ]
    return f"{rows_of(['‖Y‖ / gap at Ω / f₁(0) =', *speeds], lines)}\n\n{records(by_way)}"
