import numpy as np
import pytest
from runs import set_up
from scenes import scene
from systems import Parameters, march, strips

from simulate.marching import strip_stiffness
from simulate.marching.stability import engagement, step_limit
from workflow.study.stability.map import engaged as always_engaged, spectral_radius

UNEQUAL = np.array([1.0, 0.4, 1.7])  # stiffnesses of three strips
ON_THE_CIRCLE = 1e-9  # round-off of eigenvalues of modulus 1; such a growth needs 1e9 steps


def random_system(seed, nodes=3, n=12):
    rng = np.random.default_rng(seed)
    return np.sort(rng.uniform(1, 100, n)), rng.normal(size=(nodes, n))


def test_limit_of_a_free_mode_is_two_over_omega():
    limit = step_limit(np.array([7.0]), np.ones((1, 1)), 0.0, np.zeros(1))
    assert limit == pytest.approx(2 / 7, rel=1e-9)


def test_one_mass_on_a_rod_fails_at_four_thirds_and_is_refused_from_one():
    """lambda^2 - 2 (1 - b) lambda + (1 - b) = 0 reaches -1 at b = h^2 k/m = 4/3."""
    m, k = 2.0, np.array([50.0])
    system = np.array([1e-3]), np.array([[m**-0.5]])
    h = step_limit(*system, 0.0, k)
    assert h**2 * k[0] / m == pytest.approx(1, rel=1e-8)
    fails = np.sqrt(4 / 3 * m / k[0])
    assert spectral_radius(0.999 * fails, *system, 0.0, k) <= 1 + ON_THE_CIRCLE
    assert spectral_radius(1.001 * fails, *system, 0.0, k) > 1.001


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize("xi", [0.0, 0.001, 0.05, 0.5])
@pytest.mark.parametrize("k", [1.0, 1e3, 1e5])
def test_every_set_of_engaged_strips_is_stable_at_the_limit(seed, xi, k):
    omega, Phi_b = random_system(seed)
    k = k * UNEQUAL
    h = (1 - 1e-7) * step_limit(omega, Phi_b, xi, k)  # at 2/omega itself the root -1 is double
    for engaged in ([], [0], [1], [2], [0, 1], [0, 2], [1, 2], [0, 1, 2]):
        for share in (0.3, 0.7, 1.0):
            radius = spectral_radius(share * h, omega, Phi_b[engaged], xi, k[engaged])
            assert radius <= 1 + ON_THE_CIRCLE, (engaged, share)


def test_every_set_of_strips_is_stable_on_the_blade(coarse_rom):
    case = scene(liner__law__E=1000.0)
    setup = set_up(case, coarse_rom, 0.34)
    system = setup.omega, setup.Phi_b, strip_stiffness(case.liner, setup.places)
    h = step_limit(*system[:2], 0.0, system[2])
    assert h * setup.omega.max() < 1.9  # contact sets it
    for engaged in (range(8), range(7), range(1, 8), range(3, 8), range(6, 8), (0, 7)):
        omega, Phi_b, k = system[0], *(of[list(engaged)] for of in system[1:])
        assert spectral_radius(h, omega, Phi_b, 0.0, k) <= 1 + ON_THE_CIRCLE


def test_several_modes_can_fail_below_the_limit_of_one_mass():
    """Why the limit is b = 1 and not 4/3: a complex pair grows between, slowly."""
    omega, Phi_b = random_system(3)
    k = np.full(3, 1e3)
    h = np.sqrt(1.15) * step_limit(omega, Phi_b, 0.0, k)
    assert engagement(h, omega, Phi_b, 0.0, k) == pytest.approx(1.15, rel=1e-6)
    assert spectral_radius(h, omega, Phi_b, 0.0, k) > 1 + 1e-5


@pytest.mark.parametrize(("share", "stays"), [(0.98, True), (1.02, False)])
def test_an_always_engaged_elastic_liner_fails_where_the_step_map_says(share, stays):
    """A preloaded liner that never yields or opens is linear; it fails above the limit."""
    omega, Phi_b = random_system(0, nodes=1, n=6)
    k, xi = 1e4, 0.01
    limit = step_limit(omega, Phi_b, xi, np.array([k]))
    shares = np.linspace(1, 1.2, 201)
    radii = [spectral_radius(x * limit, omega, Phi_b, xi, np.array([k])) for x in shares]
    fails = limit * shares[np.argmax(np.array(radii) > 1 + 1e-6)]
    assert 1.1 * limit < fails < 1.17 * limit  # sqrt(4/3) = 1.155 for one mass
    h = share * fails
    # The scheme's own rest: t_N = k (1 + Phi q_p) at the predicted q_p = q + c3 Phi^T t_N, and
    # omega^2 q = -Phi^T t_N.
    c3 = 1 / (1 / h**2 + xi * omega / h)
    penetration = 1 / (1 - k * float(Phi_b[0] ** 2 @ (c3 - 1 / omega**2)))
    rest = -Phi_b[0] / omega**2 * k * penetration
    nudged = rest + 1e-6 * penetration * np.random.default_rng(1).normal(size=6)
    thick = 1e6  # no growth wears it through; the area keeps the stiffness
    system = strips(Parameters(k, 0.0, 1e30), 0.0, np.full(4, 1.0), area=thick, thickness=thick)
    run = march(system, omega, Phi_b, xi, h, 3000, nudged, nudged)
    off = abs(run.u[-100:] - Phi_b @ rest).max() / penetration
    assert run.contacts > 1000
    assert (off < 1e-4) if stays else (off > 0.1)


@pytest.mark.slow
@pytest.mark.parametrize("E", [0.5, 20.0])
def test_runs_fail_at_the_step_predicted_by_the_spectral_radius(coarse_rom, E):
    """Engaged, elastic: predicted and found within 2 %, and the limit allowed is below."""
    case = scene(liner__law={"kind": "elastic", "E": E, "unit_MPa": 2000})
    found = always_engaged(case, set_up(case, coarse_rom, 0.33))
    assert found["failed"] == pytest.approx(found["predicted"], rel=0.02)
    assert 0.8 * found["failed"] < found["limit"] < found["failed"]
