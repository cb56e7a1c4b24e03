"""Critical speeds of a blade: its linear crossings from rest to the highest speed and beyond."""

from collections.abc import Mapping
from functools import partial
from typing import Any

import numpy as np

from geometry.base import RPM
from rom.crossings import crossings_of, first_frequencies
from rom.model import Rom
from simulate.sweeps.result_types import CriticalSpeed

BEYOND = 1.25  # of Omega_m: no farther than there are frequencies extrapolated


def critical(rom: Rom, sought: Mapping[str, Any]) -> dict[str, Any]:
    """Critical speeds of a blade from rest to the highest speed of its model, and beyond it.

    Beyond it where there are operating speeds. Gyroscopic terms are not in the model.

    Parameters
    ----------
    sought : ``lines``, operating speeds by name, rpm; the number of ``modes``, from the first, and
        the engine ``orders`` that they may meet; what excites some of these (``excited``, by order)

    Returns
    -------
    ``sought``, with ``Hz``, frequencies of the modes at each line; ``crossings``; the speed, rpm,
    ``up_to`` which they are known, and the two ``through`` which f^2 goes on linearly above the
    highest, empty where it does not.
    """
    lines, top = sought["lines"], rom.Omega_m / rom.omega1
    goes_on = bool(lines) and rom.speeds.size > 2
    spans = [("crossing", (0.0, top))]
    spans += [("extrapolated crossing", (top, BEYOND * top))] * goes_on
    unit, found, modes = RPM * rom.omega1, [], sought["modes"]
    for degree, (what, between) in enumerate(spans):
        met, again = (
            crossings_of(partial(first_frequencies, rom, modes, of), sought["orders"], *between)
            for of in (degree, 2 * degree)  # within the model the same
        )
        quadratic = {(mode, k): unit * speed for mode, k, speed in again}
        found += [
            CriticalSpeed(
                what=what,
                modes=[mode],
                k=k,
                rpm=unit * speed,
                quadratic_rpm=quadratic.get((mode, k), np.nan),
                bound=False,
            )
            for mode, k, speed in met
        ]
    return {
        **sought,
        "Hz": {
            name: (rom.modes(rpm / RPM)[0][:modes] / (2 * np.pi)).tolist()
            for name, rpm in lines.items()
        },
        "crossings": found,
        "through": (RPM * rom.speeds[-2:]).tolist() if goes_on else [],
        "up_to": unit * top * (BEYOND if goes_on else 1.0),
    }
