"""A casing that moves: bands of instability, turning forces, mirrors, a heavy casing, energies."""

from dataclasses import fields
from functools import partial
from types import SimpleNamespace

import numpy as np
import pytest
from runs import marched
from scenes import EXACT, blade_balance, scene
from scipy.optimize import brentq, minimize_scalar
from systems import Hooke, in_the_middle, strips

from simulate.contact.ramp import smooth
from simulate.marching import FinalState, piecewise_exact
from simulate.marching.friction import sliding
from simulate.marching.kernel import Recorded, at_start, march_round
from simulate.marching.modal import padded_rows, rows_of
from simulate.marching.moving_casing import moving_casing
from simulate.scene.casing_modes import CasingMode
from simulate.sweeps.sweep import sweep

PRELOAD = 8.0  # order-0 distortion that keeps the contact closed
W_B, M_R, W_R, N = 1.0, 10.0, 2.0, 2  # blade of mass 1, on a pair of the casing


def mode(zeta=0.0, **more):
    """The pair of the closed forms."""
    values = {"order": N, "frequency_Hz": W_R / (2 * np.pi), "modal_mass_kg": M_R}
    return CasingMode(**values | {"damping_ratio": zeta} | more)


def places(*theta, slope=0.0, footprint=0.0):
    """Strips at angles, rad, at the radius of 1 m."""
    theta = np.array(theta)
    one = np.ones(len(theta))
    return SimpleNamespace(
        xi=theta, theta=theta, radius=one, slope=slope * one, footprint=footprint * one
    )


def pressed(k_c, Omega, h, modes, theta=(0.0,), zeta=0.0, mu=None):
    """Scheme of a blade on elastic strips of a casing that moves, and the strips."""
    m = len(theta)
    moving = moving_casing(modes, places(*theta), mu is not None, False)
    blade = np.ones((m, 1)), np.zeros((m if mu is not None else 0, 1)), np.zeros((0, 1))
    (closing, along, _), omega, zetas = moving.beside(blade, np.array([W_B]), zeta)
    system = strips(Hooke(k_c), np.zeros(m), np.full(4, PRELOAD))
    system = in_the_middle(system, omega, closing, zetas, h)
    rows = rows_of(closing, along) if mu is not None else closing
    scheme = piecewise_exact.coefficients(omega, rows, zetas, h)
    if mu is not None:
        scheme = sliding(scheme, system.first_t, np.full(m, mu), np.full(m, k_c))
        # without arc, as the tip does not pass along the rods, nor is it shifted to others
        system = system._replace(tangential=True, pitch=np.full(m, 1e30))
    return moving.turned(scheme, 1, Omega * h), system


def step_map(scheme, system, n=3):
    """Matrix (2n, 2n) of a step of the kernel on x, y of the modes, contact closed."""

    def after(start):
        state = at_start(scheme, system)
        state.motion.x[0, :n], state.motion.y[0, :n] = start[:n], start[n:]
        state.motion.u[:] = state.motion.x @ scheme.Phi.T
        empty = padded_rows(np.zeros((1, n))), np.zeros((2, 0, 1))
        recorded = Recorded(np.zeros((1, 1)), np.zeros((3, 0)), np.zeros((0, 0)), *empty)
        contacts, *_ = march_round(scheme, system, state, recorded, smooth(0.0), np.inf, 0, 1)
        assert contacts == 1
        return np.concatenate([state.motion.x[1, :n], state.motion.y[1, :n]])

    rest = after(np.zeros(2 * n))
    return np.array([after(unit) - rest for unit in np.eye(2 * n)]).T, rest


def of_kernel(Omega, k_c=0.2, h=0.01, zeta=0.0, mu=None):
    """Eigenvalues s (1/s) of the motion, from those of a step, exp(s h)."""
    step, _ = step_map(*pressed(k_c, Omega, h, [mode(zeta)], zeta=zeta, mu=mu))
    values = np.linalg.eigvals(step)
    return np.log(values.astype(complex)) / h


def of_equations(Omega, k_c=0.2, zeta=0.0, mu=0.0):
    """The same in the blade's frame, exact: u of the blade, p and q of the casing."""
    k_r, c = M_R * W_R**2, 2 * zeta * W_R * M_R
    turns, mass = N * Omega, np.diag([1.0, M_R, M_R])
    K = np.array([
        [W_B**2 + k_c, -k_c, 0],
        [-k_c, k_r - turns**2 * M_R + k_c, -c * turns],
        [-mu * k_c / N, mu * k_c / N + c * turns, k_r - turns**2 * M_R],
    ])  # fmt: skip
    D = np.array([[2 * zeta * W_B, 0, 0], [0, c, -2 * turns * M_R], [0, 2 * turns * M_R, c]])
    inverse = np.linalg.inv(mass)
    return np.linalg.eigvals(
        np.block([[np.zeros((3, 3)), np.eye(3)], [-inverse @ K, -inverse @ D]])
    )


def growth(of, Omega):
    """Largest rate, 1/s."""
    return of(Omega).real.max()


def band(of, inside, outside, least=1e-7):
    """Speeds at which a band around ``inside`` begins and ends, within those ``outside``."""
    return [
        brentq(lambda Omega: growth(of, Omega) - least, inside, end, xtol=1e-10) for end in outside
    ]


BANDS = [
    # k_c, zeta, mu, divergence, flutter, largest growth and where
    (0.2, 0.0, None, (1.0, 1.0020812), (1.5338174, 1.5640335), (0.015107722, 1.5489255)),
    (0.05, 0.0, None, (1.0, 1.0005951), (1.5087518, 1.5165620), (0.003905085, 1.5126569)),
    (0.2, 0.001, None, None, (1.53297079, 1.56487857), (0.01361599, 1.54892472)),
    (0.2, 0.001, 0.15, None, (1.5339, 1.5685), None),
]


@pytest.mark.parametrize(("k_c", "zeta", "mu", "divergence", "flutter", "largest"), BANDS)
def test_a_rub_on_a_pair_is_unstable_in_the_bands_of_the_equations(
    k_c, zeta, mu, divergence, flutter, largest
):
    """Divergence from w_r / n on, flutter above w_b + w_r = n Omega, both in the kernel's steps."""
    kernel = partial(of_kernel, k_c=k_c, zeta=zeta, mu=mu)
    exact = partial(of_equations, k_c=k_c, zeta=zeta, mu=mu or 0.0)
    of_flutter = band(kernel, np.mean(flutter), (1.45, 1.6), 1e-7)
    np.testing.assert_allclose(of_flutter, band(exact, np.mean(flutter), (1.45, 1.6)), atol=1e-5)
    np.testing.assert_allclose(of_flutter, flutter, atol=1e-4 if mu else 1e-5)
    if divergence:
        middle = np.mean(divergence)
        found = band(kernel, middle, (0.99, 1.01))
        np.testing.assert_allclose(found, divergence, atol=1e-5)
    elif mu:
        assert max(growth(kernel, Omega) for Omega in np.linspace(0.99, 1.1, 111)) < 0
    if largest:
        top = minimize_scalar(
            lambda Omega: -growth(kernel, Omega), bounds=flutter, method="bounded",
            options={"xatol": 1e-8},
        )  # fmt: skip
        assert -top.fun == pytest.approx(largest[0], rel=1e-4)
        assert top.x == pytest.approx(largest[1], abs=1e-5)


@pytest.mark.parametrize(
    ("Omega", "expected"),
    [(0.5, (1.00000000, 1.09754558, 3.00256452)), (1.2, (0.39797678, 1.09515973, 4.40252651))],
)
def test_frequencies_in_contact_are_those_of_the_equations(Omega, expected):
    errors = []
    for h in (0.02, 0.01):
        found = np.sort(of_kernel(Omega, h=h).imag)[3:]
        errors.append(abs(found / expected - 1).max())
    assert errors[-1] < 1e-5
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2, abs=0.05)


def steady(theta, Omega, h, zeta, k_c=0.3):
    """Place p + i q, m, of the casing under tips that stand still in the blade's frame."""
    scheme, system = pressed(k_c, Omega, h, [mode(zeta)], theta)
    scheme.Phi[:, 0] = 0.0  # the tips do not move
    step, rest = step_map(scheme._replace(C=scheme.Phi * scheme.gain[0] @ scheme.Phi.T), system)
    x = np.linalg.solve(np.eye(6) - step, rest)[1:3] / np.sqrt(M_R)
    return (x[0] + 1j * x[1]) * np.exp(-0.5j * N * Omega * h)


def test_a_force_that_turns_with_the_blade_pushes_a_casing_as_in_closed_form():
    """Two tips, at 0 and 0.3 rad: amplitude and phase, below and above resonance, damped."""
    theta, zeta, k_c = np.array([0.0, 0.3]), 0.05, 0.3
    for Omega in (0.4, 0.95, 1.3):
        turns = N * Omega
        stiff = M_R * (W_R**2 - turns**2) * np.eye(2)
        stiff += 2 * zeta * W_R * M_R * turns * np.array([[0, -1], [1, 0]])
        shapes = np.array([np.cos(N * theta), np.sin(N * theta)])
        p, q = np.linalg.solve(stiff + k_c * shapes @ shapes.T, k_c * PRELOAD * shapes.sum(axis=1))
        errors = [abs(steady(theta, Omega, h, zeta, k_c) / (p + 1j * q) - 1) for h in (0.02, 0.01)]
        assert errors[-1] < 2e-4, Omega
        assert np.log2(errors[0] / errors[1]) == pytest.approx(2, abs=0.1)


@pytest.mark.parametrize("mu", [None, 0.15])
def test_a_mirrored_rotation_mirrors_the_motion(mu):
    """Omega -> -Omega, theta -> -theta, and the force of friction with it: p stays, q turns."""
    theta, Omega, h, sign = np.array([0.2, 0.5]), 0.9, 0.05, np.array([1, 1, -1] * 2)
    one, other = (
        step_map(*pressed(0.2, side * Omega, h, [mode(0.02)], side * theta, mu=mu and side * mu))
        for side in (1, -1)
    )
    for first, second in zip(one, other, strict=True):
        mirrored = sign * second if second.ndim == 1 else sign[:, None] * second * sign
        np.testing.assert_allclose(first, mirrored, rtol=0, atol=1e-12 * abs(first).max())
    assert abs(one[0][2]).max() > 1e-3


def given(order=2, over_f1=0.9, rom=None, mass=0.5, zeta=0.01, **more):
    """A mode of the casing, its frequency over f1(0)."""
    values = {"order": order, "frequency_Hz": float(over_f1 * rom.f1), "damping_ratio": zeta}
    return values | ({} if "radial" in more else {"modal_mass_kg": mass}) | more


SLIDES = {"contact__friction": 0.15}
ROUNDED = {"contact": {"profile": {"edge_drop_um": 20.0, "tilt": 0.004}, "tangential": True}}
TRAVELS = {"casing__harmonics": [
    {"order": 2, "amplitude_gaps": 1.6}, {"order": 3, "amplitude_gaps": 0.5, "speed_rpm": 300},
]}  # fmt: skip
WITH = {"flat": {}, "friction": SLIDES, "rounded": ROUNDED, "travelling": TRAVELS}


def rubbing(**changes):
    """A rub with a spectrum, in steps that are exact between forces."""
    return scene(**{"integrator": EXACT, "record__spectrum_rounds": 1} | changes)


@pytest.mark.parametrize("name", WITH)
def test_a_heavy_casing_is_a_rigid_one(name, coarse_rom):
    rigid = rubbing(rounds=20, **WITH[name])
    heavy = rigid.but(
        casing__modes=[given(rom=coarse_rom, mass=9e12), given(0, 2.0, coarse_rom, 9e12)]
    )
    one, other = (marched(case, coarse_rom) for case in (rigid, heavy))
    assert one.wear.max() > 1e-6 and one.status == other.status
    for values in ("u_r", "wear", "force_peak"):
        expected = getattr(one, values)
        found = getattr(other, values)
        np.testing.assert_allclose(found, expected, rtol=0, atol=1e-10 * abs(expected).max())


@pytest.mark.parametrize("name", WITH)
def test_energies_of_blade_and_casing_are_balanced(name, coarse_rom):
    modes = [given(2, 0.9, coarse_rom), given(0, 3.0, coarse_rom), given(1, 0.7, coarse_rom)]
    outcome = marched(rubbing(rounds=6, casing__modes=modes, **WITH[name]), coarse_rom)
    ledger = outcome.ledger
    whole = ledger.casing + ledger.heat
    assert outcome.status == "ok" and outcome.casing.largest > 1e-6
    assert ledger.casing_damping > 1e-3 * ledger.damping > 0
    assert abs(blade_balance(ledger)) < 1e-12 * whole
    assert ledger.casing_kinetic + ledger.casing_elastic > 0
    if name != "rounded":  # there the ledger's error goes with the step
        assert abs(ledger.numerical) < 2e-3 * whole


def test_a_run_over_a_moving_casing_goes_on_to_the_last_bit(coarse_rom, tmp_path):
    case = rubbing(
        casing__modes=[given(rom=coarse_rom)], record__end=True, record__spectrum_rounds=None
    )
    whole = sweep(case.but(rounds=6), coarse_rom)
    first = sweep(case, coarse_rom)
    then = sweep(case.but(rounds=4, start={"scene": "before"}), coarse_rom, start=first)
    for name in ("wear", *(f"end_{field.name}" for field in fields(FinalState))):
        np.testing.assert_array_equal(then[name].values, whole[name].values, err_msg=name)
    one, two = (
        dict(zip(run["energy"].values, run["ledger"].values[0], strict=True))
        for run in (first, then)
    )
    assert two["casing_before"] == one["casing_kinetic"] + one["casing_elastic"] > 0


def test_runs_in_turn_keep_the_motion_of_the_casing(coarse_rom):
    case = rubbing(
        speeds={"over_f1": [0.3, 0.31], "in_turn": True}, casing__modes=[given(rom=coarse_rom)]
    )
    runs = sweep(case, coarse_rom)["ledger"]
    before = runs.sel(energy="casing_before").values
    end = runs.sel(energy=["casing_kinetic", "casing_elastic"]).sum("energy").values
    assert before[0] == 0 < end[0] and before[1] == pytest.approx(end[0], rel=1e-12)
