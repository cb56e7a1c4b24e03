"""Runs in which nothing touches: their status, the reason, and what goes on from them."""

from dataclasses import replace

import numpy as np
import pytest
from scenes import scene

from simulate.over_speeds import sweep
from simulate.run import march
from simulate.setup import prepare
from simulate.start import UNDER

EXACT = {"scheme": "piecewise-exact", "steps_per_round": 640}
APART = {"casing__harmonics": [{"order": 2, "amplitude_gaps": 0.99}]}
NO_STRENGTH = {"liner__law__K": 0.0, "liner__law__sigma_Y": 0.0}


def marched(rom, **changes):
    case = scene(integrator=EXACT, **changes)
    return march(case, prepare(case, rom, 2 * np.pi * 0.3 * rom.f1))


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        (APART, ["clearance: the smallest gap is 21", "largest inward distortion 20.79 um"]),
        ({"casing__scale": 0.0}, ["casing.scale: 0: nothing brings the liner to the tip"]),
        (
            {"casing__harmonics": [{"order": 0, "amplitude_m": 0.0}]},
            ["casing.the distortion is nowhere inward"],
        ),
        (
            # a(2 of 20 rounds) = 0.028 of two gaps
            {"casing__ramp_rounds": 20},
            [
                "casing.ramp_rounds: does not bring it in far enough within the 2 rounds",
                "1.176 um of 42 um",
            ],
        ),
        (NO_STRENGTH, ["liner.law: sigma_Y and K are 0", "without any force"]),
    ],
)
@pytest.mark.filterwarnings("ignore::simulate.plausible.SceneWarning")
def test_a_run_that_never_touches_says_why(coarse_rom, changes, words):
    outcome = marched(coarse_rom, **changes)
    assert outcome.status == "no-contact" and outcome.contact_share == 0
    assert all(word in outcome.reason for word in words), outcome.reason
    assert "\n" not in outcome.reason
    assert abs(outcome.u_r).max() == 0 and np.isnan(outcome.xi)
    assert (outcome.wear.max() > 0) == (changes is NO_STRENGTH)


@pytest.mark.parametrize("scheme", ["piecewise-exact", "central-difference"])
def test_a_run_that_touches_once_has_no_such_status(coarse_rom, scheme):
    """The gap is closed by a thousandth at the end of the ramp."""
    step = {"steps_per_round": 640} if scheme == "piecewise-exact" else {"fraction_of_limit": 0.8}
    case = scene(
        integrator={"scheme": scheme, **step},
        casing__harmonics=[{"order": 2, "amplitude_gaps": 1.001}],
    )
    outcome = march(case, prepare(case, coarse_rom, 2 * np.pi * 0.3 * coarse_rom.f1))
    assert outcome.status == "ok" and outcome.reason == "" and outcome.contact_share > 0


def test_a_blade_without_liner_is_not_meant_to_rub(coarse_rom):
    outcome = marched(coarse_rom, liner__law={"kind": "none"})
    assert (outcome.status, outcome.reason, outcome.contact_share) == ("ok", "", 0)


def test_a_sweep_has_the_reason_and_the_result(coarse_rom):
    lines = []
    runs = sweep(scene(integrator=EXACT, **APART), coarse_rom, lines.append)
    assert runs.status.values.tolist() == ["no-contact"]
    assert runs.reason.item().startswith("clearance: ") and runs.reason.item() in lines[-1]
    assert runs.spectrum.values.max() == 0 and not np.isnan(runs.spectrum.values).any()


@pytest.mark.filterwarnings("ignore::simulate.plausible.SceneWarning")
def test_a_run_that_goes_on_touches_when_the_casing_comes(coarse_rom):
    """Of a ramp of four rounds the first leaves nothing moved; the blade still at rest rubs."""
    case = scene(
        integrator=EXACT,
        rounds=1,
        casing__ramp_rounds=4,
        record={"samples_per_round": 64, "end": True},
    )
    first = sweep(case, coarse_rom)
    then = sweep(case.but(rounds=3, start={"scene": "before"}), coarse_rom, start=first)
    assert first.status.item() == "no-contact" and "the 1 rounds" in first.reason.item()
    assert then.status.item() == "ok" and then.wear.max() > 0


def test_a_moving_blade_that_touches_no_more_is_ok(coarse_rom):
    """A run goes on in a casing out of reach, and rings down from what the first one left."""
    case = scene(integrator=EXACT, record={"samples_per_round": 64, "end": True})
    setup = prepare(case, coarse_rom, 2 * np.pi * 0.3 * coarse_rom.f1)
    first = march(case, setup)
    away = case.but(casing={"harmonics": [{"order": 0, "amplitude_m": 0.0}]}).but(
        clearance={"leading_edge_over_span": 0.01, "trailing_edge_over_span": 0.01}
    )
    under = first.left.under * [[name != "stored"] for name in UNDER]
    left = replace(first.left, stored=0 * first.left.stored, under=under)  # no rod is strained
    then = march(away, prepare(away, coarse_rom, setup.Omega), left)
    assert then.ledger.blade_before > 0 and then.contact_share == 0
    assert (then.status, then.reason) == ("ok", "")


def test_a_blade_at_rest_over_a_worn_liner_names_the_wear(coarse_rom):
    case = scene(integrator=EXACT, record={"samples_per_round": 64, "end": True})
    first = sweep(case, coarse_rom)
    less = case.but(
        casing={"harmonics": [{"order": 2, "amplitude_gaps": 1.2}]},
        start={"scene": "before", "liner_only": True},
    )
    then = sweep(less, coarse_rom, start=first)
    assert then.status.item() == "no-contact", then.contact_share.item()
    assert then.reason.item().startswith("start: the liner is worn by more")
