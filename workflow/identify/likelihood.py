"""Likelihood of the critical speeds that the paper gives (C11), in several readings.

A datum is the shift of a peak, Omega_c over the linear crossing of f1. The paper's speeds have two
digits: sigma is half a digit of Omega_c over the crossing, for EO 6 over 0.181 in every reading.
The crossing's rounding, common to both coatings, is not modelled: sigma is above the standard
deviation of both roundings together.
"""

from dataclasses import dataclass
from itertools import product
from math import inf

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from workflow.identify.table import COATINGS, ORDERS
from workflow.paper.printed import CONSISTENT, CRITICAL, CROSSING, HALF_DIGIT

# Crossings over which the paper's speeds are taken. It prints 0.17 for EO 6, which contradicts its
# 0.31 for EO 4 under f1^2 = 1 + B Omega^2 (C10).
READINGS = {"printed": CROSSING, "consistent": CONSISTENT, "k = 4": {4: CROSSING[4]}}
SHIFTS, WITH_ORDER = DATA = ("shifts", "with C12 and C16")  # choices of the data
FOUR_SHIFTS = ("printed", "consistent")
K_OF_E1 = (0.45, 4.55)  # the paper does not say K of its figures for E = 1


@dataclass(frozen=True)
class Fit:
    """One reading of the data: K of the coating with E = 1, and the crossings."""

    K: float
    reading: str

    @property
    def name(self) -> str:
        """Name in files and tables."""
        return f"K = {self.K:g}, {self.reading}"

    @property
    def coatings(self) -> dict[str, int]:
        """Number in ``COATINGS`` of its two coatings, by the part of the paper."""
        return {"e1": COATINGS.index((1.0, self.K)), "e10": COATINGS.index((10.0, 4.55))}

    def deviations(self, over_crossing: NDArray[np.float64]) -> NDArray[np.float64]:
        """(Ours - paper's) / sigma (points, data), E by E, order by order; nan without a peak.

        ``over_crossing``: shifts (points, coatings, orders), as ``observed``.
        """
        data = product(self.coatings.items(), READINGS[self.reading].items())
        return np.stack(
            [
                (over_crossing[:, i, ORDERS.index(k)] - CRITICAL[part][k] / crossing)
                / (HALF_DIGIT / CONSISTENT[k])
                for (part, i), (k, crossing) in data
            ],
            axis=1,
        )

    def chi_squared(self, over_crossing: NDArray[np.float64]) -> NDArray[np.float64]:
        """Sum of the squares of the deviations (points,); inf where a peak is missing."""
        return np.nan_to_num((self.deviations(over_crossing) ** 2).sum(axis=1), nan=inf)

    def stiffer_is_more(self, observed: xr.Dataset) -> NDArray[np.bool_]:
        """Whether E = 10 has the higher EO 4 peak (C12) and the deeper wear there (C16)."""
        soft, stiff = self.coatings.values()
        higher, deeper = (
            values[:, stiff, 0] > values[:, soft, 0]
            for values in (observed["amplitude"].values, observed["wear"].values)
        )
        return higher & deeper


FITS = tuple(Fit(K, reading) for K in K_OF_E1 for reading in READINGS)
