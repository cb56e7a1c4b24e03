"""Posterior weights against a posterior that is known in closed form."""

import numpy as np
import pytest
from scipy.stats import norm

from workflow.identify import proposal as emulator
from workflow.identify.posterior import systematic, weighted
from workflow.identify.priors import sobol

WIDTH = 0.05  # sigma of the data in the unit cube


def deviations(points):
    """Two data: a coordinate, and the mean of two others; nan where a third is large."""
    values = np.stack([points[:, 0] - 0.6, points[:, 1:3].mean(axis=1) - 0.5], axis=1) / WIDTH
    values[points[:, 3] > 0.9] = np.nan
    return values


def likelihood(points):
    return np.exp(-np.nan_to_num(deviations(points) ** 2, nan=np.inf).sum(axis=1) / 2)


@pytest.fixture(scope="module")
def drawn():
    """Points of the prior, then of an emulated posterior, with their density."""
    prior, candidates = sobol(128, 5, 1), sobol(2**13, 5, 2)
    everywhere = np.vstack([candidates, prior])
    emulated = emulator.emulated(prior, deviations(prior), everywhere)
    density = emulated / emulated[: 2**13].mean()
    chosen = systematic(density[: 2**13], 256, np.random.default_rng(0))
    of_both = 128 + 256 * np.append(density[2**13 :], density[chosen])
    return np.vstack([prior, candidates[chosen]]), of_both


def test_weights_give_the_known_posterior(drawn):
    points, density = drawn
    posterior = weighted(points, likelihood(points), density)
    mean = posterior.weights @ points
    spread = np.sqrt(posterior.weights @ (points - mean) ** 2)
    assert posterior.weights.sum() == pytest.approx(1)
    np.testing.assert_allclose(mean, [0.6, 0.5, 0.5, 0.45, 0.5], atol=0.05)
    assert spread[0] == pytest.approx(WIDTH, rel=0.15)
    assert spread[4] == pytest.approx(1 / np.sqrt(12), rel=0.1)  # no datum: the prior
    # product of a Gaussian's mass, a Gaussian of the triangular mean of two, and a share
    exact = np.sqrt(2 * np.pi) * WIDTH * _triangular() * 0.9
    assert posterior.evidence == pytest.approx(exact, rel=0.1)


def _triangular():
    """Mean of the second datum's likelihood: the mean of two uniform numbers is triangular."""
    x = np.linspace(0, 1, 4001)
    density = np.where(x < 0.5, 4 * x, 4 * (1 - x))
    return np.trapezoid(density * np.sqrt(2 * np.pi) * WIDTH * norm.pdf(x, 0.5, WIDTH), x)


def test_the_emulator_makes_most_of_its_draws_count(drawn):
    points, density = drawn
    own = weighted(points, likelihood(points), density).effective
    of_prior_alone = weighted(points[:128], likelihood(points[:128]), np.full(128, 128.0)).effective
    assert own > 0.5 * 256 > 3 * of_prior_alone


def test_a_wrong_density_gives_wrong_weights(drawn):
    """The balance with the prior is not idle: without it the spread is that of the proposal."""
    points, density = drawn
    wrong = weighted(points, likelihood(points), np.ones_like(density))
    mean = wrong.weights @ points
    assert np.sqrt(wrong.weights @ (points - mean) ** 2)[0] < 0.85 * WIDTH


def test_points_without_support_have_no_weights():
    empty = weighted(sobol(4, 5, 1), np.zeros(4), np.full(4, 4.0))
    assert empty.evidence == empty.effective == 0 and not empty.weights.any()


def test_the_emulator_knows_its_error():
    points = sobol(64, 5, 1)
    straight = np.stack([points.sum(axis=1), points[:, 0]], axis=1)
    noisy = straight + np.random.default_rng(0).normal(0, 0.3, straight.shape)
    assert emulator.error(points, straight).max() < 1e-3
    assert 0.3 < emulator.error(points, noisy).min() < emulator.error(points, noisy).max() < 1


def test_equal_points_count_once():
    points, likely = sobol(8, 5, 1), np.linspace(1, 2, 8)
    once = weighted(points, likely, np.full(8, 8.0))
    twice = weighted(np.tile(points, (2, 1)), np.tile(likely, 2), np.full(16, 16.0))
    assert twice.effective == pytest.approx(once.effective)
    assert twice.evidence == pytest.approx(once.evidence)


def test_draws_are_evenly_spread_from_a_random_start():
    weights = np.full(1000, 1e-3)
    starts = {systematic(weights, 10, np.random.default_rng(seed))[0] for seed in range(20)}
    assert len(starts) > 10 and max(starts) < 100
    assert systematic([0.0, 1.0, 0.0], 5, np.random.default_rng(0)).tolist() == [1] * 5
