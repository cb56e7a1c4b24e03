"""Fields of the full blade from reduced coordinates, and the static deflection between speeds."""

import numpy as np
from refused import refused

from fem.assemble import assemble
from rom.model import RomError


def test_static_deflection_is_that_of_the_speeds_and_nothing_at_rest(coarse_matrices, coarse_basis):
    assert not coarse_basis.static(0.0).any()
    for speed, u_static in zip(coarse_matrices.speeds, coarse_matrices.u_static, strict=True):
        # round-off of the interpolation, coefficients up to 16
        np.testing.assert_allclose(
            coarse_basis.static(speed), u_static, rtol=0, atol=1e-13 * abs(u_static).max()
        )


def test_static_deflection_between_the_speeds(coarse_blade, coarse_mesh, coarse_basis):
    """Against the equilibrium itself, over its largest displacement.

    u_static/Omega^2 is smooth in Omega^2; its quadratic through 1/4, 3/4 and 1 of Omega_m^2 errs
    most near rest, where the deflection is small. Measured 1.3e-3, 1.9e-4, 4.6e-5.
    """
    speeds = [100.0, 450.0, 610.0]
    real = assemble(coarse_blade, "coarse", coarse_mesh.mesh, speeds).u_static
    error = [
        abs(coarse_basis.static(speed) - u).max() / abs(u).max()
        for speed, u in zip(speeds, real, strict=True)
    ]
    assert np.all(np.array(error) < [2e-3, 3e-4, 1e-4])


def test_states_of_another_model_are_refused(coarse_basis):
    refused(RomError, coarse_basis.reconstruct, np.zeros(3))
    assert refused(RomError, coarse_basis.static, 700.0).allowed == (0, 650)
