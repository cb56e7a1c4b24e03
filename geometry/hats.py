"""Piecewise linear hat functions along the chord, for displacements of the tip."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

POINTS = 4096  # of the quadrature along the chord


def hats(xi: ArrayLike, nodes: NDArray[np.float64]) -> NDArray[np.float64]:
    """Values (places, nodes) at chord fractions ``xi`` (places,) of the hats of ``nodes`` (nodes,).

    Beyond the first and the last node they are continued linearly, so that fields linear along the
    chord are represented exactly there as well.
    """
    xi = np.atleast_1d(np.asarray(xi, dtype=float))
    before = np.clip(np.searchsorted(nodes, xi, side="right") - 1, 0, len(nodes) - 2)
    part = (xi - nodes[before]) / (nodes[before + 1] - nodes[before])
    values = np.zeros((len(xi), len(nodes)))
    places = np.arange(len(xi))
    values[places, before] = 1 - part
    values[places, before + 1] = part
    return values


def mean(across: int) -> tuple[float, ...]:
    """Weights of a strip's edges, behind and ahead, in its mean; of one that has no two: (1,)."""
    return (1 / across,) * across


def lean(across: int) -> tuple[float, ...]:
    """Weights of a strip's edges in the lean: ahead less behind; 0 where it has no two."""
    return (-1.0, 1.0) if across == 2 else (0.0,)


def over_edges(
    xi: ArrayLike, nodes: NDArray[np.float64], weights: tuple[float, ...]
) -> NDArray[np.float64]:
    """Hats (places, edges nodes) at ``xi`` of coefficients edge by edge, with ``weights`` of each.

    >>> over_edges([0.5], hat_nodes(2), lean(2))
    array([[-0.5, -0.5,  0.5,  0.5]])
    """
    return np.hstack([weight * hats(xi, nodes) for weight in weights])


def hat_nodes(n: int) -> NDArray[np.float64]:
    """Chord fractions (n,) of the nodes of ``n`` hats, both ends included; n from 2."""
    return np.linspace(0, 1, n)


def middles(m: int) -> NDArray[np.float64]:
    """Chord fractions (m,) of the middles of ``m`` equal parts of the chord."""
    return (np.arange(m) + 0.5) / m


def projection(
    nodes: NDArray[np.float64],
    onto: NDArray[np.float64],
    factor: NDArray[np.float64] | None = None,
) -> NDArray[np.float64]:
    """L2 projection (onto, nodes) over the chord, from the hats of ``nodes`` to those of ``onto``.

    Of the product with ``factor`` (places,) where it is given, at equally spaced xi from 0 to 1.

    >>> nodes = hat_nodes(3)
    >>> projection(nodes, nodes, np.array([2.0, 2.0])).round(12) + 0.0
    array([[2., 0., 0.],
           [0., 2., 0.],
           [0., 0., 2.]])
    """
    xi = middles(POINTS)
    phi, field = hats(xi, onto), hats(xi, nodes)
    if factor is not None:
        field *= np.interp(xi, np.linspace(0, 1, len(factor)), factor)[:, None]
    return np.linalg.solve(phi.T @ phi, phi.T @ field)
