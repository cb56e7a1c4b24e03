"""The priors, as they are on file."""

from pathlib import Path

import numpy as np
import pytest
from refused import refused

from geometry.project import SettingsError, check_settings
from workflow.identify import priors
from workflow.identify.measured import largest_inward
from workflow.identify.priors import NAMES, SHAPE, Prior, Priors

HIGHEST_UNIT = 1e13 / 181.82  # Pa: the stiffest liner over the largest E of Table 1


def test_ends_of_the_unit_cube_are_the_ends_of_the_ranges(narrow):
    ends = narrow.values(np.array([[0.0] * len(NAMES), [1.0] * len(NAMES)]))
    for name in NAMES:
        np.testing.assert_allclose(ends[name], getattr(narrow, name).between)


def test_the_shape_comes_first(narrow):
    assert [*SHAPE] == [*NAMES[: len(SHAPE)]]
    shape = narrow.values(np.full((1, len(SHAPE)), 0.5), SHAPE)
    assert [*shape] == [*SHAPE] and shape["span_mm"] == 150


@pytest.mark.parametrize("name", NAMES)
def test_the_wide_prior_is_twice_as_wide_about_the_same_centre(name, narrow):
    """But for the unit of E, whose upper end is that of the stiffest liner."""
    wide = getattr(Priors.load(Path(priors.__file__).with_name("wide.yaml")), name)
    places = [getattr(narrow, name).place(end) for end in wide.between]
    if name == "unit_Pa":
        assert wide.between[1] == pytest.approx(HIGHEST_UNIT, rel=1e-3)
        places[1] = 1.5
    np.testing.assert_allclose(places, [-0.5, 1.5], atol=2e-3)


def test_largest_distortion_is_that_of_the_curve():
    """In closed form: at c = cos 2 theta = 1, or for a4 < -a2/4 at c = -a2 / (4 a4)."""
    for fourth in (-0.5, -0.3, -0.25, -0.1, 0.0, 0.3, 0.5):
        c = min(1.0, -1 / (4 * fourth)) if fourth < -0.25 else 1.0
        expected = 0.2 + c + fourth * (2 * c**2 - 1)
        assert largest_inward({0: 0.2, 2: 1.0, 4: fourth}) == pytest.approx(expected, rel=1e-6)


@pytest.mark.parametrize(
    "values",
    [{"between": [2.0, 1.0], "why": ""}, {"between": [0.0, 1.0], "log": True, "why": ""}],
)
def test_a_range_without_a_density_is_refused(values):
    error = refused(SettingsError, check_settings, Prior, values, "narrow.yaml")
    assert (error.key, [*error.value]) == ("between", values["between"])
