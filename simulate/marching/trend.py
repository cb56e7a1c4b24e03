"""Whether a run is steady at its end: from its swing and its wear in each revolution.

The swing is half the range of u_r at xi = 1/16 in a revolution, on a casing that tapers of
u_r - s u_z at the edge that moves more. Its rest from the start dies out as
exp(-j/tau) over the revolutions j, with the time constant of the mode that responds, of frequency
k Omega: tau = 1/(2 pi zeta k) revolutions, 53 for a damping of 0.1 % and EO 3. Beats between this
mode and the engine orders rise and fall within tau; wear may change the motion at any time. So

    growing,    the mean swing of each quarter of the revolutions is above (below) that of the one
    dying out   before by ``MOVES`` of the last, and the last change is no small one beside that
                before: no beat does so four times in turn
    steady      the swing of the last half, less the part exp(-j/tau), is within ``STILL`` of the
                swing at the end, and the last quarter wore at most ``WEARS`` of all
    too short   neither can be said
    to say

Revolutions in which the casing's distortion still changes do not count. The limits are those by
which drawn scenes, run for ten more time constants on, refute few of the words.

A run that ends when it is steady is judged again and again, and may seem so once by chance. It
ends where it is steady at two looks in turn, the second after half as many revolutions again.
"""

from dataclasses import dataclass
from math import ceil, inf, nan
from typing import Self

import numpy as np
from numpy.typing import NDArray

from simulate.scene import DYING_OUT, GROWING, STEADY, TOO_SHORT
from simulate.scene.damping import Ratios

FEWEST = 8  # revolutions, to say anything
MOVES = 0.1  # of the swing at the end, from quarter to quarter
SLOWS = 0.3  # the last change over the one before, at least: else it comes to an end
STILL = 0.05  # of the swing at the end
SURE = 2.0  # standard errors of the part that still dies out, beside it
WEARS = 0.03  # of the volume worn in the revolutions that count, in the last quarter
LONGEST = 1e3  # time constants beyond so many times the revolutions are as without damping


@dataclass(frozen=True)
class Rounds:
    """Numbers of each revolution of a run; nan where it did not end."""

    extremes: NDArray[np.float64]  # (revolutions, 2), m, least and largest u_r at a place
    volume: NDArray[np.float64]  # (revolutions + 1,), m3, worn off the liner before and after each

    @classmethod
    def unknown(cls, rounds: int, volume: float) -> Self:
        """Of ``rounds`` that are still to come; ``volume``, m3, worn before them."""
        return cls(np.full((rounds, 2), nan), np.array([volume] + [nan] * rounds))

    def add(self, done: int, samples: NDArray[np.float64], volume: float) -> None:
        """Add the revolution after ``done``: samples of u_r, m, and the volume after it."""
        self.extremes[done] = samples.min(), samples.max()
        self.volume[done + 1] = volume

    def trend(self, first: int, tau: float) -> str:
        """``trend`` of the revolutions computed after the ``first``; ``tau`` in revolutions."""
        counted = slice(first, np.isfinite(self.worn).sum())
        return trend(self.swing[counted], self.worn[counted], tau)

    @property
    def worn(self) -> NDArray[np.float64]:
        """Volume worn in each revolution (revolutions,), m3."""
        return np.diff(self.volume)

    @property
    def swing(self) -> NDArray[np.float64]:
        """Half the range (revolutions,), m, of u_r."""
        return np.diff(self.extremes, axis=1)[:, 0] / 2

    @property
    def most(self) -> float:
        """Largest swing, m; 0 if no revolution is whole."""
        return float(np.nanmax(self.swing, initial=0.0))

    @property
    def largest(self) -> tuple[float, float]:
        """Largest ``|u_r|``, m, and the number of its revolution, from 1; nan if none is whole."""
        far = self._farthest
        return (float(far.max()), float(far.argmax() + 1)) if len(far) else (nan, nan)

    @property
    def last(self) -> float:
        """Largest ``|u_r|`` in the last revolution, m; nan if none is whole."""
        return float(far[-1]) if len(far := self._farthest) else nan

    @property
    def _farthest(self) -> NDArray[np.float64]:
        """Largest ``|u_r|``, m, of each whole revolution."""
        of_rounds = abs(self.extremes).max(axis=1)
        return of_rounds[np.isfinite(of_rounds)]


def looks(standing: int, least: int, most: int) -> set[int]:
    """Revolutions at which a run is judged that ends when it is steady at two of them in turn.

    The first are ``FEWEST`` after those in which the casing changes, ``standing``, and ``least``;
    each following has half as many again, the last is ``most``.

    >>> sorted(looks(2, 5, 40))
    [10, 14, 20, 29, 40]
    """
    counted, rounds = max(FEWEST, least - standing), {most}
    while standing + counted < most:
        rounds.add(standing + counted)
        counted += ceil(counted / 2)
    return rounds


def time_constant(
    samples: NDArray[np.float64], omega: NDArray[np.float64], Omega: float, zeta: Ratios
) -> float:
    """Time constant tau, revolutions, of the mode that responds; inf without damping, or below 0.

    ``samples`` (n,), m, of u_r in one revolution: the mode is that nearest to their largest order.
    """
    order = np.abs(np.fft.rfft(samples))[1:].argmax() + 1
    mode = np.abs(omega / Omega - order).argmin()
    k, xi = omega[mode] / Omega, np.broadcast_to(zeta, omega.shape)[mode]
    return float(1 / (2 * np.pi * xi * k)) if xi > 0 else inf


def trend(swing: NDArray[np.float64], worn: NDArray[np.float64], tau: float) -> str:
    """One of ``TRENDS``, for the swing (n,) of revolutions and the volume worn in each, any units.

    ``tau``: time constant, revolutions.

    >>> j = np.arange(40)
    >>> trend(1 + np.exp(-j / 4), 0 * j, tau=4)
    'steady'
    >>> trend(1 + np.exp(-j / 40), 0 * j, tau=40), trend(1 - np.exp(-j / 40), 0 * j, tau=40)
    ('too short to say', 'growing')
    """
    n = len(swing)
    if n < FEWEST:
        return TOO_SHORT
    quarters = np.array([quarter.mean() for quarter in np.array_split(swing, 4)])
    changes = np.diff(quarters) / max(quarters[-1], np.finfo(float).tiny)
    for name, moves in ((GROWING, changes), (DYING_OUT, -changes)):
        if (moves > MOVES).all() and moves[-1] > SLOWS * moves[-2]:
            return name
    wears = worn[-(n // 4) :].sum() > WEARS * worn.sum()
    return STEADY if not wears and _is_steady(swing[n // 2 :], min(tau, LONGEST * n)) else TOO_SHORT


def further(swing: NDArray[np.float64]) -> float:
    """Share by which a growing ``swing`` (n,) rises in n revolutions more, over that at its end.

    Its changes from quarter to quarter go on in the ratio r of the last two, at most 1: it nears a
    limit exponentially, or grows on.

    >>> j = np.arange(1, 401)
    >>> swing = 1 - np.exp(-j / 150)
    >>> round(further(swing), 2), round(float((1 - np.exp(-800 / 150)) / swing[-1] - 1), 2)
    (0.07, 0.07)
    """
    quarters = np.array([quarter.mean() for quarter in np.array_split(swing, 4)])
    before, last = np.diff(quarters)[1:]
    r = np.sqrt(np.clip(last / before, 0.0, 1.0))  # of half a quarter, from its middle to its end
    end = quarters[-1] + last * r**2 / (1 + r)
    return float(last * r**3 * (r ** (2 * np.arange(4))).sum() / end)


def _is_steady(swing: NDArray[np.float64], tau: float) -> bool:
    """Whether the part exp(-j/tau) is small at the end of ``swing`` (n,), and its mean too.

    By least squares, with the standard error of the part that dies out. Neighbouring revolutions
    depend on each other: n of them count as n (1 - rho)/(1 + rho), rho their correlation.
    """
    n = len(swing)
    decay = np.exp(-(np.arange(n) - n + 1) / tau)
    d, s = decay - decay.mean(), swing - swing.mean()
    transient = (d @ s) / (d @ d)
    off = s - transient * d
    square = off @ off
    rho = np.clip((off[1:] @ off[:-1]) / square, 0, 0.95) if square > 0 else 0.0
    error = np.sqrt(square / (n - 2) * (1 + rho) / (1 - rho) / (d @ d))
    end, last = swing.mean() - transient * decay.mean(), swing[n // 2 :].mean()
    return bool(max(abs(transient) + SURE * error, abs(last - end)) <= STILL * end)
