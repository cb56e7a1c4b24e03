"""Answers at peaks: numbers of the sweep's own run, their uncertainty, and two possible motions."""

from dataclasses import replace

import numpy as np
import pytest
from runs import set_up, swept
from scenes import of_steps, scene

from simulate.errors.companion import Fineness
from simulate.errors.model_errors import ModelError
from simulate.errors.neighbour import CHAOTIC, ONE_MOTION, TWO_MOTIONS
from simulate.errors.neighbours import raised
from simulate.errors.observables import numbers
from simulate.errors.run import Case
from simulate.errors.schema import of_peaks
from simulate.loads import torque
from simulate.marching import prepare
from simulate.sweeps.over_speeds import as_sweep, at_speeds
from simulate.sweeps.peak import reported
from simulate.sweeps.peak_results import (
    LAST,
    asked,
    at_peak,
    case_of,
    change,
    largest,
    of_sweep,
    results,
    sides,
    to_march,
)

CALM = ModelError(basis=4e-5, mesh=None)
# An elastic liner that a casing of four lobes presses near the blade's own frequency: the response
# stiffens and grows with the speed, and falls from one motion to another.
FOLD = {
    "rounds": 60,
    "damping_ratio": 0.002,
    "speeds": {"over_f1": [0.3335]},
    "integrator": of_steps(1024),
    "liner__law": {"kind": "elastic", "E": 1.0, "unit_MPa": 1000},
    "liner__rods_per_round": 509,
    "casing": {"ramp_rounds": 1, "harmonics": [{"order": 4, "amplitude_gaps": 1.2}]},
    "record": {"samples_per_round": 64, "spectrum_rounds": 4},
}
STEEP = {  # its amplitude changes by a sixth with a thousandth of the frequency, and does not jump
    "rounds": 30,
    "speeds": {"over_f1": [0.364]},
    "damping_ratio": 0.005,
    "liner__law": {"kind": "elastic", "E": 1.0, "unit_MPa": 3000},
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
        runs = as_sweep(
            at_speeds(case, raised(share).rom(coarse_rom), case.speeds.omega(coarse_rom.f1))
        )
        return float(runs["spectrum"].sel(engine_order=4).item())

    high, low = 3e-3, -3e-3  # the frequency falls below that at which it can follow
    assert amplitude(high) > 2 * amplitude(low)
    middle = np.sqrt(amplitude(high) * amplitude(low))
    while high - low > 1e-6:
        share = (high + low) / 2
        low, high = (low, share) if amplitude(share) > middle else (share, high)
    return raised(high).rom(coarse_rom)


def test_a_peak_with_two_motions_gives_both(edge, coarse_rom):
    """Frequencies uncertain by 4e-5."""
    runs = as_sweep(at_speeds(scene(**FOLD), edge, scene(**FOLD).speeds.omega(coarse_rom.f1)))
    (peak,) = results(runs, edge, CALM)
    assert peak.verdict == TWO_MOTIONS
    assert largest(change(peak.numbers, peak.other)) > 0.3
    assert peak.parts["twin"]["amplitude"] < 0.01  # the gaps do not tell


FAR = FOLD | {"speeds": {"over_f1": [0.325]}}
HARD = {
    "rounds": 5,
    "damping_ratio": 0.0,
    "liner__law__unit_MPa": 10000000,
    "liner__rods_per_round": 2039,
    "speeds": {"over_f1": [0.35]},  # departs by 3 % at least, whatever the last digits of the model
    "verify__predictable": True,  # heard before the energy that these steps lose
}


def test_a_peak_tells_each_blade_of_a_stage(coarse_rom):
    """Over an elastic liner they are single runs, of their lengths and frequencies."""
    stage = {"count": 3, "longer_um": [0, 2, -15], "frequencies": [0, 0, 0.01]}
    case = scene(**STEEP | {"rounds": 8, "record": WORN["record"], "stage": stage})
    runs = swept(case, coarse_rom)
    (peak,) = results(runs, coarse_rom, CALM)
    single, found, setup = case.but(stage=None), peak.blades, set_up(case, coarse_rom, peak.Omega_c)
    by_blade = {name: one.name for name, one in of_peaks().items() if one.by_blade}
    assert found["numbers"].keys() == by_blade.keys() and found["rub"] == [0, 1]
    for j, (um, share) in enumerate(zip(stage["longer_um"], stage["frequencies"], strict=True)):
        alone = numbers(Case(single, coarse_rom, setup.of_blade(j)).march(), peak.k)
        of_one = {by_blade[name]: values[j] for name, values in found["numbers"].items()}
        assert of_one == pytest.approx({name: alone[name] for name in of_one}, rel=1e-12)
        assert (found["longer"][j], found["frequencies"][j]) == pytest.approx((1e-6 * um, share))


def test_what_follows_from_other_numbers_has_no_part_in_verdicts():
    assert largest({"amplitude": 0.1, "worn_per_pass": 0.2, "alternating": 0.3}) == 0.1


SCENES = {  # scene, errors of the model, the word, and what the uncertainty of the amplitude is
    "far from the fold": (FAR, CALM, ONE_MOTION, "model", (0.0, np.inf)),
    # frequencies uncertain by a tenth: the resonance passes the speed, and its fold with it
    "on a coarse mesh": (FAR, ModelError(None, 0.02), ONE_MOTION, "mesh", (0.0, 0.5)),
    "on a very coarse mesh": (FAR, ModelError(None, 0.1), ONE_MOTION, "mesh", (0.5, np.inf)),
    "steep": (FOLD | STEEP, ModelError(1e-3, None), ONE_MOTION, "model", (0.1, np.inf)),
    "hard": (HARD, CALM, CHAOTIC, "model", (0.0, np.inf)),
}


@pytest.mark.parametrize("name", SCENES)
def test_a_peak_has_one_motion_or_is_not_predictable(coarse_rom, name):
    case, model_error, verdict, part, (least, most) = SCENES[name]
    (peak,) = results(swept(scene(**case), coarse_rom), coarse_rom, model_error)
    assert peak.verdict == verdict
    if verdict == ONE_MOTION:
        assert least < peak.parts[part]["amplitude"] <= most and peak.other == {}
    assert peak.runs > 5 or name != "steep"  # it was tried


def test_a_jump_within_the_last_digits_is_found_with_a_coarse_mesh(edge, coarse_rom):
    """At the same speed, as where a scene gives speeds in rad/s: the fold does not go along."""
    Omega = float(scene(**FOLD).speeds.omega(coarse_rom.f1)[0])
    case = scene(**FOLD | {"speeds": {"rad_s": [Omega]}})
    (peak,) = results(as_sweep(at_speeds(case, edge, [Omega])), edge, ModelError(None, 0.02))
    assert peak.verdict == TWO_MOTIONS


def test_a_jump_stays_and_a_slope_does_not():
    """Shares over the last digits of a model."""
    answer = {
        "step": lambda share: {"amplitude": 1 + (share > 0.3 * LAST) + share / LAST / 10},
        "slope": lambda share: {"amplitude": np.exp(share / LAST)},
    }

    def sides_of(name, *shares):
        return sides(answer[name], {LAST * share: answer[name](LAST * share) for share in shares})

    tried = sorted(of["amplitude"] for of in sides_of("step", -1.0, 0.0, 1.0))
    assert tried == pytest.approx([0.9, 1, 1.025, 2.03125, 2.0375, 2.05, 2.1])  # halved four times
    assert not sides_of("slope", -1.0, 0.0, 1.0)
    assert not sides_of("step", -1.0, 0.0)  # below JUMP_FROM


@pytest.fixture(scope="module")
def worn(coarse_rom):
    """A sweep over a plastic liner, with its contact force."""
    return swept(scene(**WORN), coarse_rom)


def test_numbers_are_those_of_the_sweep(worn, coarse_rom):
    """The run is marched anew to the last bit of what files hold."""
    found = results(worn, coarse_rom, CALM)
    peak = next(of for of in found if of.k in (4, None))
    at = next((of for of in reported(worn, coarse_rom) if of.k == peak.k), None)
    index = at.index if at else int(worn["spectrum"].max("engine_order").argmax())
    assert peak.index == index
    run = worn.isel(speed_over_f1=index)
    assert peak.Omega_c == float(run["speed_over_f1"])
    casing = run["ledger"].sel(energy="casing").item()
    shaft = torque(casing, rounds=8)
    assert shaft == pytest.approx(run["torque"].mean().item(), rel=1e-12)
    force = run["force_mean"].sum("share").mean("round").item()
    exact = {"force_peak": run["force_peak"].max().item()}
    if peak.k:
        exact["amplitude"] = run["spectrum"].sel(engine_order=4).item()
    assert peak.numbers.items() >= exact.items()
    found = [peak.numbers[name] for name in ("force", "torque")]
    assert found == pytest.approx([force, shaft], rel=1e-12)


def test_results_tell_of_the_sweep_and_its_model(worn, coarse_rom):
    why = worn.assign(reason=("speed_over_f1", ["", "none", "", "none", ""]))
    told = of_sweep(why, coarse_rom, CALM, [])
    assert (told["dofs"], told["reasons"], told["status"]) == (coarse_rom.n, ["none"], {"ok": 5})
    assert (told["swept"], told["free"]) == ([0.3, 0.38], int(worn["free"].sum()))
    largest = worn["along"].max(("speed_over_f1", "judged")).values / worn.attrs["gap_m"]
    assert told["seen"] == (1 + np.flatnonzero(largest >= 0.1)).tolist() and 2 in told["seen"]
    failed = worn.assign(status=("speed_over_f1", ["diverged", "ok", "ok", "ok", "diverged"]))
    ends = of_sweep(failed, coarse_rom, CALM, [])["ends"]
    assert [end["over_f1"] for end in ends] == [0.32, 0.36]


@pytest.fixture(scope="module")
def known(worn, coarse_rom):
    """The peaks of the sweep, with their uncertainty."""
    return results(worn, coarse_rom, ModelError(1e-4, 1e-3))


def test_uncertainty_is_the_root_of_squares_of_its_parts(known):
    for peak in known:
        of_all = {"twin", "model", "mesh", "patches", "finer"}
        assert {*peak.parts} - {"speeds"} == of_all and ("speeds" in peak.parts) == bool(peak.k)
        assert peak.numbers.keys() - peak.errors.keys() == {"tip_speed"}  # as exact as Omega
        for name in peak.errors:
            value = peak.numbers[name]
            shares = [of.get(name, 0.0) for of in peak.parts.values()]
            shares = [share for share in shares if np.isfinite(share)]  # others are not known
            assert peak.errors[name] == pytest.approx(np.linalg.norm(shares) * value)
            assert peak.parts["patches"][name] > 0 and peak.parts["finer"][name] > 0
        assert peak.runs >= 8 + 2 * bool(peak.k and not peak.at_end)


def test_four_times_the_strips_steps_and_rods_lie_within_the_uncertainty(coarse_rom):
    """At the speed of the peak, without what models and other speeds add."""
    usual = {"liner__strips": 16, "liner__rods_per_round": 1021, "integrator": of_steps(2048)}
    runs = swept(scene(**WORN | usual), coarse_rom)
    for peak in results(runs, coarse_rom, CALM):
        case = case_of(runs, to_march(runs), coarse_rom, peak)
        fine = Fineness(4 * 2048, 4 * 1021, 4 * 16).scene(case.scene)
        setup = prepare(fine, coarse_rom, case.setup.Omega)
        true = at_peak(replace(case, scene=fine, setup=setup), peak)
        off = [
            abs(true[name] / peak.numbers[name] - 1) / peak.parts["finer"][name]
            for name in peak.errors
        ]
        assert 0 < max(off) < 1


def test_against_a_rigid_casing_the_companion_has_half_the_strips(coarse_rom):
    """It takes no more strips than patches."""
    rigid = WORN | {"liner__law": {"kind": "rigid"}}
    for peak in results(swept(scene(**rigid), coarse_rom), coarse_rom, CALM):
        assert "companion" in peak.parts and "finer" not in peak.parts


def test_a_model_raised_by_a_share_has_its_frequencies_higher_by_it(coarse_rom):
    ratio = raised(1e-3).rom(coarse_rom).modes(300.0)[0] / coarse_rom.modes(300.0)[0]
    np.testing.assert_allclose(ratio, 1.001, rtol=1e-9)


def test_without_a_result_or_in_turn_nothing_is_tried(coarse_rom, worn):
    turns = WORN | {"speeds": {"over_f1": [0.32, 0.34], "in_turn": True}}
    for peak in results(swept(scene(**turns), coarse_rom), coarse_rom, CALM):
        assert (peak.verdict, peak.runs, peak.numbers) == ("", 0, {})
    failed = worn.assign(status=("speed_over_f1", ["diverged"] * 5))
    (peak,) = results(failed, coarse_rom, CALM)
    assert (peak.status, peak.runs) == ("diverged", 0)


def test_a_sweep_without_contact_and_force_has_no_critical_speed(coarse_rom):
    """Without a liner, or with one that no tip reaches, nothing moves the blade."""
    away = {"clearance": {"leading_edge_um": 1000, "trailing_edge_um": 1000}}
    for still in (away | {"casing__harmonics": []}, {"liner__law": {"kind": "none"}}):
        runs = swept(scene(**WORN | still), coarse_rom)
        assert asked(runs, coarse_rom) == results(runs, coarse_rom, CALM) == []
