"""Sobol designs: their rows, and indices against those of functions that are known exactly."""

import json

import numpy as np
import pytest
import xarray as xr
from refused import refused
from scenes import EXACT, scene

from geometry.base import SettingsError
from workflow.many.design import Design
from workflow.many.design_tables import load, save, tables
from workflow.many.engine import march_block
from workflow.many.sobol import Sobol, SobolError, indices

FACTORS = {
    "gap": {
        "keys": ["clearance.leading_edge_over_span", "clearance.trailing_edge_over_span"],
        "between": [0.8, 1.25],
    },
    "damping": {"keys": ["damping_ratio"], "between": [0.5, 2.0]},
}


def table_of(sobol, **quantities) -> xr.Dataset:
    """A table of rows with made numbers."""
    factors = {"factors": (("row", "factor"), sobol.points())}
    data = {name: ("row", values) for name, values in quantities.items()}
    return xr.Dataset(data | factors, attrs={"sobol": sobol.model_dump_json()})


def of(names, bounds, samples) -> Sobol:
    return Sobol(
        samples=samples, factors={name: {"keys": [name], "between": bounds} for name in names}
    )


def test_indices_of_ishigamis_function_are_the_exact_ones():
    """a = 7, b = 0.1; exact values: Saltelli et al. 2008, Eq. (4.40)."""
    a, b = 7, 0.1
    sobol = of("abc", [-np.pi, np.pi], 2048)
    x, y, z = sobol.points().T
    values = np.sin(x) + a * np.sin(y) ** 2 + b * z**4 * np.sin(x)
    found = indices(table_of(sobol, values=values, linear=x + 2 * y), ["values", "linear"])
    alone = np.array([(1 + b * np.pi**4 / 5) ** 2 / 2, a**2 / 8, 0])
    both = 8 * b**2 * np.pi**8 / 225
    shared = np.array([both, 0, both])
    variance = alone.sum() + both
    np.testing.assert_allclose(found.first[0], alone / variance, atol=0.03)
    np.testing.assert_allclose(found.total[0], (alone + shared) / variance, atol=0.03)
    np.testing.assert_allclose(found.first[1], [0.2, 0.8, 0], atol=0.01)
    for of_kind, interval in (
        (found.first, found.first_interval),
        (found.total, found.total_interval),
    ):
        assert (interval[0] <= of_kind).all() and (of_kind <= interval[1]).all()
        assert (interval[1] - interval[0]).max() < 0.2


def test_indices_are_the_same_each_time():
    sobol = of("ab", [0, 1], 64)
    table = table_of(sobol, values=sobol.points() @ [1.0, 3.0])
    first, second = (indices(table, ["values"]) for _ in range(2))
    np.testing.assert_array_equal(first.total_interval, second.total_interval)


@pytest.fixture
def design(tmp_path) -> Design:
    (tmp_path / "factors.yaml").write_text(json.dumps({"samples": 4, "factors": FACTORS}))
    base = scene(integrator=EXACT, rounds=1, casing__ramp_rounds=0.05)
    return Design.of(base.but(design="factors.yaml"), tmp_path / "scene.yaml")


def test_rows_are_the_scene_times_its_factors(design):
    gap, damping = design.sobol.points().T
    scenes = [row.scene for row in design.rows()]
    assert len(scenes) == design.count == 4 * (2 + 2)
    found = [
        (
            of.clearance.leading_edge_over_span,
            of.clearance.trailing_edge_over_span,
            of.damping_ratio,
        )
        for of in scenes
    ]
    expected = np.column_stack([1.5e-4 * gap, 4.3e-4 * gap, 0.005 * damping])
    np.testing.assert_allclose(found, expected, rtol=1e-12)
    assert gap.min() >= 0.8 and gap.max() <= 1.25 and np.ptp(gap) > 0.2


def test_a_marched_design_has_indices_from_its_file(design, coarse_rom, tmp_path):
    models, folder = {"coarse": coarse_rom}, tmp_path / "rows"
    entries = march_block(design.rows(), folder, design.count, models=models)
    _, rows = tables(design, coarse_rom, [entries], folder)
    save(rows, tmp_path / "rows.nc")
    found = indices(load(tmp_path / "rows.nc"), ["largest_wear"])
    assert found.factors == ["gap", "damping"]
    assert found.total[0, 0] > 10 * found.total[0, 1]  # one round: damping does little


def wrong(keys=("rounds",), between=(1, 2)):
    """The factors and one more."""
    return FACTORS | {"a": {"keys": list(keys), "between": list(between)}}


@pytest.mark.parametrize(
    ("changes", "key"),
    [
        ({"samples": 6}, "samples"),
        ({"factors": {"gap": FACTORS["gap"]}}, "factors"),
        ({"factors": wrong(keys=["casing.harmonics"])}, "factors.casing.harmonics"),
        ({"factors": wrong(keys=["rouns"])}, "factors.rouns"),
        ({"factors": wrong(keys=["blade"])}, "factors.blade"),
        ({"factors": wrong(between=[2, 1])}, "factors.between"),
        ({"sample": 4}, "sample"),
    ],
)
def test_a_design_that_cannot_be_drawn_is_refused(tmp_path, monkeypatch, changes, key):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "factors.yaml").write_text(json.dumps({"samples": 4, "factors": FACTORS} | changes))
    error = refused(
        SettingsError, Design.of, scene().but(design="factors.yaml"), tmp_path / "scene.yaml"
    )
    assert (error.file, error.key) == (str(tmp_path / "factors.yaml"), key)


ROWS = table_of(of("ab", [0, 1], 4), values=np.where(np.arange(16) == 5, np.nan, 1.0))


@pytest.mark.parametrize(
    ("table", "told"),
    [
        (ROWS, "1 rows without a result, the first is 6"),
        (ROWS.assign(factors=ROWS["factors"] + 1e-6), "another version of scipy"),
        (ROWS.drop_attrs(), "not a Sobol design"),
    ],
)
def test_rows_without_a_number_or_of_another_design_have_no_indices(table, told):
    assert told in refused(SobolError, indices, table, ["values"]).text
