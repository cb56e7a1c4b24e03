"""Whether a run is steady at its end: from its swing and its wear, round by round.

The swing is half the range of u_r at xi = 1/16 in a round. What is left in it of the start dies out
as exp(-j/tau) over the rounds j, with the time constant of the mode that responds, of frequency
k Omega: tau = 1/(2 pi zeta k) revolutions, 53 for a damping of 0.1 % and k = 3. Beats between this
mode and the engine orders rise and fall within tau; wear may change the motion at any time. So

    growing,    the mean swing of each quarter of the rounds is above (below) that of the quarter
    dying out   before by ``MOVES`` of the last, and the last change is no small one beside that
                before: no beat does so four times in turn
    steady      the swing of the last half, less what dies out as exp(-j/tau), is within ``STILL``
                of the swing at the end, and the last quarter wore ``WEARS`` of the volume at most
    too short   neither can be said
    to say

Rounds in which the casing's distortion still changes do not count. The limits are those by which
drawn scenes, marched ten time constants on, refute few of the words (tests/simulate/test_trend.py).
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import inf

import numpy as np
from numpy.typing import NDArray

from simulate.scene import DYING_OUT, GROWING, STEADY, TOO_SHORT

FEWEST = 8  # rounds, to say anything
MOVES = 0.1  # of the swing at the end, from quarter to quarter
SLOWS = 0.3  # the last change over the one before, at least: else it comes to an end
STILL = 0.05  # of the swing at the end
SURE = 2.0  # standard errors of what still dies out, beside it
WEARS = 0.03  # of the worn volume, in the last quarter
LONGEST = 1e3  # time constants beyond so many times the rounds are as this one: without damping


@dataclass(frozen=True)
class Rounds:
    """What each round of a run shows; nan where it was not marched to its end."""

    extremes: NDArray[np.float64]  # (rounds, 2), m, least and largest u_r at xi = 1/16
    worn: NDArray[np.float64]  # (rounds,), m3, volume worn off the liner

    @classmethod
    def of(cls, seen: Sequence[tuple[float, float, float]], rounds: int, volume: float) -> "Rounds":
        """Of all ``rounds`` those that were ``seen``.

        Least and largest u_r, m, in each, and the volume worn until its end, m3; ``volume``: that
        before the first.
        """
        whole = np.full((rounds, 3), np.nan)
        whole[: len(seen)] = np.reshape(seen, (-1, 3))
        return cls(whole[:, :2], np.diff(whole[:, 2], prepend=volume))

    @property
    def swing(self) -> NDArray[np.float64]:
        """Half the range (rounds,), m, of u_r."""
        return np.diff(self.extremes, axis=1)[:, 0] / 2

    @property
    def largest(self) -> tuple[float, float]:
        """Largest |u_r|, m, and the number of its round, from 1; nan without a whole round."""
        of_rounds = abs(self.extremes).max(axis=1)
        if np.isnan(of_rounds).all():
            return np.nan, np.nan
        return float(np.nanmax(of_rounds)), float(np.nanargmax(of_rounds) + 1)


def time_constant(
    samples: NDArray[np.float64], omega: NDArray[np.float64], Omega: float, zeta: float
) -> float:
    """Time constant tau, rounds, of the mode that responds; inf without damping.

    ``samples`` (n,), m, of u_r in one round: the mode is that nearest to their largest order.
    """
    order = np.abs(np.fft.rfft(samples))[1:].argmax() + 1
    k = (omega / Omega)[np.abs(omega / Omega - order).argmin()]
    return float(1 / (2 * np.pi * zeta * k)) if zeta > 0 else inf


def trend(swing: NDArray[np.float64], worn: NDArray[np.float64], tau: float) -> str:
    """One of ``TRENDS``, for the swing (n,) of rounds and the volume worn in each, any units.

    ``tau``: time constant, rounds.

    >>> j = np.arange(40)
    >>> trend(1 + np.exp(-j / 4), 0 * j, tau=4)
    'steady'
    >>> trend(1 + np.exp(-j / 40), 0 * j, tau=40), trend(1 - np.exp(-j / 40), 0 * j, tau=40)
    ('too short to say', 'growing')
    """
    n = len(swing)
    if n < FEWEST:
        return TOO_SHORT
    quarters = np.array([of.mean() for of in np.array_split(swing, 4)])
    changes = np.diff(quarters) / max(quarters[-1], np.finfo(float).tiny)
    for word, moves in ((GROWING, changes), (DYING_OUT, -changes)):
        if (moves > MOVES).all() and moves[-1] > SLOWS * moves[-2]:
            return word
    wears = worn[-(n // 4) :].sum() > WEARS * worn.sum()
    return STEADY if not wears and _still(swing[n // 2 :], min(tau, LONGEST * n)) else TOO_SHORT


def _still(swing: NDArray[np.float64], tau: float) -> bool:
    """Whether what dies out as exp(-j/tau) is small at the end of ``swing`` (n,), and its mean too.

    By least squares, with the standard error of the part that dies out. Neighbouring rounds depend
    on each other: n of them count as n (1 - rho)/(1 + rho), rho their correlation.
    """
    n = len(swing)
    decay = np.exp(-(np.arange(n) - n + 1) / tau)
    d, s = decay - decay.mean(), swing - swing.mean()
    left = (d @ s) / (d @ d)
    off = s - left * d
    square = off @ off
    rho = np.clip((off[1:] @ off[:-1]) / square, 0, 0.95) if square > 0 else 0.0
    error = np.sqrt(square / (n - 2) * (1 + rho) / (1 - rho) / (d @ d))
    end, last = swing.mean() - left * decay.mean(), swing[n // 2 :].mean()
    return bool(max(abs(left) + SURE * error, abs(last - end)) <= STILL * end)
