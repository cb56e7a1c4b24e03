"""Share a(t) of the casing distortion over the revolutions: a smooth step, or a table.

A table is linear between its revolutions and constant after the last: a casing that closes, opens,
or closes and opens again. The energy of each change is booked where it happens: as work of the
casing on the rods under the tip, at the blade's displacement (``contact.ledger``).
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from simulate.contact.compiled import compiled
from simulate.scene.tables import RampTable


class Ramp(NamedTuple):
    """Share of the casing distortion as the kernel reads it."""

    share: Any  # compiled: of numbers and revolutions
    bounds: Any  # compiled: least and largest share between two times
    numbers: Any  # float, length of smooth step, or NDArray (2, points), revolutions and factors

    def at(self, rounds: NDArray[np.float64]) -> NDArray[np.float64]:
        """Shares at the times ``rounds``, for pictures."""
        return np.array([self.share(self.numbers, float(time)) for time in rounds])


def ramp_of(casing: Any) -> Ramp:
    """That of the casing of a scene."""
    return smooth(float(casing.ramp_rounds)) if casing.ramp is None else tabled(casing.ramp)


def tabled(table: RampTable) -> Ramp:
    """A table as the kernel reads it."""
    return Ramp(share, bounds, np.array([table.rounds, table.factor], float))


def smooth(rounds: float) -> Ramp:
    """The smooth step from 0 to 1 over ``rounds``."""
    return Ramp(distortion_share, smooth_bounds, rounds)


@compiled
def distortion_share(ramp_rounds, rounds):
    """a(t): smooth step x^2 (3 - 2 x) from 0 to 1 over the ramp."""
    if rounds >= ramp_rounds:
        return 1.0
    x = rounds / ramp_rounds
    return x * x * (3.0 - 2.0 * x)


@compiled
def smooth_bounds(ramp_rounds, first, last):
    """Share at ``first`` and ``last``: it grows."""
    return distortion_share(ramp_rounds, first), distortion_share(ramp_rounds, last)


@compiled
def share(table, rounds):
    """Factor of the table at ``rounds``."""
    last = table.shape[1] - 1
    if rounds >= table[0, last]:
        return table[1, last]
    k = 0
    while table[0, k + 1] <= rounds:
        k += 1
    part = (rounds - table[0, k]) / (table[0, k + 1] - table[0, k])
    return table[1, k] + part * (table[1, k + 1] - table[1, k])


@compiled
def bounds(table, first, last):
    """Least and largest factor between the revolutions ``first`` and ``last``."""
    one, other = share(table, first), share(table, last)
    low, high = min(one, other), max(one, other)
    for k in range(table.shape[1]):
        if first < table[0, k] < last:
            low, high = min(low, table[1, k]), max(high, table[1, k])
    return low, high
