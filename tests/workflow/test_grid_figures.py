"""Fig. 13 and the states of its cases, for a small prescribed grid."""

from types import SimpleNamespace

import numpy as np
import pytest
from matplotlib.patches import Ellipse

from geometry.project import read_json, write_json
from workflow.figures import fig13_grid, status_grid
from workflow.figures.heat_map import is_sensitive
from workflow.jobs.figure import read as read_files

E, K = [1, 10, 100], [0.45, 4.55]


def peak(amplitude, Omega_c=0.36, departure=1e-9, status="ok", at_end=False):
    return {
        "Omega_c": Omega_c,
        "over_crossing": Omega_c / 0.3,
        "amplitude": amplitude,
        "deepest_wear": 0.2,
        "lobes": 4,
        "status": status,
        "departure": departure,
        "at_end": at_end,
    }


@pytest.fixture
def read(tmp_path):
    """Files of a grid: k = 4 is worst at (10, 4.55), k = 6 at (1, 0.45)."""
    found = {
        (1, 0.45): ({"ok": 9, "sensitive": 1}, peak(1.0), peak(0.9, 0.2)),
        (10, 0.45): ({"ok": 10}, peak(0.5, departure=0.02, status="sensitive"), peak(0.3, 0.19)),
        (100, 0.45): ({"ok": 10}, peak(0.7, at_end=True), peak(0.2, departure=None)),
        (1, 4.55): ({"ok": 7, "inaccurate": 3}, peak(1.2), peak(0.4)),
        (10, 4.55): ({"ok": 10}, peak(2.0, 0.38), None),
        (100, 4.55): ({"inaccurate": 10}, None, None),
    }
    cases = [
        {"E": e, "K": k, "runs": 10, "statuses": ends, "peaks": {"4": four, "6": six}}
        for (e, k), (ends, four, six) in found.items()
    ]
    path = tmp_path / "grid.json"
    write_json({"E": E, "K": K, "orders": [4, 6], "cases": cases}, path)
    return SimpleNamespace(grid=path)


def words(axes):
    """Text of each cell by column and row, however it is placed in it."""
    found = {}
    for text in axes.texts:
        x, y = text.get_position()
        found.setdefault((round(x), round(y)), []).append(text.get_text())
    return found


def rings(axes):
    return [patch.center for patch in axes.patches if isinstance(patch, Ellipse)]


def test_both_maps_of_the_fourth_order(read):
    top, bottom = fig13_grid.draw(*read_files(fig13_grid, read)).axes[:2]
    np.testing.assert_allclose(top.images[0].get_array().filled(-1), [[1, 0.5, 0.7], [1.2, 2, -1]])
    amplitudes = {(0, 0): ["1.00"], (1, 0): ["0.50"], (0, 1): ["1.20"], (1, 1): ["2.00"]}
    assert words(top) == amplitudes | {(2, 0): ["0.70*"]}
    assert words(bottom)[1, 1] == ["0.380"] and words(bottom)[2, 0] == ["0.360*"]
    assert rings(top) == rings(bottom) == [(1, 1)]


def test_the_sixth_order_is_another_map(read):
    drawn = fig13_grid.draw(*read_files(fig13_grid, read), order=6)
    assert rings(drawn.axes[0]) == [(0, 0)]
    assert words(drawn.axes[0])[0, 0] == ["0.90"]
    # what is not there is not explained


def test_a_grid_without_any_peak_is_drawn(read):
    grid = read_json(read.grid)
    for case in grid["cases"]:
        case["peaks"] = {"4": None, "6": None}
    write_json(grid, read.grid)
    top = fig13_grid.draw(*read_files(fig13_grid, read)).axes[0]
    assert rings(top) == [] and words(top) == {}


@pytest.mark.parametrize(
    ("departure", "status", "known"),
    [
        (0.02, "sensitive", True),
        (1e-6, "sensitive", False),  # the wear parts, the response does not
        (None, "sensitive", True),  # the twin ended otherwise
        (None, "ok", None),
    ],
)
def test_states_of_a_peak(departure, status, known):
    assert is_sensitive(peak(1.0, departure=departure, status=status)) is known


def test_states_of_runs_and_peaks(read):
    axes = status_grid.draw(*read_files(status_grid, read)).axes[0]
    assert words(axes)[0, 0] == ["90 %", "4", "6"] and words(axes)[2, 1][0] == "0 %"
    np.testing.assert_allclose(axes.images[0].get_array(), [[0.9, 1, 1], [0.7, 1, 0]])
    states = {}
    for line in axes.lines:
        (x,), (y,) = line.get_data()
        states[round(x), round(y), 4 if x < round(x) else 6] = line.get_label()
    alike = {}  # places of one state
    for place, state in states.items():
        alike.setdefault(state, []).append(place)
    found = sorted(map(sorted, alike.values()))
    known = [(0, 0, 4), (0, 0, 6), (0, 1, 4), (0, 1, 6), (1, 0, 6), (1, 1, 4), (2, 0, 4)]
    assert found == [known, [(1, 0, 4)], [(1, 1, 6), (2, 1, 4), (2, 1, 6)], [(2, 0, 6)]]
