"""Hat functions along the chord: what patches of the tip, and places on it, are told by."""

import numpy as np
from numpy.typing import ArrayLike, NDArray


def hats(xi: ArrayLike, nodes: NDArray[np.float64]) -> NDArray[np.float64]:
    """Values (places, nodes) of the hats with ``nodes`` at chord fractions ``xi`` (places,).

    Beyond the first and the last node they go on linearly: fields linear along the chord are kept
    wherever the tip reaches beyond.
    """
    xi = np.atleast_1d(np.asarray(xi, dtype=float))
    left = np.clip(np.searchsorted(nodes, xi, side="right") - 1, 0, len(nodes) - 2)
    part = (xi - nodes[left]) / (nodes[left + 1] - nodes[left])
    values = np.zeros((len(xi), len(nodes)))
    places = np.arange(len(xi))
    values[places, left] = 1 - part
    values[places, left + 1] = part
    return values


def hat_nodes(n: int) -> NDArray[np.float64]:
    """Chord fractions (n,) of the nodes of ``n`` hats, both ends included; n from 2."""
    return np.linspace(0, 1, n)


def middles(m: int) -> NDArray[np.float64]:
    """Chord fractions (m,) amid ``m`` equal shares of the chord."""
    return (np.arange(m) + 0.5) / m
