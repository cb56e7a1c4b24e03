"""Six-node triangles: shape functions, and the facet that contains a place."""

import numpy as np
import pytest

from geometry.facets import nearest_facet, outward, shape_functions, shape_gradients

NODES = np.array([[0, 0], [1, 0], [0, 1], [0.5, 0], [0.5, 0.5], [0, 0.5]])  # VTK's order
X = np.random.default_rng(3).dirichlet([1, 1, 1], 9)[:, 1:]


def test_shape_functions_represent_quadratic_fields_exactly():
    """Including constants; so each is one at its node and zero at the others."""

    def fields(x):
        a, b = x.T
        return np.column_stack([np.ones(len(x)), a, b, a * a, a * b, b * b])

    np.testing.assert_allclose(shape_functions(X) @ fields(NODES), fields(X), atol=1e-15)


def test_gradients_are_those_of_finite_differences():
    """Central differences are exact for parabolas, up to round-off over the step."""
    step = 1e-3
    for direction in range(2):
        move = step * np.eye(2)[direction]
        slope = (shape_functions(X + move) - shape_functions(X - move)) / (2 * step)
        np.testing.assert_allclose(shape_gradients(X)[..., direction], slope, atol=1e-12)


@pytest.fixture(scope="module")
def sheet():
    """Two facets on the unit square with bent sides: corners (2, 6, 2)."""
    diagonal = [0.55, 0.45]
    first = [[0, 0], [1, 0], [0, 1], [0.5, -0.05], diagonal, [0.03, 0.5]]
    second = [[1, 0], [1, 1], [0, 1], [1.04, 0.5], [0.5, 1.02], diagonal]
    return np.array([first, second])


@pytest.mark.parametrize("facet", [0, 1])
def test_place_in_a_facet_is_found_again(sheet, facet):
    for x in X:
        place = shape_functions(x[None])[0] @ sheet[facet]
        found, there = nearest_facet(sheet, place)
        assert found == facet
        np.testing.assert_allclose(there, x, atol=1e-12)


def test_a_place_outside_belongs_to_the_facet_with_the_smallest_violation(sheet):
    found, x = nearest_facet(sheet, np.array([1.2, 0.9]))
    assert found == 1
    assert min(*x, 1 - x.sum()) < -0.05


def test_outward_reverses_facets_with_inward_normals():
    """A flat tip at radius 2 about the direction (1, 1)."""
    flat = np.column_stack([np.zeros(6), NODES])
    c = np.sqrt(0.5)
    points = np.array([2, 0, 0]) + flat
    points = points @ np.array([[c, c, 0], [-c, c, 0], [0, 0, 1]])
    other = np.array([0, 2, 1, 5, 4, 3])  # the same nodes, the other way round
    turned = outward(np.array([np.arange(6), other]), points)
    np.testing.assert_array_equal(turned, [np.arange(6)] * 2)
