"""Linear crossings: speeds at which a natural frequency meets an engine order, f = k Omega."""

from collections.abc import Callable, Iterable
from functools import lru_cache, partial
from operator import itemgetter

import numpy as np
from numpy.typing import NDArray

from rom.model import Rom

POINTS = 33  # speeds between which a mode meets an order once at most

type Crossing = tuple[int, float, float]  # mode, order, speed


def crossings_of(
    f: Callable[[float], NDArray[np.float64]],
    orders: Iterable[float],
    lowest: float,
    highest: float,
) -> list[Crossing]:
    """Mode, order and speed of each crossing from ``lowest`` to ``highest``, speeds ascending.

    ``f``: frequencies (modes,), ascending, at a speed, in its unit.

    >>> import numpy as np
    >>> f = lambda speed: np.sqrt([1 + 0.4 * speed**2, 9 + 0.4 * speed**2])
    >>> [(mode, k, round(speed, 4)) for mode, k, speed in crossings_of(f, [3, 4], 0.0, 0.8)]
    [(1, 4, 0.2532), (1, 3, 0.341), (2, 4, 0.7596)]
    """
    from scipy.optimize import brentq  # a slow import, which many jobs do not need

    k, speeds = [*orders], np.linspace(lowest, highest, POINTS)
    lines = speeds[:, None, None] * np.array(k)
    above = np.array([f(speed) for speed in speeds])[:, :, None] >= lines
    changes = np.argwhere(above[:-1] != above[1:])
    met = [
        (
            int(mode) + 1,
            k[j],
            brentq(lambda speed: f(speed)[mode] - k[j] * speed, *speeds[i : i + 2], xtol=1e-9),  # noqa: B023
        )
        for i, mode, j in changes
    ]
    return sorted(met, key=itemgetter(2))


def first_frequencies(rom: Rom, modes: int, degree: int, speed: float) -> NDArray[np.float64]:
    """First natural frequencies (modes,) at a speed, over f1(0); of ``Rom.beyond`` by degree."""
    omega = rom.beyond(degree) if degree else lambda Omega: rom.modes(Omega)[0]
    return omega(speed * rom.omega1)[:modes] / rom.omega1


@lru_cache(256)
def crossing(rom: Rom, k: float, mode: int = 1) -> float:
    """Linear crossing of a mode, f(Omega) = k Omega, Eq. (21), over f1(0); nan up to Omega_m.

    >>> round(crossing(rom, 4), 2)
    0.31
    """
    met = crossings_of(partial(first_frequencies, rom, mode, 0), [k], 0.0, rom.Omega_m / rom.omega1)
    return next((speed for of, _, speed in met if of == mode), float("nan"))
