"""The worst coating over ten times the paper's rounds: claims C25 and C26."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr

from geometry.project import read_json
from rom.model import Rom
from simulate.errors.signals import amplitude, spectrum
from simulate.marching.run import march
from simulate.marching.setup import prepare
from simulate.scene import LEADING, Scene
from simulate.sweeps.dataset import load
from workflow.paper.cases import WORST, of_coating
from workflow.paper.grid import at, worst
from workflow.paper.peaks import peak

ROUNDS = 200
WINDOW = 10  # rounds of each Fourier transform
ORDER = 4


def numbers(files: Any, scene: Mapping[str, Any]) -> dict[str, Any]:
    """``growth`` from the files of a rule."""
    given = Scene.model_validate(scene), Rom.load(files.rom)
    return growth(*given, read_json(files.grid), load(files.rigid))


def growth(scene: Scene, rom: Rom, table: dict[str, Any], rigid: xr.Dataset) -> dict[str, Any]:
    """Growth of the worst case found and of the paper's, each at its Omega_c; the bare casing.

    Returns
    -------
    dict
        "cases": ``rounds``, the ends of the windows, and the ``amplitude`` over the gap in each,
        None after the end of a run; "rigid": the peak of the sweep ``rigid``.
    """
    named = {"worst found": worst(table), "the paper's worst": at(table, *WORST)}
    return {
        "cases": [_over_rounds(scene, rom, name, case) for name, case in named.items()],
        "rigid": peak(rigid, rom, ORDER),
    }


def _over_rounds(scene: Scene, rom: Rom, name: str, case: dict[str, Any]) -> dict[str, Any]:
    speed = case["peaks"][str(ORDER)]["Omega_c"]
    long = of_coating(scene, case["E"], case["K"]).but(
        rounds=ROUNDS, record__history={"chord": [LEADING]}
    )
    setup = prepare(long, rom, speed * 2 * np.pi * rom.f1)
    outcome = march(long, setup)
    windows = outcome.u_r[:, 0].reshape(ROUNDS // WINDOW, -1)
    gap = float(scene.clearance.gaps(LEADING, rom.span))
    amplitudes = [amplitude(spectrum(window), WINDOW, ORDER) / gap for window in windows]
    return {
        "name": name,
        "E": case["E"],
        "K": case["K"],
        "Omega_c": speed,
        "status": outcome.status,
        "rounds": [WINDOW * (i + 1) for i in range(len(amplitudes))],
        "amplitude": [None if np.isnan(value) else float(value) for value in amplitudes],
    }
