"""f1(Omega) and where engine orders meet it: the same numbers in every figure."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rom.model import Rom
from simulate.observables import linear_crossing

POINTS = 161  # speeds at which the reduced model's frequencies are computed


@dataclass(frozen=True)
class Curve:
    """First natural frequency over speed, both over f1(0)."""

    speeds: NDArray[np.float64]  # (points,)
    f1: NDArray[np.float64]  # (points,)

    @classmethod
    def of(cls, rom: Rom) -> "Curve":
        """f1(Omega) of the reduced model over its speed range."""
        speeds, frequencies = frequencies_over_speed(rom, 1)
        return cls(speeds, frequencies[:, 0])

    def crossing(self, k: int) -> float:
        """Speed over f1(0) where engine order ``k`` meets f1; nan when it does not."""
        return linear_crossing(self.f1, self.speeds, k)


def frequencies_over_speed(rom: Rom, modes: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Speeds (POINTS,) up to Omega_m and the frequencies (POINTS, modes) there, over f1(0)."""
    unit = 2 * np.pi * rom.f1  # rad/s for 1 Hz of f1(0)
    speeds = np.linspace(0, rom.Omega_m, POINTS)
    frequencies = np.array([rom.modes(speed)[0][:modes] for speed in speeds])
    return speeds / unit, frequencies / unit
