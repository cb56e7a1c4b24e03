"""Damping by mode, below 0 too: rates of growth, limit cycles, families where modes veer."""

from dataclasses import replace

import numpy as np
import pytest
from refused import refused
from rods import elastic, of_modes, scene_of
from scenes import EXACT, RUBBING, SCHEMES, blade_balance, of_steps, scene

from geometry.base import SettingsError
from simulate.marching import march, prepare
from simulate.scene.damping import ratios

W, UNIT, STEPS = 1000.0, 1e-6, 512  # rad/s, as 1; m, as 1; in a period of mode 1
FLUTTER = -0.002


def of_two(rounds, **more):
    """Scene of a tip before an elastic stop of 2 at a gap of 1, mode 1 of a damping below 0."""
    values = {
        "speeds": {"over_f1": [1.0]},
        "rounds": rounds,
        # by rising frequency mode 1, the tilt, mode 2
        "damping_ratio": {"families": [FLUTTER, 0.0, 0.02], "rest": 0.0},
        "casing": {"ramp_rounds": 0.0, "harmonics": []},
        "integrator": of_steps(STEPS),
        "record": {"samples_per_round": STEPS, "spectrum_rounds": 1, "states_rounds": rounds}
        | {"end": True},
    }
    return scene_of(elastic(2 * W**2), UNIT, **values | more)


def run(case, rom, q1):
    """Outcome from ``q1`` of mode 1, in UNIT, at rest; |q1| (samples,) in the rounds kept."""
    setup = prepare(case, rom, W)
    rest = march(case.but(rounds=1, record={"states_rounds": 1}), setup).final
    x = np.zeros_like(rest.x)
    x[0, 0] = q1 * UNIT
    y = x * FLUTTER / np.sqrt(1 - FLUTTER**2)  # with it no velocity
    start = replace(rest, x=x, y=y, u=x @ setup.blade.Phi.T, rounds=0)
    outcome = march(case, setup, start)
    q = outcome.states @ rom.M @ rom.modes(W)[1]
    return outcome, np.abs(q[:, 0]) / UNIT


def largest(q, periods=1):
    """Of each ``periods``."""
    return np.nanmax(q.reshape(-1, periods * STEPS), axis=1)


def test_grows_without_contact_as_the_closed_form():
    """q e^{|xi| w t}, of a tip that stays before its stop; what it gains its damping has given."""
    rom = of_modes(np.array([W, 5.3 * W]), np.array([1.0, 1.0]), length=1e3 * UNIT, highest=2 * W)
    outcome, q = run(of_two(100), rom, 0.2)
    times = np.arange(1, 100 * STEPS + 1) * 2 * np.pi / STEPS
    omega_d = np.sqrt(1 - FLUTTER**2)
    turned = np.cos(omega_d * times) + FLUTTER / omega_d * np.sin(omega_d * times)
    expected = 0.2 * np.exp(-FLUTTER * times) * np.abs(turned)
    np.testing.assert_allclose(q[-100 * STEPS :], expected, rtol=0, atol=1e-9)
    ledger = outcome.ledger
    assert ledger.fed == pytest.approx(ledger.blade - ledger.blade_before, rel=1e-9)
    assert ledger.damping == pytest.approx(-ledger.fed, rel=1e-9)


def test_mode_alone_on_a_stop_has_no_limit_cycle():
    """It grows on at |xi| w to the bound of the displacement: fed by damping, no failure."""
    rom = of_modes(np.array([W, 5.3 * W]), np.array([1.0, 0.0]), length=1e3 * UNIT, highest=2 * W)
    outcome, q = run(of_two(500), rom, 1.2)
    assert outcome.status == "diverged"
    assert outcome.facts.ledger.numerical < 0.1 * outcome.facts.ledger.given
    ledger = outcome.ledger
    assert abs(blade_balance(ledger)) < 1e-9 * ledger.fed
    assert ledger.fed == pytest.approx(-ledger.damping, rel=1e-9)
    swing = largest(q[: int(outcome.rounds) * STEPS], 1)
    late = swing[swing > 30]  # where the gap counts no more
    rate = np.log(late[-1] / late[0]) / (len(late) - 1) / (2 * np.pi)
    assert rate == pytest.approx(-FLUTTER, rel=0.01)


def test_two_modes_settle_on_a_stop_or_grow():
    """In the limit cycle mode 2 takes what mode 1 is fed; its largest q1 is known: 1.4055."""
    rom = of_modes(np.array([W, 5.3 * W]), np.array([1.0, 1.0]), length=1e3 * UNIT, highest=2 * W)
    outcome, q = run(of_two(600), rom, 1.2)
    assert outcome.status == "ok"
    assert q[-100 * STEPS :].max() == pytest.approx(1.4055, rel=1e-3)
    case = of_two(200)
    on = march(case, prepare(case, rom, W), outcome.final).ledger
    assert on.fed > 0
    assert abs(on.damping) < 1e-3 * on.fed
    assert on.numerical < 1e-3 * on.given
    beyond, _ = run(of_two(1500), rom, 1.8)
    assert beyond.status == "diverged"
    assert beyond.ledger.fed > 0


def test_families_keep_their_ratios_where_two_modes_veer():
    """From one side to the other the modes of the same number exchange theirs."""
    rom = of_modes(np.array([W, 1.5 * W]), np.array([1.0, 0.3]), length=1.0, highest=W)
    of_rest = rom.M @ rom.modes(0.0)[1]
    coupled, stiffens = np.zeros((2, 3, 3))
    coupled[0, 2] = coupled[2, 0] = 1e-2 * W**2
    stiffens[0, 0] = 4.0  # mode 1 meets mode 3 at 0.56 W
    more = [of_rest @ of @ of_rest.T for of in (coupled, stiffens)]
    rom = replace(rom, K=np.stack([rom.K[0] + more[0], more[1]]))
    case = of_two(1, damping_ratio={"families": [0.001, 0.02], "rest": 0.005})
    slow, fast = (prepare(case, rom, part * W) for part in (0.4, 0.9))
    omega = np.sqrt(1 + 4 * 0.9**2) * W
    assert slow.zeta.tolist() == [0.001, 0.02, 0.005]
    assert fast.zeta.tolist() == [0.02, 0.005, 0.001]
    assert fast.omega[2] == pytest.approx(omega, rel=1e-3)
    gap = rom.modes(0.56 * W)[0]
    assert gap[-1] / gap[-2] > 1.004  # they do not cross


def test_ratios_over_the_frequency():
    """Linear between the rows, beyond them as at the ends; the file has the same columns."""
    table = {"frequency_Hz": [100.0, 200.0], "damping_ratio": [0.001, 0.003]}
    case = of_two(1, damping_ratio=table)
    omega = 2 * np.pi * np.array([50.0, 150.0, 500.0])
    found = ratios(case.damping_ratio, omega, families=list)
    np.testing.assert_allclose(found, [0.001, 0.002, 0.003], rtol=1e-12)


def test_alike_ratios_are_one():
    """Given one by one, over the frequency, or for all: the same motion."""
    rom = of_modes(np.array([W, 5.3 * W]), np.array([1.0, 1.0]), length=1e3 * UNIT, highest=2 * W)
    given = (
        0.01,
        {"families": [0.01], "rest": 0.01},
        {"frequency_Hz": [1.0, 2.0], "damping_ratio": [0.01, 0.01]},
    )
    swings = [run(of_two(5, damping_ratio=each), rom, 1.2)[1] for each in given]
    assert swings[0].max() > 1
    for swing in swings[1:]:
        np.testing.assert_allclose(swing, swings[0], rtol=0, atol=1e-12)


@pytest.mark.parametrize(
    ("value", "key"),
    [
        (-0.2, "damping_ratio"),
        ({"families": [0.001, -0.3], "rest": 0.0}, "damping_ratio.families.1"),
        ({"families": [0.001]}, "damping_ratio.rest"),
        ([0.001, 0.002], "damping_ratio"),
        ("0.5 %", "damping_ratio"),
        ({"frequency_Hz": [200.0, 100.0], "damping_ratio": [0.0, 0.0]}, "damping_ratio"),
        ({"frequency_Hz": [0.0, 100.0], "damping_ratio": [0.0]}, "damping_ratio"),
    ],
)
def test_refuses_ratios(value, key):
    """In one line, which names the key."""
    error = refused(SettingsError, scene, damping_ratio=value)
    assert error.key.startswith(key)


def test_refuses_what_feeds_under_central_differences():
    """Whose damping loss does not tell what it gives."""
    error = refused(
        SettingsError, scene, integrator=SCHEMES["central-difference"], damping_ratio=FLUTTER
    )
    assert error.key == "damping_ratio"


def test_blades_that_flutter_are_said_to_do_so_alone():
    """With several of them; one blade says nothing."""
    assert scene(**RUBBING, integrator=EXACT).but(damping_ratio=FLUTTER).assumes == []
    of_stage = scene(**RUBBING, integrator=EXACT, stage={"count": 3}).but(damping_ratio=FLUTTER)
    (said,) = of_stage.assumes
    assert "each of the 3 blades flutters alone" in said
