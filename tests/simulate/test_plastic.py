import numpy as np
import pytest

from simulate.plastic import Plastic, stress

LAW = Plastic(E=3.0, K=2.0, sigma_Y=0.3)


def loop(law, strains):
    """Stresses and plastic strains along a strain path."""
    path, eps_p = [], 0.0
    for eps in strains:
        sigma, eps_p = stress(law, eps, eps_p)
        path.append((sigma, eps_p))
    return np.array(path).T


def test_loading_follows_the_tangent_modulus_past_the_elastic_limit():
    eps = np.linspace(0, 1, 201)
    sigma, _ = loop(LAW, eps)
    yield_strain = LAW.sigma_Y / LAW.E
    tangent = LAW.E * LAW.K / (LAW.E + LAW.K)
    expected = np.where(
        eps <= yield_strain, LAW.E * eps, LAW.sigma_Y + tangent * (eps - yield_strain)
    )
    np.testing.assert_allclose(sigma, expected, atol=1e-14)  # round-off of 200 updates


def test_unloading_follows_E_and_bears_no_tension():
    eps = np.concatenate([np.linspace(0, 1, 50), np.linspace(1, 0, 50)])
    sigma, eps_p = loop(LAW, eps)
    unloading = slice(50, None)
    assert np.ptp(eps_p[unloading]) == 0
    np.testing.assert_allclose(
        sigma[unloading], np.maximum(0, LAW.E * (eps[unloading] - eps_p[-1])), atol=1e-15
    )
    assert sigma.min() == 0


def test_reloading_to_the_same_depth_wears_no_more():
    _, eps_p = loop(LAW, [0, 1, 0, 1, 0, 1])
    assert eps_p[1] == pytest.approx(eps_p[-1], abs=1e-15)
    assert eps_p[1] == pytest.approx((LAW.E - LAW.sigma_Y) / (LAW.E + LAW.K), rel=1e-15)


def test_increments_of_eq_13_give_the_same_as_the_total_form():
    """Eqs. (13)-(16) as printed, increment by increment, on a random path."""
    strains = np.random.default_rng(1).uniform(0, 1, 400)
    sigma_total, eps_p_total = loop(LAW, strains)
    sigma = alpha = last = 0.0
    for i, eps in enumerate(strains):
        trial = LAW.E * (eps - last) + sigma
        f = trial - (LAW.sigma_Y + LAW.K * alpha)
        gamma = max(f, 0.0) / (LAW.E + LAW.K)
        sigma, alpha, last = trial - LAW.E * gamma, alpha + gamma, eps
        assert alpha == pytest.approx(eps_p_total[i], abs=1e-13)
        assert max(sigma, 0) == pytest.approx(sigma_total[i], abs=1e-12)


def test_perfect_plasticity_holds_the_elastic_limit():
    sigma, _ = loop(Plastic(E=3.0, K=0.0, sigma_Y=0.3), np.linspace(0, 1, 11))
    assert sigma[-1] == pytest.approx(0.3, rel=1e-14)
