"""Stress of a motion at one node of a body: its cycles, margin and damage."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fem.fatigue import damage, numbers, reserve, uniaxial
from fem.worst_node import cycles
from geometry.base import known
from geometry.blade import Fatigue


@dataclass(frozen=True)
class NodeStress:
    """Stress at a node over the amplitudes of a motion (times, 1 + n): 1, of rotation, then n."""

    sigma: NDArray[np.float64]  # (1 + n, 6), Pa
    fatigue: Fatigue | None

    def numbers(self, a: NDArray[np.float64]) -> dict[str, float]:
        """Mean and alternating stress, Pa, and the margin where there is a strength."""
        of_node = numbers(*cycles(self.sigma[:, None], a), self.fatigue)
        return {name: float(values[0]) for name, values in of_node.items()}

    def worst(self, revolutions: Iterable[NDArray[np.float64]]) -> dict[str, float]:
        """The numbers of the worst of revolutions, each by itself."""
        return min(map(self.numbers, revolutions), key=reserve)

    def order(self, a: NDArray[np.float64]) -> int:
        """Cycles in a revolution: of the largest line of the stress along its largest change."""
        return 1 + int(np.abs(np.fft.rfft(uniaxial(a @ self.sigma)))[1:].argmax())

    def damage(self, a: NDArray[np.float64]) -> float:
        """Miner's damage."""
        return damage(uniaxial(a @ self.sigma), known(self.fatigue, "fatigue"))
