"""Growth of the tip: closed forms of motions, a radial bar, and the equilibrium between speeds."""

from dataclasses import replace

import numpy as np
import pytest

from geometry.hats import hats, middles
from rom.coarser import coarser
from rom.polynomial import evaluate
from rom.reduce import growth_of, reduce


def moved(fom, motion):
    """The matrices with ``motion(places, speed)`` (nodes, 3) as static deflections."""
    u = [motion(fom.coordinates, speed).ravel() for speed in fom.speeds]
    return replace(fom, u_static=np.array(u))


def growth(fom, Omega):
    return evaluate(growth_of(fom), Omega)


def test_radial_expansion_is_all_growth(coarse_matrices):
    """u = a Omega^2 e_r: no place on the chord differs."""
    a = 2e-10

    def expansion(x, Omega):
        r = np.hypot(x[:, 0], x[:, 1])[:, None]
        return a * Omega**2 * x * [1, 1, 0] / r

    for Omega in (200.0, 650.0):
        grown = growth(moved(coarse_matrices, expansion), Omega)
        np.testing.assert_allclose(
            grown, a * Omega**2, rtol=1e-7
        )  # e_r between nodes: measured 2e-8


def test_turn_about_the_axis_is_no_growth(coarse_matrices):
    """By 1 mrad: the radial displacement is -r (1 - cos) = -0.28 um, the radius stays."""

    def turn(x, Omega):
        angle = 1e-3 * (Omega / 650.0) ** 2
        c, s = np.cos(angle) - 1, np.sin(angle)
        return np.column_stack([c * x[:, 0] - s * x[:, 1], s * x[:, 0] + c * x[:, 1], 0 * x[:, 2]])

    turned = moved(coarse_matrices, turn)
    assert abs(turned.S[::3] @ turned.u_static[-1]).max() > 1e-7
    assert abs(growth(turned, 650.0)).max() < 1e-12


def test_growth_between_the_speeds_of_the_basis_is_that_of_the_equilibrium(
    coarse_rom, check_matrices
):
    """At the 17 speeds of the check the equilibrium was found anew; 13 are not the basis's."""
    xi, S_r = middles(8), check_matrices.S[::3]
    x, y = check_matrices.coordinates[:, :2].T
    r = np.hypot(x, y)
    for speed, u in zip(check_matrices.speeds, check_matrices.u_static, strict=True):
        u = u.reshape(-1, 3)
        # to second order: radial displacement, and t^2 / (2 r) of the tangential one
        radial, tangential = (x * u[:, 0] + y * u[:, 1]) / r, (x * u[:, 1] - y * u[:, 0]) / r
        grown = radial + tangential**2 / (2 * r)
        e_r = np.stack([x / r, y / r, 0 * r], axis=1)
        expected = hats(xi, check_matrices.xi) @ (S_r @ (grown[:, None] * e_r).ravel())
        # the polynomial between its speeds: measured 2.4 nm of 77 um
        np.testing.assert_allclose(coarse_rom.growth_at(xi, speed), expected, rtol=0, atol=5e-9)
    assert 6e-5 < coarse_rom.growth_at(xi, speed).mean() < 9e-5


def test_blade_grows_about_as_a_radial_bar(coarse_rom):
    """A bar of one section from r0 to r1, rho Omega^2 / E int (r1^2 - r^2) / 2 dr = 83 um.

    The blade tapers to half of its section, which leaves some four fifths.
    """
    r1 = coarse_rom.camber[:, 0].mean()
    r0, Omega = r1 - coarse_rom.span, coarse_rom.Omega_m
    bar = 4430 / 113.8e9 * Omega**2 / 2 * (r1**2 * (r1 - r0) - (r1**3 - r0**3) / 3)
    assert bar == pytest.approx(83e-6, rel=0.02)
    assert 0.75 < coarse_rom.growth_at(middles(8), Omega).mean() / bar < 1.0


def test_matrices_without_deflections_have_no_growth(coarse_matrices, coarse_blade):
    unknown = replace(coarse_matrices, u_static=np.full_like(coarse_matrices.u_static, np.nan))
    assert growth_of(unknown).size == 0
    assert not reduce(unknown, coarse_blade.basis, "r")[0].growth.size


def test_coarser_model_has_the_growth_on_its_patches(coarse_rom):
    """Half as many hats: a growth linear along the chord is kept."""
    linear = replace(coarse_rom, growth=np.array([0 * coarse_rom.xi, 1 + coarse_rom.xi]))
    half, _ = coarser(linear)
    xi = middles(5)
    np.testing.assert_allclose(half.growth_at(xi, 2.0), 4 * (1 + xi), rtol=1e-6)
    assert half.growth.shape == (2, 4)
