"""What the figures of the set-up say: blade, footprint, laws and casing (Figs. 2, 4, 5, 6)."""

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from workflow.figures import fig02_blade, views

ROOT = Path(__file__).parents[2]


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
