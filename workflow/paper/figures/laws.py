"""Fig. 5: laws of the liner, loaded, unloaded, loaded further and unloaded."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from scipy.optimize import brentq

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
)

LOW, PART = 0.015, {"offset": (0, 1), "ha": "center", "va": "bottom"}  # arrows along the strains
THIN = {"color": style.GREY, "linewidth": 0.6}


@style.styled
def draw() -> Figure:
    """One plastic law with its parameters explained; below, the paper's laws at equal stress."""
    drawn, (explained, compared) = style.subplots(style.SINGLE, 4.3, 2, letters=True)
    _explained(explained, Plastic(kind="plastic", E=1, K=0.45, sigma_Y=0.15, unit_MPa=1e-6))
    _compared(compared)
    return drawn


def _explained(axes: Axes, law: Plastic) -> None:
    """Draw the stress-strain path of one law and label its slopes, limits and strains."""
    strain, stress = loop(law, STRAINS)
    axes.plot(strain.ravel(), stress.ravel(), color=style.BLACK)
    # arrow heads before the middle: those of unloading and reloading differ
    for path in np.stack([strain, stress], axis=-1):
        axes.annotate("", path[POINTS // 3 + 1], path[POINTS // 3], arrowprops=style.ARROW)
    alpha, hardened = strain[UNLOADING, -1], stress[UNLOADING, 0]
    axes.plot([0, strain_at(law, law.sigma_Y)], [law.sigma_Y] * 2, ":", **THIN)
    axes.plot([0, STRAINS[0], STRAINS[0]], [hardened, hardened, 0], ":", **THIN)
    for branch, (x, right), label in (  # a triangle below the path, between two strains
        (LOADING, (0.06, 0.13), "$E$"),
        (UNLOADING_AGAIN, (0.65, 0.73), "$E$"),
        (LOADING_ON, (0.53, 0.62), r"$\frac{EK}{E+K}$"),
    ):
        low, high = np.interp((x, right), np.sort(strain[branch]), np.sort(stress[branch]))
        axes.plot([x, right, right], [low, low, high], **THIN)
        axes.text(right + 0.01, (low + high) / 2, label, va="center")
    axes.set(
        xlim=(0, 0.9),
        ylim=(0, 0.42),
        xlabel="strain",
        ylabel="stress",
        xticks=[0, alpha, STRAINS[0]],
        xticklabels=["0", r"$\alpha$", r"$\varepsilon$"],
        yticks=[0, law.sigma_Y, hardened],
        yticklabels=["0", r"$\sigma_Y$", r"$\sigma_Y + K\alpha$"],
    )
    style.measure(axes, (0, LOW), (alpha, LOW), r"$\varepsilon^p = \alpha$", **PART)
    style.measure(axes, (alpha, LOW), (STRAINS[0], LOW), r"$\varepsilon^e$", **PART)
    axes.set_title(
        rf"$E$ = {law.E:g}, $K$ = {law.K:g}, $\sigma_Y$ = {law.sigma_Y:g}",
        loc="right",
        fontsize=7,
    )


def _compared(axes: Axes) -> None:
    """Draw the laws loaded to the same stresses, in their unit: softer ones are strained more."""
    for law, dashes, colour in zip(
        COMPARED,
        ("--", "-", "-.", "-"),
        (style.VERMILLION, style.GREY, style.BLUE, style.BLACK),
        strict=True,
    ):
        ends = strain_at(law, 0.006), strain_at(law, 0.01)
        # reloading repeats unloading: not drawn
        strain, stress = np.delete(loop(law, ends), RELOADING, axis=1)
        axes.plot(100 * strain.ravel(), stress.ravel(), linestyle=dashes, color=colour)
        moduli = law.model_dump(include={"E", "K"}).items()
        name = "\n".join([law.kind, *(f"${letter}$ = {value:g}" for letter, value in moduli)])
        style.note(axes, (100 * strain.max(), stress.max()), name, (0, 4), ha="center")
    axes.set(
        xlim=(0, 3.7),
        ylim=(0, 0.0155),
        yticks=[0, 0.003, 0.006, 0.009, 0.012],
        xlabel="strain (%)",
        ylabel="stress (unit of $E$ and $K$)",
    )
    axes.set_title(r"$\sigma_Y$ = $10^{-8}$", loc="right", fontsize=7)


def strain_at(law: Law, stress: float) -> float:
    """Strain at which a new rod has the stress ``stress``, Pa; the stress grows with the strain."""
    return brentq(lambda eps: law.stress(law.parameters, eps, 0.0)[0] - stress, 0.0, 1.0)
