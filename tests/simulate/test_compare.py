"""How far two arrays are apart."""

import numpy as np
import pytest

from simulate.compare import distance, error


def test_distance_is_over_the_larger_and_the_same_from_both_sides():
    one, other = np.array([0.0, 9.0]), np.array([0.0, 10.0])
    assert distance(one, other) == distance(other, one) == pytest.approx(0.1)
    assert distance(np.array([3.0, 4.0]), np.zeros(2)) == 1
    assert distance(np.zeros(2), np.zeros(2)) == 0


def test_the_largest_value_is_the_norm_of_order_inf():
    one, other = np.array([4.0, 2.0]), np.array([4.0, 1.0])
    assert distance(one, other, order=np.inf) == pytest.approx(1 / 4)
    assert distance(one, other) == pytest.approx(1 / np.sqrt(20))


def test_what_is_less_than_the_least_is_hardly_a_distance():
    assert distance(np.array([1e-12]), np.array([2e-12]), least=1e-9) == pytest.approx(1e-3)


def test_an_error_is_over_the_reference():
    assert error(1.1, 1.0) == pytest.approx(0.1)
    assert error(np.array([3.0, 4.5]), np.array([3.0, 4.0])) == pytest.approx(0.1)
