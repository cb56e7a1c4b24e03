"""Loads over the speed: torque of recorded forces or of the ledger, and what is not known."""

import numpy as np
import pytest
from projects import TABLES
from scenes import scene

from rom.reduce import reduce
from simulate.sweeps.over_speeds import as_sweep, at_speeds
from simulate.sweeps.peak import Peak
from workflow.figures import loads, table
from workflow.figures.response import Response

EXACT = {"scheme": "piecewise-exact", "steps_per_round": 2048}
TORQUES = {
    "flat": {},
    "friction": {"contact": {"friction": 0.1}},
    "tangential": {"contact": {"profile": {"tilt": 0.002}, "tangential": True}},
}
WITHOUT = {
    "contact.profile without contact.tangential": {"contact": {"profile": {"tilt": 0.002}}},
    "casing.harmonics that travel": {
        "casing__harmonics": [{"order": 1, "amplitude_gaps": 2, "speed_rad_s": 100}]
    },
}


@pytest.fixture(scope="module")
def loads_of(coarse_matrices, coarse_blade):
    """Loads of a scene with recorded forces, and without the variables named."""
    rom = reduce(coarse_matrices, coarse_blade.basis, "rt")[0]

    def of(without=(), **changes):
        case = scene(rounds=3, integrator=EXACT, record__contact_force=True, **changes)
        runs = as_sweep(at_speeds(case, rom, 2 * np.pi * rom.f1 * np.array([0.33, 0.34])))
        assert (runs["status"] == "ok").all()
        told = {"scene": "mine", "peaks": []}
        return loads.loads_of(Response(runs.drop_vars(without), rom), told, None)

    return of


@pytest.mark.parametrize("name", TORQUES)
def test_torque_of_the_ledger_is_that_of_the_forces(loads_of, name):
    """Of a tilted tip the ledger has none (``loads``)."""
    forces, ledger = (loads_of(without, **TORQUES[name]) for without in ((), "torque"))
    assert forces.no_torque is None and (forces.lines["torque"] > 0).all()
    if name == "tangential":
        assert "torque" not in ledger.lines
    else:
        np.testing.assert_allclose(ledger.lines["torque"], forces.lines["torque"], rtol=1e-6)


@pytest.mark.parametrize("why", WITHOUT)
def test_without_a_torque_there_is_no_line_and_the_figure_says_why(loads_of, why):
    of = loads_of(**WITHOUT[why])
    assert (of.no_torque, "torque" in of.lines) == (why, False)
    known = of._replace(name="other", no_torque=None, lines={"torque": np.array([0.3, 0.4])})
    drawn = loads.panels([of, known], 100.0, "mine")
    assert any(why in axes.get_title(loc="right") for axes in drawn.axes)


def test_a_number_that_is_not_recorded_is_known_at_peaks_and_the_caption_names_its_key(loads_of):
    caption = table.read(*TABLES)["loads-{blade}"].caption
    for name, variable, key in (
        ("force", "force_mean", "record.contact_force"),
        ("worn_volume", "wear", "record.wear"),
    ):
        assert key in caption
        peak = Peak(4, 0, 0.33, numbers={name: 2.0}, errors={name: 0.1})
        of = loads_of(variable)._replace(peaks=[peak])
        assert name not in of.lines
        drawn = loads.panels([of], 100.0, "mine")
        labels = [text.get_text() for text in drawn.legends[0].get_texts()]
        assert "peaks of scene mine" in labels
