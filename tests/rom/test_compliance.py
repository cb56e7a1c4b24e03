"""Compliance of strips of the liner on the tip."""

import numpy as np
import pytest

from rom.full_model import compliance_of_strips


@pytest.mark.parametrize("n", [2, 7])
def test_the_compliance_of_a_rigid_tip_is_the_same_at_every_strip(n):
    np.testing.assert_allclose(compliance_of_strips(np.full((n, n), 3e-6)), 3e-6, rtol=1e-14)


def test_the_middle_of_two_edges_is_their_mean():
    """A rigid tip that leans under its load: edges behind and ahead at 1 and 5, apart at 2."""
    C = np.kron([[1.0, 2.0], [2.0, 5.0]], np.ones((4, 4)))
    np.testing.assert_allclose(compliance_of_strips(C, across=2), 10 / 4, rtol=1e-14)


def test_strips_lie_a_quarter_of_the_way_between_two_patches():
    """Patches at both ends, strips in the middles of both halves: weights 3/4 and 1/4, squared."""
    np.testing.assert_allclose(
        compliance_of_strips(np.diag([16.0, 32.0])), [11.0, 19.0], rtol=1e-14
    )
