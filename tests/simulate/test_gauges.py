"""Gauges in a sweep: static part and rows times states; nothing else changes."""

from dataclasses import replace

import numpy as np
import pytest
from refused import refused
from runs import swept
from scenes import EXACT, scene

from geometry.base import SettingsError
from rom.coarser import coarser
from rom.polynomial import evaluate
from simulate.errors.neighbour import Neighbour
from simulate.errors.neighbours import QUARTER
from simulate.errors.run import Case
from simulate.marching import SceneError, check_scene, prepare
from simulate.scene import Record
from simulate.sweeps.dataset import load, of_run, save
from simulate.sweeps.peak_results import to_march

ROOT = {"name": "root", "at": [450.0, 1.0, 2.0], "direction": [1.0, 0.0, 0.0]}
ROSETTE = ROOT | {"name": "mid", "rosette": True}
GAUGES = [ROOT, ROSETTE]
NAMES = ["root", "mid-0", "mid-45", "mid-90"]
RECORD = {"samples_per_round": 64, "spectrum_rounds": 2, "states_rounds": 3, "motion": 1}
SPEEDS = {"over_f1": [0.3, 0.345]}


@pytest.fixture(scope="module")
def rom(coarse_rom):
    """The coarse model with any rows, of two powers of Omega."""
    rng = np.random.default_rng(5)
    rows = rng.standard_normal((2, 2, 4, 1 + coarse_rom.n))
    rows[1] *= 1e-6
    return replace(coarse_rom, gauges=tuple(NAMES), gauge_rows=rows)


def case(**changes):
    record = RECORD | {"gauges": GAUGES} | changes.pop("record", {})
    return scene(**{"rounds": 4, "speeds": SPEEDS, "record": record} | changes)


@pytest.fixture(scope="module")
def kept(rom):
    return swept(case(), rom)


def test_readings_are_rows_times_states_and_the_static_part(kept, rom):
    assert kept["gauge_strain"].dims == ("speed_over_f1", "gauge", "gauge_time")
    assert kept["gauge"].values.tolist() == NAMES and kept["gauge_strain"].dtype == np.float32
    np.testing.assert_allclose(kept["gauge_time"], 2 + np.arange(1, 65) / 32, rtol=1e-15)
    every_other = kept["states"].sel(time=kept["gauge_time"], method="nearest")
    np.testing.assert_allclose(every_other["time"], kept["gauge_time"], rtol=1e-12)
    for index, states in enumerate(every_other.values):
        of_run = kept.isel(speed_over_f1=index)
        rows = evaluate(rom.gauge_rows, of_run["speed"].item())
        for name, of in zip(("strain", "stress"), rows, strict=True):
            moving = of[:, 1:] @ states.T
            assert abs(moving).max() > 0
            found = of_run[f"gauge_{name}"].values
            np.testing.assert_allclose(found, moving, rtol=0, atol=1e-7 * abs(moving).max())
            np.testing.assert_allclose(of_run[f"gauge_{name}_static"], of[:, 0], rtol=1e-13)


def test_gauges_change_no_bit_of_anything_else(kept, coarse_rom):
    plain = swept(case(record={"gauges": None}), coarse_rom)
    gauges = {name for name in kept.variables if str(name).startswith("gauge")}
    assert set(kept.variables) - set(plain.variables) == gauges and len(gauges) == 6
    for name in set(plain.variables) - {"seconds"}:
        np.testing.assert_array_equal(plain[name].values, kept[name].values, str(name))


def test_without_states_and_motion_gauges_read_the_same(kept, rom):
    alone = swept(case(record={"states_rounds": None, "motion": None}), rom)
    assert not {"states", "motion"} & set(alone.variables)
    np.testing.assert_array_equal(alone["gauge_stress"].values, kept["gauge_stress"].values)


def test_a_round_of_an_odd_number_of_samples_is_read_at_each(rom):
    odd = {"samples_per_round": 65, "spectrum_rounds": None, "states_rounds": 1, "motion": None}
    runs = swept(case(record=odd, speeds={"over_f1": [0.3]}), rom)
    np.testing.assert_allclose(runs["gauge_time"], 3 + np.arange(1, 66) / 65, rtol=1e-15)
    np.testing.assert_array_equal(runs["gauge_time"], runs["time"])
    moving = evaluate(rom.gauge_rows, runs["speed"].item())[0, :, 1:] @ runs["states"].values[0].T
    found = runs["gauge_strain"].values[0]
    np.testing.assert_allclose(found, moving, rtol=0, atol=1e-7 * abs(moving).max())


def test_a_file_without_its_gauges_is_refused(kept, tmp_path):
    save(kept, tmp_path / "sweep.nc")
    again = load(tmp_path / "sweep.nc")
    np.testing.assert_array_equal(again["gauge_strain"].values, kept["gauge_strain"].values)
    save(kept.drop_vars("gauge_strain"), tmp_path / "less.nc")
    assert "gauge_strain" in str(refused(Exception, load, tmp_path / "less.nc"))


def test_revolutions_that_are_not_computed_have_no_readings(rom):
    ended = swept(
        case(
            liner__thickness_mm=0.0005,
            casing__harmonics=[{"order": 2, "amplitude_um": 40}],
            speeds={"over_f1": [0.3]},
        ),
        rom,
    )
    assert list(ended["status"].values) == ["liner-exhausted"]
    assert np.isnan(ended["gauge_strain"]).all() and np.isfinite(ended["gauge_strain_static"]).all()


def test_a_blade_that_touches_nothing_reads_rotation_alone(rom):
    alone = swept(case(liner__law={"kind": "none"}, speeds={"over_f1": [0.3]}), rom)
    assert (alone["gauge_strain"] == 0).all() and (alone["gauge_strain_static"] != 0).all()


def test_runs_of_other_models_and_at_peaks_have_no_gauges(kept, rom):
    """But those with another step, whose run may become the result."""
    run = Case(case(), rom, prepare(case(), rom, rom.omega1 * 0.3)).march()
    coarse = run.neighbour(Neighbour("coarser", rom=lambda rom: coarser(rom)[0])).march()
    assert coarse.outcome.gauges.size == 0
    assert np.isfinite(run.neighbour(QUARTER).march().outcome.gauges).all()
    assert np.isfinite(run.outcome.gauges).all()
    twice = swept(
        case(verify__predictable=True, integrator=EXACT, record={"states_rounds": None}), rom
    )
    assert set(twice["status"].values) <= {"ok", "sensitive"}
    assert coarser(rom)[0].gauges == ()
    assert to_march(kept).record.gauges is None


@pytest.mark.parametrize("held", [(), ("root",), ("mid-0", "root", "mid-45", "mid-90")])
def test_a_model_without_these_gauges_is_refused(rom, held):
    error = refused(SceneError, check_scene, case(), replace(rom, gauges=held))
    assert error.key == "record.gauges" and "gauges.nc" in str(error)
    check_scene(case(record={"gauges": None}), replace(rom, gauges=held))


@pytest.mark.parametrize(
    ("gauges", "key"),
    [
        ([ROOT, ROOT], "record.gauges"),
        ([ROSETTE, ROOT | {"name": "mid-45"}], "record.gauges"),
        ([], "record.gauges"),
        ([ROOT | {"name": "Root 1"}], "record.gauges.0.name"),
        ([ROOT | {"length_mm": 0}], "record.gauges.0.length_mm"),
        ([ROOT | {"at": [1.0, 2.0]}], "record.gauges.0.at.2"),
        ([ROOT | {"direction": None}], "record.gauges.0.direction"),
    ],
)
def test_gauges_that_cannot_be_are_refused(gauges, key):
    assert refused(SettingsError, case, record={"gauges": gauges}).key == key


def test_a_run_until_it_is_steady_reads_its_last_rounds(rom):
    """As a run of as many rounds does; of one that breaks off only what was computed."""
    at = {"speeds": {"over_f1": [0.3]}, "damping_ratio": 0.02, "integrator": EXACT}
    until = swept(case(**at, rounds=200, until="steady", record={"motion": None}), rom)
    rounds = int(until["rounds"].item())
    assert 8 < rounds < 200
    same = swept(case(**at, rounds=rounds, record={"motion": None}), rom)
    for name in ("gauge_strain", "gauge_stress"):
        np.testing.assert_array_equal(until[name], same[name])
    np.testing.assert_allclose(until["gauge_time"] + rounds, same["gauge_time"], rtol=1e-12)
    of = case(**at, rounds=200, until="steady")
    setup = replace(prepare(of, rom, 0.3 * rom.omega1), bound=1e-6)
    assert Case(of, rom, setup).march().outcome.rounds < 2
    assert np.isnan(of_run(Case(of, rom, setup).march())["gauge_strain"]).any()


def test_grids_are_those_of_their_gauges():
    grids = Record(gauges=GAUGES).grids
    assert [*grids] == NAMES and [angle for _, angle in grids.values()] == [0, 0, 45, 90]
    assert [of.name for of, _ in grids.values()] == ["root", "mid", "mid", "mid"]
