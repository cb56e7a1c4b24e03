"""Response peaks of a sweep, and where the blade alone would have them."""

import numpy as np
import xarray as xr
from numpy.typing import NDArray
from scipy.optimize import brentq

from rom.model import Rom
from simulate.dataset import scene_of
from simulate.observables import Peak, order_amplitude, peak_along_order


def crossing(rom: Rom, k: int) -> float:
    """Linear crossing f1(Omega) = k Omega, Eq. (21), over f1(0); nan where it is above Omega_m."""
    unit = 2 * np.pi * rom.f1

    def above(speed: float) -> float:
        return rom.modes(speed * unit)[0][0] / unit - k * speed

    end = rom.Omega_m / unit
    return float(brentq(above, 0, end, xtol=1e-9)) if above(end) < 0 else float("nan")


def along_order(found: xr.Dataset, k: int) -> NDArray[np.float64]:
    """Amplitude (speeds,) of u_r at xi = 1/16 along engine order ``k``, m; nan where it failed."""
    rounds = scene_of(found).record.spectrum_rounds
    spectra = found["spectrum"].values
    return order_amplitude(spectra, np.arange(spectra.shape[1]) / rounds, k)


def peak_of(found: xr.Dataset, rom: Rom, k: int) -> Peak | None:
    """Peak of a sweep along engine order ``k``, speed over f1(0), ||Y|| in m."""
    speeds = found["speed_over_f1"].values
    return peak_along_order(speeds, along_order(found, k), k, crossing(rom, k))
