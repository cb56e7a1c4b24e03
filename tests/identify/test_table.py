"""Scenes of the rows of a table, and their peaks read back."""

from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from simulate.scene import LEADING, Scene
from workflow.identify import priors
from workflow.identify.measured import at_point
from workflow.identify.points import Blades, drawn_cube, parameters_at
from workflow.identify.priors import NAMES, SHAPE, sobol
from workflow.identify.steps import FIRM, MOST, STEPS, with_steps
from workflow.identify.table import COATINGS, coated, joined, observed, tables

SCENES = Path(priors.__file__).parents[1] / "scenes"


@pytest.fixture(scope="module")
def values(narrow):
    """Parameters of eight points."""
    return narrow.values(sobol(8, len(NAMES), 1))


@pytest.fixture(scope="module")
def scenes(values):
    """Scenes of the rows of these points."""
    base = Scene.load(SCENES / "identify.yaml")
    return [row for i in range(8) for row in coated(at_point(base, parameters_at(values, i)))]


def test_every_point_has_a_row_for_each_coating(scenes):
    given = [(scene.liner.law.E, scene.liner.law.K) for scene in scenes]
    assert given == [*COATINGS] * 8


def harmonics_of(scene):
    """Largest inward distortion, and harmonics 0 to 5, gaps."""
    theta, gap = np.linspace(0, 2 * np.pi, 7201), float(scene.clearance.gaps(LEADING, 0.14))
    inward = scene.casing.inward(theta, gap) / gap
    harmonics = np.fft.rfft(inward[:-1]).real[:6] / (len(theta) - 1)
    return inward.max(), harmonics * [1, 2, 2, 2, 2, 2]


def test_rows_have_the_parameters_of_their_point(scenes, values):
    for i, scene in enumerate(scenes[:: len(COATINGS)]):
        largest, (constant, _, second, _, fourth, fifth) = harmonics_of(scene)
        assert largest == pytest.approx(values["casing_gaps"][i], rel=1e-6)
        assert fourth / second == pytest.approx(values["fourth_over_second"][i], abs=1e-9)
        assert constant / second == pytest.approx(values["constant_over_second"][i], abs=1e-9)
        assert fifth == pytest.approx(0, abs=1e-9)
        assert scene.damping_ratio == pytest.approx(values["damping_ratio"][i])
        assert scene.liner.law.unit_Pa == pytest.approx(values["unit_Pa"][i])
    assert (values["fourth_over_second"] < 0).any()


def test_stiff_coatings_have_more_steps(scenes):
    for scene in scenes:
        assert with_steps(scene) == scene
        E, steps = scene.liner.law.E * scene.liner.law.unit_Pa, scene.integrator.steps_per_round
        assert steps in (STEPS, 2 * STEPS, MOST * STEPS)
        assert E / steps <= FIRM / STEPS or steps == MOST * STEPS
        assert 2 * E / steps > FIRM / STEPS or steps == STEPS  # and no more than these
    assert len({scene.integrator.steps_per_round for scene in scenes}) == 3
    fine = scenes[0].but(integrator__steps_per_round=2**14)
    bare = scenes[0].but(liner__law={"kind": "rigid"})
    assert with_steps(fine) == fine and with_steps(bare) == bare


@pytest.fixture
def seen():
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
    return observed(rows)


def test_only_peaks_that_would_be_named_are_observed(seen):
    number = np.arange(12.0).reshape(6, 2)
    assert seen.over_crossing.shape == (2, 3, 2)
    assert np.isnan(seen.wear.values[0, 0, 1]) and np.isnan(seen.over_crossing.values).sum() == 1
    np.testing.assert_allclose(seen.wear[1], number[3:])
    np.testing.assert_allclose(seen.amplitude[1], number[3:])
    assert joined([seen] * 2).amplitude.shape == (4, 3, 2)


def test_blocks_of_a_table_are_joined_and_nan_is_no_peak(seen):
    """As of a file: null."""
    peaks = {name: np.where(np.isnan(each), None, each).tolist() for name, each in seen.items()}
    cube = drawn_cube(4, 1)
    first, second, other = (
        {"sample": name, "data": None, "cube": at.tolist(), **peaks}
        for name, at in (("prior", cube[:2]), ("prior", cube[2:]), ("first", cube[:2]))
    )
    blades = Blades(np.full((1, len(SHAPE)), 0.5), np.zeros(1), np.zeros((1, 2)))
    prior, later = tables([first, second, other], blades)
    np.testing.assert_array_equal(prior["cube"], cube)
    np.testing.assert_array_equal(prior["wear"], np.concatenate([seen["wear"]] * 2))
    assert later.sizes["point"] == 2
