"""Speeds at which rotation feeds blade and casing through a rub: n Omega = w_b + w_n.

A casing of n diameters then has a wave that follows the rotor, slower than it, and takes in the
frame of the blade the frequency n Omega - w_n of the blade. Contact couples both, and both grow
(flutter). A blade in contact is stiffer than a free one: so it is a range of speeds, from the free
blade to one of which all strips are engaged with the unworn liner.
"""

from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from geometry.base import RPM
from rom.crossings import crossings_of, first_frequencies
from rom.model import Rom
from simulate.contact.places import closing_rows, strip_places
from simulate.marching.setup import strip_stiffness
from simulate.scene import Casing, Liner
from simulate.scene.casing_modes import CasingMode


def whirls(rom: Rom, liner: Liner, casing: Casing, modes: int) -> list[dict[str, Any]]:
    """Ranges of speed in which each pair of a casing meets the first ``modes`` of the blade.

    Of each its ``order`` and frequency ``Hz``, the number of ``modes``, the highest speed ``up_to``
    of the model, rpm, and those ``met``: the blade's ``mode``, the speeds ``rpm`` with the free
    blade and ``rpm_to`` with one in contact, at most that speed (``bound``), and ``f_over_Omega``
    of the free blade.
    """
    unit, up_to = RPM * rom.omega1, RPM * rom.Omega_m
    free = partial(first_frequencies, rom, modes, 0)
    places = strip_places(rom, liner, casing)
    P, k = closing_rows(rom, casing, places.xi), strip_stiffness(liner, places)
    engaged, found = partial(_engaged, rom, P, k, modes), []
    for mode in (mode for mode in casing.moves if mode.order):
        ends = _met(rom, engaged, mode)
        met = [
            {
                "mode": number,
                "rpm": unit * speed,
                "rpm_to": unit * ends[number] if number in ends else up_to,
                "bound": number not in ends,
                "f_over_Omega": float(free(speed)[number - 1] / speed),
            }
            for number, speed in _met(rom, free, mode).items()
        ]
        of_casing = {"order": mode.order, "Hz": mode.frequency_Hz, "met": met}
        found.append(of_casing | {"modes": modes, "up_to": up_to})
    return found


def _met(rom: Rom, f: Any, mode: CasingMode) -> dict[int, float]:
    """Speed over f1(0) at which each mode of a blade, of frequencies ``f``, meets the casing's."""
    of_casing = mode.frequency_Hz / rom.f1
    highest = rom.Omega_m / rom.omega1
    met = crossings_of(lambda speed: f(speed) + of_casing, [mode.order], 0.0, highest)
    return dict(sorted((number, speed) for number, _, speed in met))


def _engaged(
    rom: Rom, P: NDArray[np.float64], k: NDArray[np.float64], modes: int, speed: float
) -> NDArray[np.float64]:
    """First frequencies (modes,), over f1(0), with all strips in contact, at a speed over it.

    ``P`` (m, n): what closes the gaps of the strips; ``k`` (m,): their stiffness, N/m.
    """
    omega, Phi = rom.modes(speed * rom.omega1)
    rows = P @ Phi
    K = np.diag(omega**2) + rows.T @ (k[:, None] * rows)
    return np.sqrt(np.linalg.eigvalsh(K)[:modes]) / rom.omega1
