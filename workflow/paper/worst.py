"""The worst coating over ten times the paper's rounds: claims C25 and C26."""

from typing import Any

import numpy as np

from rom.model import Rom
from simulate.observables import order_amplitude, spectrum
from simulate.run import march, prepare
from simulate.scene import Scene
from workflow.paper.cases import WORST, of_coating
from workflow.paper.grid import at, worst

ROUNDS = 200
WINDOW = 10  # rounds of each Fourier transform
ORDER = 4


def growth(scene: Scene, rom: Rom, table: dict[str, Any]) -> list[dict[str, Any]]:
    """Amplitude over the rounds of the worst case found, and of the paper's, at their Omega_c.

    ``rounds``: ends of the windows; ``amplitude`` over the gap there, None where a run has ended.
    """
    named = {"worst found": worst(table), "the paper's worst": at(table, *WORST)}
    return [_over_rounds(scene, rom, name, case) for name, case in named.items()]


def _over_rounds(scene: Scene, rom: Rom, name: str, case: dict[str, Any]) -> dict[str, Any]:
    speed = case["peaks"][str(ORDER)]["Omega_c"]
    long = of_coating(scene, case["E"], case["K"]).changed(
        rounds=ROUNDS, record__history={"nodes": [1]}
    )
    setup = prepare(long, rom, speed * 2 * np.pi * rom.f1)
    outcome = march(long, setup)
    windows = outcome.u_r[:, 0].reshape(ROUNDS // WINDOW, -1)
    found = [_amplitude(window) / setup.strips.g0[0] for window in windows]
    return {
        "name": name,
        "E": case["E"],
        "K": case["K"],
        "Omega_c": speed,
        "status": outcome.status,
        "rounds": [WINDOW * (i + 1) for i in range(len(found))],
        "amplitude": [None if np.isnan(value) else float(value) for value in found],
    }


def _amplitude(u_r: np.ndarray) -> float:
    if np.isnan(u_r).any():
        return np.nan
    found = spectrum(u_r)
    return float(order_amplitude(found[None], np.arange(found.size) / WINDOW, ORDER)[0])
