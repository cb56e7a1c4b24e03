"""Whether a run is steady: closed forms, runs until they are, drawn scenes marched much longer."""

from collections import Counter
from dataclasses import replace
from functools import partial
from itertools import pairwise
from math import ceil, inf, nan

import numpy as np
import pytest
from scenes import EXACT, RUBBING, of_steps, scene
from scipy.signal import lfilter

from geometry.base import ROOT
from rom.crossings import crossing
from simulate.errors.neighbour import Neighbour
from simulate.errors.neighbours import ITSELF, TWIN, judged
from simulate.errors.run import Case
from simulate.marching import WITH_RESULT, march, prepare
from simulate.marching.trend import FEWEST, Rounds, looks, time_constant, trend
from simulate.scene import DYING_OUT, GROWING, STEADY, TOO_SHORT, TRENDS, Scene
from simulate.sweeps.dataset import SPEED, course, load, of_run, save
from simulate.sweeps.peak import Peak
from simulate.sweeps.peak_results import case_of, to_march
from simulate.sweeps.sweep import sweep

J = np.arange(400.0)
NO_WEAR = np.zeros(400)


def of(swing, rounds, tau):
    """The word of the first ``rounds`` of a swing, without wear."""
    return trend(swing[:rounds], NO_WEAR[:rounds], tau)


@pytest.mark.parametrize("tau", [3.0, 20.0])
def test_what_dies_out_is_steady_when_little_of_it_is_left(tau):
    """1 + exp(-j/tau): 5 % of it is left after three time constants."""
    words = [of(1 + np.exp(-J / tau), n, tau) for n in range(FEWEST, 400)]
    first = words.index(STEADY) + FEWEST
    assert 3 * tau < first + 1 < 6 * tau
    assert set(words[first - FEWEST :]) == {STEADY}


def test_a_mode_that_rises_grows_until_it_is_steady():
    """1 - exp(-j/tau), as at a resonance that is switched on."""
    words = [of(1 - np.exp(-J / 30), n, 30.0) for n in range(FEWEST, 400)]
    assert words[0] == GROWING and words[-1] == STEADY and DYING_OUT not in words


@pytest.mark.parametrize("period", [3.3, 7.0, 16.0, 40.0])
def test_beats_are_no_growth(period):
    """Between a mode and an engine order: 1 + a cos that dies out, at any length and phase."""
    for phase in np.arange(0, 2 * np.pi, 0.5):
        swing = 1 + 0.4 * np.exp(-J / 25) * np.cos(2 * np.pi * J / period + phase)
        whole = [of(swing, n, 25.0) for n in range(ceil(2 * period) + FEWEST, 400)]
        assert {GROWING, DYING_OUT}.isdisjoint(whole) and whole[-1] == STEADY


def test_noise_about_a_level_is_steady_and_a_drift_in_it_is_found():
    noise = lfilter([1.0], [1.0, -0.6], np.random.default_rng(4).normal(0, 0.02, 400))
    assert of(1 + noise, 100, 5.0) == STEADY
    assert of(1 + noise + 0.01 * J, 100, 5.0) == GROWING
    assert of(2 + noise - 0.018 * J, 100, 5.0) == DYING_OUT


def test_wear_few_rounds_and_no_damping_tell_nothing_and_a_blade_at_rest_is_steady():
    assert trend(np.ones(40), np.ones(40), 2.0) == TOO_SHORT
    assert trend(np.ones(40), np.exp(-np.arange(40)), 2.0) == STEADY
    assert of(np.ones(400), FEWEST - 1, 1.0) == TOO_SHORT
    assert of(1 + 0.3 * np.cos(J), 100, inf) == TOO_SHORT
    assert of(NO_WEAR, 20, inf) == STEADY


def test_the_time_constant_is_of_the_mode_that_responds():
    """53 rounds at 0.1 % and k = 3."""
    theta = 2 * np.pi * np.arange(64) / 64
    samples = np.cos(3 * theta) + 0.5 * np.cos(11 * theta) + 9
    omega = 100 * np.array([3.1, 10.6])
    assert time_constant(samples, omega, 100.0, 1e-3) == pytest.approx(1 / (2e-3 * np.pi * 3.1))
    assert time_constant(np.cos(11 * theta), omega, 100.0, 1e-3) == pytest.approx(
        1 / (2e-3 * np.pi * 10.6)
    )
    assert time_constant(samples, omega, 100.0, 0.0) == inf


def test_the_largest_displacement_has_its_round():
    rounds = Rounds.unknown(4, 2.0)
    assert np.isnan(rounds.largest).all()
    seen = [([-3.0, 0.0, 1.0], 2.0), ([1.0, -5.0], 2.5), ([4.0, 2.0], 4.0)]
    for done, (samples, volume) in enumerate(seen):
        rounds.add(done, np.array(samples), volume)
    assert rounds.largest == (5.0, 2.0)
    np.testing.assert_array_equal(rounds.worn, [0.0, 0.5, 1.5, np.nan])
    np.testing.assert_array_equal(rounds.swing, [2.0, 3.0, 1.0, np.nan])


RUB = {
    "damping_ratio": 0.006,
    "integrator": EXACT,
    "record": {"samples_per_round": 64, "spectrum_rounds": 5, "wear": True, "contact_force": True},
}


def marched_case(case, rom, over_f1=0.3):
    return Case(case, rom, prepare(case, rom, over_f1 * rom.omega1)).march()


def marched(case, rom, over_f1=0.3):
    return marched_case(case, rom, over_f1).outcome


def test_a_run_until_it_is_steady_is_that_of_as_many_rounds(coarse_rom):
    """To the last bit, its last rounds in order; the rounds asked for are the most."""
    until = marched(scene(**RUB, rounds=200, until="steady"), coarse_rom)
    ends = sorted(looks(1, 5, 200))
    assert (until.status, until.trend) == ("ok", STEADY) and until.rounds in ends[1:-1]
    same = marched(scene(**RUB, rounds=int(until.rounds)), coarse_rom)
    assert same.trend == STEADY
    for name in ("u_r", "wear", "casing_work"):
        np.testing.assert_array_equal(getattr(until, name), getattr(same, name))
    *_, earlier, before = ends[: ends.index(until.rounds)]
    assert marched(scene(**RUB, rounds=before), coarse_rom).trend == STEADY
    assert marched(scene(**RUB, rounds=earlier), coarse_rom).trend != STEADY
    shorter = marched(scene(**RUB, rounds=12, until="steady"), coarse_rom)
    assert shorter.rounds == 12 and shorter.trend != STEADY


def test_it_is_marched_as_far_as_its_spectrum_needs(coarse_rom):
    record = RUB["record"] | {"spectrum_rounds": 50}
    case = scene(**RUB | {"record": record}, rounds=200, until="steady")
    assert marched(case, coarse_rom).rounds >= 50


@pytest.mark.parametrize("bound", [0.05, 0.99])  # in the first round; in a later one
def test_a_run_that_breaks_off_says_what_its_whole_rounds_tell(coarse_rom, bound):
    """Of a time constant and of what is worn at the end nothing is known; twins go as far."""
    case = scene(**RUB, rounds=30, until="steady", verify__predictable=True)
    setup = prepare(case, coarse_rom, 0.3 * coarse_rom.omega1)
    largest = march(case, setup).each.largest[0]
    run = judged(Case(case, coarse_rom, replace(setup, bound=bound * largest)).march())
    assert run.outcome.status == "diverged" and run.outcome.trend == TOO_SHORT
    assert np.isnan(run.outcome.time_constant)
    assert course(of_run(run).isel(speed_over_f1=0)) == {"trend": TOO_SHORT}


def test_a_run_that_grows_until_it_breaks_off_grows():
    rounds = Rounds.unknown(40, 0.0)
    for done in range(30):
        rounds.add(done, np.array([0.0, 1.1**done]), 0.0)
    assert rounds.trend(0, nan) == GROWING
    assert rounds.trend(24, nan) == TOO_SHORT


@pytest.mark.parametrize("verify", [{"predictable": True}, "every"])
def test_second_runs_take_as_many_rounds(coarse_rom, verify):
    """So that the differences are those of the runs, not of their lengths."""
    case = scene(**RUB, rounds=80, until="steady", verify=verify)
    run = judged(marched_case(case, coarse_rom))
    assert run.outcome.rounds < 80
    for found, most in ((run.departures, 1e-6), (run.errors, 1.0))[: 1 + (verify == "every")]:
        assert {*found} == {"spectrum", "wear", "force_peak"}
        assert max(found.values()) < most


def test_at_peaks_second_runs_take_as_many_rounds_as_the_sweep(coarse_rom):
    speeds = {"over_f1": [0.28, 0.3, 0.32]}
    runs = sweep(scene(**RUB, rounds=80, until="steady", speeds=speeds), coarse_rom)
    peak = Peak(4, 1, 0.3)
    case = case_of(runs, to_march(runs), coarse_rom, peak)
    longer = Neighbour("less damped", scene=lambda of: of.but(damping_ratio=1e-4))
    for other in (ITSELF, TWIN, longer):
        assert case.neighbour(other).march().outcome.rounds == runs["rounds"][1] < 80


def test_a_scene_may_start_from_one_that_does_not_stop(coarse_rom):
    first = RUB | {"record": RUB["record"] | {"end": True}}
    runs = sweep(scene(**first, rounds=20), coarse_rom)
    case = scene(**RUB, rounds=60, until="steady", start={"scene": "first"})
    assert sweep(case, coarse_rom, start=runs)["trend"].item() == STEADY


def test_a_ramp_ends_where_it_takes_its_last_value():
    """Tables go on to the end of a run, with the same factor."""
    ramp = {"rounds": [0, 5.5, 9, 80], "factor": [0, 0.5, 1, 1]}
    assert scene(casing__ramp_rounds=None, casing__ramp=ramp).casing.changes_until == 9
    still = {"rounds": [0, 80], "factor": [1, 1]}
    assert scene(casing__ramp_rounds=None, casing__ramp=still).casing.changes_until == 0


def test_what_is_recorded_over_time_is_that_of_as_many_rounds(coarse_rom, tmp_path):
    """To the last bit: histories from the start, all else of the last rounds, in order.

    The file is read though nothing was computed after a run.
    """
    record = RUB["record"] | {"states_rounds": 3, "motion": 3, "history": {"chord": [0.5]}}
    case = scene(**RUB | {"record": record}, rounds=200, until="steady", speeds={"over_f1": [0.3]})
    save(sweep(case, coarse_rom), tmp_path / "sweep.nc")
    until = load(tmp_path / "sweep.nc")
    rounds = int(until["rounds"].item())
    assert until["trend"].item() == STEADY and rounds < 200
    same = sweep(case.but(until=None, rounds=rounds), coarse_rom)
    for name in ("states", "motion", "strained", "strained_round", "spectrum", "along", "torque"):
        values = until[name].values[:, :rounds] if name == "torque" else until[name].values
        np.testing.assert_array_equal(values, same[name].values)
    for name, time in {"history": "history_time", "envelope": "window"}.items():
        cut, left = np.split(until[name].transpose(time, ...).values, [same.sizes[time]])
        np.testing.assert_array_equal(cut, same[name].transpose(time, ...).values)
        assert np.isnan(left).all()
    for time in ("time", "motion_time"):  # runs end at times of their own
        np.testing.assert_allclose(until[time] + rounds, same[time], rtol=1e-12)
        assert "since the end" in until[time].attrs["long_name"]


@pytest.mark.slow
def test_a_run_that_shorter_steps_mend_has_the_times_of_its_sweep(coarse_rom, tmp_path):
    """All but one run of a sweep until steady are of its own steps; all end at 0."""
    stiff = {"kind": "plastic", "E": 100.0, "K": 45.0, "sigma_Y": 1e-8, "unit_MPa": 2000}
    record = RUB["record"] | {"motion": 3, "states_rounds": 3, "history": {"chord": [0.5]}}
    speeds = {"over_f1": {"first": 0.26, "last": 0.34, "count": 12}}
    of = {"record": record, "speeds": speeds, "liner__law": stiff, "damping_ratio": 0.02}
    of |= {"liner__rods_per_round": 2039, "integrator": of_steps(1280), "verify": {"share": 0.1}}
    save(sweep(scene(**RUB | of, rounds=60, until="steady"), coarse_rom), tmp_path / "sweep.nc")
    runs = load(tmp_path / "sweep.nc")
    mended = runs.steps_per_round > 1280
    assert mended.any() and len({*runs.rounds.values}) > 1
    assert runs.motion_time.values[-1] == 0 and len(runs.motion_time) == 64
    assert runs.sizes["round"] == 60 and np.isfinite(runs.motion[mended]).all()
    for name in ("worn", "torque", "force_peak"):
        known = np.isfinite(runs[name]).all([*{*runs[name].dims} - {SPEED, "round"}])
        np.testing.assert_array_equal(known.sum("round"), runs.rounds)


def test_second_runs_record_no_more_states_than_the_run(coarse_rom):
    record = {"samples_per_round": 64, "states_rounds": 150, "spectrum_rounds": None}
    case = scene(**RUB | {"record": record}, rounds=200, until="steady", verify__predictable=True)
    run = judged(marched_case(case, coarse_rom))
    assert run.outcome.rounds < 150 and 0 < max(run.departures.values()) < 1e-6
    ended = of_run(run)["states"].dropna("time")
    np.testing.assert_array_equal(ended[0], run.outcome.states)


def test_a_peak_still_grows_after_the_twenty_rounds_of_the_paper(coarse_rom):
    """Near 0.350 f1(0) with the ductile coating: its amplitude there is none of a steady motion."""
    paper = Scene.load(ROOT / "workflow/scenes/paper.yaml")
    case = paper.but(**RUBBING, liner__strips=8)
    run = marched(case, coarse_rom, 0.35)
    assert (run.status, run.trend, run.each.largest[1]) == ("ok", GROWING, 20.0)
    assert run.time_constant == pytest.approx(15, rel=0.1)  # 0.29 %, k = 3.7


# How drawn scenes refute a word: marched to ten time constants, or a quarter of the run longer
SCENES, LONGER = 200, 10
OFF = 0.1  # of the swing of a steady run, there
PASSED = 0.01  # by which the swing of a quarter comes to lie beyond that at the end of the run


def drawn(dice, rom):
    """A scene near a crossing or anywhere, its speed over f1(0), and rounds to judge it by."""
    at = crossing(rom, int(dice.integers(3, 12)))
    near = min(0.395, (at if np.isfinite(at) else 0.35) * dice.uniform(0.98, 1.15))
    over_f1 = near if dice.random() < 0.5 else dice.uniform(0.061, 0.395)
    zeta = 10 ** dice.uniform(-2.8, -1.7)
    tau = over_f1 / (2 * np.pi * zeta)  # of the first mode at rest: the slowest
    ramp = float(dice.choice([0.5, 2.0, 5.0]))
    rounds = ceil(ramp) + int(np.exp(dice.uniform(np.log(FEWEST), np.log(max(8 * tau, 30)))))
    values = {
        "damping_ratio": zeta,
        "rounds": max(ceil(LONGER * tau), rounds + rounds // 4 + 1),
        "integrator": of_steps(1024),
        "liner__rods_per_round": 1019,
        "liner__law__unit_MPa": 8000 * 10 ** dice.uniform(-1, 0.3),
        "liner__law__E": float(dice.choice([0.1, 0.25, 0.5, 1.0, 2.0, 3.0, 5.0, 7.0, 10.0])),
        "liner__law__K": float(dice.choice([0.1, 0.45, 1.0, 4.55, 10.0])),
        "casing__ramp_rounds": ramp,
        "casing__harmonics": [
            {"order": order, "amplitude_gaps": share * dice.uniform(1.1, 2.5)}
            for order, share in ((0, 0.375), (int(dice.integers(1, 4)), 0.5), (4, 0.125))
        ],
        "record": {"samples_per_round": 64, "spectrum_rounds": 1, "wear": True},
    }
    return scene(**values), over_f1, rounds


def refuted(word, swing, end):
    """Whether a ``swing`` of more rounds refutes the ``word`` of those before ``end``."""
    window = max(end // 4, 2)
    last = swing[end - window : end].mean()
    means = np.convolve(swing[end - window // 2 :], np.ones(window) / window, "valid") / last
    if word == STEADY:
        return abs(means[-1] - 1) > OFF
    return means.max() <= 1 + PASSED if word == GROWING else means.min() >= 1 - PASSED


def said(each, standing, tau, end):
    """The word after ``end`` rounds."""
    return trend(each.swing[standing:end], each.worn[standing:end], tau)


@pytest.mark.slow
def test_few_words_of_drawn_scenes_are_refuted(coarse_rom):
    """Of steady ones 2 % at most, of growing and dying ones 10 %; most long runs get a word.

    Also of runs that end where they are steady. Long: two time constants, while the casing stands.
    The limits of ``trend`` were set on other scenes, 300 of both blades and 1200 of this one.
    """
    dice, words, wrong, long = np.random.default_rng(20261126), Counter(), Counter(), []
    for _ in range(SCENES):
        case, over_f1, rounds = drawn(dice, coarse_rom)
        run = marched(case, coarse_rom, over_f1)
        if run.status not in WITH_RESULT:
            continue
        standing, tau = case.casing.changes_until, run.time_constant
        says = partial(said, run.each, standing, tau)
        ends = sorted(looks(standing, 1, len(run.each.worn)))
        stops = (end for of, end in pairwise(ends) if says(of) == says(end) == STEADY)
        if (end := next(stops, inf)) < 0.75 * len(run.each.worn):
            words["until"] += 1
            wrong["until"] += refuted(STEADY, run.each.swing, end)
        word = says(rounds)
        words[word] += 1
        wrong[word] += word != TOO_SHORT and refuted(word, run.each.swing, rounds)
        if rounds - standing > 2 * tau:
            long.append(word != TOO_SHORT)
    print(words, wrong, len(long), np.mean(long))
    assert sum(words[word] for word in TRENDS) > 0.9 * SCENES and set(words) <= {*TRENDS, "until"}
    assert wrong[STEADY] <= 0.02 * words[STEADY]
    assert wrong["until"] <= 0.02 * words["until"] and words["until"] > 0.5 * SCENES
    moving = words[GROWING] + words[DYING_OUT]
    assert wrong[GROWING] + wrong[DYING_OUT] <= 0.1 * moving
    assert np.mean(long) >= 0.7
