"""A sweep: one scene at its speeds, and at more speeds around the peaks that it asks for.

Runs at given speeds (``over_speeds``) do not depend on how peaks are found.
"""

from collections.abc import Callable
from functools import partial

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from geometry.project import Say, silent
from rom.model import Rom
from simulate.errors.accuracy import Choice
from simulate.scene import Peaks, Scene
from simulate.sweeps.dataset import checks, merge
from simulate.sweeps.over_speeds import as_sweep, at_speeds, tell_before
from simulate.sweeps.peak import Peak, peak_of
from simulate.sweeps.plausible import doubts_of_runs, warn_of


def sweep(
    scene: Scene,
    rom: Rom,
    report: Say = silent,
    choice: Choice | None = None,
    start: xr.Dataset | None = None,
) -> xr.Dataset:
    """Run the scene at its speeds, and at more speeds around its peaks.

    With a ``choice``, step, density and strips are the chosen ones, and the dataset has the
    relative `error` of each run. ``report`` gets one line per run. ``start``: the sweep from which
    a scene with `start` goes on.

    Raises
    ------
    simulate.marching.setup.SceneError
        When the scene does not fit the reduced model or the step is above its limit.
    """
    tell_before(choice.scene(scene) if choice else scene, rom, report)
    speeds = scene.speeds.omega(rom.f1)
    runs = as_sweep(at_speeds(scene, rom, speeds, report, choice, start), report, choice)
    return close_in(scene, rom, runs, report, choice, start)


def close_in(
    scene: Scene,
    rom: Rom,
    runs: xr.Dataset,
    report: Say = silent,
    choice: Choice | None = None,
    start: xr.Dataset | None = None,
) -> xr.Dataset:
    """``runs`` at the scene's speeds, and more runs around the peaks that it asks for.

    The spacing of the speeds on both sides of each peak is halved until it is at most
    ``scene.peaks.within_over_f1``. Limits that the runs exceed are warned of.
    """
    first_runs, added = runs, []
    while scene.peaks and (
        speeds := halfway(scene.peaks, rom.f1, runs["speed"].values, partial(peak_of, runs, rom))
    ):
        new = at_speeds(scene, rom, speeds, report, choice, start)
        runs, added = merge([runs, as_sweep(new, choice=choice, check=False)]), added + new
    if added:
        runs = merge([first_runs, as_sweep(added, report, choice)])
    report(checks(runs))
    warn_of(doubts_of_runs(runs).values())
    return runs


def halfway(
    peaks: Peaks,
    f1: float,
    Omega: NDArray[np.float64],
    peak_at: Callable[[int], Peak | None],
) -> list[float]:
    """Speeds (rad/s) halfway between each peak and its neighbours that are too far away.

    Parameters
    ----------
    peaks : the peaks that the scene asks for
    f1 : Hz, first natural frequency at rest
    Omega : (speeds,), rad/s, ascending
    peak_at : peak among these speeds along an engine order
    """
    speeds = set()
    for peak in filter(None, map(peak_at, peaks.orders)):
        near = Omega[max(peak.index - 1, 0) : peak.index + 2]
        far = np.diff(near) > peaks.within_over_f1 * 2 * np.pi * f1 * (1 + 1e-9)
        speeds |= set(((near[:-1] + near[1:]) / 2)[far].tolist())
    return sorted(speeds)
