"""Tables of a blade's frequencies: with either prestress, and with other cuts of its edges."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from simulate.peaks import crossing_of
from workflow.markdown import table

HZ = 2 * np.pi  # rad/s
VARIANTS = ("nonlinear", "linear")


def markdown(frequencies: Mapping[str, Any]) -> str:
    """Frequencies at three speeds with either prestress, and where engine order 4 meets f1."""
    speeds = frequencies["speeds_rad_s"]
    found = {variant: np.array(frequencies[f"{variant}_rad_s"]) for variant in VARIANTS}
    modes = range(1, found["linear"].shape[1] + 1)
    rows = [_row("at rest", found["nonlinear"][0])]
    for j in (1, 2):
        rows += [_row(f"{speeds[j]:g} rad/s, {v}", found[v][j]) for v in VARIANTS]
    meets = ", ".join(f"{crossing(speeds, found[v][:, 0], 4):.4f} ({v})" for v in VARIANTS)
    shown = table(["Hz", *(f"mode {m}" for m in modes)], rows)
    return f"{shown}\n\nEngine order 4 meets f1 at Ω / f1(0) = {meets}."


def crossing(speeds: ArrayLike, omega: ArrayLike, k: int) -> float:
    """Speed over omega(0) where k Omega = omega(Omega); nan where it is above the last of three.

    Between them omega^2 is a parabola in Omega^2, in which it is smooth.
    """
    over_rest = np.array([speeds, omega]) / omega[0]
    squares = np.polyfit(*over_rest**2, 2)
    return crossing_of(lambda speed: np.sqrt(np.polyval(squares, speed**2)), k, over_rest[0, -1])


def edge_cuts(study: Mapping[str, Any]) -> str:
    """Frequencies at rest for other cuts of the edges, less those of the blade's own cut."""
    own = study["cut_percent"].index(study["own_percent"])
    values = np.array(study["at_rest_Hz"])
    modes = range(1, len(values[0]) + 1)
    rows = [
        [f"{cut:g} instead of {study['own_percent']:g}"]
        + [f"{change:+.2f} %" for change in 100 * (row / values[own] - 1)]
        for cut, row in zip(study["cut_percent"], values, strict=True)
        if cut != study["own_percent"]
    ]
    return table(["at rest, cut % of chord", *(f"mode {m}" for m in modes)], rows)


def _row(label: str, omega: ArrayLike) -> list[str]:
    return [label, *(f"{value:.1f}" for value in np.asarray(omega) / HZ)]
