"""Compliance of places on the tip, m/N: displacement of each under a unit load at it."""

import numpy as np
from numpy.typing import NDArray

from geometry.hats import hat_nodes, hats, middles


def of_places(P: NDArray[np.float64], C: NDArray[np.float64]) -> NDArray[np.float64]:
    """Compliance (places,) of places with rows ``P`` (places, n) over the DoFs of ``C`` (n, n)."""
    return np.diag(P @ C @ P.T)


def of_strips(C: NDArray[np.float64]) -> NDArray[np.float64]:
    """Compliance (n,) at the middles of n strips, from ``C`` (n, n) of n patches, one direction."""
    n = len(C)
    return of_places(hats(middles(n), hat_nodes(n)), C)
