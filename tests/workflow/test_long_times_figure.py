"""Figure of long times, on prescribed sweeps."""

import numpy as np
import pytest
import xarray as xr
from made_sweeps import ENDS, GAP, attrs_of, by_strip, made_rom

from simulate.scene import Scene
from simulate.sweeps.dataset import save
from tests.simulate.scenes import scene
from workflow.figures import long_times

SPEEDS = [0.3, 0.35, 0.4]
RODS = 64


class Files(dict):
    """Files by name, as a job has them."""

    __getattr__ = dict.__getitem__


def sweep(amplitude, deepest, rounds=20) -> xr.Dataset:
    """Amplitudes (speeds,) along k = 4, and the deepest wear, in gaps."""
    of: Scene = scene(rounds=rounds, record__spectrum_rounds=10)
    spectrum = np.zeros((len(SPEEDS), 101))
    spectrum[:, 40] = amplitude
    wear = np.zeros((len(SPEEDS), RODS))
    wear[:, 5] = deepest
    return xr.Dataset(
        {
            "status": ("speed_over_f1", np.array(["ok"] * len(SPEEDS))),
            "spectrum": (("speed_over_f1", "engine_order"), GAP * spectrum),
            "wear": (("speed_over_f1", "strip", "theta"), GAP * by_strip(wear)),
        },
        coords={
            "speed": ("speed_over_f1", np.array(SPEEDS) * 2 * np.pi * 100),
            "speed_over_f1": ("speed_over_f1", SPEEDS),
            "end": ("strip_end", ENDS),
        },
        attrs=attrs_of(of),
    )


@pytest.fixture
def files(tmp_path):
    sweeps = {
        "rest": sweep([0.1, 2.0, 0.3], 0.5),
        "run_up": sweep([0.1, 0.2, 4.0], [0.5, 0.5, 2.0]),
        "run_down": sweep([3.0, 3.5, 4.0], 2.0),
        "on_worn": sweep([3.0, 0.3, 0.2], 2.0),
        "20": sweep([0.1, 2.0, 0.3], 0.5, rounds=20),
        "200": sweep([0.1, 2.2, 0.1], 0.5, rounds=180),
        "2000": sweep([0.1, 2.3, 0.1], 0.5, rounds=1800),
    }
    for name, runs in sweeps.items():
        save(runs, tmp_path / f"{name}.nc")
    made_rom().save(tmp_path / "rom.nc")
    of = {name: tmp_path / f"{name}.nc" for name in sweeps}
    return Files(of, rom=tmp_path / "rom.nc", long=[of[n] for n in ("20", "200", "2000")])


def test_amplitudes_over_the_rounds_and_over_the_speed(files):
    rounds, speeds, wear = long_times.draw(*long_times.load(files)).axes
    lines = {line.get_label(): line for line in rounds.get_lines()}
    np.testing.assert_allclose(lines["0.350"].get_xdata(), [20, 200, 2000])
    np.testing.assert_allclose(lines["0.350"].get_ydata(), [2.0, 2.2, 2.3], rtol=1e-6)
    np.testing.assert_allclose(speeds.get_lines()[1].get_ydata(), [0.1, 0.2, 4.0], rtol=1e-6)
    np.testing.assert_allclose(wear.get_lines()[1].get_ydata(), [0.5, 0.5, 2.0], rtol=1e-6)
