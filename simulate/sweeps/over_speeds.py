"""A sweep: one scene at its speeds, and at more speeds around the peaks that it asks for."""

from collections.abc import Callable, Sequence
from functools import partial
from time import perf_counter
from typing import NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from geometry.project import progress
from rom.model import Rom
from simulate.errors.accuracy import Choice, march_to_accuracy
from simulate.errors.halving import beside_halved
from simulate.errors.resolution import check_resolution, judge_alone
from simulate.errors.twin import beside_twin
from simulate.marching.checks import check_scene
from simulate.marching.run import Outcome, make_kernel, march
from simulate.marching.setup import SceneError, Setup, prepare
from simulate.marching.start import Left, Worn
from simulate.scene import Peaks, Scene
from simulate.sweeps.before import before
from simulate.sweeps.cost import cost
from simulate.sweeps.dataset import attributes, merge, of_run, require_rom
from simulate.sweeps.peak import Peak, peak_of
from simulate.sweeps.plausible import doubts, doubts_of_runs, warn_of

LONG = 1.0  # s, wall time above which a compilation is logged

type Report = Callable[[str], None]


def no_report(line: str) -> None:
    """Write no log."""


def sweep(
    scene: Scene,
    rom: Rom,
    report: Report = no_report,
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
    runs = at_speeds(scene, rom, scene.speeds.omega(rom.f1), report, choice, start)
    return close_in(scene, rom, runs, report, choice, start)


def tell_before(scene: Scene, rom: Rom, report: Report) -> None:
    """Warn of doubtful values, and report what the sweep will cost."""
    check_scene(scene, rom)
    warn_of(doubts(scene, rom).values())
    for line in cost(scene, rom, scene.speeds.count).lines():
        report(line)


def check_sweep(scene: Scene, rom: Rom, report: Report = no_report) -> None:
    """Check a scene against its reduced model once, before its blocks: all keys, extreme speeds.

    Doubtful values are warned of, and ``report`` gets what the sweep will cost.

    Raises
    ------
    simulate.marching.setup.SceneError
        As ``sweep``.
    """
    tell_before(scene, rom, report)
    speeds = scene.speeds.omega(rom.f1)
    for Omega in sorted({speeds.min(), speeds.max()}):
        set_up(scene, rom, Omega)


def block_speeds(scene: Scene, rom: Rom, block: int, blocks: int) -> NDArray[np.float64]:
    """Omega (rad/s) of every ``blocks``-th speed from ``block`` on: all blocks cost the same."""
    return scene.speeds.omega(rom.f1)[block::blocks]


def at_speeds(
    scene: Scene,
    rom: Rom,
    speeds: Sequence[float],
    report: Report = no_report,
    choice: Choice | None = None,
    start: xr.Dataset | None = None,
) -> xr.Dataset:
    """Run the scene at ``speeds`` (rad/s); all set-ups are checked before the first march.

    Speeds in turn end with the first run that leaves nothing to go on from.

    Raises
    ------
    simulate.marching.setup.SceneError
        As ``sweep``.
    """
    if choice:
        scene = choice.scene(scene)
    check_scene(scene, rom)
    setups = [set_up(scene, rom, Omega, choice) for Omega in speeds]
    lefts = _starts(scene, rom, speeds, start)
    for setup in setups[:1]:
        if (seconds := make_kernel(scene, setup)) > LONG:
            report(f"march compiled for this scheme and law: {seconds:.1f} s")
    runs, in_turn, last, begun = [], scene.speeds.in_turn, None, perf_counter()
    for done, (setup, left) in enumerate(zip(setups, lefts, strict=True), 1):
        run = march_one(scene, rom, setup, choice, last or left)
        far = progress.left(done, len(setups), perf_counter() - begun)
        report(f"{run.line}; speed {far}")
        runs.append(of_run(scene, rom, *run))
        last = run.outcome.left if in_turn else None
        if in_turn and last is None:
            break
    merged = xr.concat(runs, dim="speed_over_f1", join="outer")
    merged = merged.sortby("speed_over_f1") if in_turn else merged
    return merged.assign_attrs(attributes(scene, rom, choice))


def _starts(
    scene: Scene, rom: Rom, speeds: Sequence[float], runs: xr.Dataset | None
) -> list[Left | Worn | None]:
    """What the run at each speed starts from, of the sweep ``runs``; in turn the first alone."""
    if scene.start is None:
        if runs is not None:
            raise SceneError("missing: give the scene that the runs go on from", key="start")
        return [None] * len(speeds)
    if runs is not None:
        require_rom(runs, rom)
    at = before(scene, rom, runs)
    from_there = 1 if scene.speeds.in_turn else len(speeds)
    return [at(Omega) if i < from_there else None for i, Omega in enumerate(speeds)]


def close_in(
    scene: Scene,
    rom: Rom,
    runs: xr.Dataset,
    report: Report = no_report,
    choice: Choice | None = None,
    start: xr.Dataset | None = None,
) -> xr.Dataset:
    """``runs`` at the scene's speeds, and more runs around the peaks that it asks for.

    The spacing of the speeds on both sides of each peak is halved until it is at most
    ``scene.peaks.within_over_f1``. What the runs have gone beyond is warned of.
    """
    while speeds := _between(scene, rom, runs):
        runs = merge([runs, at_speeds(scene, rom, speeds, report, choice, start)])
    warn_of(doubts_of_runs(runs).values())
    return runs


def _between(scene: Scene, rom: Rom, runs: xr.Dataset) -> list[float]:
    """Speeds (rad/s) halfway between each peak and its neighbours that are too far away."""
    return halfway(scene.peaks, rom.f1, runs["speed"].values, partial(peak_of, runs, rom))


def halfway(
    peaks: Peaks | None,
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
    found = [peak for k in (peaks.orders if peaks else ()) if (peak := peak_at(k))]
    speeds = set()
    for peak in found:
        near = Omega[max(peak.index - 1, 0) : peak.index + 2]
        far = np.diff(near) > peaks.within_over_f1 * 2 * np.pi * f1 * (1 + 1e-9)
        speeds |= set(((near[:-1] + near[1:]) / 2)[far].tolist())
    return sorted(speeds)


class Marched(NamedTuple):
    """One run, with its error estimate and its difference from its twin where asked for."""

    setup: Setup
    outcome: Outcome
    seconds: float  # wall time
    departures: dict[str, float]  # from its twin, by observable; empty without a twin
    errors: dict[str, float]  # relative, by observable; empty without an accuracy or halving

    @property
    def line(self) -> str:
        """Speed, status and why, and wall time, for logs."""
        why = f" ({self.outcome.reason})" if self.outcome.reason else ""
        end = f"{self.outcome.status}{why}"
        return f"{self.setup.Omega:.6g} rad/s: {end}, {self.seconds:.2f} s"


def set_up(scene: Scene, rom: Rom, Omega: float, choice: Choice | None = None) -> Setup:
    """``prepare``, and without a ``choice`` of the steps a check that they resolve the rub.

    Raises
    ------
    simulate.marching.setup.SceneError
        As ``sweep``.
    """
    setup = prepare(scene, rom, Omega)
    if choice is None:
        check_resolution(scene, setup)
    return setup


def march_one(
    scene: Scene,
    rom: Rom,
    setup: Setup,
    choice: Choice | None,
    left: Left | Worn | None = None,
) -> Marched:
    """March one run, and its twin, companion or finer runs where the scene asks for it.

    ``left``: what they start from.
    """
    start = perf_counter()
    departures, errors = {}, {}
    if choice:
        run = march_to_accuracy(scene, rom, setup.Omega, choice)
        setup, outcome, errors = run.setup, run.outcome, run.errors
    else:
        outcome = march(scene, setup, left)
    if scene.twin:
        outcome, departures = beside_twin(scene, setup, outcome, left)
    if scene.halving:
        outcome, errors = beside_halved(scene, rom, setup, outcome)
    elif not choice:
        outcome = judge_alone(scene, outcome)
    return Marched(setup, outcome, perf_counter() - start, departures, errors)
