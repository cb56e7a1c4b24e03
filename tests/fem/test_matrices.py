"""The coarse blade's matrices: what the reduced model receives."""

import hashlib

import numpy as np
import pytest
from scipy.sparse import csr_matrix, identity, random_array
from scipy.sparse.linalg import eigsh

from fem.assemble import assemble
from fem.interface import cylindrical, dofs_at
from fem.matrices import Matrices
from fem.prestress import mass
from fem.solid import read_solid
from geometry.interface import InterfaceNodes


@pytest.fixture(scope="module")
def solid(coarse_blade, coarse_files):
    return read_solid(str(coarse_files.mesh), coarse_blade.material)


@pytest.fixture(scope="module")
def Q(coarse_matrices):
    points = coarse_matrices.interface_points
    theta = np.arctan2(points[:, 1], points[:, 0])
    return cylindrical(coarse_matrices.M.shape[0], coarse_matrices.interface_dofs, theta)


def test_matrices_are_symmetric_to_the_last_bit(coarse_matrices):
    for A in (coarse_matrices.M, *coarse_matrices.K):
        assert abs(A - A.T).max() == 0


@pytest.mark.parametrize("prestress", ["linear", "nonlinear"])
def test_assembled_matrices_are_symmetric_to_the_last_bit(coarse_blade, coarse_files, prestress):
    """Before the file, whose upper triangle would hide it."""
    blade = coarse_blade.model_copy(update={"prestress": prestress})
    matrices = assemble(blade, coarse_files.mesh, coarse_files.interface, [400.0])
    for A in (matrices.M, *matrices.K):
        assert abs(A - A.T).max() == 0


def test_file_reads_back_bit_for_bit(tmp_path):
    rng = np.random.default_rng(1)

    def symmetric():
        A = random_array((12, 12), density=0.2, rng=rng, format="csr")
        return csr_matrix(A + A.T + identity(12))

    matrices = Matrices(
        M=symmetric(),
        K=(symmetric(), symmetric()),
        speeds=np.array([0.0, 1 / 3]),
        u_static=rng.normal(size=(2, 12)),
        residuals=np.array([0.0, 1e-17]),
        coordinates=rng.normal(size=(4, 3)),
        interface_dofs=np.array([[9, 10, 11], [3, 4, 5]]),
        interface_points=rng.normal(size=(2, 3)),
        span=1 / 7,
        mesh_hash="5ead",
    )
    matrices.save(tmp_path / "matrices.h5")
    again = Matrices.load(tmp_path / "matrices.h5")
    for A, B in zip((matrices.M, *matrices.K), (again.M, *again.K), strict=True):
        assert type(B) is csr_matrix
        np.testing.assert_array_equal(A.toarray(), B.toarray())
    for name in vars(matrices).keys() - {"M", "K"}:
        before, after = getattr(matrices, name), getattr(again, name)
        np.testing.assert_array_equal(before, after)
        assert np.asarray(before).dtype == np.asarray(after).dtype, name


def test_matrices_say_what_they_are_of(coarse_blade, coarse_files, coarse_matrices):
    n_full = coarse_matrices.M.shape[0]
    assert coarse_matrices.mesh_hash == hashlib.sha256(coarse_files.mesh.read_bytes()).hexdigest()
    np.testing.assert_allclose(coarse_matrices.speeds, 650 * np.sqrt([0, 0.25, 0.75, 1]))
    assert coarse_matrices.u_static.shape == (4, n_full)
    assert coarse_matrices.coordinates.shape == (n_full // 3, 3)
    assert coarse_matrices.residuals.max() <= 1e-9
    interface = InterfaceNodes.load(coarse_files.interface)
    np.testing.assert_array_equal(coarse_matrices.interface_points, interface.points)


def test_first_frequency_is_near_that_of_finer_meshes(coarse_matrices):
    (value,) = eigsh(coarse_matrices.K[0], 1, coarse_matrices.M, sigma=0)[0]
    f1 = np.sqrt(value) / (2 * np.pi)
    # 258.05 Hz on 12,500 cells (design.md, section 4); P2 converges from above, here by 0.5 %
    assert 258.05 < f1 < 258.05 * 1.015


def test_mass_is_turned_at_the_interface_and_nowhere_else(coarse_matrices, solid, Q):
    difference = coarse_matrices.M - Q.T @ mass(solid) @ Q
    assert abs(difference).max() < 1e-15 * abs(coarse_matrices.M).max()  # round-off of a turn


def test_unit_radial_displacement_points_outward(coarse_matrices, Q):
    points = coarse_matrices.interface_points
    for node, dofs in enumerate(coarse_matrices.interface_dofs):
        outward = points[node, :2] / np.hypot(*points[node, :2])
        for dof, expected in zip(
            dofs, [(*outward, 0), (-outward[1], outward[0], 0), (0, 0, 1)], strict=True
        ):
            unit = np.zeros(Q.shape[0])
            unit[dof] = 1
            u = (Q @ unit).reshape(-1, 3)
            # the node of the mesh that moves is the interface node, and no other does
            here = np.flatnonzero(abs(u).max(axis=1))
            assert coarse_matrices.coordinates[here] == pytest.approx(points[[node]], abs=1e-15)
            assert u[here[0]] == pytest.approx(expected, abs=1e-15)


def test_turn_about_the_axis_is_tangential_at_the_interface(coarse_matrices, Q):
    """u = e_z x X: radius in the sense of rotation, nothing outward, nothing axial."""
    x, y, _ = coarse_matrices.coordinates.T
    turned = Q.T @ np.column_stack([-y, x, np.zeros_like(x)]).ravel()
    expected = np.zeros((8, 3))
    expected[:, 1] = 0.5624
    assert turned[coarse_matrices.interface_dofs] == pytest.approx(expected, abs=1e-14)


def test_interface_table_of_another_mesh_is_refused(coarse_matrices):
    moved = coarse_matrices.interface_points + np.array([0, 0, 1e-6])
    with pytest.raises(ValueError, match=r"nodes and mesh differ by 1\.0e-06 m: rebuild"):
        dofs_at(coarse_matrices.coordinates, moved)


def test_matrices_at_some_of_their_speeds(coarse_matrices):
    some = coarse_matrices.at([650.0, 325.0])
    for here, there in enumerate([3, 1]):
        assert some.K[here] is coarse_matrices.K[there]
        np.testing.assert_array_equal(some.u_static[here], coarse_matrices.u_static[there])
        assert some.residuals[here] == coarse_matrices.residuals[there]
    np.testing.assert_allclose(some.speeds, [650, 325], rtol=1e-15)
    with pytest.raises(ValueError, match=r"hold none at some of \[0, 300\]"):
        coarse_matrices.at([0, 300])
