"""Several blades over one liner: closed forms, single runs, legs, restarts, a casing of all."""

from dataclasses import fields, replace
from functools import partial

import numpy as np
import pytest
from pairs import W_R, band, growth, largest_growth, march_stood, mode, of_stage, stood
from refused import refused
from runs import marched, set_up
from scenes import EXACT, RUBBING, SCHEMES, UNIT, blade_balance, of_steps, scene
from systems import Parameters, strips
from test_moving_casing import WITH, given

from geometry.base import SettingsError
from rom.coarser import coarser
from simulate.contact.compiled import for_types_of
from simulate.contact.ledger import ON_CASING, WORN
from simulate.contact.places import by_share
from simulate.contact.ramp import smooth
from simulate.errors.companion import with_errors
from simulate.errors.resolution import check_resolution
from simulate.errors.run import Case
from simulate.loads import torque_of_rounds, worn_volume
from simulate.marching import (
    EndOfStage,
    FinalState,
    SceneError,
    central_difference as central,
    check_scene,
    march,
)
from simulate.marching.common_casing import RIGID
from simulate.marching.course import Course
from simulate.marching.disk import (
    Disk,
    Turned,
    does_not_slide,
    leg_of,
    march_disk,
    of_all_schemes,
    same_casing,
    stacked,
)
from simulate.marching.kernel import Recorded, at_start
from simulate.marching.status import judged
from simulate.scene import Stage
from simulate.scene.stage import Frequencies, Lengths
from simulate.signals import amplitude
from simulate.sweeps.cost import cost
from simulate.sweeps.sweep import sweep

E, K = 10.0, 4.55  # of the rigid blades, Pa
STRAINS = np.array([1.0, 0.8, 0.5, 0.25])
ORDER = {0: [0, 3, 2, 1], 3: [3, 2, 1, 0]}  # of the blades, by the quarter of the rod
ELASTIC = {"liner__law": {"kind": "elastic", "E": 1.0, "unit_MPa": UNIT / 1e6}}
UNEVEN = {
    "longer_um": {"std_um": 1.0, "seed": 3},
    "frequencies": {"std": 0.01, "seed": 1},
}  # of twelve blades, some of which rub


def rubbing(**changes):
    """A rub with a spectrum, in steps that are exact between forces."""
    return scene(**RUBBING | {"integrator": EXACT, "record__spectrum_rounds": 1} | changes)


def rigid_blades(rounds, per_blade=4):
    """Rigid blades on single rods, one rod in a step.

    Forces (rounds, blades, steps), N; plastic strains of the rods; volume that each blade wore.
    """
    blades, steps = len(STRAINS), per_blade * len(STRAINS)
    scheme = central.coefficients(np.array([1.0]), np.zeros((1, 1)), 0.0, 0.1)
    one = strips(Parameters(E, K, 0.0), 0.0, np.ones(steps), advance=1.0)
    states = [at_start(scheme, one) for _ in range(blades)]
    state = stacked(states)._replace(eps_p=states[0].eps_p)
    disk = Disk(
        schemes=stacked([scheme]),
        which=np.zeros(blades, np.int64),
        slides=does_not_slide,
        rows=of_all_schemes,
        casing=same_casing,
        g0=1 - STRAINS[:, None] / 2,
        first=per_blade * np.arange(float(blades))[:, None],
        leg=2,
        common=RIGID,
    )
    found, turned = [], Turned.room(blades)
    for done in range(rounds):
        pushed = np.zeros((blades, steps, 1))
        recorded = Recorded(
            np.zeros((blades, steps, 1)), np.zeros((blades, 3, 1)), np.zeros((blades, 0, 0)),
            Phi=np.zeros((1, 8)), weights=np.ones((2, 1, 1)), pushed=pushed,
        )  # fmt: skip
        arguments = disk, one, state, recorded, smooth(0.0), np.inf, done, steps, turned
        for_types_of(march_disk, *arguments)(*arguments)
        found.append(np.diff(pushed[..., 0], axis=1, prepend=0.0))
    return np.array(found), state.eps_p[0], state.energies[:, WORN]


def test_a_rod_meets_rigid_blades_in_decreasing_numbers():
    """Stresses of the closed form on a rod that the shortest meets first, and on another.

    At half the strains: at a strain of 1 the liner is worn through.
    """
    forces, eps_p, wore = rigid_blades(rounds=3)

    def on_rod(r):
        """Forces (rounds, blades), as it meets them."""
        return 2 * np.array([forces[:, j, (r - 4 * j - 1) % 16] for j in ORDER[r // 4]]).T

    last = [0.0, 0.0, 1.127148, 3.127148]
    expected = [[0.781787, 1.563574, 2.501718, 3.127148], last, last]
    np.testing.assert_allclose(on_rod(13), expected, atol=1e-6)
    np.testing.assert_allclose(on_rod(1), [np.roll(last, 1)] * 3, atol=1e-6)
    np.testing.assert_allclose(2 * eps_p, E / (E + K), rtol=1e-12)
    # each wears what is left of its own depth by those that the rod met before
    reach, expected = STRAINS / 2 * E / (E + K), np.zeros(len(STRAINS))
    for first in range(4):
        worn = 0.0
        for j in (first - np.arange(4)) % 4:
            expected[j] += 4 * max(reach[j] - worn, 0.0)
            worn = max(worn, reach[j])
    np.testing.assert_allclose(wore, expected, rtol=1e-12)


@pytest.mark.parametrize("scheme", SCHEMES)
def test_a_stage_of_one_blade_is_one_blade_to_the_last_bit(scheme, coarse_rom):
    case = rubbing(integrator=SCHEMES[scheme])
    one, of_stage = (marched(of, coarse_rom) for of in (case, case.but(stage={"count": 1})))
    assert one.wear.max() > 1e-6
    for name in ("u_r", "wear", "force_peak", "force_mean", "casing_work"):
        np.testing.assert_array_equal(getattr(one, name), getattr(of_stage, name), err_msg=name)
    np.testing.assert_array_equal(one.each.extremes, of_stage.each.extremes)


def test_blades_over_an_elastic_liner_are_single_runs(coarse_rom):
    """Bits with the rods of the start shifted; with the casing turned, to round-off."""
    stage = {"count": 4, "longer_um": [0, 2, -1, 1], "frequencies": [0, 0.01, 0, -0.02]}
    case = rubbing(**ELASTIC, liner__rods_per_round=2040, record__blades="all", stage=stage)
    setup = set_up(case, coarse_rom)
    of_stage = march(case, setup)
    single = case.but(stage=None, record={"blades": "worst"})
    for j, blade in enumerate(of_stage.blades):
        alone = march(single, setup.of_blade(j))
        assert alone.contact_share == blade.contact_share > 0.1
        for name in ("u_r", "force_peak", "casing_work"):
            np.testing.assert_array_equal(getattr(alone, name), getattr(blade, name))
    three = {
        "count": 3,
        "longer_um": None,
        "frequencies": None,
    }  # by 120 and 240 deg, other casings
    for j, blade in enumerate(marched(case.but(stage=three), coarse_rom).blades):
        turned = [
            of.model_dump(exclude_none=True)
            | {"phase_deg": (of.phase_deg + 120 * j * of.order) % 360}
            for of in single.casing.harmonics
        ]
        alone = marched(single.but(casing={"harmonics": turned}), coarse_rom)
        most = abs(alone.u_r).max()
        np.testing.assert_allclose(blade.u_r, alone.u_r, rtol=0, atol=1e-12 * most)


def test_two_equal_blades_over_an_even_casing_wear_alike(coarse_rom):
    outcome = marched(rubbing(liner__rods_per_round=2040, rounds=4, stage={"count": 2}), coarse_rom)
    half = np.roll(outcome.wear, 1020, axis=1)
    np.testing.assert_allclose(outcome.wear, half, rtol=0, atol=1e-12 * half.max())
    assert [of.wear_share for of in (outcome, *outcome.blades)] == pytest.approx([1.0, 0.5, 0.5])
    one, other = (blade.each for blade in outcome.blades)
    np.testing.assert_allclose(one.extremes, other.extremes, rtol=1e-12)
    alone = marched(rubbing(liner__rods_per_round=2040, rounds=4), coarse_rom)
    assert not np.allclose(outcome.wear, alone.wear, rtol=1e-2)


@pytest.mark.parametrize("name", ["flat", "friction", "short"])
def test_blades_wear_what_the_liner_loses(name, coarse_rom, monkeypatch):
    """Also one that begins over the liner of another run."""
    wore, outcome_of = [], Course.outcome

    def outcome(course, *given, **of_liner):
        """That of the course, whose wear is kept."""
        wore.append(course.wore)
        return outcome_of(course, *given, **of_liner)

    monkeypatch.setattr(Course, "outcome", outcome)
    short = {"liner__footprint_mm": 0.5}  # liner comes and goes within a step
    case = rubbing(stage={"count": 12} | UNEVEN, record__end=True, **WITH.get(name, short))
    setup = set_up(case, coarse_rom)
    places, begun = setup.places, march(case, setup)
    went_on = march(case, setup, begun.final)
    parts = [begun.wear, went_on.wear - begun.wear]
    for wear, of_run in zip(parts, np.split(np.array(wore), 2), strict=True):
        lost = worn_volume(wear, places.width, places.radius)
        assert of_run.sum() == pytest.approx(lost, rel=1e-9)
    shares = [blade.wear_share for blade in begun.blades]
    np.testing.assert_allclose(shares, np.array(wore[:12]) / sum(wore[:12]))
    assert min(shares) < 0.01 < 0.2 < max(shares)


@pytest.mark.parametrize("name", ["flat", "friction", "travelling"])
def test_legs_of_any_length_are_the_same_to_the_last_bit(name, coarse_rom):
    """From a part of a sample to the longest; a longer one would not be."""
    stage = {"count": 12} | UNEVEN
    case = rubbing(record__blades="all", stage=stage, **WITH[name])
    setup = set_up(case, coarse_rom)
    longest, last = setup.stage.leg, march(case, setup)
    assert longest >= 10 and last.wear.max() > 1e-6
    for leg in (1, 5, 10):
        other = march(case, replace(setup, stage=replace(setup.stage, leg=leg)))
        np.testing.assert_array_equal(other.wear, last.wear)
        for one, blade in zip(other.blades, last.blades, strict=True):
            np.testing.assert_array_equal(one.u_r, blade.u_r)
            assert one.contact_share == blade.contact_share
    if name == "flat":
        wrong = march(case, replace(setup, stage=replace(setup.stage, leg=setup.steps)))
        assert not np.array_equal(wrong.wear, last.wear)


@pytest.mark.parametrize("blades", [2, 7, 12, 30, 60])
def test_windows_of_neighbours_do_not_meet_in_a_leg(blades, coarse_rom):
    """And would in one more sample, or in twice the part of one."""
    strips, steps, samples = set_up(rubbing(), coarse_rom).strips, 640, 64
    leg, every = leg_of(strips, blades, steps, samples, most=0.0), 10
    window, pitch = strips.rods_covered + 2 + 2 * strips.partly_covered, 512 / blades
    more = leg + every if leg >= every else 2 * leg
    assert leg * strips.advance + window <= pitch < more * strips.advance + window
    assert leg % every == 0 or every % leg == 0
    assert leg_of(strips._replace(tangential=True), blades, steps, samples, most=0.05) < leg


@pytest.mark.parametrize("name", ["flat", "friction", "rounded", "cone"])
def test_energies_of_all_blades_and_their_casing_are_balanced(name, coarse_rom):
    modes = [given(2, 0.9, coarse_rom), given(0, 3.0, coarse_rom), given(1, 0.7, coarse_rom)]
    case = rubbing(rounds=6, casing__modes=modes, stage={"count": 3} | THREE, **WITH[name])
    outcome = marched(case, coarse_rom)
    whole, ledger = outcome.ledger.casing + outcome.ledger.heat, outcome.ledger
    assert outcome.status == "ok" and ledger.casing_damping > 0 < ledger.casing_kinetic
    for blade in outcome.blades:
        assert blade.contact_share > 0.05
        assert abs(blade_balance(blade.facts.ledger)) < 1e-12 * whole
    assert abs(blade_balance(ledger)) < 1e-12 * whole
    if name != "rounded":  # there the ledger's error goes with the step
        assert abs(ledger.numerical) < 2e-3 * whole


THREE = {"longer_um": [1.0, 0.0, -2.0], "frequencies": [0.0, -0.01, 0.02]}


def test_what_blades_do_not_know_of_each_other_is_of_order_two(coarse_rom):
    """Energy of the casing of all, over what its blades have told of: falls with h squared."""
    modes = [given(2, 0.9, coarse_rom), given(0, 3.0, coarse_rom)]
    case = rubbing(rounds=2, casing__modes=modes, stage={"count": 3}, liner__rods_per_round=2048)
    created = []
    for steps in (1280, 2560, 5120):
        outcome = marched(case.but(integrator=of_steps(steps)), coarse_rom)
        told = sum(blade.facts.ledger.on_casing for blade in outcome.blades)
        created.append(abs(outcome.ledger.on_casing - told) / outcome.ledger.casing)
    first, second, third = created
    assert first < 1e-5 and 2.5 < first / second < 7 and 2.5 < second / third < 7


BANDS = [  # angles, rad; divergence, flutter, largest growth and where
    ((0.0, 0.5), (1.0009572, 1.0032038), (1.5287308, 1.5714272), (0.021345967, 1.55007903)),
    (
        tuple(2 * np.pi * np.arange(3) / 3),
        None,
        (1.5251034, 1.5773463),
        (0.026116663, 1.55122494),
    ),
]


@pytest.mark.parametrize(("theta", "divergence", "flutter", "largest"), BANDS)
def test_blades_on_one_pair_are_unstable_in_the_bands_of_the_equations(
    theta, divergence, flutter, largest
):
    kernel = partial(of_stage, theta=theta)
    np.testing.assert_allclose(band(kernel, np.mean(flutter), (1.45, 1.65)), flutter, atol=1e-5)
    if divergence:
        found = band(kernel, np.mean(divergence), (0.99, 1.01))
        np.testing.assert_allclose(found, divergence, atol=1e-5)
    else:
        assert max(growth(kernel, Omega) for Omega in np.linspace(0.99, 1.1, 23)) < 1e-7
    rate, Omega = largest_growth(kernel, flutter)
    assert rate == pytest.approx(largest[0], rel=1e-4)
    assert pytest.approx(largest[1], abs=1e-5) == Omega


def test_energy_on_one_pair_is_of_order_two_in_the_step():
    """The casing has what all blades together have told of, but for that."""
    created = []
    for h in (0.02, 0.01, 0.005):
        disk, system = stood((0.0, 0.5), 0.2, 0.7, h, [mode()])
        state, states = march_stood(disk, system, round(4 / h))
        energy = W_R**2 / 2 * (state[4:8] @ state[4:8])
        created.append(abs(energy - states.energies[:, ON_CASING].sum()) / energy)
    assert created[0] < 1e-3
    assert np.log2(created[0] / created[1]) == pytest.approx(2, abs=0.2)
    assert np.log2(created[1] / created[2]) == pytest.approx(2, abs=0.2)


def test_a_heavy_casing_of_several_blades_is_a_rigid_one(coarse_rom):
    rigid = rubbing(rounds=10, stage={"count": 3} | THREE)
    modes = [given(rom=coarse_rom, mass=9e12), given(0, 2.0, coarse_rom, 9e12)]
    one, other = (marched(case, coarse_rom) for case in (rigid, rigid.but(casing__modes=modes)))
    for values in ("u_r", "wear", "force_peak"):
        expected = getattr(one, values)
        np.testing.assert_allclose(
            getattr(other, values), expected, rtol=0, atol=1e-10 * abs(expected).max()
        )


@pytest.mark.parametrize("moves", [False, True])
def test_a_stage_goes_on_to_the_last_bit(moves, coarse_rom):
    """From the end of another run, in a file, with a casing that moves, too."""
    modes = {"casing__modes": [given(rom=coarse_rom)]} if moves else {}
    case = rubbing(record__end=True, rounds=3, stage={"count": 3} | THREE, **modes)
    whole, first = (sweep(of, coarse_rom) for of in (case.but(rounds=5), case))
    then = sweep(case.but(rounds=2, start={"scene": "before"}), coarse_rom, start=first)
    names = [field.name for kind in (FinalState, EndOfStage) for field in fields(kind)]
    for name in ("wear", *(f"end_{name}" for name in names if f"end_{name}" in whole)):
        np.testing.assert_array_equal(then[name].values, whole[name].values, err_msg=name)
    np.testing.assert_array_equal(
        then["blade_extremes"][0, :, :2], whole["blade_extremes"][0, :, 3:]
    )
    assert (
        first["end_x"].dims[:2] == ("speed_over_f1", "blade")
        and "blade" not in first["end_eps_p"].dims
    )
    other = case.but(stage={"count": 4, "longer_um": None, "frequencies": None})
    refused(
        SceneError, sweep, other.but(start={"scene": "before"}), coarse_rom, start=first,
        match="stage",
    )  # fmt: skip
    over = other.but(start={"scene": "before", "liner_only": True})
    assert sweep(over, coarse_rom, start=first)["wear"].max() >= whole["wear"].min()


def test_runs_in_turn_keep_all_blades(coarse_rom):
    case = rubbing(speeds={"over_f1": [0.3, 0.301], "in_turn": True}, stage={"count": 3} | THREE)
    both = sweep(case, coarse_rom)
    one = sweep(case.but(speeds={"over_f1": [0.3], "in_turn": False}, record__end=True), coarse_rom)
    then = case.but(
        speeds={"over_f1": [0.301], "in_turn": False}, start={"scene": "x", "speed_over_f1": 0.3}
    )
    then = sweep(then, coarse_rom, start=one)
    np.testing.assert_array_equal(both["wear"][1], then["wear"][0])


def test_the_worst_blade_is_told_with_its_number(coarse_rom):
    """That of the worst status; of several that of the largest displacement."""
    case = rubbing(rounds=4, record__spectrum_rounds=4)
    for stage, worst in (
        ({"count": 4, "longer_um": [0, 0, 8, 0]}, 2),
        ({"count": 4, "frequencies": [0, -0.2, 0, 0]}, None),
    ):
        run = sweep(case.but(stage=stage), coarse_rom).isel(speed_over_f1=0)
        found = int(run["worst"])
        assert worst is None or found == worst
        most = run["blade_displacement"].values
        assert found == most.argmax() and float(run["displacement"]) == pytest.approx(most.max())
        np.testing.assert_allclose(run["extremes"], run["blade_extremes"][found], rtol=1e-6)
        along = run["blade_along"].values[found]
        expected = [amplitude(run["spectrum"].values, 4, k) for k in run["order"].values]
        np.testing.assert_allclose(along, expected, rtol=1e-5, atol=1e-12)
    thin = case.but(
        liner={"thickness_mm": 0.02, "law": {"unit_MPa": 1.0}},
        stage={"count": 3, "longer_um": [0, 8, 0]},
    )
    ended = sweep(thin, coarse_rom).isel(speed_over_f1=0)
    assert (ended["status"], ended["worst"]) == ("liner-exhausted", 1)
    assert set(ended["blade_status"].values[[0, 2]]) <= {"ok", "no-contact"}


def test_a_run_ends_where_the_first_blade_ends(coarse_rom):
    """Whatever the leg: of two that are worn through in it the first counts."""
    thin = {"liner__thickness_mm": 0.02, "liner__law__unit_MPa": 1.0}
    case = rubbing(rounds=4, stage={"count": 3, "longer_um": [8.0, 8.0, 10.0]}, **thin)
    setup = set_up(case, coarse_rom)
    assert setup.stage.leg > setup.steps / 4
    for leg in (setup.stage.leg, 10):
        ended = march(case, replace(setup, stage=replace(setup.stage, leg=leg)))
        assert (ended.status, ended.worst) == ("liner-exhausted", 1)
        assert ended.rounds == pytest.approx(0.0875) == ended.blades[2].rounds
        assert {blade.status for blade in ended.blades[::2]} <= {"ok", "no-contact"}
        assert ended.xi == pytest.approx(0.0625) and np.isfinite(ended.theta)


def test_no_contact_is_said_where_no_blade_touches(coarse_rom):
    far = rubbing(casing__harmonics=[{"order": 2, "amplitude_gaps": 0.7}], stage={"count": 3})
    none = marched(far, coarse_rom)
    assert none.status == "no-contact" and "clearance" in none.reason
    long = far.but(stage={"count": 3, "longer_um": [0, 0, 4.0]})
    one = marched(long, coarse_rom)
    assert (one.status, one.worst) == ("ok", 2)
    assert [blade.status for blade in one.blades] == ["no-contact", "no-contact", "ok"]


def test_records_are_of_the_worst_of_a_list_or_of_all(coarse_rom):
    case = rubbing(record__states_rounds=1, record__motion=1, stage={"count": 3} | THREE)
    worst, listed, each = (
        sweep(case.but(record={"blades": blades}), coarse_rom).isel(speed_over_f1=0)
        for blades in ("worst", [2], "all")
    )
    assert "recorded" not in worst and listed["recorded"].values.tolist() == [2]
    for name in ("history", "states", "force_peak", "motion", "strained"):
        np.testing.assert_array_equal(listed[f"blade_{name}"][0], each[f"blade_{name}"][2])
        of_worst = each[f"blade_{name}"][int(each["worst"])]
        single = np.float32(worst[name].values)
        np.testing.assert_array_equal(of_worst, single, err_msg=name)


def test_a_stage_is_steady_where_all_its_blades_are(coarse_rom):
    case = rubbing(
        rounds=200, until="steady", damping_ratio=0.02, stage={"count": 2, "longer_um": [0, -3.0]}
    )
    outcome = marched(case, coarse_rom)
    assert outcome.trend == "steady" and outcome.rounds < 200
    assert {blade.trend for blade in outcome.blades} == {"steady"}
    assert len({blade.time_constant for blade in outcome.blades}) == 1
    far = rubbing(rounds=20, damping_ratio=0.02, stage={"count": 2, "longer_um": [0, -8.0]})
    outcome = marched(far, coarse_rom)
    assert [blade.trend for blade in outcome.blades] == ["steady", "too short to say"]
    assert (outcome.worst, outcome.trend) == (0, "too short to say")


def test_second_runs_compare_all_blades(coarse_rom):
    case = rubbing(verify="every", stage={"count": 3} | THREE)
    run = sweep(case, coarse_rom).isel(speed_over_f1=0)
    assert run["status"] == "ok" and 0 < run["error"].max() < 0.1
    assert run["departure"].max() < 1e-4


def test_companions_of_a_stage_have_its_states(coarse_rom):
    case = rubbing(record__states_rounds=1, liner__rods_per_round=640, stage={"count": 2})
    run = Case(case, coarse_rom, set_up(case, coarse_rom)).march()
    assert set(with_errors(run, coarser(coarse_rom)).errors) >= {"states", "history", "wear"}


def test_where_twice_the_step_brings_blades_too_near_half_of_it_checks(coarse_rom):
    case = rubbing(integrator=of_steps(768), rounds=1, stage={"count": 84}, verify={"share": 1.0})
    run = sweep(case, coarse_rom).isel(speed_over_f1=0)
    assert run["status"] == "ok" and run["error"].max() < 0.1


def test_steps_are_short_enough_for_the_longest_and_the_fastest_blade(coarse_rom):
    """Where the others do not touch, too."""
    apart = [{"order": 2, "amplitude_gaps": 0.7}]
    case = rubbing(casing__harmonics=apart, integrator=of_steps(320))
    setup = set_up(case, coarse_rom)
    check_resolution(setup, 64, halves=False)  # does not touch
    long = case.but(stage={"count": 2, "longer_um": [0, 4.0]})
    fast = case.but(stage={"count": 2, "longer_um": [0, 4.0], "frequencies": [0, 0.3]})
    least = [
        refused(
            SceneError, check_resolution, set_up(of, coarse_rom), 64, False,
            match="the first mode has .* steps in a period",
        ).allowed["ge"]
        for of in (long, fast)
    ]  # fmt: skip
    assert least[1] == pytest.approx(1.3 * least[0], abs=64)


def test_energies_of_each_blade_are_judged(coarse_rom):
    case = rubbing(rounds=2, stage={"count": 2, "longer_um": [0, -3.0]})
    outcome = marched(case, coarse_rom)
    assert judged(outcome).status == "ok"
    facts = outcome.blades[1].facts
    losing = replace(facts, ledger=replace(facts.ledger, work=-facts.ledger.casing))
    blades = [outcome.blades[0], replace(outcome.blades[1], facts=losing)]
    found = judged(replace(outcome, blades=blades))
    assert found.status == "inaccurate"
    assert [blade.status for blade in found.blades] == ["ok", "inaccurate"]
    assert outcome.blades[0].wear is outcome.blades[1].wear  # one liner


def test_torque_and_wear_per_pass_are_of_all_blades(coarse_rom):
    case = rubbing(rounds=3, stage={"count": 3} | THREE)
    outcome = marched(case, coarse_rom)
    work = sum(blade.casing_work for blade in outcome.blades)
    torque = torque_of_rounds(case, coarse_rom, outcome)
    np.testing.assert_allclose(torque, work / (2 * np.pi), rtol=1e-12)
    assert work.sum() == pytest.approx(outcome.ledger.casing, rel=1e-12)


def test_lengths_and_frequencies_are_lists_files_or_draws(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "longer.csv").write_text("longer_mm\n0.01\n0\n-0.005\n")
    (tmp_path / "f.csv").write_text("frequencies\n0.01\n0\n-0.02\n")
    of_file = Stage(count=3, longer_um="longer.csv", frequencies="f.csv")
    np.testing.assert_allclose(of_file.longer(1.0), [1e-5, 0, -5e-6])
    assert of_file.relative.tolist() == [0.01, 0.0, -0.02]
    drawn = Stage(count=4000 // 10, longer_um=Lengths(std_gaps=0.125, seed=2),
                  frequencies=Frequencies(std=0.01, seed=2))  # fmt: skip
    assert drawn.longer(8e-5).std() == pytest.approx(1e-5, rel=0.1)
    assert drawn.relative.std() == pytest.approx(0.01, rel=0.1)
    assert abs(np.corrcoef(drawn.longer(1.0), drawn.relative)[0, 1]) < 0.15
    again = drawn.model_copy(update={"longer_um": Lengths(std_um=10.0, seed=2)})
    np.testing.assert_allclose(again.longer(1.0), drawn.longer(8e-5), rtol=1e-12)
    other = drawn.model_copy(update={"longer_um": Lengths(std_um=10.0, seed=3)})
    assert not np.allclose(other.longer(1.0), again.longer(1.0))


@pytest.mark.parametrize(
    ("stage", "says"),
    [
        ({"count": 0}, "stage.count"),
        ({"count": 3, "longer_um": [0, 1]}, "stage.longer_um: 2 values for 3 blades"),
        ({"count": 2, "frequencies": [0, 1]}, "stage.frequencies"),
        ({"count": 2, "frequencies": {"std": 1.0, "seed": 1}}, "1 % is 0.01"),
        ({"count": 2, "longer_um": {"std_um": 1.0}}, "stage.longer_um.*seed"),
        ({"count": 2, "longer_um": {"std_um": 1.0, "std_gaps": 0.1, "seed": 1}}, "stage.longer_um"),
        ({"count": 2, "longer_um": "none.csv"}, "none.csv"),
    ],
)
def test_a_stage_that_is_none_is_refused(stage, says):
    refused(SettingsError, rubbing, stage=stage, match=says)


def test_a_stage_that_does_not_fit_is_refused(coarse_rom):
    gap = rubbing(stage={"count": 2, "longer_um": [0, 500.0]})
    for check in (check_scene, set_up):
        refused(
            SceneError, check, gap, coarse_rom,
            match="stage.longer_um: blade 1 is longer by 500 um, the smallest gap",
        )  # fmt: skip
    crowded = rubbing(stage={"count": 200})
    refused(SceneError, set_up, crowded, coarse_rom, match="stage.count: 200")
    for blades in ([0], "all"):
        refused(SettingsError, rubbing, record__blades=blades, match="record.blades.*give stage")
    stage = {"count": 3}
    refused(
        SettingsError,
        rubbing,
        record__blades=[0, 3],
        stage=stage,
        match="record.blades.*blade 3 of 3",
    )


def test_the_cost_of_a_stage_is_told(coarse_rom):
    one, many = (cost(case, coarse_rom) for case in (rubbing(), rubbing(stage={"count": 8})))
    assert many.all_steps == 8 * one.all_steps and many.seconds == pytest.approx(8 * one.seconds)
    assert one.memory < many.memory


def test_a_history_has_directions_and_force(coarse_rom):
    """Displacements of the model's rows, the impulse of the forces, the wear of each revolution."""
    chord = [0.0625, 0.5]
    history = {"chord": chord, "directions": "rt", "force": True}
    case = rubbing(rounds=3, record__history=history, record__wear_by_round=True,
                   record__states_rounds=3)  # fmt: skip
    run = sweep(case, coarse_rom).isel(speed_over_f1=0)
    assert run["direction"].values.tolist() == ["r", "t"]
    for i, direction in enumerate("rt"):
        rows = coarse_rom.rows(np.array(chord), direction)
        expected = rows @ run["states"].values.T
        found = run["history_u"].values[i]
        np.testing.assert_allclose(found, expected, rtol=0, atol=1e-12 * abs(expected).max())
    np.testing.assert_allclose(run["history"], run["history_u"][0], rtol=0, atol=1e-18)
    mean = run["history_force"].values.reshape(2, 3, -1).mean(axis=2)
    np.testing.assert_allclose(mean, run["force_mean"].values[:, [0, 4]].T, rtol=1e-9)
    assert mean.max() > 1 and run["history_force"].max() > 2 * mean.max()
    np.testing.assert_allclose(
        run["wear_by_round"][-1], by_share(run["wear"].values, run["end"].values), rtol=1e-5
    )
    whole = run["wear_by_round"].sum(("share", "theta"))
    assert (np.diff(whole) > 0).all()
    assert case.directions == "rt" and rubbing().directions == "r"
    alone = replace(coarse_rom, directions=coarse_rom.directions[:1])
    refused(
        SceneError, check_scene, case, alone, match="record.history.directions: .rt.: .*rom-rt.nc"
    )
