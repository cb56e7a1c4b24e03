"""Whole runs on the coarse blade's reduced model."""

from dataclasses import asdict, replace

import numpy as np
import pytest
from refused import refused
from runs import marched, set_up, swept
from scenes import SCHEMES, of_steps, over_strips, scene, softened

from geometry.blade import EnrichedBasis
from rom.reduce import reduce
from simulate.contact.kernel_file import kernel
from simulate.marching import SceneError, check_scene, march, strip_stiffness

CENTRAL, EXACT = "central-difference", "piecewise-exact"


@pytest.mark.parametrize("integrator", [SCHEMES[CENTRAL], of_steps(2048), of_steps(1024)])
def test_a_strip_covers_its_footprint(coarse_rom, integrator):
    """Area w L and stiffness E w L / l each, centred on its place, or half a step before it."""
    more = {"liner__rods_per_round": 4096, "liner__footprint_mm": 6}
    case = scene(integrator=integrator, **more)
    setup = set_up(case, coarse_rom)
    strips, places = setup.strips, setup.places
    pitch = 2 * np.pi * coarse_rom.camber[:, 0].mean() / 4096  # 0.86 mm
    assert strips.length == pytest.approx(6e-3 / pitch, rel=1e-14) and strips.rods_covered == 7
    np.testing.assert_allclose(strips.area * strips.length, places.width * 6e-3, rtol=1e-14)
    engaged = strips.law.parameters.E * strips.area * strips.length / strips.thickness
    np.testing.assert_allclose(strip_stiffness(case.liner, places), engaged, rtol=1e-14)
    before = 0 if integrator["scheme"] == CENTRAL else strips.advance / 2
    middle = strips.first + strips.partly_covered + (strips.rods_covered - 1) / 2 + before
    off = middle * 2 * np.pi / 4096 - coarse_rom.line(places.xi)[:, 1]
    np.testing.assert_allclose((off + np.pi) % (2 * np.pi) - np.pi, 0, atol=1e-12)


@pytest.mark.parametrize("share", [0.5, 1.0])
def test_a_step_is_a_share_of_the_limit_and_divides_the_round(coarse_rom, share):
    setup = set_up(scene(integrator__fraction_of_limit=share), coarse_rom)
    assert 0.98 * share * setup.limit < setup.h <= share * setup.limit
    assert setup.steps % 64 == 0


def test_the_steps_that_the_message_allows_are_accepted(coarse_rom):
    def case(steps):
        return scene(integrator=of_steps(steps, CENTRAL))

    error = refused(SceneError, set_up, case(6400), coarse_rom)
    assert (error.key, error.value) == ("integrator.steps_per_round", 6400)
    least = error.allowed["ge"]
    assert set_up(case(least), coarse_rom).steps == least
    refused(SceneError, set_up, case(least - 64), coarse_rom)
    short = scene(integrator__fraction_of_limit=1e-9)
    assert refused(SceneError, set_up, short, coarse_rom).key == "integrator"


@pytest.mark.parametrize("scheme", [CENTRAL, EXACT])
@pytest.mark.parametrize(("first", "last", "strip"), [(1.5e-4, 4.3e-4, 0), (4.3e-4, 1.5e-4, 7)])
def test_a_run_ends_in_the_step_in_which_the_tip_wears_through(
    coarse_rom, scheme, first, last, strip
):
    """A casing moves evenly inward; the liner is too soft to move the blade: a closed form.

    The casing of a step is that of its end in central differences, of its middle in the other.
    """
    thickness, per_round, end = 1e-3, 64_000, 96_000
    gap, before = 1.5e-4 * coarse_rom.span, 0.5 if scheme == EXACT else 0.0
    reaches = (thickness + gap) / smooth((end - before - 0.5) / per_round / 4)
    case = scene(
        rounds=3,
        clearance={"leading_edge_over_span": first, "trailing_edge_over_span": last},
        casing={"ramp_rounds": 4, "harmonics": [{"order": 0, "amplitude_m": reaches}]},
        liner__thickness_m=thickness,
        integrator=of_steps(per_round, scheme),
    )
    case = softened(case, 1e-6)
    setup = set_up(case, coarse_rom)
    outcome, places = march(case, setup), setup.places
    assert (outcome.status, outcome.rounds) == ("liner-exhausted", 1.5)
    assert outcome.xi == places.xi[strip]
    off = outcome.theta - places.theta[strip] - np.pi  # half a round on
    assert abs((off + np.pi) % (2 * np.pi) - np.pi) <= np.pi / 512 * (1 + 1e-9)
    assert 0 <= outcome.theta < 2 * np.pi
    # the tip comes through before the sample at that step is taken
    assert np.isfinite(outcome.u_r[:95]).all() and np.isnan(outcome.u_r[95:]).all()
    # loaded along E K / (E + K) over its width by 5 mm; mean over the steps that were marched
    share = smooth((np.arange(1, end + 1) - before) / per_round / 4)
    area = places.width[strip] * 5e-3
    force = 0.45 / 1.45 * area * np.maximum(reaches * share - gap, 0) / thickness
    expected = [force[:per_round].mean(), force[per_round:].mean()]
    np.testing.assert_allclose(outcome.force_mean[:2, strip], expected, rtol=1e-6)
    assert outcome.force_peak[1, strip] == pytest.approx(force[-1], rel=1e-6)
    assert np.isnan(outcome.force_mean[2]).all()


def smooth(x):
    """The ramp, up to its end."""
    return x**2 * (3 - 2 * x)


@pytest.mark.parametrize("scheme", [CENTRAL, EXACT])
def test_a_blade_alone_does_not_move(coarse_rom, scheme):
    """It is not meant to rub: that nothing touches has no reason."""
    case = scene(liner__law={"kind": "none"}, integrator=of_steps(64_000, scheme))
    outcome = marched(case, coarse_rom)
    found = outcome.status, outcome.rounds, outcome.contact_share, outcome.reason
    assert found == ("ok", 2, 0, "")
    assert not outcome.u_r.any() and not outcome.wear.any() and not outcome.force_peak.any()
    assert not any(asdict(outcome.ledger).values())


def beyond_casing(case, setup, outcome):
    """Penetration of the tip into the deepest rod of each strip at every sample, (samples, m)."""
    rods, per_round = setup.strips, case.record.samples_per_round
    u_r = outcome.u_r[:, 1:]
    rounds = np.arange(1, len(u_r) + 1) / per_round
    a = np.where(rounds < case.casing.ramp_rounds, smooth(rounds / case.casing.ramp_rounds), 1.0)
    nu, lift = rods.d.size, np.empty(u_r.shape)
    for n in range(len(lift)):
        step = (n % per_round + 1) * setup.steps // per_round + 1 - rods.placed  # its end
        first = rods.first + rods.partly_covered + step * rods.advance
        for i, place in enumerate(first + (rods.rods_covered - 1) / 2):
            ends = place + np.array([-0.5, 0.5]) * rods.length[i]
            under = np.r_[ends[0], np.arange(np.ceil(ends[0]), ends[1]), ends[1]]
            d = np.interp(under, np.arange(nu), rods.d, period=nu)
            lift[n, i] = a[n] * d.max() - rods.g0[i]
    return u_r + lift


HARD = {
    "rounds": 2,
    "record": {
        "samples_per_round": 2048,
        "contact_force": True,
        "history": {"chord": over_strips()},
    },
}


@pytest.mark.slow
def test_no_strip_passes_a_rigid_casing(coarse_rom):
    """At the end of every step, each of which is a sample."""
    rigid = {"liner__law": {"kind": "rigid"}, "liner__footprint_mm": 15}
    case = scene(**rigid, **HARD, integrator=of_steps(2048))
    setup = set_up(case, coarse_rom, 0.33)
    outcome = march(case, setup)
    assert (outcome.status, outcome.rounds) == ("ok", 2)
    assert setup.strips.rods_covered == 3 and (outcome.force_peak.max(axis=0) > 0).all()
    beyond, round_off = beyond_casing(case, setup, outcome), 1e-12 * abs(outcome.u_r).max()
    assert abs(outcome.u_r).max() > setup.strips.g0[0]
    assert abs(beyond.max(axis=0)).max() < round_off  # each strip reaches it, none passes
    assert not outcome.wear.any()
    assert outcome.ledger.numerical <= 0


@pytest.mark.slow
def test_a_worn_through_liner_leaves_the_casing_to_stop_the_tip(coarse_rom):
    """A soft, thin coating at the crossing with eo(4)."""
    soft = {"liner__thickness_mm": 0.008, "liner__law__K": 0.01, "liner__rods_per_round": 8192}
    stopped = scene(**soft, **HARD, integrator=of_steps(65536))
    assert marched(stopped, coarse_rom, 0.31).status == "liner-exhausted"
    case = stopped.but(liner__worn_through="casing")
    setup = set_up(case, coarse_rom, 0.31)
    outcome = march(case, setup)
    assert (outcome.status, outcome.rounds) == ("ok", 2) and np.isnan(outcome.xi)
    beyond, thickness = beyond_casing(case, setup, outcome), setup.strips.thickness
    assert abs(beyond.max() - thickness) < 1e-12 * abs(outcome.u_r).max()
    # all the strain that a rod can have, less the elastic one; the line to its neighbour, one of
    # 8192 a round, keeps 4e-5 of it from the tip
    worn = (1 - 1e-8) / (1 + 0.01) * thickness
    # within a step the tip goes straight, from casing to casing, and these lines bend at a rod
    beyond = abs(np.diff(setup.strips.d, 2)).max() * setup.strips.advance / 4
    most = worn * (1 + beyond / thickness)
    assert (1 - 1e-4) * worn < outcome.wear.max() <= (1 + 1e-12) * most < (1 + 1e-6) * worn


@pytest.mark.parametrize("scheme", [CENTRAL, EXACT])
def test_a_motion_beyond_the_bound_ends_the_run_there(coarse_rom, scheme):
    """At the first sample at which any strip exceeds the bound, here a small one."""
    record = {"casing__ramp_rounds": 0, "record__history__chord": over_strips()}
    case = scene(**record, integrator=SCHEMES[scheme])
    setup = set_up(case, coarse_rom, 0.33)
    free = march(case, setup)
    bound = 0.9 * abs(free.u_r).max()
    first = np.argmax((abs(free.u_r) > bound).any(axis=1))
    assert first > 10
    ended = march(case, replace(setup, bound=bound))
    assert (ended.status, ended.rounds) == ("diverged", (first + 1) / 64)
    farthest = abs(free.u_r[first, 1:]).argmax()
    assert ended.xi == setup.places.xi[farthest]
    expected = (2 * np.pi * (first + 1) / 64 + setup.places.theta[farthest]) % (2 * np.pi)
    assert ended.theta == pytest.approx(expected, rel=1e-12)
    np.testing.assert_array_equal(ended.u_r[: first + 1], free.u_r[: first + 1])
    assert np.isnan(ended.u_r[first + 1 :]).all()


ROUND_TIP = {"contact__profile": {"edge_drop_um": 20}, "contact__tangential": True}


@pytest.mark.parametrize(
    ("changes", "key"),
    [
        (ROUND_TIP, "contact.tangential"),
        ({"contact": {"friction": 0.1}, "integrator": of_steps(1024)}, "contact.friction"),
    ],
)
def test_a_tangential_scene_needs_a_model_with_tangential_dofs(coarse_rom, changes, key):
    radial = replace(coarse_rom, directions=("radial",))
    assert refused(SceneError, check_scene, scene(**changes), radial).key == key
    check_scene(scene(contact__profile=ROUND_TIP["contact__profile"]), radial)


RIGID = {"liner__law": {"kind": "rigid"}, "integrator": of_steps(2048)}
BACKED = {"liner__worn_through": "casing", "integrator": of_steps(2048)}
ELASTIC = {"kind": "elastic", "E": 1.0, "unit_MPa": 2000}
ALONE = {"liner__law": {"kind": "none"}}


@pytest.mark.parametrize(
    ("changes", "key", "value", "allowed"),
    [
        (
            {"speeds": {"over_f1": [0.3, 0.6]}},
            "speeds.over_f1",
            0.6,
            {"le": pytest.approx(0.3989, rel=1e-4)},
        ),
        (
            {"speeds": {"rpm": [6700.0]}},
            "speeds.rpm",
            6700,
            {"le": pytest.approx(6207.04, rel=1e-6)},
        ),
        ({"blade": "other"}, "blade", "other", "coarse"),
        ({"clearance__trailing_edge_over_span": 2.3e-3}, "clearance", None, None),
        ({"clearance__trailing_edge_over_span": 9.9e-6}, "clearance", None, None),
        (RIGID | {"liner__strips": 9}, "liner.strips", 9, 8),
        (BACKED | {"liner__strips": 9}, "liner.strips", 9, 8),
        (RIGID | {"liner__strips": 7}, "liner.strips", 7, 8),
        (BACKED | {"liner__strips": 2}, "liner.strips", 2, 8),
        ({"liner__strips": 7}, "liner.strips", 7, {"ge": 8}),
        ({"liner__strips": 2, "liner__law": ELASTIC}, "liner.strips", 2, {"ge": 8}),
        ({"liner__rods_per_round": 10}, "liner.rods_per_round", 10, {"ge": 354}),
    ],
)
def test_a_scene_that_does_not_fit_the_blade_is_refused(coarse_rom, changes, key, value, allowed):
    error = refused(SceneError, swept, scene(**changes), coarse_rom)
    assert (error.key, error.value, error.allowed) == (key, value, allowed)


def test_a_footprint_around_a_small_blade_is_refused(coarse_rom):
    small = replace(coarse_rom, camber=coarse_rom.camber * [0.05, 1.0, 1.0])
    error = refused(SceneError, check_scene, scene(liner__footprint_mm=200), small)
    assert (error.key, error.value) == ("liner.footprint_mm", 200)


def test_gaps_that_differ_fifteenfold_are_accepted(coarse_rom):
    """The gap is then 0 at one edge, up to round-off."""
    check_scene(scene(clearance__trailing_edge_over_span=15 * 1.5e-4 - 1e-12), coarse_rom)


@pytest.mark.parametrize(
    ("changes", "strips"), [({}, (1, 8, 9)), (RIGID, (1, 8)), (BACKED, (1, 8)), (ALONE, (1, 2, 9))]
)
def test_strips_are_as_many_as_patches_or_one_and_on_a_liner_more(coarse_rom, changes, strips):
    """Without contact there is nothing that they could miss."""
    for m in strips:
        check_scene(scene(**changes, liner__strips=m), coarse_rom)


def test_what_is_refused_for_few_strips_names_both_keys_and_misses_what_the_blade_does(coarse_rom):
    """With half as many, their middles pass by the hats between; with twice as many, little."""
    for changes in ({}, RIGID):
        error = refused(SceneError, check_scene, scene(**changes, liner__strips=4), coarse_rom)
        assert error.key == "liner.strips" and "interface.patches of the blade" in error.text
    peaks = [abs(marched(scene(liner__strips=m), coarse_rom).u_r[:, 0]).max() for m in (4, 8, 16)]
    assert abs(peaks[0] - peaks[1]) > 4 * abs(peaks[2] - peaks[1])


@pytest.mark.parametrize("m", [7, 16])
def test_an_interface_of_points_has_a_strip_for_each(paper_reduced, m):
    rom, _ = paper_reduced
    check_scene(scene(blade="coarse-paper", liner__strips=8), rom)
    error = refused(SceneError, check_scene, scene(blade="coarse-paper", liner__strips=m), rom)
    assert (error.key, error.value, error.allowed) == ("liner.strips", m, 8)


@pytest.mark.parametrize("m", [1, 4, 8, 12, 16, 32])
def test_forces_are_sums_over_eighths_of_the_chord(coarse_rom, m):
    """Under a tilted tip each strip bears its own; those of twelve straddle the eighths.

    A casing pressed on a liner too soft to move the blade: constant, in closed form.
    """
    case = scene(
        rounds=1,
        casing={"ramp_rounds": 0, "harmonics": [{"order": 0, "amplitude_um": 100}]},
        liner__strips=m,
        integrator=of_steps(2048),
    )
    setup = set_up(softened(case, 1e-6), coarse_rom)
    outcome = march(softened(case, 1e-6), setup)
    places, depth = setup.places, 1e-4 - setup.strips.g0
    strips = places.width * 5e-3 * (0.45 * depth / 5e-3 + 1e-8) / 1.45
    borne = np.concatenate([[0], np.cumsum(strips)])  # up to the end of each strip
    expected = np.diff(np.interp(np.linspace(0, 1, 9), places.ends, borne))
    np.testing.assert_allclose(outcome.force_mean[0], expected, rtol=1e-9)
    np.testing.assert_allclose(outcome.force_peak[0], expected, rtol=1e-9)
    worn = (depth / 5e-3 - 1e-8) / 1.45 * 5e-3  # (E p - sigma_Y l) / (E + K), of every rod
    np.testing.assert_allclose(outcome.wear, np.tile(worn[:, None], 512), rtol=1e-9)


def test_outputs_are_at_a_sixteenth_of_the_chord_for_any_number_of_strips(coarse_rom):
    """Column 0 is the displacement of the states there, also where there is no strip."""
    record = {"samples_per_round": 64, "states_rounds": 1, "history": {"chord": [0.5, 0.0625]}}
    rows = []
    for m in (3, 8, 16):
        case = scene(rounds=1, liner__strips=m, record=record)
        setup = set_up(case, coarse_rom, 0.33)
        outcome = march(case, setup)
        rows.append(setup.Phi_out)
        there = outcome.states @ coarse_rom.rows(np.array([1 / 16, 0.5])).T
        round_off = 1e-12 * abs(outcome.states).max()
        assert outcome.contact_share > 0.02 and abs(there).max() > 1e-6
        # the same place twice: the sums of a matrix product may differ by round-off
        again = np.column_stack([there, there[:, 0]])
        np.testing.assert_allclose(outcome.u_r[:, :3], again, rtol=0, atol=round_off)
    # strips that nothing touches leave it alone
    np.testing.assert_array_equal(rows, np.stack([rows[0]] * 3))


def test_a_radial_interface_is_as_accurate_in_normal_contact_as_the_full_one(
    coarse_matrices, coarse_rom
):
    """Contact is radial: the error of a model is due to its basis, not to its directions.

    Both are compared with 40 natural modes at each speed, over a few rounds.
    """
    rich = EnrichedBasis(natural_modes=40, rank_tolerance=1e-4)
    radial = reduce(coarse_matrices, EnrichedBasis(), "r")[0]
    models = [reduce(coarse_matrices, rich)[0], coarse_rom, radial]
    case = scene(rounds=2, integrator=of_steps(64 * 1200, CENTRAL))
    runs = [marched(case, rom, 0.33) for rom in models]
    gap = case.clearance.gaps(1 / 16, radial.span)
    reference, full, light = (run.u_r / gap for run in runs)
    assert radial.n < coarse_rom.n - 20 < models[0].n - 60
    errors = [abs(u_r - reference).max() for u_r in (full, light)]
    assert abs(reference).max() > 0.5  # of the gap: hard contact
    # measured 0.023 % and 0.035 % of the gap, and 0.029 % between them
    assert max(*errors, abs(full - light).max()) < 0.001
    assert errors[1] < 2 * errors[0]
    wear = [run.wear.max() for run in runs]
    assert wear[2] == pytest.approx(wear[0], rel=0.001)  # measured 4e-5


def test_one_kernel_serves_all_scenes_of_a_scheme_and_a_law(coarse_rom):
    """Profile, tangential force, a casing behind the liner and records need no new compilation."""
    plain = {"integrator": of_steps(320), "rounds": 1}
    marched(scene(**plain, liner__footprint_mm=20), coarse_rom)
    kernels = kernel.cache_info().misses
    for changes in (
        {"liner__rods_per_round": 4096},
        {"liner__worn_through": "casing"},
        ROUND_TIP,
        {"record": {"states_rounds": 1, "samples_per_round": 64}},
    ):
        marched(scene(**plain, **changes), coarse_rom)
    assert kernel.cache_info().misses == kernels
