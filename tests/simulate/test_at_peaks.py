"""Answers at peaks: numbers of the sweep's own run, their uncertainty, and two possible motions."""

import numpy as np
import pytest
from runs import swept
from scenes import of_steps, scene

from simulate.errors.bistable import change, jump, largest
from simulate.errors.loads import torque
from simulate.sweeps import at_peaks
from simulate.sweeps.at_peaks import BISTABLE, CHAOTIC, SETTLED, Doubt, answers, raised
from simulate.sweeps.over_speeds import at_speeds
from simulate.sweeps.peak import peak_of

CALM = Doubt(basis=4e-5, mesh=None)
# An elastic liner that a casing of four lobes presses near the blade's own frequency: the response
# stiffens and grows with the speed, and falls from one motion to another.
FOLD = {
    "rounds": 60,
    "damping_ratio": 0.002,
    "speeds": {"over_f1": [0.3335]},
    "integrator": of_steps(1024),
    "liner__law": {"kind": "elastic", "E": 1.0, "unit_Pa": 1e9},
    "liner__rods_per_round": 509,
    "casing": {"ramp_rounds": 1, "harmonics": [{"order": 4, "amplitude_gaps": 1.2}]},
    "record": {"samples_per_round": 64, "spectrum_rounds": 4},
}
STEEP = {  # its amplitude changes by a sixth with a thousandth of the frequency, and does not jump
    "rounds": 30,
    "speeds": {"over_f1": [0.364]},
    "damping_ratio": 0.005,
    "liner__law": {"kind": "elastic", "E": 1.0, "unit_Pa": 3e9},
    "casing": {"ramp_rounds": 1, "harmonics": [{"order": 4, "amplitude_gaps": 1.5}]},
}
WORN = {
    "rounds": 8,
    "integrator": of_steps(1024),
    "record": {"samples_per_round": 64, "spectrum_rounds": 4, "contact_force": True},
    "speeds": {"over_f1": [0.30, 0.32, 0.34, 0.36, 0.38]},
}


@pytest.fixture(scope="module")
def edge(coarse_rom):
    """The model on which the motion changes at the speed of FOLD, to one part in a million."""
    case = scene(**FOLD)

    def amplitude(share):
        runs = at_speeds(case, raised(coarse_rom, share), case.speeds.omega(coarse_rom.f1))
        return float(runs["spectrum"].sel(engine_order=4).item())

    high, low = 3e-3, -3e-3  # the frequency falls below that at which it can follow
    assert amplitude(high) > 2 * amplitude(low)
    middle = np.sqrt(amplitude(high) * amplitude(low))
    while high - low > 1e-6:
        share = (high + low) / 2
        low, high = (low, share) if amplitude(share) > middle else (share, high)
    return raised(coarse_rom, high)


def test_a_scene_with_two_motions_is_bistable_and_gives_both(edge, coarse_rom):
    """Frequencies uncertain by 4e-5."""
    runs = at_speeds(scene(**FOLD), edge, scene(**FOLD).speeds.omega(coarse_rom.f1))
    (answer,) = answers(runs, edge, CALM)
    assert answer.word == BISTABLE
    assert largest(change(answer.numbers, answer.other)) > 0.3
    assert answer.parts["twin"]["amplitude"] < 0.01  # the gaps do not tell


FAR = FOLD | {"speeds": {"over_f1": [0.325]}}
HARD = {
    "rounds": 5,
    "damping_ratio": 0.0,
    "liner__law__unit_Pa": 1e13,
    "liner__rods_per_round": 2039,
    "speeds": {"over_f1": [0.33]},
    "twin": True,  # heard before the energy that these steps lose
}
ONE_MOTION = {  # scene, doubt, the word, and what the uncertainty of the amplitude is
    "far from the fold": (FAR, CALM, SETTLED, "model", (0.0, np.inf)),
    # frequencies uncertain by a tenth: the resonance passes the speed, and its fold with it
    "on a coarse mesh": (FAR, Doubt(None, 0.02), SETTLED, "mesh", (0.0, 0.5)),
    "on a very coarse mesh": (FAR, Doubt(None, 0.1), SETTLED, "mesh", (0.5, np.inf)),
    "steep": (FOLD | STEEP, Doubt(1e-3, None), SETTLED, "model", (0.1, np.inf)),
    "hard": (HARD, CALM, CHAOTIC, "model", (0.0, np.inf)),
}


@pytest.mark.parametrize("name", ONE_MOTION)
def test_one_motion_is_settled_or_not_predictable_with_its_uncertainty(coarse_rom, name):
    case, doubt, word, part, (least, most) = ONE_MOTION[name]
    (answer,) = answers(swept(scene(**case), coarse_rom), coarse_rom, doubt)
    assert answer.word == word
    if word == SETTLED:
        assert least < answer.parts[part]["amplitude"] <= most and answer.other == {}
    assert answer.runs > 5 or name != "steep"  # it was tried


def test_a_jump_within_the_last_digits_is_found_with_a_coarse_mesh(edge, coarse_rom):
    """At the same speed, as where a scene gives speeds in rad/s: the fold does not go along."""
    Omega = float(scene(**FOLD).speeds.omega(coarse_rom.f1)[0])
    case = scene(**FOLD | {"speeds": {"rad_s": [Omega]}})
    (answer,) = answers(at_speeds(case, edge, [Omega]), edge, Doubt(None, 0.02))
    assert answer.word == BISTABLE


def test_a_jump_stays_and_a_slope_does_not():
    answer = {
        "step": lambda share: {"amplitude": 1 + (share > 0.3) + share / 10},
        "slope": lambda share: {"amplitude": np.exp(share)},
    }

    def jump_of(name, *shares):
        return jump(answer[name], {share: answer[name](share) for share in shares})

    low, high = jump_of("step", -1.0, 0.0, 1.0)
    assert [round(of["amplitude"], 1) for of in (low, high)] == [1.0, 2.0]
    assert jump_of("slope", -1.0, 0.0, 1.0) is None
    assert jump_of("step", -1.0, 0.0) is None  # below JUMP_FROM


@pytest.fixture(scope="module")
def worn(coarse_rom):
    """A sweep over a plastic liner, with its contact force."""
    return swept(scene(**WORN), coarse_rom)


def test_numbers_are_those_of_the_sweep(worn, coarse_rom):
    """The run is marched anew to the last bit of what files hold."""
    found = answers(worn, coarse_rom, CALM)
    peak = peak_of(worn, coarse_rom, 4)
    answer = next(of for of in found if of.k in (4, None))
    index = peak.index if answer.k else int(worn["spectrum"].max("engine_order").argmax())
    run = worn.isel(speed_over_f1=index)
    assert answer.speed_over_f1 == float(run["speed_over_f1"])
    casing = run["ledger"].sel(energy="casing").item()
    shaft = torque(casing, rounds=8)
    assert shaft == pytest.approx(run["torque"].mean().item(), rel=1e-12)
    force = run["force_mean"].sum("share").mean("round").item()
    exact = {"force_peak": run["force_peak"].max().item()}
    if answer.k:
        exact["amplitude"] = run["spectrum"].sel(engine_order=4).item()
    assert answer.numbers.items() >= exact.items()
    found = [answer.numbers[name] for name in ("force", "torque")]
    assert found == pytest.approx([force, shaft], rel=1e-12)


def test_uncertainty_is_the_root_of_squares_of_twin_models_and_companion(worn, coarse_rom):
    for answer in answers(worn, coarse_rom, Doubt(1e-4, 1e-3)):
        assert {*answer.parts} == {"twin", "model", "mesh", "companion"}
        for name, value in answer.numbers.items():
            shares = [of[name] for of in answer.parts.values()]
            assert answer.errors[name] == pytest.approx(np.linalg.norm(shares) * value)
            assert answer.parts["companion"][name] > 0
        assert answer.runs >= 7


def test_a_model_raised_by_a_share_has_its_frequencies_higher_by_it(coarse_rom):
    ratio = raised(coarse_rom, 1e-3).modes(300.0)[0] / coarse_rom.modes(300.0)[0]
    np.testing.assert_allclose(ratio, 1.001, rtol=1e-9)


def test_without_a_result_or_in_turn_nothing_is_tried(coarse_rom, worn):
    turns = WORN | {"speeds": {"over_f1": [0.32, 0.34], "in_turn": True}}
    for answer in answers(swept(scene(**turns), coarse_rom), coarse_rom, CALM):
        assert (answer.word, answer.runs, answer.numbers) == ("", 0, {})
    failed = worn.assign(status=("speed_over_f1", ["diverged"] * 5))
    (answer,) = answers(failed, coarse_rom, CALM)
    assert (answer.status, answer.runs) == ("diverged", 0)


def test_a_bare_casing_has_no_liner_numbers_and_no_liner_no_force(coarse_rom):
    free = WORN | {"liner__law": {"kind": "none"}}
    (answer,) = answers(swept(scene(**free), coarse_rom), coarse_rom, CALM)
    assert {*answer.numbers} == {"amplitude"}
    assert {*answer.errors} <= {*at_peaks.UNITS}
