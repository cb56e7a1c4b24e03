"""The worst cases over many rounds, and the maps over unit of E and casing amplitude."""

import json
from types import SimpleNamespace

import numpy as np
import pytest
from matplotlib.patches import Ellipse

from workflow.figures import contact_map, worst
from workflow.figures.contact_map import PANELS, borders, panel_marks
from workflow.figures.heat_map import NO_PEAK, NO_RUB, RISE, SENSITIVE, by_cell

UNITS, AMPLITUDES = [1e9, 2e9, 4e9], [1.0, 2.0]


def peak(shift=1.1, amplitude=1.0, wear=0.4, departure=1e-9, at_end=False):
    return {
        "Omega_c": 0.3 * shift,
        "over_crossing": shift,
        "amplitude": amplitude,
        "deepest_wear": wear,
        "lobes": 4,
        "status": "ok",
        "departure": departure,
        "at_end": at_end,
    }


def case(e1=None, e10=None, miss=0.1):
    """Both orders alike."""
    return {"e1": {"4": e1, "6": e1}, "e10": {"4": e10, "6": e10}, "miss": miss}


@pytest.fixture
def found(tmp_path):
    """E = 10 has larger peaks on the left, smaller ones on the right; no rub at the lower right."""
    cases = {
        (1e9, 1.0): case(peak(1.0, 1.0, 0.5), peak(1.2, 1.5, 0.25)),
        (2e9, 1.0): case(peak(1.1, 2.0, 0.5, departure=0.3), peak(1.2, 1.0, 0.5)),
        (4e9, 1.0): case(peak(1.0, 1e-5, 1e-6), peak(1.0, 1e-5, 0.0)),
        (1e9, 2.0): case(peak(1.15, 1.0), peak(1.3, 1.1, 0.6, at_end=True)),
        (2e9, 2.0): case(peak(1.2, 1.0), None, miss=None),
        (4e9, 2.0): case(peak(1.25, 1.0), peak(1.3, 0.9)),
    }
    listed = [{"unit_Pa": u, "scale": s, **made} for (u, s), made in cases.items()]
    best = {"unit_Pa": 2e9, "scale": 2.0}
    written = {"unit_Pa": UNITS, "scale": AMPLITUDES, "cases": listed, "best": best}
    (tmp_path / "map.json").write_text(json.dumps(written))
    return contact_map.load(SimpleNamespace(map=tmp_path / "map.json"))[0]


def panels_of(drawn):
    return [axes for axes in drawn.axes if axes.get_label() != "<colorbar>"]


def test_numbers_of_the_four_panels(found):
    images = [axes.images[0].get_array().filled(-1) for axes in panels_of(contact_map.draw(found))]
    shift, miss, amplitude, wear = images
    np.testing.assert_allclose(shift, [[1.0, 1.1, -1], [1.15, 1.2, 1.25]])
    np.testing.assert_allclose(miss, [[0.1, 0.1, -1], [0.1, -1, 0.1]])
    np.testing.assert_allclose(amplitude, [[1.5, 0.5, -1], [1.1, -1, 0.9]])
    np.testing.assert_allclose(wear, [[0.5, 1.0, -1], [1.5, -1, 1.0]])


def test_each_number_has_the_marks_of_its_peaks(found):
    cases = by_cell(found, "unit_Pa", "scale")
    shift, _, amplitude, _ = PANELS
    assert panel_marks(cases[0, 0], shift) == set()
    assert panel_marks(cases[0, 1], shift) == {SENSITIVE}
    assert panel_marks(cases[0, 2], shift) == {NO_RUB}
    assert panel_marks(cases[1, 0], shift) == set()
    assert panel_marks(cases[1, 0], amplitude) == {RISE}
    assert panel_marks(cases[1, 1], shift) == set()
    assert panel_marks(cases[1, 1], amplitude) == {NO_PEAK}


def test_borders_separate_cells_above_and_below_the_level():
    values = np.array([[0.5, 2.0, np.nan], [0.5, 0.5, 2.0]])
    expected = [[(0.5, -0.5), (0.5, 0.5)], [(1.5, 0.5), (1.5, 1.5)], [(0.5, 0.5), (1.5, 0.5)]]
    np.testing.assert_array_equal(borders(values, 1.0), expected)
    assert borders(values, 5.0) == []


def test_the_maps_are_drawn_as_they_are(found, tmp_path):
    drawn = contact_map.draw(found)
    drawn.savefig(tmp_path / "map.png")
    panels = panels_of(drawn)
    rings = [patch for axes in panels for patch in axes.patches if isinstance(patch, Ellipse)]
    assert [ring.center for ring in rings] == [(1, 1)] * 4  # 2 GPa, two gaps
    assert [tick.get_text() for tick in panels[2].get_xticklabels()] == ["1", "2", "4"]
    assert [tick.get_text() for tick in panels[2].get_yticklabels()] == ["1", "2"]
    assert "GPa" in panels[2].get_xlabel() and "gaps" in panels[2].get_ylabel()
    texts = [{text.get_position(): text.get_text() for text in axes.texts} for axes in panels]
    shifts = {(0, 0): "1.00", (1, 0): "1.10", (0, 1): "1.15", (1, 1): "1.20", (2, 1): "1.25"}
    assert texts[0] == shifts
    assert texts[2][0, 1] == "1.10*"
    (lines,) = panels[2].collections
    np.testing.assert_allclose(lines.get_segments(), [[(0.5, -0.5), (0.5, 0.5)]])  # 1.5 beside 0.5
    labels = [text.get_text() for text in drawn.legends[0].get_texts()]
    assert {NO_PEAK, NO_RUB, SENSITIVE, RISE} <= set(labels)


@pytest.fixture
def cases(tmp_path):
    rounds = list(range(10, 201, 10))
    growing = [0.01 * r for r in rounds[:5]] + [None] * 15
    steady = [1.5] * 20
    listed = [
        {"name": name, "E": E, "K": 4.55, "Omega_c": 0.38, "rounds": rounds, **more}
        for name, E, more in (
            ("here", 1.0, {"amplitude": growing, "status": "liner-exhausted"}),
            ("of the paper", 10.0, {"amplitude": steady, "status": "ok"}),
        )
    ]
    rigid = {"Omega_c": 0.39, "amplitude": 0.8, "status": "ok"}
    path = tmp_path / "worst.json"
    path.write_text(json.dumps({"cases": listed, "rigid": rigid}))
    return SimpleNamespace(worst=path)


def test_growth_over_windows_and_the_rigid_casing(cases):
    drawn = worst.draw(*worst.load(cases))
    (axes,) = drawn.axes
    here, paper, rigid, end = axes.lines
    assert list(here.get_xdata()) == list(range(10, 201, 10))
    np.testing.assert_allclose(here.get_ydata()[:5], [0.1, 0.2, 0.3, 0.4, 0.5])
    assert np.isnan(here.get_ydata()[5:]).all()
    assert set(paper.get_ydata()) == {1.5} and set(rigid.get_ydata()) == {0.8}
    assert set(end.get_xdata()) == {20}
    assert axes.get_ylim()[0] == 0 and axes.get_ylim()[1] > 1.5
    labels = [text.get_text() for text in drawn.legends[0].get_texts()]
    assert "0.380, liner-exhausted" in labels[0] and "$E$ = 10" in labels[1]
    assert labels[2].endswith("0.390")
