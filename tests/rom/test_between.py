"""The estimate of the error of K(Omega) between its speeds, and the speeds that follow from it."""

from dataclasses import replace

import numpy as np
import pytest
from refused import refused

import rom.full_model
from fem.assemble import assemble, over_speeds
from geometry.base import RPM, Caution
from rom.check import check
from rom.full_model import error_between, solve
from rom.model import RomError
from rom.polynomial import basis_speeds, evaluate, interpolate
from rom.reduce import reduce
from workflow.jobs.full_model import assembled

FAST = 1300.0  # rad/s: f1 doubles, and four speeds give 0.4 %


def made(speeds):
    """M and K(Omega) (n, n) of made modes whose squares rise like x / (1 + x / 2)."""
    x = (np.asarray(speeds) / 100.0) ** 2
    rise = x / (1 + x / 2)
    A = np.random.default_rng(1).standard_normal((6, 6))
    K0, K1 = A @ A.T + 6 * np.eye(6), np.diag([5.0, 4, 3, 2, 1, 0])
    return np.eye(6), K0 + rise[:, None, None] * K1


@pytest.mark.parametrize("count", [4, 5, 6, 7])
def test_estimate_is_of_the_size_of_the_error(count):
    """On made matrices whose K is no polynomial; the true error on 101 speeds."""
    speeds = 100 * np.sin(np.linspace(0, np.pi, count) / 2)
    M, K = made(speeds)
    polynomial, fine = interpolate(K, speeds), np.linspace(0, 100, 101)
    true = max(
        abs(np.sqrt(np.linalg.eigvalsh(evaluate(polynomial, s)) / np.linalg.eigvalsh(k)) - 1).max()
        for s, k in zip(fine, made(fine)[1], strict=True)
    )
    assert 0.5 < error_between(M, K, speeds) / true < 2


def test_estimate_of_a_polynomial_is_round_off_and_of_three_speeds_not_known():
    speeds = np.array([0.0, 50, 80, 100])
    K = made([0.0])[1] + (speeds**2 / 1e4)[:, None, None] * np.eye(6)
    assert error_between(np.eye(6), K, speeds) < 1e-12
    assert np.isnan(error_between(np.eye(6), K[:3], speeds[:3]))


@pytest.fixture(scope="module")
def fast(coarse_blade):
    return coarse_blade.model_copy(update={"max_speed_rpm": RPM * FAST})


@pytest.mark.slow
def test_speeds_are_added_until_the_check_is_met(fast, coarse_mesh):
    said = []
    fom = assembled(fast, "fast", coarse_mesh.mesh, said.append)
    assert np.all(np.diff(fom.speeds) > 0)
    assert set(np.round(basis_speeds(fast.basis, FAST), 6)) <= set(np.round(fom.speeds, 6))
    added = [line for line in said if "one more" in line]
    assert len(added) == len(fom.speeds) - 4 > 0
    assert added[0].startswith("frequencies of K(Omega) through 4 speeds err by some")
    alone = assemble(fast, "fast", coarse_mesh.mesh, [fom.speeds[-2]])
    assert abs(fom.K[-2] - alone.K[0]).max() < 1e-7 * abs(alone.K[0]).max()
    full = solve(*over_speeds(fast, "fast", coarse_mesh.mesh, np.linspace(0, FAST, 17)))
    check(reduce(fom, fast.basis, "r")[0], full).require(0.1)
    four = assemble(fast, "fast", coarse_mesh.mesh, basis_speeds(fast.basis, FAST))
    found = check(reduce(four, fast.basis, "r")[0], full)
    refused(RomError, found.require, 0.1, match=r"raise basis\.speeds")


def test_four_speeds_are_enough_for_the_coarse_blade(coarse_blade, coarse_mesh, coarse_matrices):
    fom = assembled(coarse_blade, "coarse", coarse_mesh.mesh)
    np.testing.assert_array_equal(fom.speeds, coarse_matrices.speeds)
    assert abs(fom.K[-1] - coarse_matrices.K[-1]).max() == 0


def test_what_no_number_of_speeds_can_give_is_refused(fast, coarse_mesh, monkeypatch):
    monkeypatch.setattr(rom.full_model, "MOST", 4)
    refused(RomError, assembled, fast, "fast", coarse_mesh.mesh, match="through 4 speeds err")


def given(fom, count):
    """The matrices as if they were from elsewhere, at the first of their speeds and the last."""
    provenance = replace(fom.provenance, settings={"full_matrices": []})
    return replace(fom.at([*fom.speeds[: count - 1], fom.speeds[-1]]), provenance=provenance)


def test_matrices_from_elsewhere_are_refused_where_they_are_wrong_between_their_speeds(
    fast, coarse_mesh
):
    """At their own speeds the reduced model is right to 1e-5."""
    fom = assemble(fast, "fast", coarse_mesh.mesh, basis_speeds(fast.basis, FAST))
    few = given(fom, 4)
    found = check(reduce(few, fast.basis, "r")[0], solve(few, few.states()))
    assert abs(found.error).max() < 1e-4 < found.between
    refused(RomError, found.require, 0.1, match="between its 4 speeds")


def test_error_between_three_speeds_from_elsewhere_is_said_not_to_be_known(
    coarse_blade, coarse_matrices
):
    three = given(coarse_matrices, 3)
    found = check(reduce(three, coarse_blade.basis, "r")[0], solve(three, three.states()))
    with pytest.warns(Caution, match="full_matrices.K: 3 speeds: .* not known"):
        found.require(0.1)
