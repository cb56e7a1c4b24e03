"""Peaks of one and of several blades over one liner: a row of an experiment, and its table."""

from typing import Any

import xarray as xr

from rom.model import Rom
from simulate.errors.observables import numbers
from simulate.errors.run import Case
from simulate.marching import prepare
from simulate.scene import OF_LAST_ROUNDS, Scene
from simulate.signals import leading_gap, leading_wear
from simulate.sweeps.peak import Peak, peak_of

UM = 1e6
ORDERS = (4, 5)
PASSES = 3200  # most of the tips, of a run that goes on until it is steady


def at_peaks(runs: xr.Dataset, scene: Scene, rom: Rom) -> dict[str, Any]:
    """The peaks of mode 1 along ``ORDERS`` after the runs' revolutions, and there when steady.

    Speed over f1(0), lengths in um: of the worst blade, the amplitude also of the median blade and
    of the blade with least. The steady motion goes on to ``PASSES`` of the tips at most.
    """
    found = {k: peak_of(runs, rom, k) for k in ORDERS}
    return {f"EO {k}": _at(runs, scene, rom, peak) for k, peak in found.items() if peak}


def _at(runs: xr.Dataset, scene: Scene, rom: Rom, peak: Peak) -> dict[str, Any]:
    """Numbers at a peak."""
    at, count = runs.isel(speed_over_f1=peak.index), scene.stage.count if scene.stage else 1
    amplitude = (peak.amplitude or 0.0) * leading_gap(runs)
    along = at["blade_along"].sel(order=peak.k) if scene.stage else xr.DataArray([amplitude])
    return {
        "speed": peak.Omega_c,
        "stands_out": int(peak.reported),
        "amplitude_um": UM * amplitude,
        "median_um": UM * float(along.median()),
        "least_um": UM * float(along.min()),
        "largest_um": UM * float(at["displacement"]),
        "wear_um": UM * float(leading_wear(at).max()),
        "worst": int(at["worst"]) if scene.stage else 0,
        "steady": _steady(scene, rom, float(at["speed"]), peak.k, PASSES // count),
    }


def _steady(scene: Scene, rom: Rom, Omega: float, k: float | None, rounds: int) -> dict[str, Any]:
    """The same at one speed, of a run from rest that ends when it is steady."""
    unused = dict.fromkeys(OF_LAST_ROUNDS)
    scene = scene.but(until="steady", rounds=rounds, record=unused)
    run = Case(scene, rom, prepare(scene, rom, Omega)).march()
    of = numbers(run, k)
    return {
        "status": run.outcome.status,
        "trend": run.outcome.trend,
        "rounds": run.outcome.rounds,
        "amplitude_um": UM * of["amplitude"] if "amplitude" in of else None,
        "wear_um": UM * of["wear"],
    }
