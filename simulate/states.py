"""Recorded states of a sweep: which one to look at."""

from dataclasses import dataclass

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from simulate.status import WITH_RESULT


@dataclass(frozen=True)
class State:
    """Reduced displacements at one speed and time, and the place farthest beyond its gap."""

    status: str  # of the run: ok, or sensitive
    Omega: float  # rad/s
    speed_over_f1: float
    time: float  # rounds since the start
    xi: float  # its chord fraction
    u_r: float  # m, its radial displacement, outward positive
    u: NDArray[np.float64]  # (n,), m

    def numbers(self) -> dict[str, float | str]:
        """What says which state it is."""
        return {
            "status": self.status,
            "speed_over_f1": self.speed_over_f1,
            "speed_rad_s": self.Omega,
            "time_rounds": self.time,
            "xi": self.xi,
            "u_r_m": self.u_r,
        }


def largest_state(sweep: xr.Dataset) -> State:
    """State with the largest radial displacement over any strip beyond its initial gap.

    Not the largest as such: that may be of a corner far from the liner, or inward, where the
    vibration unloads the blade. Runs without a result are left out.

    Raises
    ------
    ValueError
        When the sweep holds no states, or none of a run with a result.
    """
    if "states" not in sweep:
        raise ValueError("the sweep holds no states: set record.states_rounds in its scene")
    runs = sweep.isel(speed=np.flatnonzero(sweep["status"].isin(WITH_RESULT)))
    if runs.sizes["speed"] == 0:
        raise ValueError("no run of the sweep ended ok: it has no state to show")
    u_r = runs["states"].values @ runs["P"].values.T
    beyond = u_r - runs["gap"].values
    speed, time, strip = np.unravel_index(beyond.argmax(), beyond.shape)
    return State(
        status=str(runs["status"].values[speed]),
        Omega=float(runs["speed"][speed]),
        speed_over_f1=float(runs["speed_over_f1"][speed]),
        time=float(runs["time"][time]),
        xi=float(runs["xi"][strip]),
        u_r=float(u_r[speed, time, strip]),
        u=runs["states"].values[speed, time],
    )
