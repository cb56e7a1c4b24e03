"""Figures of the study of accuracy and time, for prescribed rows."""

import numpy as np
import pytest
from test_trade import row

from workflow.figures import trade
from workflow.study.levels import (
    COARSER,
    OBSERVABLES,
    OTHER_SCHEME,
    SCENES,
    group_rows,
    uncertainty,
)

SHARES = {"amplitude": 0.5, "wear": 1.0, "force": 0.2, "history": 0.4}


def of_scene(on, times, more):
    """Rows of a scene with ``times`` the times and ``more`` times the errors."""

    def one(group, name, seconds, largest, steps=4096, **integrator):
        """Wear has the largest error, the others a known part of it."""
        shares = {key: share * more * largest for key, share in SHARES.items()}
        of = row(name, times * seconds, 0.0, on=on, group=group, steps=steps, **shares)
        of["settings"]["integrator"] |= integrator
        return of

    central = {"scheme": "central-difference"}
    return [
        one("finest", COARSER, 1.0, 0.004),
        one("scheme", "16384 steps", 0.4, 0.01, steps=16384),
        one("scheme", "1024 steps", 0.02, 0.08, steps=1024),
        one("scheme", "4096 steps", 0.1, 0.02),
        one("scheme", OTHER_SCHEME, 0.5, 0.001, steps=30000, **central),
        one("scheme", "scaled", 0.04, 0.3, steps=6000, mass_scaling_hz=25e3, **central),
        one("front", "16 strips, 16384 steps, few", 0.3, 1e-5, steps=16384),
        one("front", "16 strips, 2048 steps, few", 0.05, 0.07, steps=2048),
        one("front", "8 strips, 1024 steps, few", 0.02, 0.09, steps=1024),
        one("front", "8 strips, 4096 steps, few", 0.06, 0.08),
    ]


@pytest.fixture(scope="module")
def study():
    """Four scenes; the last has twice the times and three times the errors."""
    return [row for on in SCENES[:3] for row in of_scene(on, 1, 1)] + of_scene(SCENES[-1], 2, 3)


@pytest.fixture(scope="module")
def drawn(study):
    return {"panels": trade.settings(study).axes, "steps": trade.steps(study).axes}


def line(axes, label):
    return next(one for one in axes.lines if one.get_label() == label)


def test_the_band_ends_at_the_largest_uncertainty(drawn):
    panels = drawn["panels"]
    for axes, height in ((panels[0], 0.4), (panels[3], 1.2)):
        (band,) = axes.patches
        bottom = axes.get_ylim()[0]
        assert band.get_y() == bottom == pytest.approx(0.35 * 0.4)
        assert band.get_y() + band.get_height() == pytest.approx(height)
    together = line(panels[0], "same model and rods, by step").get_xydata()
    expected = [[0.05, 7.0], [0.3, 0.35 * 0.4]]  # the error of the last, 1e-5, is not claimed
    np.testing.assert_allclose(together, expected)


def test_the_front_is_a_stepped_line_through_its_runs_and_levels_are_ringed(drawn):
    axes = drawn["panels"][3]
    stair = line(axes, "Pareto front of error and time")
    assert stair.get_drawstyle() == "steps-post"
    expected = [[0.04, 27], [0.1, 21], [0.6, 0.35 * 0.4]]
    np.testing.assert_allclose(stair.get_xydata(), expected)
    np.testing.assert_allclose(line(axes, "16 strips").get_xydata(), expected[1:])
    for panel, seconds in ((drawn["panels"][0], 0.3), (axes, 0.6)):  # 10, 3 and 1 % on all scenes
        rings = [one for one in panel.lines if ": paper in " in one.get_label()]
        assert [ring.get_xdata()[0] for ring in rings] == pytest.approx([seconds] * 3)


def test_where_one_of_four_errors_is_unknown_none_is_drawn():
    rows = [row(COARSER, 1.0, 0.3, group="finest", force=None)]
    unsure = trade.with_floor(uncertainty(rows))
    assert unsure.at["calm", "wear"] == 30 and np.isnan(unsure.at["calm", "worst"])
    assert unsure.at[trade.FLOOR, "worst"] == trade.UNKNOWN
    drawn = trade.shown(group_rows(rows, "finest"), unsure)
    assert np.isnan(drawn["worst"].item()) and drawn["wear"].item() == 30


def test_every_row_of_steps_has_its_observable_and_uncertainty(drawn):
    """Runs of a scheme joined by step."""
    rows = np.reshape(drawn["steps"], (4, 4))
    for axes, share in zip(rows, SHARES.values(), strict=True):
        exact = line(axes[0], "piecewise-exact, by step").get_xydata()
        expected = np.array([[0.02, 8], [0.1, 2], [0.4, 1]]) * [1, share]
        np.testing.assert_allclose(exact, expected)
        scaled = line(axes[3], "central differences, mass-scaled, by step")
        np.testing.assert_allclose(scaled.get_xydata(), [[0.08, 90 * share]])
        assert axes[0].get_ylim()[0] == pytest.approx(0.35 * share * 0.1)
        (band,) = axes[3].patches
        assert band.get_y() + band.get_height() == pytest.approx(share * 0.3)


@pytest.fixture(scope="module")
def features():
    def changed(name, seconds, on="calm", **errors):
        known = dict.fromkeys(OBSERVABLES) | errors
        return row(name, seconds, None, on=on, group="feature", against="as it is", **known)

    less = {"amplitude": -0.05, "wear": 0.004, "lobes": 0}
    whole = {"amplitude": 0.123, "wear": 2e-4, "lobes": -2, "force": 3.0, "history": 0.01}
    return [
        *(row("as it is", 2.0, 0.0, on=on, group="with") for on in SCENES),
        changed("wear feedback: elastic law", 1.86, **whole),
        *(changed("Coriolis: none", 2.16, on=on, **less) for on in SCENES),
    ]


def test_features_have_each_change_in_percent_and_unknown_ones_blank(features):
    """Of the columns amplitude, wear, lobes, force and history; the sixth is the time saved."""
    calm, stiff = np.array(trade.changes(features).axes)[[0, 2]]
    minus = "\N{MINUS SIGN}"

    def cells(axes):
        place = {text.get_position(): text.get_text() for text in axes.texts}
        return [[place.get((x, row), "") for x in calm.get_xticks()] for row in (0, 1)]

    whole = ["12", "0", f"{minus}2", "300", "1", "7"]
    assert cells(calm) == [whole, ["5", "0.4", "0", "", "", f"{minus}8"]]
    assert cells(stiff) == [[""] * 6, ["5", "0.4", "0", "", "", f"{minus}8"]]
    values = calm.images[0].get_array()
    np.testing.assert_allclose(values[0].filled(-1), [12.3, 0.02, -1, 300, 1, -1])
    np.testing.assert_allclose(values[1].filled(-1), [5, 0.4, -1, -1, -1, -1])
