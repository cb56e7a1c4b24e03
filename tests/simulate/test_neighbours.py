"""Second runs: differences in closed form; twins; half and a quarter of the step; statuses."""

from dataclasses import replace
from math import hypot, inf, isnan, nan, sqrt

import numpy as np
import pytest
from refused import refused
from runs import made, set_up, swept
from scenes import SCHEMES, of_steps, scene

from geometry.base import SettingsError
from simulate.contact.ledger import Ledger
from simulate.errors.neighbours import EIGHTH, HALF, QUARTER, TWIN, from_shorter, judged, shifted
from simulate.errors.observables import differences, distance, observables
from simulate.errors.resolution import footprints_passed
from simulate.errors.run import Case, Run
from simulate.marching import SENSITIVE_FROM, Facts, Outcome, largest_state, prepare
from simulate.marching.kernel import ESCAPED, RUNNING, WORN_THROUGH
from simulate.marching.trend import Rounds
from simulate.sweeps.over_speeds import as_sweep, at_speeds
from simulate.sweeps.sweep import sweep

RECORD = {
    "samples_per_round": 64,
    "spectrum_rounds": 1,
    "states_rounds": 1,
    "contact_force": True,
    "history": {"chord": [0.0625, 0.3125]},
}
ALL = ["spectrum", "wear", "history", "force_peak", "states"]
STILL = Ledger(*[0.0] * 7)
LOSSY = Ledger(1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
FACTS = {  # of marches that end with a status
    "ok": Facts(RUNNING, STILL),
    "no-contact": Facts(RUNNING, STILL, untouched=True),
    "inaccurate": Facts(RUNNING, LOSSY),
    "diverged": Facts(ESCAPED, STILL),
    "liner-exhausted": Facts(WORN_THROUGH, STILL),
    "sensitive": Facts(RUNNING, STILL),
}
# at resonance, undamped, strips a thousand times stiffer than the paper's: it chatters
HARD = {
    "rounds": 5,
    "damping_ratio": 0.0,
    "liner__law__unit_MPa": 10000000,
    "liner__rods_per_round": 2039,  # with fewer, no step returns what contact should
    "speeds": {"over_f1": [0.33]},
}


def outcome(scale=1.0, status="ok", **changes):
    """A run of two rounds, three places, eight strips, four rods and five DoFs.

    All values are proportional to ``scale``; the first place is that of the spectrum.
    """
    angle = 2 * np.pi * np.arange(1, 129) / 64
    wave = scale * np.stack([3 * np.cos(4 * angle), angle, 2 * np.sin(angle)], axis=1)
    run = Outcome(
        status=status,
        rounds=2.0,
        xi=nan,
        theta=nan,
        facts=FACTS[status],
        u_r=wave,
        states=np.full((64, 5), scale),
        ends=np.linspace(0, 1, 9),
        wear=np.full((8, 4), scale),
        force_peak=np.full((2, 8), scale),
        force_mean=np.full((2, 8), scale),
        force_tangential_mean=np.zeros((2, 8)),
        casing_work=np.zeros(2),
        contact_share=0.5,
        each=Rounds(scale * np.array([[-3.0, 3.0]] * 2), scale * np.arange(3)),
        gauges=np.empty((0, 0)),
    )
    return replace(run, **changes)


def parting(run, other, **record):
    asked = scene(record=RECORD | record).record
    return differences(made(asked, run), made(asked, other))


@pytest.mark.parametrize(
    ("one", "other", "apart"),
    [(1.0, 1.0, 0), (0.0, 0.0, 0), (1.0, 1.2, 1 / 6), (1.2, 1.0, 1 / 6), (0.0, 1.0, 1)],
)
def test_values_larger_by_a_fifth_differ_by_a_sixth(one, other, apart):
    """The larger of the two counts: twins may be exchanged. Sensitive runs are compared alike."""
    expected = pytest.approx(dict.fromkeys(ALL, apart), rel=1e-12)
    assert parting(outcome(one), outcome(other)) == expected
    assert parting(outcome(one), outcome(other, status="sensitive")) == expected


def test_what_is_less_than_the_least_is_hardly_a_distance():
    assert distance(np.array([1e-12]), np.array([2e-12]), least=1e-9) == pytest.approx(1e-3)


def changed(name, place, by):
    """A run with some of the values of one of its arrays changed."""
    values = getattr(outcome(), name).copy()
    values[place] += by
    return outcome(**{name: values})


WAVE = outcome().u_r
SQUARE = (WAVE[:, 1:] ** 2).sum(axis=0)
SEVENTH = 0.3 * np.cos(2 * np.pi * 7 * np.arange(1, 129) / 64)
OFF = {  # run, and what of it differs by how much
    "wear of a rod": (changed("wear", (1, 2), 1), {"wear": 1 / sqrt(32 + 3)}),
    "a peak of the force": (
        changed("force_peak", (1, 2), 1),
        {"force_peak": 1 / sqrt(16 + 3)},
    ),
    "a place of the history": (
        changed("u_r", np.s_[:, 1], -WAVE[:, 1]),
        {"history": sqrt(SQUARE[0] / SQUARE.sum())},
    ),
    # of the first place; the mean is summed over 64 numbers of order 5: round-off of 1e-15
    "the mean of the spectrum": (changed("u_r", np.s_[:, 0], 5.0), {}),
    "before the spectrum": (changed("u_r", np.s_[:64, 0], -WAVE[:64, 0]), {}),
    "the spectrum": (changed("u_r", np.s_[:, 0], SEVENTH), {"spectrum": 0.3 / hypot(3, 0.3)}),
}


@pytest.mark.parametrize("name", OFF)
def test_each_observable_differs_independently(name):
    """The spectrum is of the first place in the last rounds, and leaves out its mean."""
    run, apart = OFF[name]
    expected = dict.fromkeys(ALL, 0.0) | apart
    assert parting(outcome(), run) == pytest.approx(expected, rel=1e-12, abs=1e-14)


def test_a_longer_spectrum_sees_the_rounds_before():
    early, _ = OFF["before the spectrum"]
    assert parting(outcome(), early, spectrum_rounds=2)["spectrum"] > 0.4


def test_wear_is_compared_by_its_means_over_eighths_of_the_chord():
    """Runs on other strips are equal if these means are."""
    worn = np.random.default_rng(6).uniform(0, 1, (8, 4))
    finer = outcome(wear=np.repeat(worn, 2, axis=0), ends=np.linspace(0, 1, 17))
    assert parting(outcome(wear=worn), finer)["wear"] < 1e-15
    uneven = finer.wear + np.tile([0.1, -0.1], 8)[:, None]  # of no share's mean
    assert parting(outcome(wear=worn), replace(finer, wear=uneven))["wear"] < 1e-15
    fewer = outcome(wear=np.full((4, 4), 1.2), ends=np.linspace(0, 1, 5))
    assert parting(outcome(), fewer)["wear"] == pytest.approx(1 / 6, rel=1e-12)


def test_the_difference_of_runs_that_end_differently_is_infinite():
    ended = outcome(status="liner-exhausted")
    assert parting(outcome(), ended) == parting(ended, outcome()) == dict.fromkeys(ALL, inf)
    assert all(isnan(value) for value in parting(ended, ended).values())


def test_only_what_is_recorded_is_compared():
    lean = {"samples_per_round": 64, "wear": False, "history": {"chord": [0.0625]}}
    run = made(scene(record=lean).record, outcome())
    assert [*differences(run, run)] == [*observables(run)] == ["history"]
    nothing = {"samples_per_round": 64, "wear": False}
    assert (
        refused(SettingsError, scene, verify={"predictable": True}, record=nothing).key == "verify"
    )


def test_a_twin_differs_in_its_gaps_alone(coarse_rom):
    setup = prepare(scene(), coarse_rom, 500.0)
    other = shifted(setup)
    widest = max(setup.strips.g0.max(), setup.strips.d.max())
    np.testing.assert_allclose(other.strips.g0 - setup.strips.g0, 1e-10 * widest, rtol=1e-5)
    no_gap = replace(setup, strips=setup.strips._replace(g0=np.zeros(8)))
    assert shifted(no_gap).strips.g0.min() > 0
    assert replace(other, strips=setup.strips) == setup
    for name in set(setup.strips._fields) - {"g0"}:
        assert getattr(other.strips, name) is getattr(setup.strips, name)


@pytest.fixture(scope="module")
def hard(coarse_rom):
    """A sweep on strips that are hard, and the scene, which asks for twins."""
    case = scene(**HARD, integrator__fraction_of_limit=0.1, verify__predictable=True, record=RECORD)
    return case, swept(case, coarse_rom)


def test_hard_contact_is_sensitive_whatever_the_step(coarse_rom, hard):
    """Not because of the step, at and above resonance; sensitive runs have results.

    The wear differs by 5 % or more at 0.8, 0.4, 0.2 and 0.1 of the limit.
    """
    _, runs = hard
    assert set(runs.status.values) == {"sensitive"}
    assert runs.departure.sel(observable="wear").min() > 3 * SENSITIVE_FROM
    assert np.isfinite(runs.spectrum).all() and runs.spectrum.max() > 0
    assert largest_state(runs)[1] > 0
    coarser = scene(**HARD, record=RECORD, integrator__fraction_of_limit=0.4)
    setup = set_up(coarser, coarse_rom, 0.335)
    coarser = coarser.but(verify={"predictable": True})
    found = judged(Case(coarser, coarse_rom, setup).march())
    assert found.outcome.status == "sensitive" and found.departures["wear"] > 3 * SENSITIVE_FROM


def test_a_calm_run_is_predictable(coarse_rom):
    """The change by 1e-10 of the gap becomes 4e-10 at most (measured)."""
    speeds = {"over_f1": [0.29, 0.3]}
    calm = swept(
        scene(verify__predictable=True, rounds=3, record=RECORD, speeds=speeds), coarse_rom
    )
    assert list(calm.status.values) == ["ok", "ok"]
    assert [*calm.observable.values] == ALL
    assert calm.departure.min() > 1e-12 and calm.departure.max() < 1e-8


def test_a_twin_changes_nothing_but_the_status(coarse_rom, hard):
    case, runs = hard
    alone = as_sweep(
        at_speeds(case.but(verify={"predictable": False}), coarse_rom, runs.speed.values)
    )
    assert "departure" not in alone and "observable" not in alone.coords
    assert set(alone.status.values) == {"ok"}
    for name in ("wear", "spectrum", "history", "states", "force_peak"):
        np.testing.assert_array_equal(alone[name].values, runs[name].values)


EXACT = of_steps(1280)


def exact(**changes):
    return scene(**{"integrator": EXACT, "record": RECORD} | changes)


@pytest.fixture
def beside(coarse_rom, monkeypatch):
    """Judge a run beside others that are given by name instead of marched; the steps it takes."""

    def decided(run, others, check=False, **changes):
        case = exact(**changes)
        setup = prepare(case, coarse_rom, 500.0)
        given = dict(others)

        def march(of):
            return Run(**vars(of) | {"setup": setup}, outcome=given.pop(of.setup.name))

        monkeypatch.setattr(Case, "neighbour", lambda of, other: replace(of, setup=other))
        monkeypatch.setattr(Run, "neighbour", lambda of, other: Case(of.scene, of.rom, other))
        monkeypatch.setattr(Case, "march", march)
        found = judged(Run(case, coarse_rom, setup, outcome=run), check=check)
        assert not given, "not marched"
        assert found.steps == 2 * setup.steps * (1 + len(others))
        return found

    return decided


def of_order(order, error):
    """Runs with h to h/8 whose values are too small by errors that fall with the order."""
    return [outcome(1 - error / 2 ** (order * halvings)) for halvings in range(4)]


@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize("error", [0.02, 0.04, 0.055])
def test_three_runs_bound_the_error_by_little_more(order, error):
    """By a third for order one, by two thirds for order two. Changes are over the finest run.

    As does a fourth, of an eighth of the step: changes fall.
    """
    case = exact()
    runs = [made(case.record, run, stepping=case.stepping) for run in of_order(order, error)]
    *_, found = from_shorter(*runs[:3])
    assert error <= found <= {1: 1.34, 2: 1.67}[order] * error
    before = differences(runs[1], runs[2])
    *_, found = from_shorter(runs[0], *runs[2:], before)
    assert error <= found <= {1: 1.34, 2: 1.67}[order] * error


def at_bound(bound, third=None):
    """Runs of which half the step gives this bound, less of it a run with other values."""
    half = outcome(1 / (1 - bound / 3))
    return [outcome(), half] + ([outcome(third)] * 2 if third else [])


UNTOUCHED = outcome(0.0, status="no-contact", contact_share=0.0, reason="why")
CENTRAL = {"integrator": SCHEMES["central-difference"]}
FAILED = outcome(status="diverged")
SHORT = outcome(0.0, contact_share=0.01)  # a contact that UNTOUCHED misses
JUDGED = {  # runs with h, h/2 and, where one is needed, h/4, h/8; the status, and its largest bound
    "below a fifth of 0.1": (at_bound(0.018), "ok", 0.018),
    "in doubt": (at_bound(0.022, 1 / (1 - 0.022 / 3)), "ok", 1.5 * 0.022 / 3),
    "in doubt, far above 0.1": (at_bound(0.9, 1 / (1 - 0.05)), "ok", 1.5 * 0.05),
    "less than a tenth": (of_order(1, 0.074), "ok", 1.5 * 0.06475 / 0.99075),
    # changes that fall, then grow: long steps agree before they resolve the fast modes
    "a plateau": (
        [outcome(), outcome(1.28), outcome(1.31), outcome(1.42)],
        "inaccurate",
        0.42 / 1.42 + 3 * 0.11 / 1.42,
    ),
    # half the step changes 2.6 %, a quarter 17 % more: a case of the stability study
    "no convergence": ([outcome(), outcome(1.026), outcome(1.2)], "inaccurate", 1.75 * 0.2 / 1.2),
    "the third failed": ([outcome(), outcome(1.026), FAILED], "inaccurate", inf),
    "the second ends early": (
        [outcome(), outcome(status="liner-exhausted"), outcome()],
        "inaccurate",
        inf,
    ),
    # the same values from a contact that was a step long in both: half the share
    "as many steps in contact": ([outcome(), outcome(contact_share=0.5)], "ok", 0),
    "fewer": ([outcome(), outcome(contact_share=0.4)], "ok", 0),
    "more": ([outcome(), outcome(contact_share=0.63)], "ok", 0),
    "ever fewer": (
        [outcome(), *(outcome(contact_share=of) for of in (0.37, 0.2))],
        "inaccurate",
        0,
    ),
    "ever more": (
        [outcome(), *(outcome(contact_share=of) for of in (0.68, 1.0))],
        "inaccurate",
        0,
    ),
    "chatter": ([outcome(), outcome(contact_share=0.2)], "ok", 0, CENTRAL),
    "no contact in one": ([UNTOUCHED, SHORT, UNTOUCHED], "inaccurate", 0),
    "no contact in both": ([UNTOUCHED, UNTOUCHED], "no-contact", 0),
    "sensitive": ([outcome(), outcome(1 / (1 - 0.055 / 3))], "sensitive", 0.055),
    "diverged": ([FAILED], "diverged", None),  # nothing to compare
}
CONVERGED = {  # runs with h to h/8, of which the last is the result; its bound
    "a tenth, order one": (of_order(1, 0.1), 2 * 0.0125 / 0.9875),
    "far too long a step": (
        [outcome(), outcome(2.0), outcome(2.1), outcome(2.15)],
        2 * 0.05 / 2.15,
    ),
    "only at h contact is missed": ([UNTOUCHED, *[outcome()] * 3], 0.0),
    "only h fails": (
        [outcome(status="inaccurate"), outcome(), outcome(1.05), outcome(1.06)],
        2 * 0.01 / 1.06,
    ),
    "only h sees another contact": ([outcome(contact_share=0.2), *[outcome()] * 3], 0.0),
}


def named(runs):
    """The run, and those beside it by their names."""
    run, *finer_ones = runs
    return run, dict(zip((HALF.name, QUARTER.name, EIGHTH.name), finer_ones, strict=False))


@pytest.mark.parametrize("case", JUDGED)
def test_a_run_is_judged_beside_half_and_in_doubt_less_of_its_step(beside, case):
    """Inaccurate from a bound of a tenth, where contacts are not alike, or runs end differently.

    A quarter of the step is marched where the bound by half of it is above 0.02, an eighth where
    the quarter lets it through. A reason goes with its status.
    """
    runs, status, bound, *changes = JUDGED[case]
    run, others = named(runs)
    others |= {TWIN.name: outcome(2.0) if status == "sensitive" else run}
    found = beside(run, others, verify="every", **dict(*changes))
    assert found.outcome.status == status
    assert found.errors == pytest.approx(dict.fromkeys(ALL if runs[1:] else [], bound), rel=1e-9)
    assert found.outcome.reason == ("why" if status == "no-contact" else "")


@pytest.mark.parametrize("case", CONVERGED)
def test_the_result_is_that_of_the_shortest_step_where_it_converges_alone(beside, case):
    runs, bound = CONVERGED[case]
    run, others = named(runs)
    found = beside(run, others | {TWIN.name: run}, verify="every")
    assert found.outcome.status == "ok" and found.outcome.u_r is runs[3].u_r
    assert found.errors == pytest.approx(dict.fromkeys(ALL, bound), rel=1e-9, abs=1e-12)


TWICE = "twice the step"
CHECKED = {  # others beside a run of values 1: status, largest bound, values of the result
    "twice the step is enough": ({TWICE: 0.97}, "ok", 1.5 * 0.03, 1.0),
    "half is needed": ({TWICE: 0.9, HALF: 1.0}, "ok", 0.0, 1.0),
    "not predictable": ({TWICE: 0.9, TWIN: 1.1, HALF: 1.1}, "sensitive", 3 * 0.1 / 1.1, 1.0),
    "wrong": (
        {TWICE: 0.9, TWIN: 1.0, HALF: 1.5, QUARTER: 2.0},
        "inaccurate",
        1.75 / 2,
        1.0,
    ),
    "mended": (
        {TWICE: 0.9, TWIN: 1.0, HALF: 1.5, QUARTER: 1.5, EIGHTH: 1.5},
        "ok",
        0.0,
        1.5,
    ),
    "a quarter is enough": (
        {TWICE: 0.9, TWIN: 1.0, HALF: 1.03, QUARTER: 1.04},
        "ok",
        0.07 / 1.04,
        1,
    ),
    "changes that grow": (  # within a tenth by the change to a quarter
        {TWICE: 0.94, TWIN: 1.0, HALF: 1.012, QUARTER: 1.055, EIGHTH: 1.15},
        "inaccurate",
        (0.15 + 3 * 0.095) / 1.15,
        1,
    ),
}


@pytest.mark.parametrize("case", CHECKED)
def test_a_check_takes_shorter_steps_and_a_twin_only_in_doubt(beside, case):
    scales, status, bound, result = CHECKED[case]
    others = {getattr(of, "name", of): outcome(scale) for of, scale in scales.items()}
    found = beside(outcome(), others, check=True)
    assert found.outcome.status == status
    assert max(found.errors.values()) == pytest.approx(bound, rel=1e-9, abs=1e-12)
    np.testing.assert_array_equal(found.outcome.wear, result)


@pytest.mark.parametrize("asked", [{"check": True}, {"verify": "every"}])
def test_steps_that_pass_more_than_a_footprint_are_no_proof_though_two_agree(beside, asked):
    """1.2 footprints: neither twice nor half the step decides, but a quarter of it."""
    of = {"integrator": of_steps(576)}
    others = {HALF.name: outcome(), QUARTER.name: outcome(1.2), TWIN.name: outcome()}
    found = beside(outcome(), others, **of, **asked)
    assert footprints_passed(found.setup) == pytest.approx(1.23, abs=0.01)
    assert found.outcome.status == "inaccurate"


def test_a_scene_asks_for_it_and_the_sweep_has_the_errors(coarse_rom):
    """Against a run eight times finer the error is within its bound, and not a tenth of it."""
    case = exact(liner__rods_per_round=4096)  # one more changes less than the step
    alone = sweep(case, coarse_rom)
    runs = sweep(case.but(verify="every"), coarse_rom)
    assert runs.status.item() == "ok" and "error" not in alone
    assert runs.observable.values.tolist() == ALL
    assert "twice to an eighth of the step" in runs.error.attrs["long_name"]
    for name in ("wear", "spectrum", "history", "ledger"):
        np.testing.assert_array_equal(runs[name].values, alone[name].values)
    fine = sweep(case.but(integrator={"steps_per_round": 8 * 1280}), coarse_rom)
    for name in ("wear", "history"):
        of = (runs[name].values - fine[name].values).ravel()
        error = np.linalg.norm(of) / np.linalg.norm(fine[name].values.ravel())
        bound = runs.error.sel(observable=name).item()
        assert error < bound < 10 * error


def test_twin_and_half_step_go_together(coarse_rom):
    wear = sweep(exact(verify="every"), coarse_rom).sel(observable="wear")
    assert np.isfinite(wear.error).all() and np.isfinite(wear.departure).all()


@pytest.mark.parametrize(
    "changes",
    [
        {"record": {"samples_per_round": 64, "wear": False}},
        {"start": {"scene": "before"}},
        {"speeds": {"over_f1": [0.3], "in_turn": True}},
    ],
)
def test_it_is_refused_where_there_is_nothing_to_halve(changes):
    assert refused(SettingsError, scene, verify="every", **changes).key == "verify"
