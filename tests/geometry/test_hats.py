"""Hat functions along the chord: exact for constants and linear fields, also beyond both ends."""

import numpy as np
import pytest

from geometry.hats import hat_nodes, hats, middles

XI = np.linspace(-0.2, 1.2, 57)  # includes 0 and 1, and places beyond


@pytest.mark.parametrize("n", [2, 3, 8, 16])
def test_hats_are_a_partition_of_unity_and_exact_for_linear_fields(n):
    nodes = hat_nodes(n)
    values = hats(XI, nodes)
    # round-off of values up to 1 + 0.2 n
    np.testing.assert_allclose(values.sum(axis=1), 1, rtol=0, atol=1e-14)
    np.testing.assert_allclose(values @ (3 - 2 * nodes), 3 - 2 * XI, rtol=0, atol=1e-13)


@pytest.mark.parametrize("nodes", [hat_nodes(5), middles(4), np.array([0.1, 0.15, 0.7])])
def test_each_hat_is_one_at_its_node_and_zero_at_the_others(nodes):
    np.testing.assert_allclose(hats(nodes, nodes), np.eye(len(nodes)), atol=1e-15)


def test_hats_are_nonnegative_on_the_chord_and_at_most_two_overlap():
    values = hats(np.linspace(0, 1, 101), hat_nodes(7))
    assert values.min() >= 0
    assert ((values > 0).sum(axis=1) <= 2).all()


def test_hat_nodes_include_both_ends_and_middles_are_those_of_equal_parts():
    np.testing.assert_allclose(hat_nodes(5), [0, 0.25, 0.5, 0.75, 1])
    np.testing.assert_allclose(middles(4), [0.125, 0.375, 0.625, 0.875])
    assert hats(0.3, hat_nodes(3)).shape == (1, 3)  # one place
