"""Two masses, of which one slides with friction: code_aster's case of stick and slip.

Friction here is that of a tip that always slides, so the run is that of the sliding, from 0.03512
to 0.31492 s. No scene has a force or a start but rest: the motion without friction, known in closed
form, is added to that of the simulator, in which friction alone acts.
"""

from collections.abc import Iterator

import numpy as np
from cases import Case, Row
from numpy.typing import NDArray
from rods import elastic, of_end, scene_of
from scipy.linalg import expm

from simulate.marching import march, prepare

MASS, SPRING, FORCE, UNTIL = 5.0, 1e4, 3000.0, 0.2  # kg, N/m, N on the second mass, s
PRESSED, STATIC, SLIDING = 1e4, 0.3, 0.2  # N on the first mass, coefficients of friction
SLIP = np.arccos(1 - STATIC * PRESSED / FORCE) / np.sqrt(SPRING / MASS)  # s, it begins to slide
STIFF, DEEP, HELD = 1e11, 0.01, 1e-3  # N/m, of the pressed direction; m; N/m, of both masses
TIME, STEPS, SAMPLES = 0.3, 16384, 4096  # s after SLIP


def without_friction(times: NDArray[np.float64]) -> NDArray[np.float64]:
    """Displacements (times, 2), m, from ``SLIP`` on; times from there, s."""
    pull = SPRING / MASS
    rates = np.zeros((5, 5))  # of x1, x2, their speeds, and 1
    rates[:2, 2:4] = np.eye(2)
    rates[2:4, :2] = [[-pull, pull], [pull, -pull]]
    rates[3, 4] = FORCE / MASS
    w = np.sqrt(pull)
    start = [
        0,
        FORCE / SPRING * (1 - np.cos(w * SLIP)),
        0,
        FORCE / SPRING * w * np.sin(w * SLIP),
        1,
    ]
    change = UNTIL - SLIP
    halfway = expm(rates * change) @ start
    unloaded = rates.copy()
    unloaded[3, 4] = 0
    return np.array(
        [
            (expm(rates * t) @ start if t < change else expm(unloaded * (t - change)) @ halfway)[:2]
            for t in times
        ]
    )


def by_friction() -> NDArray[np.float64]:
    """Displacements (SAMPLES, 2), m, from ``SLIP`` on by friction alone, from rest."""
    M = np.diag([MASS] * 3)  # of the pressed direction, of the first mass and of the second
    pair = SPRING * np.array([[1, -1], [-1, 1]]) + HELD * np.eye(2)
    K = np.array([[STIFF, 0, 0], [0, *pair[0]], [0, *pair[1]]])
    pushed = {"order": 0, "amplitude_m": DEEP + PRESSED / STIFF}
    Omega = 2 * np.pi / TIME
    rom = of_end(M, K, ("radial", "tangential"), 1.0, Omega)
    scene = scene_of(
        elastic(PRESSED / DEEP),
        0.0,
        speeds={"rad_s": [Omega]},
        rounds=1,
        damping_ratio=0.0,
        integrator={"scheme": "piecewise-exact", "steps_per_round": STEPS},
        casing={"harmonics": [pushed], "ramp_rounds": 0.0},
        contact={"friction": SLIDING},
        record={"samples_per_round": SAMPLES, "states_rounds": 1},
    )
    outcome = march(scene, prepare(scene, rom, Omega))
    first = outcome.states[:, [1, 3]].mean(axis=1)  # tangential, of both places
    return np.column_stack([first, outcome.states[:, 4]])


def rows() -> Iterator[Row]:
    """Displacements while the first mass slides, and when it stops."""
    times = TIME * np.arange(1, SAMPLES + 1) / SAMPLES
    moved = without_friction(times) + by_friction()
    for name, theirs, x in zip(("first", "second"), (1.35332, 1.80751), moved.T, strict=True):
        at = float(np.interp(0.15 - SLIP, times, x))
        yield Row(f"displacement of the {name} mass at 0.15 s, m", theirs, at, 2e-5)
    speed = np.gradient(moved[:, 0], times)
    ends = np.flatnonzero(speed < 0)[0]
    part = speed[ends - 1] / (speed[ends - 1] - speed[ends])
    end = SLIP + times[ends - 1] + part * (times[ends] - times[ends - 1])
    yield Row("end of sliding, s", 0.31492, float(end), 2e-5)


CASE = Case(
    title="A mass that slides with friction (code_aster)",
    source="closed form in code_aster's validation manual, V5.01.106 (SDND106)",
    compared="5 kg each, 1e4 N/m, 3000 N on the second mass to 0.2 s, the first pressed by 1e4 N "
    "on a plane, friction 0.2 while it slides. The simulator has the friction alone, from the "
    "start of sliding on; the motion without it is added.",
    reason="the source rounds to five decimals and starts the sliding 1e-6 s late: 1.3e-5.",
    rows=rows,
)
