"""What is shown of strain gauges: the map and amplitudes of one, and the table of all."""

import csv
from io import StringIO

import numpy as np
import pytest
import xarray as xr
from made_sweeps import attrs_of, made_rom

from geometry.base import ROOT
from simulate.scene import Scene
from workflow.figures import spectra
from workflow.figures.response import Response

SPEEDS = np.linspace(0.1, 0.4, 7)
ROUNDS, SAMPLES = 2, 64
GAUGE = {"name": "root", "at": [440, 1.8, 0], "direction": [1, 0, 0]}


@pytest.fixture(scope="module")
def response():
    """100 µε of EO 4 on -20 µε at the first gauge, half of it of EO 6 at the second; 10 MPa."""
    scene = Scene.load(ROOT / "workflow/scenes/paper-e1.yaml").but(
        record={"spectrum_rounds": ROUNDS, "gauges": [GAUGE, GAUGE | {"name": "tip"}]}
    )
    time = 18 + np.arange(1, ROUNDS * SAMPLES + 1) / SAMPLES
    wave = np.stack([np.cos(8 * np.pi * time), 0.5 * np.cos(12 * np.pi * time)])
    grown = SPEEDS[:, None, None] / SPEEDS[-1] * wave
    dims = ("speed_over_f1", "gauge", "gauge_time")
    runs = xr.Dataset(
        {
            "gauge_strain": (dims, 1e-4 * grown),
            "gauge_stress": (dims, 1e7 * grown),
            "gauge_strain_static": (dims[:2], np.full((7, 2), -2e-5)),
            "gauge_stress_static": (dims[:2], np.full((7, 2), 5e6)),
            "status": ("speed_over_f1", ["ok"] * 7),
        },
        {
            "speed_over_f1": SPEEDS,
            "speed": ("speed_over_f1", SPEEDS * 2 * np.pi * 100),
            "gauge": ["root", "tip"],
            "gauge_time": time,
        },
        attrs_of(scene) | {"f1_Hz": 100.0},
    )
    return Response(runs, made_rom())


def test_the_first_gauge_is_drawn_in_microstrain_along_engine_orders(response):
    drawn = spectra.of_gauge(response)
    top, bottom = drawn.axes[:2]
    (line,) = [line for line in bottom.get_lines() if line.get_label() == "EO 4"]
    np.testing.assert_allclose(line.get_ydata(), 100 * SPEEDS / 0.4, rtol=1e-6)
    assert "(µε)" in bottom.get_ylabel() and top.get_ylim() == (0, spectra.SHOWN_STRAIN)
    assert any("strain, gauge root (µε)" in axes.get_ylabel() for axes in drawn.axes)


def test_the_table_has_static_and_total_values_of_each_grid(response):
    rows = [*csv.DictReader(StringIO(spectra.gauges_csv(response.sweep)))]
    assert [(row["speed_over_f1"], row["gauge"]) for row in rows[:3]] == [
        ("0.1", "root"), ("0.1", "tip"), ("0.15", "root"),
    ]  # fmt: skip
    last = {name: float(of) for name, of in rows[-2].items() if name not in ("gauge", "status")}
    assert last == pytest.approx(
        {
            "speed_over_f1": 0.4,
            "speed (rpm)": 2400,
            "static strain (µε)": -20,
            "largest strain (µε)": 80,
            "least strain (µε)": -120,
            "vibratory strain (µε)": 100,
            "static stress (MPa)": 5,
            "largest stress (MPa)": 15,
            "least stress (MPa)": -5,
            "vibratory stress (MPa)": 10,
        }
    )
