"""Twin runs: differences in closed form, and runs that are and are not predictable."""

from dataclasses import replace
from math import hypot, inf, isnan, nan, sqrt

import numpy as np
import pytest
from refused import refused
from runs import set_up, swept
from scenes import scene

from geometry.project import SettingsError
from simulate.contact.ledger import Ledger
from simulate.errors.neighbours import Case, judged, shifted
from simulate.errors.observables import Run, differences, distance
from simulate.marching.kernel import ESCAPED, RUNNING, WORN_THROUGH
from simulate.marching.run import Outcome, march
from simulate.marching.setup import prepare
from simulate.marching.states import largest_state
from simulate.marching.status import SENSITIVE_FROM, Facts
from simulate.sweeps.over_speeds import at_speeds

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
    "no-contact": Facts(RUNNING, STILL, at_rest=True),
    "inaccurate": Facts(RUNNING, LOSSY),
    "diverged": Facts(ESCAPED, STILL),
    "liner-exhausted": Facts(WORN_THROUGH, STILL),
    "sensitive": Facts(RUNNING, STILL),
}
# at resonance, undamped, strips a thousand times stiffer than the paper's: it chatters
HARD = {
    "rounds": 5,
    "damping_ratio": 0.0,
    "liner__law__unit_Pa": 1e13,
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
    )
    return replace(run, **changes)


def parting(run, other, **record):
    asked = scene(record=RECORD | record).record
    return differences(Run(asked, run), Run(asked, other))


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
    run = Run(scene(record=lean).record, outcome())
    assert [*differences(run, run)] == ["history"]
    nothing = {"samples_per_round": 64, "wear": False}
    assert refused(SettingsError, scene, twin=True, record=nothing).key == "twin"


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
    case = scene(**HARD, integrator__fraction_of_limit=0.1, twin=True, record=RECORD)
    return case, swept(case, coarse_rom)


def test_hard_contact_is_sensitive_whatever_the_step(coarse_rom, hard):
    """Not because of the step, at and above resonance; sensitive runs have results.

    The wear differs by 5 % or more at 0.8, 0.4, 0.2 and 0.1 of the limit.
    """
    _, runs = hard
    assert set(runs.status.values) == {"sensitive"}
    assert runs.departure.sel(observable="wear").min() > 3 * SENSITIVE_FROM
    assert np.isfinite(runs.spectrum).all() and runs.spectrum.max() > 0
    state = largest_state(runs)
    assert state.status == state.numbers()["status"] == "sensitive"
    coarser = scene(**HARD, record=RECORD, integrator__fraction_of_limit=0.4)
    setup = set_up(coarser, coarse_rom, 0.335)
    coarser = coarser.but(twin=True)
    found = judged(Case(coarser, coarse_rom, setup), march(coarser, setup))
    assert found.outcome.status == "sensitive" and found.departures["wear"] > 3 * SENSITIVE_FROM


def test_a_calm_run_is_predictable(coarse_rom):
    """The change by 1e-10 of the gap becomes 4e-10 at most (measured)."""
    speeds = {"over_f1": [0.29, 0.3]}
    calm = swept(scene(twin=True, rounds=3, record=RECORD, speeds=speeds), coarse_rom)
    assert list(calm.status.values) == ["ok", "ok"]
    assert [*calm.observable.values] == ALL
    assert calm.departure.min() > 1e-12 and calm.departure.max() < 1e-8


def test_a_twin_changes_nothing_but_the_status(coarse_rom, hard):
    case, runs = hard
    alone = at_speeds(case.model_copy(update={"twin": False}), coarse_rom, runs.speed.values)
    assert "departure" not in alone and "observable" not in alone.coords
    assert set(alone.status.values) == {"ok"}
    for name in ("wear", "spectrum", "history", "states", "force_peak"):
        np.testing.assert_array_equal(alone[name].values, runs[name].values)
