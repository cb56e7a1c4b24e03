import numpy as np
import pytest
from systems import march, strips

from simulate.plastic import Plastic
from simulate.stability import spectral_radius, step_limit


def random_system(seed, nodes=3, n=12):
    rng = np.random.default_rng(seed)
    return np.sort(rng.uniform(1, 100, n)), rng.normal(size=(nodes, n))


def test_limit_of_a_free_mode_is_two_over_omega():
    assert step_limit(np.array([7.0]), np.ones((1, 1)), 0.0, 0.0) == pytest.approx(2 / 7, rel=1e-9)


def test_limit_of_a_mass_on_a_rod_is_four_thirds():
    """lambda^2 - 2 (1 - b) lambda + (1 - b) = 0 reaches -1 at b = h^2 k/m = 4/3."""
    m, k = 2.0, 50.0
    h = step_limit(np.array([1e-3]), np.array([[m**-0.5]]), 0.0, k)
    assert h**2 * k / m == pytest.approx(4 / 3, rel=1e-8)


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize("xi", [0.0, 0.01, 0.5])
@pytest.mark.parametrize("k", [1.0, 1e3, 1e5])
def test_limit_is_where_the_spectral_radius_leaves_one(seed, xi, k):
    omega, Phi_b = random_system(seed)
    h = step_limit(omega, Phi_b, xi, k)
    for share in (0.3, 0.7, 0.9, 0.999):
        assert spectral_radius(share * h, omega, Phi_b, xi, k) <= 1 + 1e-9
    # the bracket is 1e-3 wide where the radius decides
    assert spectral_radius(1.003 * h, omega, Phi_b, xi, k) > 1 + 1e-9


def test_an_undamped_blade_is_unstable_below_the_limit_of_one_mass():
    """Several modes on a strip grow as a complex pair above b = 1; one mass only above 4/3."""
    omega, Phi_b = random_system(3)
    k = 1e3
    b = step_limit(omega, Phi_b, 0.0, k) ** 2 * np.linalg.eigvalsh(k * Phi_b @ Phi_b.T)[-1]
    assert 1.0 < b < 1.1
    damped = step_limit(omega, Phi_b, 0.05, k) ** 2 * np.linalg.eigvalsh(k * Phi_b @ Phi_b.T)[-1]
    assert damped > 4 / 3


@pytest.mark.parametrize("seed", range(6))
def test_fewer_engaged_strips_are_never_less_stable(seed):
    omega, Phi_b = random_system(seed)
    h = 0.999 * step_limit(omega, Phi_b, 0.01, 1e4)
    for engaged in ([0], [1], [2], [0, 1], [0, 2], [1, 2]):
        assert spectral_radius(h, omega, Phi_b[engaged], 0.01, 1e4) <= 1 + 1e-9


@pytest.mark.parametrize(("share", "stays"), [(0.98, True), (1.02, False)])
def test_an_always_engaged_elastic_liner_fails_where_predicted(share, stays):
    """A preloaded liner that never yields or opens is linear: runs part within 2 % of the limit."""
    omega, Phi_b = random_system(0, nodes=1, n=6)
    k = 1e4
    h = share * step_limit(omega, Phi_b, 0.01, k)
    system = strips(Plastic(k, 0.0, 1e30), 0.0, np.full(4, 1.0))
    # The scheme's own rest: t_N = k (1 + Phi q_p) at the predicted q_p = q + c3 Phi^T t_N, and
    # omega^2 q = -Phi^T t_N. (It is stiffer than the liner, by 1/(1 - b).)
    c3 = 1 / (1 / h**2 + 0.01 * omega / h)
    compliance = float(Phi_b[0] ** 2 @ (c3 - 1 / omega**2))
    penetration = 1 / (1 - k * compliance)
    rest = -Phi_b[0] / omega**2 * k * penetration
    nudged = rest + 1e-6 * penetration * np.random.default_rng(1).normal(size=6)
    u, _, contacts = march(system, omega, Phi_b, 0.01, h, 3000, nudged, nudged)
    off = abs(u[-100:] - Phi_b @ rest).max() / penetration
    assert contacts > 1000
    assert (off < 1e-4) if stays else (off > 0.1)
