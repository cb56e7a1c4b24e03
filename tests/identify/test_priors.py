"""The priors, as they are on file, and the casing that they draw."""

from pathlib import Path

import numpy as np
import pytest
from refused import refused

from geometry.project import SettingsError, check_settings
from workflow.identify import priors
from workflow.identify.priors import NAMES, Prior, Priors, largest_inward

PRIORS = Priors.load(Path(priors.__file__).with_name("priors.yaml"))


def test_ends_of_the_unit_cube_are_the_ends_of_the_ranges():
    ends = PRIORS.values(np.array([[0.0] * 5, [1.0] * 5]))
    for name in NAMES:
        np.testing.assert_allclose(ends[name], getattr(PRIORS, name).between)


def test_largest_distortion_is_that_of_the_curve():
    theta = np.linspace(0, np.pi, 20001)
    for fourth in (-0.5, -0.3, -0.25, -0.1, 0.0, 0.3, 0.5):
        curve = 0.2 + np.cos(2 * theta) + fourth * np.cos(4 * theta)
        largest = largest_inward(np.array([fourth]), np.array([0.2]))
        np.testing.assert_allclose(largest, curve.max(), rtol=1e-7)


@pytest.mark.parametrize(
    "values",
    [{"between": [2.0, 1.0], "why": ""}, {"between": [0.0, 1.0], "log": True, "why": ""}],
)
def test_a_range_without_a_density_is_refused(values):
    error = refused(SettingsError, check_settings, Prior, values, "priors.yaml")
    assert (error.key, [*error.value]) == ("between", values["between"])
