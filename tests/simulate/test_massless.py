"""The massless boundary: closed forms, order, energy, and the product's runs as its limit."""

from types import SimpleNamespace

import numpy as np
import pytest
from massless import (
    Massless,
    at_the_end,
    coefficients,
    craig_bampton,
    energy,
    exact_but_static,
    macneal,
    massless_run,
    own_run,
    step_limit,
)
from runs import set_up
from scenes import of_steps, over_strips, scene
from systems import Hooke, elastic_rod, lively, march_by, one_rod, strips

from geometry.tip import JUDGED
from simulate.contact.rod_law import rod_law
from simulate.marching.kernel import ESCAPED, RUNNING
from simulate.scene.law import numbers_of
from simulate.scene.laws.rigid import Rigid

SOFT = 1e-7  # rad/s, of a mass that is all but free
RESIDUAL = np.diag([1e-2, 3e-2])


def model(omega, Phi_b, R):
    """A reduced model without outputs."""
    omega, Phi_b = np.asarray(omega, float), np.atleast_2d(Phi_b)
    nowhere = np.zeros((0, len(omega))), np.zeros((0, len(Phi_b)))
    return Massless(omega, Phi_b, np.atleast_2d(R), *nowhere)


def massless(system, of, xi, h, steps, q, v, **more):
    """March a small system from displacement and velocity, apart from the rods."""
    q, v = np.asarray(q, float), np.asarray(v, float)
    half = v - h / 2 * (of.omega**2 * q + 2 * xi * of.omega * v)
    scheme = SimpleNamespace(
        coefficients=lambda omega, Phi_b, xi, h: coefficients(of, xi, h),
        energy=lambda omega, xi, h, motion, now: energy(of, h, motion, now),
    )
    system = at_the_end(system)
    return march_by(scheme, system, of.omega, of.Phi_b, xi, h, steps, q, half, **more)


@pytest.mark.parametrize("R", [0.0, 0.7])
@pytest.mark.parametrize("K", [0.45, 3.0])
def test_a_mass_rebounds_from_a_plastic_rod_on_its_static_spring(K, R):
    """Restitution sqrt(loading over unloading stiffness), each in series with R; order two."""
    loading, unloading, v0 = 1 / (R + (1 + K) / K), 1 / (R + 1), 0.1
    of = model([SOFT], [[1.0]], R)
    for h in (2e-2, 1e-2, 5e-3, 2.5e-3):
        for share in np.linspace(0, 1, 8):  # of a step before it arrives
            run = massless(one_rod(1.0, K), of, 0.0, h, int(20 / h), [-share * h * v0], [v0])
            rebound = (run.u[-2, 0] - run.u[-1, 0]) / (h * v0)
            assert abs(rebound - np.sqrt(loading / unloading)) < h**2 / 10


def test_a_one_sided_spring_in_series_sets_the_frequency_and_takes_no_energy():
    """One mode, R and an elastic rod: 2 w1 w2 / (w1 + w2), w2^2 = w1^2 + 1/(R + 1/k)."""
    w1, k, R, h = 1.0, 8.0, 0.3, 2e-3
    w2 = np.sqrt(w1**2 + 1 / (R + 1 / k))
    period = np.pi / w1 + np.pi / w2
    steps = int(20.5 * period / h)
    run = massless(elastic_rod(k), model([w1], [[1.0]], R), 0.0, h, steps, [-1.0], [0.0])
    u = run.u[:, 0]
    up = np.flatnonzero((u[:-1] < 0) & (u[1:] >= 0))
    crossings = up - u[up] / (u[up + 1] - u[up])
    found = h * (crossings[-1] - crossings[0]) / (len(crossings) - 1)
    assert len(crossings) >= 20
    assert found == pytest.approx(period, rel=h**2)
    assert u[-int(period / h) :].min() == pytest.approx(-1, abs=h**2)


@pytest.mark.parametrize("dynamic", [10, 40])
def test_an_elastic_bar_meets_a_rigid_stop(dynamic):
    """Impulse 2 m v0 in 2 L/c0; of eighty free modes half or more bear no mass."""
    modes, v0, h = 80, 1e-3, 2e-3
    omega = np.pi * np.arange(modes)
    omega[0] = SOFT
    end = np.where(np.arange(modes) == 0, 1.0, np.sqrt(2))[None]
    R = (end[:, dynamic:] / omega[dynamic:] ** 2) @ end[:, dynamic:].T
    of = model(omega[:dynamic], end[:, :dynamic], R)
    assert h < step_limit(of, np.array([np.inf]))
    system = strips(rod_law(Rigid, numbers_of()()), 0.0, np.zeros(4), rigid_from=0.0)
    start = v0 * (np.arange(dynamic) == 0)
    run = massless(system, of, 0.0, h, int(2.6 / h), np.zeros(dynamic), start)
    assert run.force[0, 1, 0] * h == pytest.approx(2 * v0, rel=0.02)
    assert run.u[-1, 0] / v0 == pytest.approx(-0.6, abs=0.01)
    assert run.ledger.blade == pytest.approx(run.start_energy, rel=1e-3)


def test_free_motion_keeps_energy_less_damping():
    omega, Phi_b, q, v = lively()
    of = model(omega, Phi_b, 0.0)
    run = massless(one_rod(1, 1, gap=1e9), of, 0.02, 1e-2, 2000, q, v)
    lost = run.start_energy - run.ledger.blade
    assert lost > 0.5 * run.start_energy
    assert run.ledger.damping == pytest.approx(lost, rel=1e-10)


@pytest.mark.parametrize(("share", "end"), [(0.99, RUNNING), (1.01, ESCAPED)])
def test_the_step_limit_is_sharp_with_all_strips_engaged(share, end):
    """Rods that always bear, from near their equilibrium: the system is linear."""
    omega, Phi_b, _, v = lively(2, start=1e-6)
    of, k, depth = model(omega, Phi_b, RESIDUAL), 40.0, 9.0
    limit = step_limit(of, np.full(2, k))
    assert limit < 0.99 * 2 / omega.max()
    engaged = Phi_b.T @ np.linalg.inv(RESIDUAL + np.eye(2) / k)
    q = -np.linalg.solve(np.diag(omega**2) + engaged @ Phi_b, engaged.sum(axis=1)) * depth
    system = strips(Hooke(k), [-depth, -depth], np.zeros(4), area=100.0, thickness=100.0)
    h = share * limit
    at_rest = h / 2 * omega**2 * q  # half a step later
    run = massless(system, of, 0.0, h, 4000, q, at_rest + v, bound=20.0)
    assert run.end == end


def swinging(length, steps):
    """Wear of a blade that swings over rods too small to disturb it, and its deepest reach."""
    nu, depth, thickness, omega, (E, K) = 40, 1.5, 9.0, 2 * np.pi * 7.3, (5.0, 2.0)
    system = strips(
        one_rod(E, K).law, -depth, np.zeros(nu), length, 1e-12, thickness, advance=nu / steps
    )
    of = model([omega], [[1.0]], 0.0)
    run = massless(system, of, 0.0, 1 / steps, steps, [1.0], [0.0])
    times, middle = np.linspace(0, 1, 200_001), (np.ceil(length) - 1) / 2
    u, reach = np.cos(omega * times), np.zeros(nu)
    for rod in range(nu):
        for away in (0, -nu):
            over = abs(times * nu + middle + away - rod) <= length / 2
            reach[rod] = max(reach[rod], depth + u[over].max(initial=-depth))
    return thickness * run.eps_p[0] * (E + K) / E, reach


@pytest.mark.parametrize("length", [1.303, 4.707])
def test_wear_is_of_second_order_in_the_step(length):
    """Against the continuous swing; the error is that of leapfrog's frequency."""
    errors = []
    for steps in (100, 200, 400, 800):
        worn, reach = swinging(length, steps)
        errors.append(abs(worn - reach).max())
    assert errors[-1] < 1e-2
    assert np.polyfit(np.log([1, 2, 4, 8]), np.log(errors), 1)[0] < -1.7, errors


def rubbing(steps, **law):
    """Two revolutions at 0.3 f1(0) over an oval casing."""
    return scene(
        casing__ramp_rounds=0.5,
        integrator=of_steps(steps),
        liner__law=law,
        record__history__chord=over_strips(2),
    )


PLASTIC = {"kind": "plastic", "E": 1.0, "K": 0.45, "sigma_Y": 1e-8, "unit_MPa": 2000}
LAWS = [PLASTIC, {"kind": "elastic", "E": 1.0, "unit_MPa": 2000}, {"kind": "rigid"}]


def apart(one, other):
    """Largest relative difference of displacements and wear."""
    pairs = [(one.u_r, other.u_r), (one.wear, other.wear)]
    return max(abs(a - b).max() / abs(b).max() for a, b in pairs if b.any())


@pytest.mark.parametrize("law", LAWS[:2], ids=lambda law: law["kind"])
def test_with_all_modes_and_short_steps_the_run_is_that_of_the_product(coarse_rom, law):
    """Leapfrog of all modes errs by (w h)^2/24 in their frequencies."""
    case = rubbing(131072, **law)
    setup = set_up(case, coarse_rom)
    run, own = massless_run(case, setup, macneal(setup, coarse_rom.n)), own_run(case, setup)
    assert run.contacts > 0.2 * 2 * setup.steps
    assert apart(run, own) < 2e-5


def left(case, setup, models):
    """What is left of the difference from the product at short steps, for each model."""
    own = own_run(case, setup)
    return [apart(massless_run(case, setup, of), own) for of in models]


@pytest.mark.parametrize("law", LAWS, ids=lambda law: law["kind"])
def test_with_more_dynamic_modes_the_run_nears_that_of_the_product(coarse_rom, law):
    """What is left is the inertia of the other modes: most on a rigid casing."""
    case = rubbing(32768, **law)
    setup = set_up(case, coarse_rom)
    found = left(case, setup, [macneal(setup, r) for r in (6, 16, 30)])
    assert found[0] > found[1] > found[2], found
    assert found[2] < (3e-3 if law["kind"] == "rigid" else 1e-3), found


def test_the_reduction_of_craig_and_bampton_nears_it_too(coarse_rom):
    """It drops the mass of the interface, which MacNeal's shares among the free modes."""
    case = rubbing(32768, **PLASTIC)
    setup = set_up(case, coarse_rom)
    places = np.array([*JUDGED, *case.record.history.chord])
    found = left(case, setup, [craig_bampton(setup, coarse_rom, places, r) for r in (6, 16, 30)])
    assert found[0] > found[1] > found[2], found
    assert found[2] < 1e-2, found


def test_both_reductions_keep_the_static_compliance(coarse_rom):
    """That of the interface, and from it to the outputs, whatever the number of modes."""
    case = rubbing(640, **PLASTIC)
    setup = set_up(case, coarse_rom)
    places = np.array([*JUDGED, *case.record.history.chord])
    flexibility = np.linalg.inv(coarse_rom.stiffness(setup.Omega))
    P, P_out = coarse_rom.rows(setup.places.xi), coarse_rom.rows(places)
    for of in (macneal(setup, 9), craig_bampton(setup, coarse_rom, places, 9)):
        moved = of.Phi_b / of.omega**2
        for rows, residual, out in ((of.Phi_b, of.R, P), (of.Phi_out, of.R_out, P_out)):
            exact = out @ flexibility @ P.T
            least = 1e-10 * abs(exact).max()  # entries that cancel
            np.testing.assert_allclose(rows @ moved.T + residual, exact, rtol=1e-9, atol=least)


def test_static_modes_in_the_product_s_scheme_have_the_same_limit(coarse_rom):
    """The same equations by another scheme; first order in the step, four times as near."""
    differences = []
    for steps in (16384, 65536):
        case = rubbing(steps, **LAWS[1])
        setup = set_up(case, coarse_rom)
        static = own_run(case, setup, exact_but_static(setup, case.damping_ratio, 6))
        differences.append(apart(static, massless_run(case, setup, macneal(setup, 6))))
    assert differences[1] < 1e-3
    assert 3 < differences[0] / differences[1] < 5, differences
