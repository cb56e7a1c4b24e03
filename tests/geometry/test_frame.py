"""Axes of a file: a signed permutation; blades that do not agree with it are refused."""

import itertools

import numpy as np
import pytest
from refused import refused

from geometry.base import MeshError
from geometry.blade import Frame, SourceFile
from geometry.frame import rotation, to_blade, to_file

AXES = ["x", "-x", "y", "-y", "z", "-z"]
UNIT = {
    name: sign * np.eye(3)[i] for i, a in enumerate("xyz") for name, sign in ((a, 1), (f"-{a}", -1))
}
FRAMES = [
    Frame(downstream=d, radial=r, rotation=hand)
    for d, r in itertools.product(AXES, AXES)
    if d[-1] != r[-1]
    for hand in ("right-handed", "left-handed")
]


def source(frame=None, unit="m"):
    return SourceFile(file="b.inp", unit=unit, frame=frame or Frame())


BLADE = np.array([[0.4, 0.01, 0.02], [0.5, -0.01, -0.02], [0.55, 0.03, 0.01]])  # m


@pytest.mark.parametrize("frame", FRAMES, ids=lambda f: f"{f.downstream}{f.radial}{f.rotation[0]}")
def test_axes_go_where_the_frame_says(frame):
    R = rotation(frame)
    np.testing.assert_array_equal(R @ UNIT[frame.radial], [1, 0, 0])
    np.testing.assert_array_equal(R @ UNIT[frame.downstream], [0, 0, 1])
    np.testing.assert_array_equal(R @ R.T, np.eye(3))
    assert np.linalg.det(R) == (1 if frame.rotation == "right-handed" else -1)


def test_the_default_is_the_frame_of_the_blade():
    np.testing.assert_array_equal(to_blade(BLADE * 1e3, source(unit="mm")), BLADE * 1e3 * 1e-3)


def test_any_frame_brings_the_blade_back_and_to_the_file():
    """Points, and displacements of several nodes in a row."""
    for frame in FRAMES:
        in_file = BLADE @ rotation(frame)  # x = R^T x', for rows
        np.testing.assert_array_equal(to_blade(in_file, source(frame)), BLADE)
        in_file, given = in_file * 1e3, source(frame, unit="mm")
        np.testing.assert_allclose(to_file(to_blade(in_file, given), given), in_file, rtol=1e-15)
        rows = np.stack([BLADE.ravel(), 2 * BLADE.ravel()])
        np.testing.assert_allclose(to_file(rows, given)[1], 2 * in_file.ravel(), rtol=1e-15)


@pytest.mark.parametrize(
    ("radial", "angle"),
    [("-x", "180"), ("y", "-90"), ("-y", "90")],
)
def test_a_blade_along_another_axis_is_refused_with_angle_and_axis(radial, angle):
    error = refused(MeshError, to_blade, BLADE * [1, 0, 1], source(Frame(radial=radial)))
    assert error.allowed == "x"
    assert f"{angle} degrees from frame.radial {radial} about" in error.text


@pytest.mark.parametrize("angle", [44, -44, 46, -46])
def test_a_blade_may_be_45_degrees_from_the_radial_axis(angle):
    c, s = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    leaning = BLADE * [1, 0, 1] @ np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]])
    if abs(angle) < 45:
        np.testing.assert_array_equal(to_blade(leaning, source()), leaning)
    else:
        error = refused(MeshError, to_blade, leaning, source())
        assert error.allowed == ("y" if angle > 0 else "-y")


def test_the_axis_named_by_the_message_is_the_correct_one():
    """For every frame that is refused."""
    for truth, radial in itertools.product(FRAMES, AXES):
        if radial[-1] == truth.downstream[-1] or radial == truth.radial:
            continue
        in_file = BLADE @ rotation(truth)
        error = refused(
            MeshError, to_blade, in_file, source(truth.model_copy(update={"radial": radial}))
        )
        assert error.allowed == truth.radial


@pytest.mark.parametrize(
    ("points", "unit", "length"), [(BLADE, "mm", "0.00015"), (BLADE * 1e3, "m", "150")]
)
def test_a_wrong_unit_is_refused_with_length_and_unit(points, unit, length):
    error = refused(MeshError, to_blade, points, source(unit=unit))
    assert error.allowed == (0.001, 5)
    assert f"{length} m long with unit: {unit};" in error.text
