"""Study of stability: sentences and figure of its results."""

from types import SimpleNamespace

import numpy as np
import pytest
from runs import made

from simulate.errors.observables import observables
from workflow.study.stability import steps, told as stability

ENGAGED = [
    {"E": E, "alone": 6e-7, "limit": 5e-7 / E, "predicted": 6e-7 / E, "failed": 6e-7 / E}
    for E in (1.0, 3.0, 10.0, 30.0)
]


def test_the_peak_amplitude_is_that_of_the_last_rounds_without_the_mean():
    """Twelve rounds at engine order 4 about a mean, the first two much larger."""
    record = steps.RECORD
    rounds = np.arange(steps.ROUNDS * record.samples_per_round) / record.samples_per_round
    u = np.where(rounds < 2, 50.0, 7.0 + 2.0 * np.cos(2 * np.pi * 4 * rounds))
    shown = observables(made(record.but(wear=False), SimpleNamespace(u_r=u[:, None])))
    assert shown["spectrum"].max() == pytest.approx(2.0, rel=1e-12)  # round-off


def test_the_sentence_has_the_distance_of_failures_from_prediction_and_limit():
    found = [row | {"failed": row["failed"] * 0.9} for row in ENGAGED]
    told = stability.limits({"engaged": found})
    assert "E = 1 to 30, 4 always engaged liners: runs fail within 10.0% of" in told
    assert told.endswith("the limit allowed is 7.4% to 7% below.")  # 1 - 5 / (6 * 0.9)


def test_the_step_that_reaches_a_level_is_interpolated():
    h, error = np.array([4e-6, 1e-6, 2e-6]), np.array([0.16, 0.01, 0.04])
    assert steps.passes(h, error, 0.02) == pytest.approx(np.sqrt(2) * 1e-6)
    assert steps.passes(h, error, 0.2) is None
    assert steps.passes(h, error, 0.001) is None
