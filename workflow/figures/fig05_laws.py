"""Fig. 5: laws of the liner, loaded, unloaded, loaded further and unloaded."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray
from scipy.optimize import brentq

from simulate.law import Law
from simulate.laws.elastic import Elastic
from simulate.laws.plastic import Plastic
from workflow.figures import style

POINTS = 41  # of one branch
LOADING, UNLOADING, RELOADING, LOADING_ON, UNLOADING_AGAIN = range(5)  # branches
READABLE = Plastic(kind="plastic", E=1, K=0.45, sigma_Y=0.15, unit_Pa=1)
STRAINS = (0.5, 0.8)  # at the ends of the two loadings
STRESSES = (0.006, 0.01)  # the same, of the laws that are compared; in their unit
COMPARED = (  # the paper's numbers, and how they are drawn
    (Plastic(kind="plastic", E=10, K=4.55, sigma_Y=1e-8, unit_Pa=1), "--", style.VERMILLION),
    (Elastic(kind="elastic", E=1, unit_Pa=1), "-", style.GREY),
    (Plastic(kind="plastic", E=10, K=0.45, sigma_Y=1e-8, unit_Pa=1), "-.", style.BLUE),
    (Plastic(kind="plastic", E=1, K=0.45, sigma_Y=1e-8, unit_Pa=1), "-", style.BLACK),
)
PERCENT = 100
MEASURE = {"arrowstyle": "<->", "linewidth": 0.6, "shrinkA": 0, "shrinkB": 0}
ALONG = {"arrowstyle": "-|>", "linewidth": 1.0, "color": style.BLACK, "shrinkA": 0, "shrinkB": 0}
THIN = {"color": style.GREY, "linewidth": 0.6}


@dataclass(frozen=True)
class Loop:
    """Stress-strain path of a rod: load, unload, reload as far, load farther, unload.

    Each unloading ends at the plastic strain, where the rod bears nothing any more.
    """

    strain: NDArray[np.float64]  # (5, POINTS), branch by branch
    stress: NDArray[np.float64]  # (5, POINTS), Pa
    alpha: NDArray[np.float64]  # (5, POINTS), plastic strain


def loop(law: Law, peaks: tuple[float, float]) -> Loop:
    """Path to the strains ``peaks``, ascending, as the law's own update has it."""
    strain, stress, alpha = np.zeros((3, 5, POINTS))
    at = eps_p = 0.0
    for branch, peak in enumerate((peaks[0], None, *peaks, None)):
        end = eps_p if peak is None else peak
        strain[branch] = np.linspace(at, end, POINTS)
        for i, eps in enumerate(strain[branch]):
            stress[branch, i], eps_p, _ = law.stress(law.parameters, eps, eps_p)
            alpha[branch, i] = eps_p
        at = end
    return Loop(strain, stress, alpha)


def slopes(law: Law) -> dict[str, float]:
    """Slopes d sigma / d eps, Pa, measured on the computed path.

    ``loading`` past the elastic limit, ``unloading`` after it, and ``reloading`` from there.
    """
    path = loop(law, STRAINS)
    return {
        "loading": _slope(path, LOADING_ON),
        "unloading": _slope(path, UNLOADING),
        "reloading": _slope(path, RELOADING),
    }


def _slope(path: Loop, branch: int) -> float:
    """Rise of a branch over its length."""
    rise = path.stress[branch, -1] - path.stress[branch, 0]
    return float(rise / (path.strain[branch, -1] - path.strain[branch, 0]))


def strain_at(law: Law, stress: float) -> float:
    """Strain at which a fresh rod bears ``stress``, Pa: the stress grows with the strain."""
    return brentq(lambda eps: law.stress(law.parameters, eps, 0.0)[0] - stress, 0.0, 1.0)


def load(files: Any) -> tuple[()]:
    """Nothing: the laws are the simulator's own."""
    return ()


@style.styled
def draw() -> Figure:
    """One plastic law with its numbers explained; below, the paper's at the same stress."""
    drawn = style.figure(style.SINGLE, 4.3)
    explained, compared = drawn.subplots(2, 1)
    _explained(explained)
    _compared(compared)
    for axes, letter in ((explained, "a"), (compared, "b")):
        style.panel_letter(axes, letter)
    return drawn


def _explained(axes: Axes) -> None:
    """Draw the path of one law and name its slopes, limits and strains."""
    path, law = loop(READABLE, STRAINS), READABLE
    axes.plot(path.strain.ravel(), path.stress.ravel(), color=style.BLACK)
    for branch in range(5):
        _direction(axes, path.strain[branch], path.stress[branch])
    alpha, hardened = path.alpha[UNLOADING, -1], path.stress[UNLOADING, 0]
    axes.plot([0, strain_at(law, law.sigma_Y)], [law.sigma_Y] * 2, ":", **THIN)
    axes.plot([0, STRAINS[0], STRAINS[0]], [hardened, hardened, 0], ":", **THIN)
    _triangle(axes, path, LOADING, (0.06, 0.13), "$E$")
    _triangle(axes, path, UNLOADING_AGAIN, (0.65, 0.73), "$E$")
    _triangle(axes, path, LOADING_ON, (0.6, 0.73), r"$\frac{EK}{E+K}$", above=True)
    axes.set(xlim=(0, 0.9), ylim=(0, 0.42), xlabel="strain", ylabel="stress")
    axes.set_xticks([0, alpha, STRAINS[0]], ["0", r"$\alpha$", r"$\varepsilon$"])
    axes.set_yticks([0, law.sigma_Y, hardened], ["0", r"$\sigma_Y$", r"$\sigma_Y + K\alpha$"])
    _measure(axes, 0, alpha, r"$\varepsilon^p = \alpha$")
    _measure(axes, alpha, STRAINS[0], r"$\varepsilon^e$")
    _say(axes, rf"$E$ = {law.E:g}, $K$ = {law.K:g}, $\sigma_Y$ = {law.sigma_Y:g}")


def _direction(axes: Axes, strain: NDArray[np.float64], stress: NDArray[np.float64]) -> None:
    """Put an arrow head on a branch, before its middle: there and back do not meet."""
    begin, end = ((strain[i], stress[i]) for i in (POINTS // 3, POINTS // 3 + 1))
    axes.annotate("", end, begin, arrowprops=ALONG)


def _triangle(
    axes: Axes,
    path: Loop,
    branch: int,
    strains: tuple[float, float],
    label: str,
    above: bool = False,
) -> None:
    """Draw the slope of a branch between two strains, and its label, below or above the path."""
    upwards = path.strain[branch].argsort()
    stresses = np.interp(strains, path.strain[branch, upwards], path.stress[branch, upwards])
    corner = 0 if above else 1
    x, y = strains[corner], stresses[1 - corner]
    axes.plot([strains[0], x, strains[1]], [stresses[0], y, stresses[1]], **THIN)
    if above:
        axes.text(sum(strains) / 2, y + 0.01, label, ha="center", va="bottom")
    else:
        axes.text(x + 0.01, sum(stresses) / 2, label, va="center")


def _measure(axes: Axes, begin: float, end: float, name: str) -> None:
    """Draw a double arrow along the strains, with its name."""
    axes.annotate("", (begin, 0.015), (end, 0.015), arrowprops=MEASURE)
    axes.text((begin + end) / 2, 0.02, name, ha="center", va="bottom", fontsize=7)


def _say(axes: Axes, text: str) -> None:
    axes.set_title(text, loc="right", fontsize=7)


def _compared(axes: Axes) -> None:
    """Draw the laws to the same stresses: the more a rod gives, the farther it reaches."""
    for law, dashes, colour in COMPARED:
        path = loop(law, tuple(strain_at(law, stress) for stress in STRESSES))
        for branch in (LOADING, UNLOADING, LOADING_ON, UNLOADING_AGAIN):  # RELOADING retraces
            strain, stress = PERCENT * path.strain[branch], path.stress[branch]
            axes.plot(strain, stress, linestyle=dashes, color=colour)
        peak = (PERCENT * path.strain[LOADING_ON, -1], path.stress[LOADING_ON, -1])
        offset = {"xytext": (0, 4), "textcoords": "offset points"}
        axes.annotate(_name(law), peak, ha="center", fontsize=7, **offset)
    axes.set(xlim=(0, 3.7), ylim=(0, 0.0155), yticks=[0, 0.003, 0.006, 0.009, 0.012])
    axes.set(xlabel="strain (%)", ylabel="stress (unit of $E$ and $K$)")
    _say(axes, r"$\sigma_Y$ = $10^{-8}$")


def _name(law: Law) -> str:
    """Kind and moduli, one to a line."""
    numbers = law.model_dump(include={"E", "K"})
    return "\n".join([law.kind, *(f"${name}$ = {value:g}" for name, value in numbers.items())])
