"""The design of a table as scenes, and its peaks read back."""

from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from refused import refused

from geometry.project import SettingsError
from simulate.scene import LEADING, Scene
from simulate.scene.design import Design
from workflow.identify import priors
from workflow.identify.priors import Priors
from workflow.identify.steps import FIRM, with_steps
from workflow.identify.table import COATINGS, design, joined, observed, parameters, settings, sobol

PRIORS = Priors.load(Path(priors.__file__).with_name("priors.yaml"))
SCENES = Path(priors.__file__).parents[1] / "scenes"
STIFFNESS = 3.0


@pytest.fixture(scope="module")
def scenes(tmp_path_factory):
    """Scenes of the rows of eight points on a blade three times as stiff."""
    folder = tmp_path_factory.mktemp("table")
    text = design(settings(PRIORS, sobol(8, 1), STIFFNESS))
    (folder / "prior.csv").write_text(text)
    scene = Scene.load(SCENES / "identify.yaml").but(design="prior.csv")
    return Design.of(scene, folder / "scene.yaml").scenes


def test_every_point_has_a_row_for_each_coating(scenes):
    given = [(scene.liner.law.E, scene.liner.law.K) for scene in scenes]
    assert given == [*COATINGS] * 8


def test_rows_have_the_parameters_of_their_point(scenes):
    values, theta, span = PRIORS.values(sobol(8, 1)), np.linspace(0, 2 * np.pi, 7201), 0.14
    for i, scene in enumerate(scenes[:: len(COATINGS)]):
        gap = float(scene.clearance.gaps(LEADING, span))
        inward = scene.casing.inward(theta, gap) / gap
        harmonics = np.fft.rfft(inward[:-1]).real / (len(theta) - 1)
        constant, second, fourth = harmonics[[0, 2, 4]] * [1, 2, 2]
        assert inward.max() == pytest.approx(values["casing_gaps"][i], rel=1e-6)
        assert fourth / second == pytest.approx(values["fourth_over_second"][i], abs=1e-9)
        assert constant / second == pytest.approx(values["constant_over_second"][i], abs=1e-9)
        assert scene.damping_ratio == pytest.approx(values["damping_ratio"][i])
        assert scene.liner.law.unit_Pa == pytest.approx(STIFFNESS * values["unit_Pa"][i])
    assert (values["fourth_over_second"] < 0).any()


def test_the_parameters_of_a_row_are_read_back(scenes):
    points = sobol(8, 1)
    for point, scene in zip(points, scenes[:: len(COATINGS)], strict=True):
        there = parameters(scene)
        there["unit_Pa"] /= STIFFNESS
        np.testing.assert_allclose(PRIORS.point(there), point, rtol=1e-9)


@pytest.mark.parametrize(
    "harmonic", [{"order": 5, "amplitude_gaps": 0.1}, {"order": 4, "phase_deg": 90.0}]
)
def test_a_casing_of_another_shape_has_no_parameters(scenes, harmonic):
    known = [of.model_dump(exclude_unset=True) for of in scenes[0].casing.harmonics[:2]]
    other = scenes[0].but(casing__harmonics=[*known, {"amplitude_gaps": 0.1} | harmonic])
    assert refused(SettingsError, parameters, other).key == "casing.harmonics"


def test_stiff_coatings_have_more_steps(scenes):
    for scene in scenes:
        assert with_steps(scene) == scene
        E, steps = scene.liner.law.E * scene.liner.law.unit_Pa, scene.integrator.steps_per_round
        assert steps in (1024, 2048, 4096, 8192)
        assert E / steps <= FIRM / 1024 or steps == 8192
        assert 2 * E / steps > FIRM / 1024 or steps == 1024  # and no more than these
    assert len({scene.integrator.steps_per_round for scene in scenes}) == 4
    fine = scenes[0].but(integrator__steps_per_round=2**14)
    bare = scenes[0].but(liner__law={"kind": "rigid"})
    assert with_steps(fine) == fine and with_steps(bare) == bare


def test_only_peaks_that_would_be_named_are_observed():
    """Two points: rows by point, then coating; the second peak of the first row is not named."""
    number = np.arange(12.0).reshape(6, 2)
    reported = np.ones((6, 2), int)
    reported[0, 1] = 0
    variables = {
        name: (("row", "order"), values)
        for name, values in {
            "reported": reported, "over_crossing": number, "peak": number, "wear": 2e-5 * number,
        }.items()
    }  # fmt: skip
    rows = xr.Dataset(
        variables | {"gap": (("row",), np.full(6, 2e-5))}, {"order": [4, 6], "row": range(1, 7)}
    )
    seen = observed(rows)
    assert seen.over_crossing.shape == (2, 3, 2)
    assert np.isnan(seen.wear.values[0, 0, 1]) and np.isnan(seen.over_crossing.values).sum() == 1
    np.testing.assert_allclose(seen.wear[1], number[3:])
    np.testing.assert_allclose(seen.amplitude[1], number[3:])
    assert joined([seen] * 2).amplitude.shape == (4, 3, 2)
