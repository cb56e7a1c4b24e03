"""Long times: numbers and figure on prescribed sweeps, the worst cases over many rounds."""

from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr
from made_sweeps import ENDS, GAP, attrs_of, by_strip, made_rom

from geometry.base import write_json
from simulate.scene import Scene
from simulate.sweeps.dataset import save
from tests.simulate.scenes import scene
from workflow.paper import long

SPEEDS = [0.3, 0.35, 0.4]
RODS = 64


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
    long = [of.pop(rounds) for rounds in ("20", "200", "2000")]
    return SimpleNamespace(**of, rom=tmp_path / "rom.nc", long=long)


def test_amplitudes_over_the_rounds_and_on_ways_through_the_peak():
    runs = [sweep([0.1, 2.0, 0.3], 0.5, rounds=20), sweep([0.1, 2.5, 0.0], 0.9, rounds=180)]
    rest, run_up = runs[0], sweep([0.1, 4.5, 4.0], [0.5, 0.6, 2.0])
    found = long.numbers(runs, rest, run_up, run_down=rest, on_worn=rest)
    assert found["rounds"] == [20, 200] and found["speeds"] == [0.3, 0.35, 0.4]
    assert found["amplitude"][1] == pytest.approx([0.1, 2.5, 0.0])
    assert found["wear"][1] == pytest.approx([0.9] * 3)
    way = {"largest": 4.5, "at": 0.35, "at_highest": 4.0, "deepest_wear": 2.0}
    assert found["through"]["run_up"] == pytest.approx(way)
    text = long.table(found)
    assert "| after 200 revolutions | 0.1 | 2.5 | 0 |" in text
    assert "| run-up | 4.50 | 0.350 | 4.00 | 2.00 |" in text
    found["amplitude"][1][0], found["status"][1][0] = None, "liner-exhausted"
    assert "| after 200 revolutions | liner-exhausted | 2.5 | 0 |" in long.table(found)


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
    write_json({"cases": listed, "rigid": rigid}, path)
    return SimpleNamespace(worst=path)
