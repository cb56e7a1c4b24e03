"""A casing that moves: bands of instability, turning forces, mirrors, a heavy casing, energies."""

from dataclasses import fields
from functools import partial
from types import SimpleNamespace

import numpy as np
import pytest
from pairs import (
    M_R,
    PRELOAD,
    W_R,
    N,
    band,
    growth,
    largest_growth,
    mode,
    of_equations,
    of_kernel,
    places,
    pressed,
    step_map,
)
from refused import refused
from runs import marched, rad_s, set_up
from scenes import EXACT, RUBBING, SCHEMES, blade_balance, of_steps, scene
from scipy.linalg import eigh

from geometry.base import RPM, SettingsError
from rom.polynomial import evaluate
from simulate.contact.places import mean_footprint
from simulate.errors.accuracy import choose, march_to_accuracy
from simulate.errors.model_errors import ModelError
from simulate.loads import worn_volume
from simulate.marching import (
    WITH_RESULT,
    FinalState,
    SceneError,
    check_scene,
    march,
    strip_stiffness,
)
from simulate.marching.moving_casing import CasingMotion, moving_casing
from simulate.scene.casing_modes import Ring
from simulate.sweeps.peak import reported
from simulate.sweeps.sweep import sweep
from simulate.sweeps.whirls import whirls

FIRST = SimpleNamespace(f1=260.0)  # for scenes that are not marched
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
        rate, Omega = largest_growth(kernel, flutter)
        assert rate == pytest.approx(largest[0], rel=1e-4)
        assert pytest.approx(largest[1], abs=1e-5) == Omega


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
CONE = {"casing__slope": -0.2}
TRAVELS = {"casing__harmonics": [
    {"order": 2, "amplitude_gaps": 1.6}, {"order": 3, "amplitude_gaps": 0.5, "speed_rpm": 300},
]}  # fmt: skip
WITH = {"flat": {}, "friction": SLIDES, "rounded": ROUNDED, "travelling": TRAVELS, "cone": CONE}


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
        assert -2e-3 * whole < ledger.numerical <= 1e-12 * whole  # none is created


def test_work_on_a_casing_without_damping_stays_in_it(coarse_rom):
    modes = [given(2, 0.9, coarse_rom, zeta=0.0), given(0, 3.0, coarse_rom, zeta=0.0)]
    ledger = marched(rubbing(rounds=6, casing__modes=modes), coarse_rom).ledger
    assert ledger.on_casing > 1e-6 * ledger.casing
    assert abs(ledger.casing_damping) < 1e-12 * ledger.casing


def test_wear_over_a_moving_casing_is_of_order_two_in_the_step(coarse_rom):
    """As the tip passes along the casing within a step, so does its reach."""
    modes = [given(2, 300 / coarse_rom.f1, coarse_rom, 5.0)]
    of = RUBBING | {"integrator": EXACT, "rounds": 6, "liner__rods_per_round": 8209}
    case = scene(**of, casing__modes=modes)
    volumes = []
    for steps in (768, 1536, 3072, 16384):
        setup = set_up(case.but(integrator=of_steps(steps)), coarse_rom)
        wear, places = march(case, setup).wear, setup.places
        volumes.append(worn_volume(wear, places.width, places.radius))
    first, second, third = abs(np.array(volumes[:3]) / volumes[3] - 1)
    assert 3 < first / second < 5.5 and 2.5 < second / third < 5.5 and third < 5e-4


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


def lasting(rom, mass, unit_MPa=200, **changes):
    """A rub all around, kept closed by order 0, on a casing of five diameters."""
    values = {
        "rounds": 60,
        "damping_ratio": 0.001,
        "casing__harmonics": [{"order": 0, "amplitude_gaps": 1.5}],
        "casing__modes": [given(5, 0.45, rom, mass, 0.002)],
        "record": {"samples_per_round": 64, "spectrum_rounds": 20},
        "liner__law": {"kind": "elastic", "E": 1.0, "unit_MPa": unit_MPa},
    }
    return rubbing(**values | changes)


def test_rotation_feeds_blade_and_casing_on_no_engine_order(coarse_rom):
    """From n Omega = w_b + w_n of the free blade to that in contact: a row, f / Omega."""
    case = lasting(coarse_rom, 10.0)
    (of_casing,) = whirls(coarse_rom, case.liner, case.casing, 1)
    (met,) = of_casing["met"]
    first, last = (met[end] / (60 * coarse_rom.f1) for end in ("rpm", "rpm_to"))
    speeds = [
        0.95 * first,
        0.98 * first,
        *np.linspace(first, last, 4)[1:],
        1.04 * last,
        1.07 * last,
    ]
    runs = sweep(case.but(speeds={"over_f1": [float(speed) for speed in speeds]}), coarse_rom)
    amplitude = spectra(runs)[:, 1:].max(axis=1)
    assert amplitude[:2].max() < 0.1 * amplitude[2:5].min()
    (peak,) = reported(runs, coarse_rom)
    assert first < peak.Omega_c <= 1.04 * last and tuple(peak.modes) == (1,)
    assert abs(peak.k - round(peak.k)) > 0.1
    f_b = coarse_rom.modes(peak.Omega_c * coarse_rom.omega1)[0][0] / coarse_rom.omega1
    assert f_b < peak.k * peak.Omega_c < 1.1 * f_b
    backward = abs(5 - peak.k)  # the casing's wave, in its own frame
    of_mode = runs["casing_spectrum"].isel(casing_mode=0).sel(speed_over_f1=peak.Omega_c)
    assert of_mode.engine_order.values[of_mode.values[1:].argmax() + 1] == pytest.approx(
        backward, abs=0.1
    )


def test_a_run_is_steady_when_its_casing_is(coarse_rom):
    """Flutter that grows slower than the blade's motion dies out does not end a run as steady."""
    slow = {"damping_ratio": 0.01, "until": "steady", "rounds": 600, "record__spectrum_rounds": 4}
    case = lasting(coarse_rom, 100.0, **slow)
    early, late = marched(case, coarse_rom, 0.369), marched(case.but(until=None), coarse_rom, 0.369)
    assert late.each.last > 5e-6  # 1.4 um after 42 revolutions
    assert early.trend != "steady" or early.each.last == pytest.approx(late.each.last, rel=0.1)
    assert early.time_constant == pytest.approx(0.369 * 1 / (2 * np.pi * 0.002 * 0.45), rel=1e-6)


def spectra(runs):
    """Spectra (speeds, bins) of u_r, m."""
    return runs["spectrum"].transpose("speed_over_f1", ...).values


def test_ranges_fed_by_rotation_are_those_of_the_whole_model(coarse_rom):
    """n f = f_b + f_n, with frequencies of M, K and the strips, at both ends."""
    case = lasting(coarse_rom, 10.0)
    (of_casing,) = whirls(coarse_rom, case.liner, case.casing, 4)
    met = of_casing["met"][0]
    setup = set_up(case, coarse_rom, 0.3)
    k, P = strip_stiffness(case.liner, setup.places), coarse_rom.rows(setup.places.xi, "r")
    for rpm, stiffer in ((met["rpm"], 0.0), (met["rpm_to"], P.T @ (k[:, None] * P))):
        K = evaluate(coarse_rom.K, rpm / RPM) + stiffer
        f = np.sqrt(eigh(K, coarse_rom.M, eigvals_only=True)[0]) / (2 * np.pi)
        assert 5 * rpm / 60 == pytest.approx(f + 0.45 * coarse_rom.f1, rel=1e-6)
    assert whirls(coarse_rom, case.liner, case.but(casing__modes=None).casing, 4) == []
    slow = case.but(casing__modes=[given(2, 1.0, coarse_rom)])
    assert whirls(coarse_rom, slow.liner, slow.casing, 4)[0]["met"] == []


@pytest.mark.parametrize(
    ("modes", "mass", "speed"), [("light", 0.05, 0.33), ("undamped", 2.0, 0.3)]
)
def test_what_rotation_feeds_diverges(modes, mass, speed, coarse_rom):
    """Physics, and no fault of the steps: they create nothing beside the casing's work."""
    damping = 0.0 if modes == "undamped" else 0.002
    zeta = {"casing__modes": [given(5, 0.45, coarse_rom, mass, damping)]}
    thick = {"liner__thickness_mm": 100, "rounds": 1000, "record__spectrum_rounds": 1}
    case = lasting(coarse_rom, mass, 40000, **thick, **zeta)
    outcome = marched(case, coarse_rom, speed)
    assert outcome.status == "diverged", outcome.rounds
    assert outcome.casing.largest > 1e-6  # of a part of a revolution, too
    assert abs(outcome.ledger.numerical) < 1e-3 * outcome.ledger.casing


@pytest.mark.parametrize("forward", [True, False])
def test_the_spectrum_of_the_casing_is_of_its_own_frame(forward):
    """A wave of two diameters that turns at 0.7 Omega, and a shift; the same all around."""
    moving = moving_casing([mode(), mode(order=0)], places(0.0), False, False)
    motion = CasingMotion.room(moving, 10)
    for done in range(12):
        time = 2 * np.pi * (done + (np.arange(1, 65) / 64 - 0.5 / 640))  # of the step's middle
        turn = 2 * time * (0.7 if forward else -0.7) - 2 * time  # in the blade's frame
        x = np.stack([3e-6 * np.cos(turn), 3e-6 * np.sin(turn), 0 * time + 1e-6], axis=1)
        motion.add(x * np.sqrt(M_R))
    found = motion.spectrum()
    assert found.shape == (2, 321) and found[0].argmax() == 14  # 1.4 of ten revolutions
    assert found[0, 14] == pytest.approx(3e-6, rel=1e-9) and found[1, 0] == pytest.approx(1e-6)
    assert np.delete(found[0], 14).max() < 1e-12
    assert motion.largest == pytest.approx(4e-6, rel=2e-3)


def test_the_largest_motion_of_several_modes_is_that_around_the_casing():
    modes = [mode(order=n, modal_mass_kg=m) for n, m in ((0, 2.0), (1, 3.0), (4, 5.0))]
    motion = CasingMotion.room(moving_casing(modes, places(0.0), False, False), 1)
    x, phi = np.random.default_rng(4).normal(size=(64, 5)), np.linspace(0, 2 * np.pi, 20000)
    motion.add(x)
    shapes = [np.cos(0 * phi), np.cos(phi), np.sin(phi), np.cos(4 * phi), np.sin(4 * phi)]
    whole = x / np.sqrt([2, 3, 3, 5, 5]) @ shapes
    assert motion.largest == pytest.approx(abs(whole).max(), rel=2e-3)
    motion.add(x / 2)
    assert motion.largest == pytest.approx(abs(whole).max(), rel=2e-3)


def test_rows_are_those_of_the_mode_at_the_edges_of_the_tip_on_a_cone():
    theta, slope, n = np.array([0.1, 0.7]), -0.3, 3
    of = mode(order=n, modal_mass_kg=None, radial=0.4, tangential=-0.1, axial=0.05)
    moving = moving_casing([of], places(*theta, slope=slope, footprint=0.02), True, True)
    closing, along, lean = moving.rows
    ahead, behind = (
        -(0.4 - slope * 0.05) * np.stack([np.cos(n * at), np.sin(n * at)], axis=1)
        for at in (theta + 0.01, theta - 0.01)
    )
    np.testing.assert_allclose(closing, (ahead + behind) / 2, rtol=1e-14)
    np.testing.assert_allclose(lean, ahead - behind, rtol=1e-12)
    sides = 0.1 * np.stack([np.sin(n * theta), -np.cos(n * theta)], axis=1)
    np.testing.assert_allclose(along, sides, rtol=1e-14)
    by_mass = mode(order=n, modal_mass_kg=1 / 0.4**2)
    assert by_mass.phi == pytest.approx((0.4, -0.4 / n, 0.0))


def test_a_ring_is_that_of_the_table():
    ring = Ring(
        young_modulus_GPa=70, density_kg_m3=2700, radius_mm=250, thickness_mm=4, width_mm=50,
        orders=[0, 2, 3, 4, 5, 6], damping_ratio=0.001,
    )  # fmt: skip
    Hz = [3241.509, 40.1738, 113.6287, 217.8730, 352.3475, 516.8863]
    kg = [0.8482300, 0.5301438, 0.4712389, 0.4506222, 0.4410796, 0.4358960]
    assert [mode.frequency_Hz for mode in ring.modes] == pytest.approx(Hz, rel=1e-6)
    assert [mode.modal_mass_kg for mode in ring.modes] == pytest.approx(kg, rel=1e-6)
    wide = ring.but(poisson_ratio=0.3).modes
    assert wide[1].frequency_Hz == pytest.approx(40.1738 / np.sqrt(0.91), rel=2e-6)
    assert wide[0].frequency_Hz == ring.modes[0].frequency_Hz


REFUSED = {
    "central": ({"integrator": SCHEMES["central-difference"]}, "casing.modes: .*central diff"),
    "rigid law": ({"liner__law": {"kind": "rigid"}}, "casing.modes: .*law.kind: rigid"),
    "backing": ({"liner__worn_through": "casing"}, "casing.modes: .*worn_through"),
    "both": (
        {"casing__ring": {
            "young_modulus_GPa": 70, "density_kg_m3": 2700, "radius_mm": 700, "thickness_mm": 20,
            "width_mm": 100, "orders": [2], "damping_ratio": 0.01,
        }}, "casing.ring: .*take one of them out",
    ),
    "one of": ({"casing__modes": [given(rom=FIRST, radial=1.0, modal_mass_kg=1.0)]}, "exactly one"),
    "tangential": ({"casing__modes": [given(rom=FIRST, tangential=1.0)]}, "tangential: goes with"),
    "order 0": (
        {"casing__modes": [given(0, rom=FIRST, radial=1.0, tangential=0.1)]},
        "tangential: 0.1: order",
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", REFUSED)
def test_a_casing_is_refused_in_a_line(name):
    changes, match = REFUSED[name]
    refused(SettingsError, rubbing, **{"casing__modes": [given(rom=FIRST)]} | changes, match=match)


def test_a_free_ring_has_no_order_one():
    of = {
        "young_modulus_GPa": 70, "density_kg_m3": 2700, "radius_mm": 700, "thickness_mm": 20,
        "width_mm": 100, "damping_ratio": 0.01,
    }  # fmt: skip
    for changes, match in (
        ({"orders": [0, 1]}, "orders: 1: allowed 0 and 2"),
        ({"orders": [2, 2]}, "names an order twice"),
        ({"orders": [2], "thickness_mm": 300}, "casing.ring.thickness_mm: 300: no thin ring"),
        (
            {"orders": [2], "thickness_mm": 1e-3},
            "casing.ring: .*refused: order 2: frequency_Hz: 0.0",
        ),
    ):
        refused(SettingsError, rubbing, casing__ring=of | changes, match=match)


def refused_lines(case, rom, match):
    with pytest.raises(SceneError, match=match):
        check_scene(case, rom)


def test_modes_that_do_not_fit_the_model_are_refused(coarse_rom):
    def check(**mode):
        check_scene(rubbing(casing__modes=[given(rom=coarse_rom, **mode)]), coarse_rom)

    check(order=2, over_f1=0.2)
    half = mean_footprint(rubbing().liner, coarse_rom) / coarse_rom.camber[:, 0].mean() / 2
    check(order=int(0.1 / half))
    many = f"modes.0.order: {int(0.1 / half) + 1}: .*up to {int(0.1 / half)}"
    refused(SceneError, check, order=int(0.1 / half) + 1, match=many)
    refused(SceneError, check, over_f1=0.59, zeta=0.0, match="modes.0.damping_ratio: 0: without")
    check(over_f1=0.61, zeta=0.0)  # the fastest run is at 0.3
    ring = {
        "young_modulus_GPa": 70, "density_kg_m3": 2700, "radius_mm": 600, "thickness_mm": 20,
        "width_mm": 100, "orders": [0, 2, 50], "damping_ratio": 0.0,
    }  # fmt: skip
    for match in (
        "casing.ring.orders: 50: half of the arc",
        "casing.ring.damping_ratio: 0: without",
    ):
        refused_lines(rubbing(casing__ring=ring), coarse_rom, match)


def test_modes_come_from_a_csv_file(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    table = tmp_path / "modes.csv"
    table.write_text(
        "order,frequency_Hz,radial,axial,damping_ratio\n0,900,0.3,0,0.01\n2,400,.2,.1,0\n"
    )
    first, second = rubbing(casing__modes="modes.csv").casing.modes
    assert (first.order, second.frequency_Hz, second.phi) == (0, 400.0, (0.2, -0.1, 0.1))
    table.write_text("order,frequency_Hz,modal_mass_kg,radial,damping_ratio\n2,9,,1,0\n3,9,4,,0\n")
    first, second = rubbing(casing__modes="modes.csv").casing.modes
    assert (first.radial, first.modal_mass_kg, second.radial) == (1.0, None, None)
    for text, match in (
        (
            "order,frequency_Hz,modal_mass_kg,damping_ratio\n2.5,400,9,0",
            "modes.csv: .*order.*line 2",
        ),
        (
            "order,frequency,modal_mass_kg,damping_ratio\n2,400,9,0",
            "modes.csv: line 1: columns .*frequency.*should be some of order, frequency_Hz",
        ),
        (
            "order,frequency_Hz,modal_mass_kg,damping_ratio\n2,400,9",
            "modes.csv: .*found 3 cells .line 2",
        ),
        ("order,order\n2,3\n", "modes.csv: line 1: .*each once"),
        ("order,frequency_Hz", "casing.modes"),
        ("", "casing.modes"),
    ):
        table.write_text(text)
        refused(SettingsError, rubbing, casing__modes="modes.csv", match=match)


def test_a_sweep_tells_the_motion_of_the_casing_and_leaves_it_out_of_a_rigid_one(coarse_rom):
    case = rubbing(casing__modes=[given(rom=coarse_rom), given(0, 3.0, coarse_rom)], **SLIDES)
    moves, rigid = (sweep(of, coarse_rom) for of in (case, rubbing(**SLIDES)))
    told = {"casing_motion", "casing_spectrum", "casing_order", "casing_frequency"}
    assert told <= {*moves.variables} and not told & {*rigid.variables}
    assert moves["casing_spectrum"].dims == ("speed_over_f1", "casing_mode", "engine_order")
    assert moves["casing_order"].values.tolist() == [2, 0]
    assert moves["casing_motion"].item() >= moves["casing_spectrum"].max().item() > 1e-7
    assert not {"on_casing", "casing_damping"} & {*rigid["energy"].values}
    assert "mu_crit" in rigid and "mu_crit" not in moves  # that of a blade on a rigid casing
    energies = moves["ledger"].isel(speed_over_f1=0)
    formula = moves["energy"].attrs["long_name"].partition("numerical: ")[2].partition(" = ")[2]
    terms = {str(name): energies.sel(energy=name).item() for name in energies["energy"].values}
    said = eval(formula.partition(";")[0], {}, terms)
    assert terms["numerical"] == pytest.approx(said, rel=1e-9)


def test_second_runs_have_the_casing_too(coarse_rom):
    runs = sweep(
        rubbing(casing__modes=[given(rom=coarse_rom)], rounds=4, verify="every"), coarse_rom
    )
    assert runs["status"].item() in WITH_RESULT and runs["casing_motion"].item() > 1e-7
    assert 0 < runs["error"].max().item() < 0.1


def test_an_accuracy_is_met_over_a_moving_casing(coarse_rom):
    case = rubbing(
        casing__modes=[given(rom=coarse_rom)], accuracy=0.1, rounds=4, integrator=None,
        liner__rods_per_round=None, liner__strips=None,
    )  # fmt: skip
    choice = choose(case, coarse_rom, ModelError(0.0, None))
    run = march_to_accuracy(case, coarse_rom, rad_s(coarse_rom, 0.3), choice)
    assert run.outcome.status == "ok" and run.outcome.casing.largest > 1e-7
    assert 0 < max(run.errors.values()) < 0.1
