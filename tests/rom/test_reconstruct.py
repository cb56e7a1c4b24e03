"""Fields of the full blade from reduced coordinates, and the static deflection between speeds."""

from dataclasses import replace

import numpy as np
import pytest
from refused import refused

from fem.assemble import assemble
from geometry.provenance import ProvenanceError
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


@pytest.mark.parametrize("kind", ["coarse", "paper"])
def test_interface_dofs_of_the_field_are_those_asked_for(kind, request):
    """S of the Cartesian field is c, whatever the modes do."""
    fom = request.getfixturevalue(f"{kind}_matrices")
    rom, T = request.getfixturevalue(f"{kind}_reduced")
    u = np.random.default_rng(4).normal(size=rom.n)
    field = Basis.of(fom, T, rom.provenance).reconstruct(u)
    assert field.shape == (fom.M.shape[0],)
    # S T = [I, 0] to 1e-9, in the norm of a field that has all modes at once
    np.testing.assert_allclose(fom.S @ field, u[:24], rtol=0, atol=1e-9)


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
    real = assemble(coarse_blade, "coarse", coarse_mesh.mesh, speeds).u_static
    error = [
        abs(basis.static(speed) - u).max() / abs(u).max()
        for speed, u in zip(speeds, real, strict=True)
    ]
    assert np.all(np.array(error) < [2e-3, 3e-4, 1e-4])


def test_states_of_another_model_are_refused(basis):
    n = basis.T.shape[1]
    refused(
        RomError,
        basis.reconstruct,
        np.zeros(3),
        match=rf"shape \(3,\): this basis needs one state of \({n},\)",
    )
    assert refused(RomError, basis.static, 700.0).allowed == (0, 650)


def test_file_of_other_code_is_refused(tmp_path, basis):
    older = replace(basis, provenance=replace(basis.provenance, code="0" * 16))
    older.save(tmp_path / "basis.h5")
    refused(
        ProvenanceError,
        Basis.load,
        tmp_path / "basis.h5",
        match=r"basis.h5: another version of the code made it",
    )
