"""A sweep: one scene at its speeds, and at more speeds around the peaks that it asks for.

Runs at given speeds (``over_speeds``) do not depend on how peaks are found.
"""

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from math import inf
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from geometry.base import Say, known, silent
from rom.model import Rom
from simulate.errors.accuracy import Choice
from simulate.scene import EVERY, PEAKS, Peaks, Scene
from simulate.sweeps.dataset import OF_MOTION, checks, merge
from simulate.sweeps.over_speeds import as_sweep, at_speeds, tell_before
from simulate.sweeps.peak import Responses, along_order, peaks_or_largest, rise
from simulate.sweeps.unusual import doubts_of_runs, warn_of


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

    Limits that the runs exceed are warned of.
    """
    judged, added, seen = runs.drop_vars(OF_MOTION, errors="ignore"), [], {}
    while scene.peaks:
        of, along_of = Responses.of(judged, rom), partial(along_order, judged)
        speeds = further(scene.peaks, judged["speed"].values, of, along_of, seen, len(added))
        if not speeds:
            break
        new = at_speeds(scene, rom, speeds, report, choice, start)
        of_new = as_sweep(new, choice=choice, check=False).drop_vars(OF_MOTION, errors="ignore")
        judged, added = merge([judged, of_new]), added + new
    if scene.peaks and not scene.peaks.orders and len(added) == scene.peaks.most:
        report(f"peaks.most: {len(added)} speeds are added: more may raise peaks")
    if added:
        runs = merge([runs, as_sweep(added, report, choice)])
    if scene.verify == PEAKS:
        runs = verified(scene, rom, runs, report, choice)
    report(checks(runs))
    warn_of(doubts_of_runs(runs).values())
    return runs


def verified(
    scene: Scene, rom: Rom, runs: xr.Dataset, report: Say = silent, choice: Choice | None = None
) -> xr.Dataset:
    """``runs``, those at the peaks with all second runs, as `verify: every` has them.

    Without a peak that where the sweep responds most.
    """
    at_peaks = sorted({peak.index for peak in peaks_or_largest(runs, rom)})
    speeds = runs["speed"].values[at_peaks]
    again = at_speeds(scene.but(verify=EVERY), rom, speeds, report, choice)
    if not again:
        return runs
    judged = as_sweep([replace(run, scene=scene) for run in again], choice=choice, check=False)
    others = np.delete(np.arange(len(runs["speed"])), at_peaks)
    return merge([runs.isel(speed_over_f1=others), judged])


def further(
    peaks: Peaks,
    Omega: NDArray[np.float64],
    of: Responses,
    along_of: Callable[[int], NDArray[np.float64]],
    seen: dict[Any, tuple[float, float]],
    added: int,
) -> list[float]:
    """Speeds (rad/s) halfway between each peak and its neighbours, ascending.

    Where a neighbour is farther than asked for. Without ``orders`` also where the last turn raised
    a peak by more than the resonance through it and its neighbours had said; those of the highest
    peaks, if there are more than may be ``added``.

    Parameters
    ----------
    peaks : what the scene asks for
    Omega : (speeds,), rad/s, ascending
    of, along_of : responses at these, and as of ``Responses.near_f1``
    seen : by order and modes of each its amplitude, gaps, in the last turn, and the relative rise
        from it to the top of the resonance; this turn's are put in
    added : number of speeds that are added already
    """
    speeds = dict[float, None]()
    asked = [of.near_f1(k, along_of) for k in peaks.orders or ()]
    found = filter(None, asked) if peaks.orders else of.stand_out()
    for peak in sorted(found, key=lambda peak: -(peak.amplitude or 0.0)):
        three, height = slice(max(peak.index - 1, 0), peak.index + 2), peak.amplitude or 0.0
        near = Omega[three]
        far = np.diff(near) > peaks.within_over_f1 * of.rom.omega1 * (1 + 1e-9)
        if not peaks.orders:
            before, said = seen.get((peak.k, peak.modes), (height, inf))
            far |= height > before * (1 + said)
            along = of.series(known(peak.k, "k"), peak.place)[three]
            seen[peak.k, peak.modes] = height, rise(near, along) if len(near) == 3 else inf
        speeds |= dict.fromkeys(((near[:-1] + near[1:]) / 2)[far].tolist())
    return sorted([*speeds][: None if peaks.orders else peaks.most - added])
