"""Results of one fit: distance of the best point, and ranges of the parameters."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from geometry.project import SettingsError
from workflow.identify.likelihood import SHIFTS, WITH_ORDER, Fit
from workflow.identify.points import Values
from workflow.identify.posterior import Weighted, medoid, systematic, weighted
from workflow.identify.priors import NAMES, Points, Priors
from workflow.identify.proposal import proposal
from workflow.identify.table import joined

LEVELS = (0.05, 0.5, 0.95)  # quantiles of the parameters
ENOUGH = 200  # effective size below which ranges are rough
DRAWS, SEED = 100, 3  # of a distribution, for the claims at its points
K_TAKEN = 4.55  # of the coating with E = 1, in the fit whose medoid the scenes of the paper take
TWO_NEAREST = -0.25  # `fourth_over_second`: below, the casing is nearest at four places, not two


def drawn(tables: Sequence[xr.Dataset]) -> xr.Dataset:
    """Points of the prior's table and of those drawn after it, with their `density` (point,).

    That of all draws together, relative to the prior.
    """
    every = joined(tables)
    cube = every["cube"].values
    density = np.full(len(cube), float(tables[0].sizes["point"]))
    for i in range(1, len(tables)):
        density += tables[i].sizes["point"] * proposal(tables[:i], cube, tables[i].attrs["data"])
    return every.assign(density=("point", density))


def prior_numbers(priors: Priors) -> dict[str, Any]:
    """Ranges and share of casings as those of a posterior (``fit``), before any datum."""
    levels = np.repeat(np.array(LEVELS)[:, None], len(NAMES), axis=1)
    return {
        "ranges": {name: quantiles.tolist() for name, quantiles in priors.values(levels).items()},
        "four_places": priors.fourth_over_second.place(TWO_NEAREST),
    }


def fit(data_fit: Fit, marched: xr.Dataset, values: Values) -> dict[str, Any]:
    """Numbers of a fit, with the shifts as data, and with C12 and C16 besides.

    "met": number of points at which all deviations are within one sigma, and the data besides hold;
    "blades": number of equal blades that have as much of the weight (Kong 1992);
    "four_places": share of the casings that are nearest at four places instead of two.
    """
    points, shifts = marched["points"].values, marched["over_crossing"].values
    deviations, chi_squared = data_fit.deviations(shifts), data_fit.chi_squared(shifts)
    likelihood, best = np.exp(-chi_squared / 2), int(chi_squared.argmin())
    main_peak = Fit(data_fit.K, "k = 4").deviations(shifts)
    agrees, within_sigma = ((abs(off) <= 1).all(axis=1) for off in (main_peak, deviations))
    both = data_fit.stiffer_is_more(marched)

    def posterior(by: NDArray[np.bool_]) -> dict[str, Any]:
        """Numbers with the likelihood of the points ``by`` alone."""
        by_data = weighted(points, likelihood * by, marched["density"].values)
        by_blade = np.bincount(marched["number"].values, by_data.weights)
        return _posterior(by_data, points, values, agrees) | {
            "met": int((within_sigma & by).sum()),
            "blades": float(1 / (by_blade**2).sum()) if by_data.evidence else 0.0,
        }

    return {
        "chi_squared": float(chi_squared[best]),
        "best": {
            "deviations": deviations[best].tolist(),
            "values": {name: float(value[best]) for name, value in values.items()},
        },
        SHIFTS: posterior(np.ones_like(both)),
        WITH_ORDER: posterior(both),
    }


def _posterior(
    sample: Weighted, points: Points, values: Values, agrees: NDArray[np.bool_]
) -> dict[str, Any]:
    """Numbers of a posterior; its medoid is one of the points whose EO 4 peaks agree."""
    supported, ranges, draws = agrees & (sample.weights > 0), None, []
    if sample.evidence:
        ranges = {
            name: np.quantile(
                samples, LEVELS, weights=sample.weights, method="inverted_cdf"
            ).tolist()
            for name, samples in values.items()
        }
        draws = systematic(sample.weights, DRAWS, np.random.default_rng(SEED)).tolist()
    return {
        "effective": sample.effective,
        "evidence": sample.evidence,
        "weights": sample.weights.tolist(),
        "ranges": ranges,
        "four_places": float((values["fourth_over_second"] < TWO_NEAREST) @ sample.weights),
        "medoid": medoid(points, sample.weights, supported) if supported.any() else None,
        "draws": draws,
    }


def of_fit(fits: Mapping[str, Any], K: float, reading: str | None = None) -> dict[str, Any]:
    """Numbers of one fit, with ``K`` of the coating with E = 1; by default of what was served."""
    return fits["fits"][Fit(K, reading or fits["served"]).name]


def posterior_of(fits: Mapping[str, Any]) -> dict[str, Any]:
    """That with C12 and C16, by the reading that was served, whose medoid and draws are used.

    Raises
    ------
    geometry.project.errors.SettingsError
        When no point has the data.
    """
    posterior = of_fit(fits, K_TAKEN)[WITH_ORDER]
    if posterior["medoid"] is None:
        raise SettingsError(
            "no point has C12, C16 and the paper's peaks of EO 4: add tables",
            file="workflow/rules/functions.smk",
            key="TABLES",
        )
    return posterior
