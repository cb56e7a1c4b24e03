"""What the figures of the set-up say: blade, footprint, laws and casing (Figs. 2, 4, 5, 6)."""

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr
from scipy.signal import argrelmax

from geometry.settings import read_settings
from simulate.scene import Harmonic, Scene
from simulate.sweep import save as save_sweep
from workflow.figures import fig02_blade, fig06_casing, views

ROOT = Path(__file__).parents[2]
GAP = 2e-5


@pytest.fixture(scope="module")
def paper():
    return read_settings(Scene, ROOT / "workflow/scenes/paper-e1.yaml")


@pytest.fixture(scope="module")
def blade(coarse_mesh):
    files = SimpleNamespace(mesh=coarse_mesh.mesh, interface=coarse_mesh.interface)
    (read,) = fig02_blade.load(files)
    return read


@pytest.fixture(scope="module")
def blade_panels(blade):
    return fig02_blade.draw(blade).axes


def noted(axes):
    """Annotations of ``axes``: text and the point it belongs to."""
    return {
        text.get_text(): text.xy for text in axes.texts if text.get_text() and hasattr(text, "xy")
    }


def test_the_camera_tells_where_a_point_is_in_the_picture(blade):
    """The skin's outermost points bound the picture, but for the outline, 4 pixels wide."""
    surface = views.skin(blade.points, blade.cells, np.zeros(len(blade.points)))
    image = views.picture(
        surface, surface, fig02_blade.PAINT, (0, 1), fig02_blade.VIEW, fig02_blade.LIGHT
    )
    rows, columns = views.window([image])
    pixels = views.Camera.on(blade.points, fig02_blade.VIEW).pixels(blade.points)
    low, high = pixels.min(axis=0), pixels.max(axis=0)
    np.testing.assert_allclose(low, [columns.start, rows.start], atol=3)
    np.testing.assert_allclose(high, [columns.stop - 1, rows.stop - 1], atol=3)


def test_nodes_are_numbered_from_the_leading_edge(blade, blade_panels):
    """Upstream and ahead in the sense of rotation, which points upwards."""
    whole, tip = blade_panels
    named, points = noted(tip), 1e3 * blade.interface.points
    for number, (x, y, z) in enumerate(points, start=1):
        assert named[str(number)][0] == pytest.approx(z)
        # unrolled at the mean radius: the tip is a cylinder
        assert named[str(number)][1] == pytest.approx(np.hypot(x, y) * np.arctan2(y, x), rel=1e-6)
    assert named["LE"] == pytest.approx(named["1"]) and named["TE"] == pytest.approx(named["8"])
    assert named["LE"][0] < named["TE"][0] and named["LE"][1] > named["TE"][1]
    (arrow,) = (text for text in tip.texts if getattr(text, "arrow_patch", None))
    assert arrow.xy[1] > arrow.xyann[1]
    assert "9" not in named and {"1", "8", "LE", "TE"} <= set(noted(whole))


def test_nodes_in_the_picture_lie_on_the_tip(blade_panels):
    """On the picture of the blade, in its uppermost eighth: the tip as seen from above."""
    (whole, _) = blade_panels
    (line,) = whole.lines
    image = np.asarray(whole.images[0].get_array())
    columns, rows = np.round(line.get_data()).astype(int)
    assert np.all(image[rows, columns, 3] > 0)
    assert rows.max() < image.shape[0] / 8


@pytest.fixture(scope="module")
def shapes(paper, tmp_path_factory):
    """Two diameters as in the paper's scenes, and with a fifth harmonic of half a gap."""
    fifth = Harmonic(order=5, amplitude_m=GAP / 2)
    casing = paper.casing.model_copy(update={"harmonics": [*paper.casing.harmonics, fifth]})
    scenes = {"two": paper, "two_five": paper.model_copy(update={"casing": casing})}
    folder = tmp_path_factory.mktemp("casing")
    for name, scene in scenes.items():
        swept = xr.Dataset(coords={"gap": ("node", [GAP, 3 * GAP])})
        save_sweep(swept.assign_attrs(scene=scene.model_dump_json()), folder / name)
    return fig06_casing.load(SimpleNamespace(**{name: folder / name for name in scenes}))


def test_casing_shapes_are_the_scenes_over_the_gap_of_node_1(shapes):
    """1.75 [(1 + cos 2 theta) / 2]^2, and cos 5 theta / 2 on it; inward is up in the curves."""
    *_, two, two_five = fig06_casing.draw(*shapes).axes
    theta, d = two.lines[0].get_data()
    closed = 1.75 * ((1 + np.cos(2 * np.radians(theta))) / 2) ** 2
    np.testing.assert_allclose(d, closed, atol=1e-12)
    fifth = np.cos(5 * np.radians(theta)) / 2
    np.testing.assert_allclose(two_five.lines[0].get_ydata(), closed + fifth, atol=1e-12)
    assert [shape.orders for shape in shapes] == [(0, 2, 4), (0, 2, 4, 5)]
    nearest = [len(argrelmax(shape.inward[:-1], mode="wrap")[0]) for shape in shapes]
    assert nearest == [2, 5]  # "five privileged contact areas", section 7.2.2


def test_the_drawn_casing_is_in_the_gaps_scale(shapes):
    """Between undistorted casing and tip lies one gap, and inward is towards the axis."""
    drawn = fig06_casing.draw(*shapes).axes[:2]
    for axes, shape in zip(drawn, shapes, strict=True):
        casing, around, tip = (np.hypot(*line.get_data()) for line in axes.lines[:3])
        np.testing.assert_allclose((around - casing) / (around - tip), shape.inward, atol=1e-12)
    scales = [1 - np.hypot(*axes.lines[2].get_data()) for axes in drawn]
    np.testing.assert_allclose(*scales)


def test_where_the_casing_closes_the_gap_is_hatched(shapes):
    """1.75 cos^4 theta > 1: up to 29.6 deg from its two nearest angles."""
    around, _, over, _ = fig06_casing.draw(*shapes).axes
    half = np.degrees(np.arccos((1 / 1.75) ** 0.25))
    (band,) = over.collections
    bounds = [(path.vertices[:, 0].min(), path.vertices[:, 0].max()) for path in band.get_paths()]
    sides = [(0, half), (180 - half, 180 + half), (360 - half, 360)]
    np.testing.assert_allclose(bounds, sides, atol=0.5)  # drawn every half degree
    x, y = around.patches[0].get_xy().T
    tip = np.hypot(*around.lines[2].get_data())[0]
    closed = np.hypot(x, y) < tip - 1e-9
    away = np.abs((np.degrees(np.arctan2(y, x)) + 90) % 180 - 90)
    assert away[closed].max() == pytest.approx(half, abs=0.5)
