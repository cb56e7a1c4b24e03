"""Shocks with closed forms, two of them cases of code_aster's validation manual."""

from collections.abc import Iterator
from itertools import chain

import numpy as np
from cases import Case, Row
from numpy.typing import NDArray
from rods import clamped_rod, scene_of
from systems import Run, elastic_rod, march_exact, strips

from simulate.contact.rod_law import rod_law
from simulate.marching import march, prepare
from simulate.scene.law import numbers_of
from simulate.scene.laws.rigid import Rigid

# V5.01.101: a mass on a spring meets an elastic stop
MASS, SPRING, STOP, SPEED = 100.0, 1e4, 1e6, 1.0  # kg, N/m, N/m, m/s
# V5.03.100: a bar meets a rigid wall
LENGTH, SECTION, YOUNG, DENSITY = 0.2, 4e-4, 2e11, 8000.0  # m, m2, Pa, kg/m3
GAP, THROWN = 2e-3, 100.0  # m, m/s
MODES, STEPS, UNTIL = 200, 5600, 1.4e-4  # of the bar; s
FREE = 1e-7  # rad/s: of the rigid motion, for which the exact scheme needs a frequency
# the same bar, clamped, of an elastic wave that the wall sends through it
ELEMENTS, PUSHED, ROUNDS = 200, 10.0, 8  # m/s; revolutions, in each the wave passes half the bar
ONE_WAVE = 1 / MODES  # of the shortest mode, over the length


def on_a_stop() -> Iterator[Row]:
    """Two shocks: largest forces, their times, impulse and duration of the second."""
    w, w_c = np.sqrt(SPRING / MASS), np.sqrt((SPRING + STOP) / MASS)  # free, in contact
    contact, free, h, steps = np.pi / w_c, np.pi / w, 1e-6, 200_000  # s; steps in half the time
    start = [0.0], [SPEED * np.sqrt(MASS)]
    run = march_exact(
        elastic_rod(STOP), [w], [[1 / np.sqrt(MASS)]], 0.0, h, steps, *start, rounds=2
    )
    largest, impulse = run.force[:, 0, 0], h * run.force[1, 1, 0]
    pressed = run.u[:, 0] > 0
    second = pressed[steps:]
    times = [h * (1 + run.u[:steps].argmax()), h * (1 + steps + run.u[steps:].argmax())]
    expected = [contact / 2, contact + free + contact / 2]
    for name, force, time, at in zip(("first", "second"), largest, times, expected, strict=True):
        yield Row(f"largest force of the {name} shock, N", STOP * SPEED / w_c, float(force), 1e-6)
        yield Row(f"time of that force, {name} shock, s", at, float(time), h / at)
    yield Row("impulse of the second shock, N s", 2 * STOP * SPEED / w_c**2, impulse, 1e-6)
    yield Row("duration of the second shock, s", contact, h * second.sum(), 2 * h / contact)


def thrown() -> Iterator[Row]:
    """A free bar: its ends during contact, end of contact, rebound, force."""
    run, h = thrown_bar(), UNTIL / STEPS

    def at(t: float) -> NDArray[np.float64]:
        """Displacement of the end at the wall and of the free end, m, toward the wall."""
        return run.u[round(t / h) - 1]

    ends = "end at the wall", "free end"
    for t in (4e-5, 8e-5):
        for name, theirs, u in zip(ends, (2.0, 4.0), 1e3 * at(t), strict=True):
            yield Row(f"displacement of the {name} at {t:g} s, mm", theirs, u, ONE_WAVE)
    end = h * (1 + np.flatnonzero(run.u[:, 0] >= GAP * (1 - 1e-9)).max())
    yield Row("end of contact, s", 1e-4, end, ONE_WAVE)
    for name, speed in zip(ends, (at(1.2e-4) - at(1.3e-4)) / 1e-5, strict=True):
        yield Row(f"speed of the {name} after the shock, m/s", THROWN, speed, ONE_WAVE)
    force = h * run.force[0, 1, 0] / (end - GAP / THROWN)
    yield Row("mean force of the contact, N", 1.6e6, force, ONE_WAVE)


def thrown_bar() -> Run:
    """Free-free modes of the bar, thrown at the wall; its free end has a strip far away."""
    c, mass, orders = np.sqrt(YOUNG / DENSITY), DENSITY * SECTION * LENGTH, np.arange(MODES)
    omega = np.where(orders > 0, np.pi * c / LENGTH * orders, FREE)
    near = np.where(orders > 0, np.sqrt(2), 1) / np.sqrt(mass)
    start = np.where(orders > 0, 0, THROWN * np.sqrt(mass))
    wall = strips(rod_law(Rigid, numbers_of()()), [GAP, 1.0], np.zeros(4), rigid_from=0.0)
    ends = np.array([near, near * (-1.0) ** orders])
    return march_exact(wall, omega, ends, 0.0, UNTIL / STEPS, STEPS, 0 * start, start)


def clamped() -> Iterator[Row]:
    """A clamped bar at whose end a wall moves: mean forces before and after the wave comes back."""
    c, mass = np.sqrt(YOUNG / DENSITY), DENSITY * SECTION * LENGTH
    Omega = 2 * np.pi * 2 * c / LENGTH  # a revolution is L / 2c
    rom = clamped_rod(YOUNG * SECTION / LENGTH, mass, LENGTH, ELEMENTS, Omega)
    way = PUSHED * ROUNDS * LENGTH / (2 * c)
    scene = scene_of(
        {"kind": "rigid"},
        0.0,
        speeds={"over_f1": [Omega / rom.omega1]},
        rounds=ROUNDS,
        damping_ratio=0.0,
        integrator={"scheme": "piecewise-exact", "steps_per_round": 1024},
        casing={
            "harmonics": [{"order": 0, "amplitude_m": way}],
            "ramp": {"rounds": [0, ROUNDS], "factor": [0, 1]},
        },
        record={"samples_per_round": 1024, "spectrum_rounds": 1, "contact_force": True},
    )
    forces = march(scene, prepare(scene, rom, Omega)).force_mean.sum(axis=1)
    unit = DENSITY * c * SECTION * PUSHED
    # the front is spread by the elements: revolutions beside its arrival, at 2 L/c, are left out
    for first, theirs in ((0, 1.0), (ROUNDS // 2 + 1, 3.0)):
        force = forces[first : first + 2].mean() / unit
        at = f"{first / 2:g} to {first / 2 + 1:g} L/c"
        yield Row(f"mean force from {at}, over rho c A v", theirs, force, ONE_WAVE)


ON_A_STOP = Case(
    title="A mass meets an elastic stop (code_aster)",
    source="closed form of code_aster's validation manual, V5.01.101 (SDND101), which prints "
    "9950.0 N, 0.01563 s, 0.361 s, 198.05 N s and 0.03126 s",
    compared="100 kg on 1e4 N/m at 1 m/s into a stop of 1e6 N/m, two shocks; `piecewise-exact`, "
    "1 us.",
    reason="forces are of order two in the step; times are known to a step.",
    rows=on_a_stop,
)
THROWN_BAR = Case(
    title="A bar meets a rigid wall (code_aster)",
    source="closed form in code_aster's validation manual, V5.03.100 (SDNV100), and a clamped bar "
    "of the same kind: force rho c A v until the wave is back, then 3 rho c A v",
    compared="A free bar of 0.2 m, c = 5000 m/s (Poisson's ratio 0, as the manual computes), is "
    "thrown at 100 m/s at a wall 2 mm away: 200 modes, law `rigid`. The same bar, clamped, 200 "
    "elements, is pushed by a wall at v = 10 m/s.",
    reason="the shortest mode has 1/200 of the length: fronts are as wide.",
    rows=lambda: chain(thrown(), clamped()),
)
