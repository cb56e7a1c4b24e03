"""Which runs are checked: by response, risk, share and neighbours; what a sweep says of it."""

from dataclasses import replace
from math import inf
from types import SimpleNamespace

import numpy as np
import pytest
from scenes import of_steps, scene

from simulate import Runs
from simulate.contact.ledger import Ledger
from simulate.errors import checked as module
from simulate.errors.checked import checked
from simulate.errors.resolution import LEAST_LOST, LOST, PERIOD, risk
from simulate.errors.run import Run
from simulate.sweeps.dataset import checks
from simulate.sweeps.peak import Peak
from simulate.sweeps.peak_results import case_of
from simulate.sweeps.sweep import sweep

EXACT = of_steps(1280)


def run_of(speed, displacement=1.0, status="ok", steps=100.0):
    """A judged run of no spectrum, of so many steps."""
    record = SimpleNamespace(spectrum_rounds=None)
    each = SimpleNamespace(largest=(displacement, 1.0))
    outcome = SimpleNamespace(status=status, each=each, reason="", trend="steady", blades=())
    setup = SimpleNamespace(Omega=speed, h=1.0)
    return Run(SimpleNamespace(record=record), None, setup, outcome=outcome, steps=steps)


@pytest.fixture
def tried(monkeypatch):
    """Speeds in the order in which runs are checked; ``risks`` and runs ``wrong`` by speed."""

    def of(runs, risks, share, wrong=(), budget=0.0):
        order = []

        def judge(run, check):
            order.append(run.setup.Omega)
            status = "inaccurate" if run.setup.Omega in wrong else "ok"
            outcome = SimpleNamespace(**vars(run.outcome) | {"status": status})
            steps = run.steps * (8.5 if wrong else 1.5)
            return replace(run, outcome=outcome, errors={"wear": 0.0}, steps=steps)

        monkeypatch.setattr(module, "judged", judge)
        monkeypatch.setattr(module, "risk", lambda run: risks[run.setup.Omega])
        found, rest = checked(runs, share, budget)
        assert [run.setup.Omega for run in found] == sorted(risks)
        return order, rest

    return of


RISKS = {1: 0.1, 2: 0.5, 3: 0.3, 4: 0.2, 5: 0.4}


def test_the_largest_response_is_first_then_the_risk_within_the_share(tried):
    """Five runs of 100 steps, a check of 50 each; runs may come in any order."""
    runs = [run_of(speed, displacement=1.0 + (speed == 4)) for speed in (3, 1, 2, 5, 4)]
    assert tried(runs, RISKS, share=0.3) == ([4, 2, 5], 0.0)
    assert tried(runs, RISKS, share=0.5) == ([4, 2, 5, 3, 1], 0.0)
    assert tried(runs, RISKS, share=0.0) == ([], 0.0)


def test_a_run_that_stands_alone_is_checked_where_it_touches(tried):
    assert tried([run_of(1)], {1: 1e-9}, share=0.1) == ([1], -40.0)
    assert tried([run_of(1)], {1: 0.0}, share=0.1) == ([], 10.0)
    assert tried([run_of(1)], {1: 1e-9}, share=0.1, budget=-11.0) == ([], -1.0)
    assert tried([run_of(1)], {1: 0.0}, share=0.1, budget=40.0) == ([1], 0.0)
    two = [run_of(1), run_of(2)]
    assert tried(two, dict.fromkeys((1, 2), 1.0), share=0.1) == ([1], -30.0)


def test_beside_a_wrong_run_its_neighbours_are_checked_whatever_that_takes(tried):
    runs = [run_of(speed, displacement=1.0 + (speed == 2)) for speed in RISKS]
    order, budget = tried(runs, RISKS, share=0.1, wrong=(2, 3))
    assert order[0] == 2 and {*order} == {1, 2, 3, 4} and budget == 50 - 4 * 750


def test_runs_that_ended_early_are_not_checked(tried):
    runs = [run_of(1, status="diverged"), run_of(2), run_of(3, status="liner-exhausted")]
    assert tried(runs, {1: inf, 2: 1.0, 3: inf}, share=1.0)[0] == [2]


def alone(steps_a_period, lost, status="ok", contact=0.5, scheme="piecewise-exact"):
    """A run of which the facts for its risk are known."""
    outcome = SimpleNamespace(
        status=status, contact_share=contact, ledger=Ledger(1.0, 1.0 - lost, 0, 0, 0, 0, 0)
    )
    blade = SimpleNamespace(omega=np.array([2 * np.pi, 9e9]))
    setup = SimpleNamespace(blades=[blade], h=1 / steps_a_period)
    return Run(
        SimpleNamespace(stepping=SimpleNamespace(scheme=scheme)), None, setup, outcome=outcome
    )


@pytest.mark.parametrize("scheme", LOST)
def test_the_risk_is_one_where_both_facts_are_at_their_limits(scheme):
    limit = LOST[scheme]
    assert risk(alone(PERIOD, limit, scheme=scheme)) == pytest.approx(1)
    assert risk(alone(10 * PERIOD, limit, scheme=scheme)) == pytest.approx(0.1)
    assert risk(alone(PERIOD, limit / 16, scheme=scheme)) == pytest.approx(0.5)
    least = (LEAST_LOST / limit) ** 0.25
    assert risk(alone(PERIOD, 0.0, scheme=scheme)) == pytest.approx(least)


def test_the_risk_of_a_stopped_run_is_infinite_and_without_contact_there_is_none():
    assert risk(alone(1e6, 0.1, status="inaccurate")) == inf
    assert risk(alone(PERIOD, 0.0, contact=0.0)) == 0


SPEEDS = {"over_f1": {"first": 0.26, "last": 0.34, "count": 12}}


@pytest.fixture(scope="module")
def swept(coarse_rom):
    """A sweep of twelve speeds with the default share of checks, its lines, and that without."""
    lines = []
    case = scene(integrator=EXACT, speeds=SPEEDS, verify={"share": 0.1})
    return (
        sweep(case, coarse_rom, lines.append),
        lines,
        sweep(case.but(verify={"share": 0}), coarse_rom),
    )


def test_a_sweep_checks_two_of_twelve_speeds_and_says_so(swept, coarse_rom):
    """The one with the largest amplitude, and that of the largest risk: 8.3 % more steps."""
    runs, lines, alone = swept
    known = np.isfinite(runs.error.max("observable").values)
    assert known.sum() == 2 and known[runs.spectrum[:, 1:].max("engine_order").values.argmax()]
    assert lines[-1] == checks(runs) == str(Runs(runs, coarse_rom)).splitlines()[2]
    assert lines[-1].startswith("checked at 2 of 12 speeds; largest error 0.0")
    assert sum("; checked, error 0.0" in line for line in lines) == 2
    assert np.isnan(runs.departure).all() and checks(alone) == "checked at 0 of 12 speeds"


def test_checks_change_no_number_of_a_right_run(swept):
    runs, _, alone = swept
    assert (runs.status == "ok").all()
    for name in ("wear", "spectrum", "history", "force_peak", "ledger", "steps_per_round"):
        np.testing.assert_array_equal(runs[name].values, alone[name].values)


def test_a_sweep_whose_step_is_too_long_is_mended(coarse_rom):
    """Alone nearly all runs are stopped for their energy; beside those found out all are checked.

    Some are right, others are mended by an eighth of the step.
    """
    stiff = {"kind": "plastic", "E": 100.0, "K": 45.0, "sigma_Y": 1e-8, "unit_MPa": 2000}
    case = scene(integrator=EXACT, speeds=SPEEDS, rounds=3, liner__law=stiff)
    case = case.but(liner__rods_per_round=2039)
    plain, runs = (sweep(case.but(verify={"share": share}), coarse_rom) for share in (0, 0.1))
    fine = sweep(case.but(integrator=of_steps(16 * 1280)), coarse_rom)
    assert (plain.status == "inaccurate").sum() >= 10 and (runs.status == "ok").sum() >= 8
    mended = np.flatnonzero(runs.steps_per_round > 1280)
    assert len(mended) >= 2 and np.isfinite(runs.error).all()
    for index in np.flatnonzero(runs.status == "ok"):
        near, far, exact = (of.history.values[index] for of in (runs, plain, fine))
        apart = [np.linalg.norm(of - exact) / np.linalg.norm(exact) for of in (near, far)]
        assert apart[0] < 0.5 * apart[1] or index not in mended
        assert apart[0] < runs.error.sel(observable="history").values[index] < 0.1
    assert case_of(runs, case, coarse_rom, Peak(None, mended[0], 0.3)).setup.steps == 8 * 1280


@pytest.mark.parametrize(
    ("changes", "share"),
    [
        ({}, 0.1),
        ({"verify": {"share": 0.3}}, 0.3),
        ({"verify": "peaks"}, 0.0),
        ({"verify": "every"}, 0.0),
        ({"start": {"scene": "before"}}, 0.0),
        ({"speeds": {"over_f1": [0.3], "in_turn": True}}, 0.0),
        ({"record": {"samples_per_round": 64, "wear": False}}, 0.0),
    ],
)
def test_the_share_is_none_where_second_runs_cannot_be_compared(changes, share):
    case = scene(**{"integrator": EXACT, "verify": {"share": 0.1}} | changes)
    assert case.checked_share == share
