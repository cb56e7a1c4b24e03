"""Runs in which nothing touches: their status, the reason, and what goes on from them."""

from dataclasses import replace

import numpy as np
import pytest
from runs import marched, set_up
from scenes import EXACT, SCHEMES, scene

from simulate.marching import march
from simulate.marching.ends import UNDER
from simulate.sweeps.sweep import sweep

APART = {"casing__harmonics": [{"order": 2, "amplitude_gaps": 0.99}]}
NO_STRENGTH = {"liner__law__K": 0.0, "liner__law__sigma_Y": 0.0}


def record_end(**changes):
    record = {"samples_per_round": 64, "end": True}
    return scene(integrator=EXACT, record=record, **changes)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        (APART, ["clearance: the smallest gap is 21", "largest inward distortion 20.79 um"]),
        ({"casing__scale": 0.0}, ["casing.scale: 0: nothing brings the liner to the tip"]),
        (
            {"casing__harmonics": [{"order": 0, "amplitude_um": 0}]},
            ["casing.the distortion is nowhere inward"],
        ),
        (
            # a(2 of 20 rounds) = 0.028 of two gaps
            {"casing__ramp_rounds": 20},
            [
                "casing.ramp_rounds: the casing does not reach the tip within the 2 revolutions",
                "1.176 um of 42 um",
            ],
        ),
        (NO_STRENGTH, ["liner.law: sigma_Y and K are 0", "without any force"]),
    ],
)
@pytest.mark.filterwarnings("ignore::simulate.sweeps.unusual.SceneWarning")
def test_a_run_that_never_touches_says_why(coarse_rom, changes, words):
    outcome = marched(scene(integrator=EXACT, **changes), coarse_rom)
    assert outcome.status == "no-contact" and outcome.contact_share == 0
    assert all(word in outcome.reason for word in words), outcome.reason
    assert "\n" not in outcome.reason
    assert abs(outcome.u_r).max() == 0 and np.isnan(outcome.xi)
    assert (outcome.wear.max() > 0) == (changes is NO_STRENGTH)


@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize(("amplitude", "status"), [(1.001, "ok"), (0.99, "no-contact")])
def test_a_run_that_touches_once_has_no_such_status(coarse_rom, scheme, amplitude, status):
    """The gap is closed by a thousandth at the end of the ramp."""
    waves = [{"order": 2, "amplitude_gaps": amplitude}]
    outcome = marched(scene(integrator=SCHEMES[scheme], casing__harmonics=waves), coarse_rom)
    assert outcome.status == status
    assert (outcome.reason == "") == (outcome.contact_share > 0) == (status == "ok")
    assert outcome.u_r.any() == outcome.wear.any() == (status == "ok")


def test_a_sweep_has_the_reason_and_the_result(coarse_rom):
    lines = []
    runs = sweep(scene(integrator=EXACT, **APART), coarse_rom, lines.append)
    assert runs.status.values.tolist() == ["no-contact"]
    assert runs.reason.item().startswith("clearance: ") and runs.reason.item() in lines[-2]
    assert runs.spectrum.values.max() == 0 and not np.isnan(runs.spectrum.values).any()


@pytest.mark.filterwarnings("ignore::simulate.sweeps.unusual.SceneWarning")
def test_a_run_that_goes_on_touches_when_the_casing_comes(coarse_rom):
    """Of a ramp of four rounds the first leaves nothing moved; the blade still at rest rubs."""
    case = record_end(rounds=1, casing__ramp_rounds=4)
    first = sweep(case, coarse_rom)
    then = sweep(case.but(rounds=3, start={"scene": "before"}), coarse_rom, start=first)
    assert first.status.item() == "no-contact" and "the 1 revolutions" in first.reason.item()
    assert then.status.item() == "ok" and then.wear.max() > 0


def test_a_moving_blade_that_touches_no_more_is_ok(coarse_rom):
    """A run goes on in a casing out of reach, and rings down from what the first one left."""
    left = marched(record_end(), coarse_rom).final
    away = record_end(
        casing__harmonics=[{"order": 0, "amplitude_um": 0}],
        clearance={"leading_edge_over_span": 0.01, "trailing_edge_over_span": 0.01},
    )
    under = left.under * [[name != "stored"] for name in UNDER]
    left = replace(left, stored=0 * left.stored, under=under)  # no rod is strained
    then = march(away, set_up(away, coarse_rom), left)
    assert then.ledger.blade_before > 0 and then.contact_share == 0
    assert (then.status, then.reason) == ("ok", "")


def test_a_blade_at_rest_over_a_worn_liner_names_the_wear(coarse_rom):
    first = sweep(record_end(), coarse_rom)
    less = record_end(
        casing__harmonics=[{"order": 2, "amplitude_gaps": 1.2}],
        start={"scene": "before", "liner_only": True},
    )
    then = sweep(less, coarse_rom, start=first)
    assert then.status.item() == "no-contact", then.contact_share.item()
    assert then.reason.item().startswith("start: the liner is worn by more")
