"""Figures of the identification, on made numbers."""

from pathlib import Path

import numpy as np
import pytest

from workflow.figures import identified, together
from workflow.identify import priors
from workflow.identify.likelihood import FITS, SHIFTS, WITH_ORDER
from workflow.identify.priors import Priors
from workflow.identify.table import sobol

PRIORS = Priors.load(Path(priors.__file__).with_name("priors.yaml"))


def test_densities_are_over_the_priors():
    """Weights of the upper half of the first parameter: density 2 there, 0 below; others 1."""
    points = sobol(512, 1)
    upper = (points[:, 0] > 0.5) / 256
    of = {"weights": upper.tolist(), "effective": 256.0, "ranges": {}}
    few = {"weights": upper.tolist(), "effective": 43.2, "ranges": None}
    fits = {
        "served": "printed",
        "values": {name: values.tolist() for name, values in PRIORS.values(points).items()},
        "fits": {fit.name: {SHIFTS: of, WITH_ORDER: few} for fit in FITS},
    }
    first, *others, _ = identified.draw(fits, PRIORS).axes
    assert len(first.patches) == 3
    for step in first.patches:
        values, edges, _ = step.get_data()
        np.testing.assert_allclose(values, [0] * 5 + [2] * 5, atol=0.1)
        assert edges[[0, -1]] == pytest.approx([0.1, 30])  # GPa
    for axes in others:
        np.testing.assert_allclose(axes.patches[0].get_data()[0], 1, atol=0.2)


def test_shares_together_are_written_into_their_cells():
    rows = {"C12": {"C12": 1.0, "C16": 0.25}, "C16": dict.fromkeys(("C12", "C16"), float("nan"))}
    of = {"4.55": {"holds": {"C12": 0.5, "C16": 0.0}, "together": rows}}
    prior, _ = together.draw({"prior": of}).axes
    cells = {text.get_position(): text.get_text() for text in prior.texts}
    assert cells == {(0, 0): "50", (1, 0): "25", (1, 1): "0"}
