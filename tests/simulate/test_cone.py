"""Contact along the normal of a casing that tapers: rows, forces, energies, another program."""

from dataclasses import replace
from functools import partial

import numpy as np
import peer
import pytest
from refused import refused
from runs import assert_is_that_of_the_peer, marched, set_up
from scenes import blade_balance, of_steps, scene
from test_loads import EXACT, rigid, rubbed  # noqa: F401

from geometry.hats import hats, middles
from rom.coarser import coarser
from rom.reduce import reduce
from simulate.marching import SceneError, check_scene

SLOPE = -0.2
SECANT = np.hypot(1, SLOPE)
XI = middles(8)


def closing(rom, xi, slope=SLOPE):
    """u_r - s u_z at chord fractions, by the hats: three DoFs for each of their nodes."""
    P, values = np.zeros((len(xi), rom.n)), hats(xi, rom.xi)
    P[:, 0 : 3 * len(rom.xi) : 3] = values
    P[:, 2 : 3 * len(rom.xi) : 3] = -slope * values
    return P


def test_the_blade_moves_by_what_closes_the_gap_and_takes_the_force_along_the_normal(coarse_rom):
    """Axial over radial force is -s; with s = 0 the rows are the radial ones."""
    setup = set_up(scene(casing__slope=SLOPE), coarse_rom)
    P = coarse_rom.closing_rows(setup.places.xi, np.full(101, SLOPE))
    np.testing.assert_allclose(P, closing(coarse_rom, setup.places.xi), atol=1e-12)
    np.testing.assert_array_equal(setup.Phi_b, P @ setup.Phi)
    pressed = P.T @ np.arange(1.0, 1 + len(P))  # by t_N cos g on the strips
    of_interface = pressed[: 3 * len(coarse_rom.xi)].reshape(-1, 3)
    np.testing.assert_allclose(of_interface[:, 2], -SLOPE * of_interface[:, 0], rtol=1e-12)
    assert not of_interface[:, 1].any()
    flat = coarse_rom.closing_rows(setup.places.xi, np.zeros(101))
    np.testing.assert_array_equal(flat, coarse_rom.rows(setup.places.xi))


def test_a_slope_that_varies_is_projected_with_the_motion(coarse_rom):
    """(1 + 2 xi) u_z with u_z linear is of second degree: its projection on the hats."""
    slope, nodes, xi = 1 + 2 * np.linspace(0, 1, 101), coarse_rom.xi, np.linspace(0, 1, 2001)
    u = np.zeros(coarse_rom.n)
    u[2 : 3 * len(nodes) : 3] = 1 - nodes  # u_z
    phi = hats(xi, nodes)
    exact = np.linalg.lstsq(phi, -(1 + 2 * xi) * (1 - xi), rcond=None)[0]
    at = middles(16)
    found = coarse_rom.closing_rows(at, slope) @ u
    np.testing.assert_allclose(found, hats(at, nodes) @ exact, atol=1e-3 / len(nodes))


def test_slope_0_is_contact_along_the_radius_and_a_cylinder_has_none(coarse_rom):
    given, own = (marched(scene(**of), coarse_rom) for of in ({"casing__slope": 0.0}, {}))
    for name in ("u_r", "wear", "force_mean"):
        np.testing.assert_array_equal(getattr(given, name), getattr(own, name))


@pytest.mark.parametrize("over_f1", [0.3, 0.345])
def test_a_run_on_a_cone_is_that_of_another_program(coarse_rom, over_f1):
    of_strips = {"chord": middles(8).tolist()}
    case = scene(integrator=of_steps(2048), casing__slope=SLOPE, record__history=of_strips)
    of_peer = partial(peer.piecewise_exact, P=closing(coarse_rom, middles(case.liner.m)))
    assert assert_is_that_of_the_peer(of_peer, case, coarse_rom, over_f1, 1e-9) > 100


def test_a_rigid_tip_on_a_cone_wears_as_on_a_cylinder_and_is_pressed_along_the_normal(rigid):  # noqa: F811
    """All lengths are radial and all widths axial: t_N alone carries 1 / cos g."""
    K = np.zeros((3, 5, 5))
    K[0] = 1e16 * np.eye(5)
    model = replace(rigid, M=np.eye(5), K=K, directions=("radial", "axial"))
    flat, cone = (
        rubbed(model, "plastic", casing=EXACT["casing"] | {"slope": slope})[0]
        for slope in (0.0, SLOPE)
    )
    assert flat.wear.max() > 1e-5
    np.testing.assert_allclose(cone.wear, flat.wear, rtol=1e-9, atol=1e-15)
    assert cone.ledger.casing == pytest.approx(flat.ledger.casing, rel=1e-9)
    for name in ("force_mean", "force_peak"):
        np.testing.assert_allclose(
            getattr(cone, name), SECANT * getattr(flat, name), rtol=1e-9, atol=1e-12
        )


def test_energies_close_and_friction_is_mu_times_the_normal_force(coarse_rom):
    mu = 0.1
    of = {"casing__slope": SLOPE, "contact": {"friction": mu}, "record__contact_force": True}
    case = scene(integrator=of_steps(2048), **of)
    run = marched(case, coarse_rom, 0.345)
    assert run.contact_share > 0.01
    assert abs(blade_balance(run.ledger)) < 1e-10 * run.ledger.casing
    np.testing.assert_allclose(
        run.force_tangential_mean, mu * run.force_mean, rtol=1e-9, atol=1e-12 * run.force_mean.max()
    )


def test_a_tip_that_tapers_gets_axial_dofs_whatever_is_asked_for(coarse_blade, coarse_matrices):
    """The matrices of the coarse blade, as if its tip were on a cone of slope 0.1 to -0.3."""
    camber = coarse_matrices.camber.copy()
    z = camber[:, 2] - camber[0, 2]
    camber[:, 0] += 0.1 * z - 0.2 * z**2 / z[-1]
    fom = replace(coarse_matrices, camber=camber)
    rom = reduce(fom, coarse_blade.basis, "r")[0]
    assert rom.directions == ("radial", "axial")
    np.testing.assert_array_equal(rom.taper, fom.slope)
    assert 0.09 < rom.taper[1] < 0.11 and -0.31 < rom.taper[-2] < -0.29
    full = reduce(fom, coarse_blade.basis, "rtz")[0]
    u_z = rom.compliance(0.0)[:, 1]
    np.testing.assert_allclose(u_z, full.compliance(0.0)[:, 2], rtol=1e-6)
    for speed, u in zip(fom.speeds, fom.u_static, strict=True):  # what the shift of the tip is
        of_tip = hats(XI, fom.xi) @ (fom.S[2::3] @ u)
        for model in (rom, coarser(rom)[0]):
            found = model.advance_at(XI, speed)
            np.testing.assert_allclose(found, of_tip, atol=0.02 * abs(of_tip).max() + 1e-15)
    assert abs(of_tip).max() > 1e-6
    cylinder = reduce(coarse_matrices, coarse_blade.basis, "r")[0]
    assert cylinder.directions == ("radial",) and not cylinder.advance_at(XI, speed).any()


def test_a_model_without_axial_dofs_is_refused_for_a_casing_that_tapers(
    coarse_blade, coarse_matrices
):
    """Unless the user says that contact is along the radius."""
    rom = reduce(coarse_matrices, coarse_blade.basis, "r")[0]
    tapers = replace(rom, slope=np.full(len(rom.camber), SLOPE))  # as a model from elsewhere
    error = refused(SceneError, check_scene, scene(), tapers)
    assert error.key == "casing.slope" and "axial interface DoFs" in error.text
    error = refused(SceneError, check_scene, scene(casing__slope=SLOPE), rom)
    assert "rom-rtz.nc" in error.text
    check_scene(scene(casing__slope=0.0), tapers)
    assert scene(casing__slope=SLOPE).directions == "rtz"
    assert scene(casing__slope=0.0).directions == "r"
