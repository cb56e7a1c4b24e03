"""Engine orders beside the rub: closed forms, an integrator of its own, energies, restarts."""

import numpy as np
import pytest
from refused import refused
from rods import elastic, of_modes, scene_of
from runs import marched, rad_s, set_up
from scenes import EXACT, RUBBING, SCHEMES, blade_balance, of_steps, scene
from scipy.integrate import solve_ivp

from geometry.base import SettingsError
from rom.crossings import crossing
from simulate.marching import SceneError, check_scene, march, prepare
from simulate.scene import Scene

OMEGA, SAMPLES = 490.0, 256  # rad/s
W, TIP, RATIOS = np.array([1000.0, 5300.0]), np.array([1.0, -0.7]), np.array([0.05, 0.03])
P = {2: np.array([3.0, -40.0]) * np.exp(0.4j), 5: np.array([1.0, 200.0])}  # by engine order
STOP, GAP = 2e5, 5e-6  # N/m, m
RUB = RUBBING | {"integrator": EXACT, "record__spectrum_rounds": 1}
ON_BLADE = {"orders": [{"order": 3, "modal_force": [0.5, 3.0], "phase_deg": 30.0}]}


def pair(modes=2):
    """Model of a tip of two modes, the second of which may stand; between them is the tilt."""
    return of_modes(W, TIP * [1, modes == 2], length=1.0, highest=2e3)


def force(start="rest"):
    """Those of ``P``, as a scene has them."""
    orders = [
        {
            "order": order,
            "modal_force": [float(of[0].real / np.cos(np.angle(of[0]))), 0.0, 0.0],
            "phase_deg": float(np.degrees(np.angle(of[0]))),
        }
        for order, of in P.items()
    ]
    for one, of in zip(orders, P.values(), strict=True):
        one["modal_force"][2] = float((of[1] * np.exp(-1j * np.angle(of[0]))).real)
    return {"orders": orders, "from": start}


def forced(gap, start="rest", **more):
    """Scene of a tip before an elastic stop, under the force."""
    values = {
        "speeds": {"over_f1": [OMEGA / W[0]]},
        "rounds": 60,
        "damping_ratio": {"families": [RATIOS[0], 0.02, RATIOS[1]], "rest": 0.0},
        "casing": {"ramp_rounds": 0.0, "harmonics": []},
        "integrator": of_steps(1024),
        "record": {"samples_per_round": SAMPLES, "history": {"chord": [0.5]}, "end": True},
        "force": force(start),
    }
    return scene_of(elastic(STOP), gap, **values | more)


def answers(modes, Omega=OMEGA):
    """Closed form: complex amplitudes of the tip, m, of e^{i E theta} by engine order."""
    at = {order: order * Omega for order in P}
    return {
        order: np.abs(TIP[:modes])
        @ (of / (W**2 - at[order] ** 2 + 2j * RATIOS * W * at[order]))[:modes]
        for order, of in P.items()
    }


@pytest.mark.parametrize("modes", [1, 2])
def test_steady_response_is_the_closed_form(modes):
    """Amplitude and phase, of modes with ratios of their own, from rest."""
    outcome = march(case := forced(1e-2), prepare(case, pair(modes), OMEGA))
    lines = 2 / SAMPLES * np.fft.rfft(np.roll(outcome.u_r[-SAMPLES:, 1], 1))
    for order, expected in answers(modes).items():
        assert abs(lines[order] / expected - 1) < 1e-6
    assert outcome.status == "no-contact"
    assert outcome.reason.startswith("force: the blade vibrates under its forces alone")


@pytest.mark.parametrize("start", ["rest", "steady"])
def test_course_on_a_stop_is_that_of_an_integrator(start):
    """Which knows the force alone, in other terms: a spring behind a gap."""
    outcome = march(case := forced(GAP, start, rounds=6), prepare(case, pair(), OMEGA))

    def rates(time, state):
        q, v = np.split(state, 2)
        by_force = sum(of * np.exp(1j * order * OMEGA * time) for order, of in P.items()).real
        push = STOP * max(np.abs(TIP) @ q - GAP, 0.0)
        return [*v, *(by_force - np.abs(TIP) * push - 2 * RATIOS * W * v - W**2 * q)]

    at, rest = 1j * np.array([*P])[:, None] * OMEGA, np.zeros(4)
    steady = np.array([*P.values()]) / (W**2 + at**2 + 2 * RATIOS * W * at)
    before = rest if start == "rest" else np.concatenate([steady.sum(0), (at * steady).sum(0)]).real
    times = np.arange(1, 6 * SAMPLES + 1) / SAMPLES * 2 * np.pi / OMEGA
    found = solve_ivp(
        rates, (0, times[-1]), before, "DOP853", times, rtol=1e-10, atol=1e-16, max_step=1e-5
    )
    expected = np.abs(TIP) @ found.y[:2]
    assert outcome.contact_share > 0.1
    assert abs(outcome.u_r[:, 1] - expected).max() < 2e-5 * abs(expected).max()


def test_force_gives_what_damping_takes_in_a_steady_period():
    """From the steady response, without contact."""
    of = march(case := forced(1e-2, "steady", rounds=3), prepare(case, pair(), OMEGA)).ledger
    assert of.force == pytest.approx(of.damping, rel=1e-9)
    period = np.pi * sum(
        order * abs(one) ** 2 * 2 * RATIOS * W * order * OMEGA
        for order, one in (
            (order, of / (W**2 - (order * OMEGA) ** 2 + 2j * RATIOS * W * order * OMEGA))
            for order, of in P.items()
        )
    )
    assert of.damping == pytest.approx(3 * period.sum(), rel=1e-9)


@pytest.mark.parametrize("start", ["rest", "steady"])
@pytest.mark.parametrize("more", [{}, {"stage": {"count": 2, "frequencies": [0.01, -0.01]}}])
def test_energies_close_with_contact(coarse_rom, start, more):
    """Of a blade, and of each of a stage, whose damping feeds some modes."""
    ratios = {"families": [0.02, -0.001], "rest": 0.003}
    case = scene(**RUB | more, force=ON_BLADE | {"from": start}).but(damping_ratio=ratios)
    outcome = marched(case, coarse_rom)
    for blade in outcome.each_blade:
        of = blade.facts.ledger
        assert blade.contact_share > 0
        assert of.force != 0
        assert of.fed > 0
        assert abs(blade_balance(of)) < 1e-12 * (abs(of.work) + of.damping + of.fed)


def test_blades_of_a_stage_are_forced_one_after_another(coarse_rom):
    """Blade j of N by an angle of 2 pi j / N, each to its own frequency."""
    stage = {"count": 3, "frequencies": [0.0, 0.01, -0.02]}
    case = scene(**RUB | {"casing__scale": 0.0}, stage=stage, force=ON_BLADE | {"from": "steady"})
    case = case.but(force={"orders": [ON_BLADE["orders"][0] | {"order": 4}]})
    setup = set_up(case, coarse_rom)
    outcome, samples = march(case, setup), case.record.samples_per_round
    omega, Phi = coarse_rom.modes(setup.Omega)
    row = coarse_rom.rows(np.array([1 / 16]))[0] @ Phi
    theta = 2 * np.pi * np.arange(1, samples + 1) / samples
    for j, (blade, change) in enumerate(zip(outcome.blades, stage["frequencies"], strict=True)):
        own, at = (1 + change) * omega, 4 * setup.Omega
        given = np.array([0.5, 3.0, *[0.0] * (len(omega) - 2)]) * np.exp(1j * np.pi / 6)
        answer = abs(row) @ (given / (own**2 - at**2 + 2j * setup.zeta * own * at))
        expected = (answer * np.exp(4j * (theta + 2 * np.pi * j / 3))).real
        np.testing.assert_allclose(
            blade.u_r[-samples:, 0], expected, rtol=0, atol=1e-6 * abs(answer)
        )


def test_amplitude_is_that_of_mode_1_at_its_crossing(coarse_rom):
    """Without contact; what grows does so with the square of the speed."""
    of = {"order": 4, "amplitude_um": 20.0}
    at = rad_s(coarse_rom, crossing(coarse_rom, 4))
    case = scene(**RUB, force={"orders": [of]})
    P = prepare(case, coarse_rom, at).forced.P[0]
    omega, Phi = coarse_rom.modes(at)
    alone = abs(P[0] * (coarse_rom.rows(np.array([1 / 16])) @ Phi)[0, 0])
    assert alone / (2 * case.damping_ratio * omega[0] ** 2) == pytest.approx(2e-5, rel=1e-6)
    grown = prepare(case.but(force={"orders": [of | {"grows": True}]}), coarse_rom, 0.8 * at)
    assert abs(grown.forced.P[0, 0]) == pytest.approx(0.64 * abs(P[0]), rel=1e-6)


def test_a_run_goes_on_from_another(coarse_rom):
    """At the same speed to the last bit; at another with the same displacement and velocity."""
    ends = scene(**RUB, force=ON_BLADE, record__end=True)
    whole, half = marched(ends.but(rounds=4), coarse_rom), marched(ends, coarse_rom)
    setup = set_up(ends, coarse_rom)
    on = march(ends, setup, half.final)
    assert np.array_equal(on.wear, whole.wear)
    assert np.array_equal(on.u_r[-64:], whole.u_r[-64:])
    faster = prepare(ends, coarse_rom, 1.01 * setup.Omega)
    after = march(ends.but(rounds=1), faster, half.final)
    energy = after.ledger.blade_before
    q, v = half.final.x[0], half.final.y[0]
    assert energy == pytest.approx(half.ledger.blade, rel=0.02)
    assert len(q) == len(v)


REFUSED = {
    "two of an order": ({"orders": [{"order": 3, "modal_force": [1.0]}] * 2}, "force.orders"),
    "no size": ({"orders": [{"order": 3}]}, "force.orders.0"),
    "no mapping": (4, "needs keys: orders, from"),
    "Python's name": (ON_BLADE | {"from_": "rest"}, "did you mean 'from'?"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_refuses_a_force_that_is_not_known(case):
    """Its key is named."""
    values, key = REFUSED[case]
    assert key in str(refused(SettingsError, scene, **RUB, force=values))


def test_refuses_a_force_where_it_cannot_serve(coarse_rom):
    """Central differences; a crossing that no speed meets; a response without a limit."""
    error = refused(SettingsError, scene, integrator=SCHEMES["central-difference"], force=ON_BLADE)
    assert "piecewise-exact" in str(error)
    of_one = {"order": 1, "amplitude_um": 5.0}
    case = scene(**RUB, force={"orders": [of_one]})
    assert refused(SceneError, check_scene, case, coarse_rom).key == "force.orders.0.amplitude_um"
    many = forced(1e-2, force={"orders": [{"order": 3, "modal_force": [0.1] * 4}]})
    error = refused(SceneError, prepare, many, pair(), OMEGA)
    assert error.key == "force.orders.0.modal_force"
    undamped = scene(**RUB | {"damping_ratio": 0.0}, force={"orders": [of_one | {"order": 4}]})
    assert refused(SceneError, check_scene, undamped, coarse_rom).key.endswith("amplitude_um")


def test_scene_of_a_force_is_read_as_it_was_written():
    """With its key `from`, as results hold it."""
    case = scene(**RUB, force=ON_BLADE | {"from": "steady"})
    assert Scene.model_validate_json(case.model_dump_json()) == case
    assert case.but(rounds=3).force == case.force
