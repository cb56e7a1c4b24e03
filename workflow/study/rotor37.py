"""Tables of frequencies of rotor 37: either prestress, running geometry, other edges.

Rows are those of an experiment with ``frequencies.numbers``.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fem.assemble import STATES
from simulate.sweeps.crossings import crossings_of
from workflow import markdown
from workflow.experiment.row import ExperimentRow

CUT = "cut"  # group of the rows with other cuts
RUNS = "geometry as it runs"  # at the last speed
MODES = 8  # of the tables
HEADS = [f"mode {m}" for m in range(1, MODES + 1)]


def prestress_table(rows: Sequence[ExperimentRow]) -> str:
    """Frequencies at three speeds with either prestress, and the crossing of engine order 4.

    Also with the geometry taken for that at the last speed.
    """
    speeds, f = rows[0]["numbers"]["speeds_rad_s"], _frequencies(rows)
    lines = [_line("at rest", f["nonlinear"][0]), _line(f"at rest, {RUNS}", f["running"][0])]
    for j in (1, 2):
        lines += [_line(f"{speeds[j]:g} rad/s, {name}", f[name][j]) for name in STATES]
    lines += [_line(f"{speeds[2]:g} rad/s, nonlinear, {RUNS}", f["running"][2])]
    omega = {name: 2 * np.pi * f[name][:, 0] for name in STATES}
    crossings = ", ".join(f"{crossing(speeds, omega[n], 4):.4f} ({n})" for n in STATES)
    shown = markdown.table(["Hz", *HEADS], lines)
    return f"{shown}\n\nEngine order 4 crosses f1 at Ω / f1(0) = {crossings}."


def crossing(speeds: ArrayLike, omega: ArrayLike, k: int) -> float:
    """Speed over omega(0) at which k Omega = omega(Omega); nan above the last of the ``speeds``.

    Between the three speeds omega^2 is interpolated by a parabola in Omega^2.
    """
    over_rest = np.array([speeds, omega]) / omega[0]
    squares = np.polyfit(*over_rest**2, 2)
    met = crossings_of(
        lambda speed: np.sqrt([np.polyval(squares, speed**2)]), [k], 0.0, over_rest[0, -1]
    )
    return met[0][2] if met else np.nan


def edge_cuts_table(rows: Sequence[ExperimentRow]) -> str:
    """Relative change of the frequencies at rest for other cuts of the edges."""
    first = {name: f[0] for name, f in _frequencies(rows).items()}
    changes = {
        row["row"]: first[row["row"]] / first[row["against"]] - 1
        for row in rows
        if row["group"] == CUT
    }
    lines = [[name, *(f"{100 * change:+.2f} %" for change in f)] for name, f in changes.items()]
    return markdown.table(["at rest, cut % of chord", *HEADS], lines)


def _frequencies(rows: Sequence[ExperimentRow]) -> dict[str, NDArray[np.float64]]:
    """Frequencies (speeds, ``MODES``), Hz, by row."""
    return {row["row"]: np.array(row["numbers"]["frequencies_Hz"])[:, :MODES] for row in rows}


def _line(label: str, f: NDArray[np.float64]) -> list[str]:
    return [label, *(f"{value:.1f}" for value in f)]
