"""The reduced model with half of its patches and fewer modes."""

from dataclasses import replace

import numpy as np
import pytest
from refused import refused

from geometry.blade import EnrichedBasis
from geometry.hats import hat_nodes, hats, projection as hats_projection
from rom.coarser import coarser
from rom.model import RomError
from rom.reduce import reduce


@pytest.fixture(scope="module", params=["r", "rtz"])
def fine(request, coarse_matrices, coarse_rom):
    if request.param == "rtz":
        return coarse_rom
    return reduce(coarse_matrices, EnrichedBasis(), request.param)[0]


@pytest.fixture(scope="module")
def halved(fine):
    return coarser(fine)


def projection(fine, coarse):
    """Pi (coarse, fine) by Gauss points between all kinks: exact."""
    x, w = np.polynomial.legendre.leggauss(3)
    kinks = np.union1d(fine, coarse)
    half = np.diff(kinks) / 2
    xi = ((kinks[:-1] + half)[:, None] + half[:, None] * x).ravel()
    weights = (half[:, None] * w).ravel()
    phi = hats(xi, coarse)
    return np.linalg.solve(
        phi.T @ (weights[:, None] * phi), phi.T @ (weights[:, None] * hats(xi, fine))
    )


def test_half_the_patches_and_all_else_unchanged(fine, halved):
    coarse, T = halved
    np.testing.assert_array_equal(coarse.xi, hat_nodes(4))
    assert T.shape == (fine.n, coarse.n)
    assert coarse.n < fine.n
    assert (coarse.directions, coarse.provenance) == (fine.directions, fine.provenance)
    np.testing.assert_array_equal(coarse.line(np.array([0.3])), fine.line(np.array([0.3])))


@pytest.mark.parametrize("share", [0.0, 0.35, 0.9, 1.0])
def test_low_frequencies_are_slightly_higher(fine, halved, share):
    """Rayleigh-Ritz in a subspace that contains the natural modes at four speeds."""
    coarse, T = halved
    Omega = share * fine.Omega_m
    np.linalg.cholesky(coarse.M)
    omega, of_fine = coarse.modes(Omega)[0], fine.modes(Omega)[0]
    assert np.all(omega >= of_fine[: coarse.n] * (1 - 1e-8))
    np.testing.assert_allclose(
        coarse.stiffness(Omega), T.T @ fine.stiffness(Omega) @ T, atol=1e-9 * abs(fine.K[0]).max()
    )
    # what stays of the rank tolerance, as in the model itself; measured 2e-6
    assert (omega[:10] / of_fine[:10] - 1).max() < 1e-5


def test_coarse_interface_is_the_projection_of_the_fine_one(fine, halved):
    """c' = Pi c with c that of u = T u'."""
    coarse, T = halved
    k = len(fine.directions)
    u_coarse = np.random.default_rng(6).normal(size=(coarse.n, 5))
    u = T @ u_coarse
    Pi = projection(fine.xi, coarse.xi)
    for d in range(k):
        c, c_coarse = u[d : k * len(fine.xi) : k], u_coarse[d : k * len(coarse.xi) : k]
        # the model's by a rule that has its points on no kink: 4096 of them
        np.testing.assert_allclose(Pi @ c, c_coarse, rtol=0, atol=1e-5 * abs(c).max())


def test_static_compliance_of_the_coarse_coefficients_is_that_of_the_model(fine, halved):
    """Constraint modes at rest are in the basis: Pi C Pi^T, whatever the modes."""
    coarse, _ = halved
    k = len(fine.directions)
    Pi = projection(fine.xi, coarse.xi)
    C, C_coarse = (
        np.linalg.inv(rom.stiffness(0.0))[: k * len(rom.xi) : k, : k * len(rom.xi) : k]
        for rom in (fine, coarse)
    )
    np.testing.assert_allclose(C_coarse, Pi @ C @ Pi.T, rtol=0, atol=1e-4 * abs(C).max())


@pytest.mark.parametrize("patches", [4, 5, 8, 16])
def test_the_projection_is_exact_for_constant_and_linear_fields(coarse_rom, patches):
    """A rigid field of the interface is in W, and c' has its values at the hats' nodes."""
    fine, coarse = hat_nodes(patches), hat_nodes(patches // 2)
    Pi = hats_projection(fine, coarse)
    np.testing.assert_allclose(Pi @ (2 - 3 * fine), 2 - 3 * coarse, rtol=0, atol=1e-10)
    # midpoints of 4096 shares, where hats have kinks
    np.testing.assert_allclose(Pi, projection(fine, coarse), rtol=0, atol=1e-5)


def test_points_and_few_patches_are_refused(paper_reduced, coarse_rom):
    for rom in (paper_reduced[0], replace(coarse_rom, xi=hat_nodes(3))):
        refused(RomError, coarser, rom)
