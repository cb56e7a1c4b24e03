"""Twin runs: differences in closed form, and runs that are and are not predictable."""

from dataclasses import replace
from math import inf, isnan, nan, sqrt

import numpy as np
import pytest
from refused import refused
from scenes import scene

from geometry.settings import SettingsError
from simulate.compare import Run, departures
from simulate.dataset import load, merge, save
from simulate.ledger import Ledger
from simulate.over_speeds import at_speeds, block_speeds
from simulate.run import Outcome, march
from simulate.setup import prepare
from simulate.states import largest_state
from simulate.twin import SENSITIVE_FROM, beside_twin, twin

RECORD = {
    "samples_per_round": 64,
    "spectrum_rounds": 1,
    "states_rounds": 1,
    "contact_force": True,
    "history": {"chord": [0.0625, 0.3125]},
}
ALL = ["spectrum", "wear", "history", "force_peak", "states"]
# at resonance, undamped, strips a thousand times stiffer than the paper's: it chatters
HARD = {
    "rounds": 5,
    "damping_ratio": 0.0,
    "liner__law__unit_Pa": 1e13,
    "liner__rods_per_round": 2039,  # with fewer, no step returns what contact should
    "speeds": {"over_f1": [0.33]},
}


def outcome(scale=1.0, **changes):
    """A run of two rounds, three places, eight strips, four rods and five DoFs.

    All values are proportional to ``scale``; the first place is that of the spectrum.
    """
    angle = 2 * np.pi * np.arange(1, 129) / 64
    wave = scale * np.stack([3 * np.cos(4 * angle), angle, 2 * np.sin(angle)], axis=1)
    run = Outcome(
        status="ok",
        rounds=2.0,
        xi=nan,
        theta=nan,
        ledger=Ledger(*[0.0] * 7),
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
    return departures(Run(asked, run), Run(asked, other))


def test_a_run_does_not_differ_from_itself():
    assert parting(outcome(), outcome()) == dict.fromkeys(ALL, 0.0)
    assert parting(outcome(0.0), outcome(0.0)) == dict.fromkeys(ALL, 0.0)


def test_values_larger_by_a_fifth_differ_by_a_sixth():
    """The larger of the two counts: twins may be exchanged."""
    for pair in ((outcome(), outcome(1.2)), (outcome(1.2), outcome())):
        assert parting(*pair) == pytest.approx(dict.fromkeys(ALL, 1 / 6), rel=1e-12)
    assert parting(outcome(0.0), outcome()) == dict.fromkeys(ALL, 1.0)


def test_each_observable_differs_independently():
    one = np.zeros((8, 4))
    one[1, 2] = 1
    assert parting(outcome(), outcome(wear=1 + one))["wear"] == pytest.approx(1 / sqrt(32 + 3))
    peaks = np.ones((2, 8))
    peaks[1, 2] = 2
    found = parting(outcome(), outcome(force_peak=peaks))
    assert found["force_peak"] == pytest.approx(1 / sqrt(16 + 3))
    assert [name for name, value in found.items() if value] == ["force_peak"]
    u_r = outcome().u_r.copy()
    u_r[:, 1] = 0  # of the history alone
    found = parting(outcome(), outcome(u_r=u_r))
    assert [name for name, value in found.items() if value] == ["history"]
    square = (outcome().u_r[:, 1:] ** 2).sum(axis=0)
    assert found["history"] == pytest.approx(sqrt(square[0] / square.sum()))


def test_wear_is_compared_by_its_means_over_eighths_of_the_chord():
    """Runs on other strips are equal if these means are."""
    worn = np.random.default_rng(6).uniform(0, 1, (8, 4))
    finer = outcome(wear=np.repeat(worn, 2, axis=0), ends=np.linspace(0, 1, 17))
    assert parting(outcome(wear=worn), finer)["wear"] < 1e-15
    uneven = finer.wear + np.tile([0.1, -0.1], 8)[:, None]  # of no share's mean
    assert parting(outcome(wear=worn), replace(finer, wear=uneven))["wear"] < 1e-15
    fewer = outcome(wear=np.full((4, 4), 1.2), ends=np.linspace(0, 1, 5))
    assert parting(outcome(), fewer)["wear"] == pytest.approx(1 / 6, rel=1e-12)


def test_the_spectrum_is_of_the_first_place_in_the_last_rounds_and_leaves_out_its_mean():
    u_r = outcome().u_r
    shifted, early, faster = u_r.copy(), u_r.copy(), u_r.copy()
    shifted[:, 0] += 5.0
    early[:64, 0] = 0.0
    faster[:, 0] += 0.3 * np.cos(2 * np.pi * 7 * np.arange(1, 129) / 64)
    base = outcome()
    # the mean is summed over 64 numbers of order 5: round-off of 1e-15
    assert parting(base, outcome(u_r=shifted))["spectrum"] < 1e-14
    assert parting(base, outcome(u_r=early))["spectrum"] == 0
    assert parting(base, outcome(u_r=early), spectrum_rounds=2)["spectrum"] > 0.4
    assert parting(base, outcome(u_r=faster))["spectrum"] == pytest.approx(0.1, rel=1e-12)


def test_the_difference_of_runs_that_end_differently_is_infinite():
    ended = outcome(status="liner-exhausted")
    assert parting(outcome(), ended) == parting(ended, outcome()) == dict.fromkeys(ALL, inf)
    assert all(isnan(value) for value in parting(ended, ended).values())


def test_a_sensitive_run_is_compared_by_its_values():
    assert parting(outcome(), outcome(status="sensitive")) == dict.fromkeys(ALL, 0.0)


def test_only_what_is_recorded_is_compared():
    lean = {"samples_per_round": 64, "wear": False, "history": {"chord": [0.0625]}}
    run = Run(scene(record=lean).record, outcome())
    assert [*departures(run, run)] == ["history"]
    nothing = {"samples_per_round": 64, "wear": False}
    assert refused(SettingsError, scene, twin=True, record=nothing).key == "twin"


def test_a_twin_differs_in_its_gaps_alone(coarse_rom):
    setup = prepare(scene(), coarse_rom, 500.0)
    other = twin(setup)
    widest = max(setup.strips.g0.max(), setup.strips.d.max())
    np.testing.assert_allclose(other.strips.g0 - setup.strips.g0, 1e-10 * widest, rtol=1e-5)
    no_gap = replace(setup, strips=setup.strips._replace(g0=np.zeros(8)))
    assert twin(no_gap).strips.g0.min() > 0
    assert replace(other, strips=setup.strips) == setup
    for name in set(setup.strips._fields) - {"g0"}:
        assert getattr(other.strips, name) is getattr(setup.strips, name)


@pytest.fixture(scope="module")
def hard(coarse_rom):
    """A sweep on strips that are hard, and the scene, which asks for twins."""
    case = scene(**HARD, integrator__fraction_of_limit=0.1, twin=True, record=RECORD)
    return case, at_speeds(case, coarse_rom, case.speeds.omega(coarse_rom.f1))


def test_hard_contact_is_sensitive_whatever_the_step(coarse_rom, hard):
    """Not because of the step, at and above resonance.

    The wear differs by 5 % or more at 0.8, 0.4, 0.2 and 0.1 of the limit.
    """
    _, swept = hard
    assert set(swept.status.values) == {"sensitive"}
    assert swept.departure.sel(observable="wear").min() > 3 * SENSITIVE_FROM
    coarser = scene(**HARD, record=RECORD, integrator__fraction_of_limit=0.4)
    setup = prepare(coarser, coarse_rom, 0.335 / 0.33 * float(swept.speed[0]))
    run, found = beside_twin(coarser, setup, march(coarser, setup))
    assert run.status == "sensitive" and found["wear"] > 3 * SENSITIVE_FROM


@pytest.fixture(scope="module")
def calm(coarse_rom):
    """Two speeds at which a run does not depend on round-off, and their scene."""
    case = scene(twin=True, rounds=3, record=RECORD, speeds={"over_f1": [0.29, 0.3]})
    return case, at_speeds(case, coarse_rom, case.speeds.omega(coarse_rom.f1))


def test_a_calm_run_is_predictable(calm):
    """The change by 1e-10 of the gap becomes 4e-10 at most (measured)."""
    _, calm = calm
    assert list(calm.status.values) == ["ok", "ok"]
    assert [*calm.observable.values] == ALL
    assert calm.departure.min() > 1e-12 and calm.departure.max() < 1e-8


def test_a_twin_changes_nothing_but_the_status(coarse_rom, hard):
    case, swept = hard
    alone = at_speeds(case.model_copy(update={"twin": False}), coarse_rom, swept.speed.values)
    assert "departure" not in alone and "observable" not in alone.coords
    assert set(alone.status.values) == {"ok"}
    for name in ("wear", "spectrum", "history", "states", "force_peak"):
        np.testing.assert_array_equal(alone[name].values, swept[name].values)


def test_sensitive_runs_have_results(hard):
    _, swept = hard
    assert np.isfinite(swept.spectrum).all() and swept.spectrum.max() > 0
    state = largest_state(swept)
    assert state.status == state.numbers()["status"] == "sensitive"


def test_blocks_with_departures_merge_into_the_sweep(coarse_rom, calm, tmp_path):
    case, swept = calm
    for block in range(2):
        part = at_speeds(case, coarse_rom, block_speeds(case, coarse_rom, block, 2))
        save(part, tmp_path / f"{block}.nc")
    merged = merge([load(tmp_path / f"{block}.nc") for block in (1, 0)])
    assert merged.departure.dims == ("speed_over_f1", "observable")
    assert merged.departure.attrs["units"] == "1"
    for name in ("speed_over_f1", "observable", "departure", "status"):
        np.testing.assert_array_equal(merged[name].values, swept[name].values)
