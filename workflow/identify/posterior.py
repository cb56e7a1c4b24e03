"""Posterior of a fit: the computed points with weights.

Points are drawn from the prior, then from emulated posteriors. A point weighs its likelihood over
the density of all draws there, whichever table it is of: the balance heuristic (Owen & Zhou, J. Am.
Stat. Assoc. 95, 2000), here with densities that depend on the points before (adaptive multiple
importance sampling, Cornuet et al., Scand. J. Stat. 39, 2012): nearly unbiased.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from workflow.identify.priors import Points


def systematic(weights: ArrayLike, number: int, rng: np.random.Generator) -> NDArray[np.int64]:
    """``number`` indices drawn in proportion to ``weights``, evenly spread (Kitagawa 1996).

    >>> systematic([0.5, 0.0, 0.25, 0.25], 4, np.random.default_rng(0)).tolist()
    [0, 0, 2, 3]
    """
    upto = np.cumsum(weights)
    heights = (rng.random() + np.arange(number)) / number * upto[-1]
    return np.minimum(np.searchsorted(upto, heights, side="right"), len(upto) - 1)


class Weighted(NamedTuple):
    """A posterior of computed points."""

    weights: NDArray[np.float64]  # (points,), of sum 1; all 0 without any support
    evidence: float  # mean likelihood over the prior
    effective: float  # number of equal draws that estimate a mean as well (Kong 1992); equal points
    # count as one


def weighted(
    points: Points, likelihood: NDArray[np.float64], drawn: NDArray[np.float64]
) -> Weighted:
    """Weights of all points.

    Parameters
    ----------
    points : (points, parameters)
    likelihood : (points,)
    drawn : (points,), density of all draws together relative to the prior: the number of points of
        each table times the density from which they were drawn, summed over the tables
    """
    raw = likelihood / drawn
    evidence = float(raw.sum())
    if not evidence > 0:
        return Weighted(np.zeros_like(raw), 0.0, 0.0)
    weights = raw / evidence
    _, same = np.unique(points, axis=0, return_inverse=True)
    merged = np.bincount(same.ravel(), weights)
    return Weighted(weights, evidence, float(1 / (merged**2).sum()))


def medoid(points: Points, weights: NDArray[np.float64], among: NDArray[np.bool_]) -> int:
    """Index of the point of ``among`` (points,) with the least weighted mean distance to all.

    >>> line, among = np.array([[0.0], [0.4], [0.5], [1.0]]), np.array([True, True, False, True])
    >>> medoid(line, np.full(4, 0.25), among), medoid(line, np.array([0.0, 0.1, 0.1, 0.8]), among)
    (1, 3)
    """
    inside, support = np.flatnonzero(among), np.flatnonzero(weights)
    distances = np.linalg.norm(points[inside][:, None] - points[None, support], axis=2)
    return int(inside[(distances @ weights[support]).argmin()])
