"""Amplitude of the k = 4 peak over both moduli in Pa, and the range of the paper's table."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import BoundaryNorm
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from geometry.files import read_json
from workflow.figures import style
from workflow.figures.response import Response
from workflow.paper.cases import WORST, E, K
from workflow.paper.stiffness import SCALES, amplitudes

GIGA = 1e-9
LEVELS = np.arange(0, 2.41, 0.2)  # gaps


def load(files: Any) -> tuple[dict[str, Any], float]:
    """Read ``files.map``, stiffness.json, and the unit of E of a sweep, ``files.sweep``."""
    return read_json(files.map), Response.read(files.sweep).scene.liner.law.unit_Pa


@style.styled
def draw(study: dict[str, Any], kept: float) -> Figure:
    """One map for each casing amplitude."""
    drawn, panels = style.subplots(
        style.DOUBLE, 2.9, columns=len(SCALES), letters=True, sharex=True, sharey=True
    )
    for axes, scale in zip(panels, SCALES, strict=True):
        mesh = axes.contourf(
            GIGA * np.array(study["E_Pa"]),
            GIGA * np.array(study["K_Pa"]),
            np.ma.masked_invalid(amplitudes(study["cases"], scale).T),
            levels=LEVELS,
            norm=BoundaryNorm(LEVELS, style.MAP.N),
            cmap=style.MAP,
            extend="max",
        )
        _window(axes, kept, "-", f"unit of E as kept, {GIGA * kept:g} GPa")
        if unit := best_unit(study, scale):
            _window(axes, unit, "--", "unit at which its (10, 4.55) is closest to the worst case")
        axes.set_title(f"casing amplitude {scale:g} gaps", loc="right")
        axes.set(xscale="log", yscale="log", xlabel="Young modulus (GPa)")
    panels[0].set_ylabel("plastic modulus (GPa)")
    drawn.colorbar(mesh, ax=list(panels), label=rf"$\|Y\|$ {style.OVER_GAP}, $k$ = 4", aspect=25)
    style.legend(drawn, "lower center", ncols=2, title="the paper's table")
    return drawn


def best_unit(study: dict[str, Any], scale: float) -> float | None:
    """Unit of E (Pa) at which the amplitude of the paper's worst case is closest to the largest.

    The largest is that within the range of the paper's table, for the same unit.
    """
    of_scale = [case for case in study["worst"] if case["scale"] == scale]
    best = max(of_scale, key=lambda case: case["share_of_paper_worst"], default=None)
    return best and best["unit_Pa"]


def _window(axes: Axes, unit: float, dashes: str, label: str) -> None:
    """Outline of the paper's table for a unit of E, and its worst case."""
    u = GIGA * unit
    corner, width, height = (u * E[0], u * K[0]), u * (E[-1] - E[0]), u * (K[-1] - K[0])
    look = {"edgecolor": style.BLACK, "facecolor": "none", "linewidth": 1.0, "linestyle": dashes}
    axes.add_patch(Rectangle(corner, width, height, label=label, **look))
    axes.plot(
        u * WORST[0], u * WORST[1], "o", color=style.BLACK, markersize=5,
        markerfacecolor="white" if dashes == "-" else style.BLACK,
        label="its (10, 4.55)" if dashes == "-" else None,
    )  # fmt: skip
