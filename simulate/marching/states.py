"""Recorded state of a sweep with the largest displacement beyond the gap."""

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from simulate.marching.status import WITH_RESULT

PER_PERIOD = 8  # least states in a period of the highest mode that pictures show


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
