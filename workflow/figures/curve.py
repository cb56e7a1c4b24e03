"""Natural frequencies of the reduced model over the speed, for all figures."""

import numpy as np
from numpy.typing import NDArray

from rom.model import Rom

POINTS = 161  # speeds


def frequencies_over_speed(rom: Rom, modes: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Speeds (POINTS,) up to Omega_m and the frequencies (POINTS, modes) there, over f1(0)."""
    unit = 2 * np.pi * rom.f1  # rad/s for 1 Hz of f1(0)
    speeds = np.linspace(0, rom.Omega_m, POINTS)
    frequencies = np.array([rom.modes(speed)[0][:modes] for speed in speeds])
    return speeds / unit, frequencies / unit
