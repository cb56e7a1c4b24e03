"""The reduced coarse blade against the full one over its speed range."""

from dataclasses import replace

import numpy as np
import pytest
from refused import refused

from fem.assemble import assemble, over_speeds
from geometry.base import ProvenanceError
from geometry.blade import EnrichedBasis, PaperBasis
from geometry.hats import hats
from geometry.tip import EDGES
from rom.check import RomCheck, check, further_speeds
from rom.full_model import BENT, FullModel, solve
from rom.model import RomError
from rom.polynomial import basis_speeds, node_polynomial, speeds_between
from rom.reduce import reduce

EVEN = np.linspace(0, 650, 17)
JOINED = "speeds", "omega", "residuals", "compliance", "tip"  # the second order is not known here


@pytest.fixture(scope="module")
def full(check_matrices) -> FullModel:
    return solve(check_matrices, check_matrices.states())


@pytest.fixture(scope="module")
def result(coarse_rom, full) -> RomCheck:
    return check(coarse_rom, full)


def test_default_meets_its_tolerance_at_seventeen_speeds(result):
    """Ten frequencies within 0.1 %, between the speeds of the basis too, with n <= 85."""
    np.testing.assert_array_equal(result.speeds, np.linspace(0, 650, 17))
    assert result.error.shape == (17, 10)
    result.require(EnrichedBasis().tolerance_percent)
    # honest about its error: measured 0.005 %, which the polynomial through four speeds leaves
    assert abs(result.error).max() < 1e-4


@pytest.fixture(scope="module")
def full_at_seven(coarse_blade, coarse_mesh, coarse_matrices) -> FullModel:
    """The full model at the speeds that the workflow checks."""
    speeds = np.union1d(coarse_matrices.speeds, speeds_between(coarse_matrices.speeds))
    return solve(*over_speeds(coarse_blade, "coarse", coarse_mesh.mesh, speeds))


def test_seven_speeds_find_the_error_of_seventeen(
    coarse_rom, coarse_matrices, result, full_at_seven
):
    """Those of the basis, and where a polynomial through them errs most."""
    seven = check(coarse_rom, full_at_seven)
    assert len(seven.speeds) == 7
    assert abs(seven.error).max() > 0.98 * abs(result.error).max()
    assert further_speeds(seven, coarse_matrices.speeds, 0.1).size == 0


@pytest.mark.parametrize("wrong", [0, 1, 2, 3])
def test_a_model_wrong_at_one_speed_is_found(coarse_blade, coarse_matrices, full_at_seven, wrong):
    """K 1 % too stiff there: frequencies 0.5 %, and more between the speeds."""
    K = list(coarse_matrices.K)
    K[wrong] = 1.01 * K[wrong]
    rom, _ = reduce(replace(coarse_matrices, K=tuple(K)), coarse_blade.basis)
    found = check(rom, full_at_seven)
    assert abs(found.error).max() > 0.0049
    refused(RomError, found.require, 0.1)


@pytest.mark.parametrize(
    ("c", "tolerance", "intervals"),
    [
        ((1, 1, 1), 0.1, []),
        ((1, 1, 4), 0.1, []),
        ((1, 1, 6), 0.1, [1, 2]),
        ((9, 1, 8), 0.1, [0, 1, 2]),
        ((1, 1, 6), 10, []),  # errors far below the tolerance
        ((1, 1, 6), np.inf, []),
    ],
)
def test_further_speeds_are_where_neighbours_disagree(result, c, tolerance, intervals):
    basis = basis_speeds(EnrichedBasis(), 650.0)
    speeds, x = np.union1d(basis, speeds_between(basis)), (basis / 650) ** 2
    error = np.zeros((7, 10))
    error[1::2, 3] = 1e-2 * np.array(c) * node_polynomial(x, (speeds[1::2] / 650) ** 2)
    full = np.ones((7, 10))
    found = further_speeds(
        replace(result, speeds=speeds, full=full, reduced=full + error), basis, tolerance
    )
    assert np.bincount(np.searchsorted(basis, found) - 1, minlength=3).tolist() == [
        2 * (i in intervals) for i in range(3)
    ]
    assert np.all(np.diff(found) > 0)


@pytest.mark.slow
def test_linear_prestress_meets_it_too(coarse_blade, coarse_mesh):
    """K(Omega) has no fourth power there, so that the polynomial is exact."""
    blade = coarse_blade.model_copy(update={"prestress": "linear"})
    speeds = (basis_speeds(blade.basis, 650.0), EVEN)
    fom, between = (assemble(blade, "linear", coarse_mesh.mesh, s) for s in speeds)
    rom, _ = reduce(fom, blade.basis)
    assert rom.n <= 85
    assert abs(check(rom, solve(between, between.states())).error).max() < 1e-5  # measured 4.9e-6


@pytest.mark.parametrize(("directions", "n"), [("r", 60), ("rt", 75)])
def test_fewer_directions_meet_it_with_fewer_dofs(coarse_matrices, full, directions, n):
    rom, _ = reduce(coarse_matrices, EnrichedBasis(), directions)
    result = check(rom, full)
    assert rom.n <= n
    assert abs(result.error).max() < 1e-4
    assert result.compliance_error.shape == (17, 8, len(directions))
    assert abs(result.compliance_error).max() < 2e-4


def test_tip_compliance_is_that_of_the_full_model(result, coarse_rom):
    """Radial, tangential and axial, at the strips, each under its own load: measured 9e-5."""
    assert coarse_rom.n <= 90
    np.testing.assert_allclose(result.xi, (np.arange(8) + 0.5) / 8)
    assert result.compliance_error.shape == (17, 8, 3)
    assert abs(result.compliance_error).max() < 2e-4
    # exact at rest (constraint modes), too stiff at the other speeds of the basis (Galerkin)
    assert abs(result.compliance_error[0]).max() < 1e-8
    assert result.compliance_error[-1].max() < 1e-8


def test_results_at_further_speeds_are_joined(full):
    parts = [
        replace(full, **{name: getattr(full, name)[at] for name in JOINED})
        for at in (slice(0, None, 2), slice(1, None, 2))
    ]
    joined = parts[0].joined(parts[1])
    for name in JOINED:
        np.testing.assert_array_equal(getattr(joined, name), getattr(full, name))


def test_second_order_is_along_a_static_field_without_the_mode_itself(check_matrices):
    """K x = R but for the force of the mode, whose amplitude is given; u_t^2 / 2 r comes on top."""
    fom, seen = check_matrices.at([0.0]), []

    def along(u, x, w):
        seen.append((x, w))
        return 7.0

    full = solve(fom, fom.states(), along=along)
    (tip,), (second,) = full.tip, full.second_order
    R = hats(EDGES, fom.xi) @ fom.rows("r")
    for (edge, mode), (x, w) in zip(np.ndindex(2, BENT), seen, strict=True):
        assert tip[0, edge, mode] == pytest.approx(R[edge] @ w)
        assert abs(w @ (fom.M @ x)) < 1e-9 * np.sqrt(x @ (fom.M @ x))
        left = R[edge] - fom.K[0] @ x - fom.M @ w * (R[edge] @ w)
        assert np.linalg.norm(left) < 1e-6 * np.linalg.norm(R[edge])
    radius = np.interp(EDGES, np.linspace(0, 1, len(fom.camber)), fom.camber[:, 0])
    np.testing.assert_allclose(second, 7.0 + tip[1] ** 2 / 2 / radius[:, None])
    assert np.isnan(solve(fom, fom.states()).second_order).all()  # of matrices from elsewhere


def test_the_paper_basis_reports_its_error_and_is_accepted(paper_blade, coarse_mesh, paper_reduced):
    """On this mesh 0.9 % on seven modes (1.4 % on a fine one), far more on ten; it is exempt."""
    full = solve(*over_speeds(paper_blade, "coarse-paper", coarse_mesh.mesh, EVEN))
    result = check(paper_reduced[0], full)
    assert result.compliance_error.shape == (17, 8, 3)
    np.testing.assert_array_equal(result.xi, paper_reduced[0].xi)
    assert 0.005 < abs(result.error[:, :7]).max() < 0.015
    assert abs(result.error).max() > 0.03
    result.require(PaperBasis.tolerance_percent)


def test_a_missed_tolerance_names_mode_speed_and_error(result):
    """Of either sign; an error also at rest is that of the basis, else that of K(Omega)."""
    bad = replace(result, reduced=result.reduced.copy())
    bad.reduced[[0, 4], 6] = [1.002 * bad.full[0, 6], 0.9975 * bad.full[4, 6]]
    bad.require(0.26)
    off = "frequency 7 is off by 0.25 % at 162.5 rad/s, above basis.tolerance_percent 0.1; "
    modes = "raise basis.natural_modes, lower basis.rank_tolerance or allow more"
    assert refusal(bad) == off + modes
    bad.reduced[0, 6] = bad.full[0, 6]
    assert refusal(bad).startswith(
        f"{off}at the ends of the range the error is far smaller, so it is that of K(Omega) "
    )
    assert "raise basis.speeds" in refusal(bad)


def refusal(result):
    return refused(RomError, result.require, 0.1).text


def test_an_indefinite_model_is_refused_except_with_the_paper_basis(coarse_rom, full):
    """Its frequencies are nan there, and the check says so."""
    K = coarse_rom.K.copy()
    K[1] -= 2e-6 * K[0]  # K(Omega_m) = 0.155 K(0) + ...: some of it goes below zero
    result = check(replace(coarse_rom, K=K), full)
    assert np.isnan(result.reduced[-1]).all() and np.isfinite(result.reduced[0]).all()
    assert np.isfinite(result.highest)
    assert "not positive definite at 528.125 rad/s" in refusal(result)
    result.require(PaperBasis.tolerance_percent)


def test_a_model_smaller_than_the_check_is_refused(coarse_rom, full):
    small = replace(coarse_rom, M=coarse_rom.M[:9, :9], K=coarse_rom.K[:, :9, :9])
    refused(RomError, check, small, full, match=r"9 DoFs, .* 10 frequencies")


def test_error_compares_the_same_modes(result, coarse_rom, full):
    # round-off of the largest eigenvalue
    assert result.reduced[3] == pytest.approx(coarse_rom.modes(result.speeds[3])[0][:10], rel=1e-9)
    np.testing.assert_allclose(result.error, result.reduced / result.full - 1)
    np.testing.assert_array_equal(result.full, full.omega)
    assert full.residuals.max() < 1e-6
    assert result.highest == pytest.approx(
        max(coarse_rom.modes(speed)[0][-1] for speed in result.speeds)
    )


def test_first_frequency_rises_as_on_finer_meshes(coarse_rom):
    """Computed with 12,500 cells: f1(0.31) / f1(0) = 1.2397."""
    f1 = coarse_rom.modes(0.31 * 2 * np.pi * coarse_rom.f1)[0][0] / (2 * np.pi)
    # here 1.2395; a stiffening ratio depends little on the mesh
    assert f1 / coarse_rom.f1 == pytest.approx(1.2397, rel=1e-3)


STORED = {"coarse_rom": ".nc", "coarse_basis": ".h5", "full": ".nc", "result": ".nc"}


@pytest.mark.parametrize("name", STORED)
def test_files_read_back_bit_for_bit_and_of_other_code_are_refused(name, request, tmp_path):
    written = request.getfixturevalue(name)
    path = tmp_path / f"file{STORED[name]}"
    written.save(path)
    again = type(written).load(path)
    for field, value in vars(written).items():
        np.testing.assert_array_equal(getattr(again, field), value)
        assert type(getattr(again, field)) is type(value), field
    older = replace(written.provenance, code="0" * 16)
    replace(written, provenance=older).save(path)
    assert refused(ProvenanceError, type(written).load, path).file == str(path)


def test_speeds_of_bases_and_check():
    np.testing.assert_array_equal(basis_speeds(PaperBasis(kind="paper"), 650.0), [0, 325, 650])
    enriched = basis_speeds(EnrichedBasis(), 650.0)
    cosines = 1 - 2 * (enriched / 650) ** 2  # Chebyshev-Lobatto points of Omega^2
    np.testing.assert_allclose(cosines, np.cos(np.pi * np.arange(4) / 3), atol=1e-15)
    five = basis_speeds(EnrichedBasis(speeds=5), 1.0)
    np.testing.assert_allclose(1 - 2 * five**2, np.cos(np.pi * np.arange(5) / 4), atol=1e-15)
    # of the paper's, w = x (x - 1/4) (x - 1) is largest where 3 x^2 - 2.5 x + 1/4 = 0
    x = (2.5 + np.array([-1, 1]) * np.sqrt(3.25)) / 6
    found = speeds_between([0, 325, 650])
    np.testing.assert_allclose((found / 650) ** 2, x, atol=1e-3)  # w is taken at 1001
