"""Fig. 13 and the states of its cases, for a small prescribed grid."""

from types import SimpleNamespace

import numpy as np
import pytest

from geometry.project import write_json
from workflow.figures import fig13_grid, status_grid
from workflow.figures.fig13_grid import is_sensitive
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
    """Text of each cell by column and row, from the upper left, and which are bold."""
    found = {text.get_position(): text.get_text() for text in axes.texts}
    bold = [text.get_position() for text in axes.texts if text.get_fontweight() == "bold"]
    return found, bold


@pytest.mark.parametrize(
    ("order", "amplitudes", "largest"),
    [
        (4, [["1.20", "2.00†", "-"], ["1.00", "(0.50)", "0.70*"]], (1, 0)),
        (6, [["0.40", "-", "-"], ["0.90", "0.30", "0.20"]], (0, 1)),
    ],
)
def test_numbers_of_the_peak_have_their_marks(read, order, amplitudes, largest):
    top, bottom = fig13_grid.draw(*read_files(fig13_grid, read), order=order).axes[:2]
    written = dict(zip(np.ndindex(3, 2), np.transpose(amplitudes).ravel(), strict=True))
    assert words(top) == (written, [largest]) and words(bottom)[1] == [largest]
    shown = [[float(text.strip("()*†").replace("-", "-1")) for text in row] for row in amplitudes]
    np.testing.assert_allclose(top.images[0].get_array().filled(-1), shown)


def test_a_grid_without_any_peak_is_drawn(read):
    (grid,) = read_files(fig13_grid, read)
    cases = [case | {"peaks": {"4": None, "6": None}} for case in grid["cases"]]
    assert {*words(fig13_grid.draw(grid | {"cases": cases}).axes[0])[0].values()} == {"-"}


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
    assert words(axes)[0] == {
        (0, 0): "70 % ok\n4 ●   6 ●",
        (1, 0): "100 % ok\n4 ●   6 x",
        (2, 0): "0 % ok\n4 x   6 x",
        (0, 1): "90 % ok\n4 ●   6 ●",
        (1, 1): "100 % ok\n4 ◇   6 ●",
        (2, 1): "100 % ok\n4 ●   6 ○",
    }
    np.testing.assert_allclose(axes.images[0].get_array(), [[30, 0, 100], [10, 0, 0]])
