"""Stress-strain paths of the liner's laws, Fig. 5, and their slopes over the closed form, C04."""

import numpy as np
from numpy.typing import NDArray

from simulate.scene.law import Law
from simulate.scene.laws.elastic import Elastic
from simulate.scene.laws.plastic import Plastic

POINTS = 41  # of one branch
LOADING, UNLOADING, RELOADING, LOADING_ON, UNLOADING_AGAIN = range(5)  # branches
STRAINS = (0.5, 0.8)  # at the ends of the two loadings
COMPARED = (  # the paper's numbers
    Plastic(kind="plastic", E=10, K=4.55, sigma_Y=1e-8, unit_MPa=1e-6),
    Elastic(kind="elastic", E=1, unit_MPa=1e-6),
    Plastic(kind="plastic", E=10, K=0.45, sigma_Y=1e-8, unit_MPa=1e-6),
    Plastic(kind="plastic", E=1, K=0.45, sigma_Y=1e-8, unit_MPa=1e-6),
)


def loop(law: Law, peaks: tuple[float, float]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Strain and stress (5, POINTS), Pa: load, unload, reload as far, load further, unload.

    The rod is loaded to the strains ``peaks``, ascending; each unloading ends at the plastic
    strain, where the stress is 0.
    """
    strain, stress = np.zeros((2, 5, POINTS))
    begin = eps_p = 0.0
    for branch, peak in enumerate((peaks[0], None, *peaks, None)):
        end = eps_p if peak is None else peak
        strain[branch] = np.linspace(begin, end, POINTS)
        for i, eps in enumerate(strain[branch]):
            stress[branch, i], eps_p, _ = law.stress(law.parameters, eps, eps_p)
        begin = end
    return strain, stress


def slopes_over_closed_form() -> dict[str, float]:
    """Slopes of loading over EK/(E + K) and of unloading over E, for each plastic law of Fig. 5.

    d sigma / d eps of the computed paths, of loading above the elastic limit.
    """
    ratios = {}
    for law in (law for law in COMPARED if law.kind == "plastic"):
        strain, stress = (np.ptp(path, axis=1) for path in loop(law, STRAINS))
        slopes, name = stress / strain, f"E = {law.E:g}, K = {law.K:g}"
        ratios |= {
            f"loading, {name}": float(slopes[LOADING_ON] / (law.E * law.K / (law.E + law.K))),
            f"unloading, {name}": float(slopes[UNLOADING] / law.E),
        }
    return ratios
