"""Compliance of places on the tip, m/N: how far each moves under a unit load of its own."""

import numpy as np
from numpy.typing import NDArray

from geometry.hats import hat_nodes, hats, middles


def of_places(P: NDArray[np.float64], C: NDArray[np.float64]) -> NDArray[np.float64]:
    """Compliance (places,) of places with rows ``P`` (places, n) over the DoFs of ``C`` (n, n)."""
    return np.diag(P @ C @ P.T)


def of_strips(C: NDArray[np.float64]) -> NDArray[np.float64]:
    """The same (n,) amid n strips, as many as ``C`` (n, n), of one direction, has patches."""
    n = len(C)
    return of_places(hats(middles(n), hat_nodes(n)), C)
