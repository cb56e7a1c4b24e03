"""Where to run the engine next: equal parts of the emulated posteriors with either K.

The emulator of a fit's likelihood over the unit cube decides no result: the points that it proposes
are computed, and weighted with their own likelihood (``workflow.identify.posterior``).
"""

from collections.abc import Sequence
from math import inf

import numpy as np
import xarray as xr
from numpy.typing import NDArray
from scipy.interpolate import RBFInterpolator
from scipy.stats import chi2

from workflow.identify.likelihood import FITS, FOUR_SHIFTS, WITH_ORDER
from workflow.identify.points import drawn_cube
from workflow.identify.posterior import systematic
from workflow.identify.priors import Points
from workflow.identify.table import joined

CANDIDATES = 2**18  # points of the prior from which those of a table are drawn
SEED = 1  # of the prior's points; those after it count on
UNSUPPORTED = 0.1
LEVEL = 0.95  # of the distribution of chi squared, up to which a reading fits
SHIFTS_OF_FOUR = 4  # data of a reading of all four shifts
SMOOTHING = 1e-3  # of the splines
FOLDS = 8  # of the cross-validation
LEAST = 0.02  # probability that is assumed at least_chi_squared, of a peak or of a statement


def served(prior: xr.Dataset) -> str:
    """Reading of the data that the draws serve: the better one of all four shifts, or EO 4 alone.

    By the least chi squared that the emulator finds. All four shifts are left where it is beyond
    ``LEVEL`` of its distribution.
    """
    features, among = prior["features"].values, prior.attrs["blades"].features(candidates([prior]))
    least = {
        reading: min(
            least_chi_squared(features, each_fit.deviations(prior["over_crossing"].values), among)
            for each_fit in FITS
            if each_fit.reading == reading
        )
        for reading in FOUR_SHIFTS
    }
    nearest = min(least, key=least.__getitem__)
    return nearest if least[nearest] <= chi2.ppf(LEVEL, SHIFTS_OF_FOUR) else "k = 4"


def candidates(tables: Sequence[xr.Dataset]) -> Points:
    """Rows of the cube from which those of the table after ``tables`` are drawn."""
    return drawn_cube(CANDIDATES, SEED + len(tables))


def drawn(tables: Sequence[xr.Dataset], number: int, data: str) -> Points:
    """Rows of the cube of the table after ``tables``, drawn by ``data``, one of ``DATA``."""
    among = candidates(tables)
    rng = np.random.default_rng(SEED + len(tables))
    return among[systematic(proposal(tables, among, data), number, rng)]


def proposal(tables: Sequence[xr.Dataset], cube: Points, data: str) -> NDArray[np.float64]:
    """Density (points,), relative to the prior, from which points are drawn after ``tables``.

    Equal parts of the emulated posteriors with either K of E = 1, without a K whose evidence is
    less than ``UNSUPPORTED`` of the other's. ``data``: one of ``DATA``.
    """
    every, reading = joined(tables), served(tables[0])
    features = every["features"].values
    everywhere = tables[0].attrs["blades"].features(np.vstack([candidates(tables), cube]))
    likelihoods = np.array(
        [
            emulated(
                features,
                each_fit.deviations(every["over_crossing"].values),
                everywhere,
                each_fit.stiffer_is_more(every) if data == WITH_ORDER else None,
            )
            for each_fit in FITS
            if each_fit.reading == reading
        ]
    )
    evidences = likelihoods[:, :CANDIDATES].mean(axis=1)
    parts = likelihoods[:, CANDIDATES:] / evidences[:, None]
    return parts[evidences >= UNSUPPORTED * evidences.max()].mean(axis=0)


def _spline(points: Points, values: NDArray[np.float64], places: Points) -> NDArray[np.float64]:
    """Thin-plate splines through ``values`` (points, ...), evaluated at other points."""
    return RBFInterpolator(points, values, smoothing=SMOOTHING)(places)


def error(points: Points, deviations: NDArray[np.float64]) -> NDArray[np.float64]:
    """Root mean square (data,) of the splines' error, by cross-validation."""
    fold, miss = np.arange(len(points)) % FOLDS, np.empty_like(deviations)
    for number in range(FOLDS):
        out = fold == number
        miss[out] = _spline(points[~out], deviations[~out], points[out]) - deviations[out]
    return np.sqrt((miss**2).mean(axis=0))


def emulated(
    points: Points,
    deviations: NDArray[np.float64],
    places: Points,
    held: NDArray[np.bool_] | None = None,
) -> NDArray[np.float64]:
    """Emulated likelihood (places,) of a fit.

    Parameters
    ----------
    points : (points, parameters), where the engine ran
    deviations : (points, data), in sigma, as ``Fit.deviations``; nan without a peak
    held : (points,), whether a statement that is a datum as well holds; it needs the peaks
    """
    there = np.isfinite(deviations).all(axis=1)
    samples = points[there], deviations[there]
    variance = 1 + error(*samples) ** 2  # of the paper and of the emulator
    chi_squared = (_spline(*samples, places) ** 2 / variance).sum(axis=1)
    statement = (there if held is None else held).astype(float)[:, None]
    probability = np.clip(_spline(points, statement, places)[:, 0], LEAST, 1)  # that it holds
    return probability * np.exp(-chi_squared / 2)


def least_chi_squared(points: Points, deviations: NDArray[np.float64], places: Points) -> float:
    """Least emulated chi squared of a fit at other points; inf where too few points have peaks."""
    there = np.isfinite(deviations).all(axis=1)
    if there.sum() <= points.shape[1]:
        return inf
    return float((_spline(points[there], deviations[there], places) ** 2).sum(axis=1).min())
