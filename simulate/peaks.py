"""Response peaks of a sweep, found on its speeds and closed in on between them."""

from collections.abc import Callable

import numpy as np
import xarray as xr
from numpy.typing import NDArray
from scipy.optimize import brentq

from rom.model import Rom
from simulate.accuracy import Choice
from simulate.observables import Peak, order_amplitude, peak_along_order
from simulate.scene import Scene
from simulate.sweep import merge, scene_of, sweep


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


def close_in(
    scene: Scene,
    rom: Rom,
    found: xr.Dataset,
    report: Callable[[str], None] = lambda line: None,
    choice: Choice | None = None,
) -> xr.Dataset:
    """``found``, a sweep of the scene, with more speeds around the peaks it asks for.

    The spacing of the speeds on both sides of each peak is halved until it is no more than
    ``scene.peaks.within_over_f1``.
    """
    while speeds := _between(scene, rom, found):
        found = merge([found, sweep(scene, rom, speeds, report, choice)])
    return found


def _between(scene: Scene, rom: Rom, found: xr.Dataset) -> list[float]:
    """Speeds (rad/s) halfway to the neighbours of each peak that are too far away."""
    if scene.peaks is None:
        return []
    Omega, halfway = found["speed"].values, set()
    for k in scene.peaks.orders:
        if (peak := peak_of(found, rom, k)) is None:
            continue
        near = Omega[max(peak.index - 1, 0) : peak.index + 2]
        far = np.diff(near) > scene.peaks.within_over_f1 * 2 * np.pi * rom.f1 * (1 + 1e-9)
        halfway |= set(((near[:-1] + near[1:]) / 2)[far].tolist())
    return sorted(halfway)
