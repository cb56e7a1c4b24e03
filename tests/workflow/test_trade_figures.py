"""Figures of the study of accuracy and time, for prescribed runs."""

import copy

import numpy as np
import pytest

from workflow.figures import trade, trade_choices, trade_features, trade_steps
from workflow.study.trade_plan import LAST, OVERALL, SAME

FOUR = ("amplitude", "wear", "force", "history")
DEFAULT = {
    "scheme": "piecewise-exact",
    "mass_scaling_hz": None,
    "steps": 4096,
    "rods": 2039,
    "blade": "reference",
    "directions": "r",
    "modes": 20,
    "n": 68,
    "patches": 16,
    "strips": 16,
    "mesh_mm": 2.48,
}
LEVELS = ("draft", "standard", "reference")
AGAINST = {"scheme": SAME, "rods": SAME, "front": OVERALL}  # all others against their own finest


def errors(largest):
    """Wear has the largest error, the others a known part of it; no sweep."""
    shares = dict(zip(FOUR, (0.5, 1.0, 0.2, 0.4), strict=True))
    four = {key: None if largest is None else share * largest for key, share in shares.items()}
    return four | {"Omega_c": None, "lobes": 1}


def run(study, label, seconds, largest, **changed):
    cpu_s = [0.9 * seconds, seconds, 1.5 * seconds]
    made = {"study": study, "scene": "calm", "label": label, "cpu_s": cpu_s}
    made |= {"against": AGAINST.get(study, LAST)} | DEFAULT
    return made | changed | {"errors": errors(largest)}


def central(label, seconds, largest, steps, scaled=None):
    changed = {"scheme": "central-difference", "mass_scaling_hz": scaled, "steps": steps}
    return run("scheme", label, seconds, largest, **changed)


def front(label, seconds, largest, **changed):
    """On eight patches, with eight strips by default."""
    eight = {"blade": "reference-n8", "patches": 8, "strips": 8, "n": 52}
    return run("front", label, seconds, largest, **eight | changed)


@pytest.fixture(scope="module")
def study():
    """Two scenes with 18 runs each; the second has twice the times and three times the errors."""
    runs = [
        run("scheme", "16384 steps", 0.4, 0.01, steps=16384),
        run("scheme", "1024 steps", 0.02, 0.08, steps=1024),
        run("scheme", "4096 steps", 0.1, 0.02),
        central("half", 0.5, 0.03, steps=30000),
        central("scaled", 0.04, 0.3, steps=6000, scaled=25e3),
        run("rods", "1021 rods", 0.08, 0.05, rods=1021),
        run("rods", "2039 rods", 0.1, 0.02),
        run("modes", "12 modes", 0.09, 0.03, modes=12, n=50),
        run("modes", "20 modes", 0.1, 0.02),
        run(
            "interface", "8 patches, 8 strips", 0.05, 0.2, blade="reference-n8", patches=8, strips=8
        ),
        run("interface", "16 patches, 16 strips", 0.1, 0.02),
        run("interface", "16 patches, 32 strips", 0.2, 0.005, strips=32),
        run("mesh", "3.51 mm", 0.1, None, blade="reference-coarse", mesh_mm=3.51),
        run("mesh", "2.48 mm", 0.1, 0.02),
        front("best", 0.3, 1e-5, steps=16384, strips=16),
        front("first", 0.05, 0.07, steps=2048, strips=16),
        front("coarse", 0.02, 0.09, steps=1024),
        front("beaten", 0.06, 0.08, steps=4096),
    ]
    other = copy.deepcopy(runs)
    for one in other:
        one["scene"] = "stiff"
        one["cpu_s"] = [2 * seconds for seconds in one["cpu_s"]]
        one["errors"] = {k: None if e is None else 3 * e for k, e in one["errors"].items()}
    of_levels = zip(LEVELS, (0.02, 0.1, 1.0), (0.08, 0.02, 0.0), (1.44, 6.2, 131.0), strict=True)
    return {
        "scenes": {
            "calm": {
                "speed_over_f1": 0.38,
                "uncertainty": errors(0.004),
                "another_scheme": errors(0.001),
            },
            "stiff": {
                "speed_over_f1": 0.31,
                "uncertainty": errors(0.012),
                "another_scheme": errors(0.003),
            },
        },
        "runs": [*runs, *other],
        "front": {"calm": [16, 15, 14], "stiff": [34, 33, 32]},
        "levels": [
            {
                "level": name,
                "errors": {"calm": errors(largest)},
                "cpu_s": {"calm": seconds},
                "paper_min": minutes,
            }
            for name, seconds, largest, minutes in of_levels
        ],
    }


def bars(axes, label):
    """Marks of CPU time under ``label``, with the ends of their whiskers over them (n, 4)."""
    (bar,) = (one for one in axes.containers if one.get_label() == label)
    whiskers = np.array([s[:, 0] for s in bar[2][0].get_segments() if len(s)])
    marks = bar[0].get_xydata()
    return np.hstack([marks, whiskers / marks[:, :1]])


def line(axes, label):
    return next(one for one in axes.lines if one.get_label().startswith(label))


def bands(axes):
    """Lower end and height of the uncertainty of the references."""
    return [[band.get_y(), band.get_y() + band.get_height()] for of in axes for band in of.patches]


LOW = 0.35 * 0.004  # end of the axis below the uncertainty: a smaller error is not claimed
SPREAD = [0.9, 1.5]  # of the CPU times
SHARES = np.array([0.5, 1.0, 0.2, 0.4])
FIGURES = {"panels": trade, "steps": trade_steps}
NUMBERS = {  # by figure and what is shown: the numbers that are drawn, and what they are
    ("panels", "largest uncertainties"): (bands, [[LOW, 0.004], [LOW, 0.012]]),
    ("panels", "runs of a model by step"): (
        lambda axes: line(axes[0], "same model and rods, by step").get_xydata(),
        [[0.05, 0.07], [0.3, LOW]],
    ),
    ("panels", "the front"): (
        lambda axes: line(axes[1], "Pareto front").get_xydata(),
        [[0.04, 0.27], [0.1, 0.21], [0.6, LOW]],
    ),
    ("panels", "a model on the front"): (
        lambda axes: bars(axes[1], "8 patches, 16 strips"),
        [[0.1, 0.21, *SPREAD], [0.6, LOW, *SPREAD]],
    ),
    ("panels", "another model"): (
        lambda axes: bars(axes[0], "8 patches, 8 strips"),
        [[0.02, 0.09, *SPREAD]],
    ),
    # runs of one choice alone have other references; one that is beaten is drawn
    ("panels", "times of all runs"): (
        lambda axes: sorted({x for one in axes[0].lines for x in one.get_xdata()}),
        [0.02, 0.05, 0.06, 0.1, 0.3, 1.0],
    ),
    ("panels", "levels"): (
        lambda axes: [line(axes[0], f"{name}:").get_xydata()[0] for name in LEVELS],
        [[0.02, 0.08], [0.1, 0.02], [1.0, LOW]],
    ),
    # wear, whose error is the largest
    ("steps", "runs of a scheme"): (
        lambda axes: bars(axes[2], "piecewise-exact, by step"),
        [[0.02, 0.08, *SPREAD], [0.1, 0.02, *SPREAD], [0.4, 0.01, *SPREAD]],
    ),
    ("steps", "mass-scaled runs"): (
        lambda axes: bars(axes[3], "central differences, mass-scaled, by step"),
        [[0.08, 0.9, *SPREAD]],
    ),
    ("steps", "errors of each observable"): (
        lambda axes: [bars(of, "central differences, by step")[0, 1] for of in axes[::2]],
        0.03 * SHARES,
    ),
    ("steps", "uncertainty of each observable"): (
        lambda axes: bands(axes[1::2]),
        np.outer(SHARES, [0.35 * 0.001, 0.003]),
    ),
}


@pytest.mark.parametrize(("figure", "shown"), NUMBERS)
def test_a_figure_shows_its_numbers(study, figure, shown):
    drawn, expected = NUMBERS[figure, shown]
    np.testing.assert_allclose(drawn(FIGURES[figure].draw(study).axes), expected)


def test_where_one_of_four_errors_is_unknown_none_is_drawn():
    assert trade.worst(errors(0.3)) == trade.heights(0.3, 0.1) == 0.3
    assert np.isnan(trade.heights(trade.worst(errors(0.3) | {"force": None}), 0.1))
    assert trade.lowest([None, 0, np.inf]) == trade.UNKNOWN


def cells(axes):
    """Text of the cells, a row of the matrix each, and the rows that are bold."""
    rows, columns = axes.images[0].get_array().shape
    place = {text.get_position(): text.get_text() for text in axes.texts}
    bold = {int(text.get_position()[1]) for text in axes.texts if text.get_fontweight() == "bold"}
    return [[place.get((x, y), "") for x in range(columns)] for y in range(rows)], sorted(bold)


def test_choices_have_errors_in_percent_and_times_over_that_of_the_default(study):
    """Of amplitude, wear, force and history; 3.51 mm failed."""
    calm, stiff, _ = trade_choices.draw(study).axes
    written, bold = cells(stiff)
    names = [text.get_text() for text in calm.get_yticklabels()]
    rows = dict(zip(names, written, strict=True))
    assert [names[i] for i in bold] == [
        *("2039 rods", "20 modes", "16 patches, 16 strips", "mesh 2.48 mm"),
    ]
    assert rows["1021 rods"] == ["7.5", "15", "3", "6", "0.80"]
    assert rows["16 patches, 32 strips"] == ["0.75", "1.5", "0.3", "0.6", "2.00"]
    assert rows["mesh 3.51 mm"] == ["", "", "", "", "1.00"]


def test_errors_below_the_difference_of_schemes_are_in_brackets(study):
    """Not those below the uncertainty of the overall reference."""
    close = copy.deepcopy(study)
    close["scenes"]["calm"]["another_scheme"]["wear"] = 0.022
    written, _ = cells(trade_choices.draw(close).axes[0])
    assert [row[1] for row in written[:4]] == ["5", "(2)", "3", "(2)"]


@pytest.fixture(scope="module")
def features():
    changes = {"amplitude": 0.123, "Omega_c": None, "wear": 2e-4, "lobes": -2, "force": 3.0}
    feedback = {"feature": "wear feedback", "instead": "elastic law"}
    gyro = {"feature": "Coriolis", "instead": "none"}
    less = {"amplitude": -0.05, "Omega_c": None, "wear": 0.004, "lobes": 0, "force": None}
    return [
        feedback | {"scene": "calm", "changes": changes | {"history": 0.01}, "time_ratio": 0.93},
        gyro | {"scene": "calm", "changes": less | {"history": None}, "time_ratio": 1.08},
        gyro | {"scene": "stiff", "changes": less | {"history": 0.2}, "time_ratio": None},
    ]


def test_features_have_each_change_in_percent_and_unknown_ones_blank(features):
    """Of the columns amplitude, wear, lobes, force and history; the sixth is the time saved."""
    calm, stiff, _ = trade_features.draw({"features": features}).axes
    minus = "\N{MINUS SIGN}"
    whole = ["12", "0", f"{minus}2", "300", "1", "7"]
    assert cells(calm)[0] == [whole, ["5", "0.4", "0", "", "", f"{minus}8"]]
    assert cells(stiff)[0] == [[""] * 6, ["5", "0.4", "0", "", "20", ""]]
    values = calm.images[0].get_array()
    np.testing.assert_allclose(values[0].filled(-1), [12.3, 0.02, -1, 300, 1, -1])
    np.testing.assert_allclose(values[1].filled(-1), [5, 0.4, -1, -1, -1, -1])
