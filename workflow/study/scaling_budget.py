"""Many runs from the study's numbers: a million on cores, ten million on a GPU on paper."""

from collections.abc import Mapping
from math import ceil
from typing import Any, NamedTuple

from simulate.sweeps.design_runs import SAVED_EVERY

MANY_ROWS = 10_000  # of one design in the plan of a million runs
BLOCK_S = 600.0  # own work of a block: what surrounds a job takes some ten seconds
FILES = 3  # of a block: its table, its log, its benchmark


class Gpu(NamedTuple):
    """A GPU of which the data sheet is known: NVIDIA H100 SXM."""

    flops: float = 34e12  # 1/s, float64 without tensor cores
    bandwidth: float = 3.35e12  # bytes/s
    memory: float = 80e9  # bytes
    processors: int = 132


SHARE = 0.1  # of the peak rate that branching contact may reach; assumed
AT_ONCE = 16  # runs on a processor, a warp each; assumed
STEP_S = 3e-6  # time of a step of one run there, a chain of dependent sums; assumed
ROD_FLOPS, ROD_BYTES, MODE_FLOPS = 25, 16, 10  # of a rod under the tip and of a mode, each step
UNDER_TIP = 4  # rods of a strip under the tip or passed in a step


def largest(points: list[dict[str, Any]]) -> dict[str, Any]:
    """Point of the largest x."""
    return max(points, key=lambda point: point["x"])


def growth(points: list[dict[str, Any]], name: str) -> float:
    """Growth of a number per unit of x between the first and the last point."""
    first, last = points[0], largest(points)
    return (last[name] - first[name]) / (last["x"] - first["x"])


def million(points: Mapping[str, Any], runs: int = 10**6) -> dict[str, float]:
    """A plan of ``runs`` runs of one speed: designs of ``MANY_ROWS`` rows in blocks of minutes."""
    one, rows = points["march"]["rods"][0], points["rows"]
    of_row = growth(rows["design"], "seconds")  # each block reads and checks all rows of its design
    designs = runs // MANY_ROWS
    blocks = max(1, round(MANY_ROWS * one["seconds"] / BLOCK_S))
    beside, block_s = blocks * MANY_ROWS * of_row, MANY_ROWS * one["seconds"] / blocks
    parts = ceil(block_s / SAVED_EVERY)
    table, of_rows = largest(rows["tables"]), growth(rows["tables"], "peak_MB")
    return {
        "run_s": one["seconds"],
        "core_h": runs * one["seconds"] / 3600,
        "designs": designs,
        "rows": MANY_ROWS,
        "blocks": designs * blocks,
        "block_s": block_s,
        "beside_share": beside / (MANY_ROWS * one["seconds"]),
        "files": designs * ((FILES + parts) * blocks + 2),
        "runs_GB": runs * table["bytes"] / table["x"] / 1e9,
        "rows_GB": runs * table["row_bytes"] / table["x"] / 1e9,
        "block_MB": largest(rows["design"])["peak_MB"],
        "tables_MB": largest(rows["tables"])["peak_MB"],
        # all in one design instead
        "one_block_s": runs * of_row,
        "one_block_GB": runs * growth(rows["design"], "peak_MB") / 1e3,
        "one_tables_GB": runs * of_rows / 1e3,
        # all as sweeps instead
        "sweep_GB": runs * growth(points["speeds"]["merge"], "held") / 1e9,
        "plan_s": designs * blocks * growth(points["jobs"]["plan"], "seconds"),
    }


def large_mesh(
    points: Mapping[str, Any],
    exponents: Mapping[str, Any],
    nodes: int = 300_000,
    memory_GB: float = 24.0,
) -> dict[str, float]:
    """The full model on a larger mesh than was measured, by its exponents."""
    full, power = points["mesh"]["full_model"], exponents["mesh"]["full_model"]
    first, last = full[0]["peak_MB"], full[-1]
    above, times = last["peak_MB"] - first, nodes / last["x"]
    most = ((1e3 * memory_GB - first) / above) ** (1 / power["peak_MB"])
    return {
        "nodes": nodes,
        "min": last["seconds"] * times ** power["seconds"] / 60,
        "GB": (first + above * times ** power["peak_MB"]) / 1e3,
        "nodes_in_memory": last["x"] * most,
    }


def breaks(points: Mapping[str, Any], memory_GB: float = 24.0) -> dict[str, float]:
    """Where each way of running many ends in ``memory_GB``, or in a minute."""
    merge, plan = points["speeds"]["merge"], points["jobs"]["plan"]
    of_speed, of_job = growth(merge, "peak_MB"), growth(plan, "seconds")
    return {
        "run_kB": growth(merge, "held") / 1e3,
        "speeds": 1e3 * memory_GB / of_speed,
        "speeds_in_2_GB": 2e3 / of_speed,
        "jobs_in_a_minute": 60 / of_job,
        "job_ms": 1e3 * of_job,
        "job_MB": growth(plan, "peak_MB"),
        "rows": 1e3 * memory_GB / growth(points["rows"]["tables"], "peak_MB"),
    }


def on_gpu(points: Mapping[str, Any], runs: int = 10**7, gpu: Gpu = Gpu()) -> dict[str, float]:  # noqa: B008
    """Bounds, s, of ``runs`` runs on a GPU, from the operations of a step."""
    one = points["march"]["rods"][0]
    n, m, nu = one["n"], one["strips"], one["x"]
    flops = 4 * m * n + MODE_FLOPS * n + m * UNDER_TIP * ROD_FLOPS
    moved = m * UNDER_TIP * ROD_BYTES * 2
    resident = gpu.processors * AT_ONCE
    return {
        "step_flops": flops,
        "run_Gflop": one["steps"] * flops / 1e9,
        "core_Gflops": one["steps"] * flops / one["seconds"] / 1e9,
        "core_h": runs * one["seconds"] / 3600,
        "rods_MB": m * nu * ROD_BYTES / 1e6,
        "in_memory": gpu.memory / (m * nu * ROD_BYTES),
        "rate_s": runs * one["steps"] * flops / (SHARE * gpu.flops),
        "bandwidth_s": runs * one["steps"] * moved / gpu.bandwidth,
        "chain_s": runs * one["steps"] * STEP_S / resident,
    }
