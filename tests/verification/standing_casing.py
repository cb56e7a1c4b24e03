"""A rub on a casing that moves, in an independent march: the casing in its own frame.

Central differences on the modes of blade and casing with the force at the middle of the three
steps, explicit and of order two, and rods found anew at every step. Nothing turns here: the casing
is a cos(n phi) + b sin(n phi) in its own frame, and the blade passes at phi = theta + Omega t. A
rod wears while its centre is covered; so short a step passes a small part of a rod.
"""

from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

import numba
import numpy as np
from cases import Case, Row
from numpy.typing import NDArray
from pairs import band, growth, of_equations, of_kernel

from geometry.base import ROOT
from geometry.blade import Blade as BladeFile
from geometry.mesh import build_mesh
from rom.model import Rom
from rom.reduce import reduce
from simulate import Scene, march
from simulate.scene import LEADING, TRAILING
from workflow.jobs.full_model import assembled

STEPS, SAMPLES = 32768, 2048  # of a revolution
SPEEDS, CASINGS = (0.34, 0.36, 0.378), (400.0, 800.0, 2000.0)  # over f1(0); Hz, of order 2
MASS, ZETA = 9.0, 0.005
WITHIN = 0.5  # um
STIFFNESS, MIDDLE = 0.2, 1.5489255  # N/m, of the contact; speed of the largest growth, rad/s


class Blade(NamedTuple):
    """Modes, and what the tip rubs on."""

    omega: NDArray[np.float64]  # (n,), rad/s
    zeta: float
    rows: NDArray[np.float64]  # (m, n), u_r over the strips
    out: NDArray[np.float64]  # (n,), u_r at xi = 1/16
    theta: NDArray[np.float64]  # (m,), rad
    gap: NDArray[np.float64]  # (m,), m
    length: NDArray[np.float64]  # (m,), footprint, rods
    area: NDArray[np.float64]  # (m,), m2, of a rod
    law: tuple[float, float, float, float]  # E, K, sigma_Y, Pa; thickness, m
    d: NDArray[np.float64]  # (nu,), m
    ramp: float  # revolutions


@numba.njit(cache=False)
def marched(blade, mode, Omega, steps, rounds):
    """u_r (steps * rounds,), m, at xi = 1/16, casing a and b there, and plastic strains (m, nu).

    ``mode``: order, rad/s, modal mass, damping ratio of the casing.
    """
    h = 2 * np.pi / Omega / steps
    order, omega_c, mass, zeta_c = mode
    n, m, nu = blade.omega.size, blade.theta.size, blade.d.size
    E, K, sigma_Y, thickness = blade.law
    s = 1 / h**2 + blade.zeta * blade.omega / h
    a1, a2 = (2 / h**2 - blade.omega**2) / s, (1 / h**2 - blade.zeta * blade.omega / h) / s
    s_c = 1 / h**2 + zeta_c * omega_c / h
    c1, c2 = (2 / h**2 - omega_c**2) / s_c, (1 / h**2 - zeta_c * omega_c / h) / s_c
    q, q_old, modal = np.zeros(n), np.zeros(n), np.zeros(n)
    of_casing, of_casing_old = np.zeros(2), np.zeros(2)
    eps_p, u_r, casing = np.zeros((m, nu)), np.zeros(steps * rounds), np.zeros((steps * rounds, 2))
    for step in range(steps * rounds):
        turn = step / steps  # revolutions
        x = min(turn / blade.ramp, 1.0) if blade.ramp > 0 else 1.0
        share = x * x * (3 - 2 * x)
        modal[:] = 0.0
        on_a = on_b = 0.0
        for i in range(m):
            phi = blade.theta[i] + 2 * np.pi * turn
            c, sn = np.cos(order * phi), np.sin(order * phi)
            w = blade.rows[i] @ q - of_casing[0] * c - of_casing[1] * sn
            centre, half = phi * nu / (2 * np.pi), blade.length[i] / 2
            if w - blade.gap[i] + share * blade.d.max() <= 0:
                continue
            force = 0.0
            for j in range(int(np.floor(centre - half - 1)), int(np.ceil(centre + half + 1)) + 1):
                away = abs(j - centre)
                part = min(max(half + 0.5 - away, 0.0), 1.0)
                eps = (share * blade.d[j % nu] - blade.gap[i] + w) / thickness
                trial = E * (eps - eps_p[i, j % nu])
                if part == 0.0 or eps <= 0 or trial <= 0:
                    continue
                over = trial - sigma_Y - K * eps_p[i, j % nu]
                gamma = max(over, 0.0) / (E + K)
                force += part * (trial - E * gamma)
                if away <= half + nu / steps / 2:  # on average to the end of what is covered
                    eps_p[i, j % nu] += gamma
            force *= blade.area[i]
            modal += force * blade.rows[i]
            on_a += force * c
            on_b += force * sn
        q_old, q = q, a1 * q - a2 * q_old - modal / s
        pushed = np.array([on_a, on_b]) / mass / s_c
        of_casing_old, of_casing = of_casing, c1 * of_casing - c2 * of_casing_old + pushed
        u_r[step] = blade.out @ q
        casing[step] = of_casing
    return u_r, casing, eps_p


def blade_of(scene: Scene, rom: Rom, Omega: float) -> Blade:
    """What a plain ``scene`` is made of: radial contact, gaps at speed, harmonics that stand."""
    liner, law = scene.liner, scene.liner.law
    omega, Phi = rom.modes(Omega)
    xi = (np.arange(liner.m) + 0.5) / liner.m
    theta = rom.line(xi)[:, 1]
    width = np.diff(rom.line(np.linspace(0, 1, liner.m + 1))[:, 2])
    nu = liner.rods_per_round
    length = np.full(liner.m, liner.footprint_m * nu / (2 * np.pi * rom.camber[:, 0].mean()))
    at = scene.clearance.gaps([LEADING, TRAILING], rom.span)
    angle = 2 * np.pi * np.arange(nu) / nu
    return Blade(
        omega=omega,
        zeta=scene.damping_ratio,
        rows=np.ascontiguousarray(rom.rows(xi, "r") @ Phi),
        out=(rom.rows(np.array([LEADING]), "r") @ Phi)[0],
        theta=theta,
        gap=at[0] + (at[1] - at[0]) * (xi - LEADING) / (TRAILING - LEADING),
        length=length,
        area=width * liner.footprint_m / length,
        law=(*(law.unit_Pa * np.array([law.E, law.K, law.sigma_Y])), liner.thickness_m),
        d=scene.casing.inward(angle, at[0]),
        ramp=float(scene.casing.ramp_rounds),
    )


def rows() -> Iterator[Row]:
    """Bands of instability of a blade that bears on a pair, by the kernel's steps of 0.01 s."""
    for name, inside, outside in (
        ("divergence", 1.001, (0.99, 1.01)),
        ("flutter", MIDDLE, (1.45, 1.6)),
    ):
        exact, ours = band(of_equations, inside, outside), band(of_kernel, inside, outside)
        for end, theirs, own in zip(("begins", "ends"), exact, ours, strict=True):
            yield Row(f"{name} {end}, rad/s", theirs, own, 1e-5)
    for Omega in (1.2, MIDDLE):
        found = (np.sort(of(Omega).imag)[3:] for of in (of_equations, of_kernel))
        for i, (theirs, own) in enumerate(zip(*found, strict=True), 1):
            yield Row(f"frequency {i} at {Omega:g} rad/s", theirs, own, 1e-5)
    yield Row("largest growth, 1/s", growth(of_equations, MIDDLE), growth(of_kernel, MIDDLE), 1e-4)


def beside() -> Iterator[Row]:
    """Blade `paper` in a rub on casings that move, by both marches."""
    scene, rom = Scene.load(ROOT / "workflow/scenes/paper-e10.yaml"), model()
    for over_f1 in SPEEDS:
        for Hz in CASINGS:
            values = {"order": 2, "frequency_Hz": Hz, "modal_mass_kg": MASS, "damping_ratio": ZETA}
            case = scene.but(
                peaks=None,
                verify={"share": 0.0, "predictable": False},
                integrator={"steps_per_round": STEPS},
                record={"samples_per_round": SAMPLES, "history": {"chord": [LEADING]}},
                casing__modes=[values],
            )
            Omega = over_f1 * rom.omega1
            outcome = march(case, rom, Omega)
            pair = 2, 2 * np.pi * Hz, MASS, ZETA
            u_r, casing, _ = marched(blade_of(case, rom, Omega), pair, Omega, STEPS, case.rounds)
            every = STEPS // SAMPLES
            off = abs(u_r[every - 1 :: every] - outcome.u_r[:, 1]).max()
            at = f"{over_f1:g} f1(0), {Hz:g} Hz"
            yield Row(f"{at}: largest u_r, um", *_um(abs(u_r).max(), outcome.each.largest[0]))
            yield Row(f"{at}: difference of u_r at any time, um", *_um(0.0, off))
            moved = np.hypot(*casing.T).max(), outcome.casing.largest
            yield Row(f"{at}: largest motion of the casing, um", *_um(*moved))


def _um(theirs: float, ours: float) -> tuple[float, float, float, float]:
    """Both in um, and what they may differ by: of twenty revolutions near chaos."""
    return 1e6 * theirs, 1e6 * ours, WITHIN, 1.0


def model() -> Rom:
    """Reduced model of blade `paper`."""
    blade = BladeFile.load(ROOT / "workflow/blades/paper.yaml")
    with TemporaryDirectory() as folder:
        mesh = Path(folder) / "blade.msh"
        build_mesh(blade, mesh)
        return reduce(assembled(blade, "paper", mesh), blade.basis, "r")[0]


CASE = Case(
    title="A blade that bears on a pair of a casing",
    source="eigenvalues of the equations in the blade's frame: blade 1 kg, 1 rad/s; pair of two "
    "diameters 10 kg, 2 rad/s; contact 0.2 N/m, without damping",
    compared="Eigenvalues of a step of 0.01 s of the kernel, in which contact stays closed.",
    reason="the step is of order two: frequencies are off by 2e-6, the growth by 4.5e-5.",
    rows=rows,
)
BESIDE = Case(
    title="Rubs on casings that move",
    source="a march of its own, which has the casing in the standing frame and the force explicit, "
    "in central differences; 32,768 steps a revolution",
    compared="Scene `paper-e10` with a casing of two diameters, 9 kg, damping 0.5 %, over twenty "
    "revolutions; `piecewise-exact`, as many steps.",
    reason="both are of order two in the step; a rub doubles small differences every few "
    "revolutions, and 0.5 um are less than 1 % of the motion.",
    rows=beside,
    nightly=True,
)
