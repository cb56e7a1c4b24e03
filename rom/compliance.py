"""Compliance of places on the tip, m/N: displacement of each under a unit load at it."""

import numpy as np
from numpy.typing import NDArray

from geometry.hats import hat_nodes, hats, middles
from rom.model import Rom


def of_places(P: NDArray[np.float64], C: NDArray[np.float64]) -> NDArray[np.float64]:
    """Compliance (places,) of places with rows ``P`` (places, n) over the DoFs of ``C`` (n, n)."""
    return np.diag(P @ C @ P.T)


def places(rom: Rom) -> NDArray[np.float64]:
    """Chord fractions of the middles of as many strips as the model has patches, or its points."""
    return rom.xi if rom.of_points else middles(len(rom.xi))


def of_model(rom: Rom, Omega: float) -> NDArray[np.float64]:
    """Compliance (places, directions) of the ``places`` of a reduced model at Omega (rad/s)."""
    flexibility = np.linalg.inv(rom.stiffness(Omega))
    rows = [rom.rows(places(rom), letter) for letter in "rtz"[: len(rom.directions)]]
    return np.column_stack([of_places(P, flexibility) for P in rows])


def of_strips(C: NDArray[np.float64]) -> NDArray[np.float64]:
    """Compliance (n,) at the middles of n strips, from ``C`` (n, n) of n patches, one direction."""
    n = len(C)
    return of_places(hats(middles(n), hat_nodes(n)), C)
