"""The worst coating over ten times the paper's rounds: claims C25 and C26."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from rom.model import Rom
from simulate.errors.signals import amplitude, spectrum
from simulate.marching import march, prepare
from simulate.scene import LEADING, Scene
from workflow.paper.cases import WORST
from workflow.paper.grid import Case, at, worst

ROUNDS = 200
WINDOW = 10  # rounds of each Fourier transform
ORDER = 4


def long_cases(table: dict[str, Any]) -> dict[str, Case]:
    """The cases whose growth is followed, by name: the worst case found and the paper's."""
    return {"worst found": worst(table), "the paper's worst": at(table, *WORST)}


def growth(scene: Scene, rom: Rom, name: str, case: Mapping[str, Any]) -> dict[str, Any]:
    """Amplitudes of a coating over the rounds, at its Omega_c.

    ``scene``: that of the coating; ``case``: its numbers, as of the table of E and K.

    Returns
    -------
    dict
        ``rounds``, the ends of the windows, and the ``amplitude`` over the gap in each, None after
        the end of a run; name, coating, speed and status.
    """
    speed = case["peaks"][str(ORDER)]["Omega_c"]
    long = scene.but(rounds=ROUNDS, record__history={"chord": [LEADING]})
    outcome = march(long, prepare(long, rom, speed * rom.omega1))
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
