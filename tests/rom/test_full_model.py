"""The full model solved speed by speed: as from nothing at each speed, one K kept at a time."""

import gc
import weakref
from dataclasses import replace

import numpy as np
import pytest
from refused import refused
from scipy.sparse import csr_matrix, diags, identity

from fem.assemble import over_speeds
from fem.cholesky import Cholesky
from fem.matrices import Prestressed
from geometry.hats import mean, over_edges
from geometry.tip import EDGES
from rom.components import at_speeds
from rom.full_model import BENT, MODES, of_components, solve
from rom.modes import ModesError, ShiftInvert


@pytest.fixture(scope="module")
def full(coarse_blade, coarse_mesh):
    """As the workflow solves it, the factors shared with the equilibria."""
    cholesky = Cholesky()
    speeds = np.linspace(0, coarse_blade.top_speed, 17)
    return solve(*over_speeds(coarse_blade, "coarse", coarse_mesh.mesh, speeds, cholesky), cholesky)


def test_frequencies_and_compliances_are_those_of_each_speed_alone(full, check_matrices):
    """Equilibria by Newton, every K factorised on its own, modes from a random vector."""
    fom, loads = check_matrices, check_matrices.S.T.toarray()
    np.testing.assert_array_equal(full.speeds, fom.speeds)
    for j in (0, 1, 2, 9, 16):
        alone = ShiftInvert(fom.K[j], fom.M)
        # round-off of K^-1 of a thin blade: measured 5e-12 and 8e-12
        np.testing.assert_allclose(full.omega[j], alone.modes(MODES).omega, rtol=1e-9)
        C = fom.S @ alone.solve(loads)
        size = np.sqrt(np.diag(C))
        assert abs((full.compliance[j] - C) / np.outer(size, size)).max() < 1e-9
    assert full.residuals.max() <= 1e-6
    assert full.provenance == fom.provenance


def test_shapes_are_those_at_rest(full, check_matrices):
    """The speeds that follow replace only each other."""
    fom = check_matrices
    rest = ShiftInvert(fom.K[0], fom.M).modes(len(full.shapes)).Phi
    same = np.einsum("sn,ns->s", full.shapes.reshape(len(full.shapes), -1), fom.M @ rest)
    np.testing.assert_allclose(abs(same), 1, rtol=1e-9)
    np.testing.assert_array_equal(full.coordinates, fom.coordinates)


N = 21  # seven nodes


def stiffness(speed):
    return csr_matrix(diags(np.arange(1.0, N + 1)) + 0.1 * speed**2 * np.eye(N)[::-1])


@pytest.fixture
def constants(small):
    fom = small.matrices([0.0])
    return replace(fom, M=identity(N, format="csr"), S=identity(N, format="csr")[:6])


def test_a_stiffness_is_not_kept_beyond_its_speed(constants):
    made, alive = [], []

    def states():
        for speed in np.linspace(0, 3, 7):
            K = stiffness(speed)
            made.append(weakref.ref(K))
            gc.collect()
            alive.append(sum(K() is not None for K in made))
            yield Prestressed(speed, ((1.0, K),), np.zeros(N), 0.0)

    assert solve(constants, states()).omega.shape == (7, MODES)
    assert max(alive) <= 2  # the new one and the last, whose factor there is


def test_a_speed_that_is_not_stable_is_refused(constants):
    states = [Prestressed(of, ((1.0, stiffness(of)),), np.zeros(N), 0.0) for of in (0.0, 20.0)]
    refused(ModesError, solve, constants, states, match="K is not positive definite")


def test_components_of_some_speeds_and_others_are_one_full_model(full, check_matrices):
    """As the workflow joins it; more modes than are compared change nothing."""
    fom, ends = check_matrices, [0, 16]
    known = at_speeds(fom.at(fom.speeds[ends]), MODES + 4)
    others = fom.at(np.delete(fom.speeds, ends))
    joined = of_components(fom, known).joined(solve(others, others.states()))
    np.testing.assert_array_equal(joined.speeds, full.speeds)
    np.testing.assert_allclose(joined.omega, full.omega, rtol=1e-9)
    np.testing.assert_allclose(
        joined.compliance, full.compliance, atol=1e-9 * full.compliance.max()
    )
    np.testing.assert_allclose(abs(joined.tip), abs(full.tip), atol=1e-6 * abs(full.tip).max())


def test_the_second_order_is_along_radial_loads_at_both_edges_without_the_mode(coarse_matrices):
    """K x = R - M phi (R phi): the static field of each load, less what the mode has of it."""
    fom, asked = coarse_matrices.at([0.0]), []
    solve(fom, fom.states(), along=lambda u, x, w: asked.append((x, w)) or 0.0)
    R = over_edges(EDGES, fom.xi, mean(fom.across)) @ fom.rows("r")
    for (edge, _), (x, phi) in zip(np.ndindex(2, BENT), asked, strict=True):
        expected = R[edge] - fom.M @ phi * (R[edge] @ phi)
        np.testing.assert_allclose(fom.K[0] @ x, expected, atol=1e-9 * abs(R).max())
