import numba
import numpy as np
import pytest
from systems import strips

from simulate.contact import cover, nothing_covered, press
from simulate.laws.plastic import Parameters
from simulate.modal import Step
from simulate.strips import contact_free, largest_over_window, rod_under, rods_in_footprint

LAW = Parameters(E=2.0, K=1.0, sigma_Y=0.0)


@numba.njit
def press_all(system, covered, eps_p, u, a, step, force):
    energies = np.zeros(5)
    for i in range(force.size):
        cover(system, covered, eps_p, i, Step(step, a, 0, 0, 0), 0.0, 0.0, 0.0, energies)
        force[i] = press(system, covered, eps_p, i, u[i], 0.0, energies)[0]


def force_at(system, u, a=1.0, step=0, eps_p=None):
    """Forces and plastic strains for prescribed displacements; the rods under the nodes."""
    eps_p = np.zeros((len(system.g0), len(system.d))) if eps_p is None else eps_p
    force, covered = np.zeros(len(system.g0)), nothing_covered(system)
    press_all(system, covered, eps_p, np.asarray(u, float), a, step, force)
    return force, eps_p, covered


def test_no_force_and_no_wear_while_a_gap_is_open():
    system = strips(LAW, [0.5, 1.0], np.zeros(8))
    force, eps_p, _ = force_at(system, [0.5, 0.999])
    assert force.max() == eps_p.max() == 0


@pytest.mark.parametrize("nu", [6, 16, 64, 400, 4096])
def test_force_of_a_uniform_penetration_does_not_depend_on_the_density(nu):
    radius, footprint, width = 0.5, 0.4, 0.01
    length = max(rods_in_footprint(footprint, radius, nu), 1.0)
    area = width * footprint / length
    system = strips(LAW, 0.0, np.zeros(nu), length, area, first=[0.37])
    force, _, _ = force_at(system, [0.1])
    tangent = LAW.E * LAW.K / (LAW.E + LAW.K)
    assert force[0] == pytest.approx(width * footprint * tangent * 0.1, rel=1e-13)


@pytest.mark.parametrize("length", [1.0, 1.3, 3.6, 4.0])
def test_rods_bear_with_the_part_in_the_footprint_and_wear_with_their_centre(length):
    nu, m, steps, theta = 50, int(np.ceil(length)), 333, 0.3
    node = theta * nu / (2 * np.pi) + nu * np.arange(steps + 1) / steps  # in rods
    first = [node[0] - (m - 1) / 2]
    system = strips(LAW, 0.0, np.ones(nu), length, first=first, advance=nu / steps)
    for step in range(steps + 1):
        _, eps_p, covered = force_at(system, [0.0], step=step)
        off = (np.arange(nu) - node[step] + nu / 2) % nu - nu / 2  # from the node to rod centres
        overlap = np.minimum(off + 1 / 2, length / 2) - np.maximum(off - 1 / 2, -length / 2)
        part = np.zeros(nu)
        part[(covered.strips["at"][0] + np.arange(m + 1)) % nu] = covered.rods["part"][0]
        np.testing.assert_allclose(part, np.maximum(overlap, 0), atol=1e-12)
        np.testing.assert_array_equal(eps_p[0] > 0, abs(off) <= length / 2)


@pytest.mark.parametrize("length", [1.0, 2.3, 3.0])
def test_the_force_has_no_jumps_where_rods_come_and_go(length):
    """A tip that slides in small steps over an uneven casing: the force goes as far as the step."""
    rng, steps = np.random.default_rng(4), 8000
    d = rng.uniform(0, 1, 40)
    system = strips(LAW, 0.0, d, length, first=[0.2], advance=40 / steps)
    force = np.array([force_at(system, [0.1], step=step)[0][0] for step in range(steps)])
    assert abs(np.diff(force)).max() <= 2 / 3 * (40 / steps) * 1.0 * (1 + 1e-9)  # E_t A |d - d'|


@pytest.mark.parametrize("mean", [0.0, -5.0], ids=["either side", "outward everywhere"])
def test_safe_displacement_is_safe_and_tight(mean):
    rng = np.random.default_rng(3)
    nu, steps = 40, 400
    for _ in range(30):
        first, d = rng.uniform(0, nu, 2), rng.normal(mean, size=nu)
        system = strips(LAW, rng.uniform(0, 1, 2), d, 3.0, first=first, advance=nu / steps)
        start, a = int(rng.integers(0, steps - 50)), np.sort(rng.uniform(0, 1, 2))
        safe = np.zeros(2)
        contact_free(system, *a, start, start + 50, safe)
        span = range(start, start + 51)
        # the distortion grows monotonically: its ends bound it
        assert not any(
            force_at(system, safe - 1e-12, a=x, step=s)[0].any() for s in span for x in a
        )
        assert any(force_at(system, safe + 1e-9, a=x, step=s)[0].any() for s in span for x in a)


def test_wear_stays_when_the_blade_comes_back_less_deep():
    system = strips(LAW, 0.0, np.zeros(4))
    _, worn, _ = force_at(system, [0.6])
    force, again, _ = force_at(system, [0.3], eps_p=worn.copy())
    assert np.array_equal(worn, again)
    assert force[0] == 0  # below the worn depth of 0.4


def test_window_maximum_wraps_around_the_casing():
    np.testing.assert_array_equal(largest_over_window(np.array([3.0, 0, 1, 2]), 2), [3, 1, 2, 3])


def test_rod_under_stays_on_the_circumference():
    """Also where the first rod, a remainder by nu, rounds to nu itself."""
    system = strips(
        LAW, [0] * 3, np.zeros(10), first=[0.0, np.nextafter(10, 0), 10.0], advance=10 / 7
    )
    for step in range(8):
        assert all(0 <= rod_under(system, i, step) < 10 for i in range(3))
