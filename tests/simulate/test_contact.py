from fractions import Fraction
from itertools import pairwise

import numba
import numpy as np
import pytest
from systems import (  # `strips` is a field that compiled functions read
    FLAT,
    Hooke,
    Parameters,
    strips as strips_of,
)

from simulate.contact.compiled import for_types_of, records
from simulate.contact.places import rods_in_footprint
from simulate.contact.rod_law import rod_law
from simulate.contact.rods import (
    ROD,
    contact_force,
    cover,
    deepest_reach,
    fill,
    mean_stress,
    nothing_covered,
    press,
    widen,
)
from simulate.contact.strips import (
    Tip,
    contact_free,
    covered_share,
    rod_under,
)
from simulate.marching.modal import Step
from simulate.scene.laws.elastic import Elastic
from simulate.scene.laws.plastic import Plastic

LAW = Parameters(E=2.0, K=1.0, sigma_Y=0.0)


def from_cache(function, *arguments):
    """Call a compiled function, which is compiled once for all runs of the tests."""
    return for_types_of(function, *arguments)(*arguments)


@numba.njit
def press_all(system, covered, eps_p, u, a, step, force):
    energies = np.zeros(5)
    for i in range(force.size):
        now = Step(step, a, a, 0, 0, 0)
        cover(system, covered, eps_p, i, now, 0.0, u[i], 0.0, 0.0, 0.0, 0.0, False, energies)
        force[i] = press(system, covered, eps_p, i, u[i], u[i], 0.0, 0.0, energies)[0]


def force_at(system, u, a=1.0, step=0, eps_p=None):
    """Forces at the end of a step and plastic strains after it; the rods under the nodes."""
    eps_p = np.zeros((len(system.g0), len(system.d))) if eps_p is None else eps_p
    force, covered = np.zeros(len(system.g0)), nothing_covered(system)
    from_cache(press_all, system, covered, eps_p, np.asarray(u, float), a, step, force)
    return force, eps_p, covered


@pytest.mark.parametrize("nu", [6, 16, 64, 400, 4096])
def test_force_of_a_uniform_penetration_does_not_depend_on_the_density(nu):
    radius, footprint, width = 0.5, 0.4, 0.01
    length = max(rods_in_footprint(footprint, radius, nu), 1.0)
    area = width * footprint / length
    system = strips_of(LAW, 0.0, np.zeros(nu), length, area, first=[0.37])
    force, _, _ = force_at(system, [0.1])
    tangent = LAW.E * LAW.K / (LAW.E + LAW.K)
    assert force[0] == pytest.approx(width * footprint * tangent * 0.1, rel=1e-13)


@pytest.mark.parametrize("length", [1.0, 2.3, 3.0])
def test_the_force_has_no_jumps_where_rods_come_and_go(length):
    """A tip that slides in small steps over an uneven casing: the force goes as far as the step."""
    rng, steps = np.random.default_rng(4), 2000
    d = rng.uniform(0, 1, 40)
    system = strips_of(LAW, 0.0, d, length, first=[0.2], advance=40 / steps)
    force = np.array([force_at(system, [0.1], step=step)[0][0] for step in range(steps)])
    assert abs(np.diff(force)).max() <= 2 / 3 * (40 / steps) * 1.0 * (1 + 1e-9)  # E_t A |d - d'|


@pytest.mark.parametrize("mean", [0.0, -5.0], ids=["either side", "outward everywhere"])
def test_safe_displacement_is_safe_and_tight(mean):
    rng = np.random.default_rng(3)
    nu, steps = 40, 400
    for _ in range(30):
        first, d = rng.uniform(0, nu, 2), rng.normal(mean, size=nu)
        system = strips_of(LAW, rng.uniform(0, 1, 2), d, 3.0, first=first, advance=nu / steps)
        start, a = int(rng.integers(0, steps - 50)), np.sort(rng.uniform(0, 1, 2))
        safe = np.zeros(2)
        from_cache(contact_free.outer, system, *a, start, start + 50, safe)
        span = range(start, start + 51)
        # the distortion grows monotonically: its ends bound it
        assert not any(
            force_at(system, safe - 1e-12, a=x, step=s)[0].any() for s in span for x in a
        )
        assert any(force_at(system, safe + 1e-9, a=x, step=s)[0].any() for s in span for x in a)


def test_rod_under_stays_on_the_circumference():
    """Also where the first rod, a remainder by nu, rounds to nu itself."""
    system = strips_of(
        LAW, [0] * 3, np.zeros(10), first=[0.0, np.nextafter(10, 0), 10.0], advance=10 / 7
    )
    for step in range(8):
        assert all(0 <= rod_under(system, i, step) < 10 for i in range(3))


def plastic_paths():
    """Plastic strain at which a rod has yielded before, and total strains between its kinks."""
    for eps_p in (0.0, 0.031, 0.4):
        opens, yields = eps_p, eps_p + (0.02 + 1.3 * eps_p) / 3.0
        yield eps_p, [-0.7, 0.6 * opens, opens, (opens + yields) / 2, yields, 1.1 * yields, 0.9]


PATHS = [  # law, plastic strain, strain at the start, strain at the end
    (law, parameters, eps_p, start, end)
    for law, parameters in ((Plastic, Parameters(3.0, 1.3, 0.02)), (Elastic, Hooke(3.0)))
    for eps_p, strains in (plastic_paths() if law is Plastic else [(0.0, [-0.7, 0.0, 0.2, 0.9])])
    for start in strains
    for end in [*strains, *(start + way for way in (1e-3, -1e-6, 1e-9, -1e-12, 1e-12))]
]


def kinks(law, parameters, eps_p):
    """Strains at which the rod opens and yields."""
    if law is Elastic:
        return [0]
    return [eps_p, eps_p + (parameters.sigma_Y + parameters.K * eps_p) / parameters.E]


def exact_mean(law, parameters, start, end, eps_p):
    """Mean stress over the way, and the stress at its end: trapezoids between the kinks.

    In fractions: without round-off.
    """
    parameters = type(parameters)(*map(Fraction, parameters))
    start, end, eps_p = map(Fraction, (start, end, eps_p))

    def stress(eps):
        return law.stress(parameters, eps, eps_p)[0] if eps > 0 else Fraction(0)

    if start == end:
        return stress(end), stress(end)
    low, high = sorted([start, end])
    between = [kink for kink in kinks(law, parameters, eps_p) if low < kink < high]
    pieces = pairwise([low, *between, high])
    integral = sum((b - a) * (stress(a) + stress(b)) / 2 for a, b in pieces)
    return integral / (high - low), stress(end)


@numba.njit
def mean_to_each(law, rods, ends, w_end, found):
    for k in range(ends.size):
        found[:, k] = mean_stress(law, rods[0], ends[k], w_end)


def mean_of(law, start, ends, eps_p, w_end):
    """Mean stress of a rod on its way to each of ``ends``, and all else of its step."""
    rods, found = records(1, ROD), np.zeros((4, np.size(ends)))
    rods["start"], rods["eps_p"], rods["after"] = start, eps_p, eps_p
    if start > 0:
        rods["sigma"], rods["after"], _ = law.stress(law.parameters, start, eps_p)
    from_cache(mean_to_each, law, rods, np.atleast_1d(ends), w_end, found)
    return found.squeeze()


@pytest.mark.parametrize("w_end", [0.0, 0.3, 1.0])
def test_the_mean_stress_is_the_integral_over_the_way(w_end):
    """Open, bearing, yielding, and any of these to any other; also where the way is tiny or 0.

    Its slope is its derivative: by central differences of the exact mean, away from the kinks of
    the stress at the end.
    """
    checked, step = 0, 1e-6
    for law, parameters, before, start, end in PATHS:

        def exact(to, of=(law, parameters, start, before)):
            mean, at_end = exact_mean(*of[:3], to, of[3])
            return w_end * at_end + (1 - Fraction(w_end)) * mean, at_end

        mean, sigma, after, slope = mean_of(rod_law(law, parameters), start, end, before, w_end)
        both, at_end = exact(end)
        # round-off of the strains, which may cancel, times the modulus
        allowed = 4e-16 * float(max(both, at_end)) + 4e-16 * parameters.E * max(start, 1e-3)
        assert abs(Fraction(mean) - both) <= allowed, (law, before, start, end)
        assert abs(Fraction(sigma) - at_end) <= allowed, (law, before, start, end)
        assert before <= after == (law.stress(parameters, end, before)[1] if end > 0 else before)
        off = [end - kink for kink in [start, *kinks(law, parameters, before)]]
        if np.abs(off).min() > 2e-4:
            below, above = (exact(end + x)[0] for x in (-step, step))
            assert slope == pytest.approx(float(above - below) / (2 * step), abs=1e-6)
            checked += 1
    assert checked > 100


@pytest.mark.parametrize("w_end", [0.0, 0.01, 1.0])
def test_the_mean_stress_grows_with_the_strain_at_the_end(w_end):
    """Through zero ways and the kinks; so the force of a step is unique."""
    for law, parameters, before, start, _ in PATHS[:: len(PATHS) // 60]:
        rod = rod_law(law, parameters)
        ways = np.concatenate(
            [-np.geomspace(1.0, 1e-13, 200), [0.0], np.geomspace(1e-13, 1.0, 200)]
        )
        ends = start + ways
        mean, _, _, slope = mean_of(rod, start, ends, before, w_end)
        round_off = 1e-15 * (mean.max() + parameters.E * max(before, 1e-3))
        assert np.diff(mean).min() >= -round_off
        assert slope.min() >= -1e-12 and slope.max() <= parameters.E * (1 + 1e-3)


def rounded(tilt, drop, half):
    """A tip of these, as ``marching.setup`` makes it."""
    curvature = drop / half**2
    apex = -np.clip(tilt / (2 * curvature), -half, half) if curvature else -half * np.sign(tilt)
    return Tip(tilt, curvature, float(apex), half)


LENGTH, PITCH = 3.3, 0.2
TIPS = {
    "flat": FLAT,
    "tilted": rounded(0.3, 0.0, LENGTH * PITCH / 2),
    "tilted back": rounded(-0.3, 0.0, LENGTH * PITCH / 2),
    "rounded": rounded(0.0, 0.1, LENGTH * PITCH / 2),
    "rounded and tilted": rounded(0.4, 0.1, LENGTH * PITCH / 2),
}


@numba.njit
def reach_all(system, covered, step, w_from, w, share, reach):
    eps_p, now = np.zeros((1, system.d.size)), Step(step, 1.0, 1.0, 0, 0, 0)
    cover(system, covered, eps_p, 0, now, w_from, w, 0.0, 0.0, 0.0, 0.0, True, np.zeros(5))
    strip = covered.strips[0]
    for k in range(reach.size):
        first, last = covered_share(system, 0, k, strip.passed, strip.slid)
        share[k] = last - first
        reach[k] = deepest_reach(system, covered, 0, k, w_from, w, 0.0, 0.0, first, last)


@pytest.mark.parametrize("advance", [0.1, 0.7, 2.5])
@pytest.mark.parametrize("tip", TIPS)
def test_the_deepest_reach_over_a_centre_is_that_of_ten_thousand_times_in_the_step(tip, advance):
    """And the share of the step in which it is covered; no other rod of the round is.

    Rods that are left out as out of reach are not touched.
    """
    rng, nu, times = np.random.default_rng(8), 40, (np.arange(10_000) + 0.5) / 10_000
    d, gap, tip, left_out = rng.uniform(0, 0.05, nu), 0.02, TIPS[tip], 0
    for step in range(60):
        system = strips_of(
            LAW, gap, d, LENGTH, first=[rng.uniform(0, nu)], advance=advance, pitch=PITCH, tip=tip
        )
        covered, (w_from, w) = nothing_covered(system), rng.uniform(-0.1, 0.1, 2)
        window = covered.rods.shape[1]
        share, reach = np.zeros((2, window))
        from_cache(reach_all, system, covered, step, w_from, w, share, reach)
        camber = (
            system.first[0] + system.partly_covered + step * advance + (system.rods_covered - 1) / 2
        )
        off = (np.arange(nu) - camber + nu / 2) % nu - nu / 2
        x = off[:, None] - (times - 0.5) * advance  # from the camber line to each centre, rods
        s = np.clip(PITCH * x, -tip.half, tip.half)
        p = tip.tilt * (s - tip.apex) + tip.curvature * (s**2 - tip.apex**2)
        deep = d[:, None] - gap + w_from + times * (w - w_from) - p
        under = abs(x) <= LENGTH / 2
        met = (covered.strips["at"][0] + np.arange(window)) % nu
        assert not np.delete(under, met, axis=0).any()
        speed = abs(w - w_from) + advance * PITCH * abs(tip.tilt) + advance * abs(tip.curvature)
        for k, rod in enumerate(met):
            assert share[k] == pytest.approx(under[rod].mean(), abs=1.1e-4)
            if under[rod].any():
                deepest = deep[rod, under[rod]].max()
                if covered.strips["low"][0] <= k < covered.strips["high"][0]:
                    assert -1e-12 <= reach[k] - deepest <= 1e-4 * speed
                else:
                    left_out += 1
                    assert deepest <= 0
    assert (left_out > 0) == (tip.half > 0)


@numba.njit
def bearing_up_to(system, covered, w, deeper, widened):
    """Force at a displacement ``deeper`` than ``w``, for which the rods were found."""
    eps_p, now = np.zeros((1, system.d.size)), Step(3, 1.0, 1.0, 0, 0, 0)
    cover(system, covered, eps_p, 0, now, -0.1, w, 0.0, 0.0, 0.0, 0.0, True, np.zeros(5))
    if widened == "by itself":
        widen(system, covered, eps_p, 0, -0.1, w, 0.0, 0.0)
    elif widened == "all anew":
        window = covered.rods.shape[1]
        fill(system, covered, eps_p, 0, 0, window, 0, -0.1, w, 0.0, 0.0, True)
        covered.strips[0].low, covered.strips[0].high = 0, window
    return contact_force(system, covered, 0, deeper, 0.0)


@pytest.mark.parametrize("tip", [name for name in TIPS if name != "flat"])
def test_rods_that_forces_lift_the_tip_onto_bear_too(tip):
    d = np.random.default_rng(5).uniform(0, 0.05, 90)
    system = strips_of(LAW, 0.02, d, 30.3, first=[4.2], advance=1.7, pitch=0.02, tip=TIPS[tip])
    few, wide, every = (
        from_cache(bearing_up_to, system, nothing_covered(system), 0.0, 0.4, widened)
        for widened in ("", "by itself", "all anew")
    )
    assert few[0] < 0.9 * every[0]
    np.testing.assert_array_equal(wide, every)
