"""Contact across the thickness of the tip: closed forms, the way from one row to two, energies."""

from dataclasses import replace

import numba
import numpy as np
import pytest
from closing import closing, sides, tip_facets
from peer import piecewise_exact
from refused import refused
from scenes import RUBBING, of_steps, scene
from systems import Parameters, strips as strips_of
from test_accuracy import TO_CHOOSE
from test_interface_force import ROUND_OFF, compliance
from test_start import go_on, made

from fem.interface_operator import interface_of
from fem.solid import read_solid
from geometry.base import UserError
from geometry.hats import middles
from geometry.interface import tip_of
from rom.model import Rom, RomError
from rom.reduce import reduce
from simulate.contact.compiled import for_types_of
from simulate.contact.interface_force import new_solver, solve
from simulate.contact.places import strip_places
from simulate.contact.rods import contact_force, cover, nothing_covered, press
from simulate.contact.strips import covered_middle, covered_part, leverage
from simulate.errors.accuracy import choose, march_to_accuracy
from simulate.errors.model_errors import ModelError
from simulate.errors.observables import differences
from simulate.errors.run import Case
from simulate.marching import check_scene, march, prepare
from simulate.marching.friction import solve_sliding
from simulate.marching.modal import Step, rows_of
from simulate.marching.setup import SCHEMES, sliding_modes, strip_stiffness, with_lean
from simulate.scene import LEADING
from simulate.sweeps.unusual import doubts

SUBTRIANGLES = [(0, 3, 5), (3, 1, 4), (5, 4, 2), (3, 4, 5)]  # of six nodes, VTK's order
LENGTH, WIDTH, THICKNESS = 4e-3, 2.5e-3, 5e-3  # m, of the footprint, the strip, the liner
LAW = Parameters(E=3.54e9, K=1.6107e9, sigma_Y=0.0)
# mean penetration and half of the lean, um; forces on the edges behind and ahead, N
SLIDING = (
    (20, 0, 22.140206, 22.140206),
    (20, -10, 25.830241, 18.450172),
    (20, 10, 2.435740, 13.142291),
    (5, -10, 9.340399, 3.113466),
    (5, 10, 0.304468, 3.590040),
)


def leaning(rods, advance):
    """One strip whose footprint has so many rods, which passes ``advance`` rods in a step."""
    nu = 8 * int(np.ceil(rods + advance))
    area, pitch = WIDTH * LENGTH / rods, LENGTH / rods
    system = strips_of(
        LAW, np.zeros(1), np.zeros(nu), length=rods, advance=advance, area=area, pitch=pitch,
        thickness=THICKNESS,
    )  # fmt: skip
    return system._replace(rows=(0.0, 0.0))


@numba.njit
def slide(system, covered, eps_p, w, lean, steps, energies, force):
    for n in range(1, steps + 1):
        now = Step(n, 1.0, 1.0, 0, 0, 0)
        cover(system, covered, eps_p, 0, now, w, w, lean, lean, 0.0, 0.0, True, energies)
        total, _, moment, _ = press(system, covered, eps_p, 0, w, w, lean, lean, energies)
        force[n - 1, 0], force[n - 1, 1] = total / 2 - moment, total / 2 + moment


def slid(rods, w, half, advance):
    """Forces (2,) on both edges of a rigid tip that slid on, N, and depths that it left, m."""
    system = leaning(rods, advance)
    steps = int(1.5 * rods / advance)
    eps_p, force, energies = np.zeros((1, system.d.size)), np.zeros((steps, 2)), np.zeros(7)
    arguments = system, nothing_covered(system), eps_p, w, 2 * half, steps, energies, force
    for_types_of(slide, *arguments)(*arguments)
    first = int(rods) + 2  # rods before were under the tip when it began
    return force[-1], THICKNESS * eps_p[0, first : int(steps * advance) - 2]


@pytest.mark.parametrize("case", SLIDING, ids=lambda case: f"{case[0]} um, {case[1]:+} um")
def test_a_rigid_tip_that_leans_slides_on_fresh_liner_with_the_forces_of_the_closed_form(case):
    """Behind deeper the rods load on; ahead deeper they arrive at the deepest, and unload."""
    w, half, *edges = case
    force, depth = slid(128, 1e-6 * w, 1e-6 * half, 1.0)
    assert force == pytest.approx(edges, abs=2e-4 * sum(edges), rel=6e-4)
    deepest = 1e-6 * (w + abs(half))
    assert depth == pytest.approx(LAW.E / (LAW.E + LAW.K) * deepest, rel=1e-12)


def test_the_error_of_the_closed_form_falls_with_the_square_of_the_rods():
    """At eight places of the rods under the tip, the largest."""
    *_, exact = np.array(SLIDING[2:])
    errors = []
    for rods in (32, 64, 128):
        found = [slid(rods + part, 5e-6, 10e-6, 1.0)[0] for part in np.arange(8) / 8]
        errors.append(max(abs(np.array(found) - exact[2:]).max(axis=1)))
    assert np.log2(errors[0] / errors[-1]) / 2 == pytest.approx(2, abs=0.1), errors


@pytest.mark.parametrize("rods", [1.0, 1.6, 2.4, 7.3])
def test_levers_have_the_moment_of_a_footprint_wherever_the_blade_is(rods):
    """Sum of the parts times lever 0, times lever^2 a twelfth of the footprint."""
    system = leaning(rods, 1.0)
    window = system.rods_covered + 1 + 2 * system.partly_covered
    for passed in np.linspace(0, 1, 23)[:-1]:
        part = np.array([covered_part(system, 0, k, passed) for k in range(window)])
        middle = np.array([covered_middle(system, 0, k, passed) for k in range(window)])
        lever = leverage(system, 0, passed) * middle / rods
        assert part @ lever == pytest.approx(0, abs=1e-12)
        if rods > 1:
            assert part @ lever**2 == pytest.approx(rods / 12, rel=1e-12)


def rub(steps=1024, **more):
    """A scene whose tip rubs the arc that it covers."""
    exact = {"integrator": of_steps(steps), "liner__rods_per_round": 1021}
    return scene(**RUBBING | exact | {"rounds": 4, "liner__footprint_mm": None} | more)


@pytest.mark.parametrize("slides", [False, True])
@pytest.mark.parametrize("decade", range(-12, 13, 3))
def test_force_and_moment_are_those_of_the_rods_where_they_leave_the_strips(decade, slides):
    """Stiffness times compliance over 24 decades, random levers; sliding: C as without friction."""
    for seed in range(40):
        rng = np.random.default_rng([seed, decade + 12])
        nodes, m = rng.integers(1, 9), rng.integers(1, 7)
        E = 10.0**decade / m
        law = Parameters(E, E * rng.choice([0, 0.5, 10]), E * rng.choice([1e-3, 0.1]))
        system = strips_of(law, np.zeros(nodes), np.zeros(m), length=m)
        system = system._replace(rows=(0.0, 0.0), w_end=np.full(nodes, rng.choice([0, 0.1, 1])))
        solver, covered = new_solver(nodes, 2), nothing_covered(system)
        solver.C[:] = compliance(rng, 2 * nodes, 10 ** rng.uniform(0, 6))
        at, rods, shape = solver.unknowns, covered.rods[:, :m], (nodes, m)
        covered.strips["high"], covered.lever[:, :m] = m, rng.uniform(-0.6, 0.6, shape)
        at["strip"] = np.repeat(np.arange(nodes), 2)
        at["v"] = v = rng.normal(size=2 * nodes) * rng.choice([0.1, 1, 10])
        at["top"], rods["part"] = np.inf, 1
        rods["delta_0"] = depth = rng.normal(size=shape) * rng.choice([0.01, 0.3, 1])
        rods["start"] = -1.0  # no rod bears at the start of the step
        rods["eps_p"] = rods["after"] = np.maximum(rng.uniform(-0.5, 0.5, shape), 0)
        soft = np.full(nodes, 1 / (E * m))
        arguments = (
            (system, covered, soft, solver, nodes) if slides else (system, covered, solver, nodes)
        )
        assert for_types_of((solve_sliding if slides else solve).outer, *arguments)(*arguments)
        w, F = at["w"].reshape(-1, 2), solver.F
        scale = abs(v) + abs(solver.C) @ abs(F) + abs(depth).max()
        assert (abs(at["w"] - (v - solver.C @ F)) <= ROUND_OFF * scale).all()
        of_rods = np.array([contact_force(system, covered, i, *w[i]) for i in range(nodes)])
        k = abs(of_rods[:, 3:]).sum(axis=1).repeat(2)
        found = of_rods[:, [0, 2]].ravel()
        assert (abs(found - F) <= 4 * ROUND_OFF * scale * k + 1e-11 * found[::2].repeat(2)).all()


def with_rows(of, Phi_lean):
    """Rows of the lean in a set-up without friction, and the blade as the kernel reads it."""
    rows = rows_of(of.Phi_b, of.Phi_t, Phi_lean)
    blade = SCHEMES[of.scheme].coefficients(of.omega, rows, of.zeta, of.h)
    return {"Phi_lean": Phi_lean, "blade": blade}


def test_two_rows_that_are_equal_are_one(edges_rom):
    """A lean of 0 in all modes: the numbers of one row, for a flat tip and for a rounded one."""
    for more in ({}, {"contact__profile": {"tilt": 0.01, "edge_drop_um": 1}}):
        case = rub(**more)
        two = prepare(case, edges_rom, edges_rom.omega1 * 0.34)
        of_one = two.strips._replace(rows=(0.0,))
        one = march(case, replace(two, **with_rows(two, two.Phi[:0]), strips=of_one))
        both = march(case, replace(two, **with_rows(two, 0 * two.Phi_lean)))
        assert one.contact_share > 0.05
        assert both.wear == pytest.approx(one.wear, rel=1e-12, abs=1e-12 * one.wear.max())
        assert both.u_r == pytest.approx(one.u_r, rel=1e-12, abs=1e-12 * np.ptp(one.u_r))
        assert both.force_mean == pytest.approx(one.force_mean, rel=1e-11)


SETS = {
    "flat": {},
    "rounded": {"contact__profile": {"tilt": 0.0, "edge_drop_um": 2}},
    "tangential": {
        "contact__profile": {"tilt": 0.01, "edge_drop_um": 2},
        "contact__tangential": True,
    },
    "friction": {"contact__friction": 0.15},
    "moving casing": {
        "casing__modes": [
            {"order": 2, "frequency_Hz": 300, "modal_mass_kg": 1, "damping_ratio": 0.01}
        ]
    },
}


@pytest.mark.parametrize("of", SETS)
def test_no_energy_is_created_and_its_error_falls_with_the_step(edges_rom, of):
    """Over the casing's work, at most 2e-5 with 4096 steps.

    Normals that change within the step create some with tangential forces, in one row as in two.
    """
    errors = []
    for steps in (4096, 16384):
        case = rub(steps, **SETS[of])
        run = march(case, prepare(case, edges_rom, edges_rom.omega1 * 0.34))
        ledger = run.ledger
        assert run.status == "ok" and run.facts.unsolved == 0 and run.contact_share > 0.05
        assert (ledger.on_casing != 0) == (of == "moving casing")
        blade = ledger.blade - ledger.blade_before + ledger.damping
        assert blade == pytest.approx(ledger.work, rel=1e-9)
        errors.append(ledger.numerical / ledger.casing)
    assert abs(errors[1]) < abs(errors[0]) < 2e-5
    assert max(errors) <= 1e-12 or of == "tangential"


def test_central_differences_and_piecewise_exact_agree_across_the_thickness(edges_rom):
    case = rub(4096)
    setup = prepare(case, edges_rom, edges_rom.omega1 * 0.33)
    stepped = case.but(integrator={"scheme": "central-difference", "fraction_of_limit": 0.1})
    by_steps = march(stepped, prepare(stepped, edges_rom, setup.Omega))
    exact = march(case, setup)
    assert by_steps.wear.mean() == pytest.approx(exact.wear.mean(), rel=0.02)
    assert np.ptp(by_steps.u_r) == pytest.approx(np.ptp(exact.u_r), rel=0.01)


def test_the_stiffness_that_a_sliding_tip_meets_is_that_over_its_thickness(edges_rom):
    """Integrated from edge to edge: with the lean a twelfth of the force's."""
    case, mu = rub(contact__friction=0.3), 0.3
    setup = prepare(case, edges_rom, edges_rom.omega1 * 0.3)
    k = strip_stiffness(case.liner, setup.places)
    modes = sliding_modes(setup.omega, setup.Phi_b, setup.Phi_t, setup.places)
    (_, closing, along), rows = with_lean(modes, k, setup.Phi_lean)
    slid, by_places = setup.places.secant[:, None] * setup.Phi_t, 0.0
    for place, share in zip(*np.polynomial.legendre.leggauss(3), strict=True):
        there = setup.Phi_b + place / 2 * setup.Phi_lean
        by_places += share / 2 * (there + mu * slid).T @ (k[:, None] * there)
    found = (closing + mu * along).T @ (rows[:, None] * closing)
    assert found == pytest.approx(by_places, abs=1e-9 * abs(by_places).max())


@pytest.mark.slow
def test_an_independent_program_agrees_on_rows_from_the_nodes(
    edges_reduced, coarse_matrices, coarse_mesh
):
    """Edges cut, projected and marched by code of the tests alone."""
    rom, T = edges_reduced
    case = rub(2048, rounds=5, liner__rods_per_round=8191)
    m, Omega = case.liner.m, 0.34 * rom.omega1
    of, xi = tip_facets(coarse_mesh.mesh), np.append(middles(m), LEADING)
    P = closing(of, coarse_matrices, T, xi, edges=True)
    edges = sides(tip_of(of[1], of[0]).outline, rom.line(middles(m))[:, 2])
    kept = P[:, m:].mean(axis=0)
    their = piecewise_exact(rom, case, Omega, 2048, 5 * 2048, P[:, :m], kept, edges)
    ours = march(case, prepare(case, rom, Omega))
    assert ours.contact_share > 0.05
    assert ours.wear.max() == pytest.approx(their.wear.max(), rel=5e-3)
    assert ours.wear.mean() == pytest.approx(their.wear.mean(), rel=5e-3)
    u_r = their.out[31::32, 0]  # at the samples of the last revolution
    assert ours.u_r[-64:, 0] == pytest.approx(u_r, abs=5e-3 * np.ptp(u_r))


def test_a_rigid_casing_asks_for_one_row(edges_rom):
    for liner in ({"liner__law": {"kind": "rigid"}}, {"liner__worn_through": "casing"}):
        refused(UserError, check_scene, rub(**liner), edges_rom, match="across: 1")


def test_the_footprint_is_the_arc_that_the_tip_covers(solid, edges_rom, coarse_rom):
    """Its sum over the widths is the area of the tip that is seen along the radius."""
    places = strip_places(edges_rom, scene(liner__strips=16).liner, scene().casing)
    x, y, z = np.moveaxis(solid.V.tabulate_dof_coordinates()[solid.tip[:, SUBTRIANGLES]], -1, 0)
    arc = np.hypot(x, y) * np.arctan2(y, x)
    (a, b, c), (d, e, f) = np.moveaxis(arc, -1, 0), np.moveaxis(z, -1, 0)
    area = abs((b - a) * (f - d) - (c - a) * (e - d)).sum() / 2
    assert places.footprint @ places.width == pytest.approx(area, rel=0.01)
    given = scene(liner__footprint_mm=4)
    assert (strip_places(coarse_rom, given.liner, given.casing).footprint == 4e-3).all()
    assert "not used" in doubts(given, edges_rom)["liner.footprint_mm"]
    without = replace(coarse_rom, sides=np.empty((2, 0)))
    liner = scene(liner__footprint_mm=None).liner
    refused(RomError, strip_places, without, liner, given.casing, match="footprint_mm")


def test_gaps_at_rest_differ_between_the_edges_by_their_growth(edges_rom):
    """The untwist of the blade leans its tip: prepare takes from each edge its own growth."""
    wide = {f"clearance__{edge}_edge_over_span": 1e-3 for edge in ("leading", "trailing")}
    case = rub(clearance__at="rest", **wide)
    setup = prepare(case, edges_rom, edges_rom.omega1 * 0.3)
    xi, n = setup.places.xi, len(edges_rom.xi)
    behind, ahead = (
        replace(edges_rom, across=1, growth=edges_rom.growth[:, part]).growth_at(xi, setup.Omega)
        for part in (slice(None, n), slice(n, None))
    )
    assert abs(behind - ahead).max() > 1e-7
    assert setup.strips.lean == pytest.approx(behind - ahead, rel=1e-9)


def test_a_run_across_the_thickness_goes_on_to_the_last_bit(edges_rom, tmp_path):
    case = made(liner__footprint_mm=None, liner__rods_per_round=1021)
    whole, first, then = go_on(case, edges_rom, tmp_path / "first.nc")
    parts = [part["history"].values for part in (first, then)]
    assert np.ptp(whole["history"].values) > 0
    np.testing.assert_array_equal(np.concatenate(parts, axis=-1), whole["history"].values)
    np.testing.assert_array_equal(then["end_eps_p"].values, whole["end_eps_p"].values)


@pytest.mark.slow
def test_an_accuracy_that_is_asked_for_holds_across_the_thickness(edges_rom):
    """Against a quarter of the step and four times the rods on twice the strips."""
    case = rub(**TO_CHOOSE, accuracy=0.1, speeds={"over_f1": [0.3, 0.33]})
    choice = choose(case, edges_rom, ModelError(0.0, None))
    for Omega in case.speeds.omega(edges_rom.f1):
        own = march_to_accuracy(case, edges_rom, Omega, choice)
        fine = own.scene.but(
            liner__strips=2 * choice.strips, liner__rods_per_round=4 * choice.rods_per_round
        )
        finer = Case(fine, edges_rom, prepare(fine, edges_rom, Omega, 4 * own.setup.steps)).march()
        found = differences(own, finer)
        assert max(found.values()) < 0.1, found


@pytest.fixture(scope="module")
def solid(coarse_blade, coarse_mesh):
    return read_solid(str(coarse_mesh.mesh), coarse_blade.material)


@pytest.fixture(scope="module")
def edges_rom(edges_reduced) -> Rom:
    return edges_reduced[0]


@pytest.fixture(scope="module")
def edges_reduced(solid, coarse_blade, coarse_matrices):
    """The coarse blade with two rows across the thickness, and its basis."""
    patches = len(coarse_matrices.xi)
    of = interface_of(solid, coarse_blade.but(interface={"patches": patches, "across": 2}))
    return reduce(replace(coarse_matrices, **vars(of)), coarse_blade.basis)
