"""Half and a quarter of the step beside a run: bounds, steps in contact, the key of a scene."""

from math import inf

import numpy as np
import pytest
from refused import refused
from scenes import scene
from test_twin import RECORD, outcome

from geometry.settings import SettingsError
from simulate import halving
from simulate.halving import beside_halved, bounds, observables
from simulate.over_speeds import sweep

ALL = ["spectrum", "wear", "history", "states", "force_mean"]
EXACT = {"scheme": "piecewise-exact", "steps_per_round": 1280}


def exact(**changes):
    return scene(**{"integrator": EXACT, "record": RECORD} | changes)


@pytest.fixture
def beside(coarse_rom, monkeypatch):
    """Judge a run beside others that are given instead of marched: with h/2, and with h/4."""

    def judged(run, *finer_ones, **changes):
        given = dict(zip((2, 4), finer_ones, strict=False))
        monkeypatch.setattr(halving, "march", lambda _, times: given.pop(times))
        monkeypatch.setattr(halving, "finer", lambda *args: args[-1])
        judged = beside_halved(exact(halving=True, **changes), coarse_rom, None, run)
        assert not given, "not marched"
        return judged

    return judged


@pytest.mark.parametrize("integrator", [EXACT, None])
def test_the_bound_is_a_multiple_of_the_change(integrator):
    """Values larger by a fifth: a change of a sixth."""
    case = scene(record=RECORD) if integrator is None else exact()
    found = bounds(case, outcome(), outcome(1.2))
    assert found == pytest.approx(dict.fromkeys(ALL, 3.0 / 6), rel=1e-12)


def test_only_what_is_recorded_counts():
    lean = scene(record={"samples_per_round": 64, "wear": False, "contact_force": True}).record
    assert [*observables(lean, outcome())] == ["force_mean"]


def of_order(order, error):
    """Runs with h, h/2 and h/4 whose values are too small by errors that fall with the order."""
    return [outcome(1 - error / 2 ** (order * halvings)) for halvings in range(3)]


@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize("error", [0.02, 0.05, 0.09])
def test_three_runs_bound_the_error_by_little_more(order, error):
    """Order one: the error; two: an eighth more. Changes are over the finest run."""
    found = max(bounds(exact(), *of_order(order, error)).values())
    assert error <= found <= {1: 1.03, 2: 1.14}[order] * error


def test_a_quarter_of_the_step_is_marched_only_in_doubt(beside):
    """Where the bound by half the step is from a half of 0.1 to three times 0.1."""
    for bound, in_doubt in {0.045: False, 0.055: True, 0.29: True, 0.31: False}.items():
        half = outcome(1 / (1 - bound / 3))
        others = (half, half) if in_doubt else (half,)
        run, errors = beside(outcome(), *others)  # fails where another number is marched
        expected = bound / 3 if in_doubt else bound
        assert max(errors.values()) == pytest.approx(expected)
        assert run.status == ("ok" if expected <= 0.1 else "inaccurate")


def test_a_run_is_inaccurate_from_a_bound_of_a_tenth(beside):
    for error, status in {0.096: "ok", 0.1: "inaccurate"}.items():
        run, errors = beside(*of_order(1, error))
        assert run.status == status
        assert error < max(errors.values()) < 1.03 * error


def test_runs_that_do_not_converge_are_inaccurate(beside):
    """Half the step changes 2.6 %, a quarter 17 % more: a case of the stability study."""
    run, errors = beside(outcome(), outcome(1.026), outcome(1.2))
    assert run.status == "inaccurate" and max(errors.values()) > 0.3
    failed = outcome(status="diverged")
    run, errors = beside(outcome(), outcome(1.026), failed)
    assert run.status == "inaccurate" and errors == dict.fromkeys(ALL, inf)


def test_steps_in_contact_should_double(beside):
    """The same values from a contact that was a step long in both: half the share."""
    for share, status in {0.5: "ok", 0.4: "ok", 0.63: "ok", 0.37: "inaccurate"}.items():
        run, errors = beside(outcome(), outcome(contact_share=share))
        assert run.status == status and max(errors.values()) == 0
    assert beside(outcome(), outcome(contact_share=0.68))[0].status == "inaccurate"


def test_central_differences_may_chatter(beside):
    central = {"scheme": "central-difference", "fraction_of_limit": 0.8}
    run, _ = beside(outcome(), outcome(contact_share=0.2), integrator=central)
    assert run.status == "ok"


def test_runs_that_end_differently_are_inaccurate(beside):
    run, errors = beside(outcome(), outcome(status="liner-exhausted"))
    assert run.status == "inaccurate" and errors == dict.fromkeys(ALL, inf)
    still = outcome(0.0, status="no-contact", contact_share=0.0, reason="why")
    run, _ = beside(still, outcome(0.0, contact_share=0.01))
    assert (run.status, run.reason) == ("inaccurate", "")
    assert beside(still, still)[0] is still


def test_other_statuses_stay(beside):
    for status, finer in {"sensitive": [outcome(2.0)], "diverged": [], "inaccurate": []}.items():
        assert beside(outcome(status=status), *finer)[0].status == status


def test_a_scene_asks_for_it_and_the_sweep_has_the_errors(coarse_rom):
    """Against a run eight times finer the error is within its bound, and not a tenth of it."""
    alone = sweep(exact(), coarse_rom)
    runs = sweep(exact(halving=True), coarse_rom)
    assert runs.status.item() == "ok" and "error" not in alone
    assert runs.observable.values.tolist() == ALL
    assert "half the step" in runs.error.attrs["long_name"]
    for name in ("wear", "spectrum", "history", "ledger"):
        np.testing.assert_array_equal(runs[name].values, alone[name].values)
    fine = sweep(exact().but(integrator={"steps_per_round": 8 * 1280}), coarse_rom)
    for name in ("wear", "history"):
        of = (runs[name].values - fine[name].values).ravel()
        error = np.linalg.norm(of) / np.linalg.norm(fine[name].values.ravel())
        bound = runs.error.sel(observable=name).item()
        assert error < bound < 10 * error


def test_twin_and_half_step_go_together(coarse_rom):
    runs = sweep(exact(halving=True, twin=True), coarse_rom)
    wear = runs.sel(observable="wear")
    assert np.isfinite(wear.error).all() and np.isfinite(wear.departure).all()


@pytest.mark.parametrize(
    "changes",
    [
        {"record": {"samples_per_round": 64, "wear": False}},
        {"start": {"scene": "before"}},
        {"speeds": {"over_f1": [0.3], "in_turn": True}},
        {
            "accuracy": 0.01,
            "integrator": None,
            "liner__rods_per_round": None,
            "liner__strips": None,
        },
    ],
)
def test_it_is_refused_where_there_is_nothing_to_halve(changes):
    assert refused(SettingsError, scene, halving=True, **changes).key == "halving"
