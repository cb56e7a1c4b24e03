"""Gap over the speed in figure and summary, of a scene that gives it at rest."""

import numpy as np
import pytest
import xarray as xr
from made_sweeps import F1, SPAN, attrs_of, made_rom

from simulate.scene import Scene
from workflow.figures import gap, summary
from workflow.figures.response import Response

XI = np.array([1, 5, 11, 15]) / 16  # of four strips
SPEEDS = np.array([0.2, 0.3])
AT_REST = {"leading_edge_m": 8e-5, "trailing_edge_m": 12e-5, "at": "rest"}


@pytest.fixture
def response():
    """Gaps that shrink by 10 and 30 um, along the chord twice as much at its end."""
    paper = {"leading_edge_over_span": None, "trailing_edge_over_span": None}
    scene = Scene.load("workflow/scenes/paper-e1.yaml").but(clearance=paper | AT_REST)
    taken = np.array([[1e-5], [3e-5]]) * (1 + (XI - 1 / 16) * 16 / 14)
    coords = {
        "speed_over_f1": SPEEDS,
        "speed": ("speed_over_f1", 2 * np.pi * F1 * SPEEDS),
        "xi": ("strip", XI),
        "gap": (("speed_over_f1", "strip"), scene.clearance.gaps(XI, SPAN) - taken),
    }
    status = {"status": ("speed_over_f1", ["ok", "ok"])}
    return Response(xr.Dataset(status, coords, attrs_of(scene)), made_rom())


def test_figure_has_the_gap_at_both_places_and_those_at_rest(response):
    drawn = [list(line.get_ydata()) for line in gap.draw(response).axes[0].lines]
    np.testing.assert_allclose(drawn, [[70, 50], [80, 80], [100, 60], [120, 120]], rtol=1e-9)


def test_summary_says_the_gap_at_both_ends_of_the_sweep(response):
    numbers = summary.summarise(response.rom, None, {"mine": response})
    assert numbers["scenes"]["mine"]["gap_um"] == [
        {"speed": 0.2, "gap": [70.0, 100.0]},
        {"speed": 0.3, "gap": [50.0, 60.0]},
    ]
    table = summary.table(numbers)
    assert "70.0 and 100.0 at 0.200, 50.0 and 60.0 at 0.300" in table
    # running gaps have none
    running = response.scene.but(clearance={"at": "running"})
    sweep = response.sweep.assign_attrs(scene=running.model_dump_json())
    assert Response(sweep, response.rom).gaps is None
