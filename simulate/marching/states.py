"""Recorded state of a sweep with the largest displacement beyond the gap."""

from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from geometry.project import UserError
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


def largest_state(sweep: xr.Dataset) -> tuple[dict[str, Any], NDArray[np.float64]]:
    """State with the largest radial displacement over any strip beyond its initial gap.

    The largest displacement of all may be at a corner far from the liner, or inward, where the
    vibration unloads the blade: hence the gap is subtracted. Runs without a result are left out.

    Returns
    -------
    dict, NDArray
        For files: status of the run, its speed, revolutions since the start, chord fraction of the
        place and its radial displacement, m, outward positive; reduced displacements (n,), m.

    Raises
    ------
    geometry.project.errors.UserError
        When the sweep holds no states, or no run with a result.
    """
    if "states" not in sweep:
        raise UserError("the sweep holds no states: set record.states_rounds in its scene")
    runs = sweep.isel(speed_over_f1=np.flatnonzero(sweep["status"].isin(WITH_RESULT)))
    if runs.sizes["speed_over_f1"] == 0:
        raise UserError("no run of the sweep ended ok: there is no state to show")
    u_r = runs["states"].values @ runs["P"].values.T
    gap = runs["gap"].values  # of the strips, or of each speed's strips
    beyond = u_r - (gap if gap.ndim == 1 else gap[:, None])
    speed, time, strip = np.unravel_index(beyond.argmax(), beyond.shape)
    numbers = {
        "status": str(runs["status"].values[speed]),
        "speed_over_f1": float(runs["speed_over_f1"][speed]),
        "speed_rad_s": float(runs["speed"][speed]),
        "time_rounds": float(runs["time"][time]),
        "xi": float(runs["xi"][strip]),
        "u_r_m": float(u_r[speed, time, strip]),
    }
    return numbers, runs["states"].values[speed, time]
