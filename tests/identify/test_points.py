"""Points as blades and places, and what the emulator sees of them."""

import numpy as np
import pytest

from workflow.identify.points import UNIT, Blades, drawn_cube, parameters_at
from workflow.identify.priors import NAMES, SHAPE


def blade(place, softness, others=1.0, leading=1.0):
    tip = {"softness": softness, "others": others, "leading": leading}
    return {"places": [place] * len(SHAPE), **tip}


def test_each_blade_is_as_likely_and_has_its_own_shape(narrow):
    blades = Blades.of([blade(i / 4, 1e-6, i + 1, i) for i in range(4)], narrow)
    cube = drawn_cube(64, 1)
    number, points = blades.number(cube), blades.points(cube)
    assert np.bincount(number).tolist() == [16] * 4
    assert points.shape == (64, len(NAMES))
    np.testing.assert_array_equal(
        points[:, : len(SHAPE)], np.repeat(number[:, None] / 4, 7, axis=1)
    )
    np.testing.assert_array_equal(points[:, len(SHAPE) :], cube[:, 1:])


def test_features_have_the_unit_times_the_softness_of_the_blade(narrow):
    """Equal units on a blade ten times as stiff: lower by a decade of the prior's 2.5."""
    blades = Blades.of([blade(0.5, 1e-6, 0.1, 0.5), blade(0.5, 1e-7, 10.0, 1.5)], narrow)
    cube = np.full((2, 7), 0.25)
    cube[1, 0] = 0.75
    soft, stiff = blades.features(cube)
    assert soft[UNIT] - stiff[UNIT] == pytest.approx(1 / np.log10(300))
    assert (soft[1:5] == stiff[1:5]).all() and UNIT == 0
    np.testing.assert_allclose(stiff[5:7], 0.43)  # as far from the mean as one sigma
    np.testing.assert_allclose(soft[5:7], -0.43)
    np.testing.assert_allclose(soft[7:], 0.15 * 0.5)
    without = np.delete(cube, 5, axis=1)  # the fifth harmonic
    np.testing.assert_array_equal(blades.features(np.insert(without, 5, 0.9, axis=1))[0], soft)
    assert blades.points(cube)[0, len(SHAPE) + UNIT] == 0.25


def test_values_of_one_point():
    values = {"unit_Pa": [1e9, 2e9], "damping_ratio": np.array([0.01, 0.02])}
    assert parameters_at(values, 1) == {"unit_Pa": 2e9, "damping_ratio": 0.02}
