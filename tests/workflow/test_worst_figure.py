"""The worst cases over many rounds."""

import json
from types import SimpleNamespace

import numpy as np
import pytest

from workflow.figures import worst
from workflow.jobs.figure import read


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
    drawn = worst.draw(*read(worst, cases))
    (axes,) = drawn.axes
    here, paper, rigid, end = axes.lines
    assert list(here.get_xdata()) == list(range(10, 201, 10))
    np.testing.assert_allclose(here.get_ydata()[:5], [0.1, 0.2, 0.3, 0.4, 0.5])
    assert np.isnan(here.get_ydata()[5:]).all()
    assert set(paper.get_ydata()) == {1.5} and set(rigid.get_ydata()) == {0.8}
    assert set(end.get_xdata()) == {20}
    assert axes.get_ylim()[0] == 0 and axes.get_ylim()[1] > 1.5
