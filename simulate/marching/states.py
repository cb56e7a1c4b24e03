"""States of a run that are kept: of its last revolution, of those that strain the blade most."""

from dataclasses import dataclass, field
from typing import Self

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from simulate.marching.status import WITH_RESULT

PER_PERIOD = 8  # least states in a period of the highest mode that pictures show
INSTANTS = 256  # of a revolution that strains the blade most: of twice as many those farthest from
# its mean


@dataclass(frozen=True)
class MostStrained:
    """States of the revolutions of a run that strain its blade most, two by each of three measures.

    Range of the strain energy sum w_i^2 q_i^2; range of q_1; sum of (w_i range of q_i)^2. The first
    depends on the mean of a motion, the second misses higher modes, the third adds ranges of
    different instants.
    """

    omega: NDArray[np.float64]  # (modes,), rad/s
    every: int  # samples from one state to the next by which revolutions are measured
    q: NDArray[np.float64]  # (3, 2, instants, modes), modal displacements; nan before any
    # (3, 2), numbers of their revolutions, from 1; 0 before any
    numbers: NDArray[np.int64] = field(default_factory=lambda: np.zeros((3, 2), int))
    most: NDArray[np.float64] = field(default_factory=lambda: np.full((3, 2), -np.inf))

    @classmethod
    def room(cls, omega: NDArray[np.float64], every: int, samples: int) -> Self:
        """Before the first revolution, of so many ``samples``; ``every``: as of the function."""
        return cls(omega, every, np.full((3, 2, min(INSTANTS, samples), len(omega)), np.nan))

    def add(self, number: int, samples: NDArray[np.float64]) -> None:
        """Add a revolution: modal displacements (samples, modes or more) at its samples."""
        q = samples[self.every - 1 :: self.every, : len(self.omega)]
        ranges, energy = np.ptp(q, axis=0), q**2 @ self.omega**2
        measured = np.array([np.ptp(energy), ranges[0], np.sum((self.omega * ranges) ** 2)])
        if not (more := measured > self.most.min(axis=1)).any():
            return
        least, count = (np.flatnonzero(more), self.most.argmin(axis=1)[more]), self.q.shape[2]
        step = min(self.every, max(len(samples) // (2 * INSTANTS), 1))
        fine = samples[step - 1 :: step, : len(self.omega)]
        away = (fine - fine.mean(axis=0)) ** 2 @ self.omega**2
        farthest = np.sort(np.argpartition(-away, count - 1)[:count])
        self.most[least], self.numbers[least] = measured[more], number
        self.q[least] = fine[farthest]


def every(mode: int, samples_per_round: int, omega: NDArray[np.float64], Omega: float) -> int:
    """Samples from one state to the next for pictures that show the motion of ``mode``.

    At least eight states are in its period, and whole numbers of them make a revolution. ``omega``:
    natural frequencies, rad/s, of the run at the speed ``Omega``, rad/s.

    >>> every(1, 2048, np.array([50.0]), 10.0)  # 5 periods a revolution
    32
    """
    most = samples_per_round * Omega / (PER_PERIOD * omega[mode - 1])
    steps = np.arange(1, samples_per_round + 1)
    return int(steps[(samples_per_round % steps == 0) & (steps <= max(most, 1))].max())


def largest_state(sweep: xr.Dataset) -> tuple[float, float, NDArray[np.float64]]:
    """State of a sweep with the largest radial displacement over any strip beyond its initial gap.

    The largest displacement of all may be at a corner far from the liner, or inward, where the
    vibration unloads the blade: hence the gap is subtracted. Runs without a result are left out.

    Returns
    -------
    float, float, NDArray
        Speed, rad/s; radial displacement there, m, outward positive; reduced displacements (n,), m.
    """
    runs = sweep.isel(speed_over_f1=np.flatnonzero(sweep["status"].isin(WITH_RESULT)))
    u_r = runs["states"].values @ runs["P"].values.T
    gap = runs["gap"].values  # of the strips, or of each speed's strips
    beyond = u_r - (gap if gap.ndim == 1 else gap[:, None])
    speed, time, strip = np.unravel_index(beyond.argmax(), beyond.shape)
    of_run = runs["states"].values[speed, time]
    return float(runs["speed"][speed]), float(u_r[speed, time, strip]), of_run
