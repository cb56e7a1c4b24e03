"""Fields of the full blade from reduced coordinates, and the static deflection between speeds."""

import numpy as np
import pytest

from fem.assemble import assemble
from rom.model import RomError
from rom.reconstruct import Basis


@pytest.fixture(scope="module")
def basis(coarse_matrices, coarse_reduced) -> Basis:
    rom, T = coarse_reduced
    return Basis.of(coarse_matrices, T, rom.provenance)


def test_file_reads_back_bit_for_bit(tmp_path, basis):
    basis.save(tmp_path / "basis.h5")
    again = Basis.load(tmp_path / "basis.h5")
    for name in ("T", "u_static", "coordinates"):
        np.testing.assert_array_equal(getattr(again, name), getattr(basis, name))
    assert (again.Omega_m, again.provenance) == (basis.Omega_m, basis.provenance)


def test_interface_dofs_move_their_node_radially_tangentially_axially(coarse_matrices, basis):
    """Interface DoFs of every node and direction, u_b = 1: its Cartesian displacement there."""
    nodes = coarse_matrices.interface_dofs[:, 0] // 3
    for node, (x, y, _) in enumerate(coarse_matrices.interface_points):
        r = np.hypot(x, y)
        directions = [(x / r, y / r, 0), (-y / r, x / r, 0), (0, 0, 1)]
        for direction, expected in enumerate(directions):
            u = np.zeros(basis.T.shape[1])
            u[3 * node + direction] = 1.0
            moved = basis.reconstruct(u).reshape(-1, 3)[nodes]
            np.testing.assert_allclose(moved[node], expected, atol=1e-15)
            assert not np.delete(moved, node, axis=0).any()


def test_off_the_interface_it_is_the_basis(coarse_matrices, coarse_reduced, basis):
    _, T = coarse_reduced
    u = np.random.default_rng(4).normal(size=T.shape[1])
    others = np.setdiff1d(np.arange(len(T)), coarse_matrices.interface_dofs)
    np.testing.assert_allclose(basis.reconstruct(u)[others], (T @ u)[others], rtol=1e-12)


def test_static_deflection_is_that_of_the_speeds_and_nothing_at_rest(coarse_matrices, basis):
    assert not basis.static(0.0).any()
    for speed, u_static in zip(coarse_matrices.speeds, coarse_matrices.u_static, strict=True):
        # round-off of the interpolation, coefficients up to 16
        np.testing.assert_allclose(
            basis.static(speed), u_static, rtol=0, atol=1e-13 * abs(u_static).max()
        )


def test_static_deflection_between_the_speeds(coarse_blade, coarse_mesh, basis):
    """Against the equilibrium itself, over its largest displacement.

    u_static/Omega^2 is smooth in Omega^2; its quadratic through 1/4, 3/4 and 1 of Omega_m^2 errs
    most near rest, where the deflection is small. Measured 1.3e-3, 1.9e-4, 4.6e-5.
    """
    speeds = [100.0, 450.0, 610.0]
    real = assemble(coarse_blade, coarse_mesh.mesh, coarse_mesh.interface, speeds).u_static
    error = [
        abs(basis.static(speed) - u).max() / abs(u).max()
        for speed, u in zip(speeds, real, strict=True)
    ]
    assert np.all(np.array(error) < [2e-3, 3e-4, 1e-4])


def test_what_does_not_belong_together_is_refused(basis):
    with pytest.raises(RomError, match=r"shape \(3,\): this basis needs one state of \(70,\)"):
        basis.reconstruct(np.zeros(3))
    with pytest.raises(RomError, match=r"speed 700 rad/s is outside \[0, 650\]"):
        basis.static(700.0)
    basis.require(basis.provenance)
    with pytest.raises(RomError, match=r"another reduced model \(mesh 0; basis\).*run the sweep"):
        basis.require("mesh 0; basis")
