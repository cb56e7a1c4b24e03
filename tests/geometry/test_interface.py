import numpy as np
import pytest

from geometry.interface import InterfaceNodes


def test_table_reads_back_bit_for_bit(tmp_path):
    points = np.random.default_rng(1).normal(size=(5, 3)) * [1, 1e-9, 1e9]
    InterfaceNodes(points).save(tmp_path / "interface.csv")
    np.testing.assert_array_equal(InterfaceNodes.load(tmp_path / "interface.csv").points, points)


def test_one_node_keeps_its_shape(tmp_path):
    InterfaceNodes(np.ones((1, 3))).save(tmp_path / "interface.csv")
    assert InterfaceNodes.load(tmp_path / "interface.csv").points.shape == (1, 3)


def test_theta_turns_from_x_to_y():
    nodes = InterfaceNodes(np.array([[0.3, 0.4, 7.0], [0.0, -2.0, 7.0]]))
    assert nodes.radius == pytest.approx([0.5, 2.0])
    assert nodes.theta == pytest.approx([np.arctan(4 / 3), -np.pi / 2])
