"""Emulator of a fit's likelihood over the unit cube: it says where to run the engine next.

It decides no result: the points that it proposes are marched, and weighted with their own
likelihood (``workflow.identify.posterior``).
"""

from math import inf

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import RBFInterpolator

from workflow.identify.priors import Points

SMOOTHING = 1e-3  # of the splines
FOLDS = 8  # of the cross-validation
LEAST = 0.02  # probability that is assumed at least, of a peak or of a statement


def _spline(points: Points, values: NDArray[np.float64], at: Points) -> NDArray[np.float64]:
    """Thin-plate splines through ``values`` (points, ...), evaluated at other points."""
    return RBFInterpolator(points, values, smoothing=SMOOTHING)(at)


def error(points: Points, deviations: NDArray[np.float64]) -> NDArray[np.float64]:
    """Root mean square (data,) of the splines' error, by cross-validation."""
    fold, miss = np.arange(len(points)) % FOLDS, np.empty_like(deviations)
    for number in range(FOLDS):
        here = fold == number
        miss[here] = _spline(points[~here], deviations[~here], points[here]) - deviations[here]
    return np.sqrt((miss**2).mean(axis=0))


def likelihood(
    points: Points,
    deviations: NDArray[np.float64],
    at: Points,
    held: NDArray[np.bool_] | None = None,
) -> NDArray[np.float64]:
    """Emulated likelihood (at,) of a fit.

    Parameters
    ----------
    points : (points, parameters), where the engine ran
    deviations : (points, data), in sigma, as ``Fit.deviations``; nan without a peak
    held : (points,), whether a statement that is a datum as well holds; it needs the peaks
    """
    there = np.isfinite(deviations).all(axis=1)
    known = points[there], deviations[there]
    variance = 1 + error(*known) ** 2  # of the paper and of the emulator
    chi_squared = (_spline(*known, at) ** 2 / variance).sum(axis=1)
    statement = there if held is None else held
    return _probability(points, statement, at) * np.exp(-chi_squared / 2)


def least(points: Points, deviations: NDArray[np.float64], at: Points) -> float:
    """Least emulated chi squared of a fit at other points; inf where too few points have peaks."""
    there = np.isfinite(deviations).all(axis=1)
    if there.sum() <= points.shape[1]:
        return inf
    return float((_spline(points[there], deviations[there], at) ** 2).sum(axis=1).min())


def _probability(points: Points, held: NDArray[np.bool_], at: Points) -> NDArray[np.float64]:
    """Probability (at,) that a statement holds that holds at some of the points."""
    return np.clip(_spline(points, held.astype(float)[:, None], at)[:, 0], LEAST, 1)
