"""Sliding friction: closed forms of one mode, the unsymmetric solve, the peer, the ledger."""

from itertools import combinations

import numba
import numpy as np
import pytest
from refused import refused
from runs import marched, set_up, swept
from scenes import blade_balance, of_steps, scene
from systems import elastic_rod, march_exact, strips
from test_interface_force import assert_solved, from_another_guess, interface, plain_newton

from geometry.base import SettingsError
from simulate.contact.kernel_file import key
from simulate.marching import SceneError, march, strip_stiffness
from simulate.marching.friction import LEAST, PLACES, growth_rate, monotony, mu_crit
from simulate.marching.kernel import march_round
from simulate.marching.run import _start

DEPTH = 1e-3  # m, of the casing into a blade at rest


def rubbing(mu, **changes):
    """A scene with friction."""
    given = {"casing__ramp_rounds": 1, "contact": {"friction": mu}, "integrator": of_steps(1024)}
    return scene(**given | changes)


OMEGA, K, PHI_R, PHI_T = 1.0, 4.0, 0.8, -9.0  # one mode, and its liner
MODE = np.array([OMEGA]), np.array([[PHI_R]]), np.array([[PHI_T]])


def bracket(mu, phi_t=PHI_T):
    """Stiffness of the engaged mode, and where it would stay."""
    stiffness = OMEGA**2 + K * PHI_R * (PHI_R + mu * phi_t)
    return stiffness, K * (PHI_R + mu * phi_t) * DEPTH / stiffness


@pytest.mark.parametrize("zeta", [0.0, 0.1])
@pytest.mark.parametrize("mu", [0.2, 0.5, 1.0])
def test_one_mode_grows_at_the_rate_of_the_closed_form(mu, zeta):
    """Eq. (d), of second order in the step, along its own direction: q* + c e^(s t).

    There is a gap where the blade is at rest: the place q* where it would stay is inside the liner.
    """
    c, time, (stiffness, q) = 1e-6, 2.0, bracket(mu)
    assert stiffness < 0
    s = np.sqrt(-stiffness + (zeta * OMEGA) ** 2) - zeta * OMEGA
    assert growth_rate(MODE, mu, zeta, np.array([K])) == pytest.approx(s, rel=1e-12)
    grown, errors = c * np.exp(s * time), []
    for steps in (200, 400, 800):
        run = march_exact(
            elastic_rod(K, gap=DEPTH), [OMEGA], [[PHI_R]], zeta, time / steps, steps,
            [q + c], [s * c], w_end=0.0, sliding=(mu, PHI_T),
        )  # fmt: skip
        errors.append(abs(run.u[-1, 0] / PHI_R - q - grown) / grown)
        assert run.contacts == steps
        assert run.ledger.friction > 0
    assert errors[-1] < 1e-3
    np.testing.assert_allclose(np.log2(np.divide(errors[:-1], errors[1:])), 2, atol=0.1)


@pytest.mark.parametrize("steps_per_time", [1, 30, 1000])
@pytest.mark.parametrize("over", [0.999, -0.9, 0.0])
def test_one_mode_below_mu_crit_stays_bounded_whatever_the_step(over, steps_per_time):
    """``over``: friction over the critical one; mode and liner as above."""
    critical = -(OMEGA**2 / K + PHI_R**2) / (PHI_R * PHI_T)
    assert mu_crit(MODE, np.array([K])) == pytest.approx(critical, rel=1e-12)
    away = *MODE[:2], -MODE[2]  # friction moves the blade away: nothing locks
    assert mu_crit(away, np.array([K])) == np.inf
    mu, phi_t = abs(over) * critical, np.sign(over) * PHI_T
    rest = -bracket(mu, phi_t)[1]
    run = march_exact(
        elastic_rod(K, gap=-DEPTH), [OMEGA], [[PHI_R]], 0.0, 1 / steps_per_time, 3000,
        [rest + 1e-6], [0.0], sliding=(mu, phi_t),
    )  # fmt: skip
    assert abs(run.u[:, 0] / PHI_R - rest).max() < 1.05e-6  # round-off, where hardly stiff


def unsymmetric(seed, casing=False):
    """A random interface whose A is unsymmetric and meets Eq. (b) by ``LEAST`` to all."""
    system = interface(seed, casing=casing)
    rng = np.random.default_rng([seed, 1])
    m, k = len(system.v), system.law.E * system.depth.shape[1]
    apart = np.sqrt(np.diag(system.C))
    S = system.C + rng.choice([0.1, 1, 10]) * rng.normal(size=(m, m)) * np.outer(apart, apart)
    symmetric = (S + S.T) / 2
    lowest = np.linalg.eigvalsh(symmetric)[0]
    bound = (1 - LEAST * 10 ** rng.uniform(0, 1.5)) / k
    if lowest < -bound:  # as little as is allowed, or a share of it
        S = S * (bound / -lowest) if rng.random() < 0.5 else S - (lowest + bound) * np.eye(m)
    return system._replace(C=S, slides=True)


def test_forces_are_those_of_the_rods_under_an_unsymmetric_compliance():
    """Stiffness times compliance over 24 decades; plain Newton's method cycles in some."""
    made = [unsymmetric(seed) for seed in range(1000)]
    for system in made:
        assert_solved(system)
    assert sum(not plain_newton(system) for system in made) > 30


def test_the_first_guess_does_not_matter():
    """The solution is unique, as Eq. (b) says; a change by round-off is one of the condition."""
    for seed in range(300):
        off, scale = from_another_guess(unsymmetric(seed), seed)
        assert (off <= 1e-8 * scale.max()).all(), seed


def test_an_interface_that_breaks_the_condition_may_have_several_solutions():
    """One strip, 1 + A k < 0: w = v - A F, F = k max(w, 0) holds at w = v and at v / (1 + A k)."""
    k, A = 2.0, -1.0
    modes = np.array([1e-6]), np.array([[1.0]]), np.array([[-2.0]])
    h = np.sqrt(2.0)  # gain 1: A = 1 - 2 mu
    assert monotony(modes, 1.0, 0.0, h, np.array([k])) == pytest.approx(1 + k * A, rel=1e-6)


def test_its_kernel_is_kept_for_other_processes(coarse_rom):
    """A kernel that reads a whole module has no key: each process would compile it."""
    case = rubbing(0.1)
    arguments = _start(set_up(case, coarse_rom), case.record, case.rounds, case.until).arguments
    assert key(march_round, tuple(map(numba.typeof, arguments(0))))


def test_energies_of_a_scene_with_friction_balance(coarse_rom):
    """Blade, and liner; heat and the work on the blade are those of t_T = mu t_N."""
    of = rubbing(0.2, rounds=4, integrator=of_steps(2048))
    setup = set_up(of, coarse_rom, 0.36)
    outcome = march(of, setup)
    ledger = outcome.ledger
    assert outcome.status == "ok" and outcome.contact_share > 0.02
    ratio = outcome.force_tangential_mean.sum() / outcome.force_mean.sum()
    assert ratio == pytest.approx(0.2, rel=1e-10)
    assert abs(blade_balance(ledger)) < 1e-10 * ledger.damping
    assert -1e-6 * ledger.casing < ledger.numerical < 1e-12 * ledger.casing
    # the shaft turns at Omega against the mean tangential force over all strips' radii
    radius = setup.places.radius.mean()
    shaft = outcome.force_tangential_mean.sum() * radius * 2 * np.pi
    assert ledger.heat + ledger.friction == pytest.approx(
        shaft, rel=1e-2 * np.ptp(setup.places.radius) / radius + 1e-3
    )
    assert abs(ledger.friction) > 1e-4 * ledger.casing


def test_a_rigid_blade_heats_by_friction_times_the_arc_it_slid():
    """Pressed by a constant depth into an elastic liner: heat mu F Omega r t, no work."""
    k, nu, steps, mu = 5.0, 40, 400, 0.3
    system = strips(
        elastic_rod(k).law, -0.1, np.zeros(nu), length=2.6, advance=nu / steps, pitch=0.02
    )
    run = march_exact(
        system, [1.0], [[1e-9]], 0.0, 1e-3, steps, [0.0], [0.0], sliding=(mu, [[1e-9]])
    )
    arc, F = nu * 0.02, k * 2.6 * 0.1
    assert run.ledger.heat == pytest.approx(mu * F * arc, rel=1e-10)
    assert run.ledger.friction == pytest.approx(0, abs=1e-12)
    assert run.force[0, 2, 0] / steps == pytest.approx(mu * F, rel=1e-10)


def test_engaged_strips_lock_where_a_determinant_vanishes():
    """Of all sets of neighbouring strips the one that locks at the least friction."""
    rng, m, shares = np.random.default_rng(3), 5, np.linspace(0, 1, 201)[:, None, None]
    sets = [slice(*ends) for ends in combinations(range(m + 1), 2)]
    locked = set()
    for _ in range(200):
        omega, Phi_b, Phi_t = rng.uniform(1, 9, 8), rng.normal(size=(m, 8)), rng.normal(size=(m, 8))
        k, static = rng.uniform(1, 5, m), Phi_b / omega**2
        mu = mu_crit((omega, Phi_b, Phi_t), k)
        A = np.diag(1 / k) + static @ Phi_b.T + shares * mu * (static @ Phi_t.T)
        of_sets = np.array([np.linalg.det(A[:, part, part]) for part in sets])
        over = of_sets / of_sets[:, :1]  # those without friction
        assert abs(over[:, -1].min()) < 1e-10
        assert over[:, :-1].min() > 1e-5
        locked.add(int(over[:, -1].argmin()))
    assert locked == {*range(len(sets))}


def test_of_many_strips_sets_lie_between_places_of_the_chord():
    """Each strip of 64 is two alike of 32: the pairs lock as their strips would."""
    rng, m = np.random.default_rng(4), PLACES
    omega, Phi_b, Phi_t = rng.uniform(1, 9, 80), *rng.normal(size=(2, m, 80))
    k = rng.uniform(1, 5, m)
    halves = [np.repeat(of, 2, axis=0) for of in (Phi_b, Phi_t, k / 2)]
    of_halves = mu_crit((omega, *halves[:2]), halves[2])
    assert of_halves == pytest.approx(mu_crit((omega, Phi_b, Phi_t), k), rel=1e-9)


def test_wear_runs_away_beyond_the_friction_at_which_strips_lock(coarse_rom):
    """mu_crit is of elastic rods; those that yield are softer: at twice of it the liner is gone."""
    of = rubbing(0.1)
    setup = set_up(of, coarse_rom, 0.36)
    k = strip_stiffness(of.liner, setup.places)
    critical = mu_crit((setup.omega, setup.Phi_b, setup.Phi_t), k)
    below, without, beyond = (
        marched(rubbing(mu, rounds=6), coarse_rom, 0.36)
        for mu in (0.8 * critical, 1e-6, 2 * critical)
    )
    assert below.status == "ok" and below.wear.max() < 1.5 * without.wear.max()
    assert beyond.status == "liner-exhausted" and beyond.ledger.friction > 0.1 * beyond.ledger.work


REFUSED = {
    "friction and profile's own": {
        "contact": {"friction": 0.1, "tangential": True, "profile": {"tilt": 0.01}}
    },
    "central differences": {
        "integrator": {"scheme": "central-difference", "fraction_of_limit": 0.5}
    },
    "rigid": {"liner__law": {"kind": "rigid"}},
    "no contact": {"liner__law": {"kind": "none"}},
    "worn through": {"liner__worn_through": "casing"},
    "negative": {"contact": {"friction": -0.1}},
}


@pytest.mark.parametrize("case", REFUSED)
def test_scenes_that_friction_does_not_go_with_are_refused(case):
    assert refused(SettingsError, rubbing, 0.1, **REFUSED[case]).key == "contact.friction"


def test_a_step_without_a_unique_solution_is_refused_with_one_that_has(coarse_rom):
    """A slow blade on a stiff liner: its step is long enough to lock."""
    more = {"speeds": {"over_f1": [0.001]}, "liner__law__E": 10.0, "integrator": of_steps(4096)}
    of = rubbing(0.3, **more)
    error = refused(SceneError, set_up, of, coarse_rom, 0.001)
    assert (error.key, error.value) == ("integrator.steps_per_round", 4096)
    set_up(of.but(integrator__steps_per_round=error.allowed), coarse_rom, 0.001)
    assert error.allowed % 4096 == 0


def test_the_least_sliding_speed_is_that_of_the_tip():
    """A tip that swings tangentially by c cos(omega t), pressed all the time."""
    nu, steps, c = 40, 4000, 1e-3
    system = strips(
        elastic_rod(5.0).law, -0.1, np.zeros(nu), 2.6, 1e-9, advance=nu / steps, pitch=1e-3
    )
    swings = [2 * np.pi], [[1e-9]], 0.0, 1 / steps, steps, [c], [0.0]
    run = march_exact(system, *swings, sliding=(0.1, [[1.0]]))
    assert run.least_sliding == pytest.approx(1 - c * 2 * np.pi / (nu * 1e-3), rel=1e-4)


def test_a_sweep_tells_friction_and_leaves_it_out_without(coarse_rom):
    run, bare = (swept(rubbing(mu), coarse_rom) for mu in (0.1, None))
    told = {"mu_crit", "growth_rate", "least_sliding"}
    assert told <= set(run) and "force_tangential_mean" in run
    assert {"friction", "heat"} <= set(run["energy"].values)
    energies = run["ledger"].isel(speed_over_f1=0)
    formula = run["energy"].attrs["long_name"].partition("numerical: ")[2].partition(" = ")[2]
    terms = {str(name): energies.sel(energy=name).item() for name in energies["energy"].values}
    said = eval(formula.partition(";")[0], {}, terms)
    assert terms["numerical"] == pytest.approx(said, rel=1e-9)
    assert not told & set(bare)
    assert not {"friction", "heat"} & set(bare["energy"].values)
