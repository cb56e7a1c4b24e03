"""Quantiles over seeds: how often their intervals hold the exact ones; how many draws they need."""

import numpy as np
import pytest

from workflow.many.quantiles import needed, quantile


@pytest.mark.parametrize(("share", "count"), [(0.1, 29), (0.5, 20), (0.9, 29), (0.95, 59)])
def test_intervals_hold_the_exact_quantile_nineteen_times_of_twenty(share, count):
    """Of uniform draws it is the share itself; as few draws as the quantile needs."""
    rng = np.random.default_rng(3)
    found = [quantile(rng.random(count), share) for _ in range(1000)]
    held = np.mean([of.low <= share <= of.high for of in found])
    assert 0.92 < held < 0.98
    between = (share * (count - 1) + 1) / (count + 1)  # mean of the draws between which it lies
    assert np.mean([of.value for of in found]) == pytest.approx(between, abs=0.01)


def test_an_interval_of_too_few_draws_ends_at_the_last():
    draws = np.arange(20.0)
    assert quantile(draws, 0.9).high == 19 and quantile(draws, 0.1).low == 0
    assert quantile([5.0], 0.5)[:4] == (5.0, 5.0, 5.0, 1)


@pytest.mark.parametrize("share", [0.1, 0.5, 0.9, 0.95, 0.99])
def test_the_largest_of_the_draws_needed_lies_beyond(share):
    """Of n independent draws one lies beyond with 1 - q^n: for the first n that is 95 %."""
    tail = max(share, 1 - share)
    assert 1 - tail ** needed(share) >= 0.95 > 1 - tail ** (needed(share) - 1)


def test_of_equal_draws_there_is_no_doubt():
    assert quantile([2.0] * 4, 0.9)[:4] == (2.0, 2.0, 2.0, 4)
