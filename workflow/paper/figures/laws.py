"""Fig. 5: laws of the liner, loaded, unloaded, loaded further and unloaded."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from simulate.scene.law import Law
from simulate.scene.laws.plastic import Plastic
from workflow.figures import style
from workflow.paper.laws import (
    COMPARED,
    LOADING,
    LOADING_ON,
    POINTS,
    RELOADING,
    STRAINS,
    UNLOADING,
    UNLOADING_AGAIN,
    loop,
    strain_at,
)

READABLE = Plastic(kind="plastic", E=1, K=0.45, sigma_Y=0.15, unit_MPa=1e-6)
LINES = (  # of the laws compared
    ("--", style.VERMILLION),
    ("-", style.GREY),
    ("-.", style.BLUE),
    ("-", style.BLACK),
)
STRESSES = (0.006, 0.01)  # at the ends of their two loadings, in their unit
PERCENT = 100
LOW, PART = 0.015, {"offset": (0, 1), "ha": "center", "va": "bottom"}  # arrows along the strains
THIN = {"color": style.GREY, "linewidth": 0.6}


@style.styled
def draw() -> Figure:
    """One plastic law with its parameters explained; below, the paper's laws at equal stress."""
    drawn, (explained, compared) = style.subplots(style.SINGLE, 4.3, 2, letters=True)
    _explained(explained)
    _compared(compared)
    return drawn


def _explained(axes: Axes) -> None:
    """Draw the stress-strain path of one law and label its slopes, limits and strains."""
    law = READABLE
    strain, stress = loop(law, STRAINS)
    axes.plot(strain.ravel(), stress.ravel(), color=style.BLACK)
    for x, y in zip(strain, stress, strict=True):
        i = POINTS // 3  # arrow heads before the middle: those of unloading and reloading differ
        axes.annotate("", (x[i + 1], y[i + 1]), (x[i], y[i]), arrowprops=style.ARROW)
    alpha, hardened = strain[UNLOADING, -1], stress[UNLOADING, 0]
    axes.plot([0, strain_at(law, law.sigma_Y)], [law.sigma_Y] * 2, ":", **THIN)
    axes.plot([0, STRAINS[0], STRAINS[0]], [hardened, hardened, 0], ":", **THIN)
    _triangle(axes, strain[LOADING], stress[LOADING], (0.06, 0.13), "$E$")
    _triangle(axes, strain[UNLOADING_AGAIN], stress[UNLOADING_AGAIN], (0.65, 0.73), "$E$")
    _triangle(
        axes,
        strain[LOADING_ON],
        stress[LOADING_ON],
        (0.6, 0.73),
        r"$\frac{EK}{E+K}$",
        above=True,
    )
    axes.set(xlim=(0, 0.9), ylim=(0, 0.42), xlabel="strain", ylabel="stress")
    axes.set_xticks([0, alpha, STRAINS[0]], ["0", r"$\alpha$", r"$\varepsilon$"])
    axes.set_yticks([0, law.sigma_Y, hardened], ["0", r"$\sigma_Y$", r"$\sigma_Y + K\alpha$"])
    style.measure(axes, (0, LOW), (alpha, LOW), r"$\varepsilon^p = \alpha$", **PART)
    style.measure(axes, (alpha, LOW), (STRAINS[0], LOW), r"$\varepsilon^e$", **PART)
    numbers = rf"$E$ = {law.E:g}, $K$ = {law.K:g}, $\sigma_Y$ = {law.sigma_Y:g}"
    axes.set_title(numbers, loc="right", fontsize=7)


def _triangle(
    axes: Axes,
    strain: NDArray[np.float64],
    stress: NDArray[np.float64],
    ends: tuple[float, float],
    label: str,
    above: bool = False,
) -> None:
    """Draw the slope of a branch between two strains, and its label, below or above the path."""
    (x, right), (low, high) = ends, np.interp(ends, np.sort(strain), np.sort(stress))
    if above:
        axes.plot([x, x, right], [low, high, high], **THIN)
        axes.text((x + right) / 2, high + 0.01, label, ha="center", va="bottom")
    else:
        axes.plot([x, right, right], [low, low, high], **THIN)
        axes.text(right + 0.01, (low + high) / 2, label, va="center")


def _compared(axes: Axes) -> None:
    """Draw the laws loaded to the same stresses: softer laws reach larger strains."""
    for law, (dashes, colour) in zip(COMPARED, LINES, strict=True):
        path = loop(law, tuple(strain_at(law, stress) for stress in STRESSES))
        # reloading repeats unloading: not drawn
        strain, stress = (np.delete(branches, RELOADING, axis=0) for branches in path)
        axes.plot(PERCENT * strain.ravel(), stress.ravel(), linestyle=dashes, color=colour)
        peak = (PERCENT * strain.max(), stress.max())
        style.note(axes, peak, _name(law), (0, 4), ha="center")
    axes.set(
        xlim=(0, 3.7),
        ylim=(0, 0.0155),
        yticks=[0, 0.003, 0.006, 0.009, 0.012],
        xlabel="strain (%)",
        ylabel="stress (unit of $E$ and $K$)",
    )
    axes.set_title(r"$\sigma_Y$ = $10^{-8}$", loc="right", fontsize=7)


def _name(law: Law) -> str:
    """Kind and moduli, one to a line."""
    numbers = law.model_dump(include={"E", "K"})
    return "\n".join([law.kind, *(f"${name}$ = {value:g}" for name, value in numbers.items())])
