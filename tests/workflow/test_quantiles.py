"""Quantiles over seeds: how often their intervals hold the exact ones; how many draws they need."""

import numpy as np
import pytest

from workflow.many.quantiles import needed, quantile


@pytest.mark.parametrize("share", [0.1, 0.5, 0.9])
def test_intervals_hold_the_exact_quantile_nineteen_times_of_twenty(share):
    """Of uniform draws it is the share itself; percentile intervals of 60 draws hold less."""
    rng = np.random.default_rng(3)
    found = [quantile(rng.random(60), share) for _ in range(200)]
    held = np.mean([of.low <= share <= of.high for of in found])
    assert 0.88 < held < 0.98
    assert np.mean([of.value for of in found]) == pytest.approx(share, abs=0.02)


@pytest.mark.parametrize("share", [0.1, 0.5, 0.9, 0.95, 0.99])
def test_the_largest_of_the_draws_needed_lies_beyond(share):
    """Of n independent draws one lies beyond with 1 - q^n: for the first n that is 95 %."""
    tail = max(share, 1 - share)
    assert 1 - tail ** needed(share) >= 0.95 > 1 - tail ** (needed(share) - 1)


def test_of_equal_draws_there_is_no_doubt():
    assert quantile([2.0] * 4, 0.9)[:4] == (2.0, 2.0, 2.0, 4)
