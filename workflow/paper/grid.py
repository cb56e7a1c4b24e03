"""||Y|| and Omega_c over Table 1's grid of E and K: Figs. 13a, 13b."""

from collections.abc import Sequence
from typing import Any

import xarray as xr

from rom.model import Rom
from simulate.scene import Scene
from simulate.sweeps.dataset import statuses
from simulate.sweeps.over_speeds import at_speeds
from workflow.paper.cases import E, K
from workflow.paper.peaks import departure, peak

type Case = dict[str, Any]


def of_coating(runs: xr.Dataset, rom: Rom, scene: Scene) -> Case:
    """One coating of the grid: E and K, number of runs, statuses, and peaks by order.

    At each peak the twin is marched as well.
    """
    peaks = {str(k): peak(runs, rom, k) for k in scene.peaks.orders}
    return {
        "E": scene.liner.law.E,
        "K": scene.liner.law.K,
        "runs": runs.sizes["speed_over_f1"],
        "statuses": statuses(runs),
        "peaks": {k: p and p | _predictable(rom, scene, p) for k, p in peaks.items()},
    }


def _predictable(rom: Rom, scene: Scene, at: Case) -> dict[str, Any]:
    """Status of the run at a peak, and its difference from its twin."""
    with_twin = at_speeds(scene.but(twin=True), rom, [at["Omega_c"] * rom.omega1])
    run = with_twin.isel(speed_over_f1=0)
    return {"status": str(run["status"].item()), "departure": departure(run)}


def grid(cases: Sequence[Case]) -> dict[str, Any]:
    """The whole table from its cases."""
    orders = sorted({int(k) for case in cases for k in case["peaks"]})
    return {"E": list(E), "K": list(K), "orders": orders, "cases": list(cases)}


def of_rows(rows: Sequence[Case]) -> dict[str, Any]:
    """The table from the rows of an experiment, those on the scene `grid`."""
    return grid([row["numbers"] for row in rows if row["scene"] == "grid"])


def worst(table: dict[str, Any], k: int = 4) -> Case:
    """The case with the highest peak along engine order ``k``."""
    with_peak = [case for case in table["cases"] if case["peaks"][str(k)]]
    return max(with_peak, key=lambda case: case["peaks"][str(k)]["amplitude"])


def at(table: dict[str, Any], young: float, plastic: float) -> Case:
    """The case of one coating."""
    return next(c for c in table["cases"] if (c["E"], c["K"]) == (young, plastic))
