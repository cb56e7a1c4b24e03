"""``sweep.nc``: what a sweep holds, what it says of its origin, and how blocks merge."""

from dataclasses import asdict, replace
from datetime import UTC, datetime

import numpy as np
import pytest
from refused import refused
from scenes import blade_balance, scene

from geometry.provenance import ProvenanceError
from simulate.dataset import (
    FORMAT,
    code,
    load,
    merge,
    origin,
    over_f1,
    require_rom,
    save,
    scene_of,
)
from simulate.over_speeds import at_speeds, block_speeds
from simulate.places import strip_places
from simulate.run import march
from simulate.setup import prepare

ROUND_TIP = {"contact__profile": {"edge_drop_m": 2e-5}, "contact__tangential": True}


def rad_s(rom, over_f1):
    return 2 * np.pi * rom.f1 * over_f1


def test_a_sweep_holds_the_ledger(coarse_rom):
    case, Omega = scene(rounds=1), rad_s(coarse_rom, 0.33)
    kept = at_speeds(case, coarse_rom, [Omega])
    ledger = march(case, prepare(case, coarse_rom, Omega)).ledger
    assert kept["ledger"].dims == ("speed_over_f1", "energy") and kept["ledger"].units == "J"
    by_name = dict(zip(kept["energy"].values, kept["ledger"].values[0], strict=True))
    energies = asdict(ledger) | {"numerical": ledger.numerical}
    assert energies.pop("friction") == energies.pop("heat") == 0  # kept where there is friction
    assert by_name == energies
    # every energy is said in the file
    assert all(f"{name}: " in kept["energy"].long_name for name in by_name)
    assert by_name["casing"] > by_name["plastic"] > 0
    # the blade's own balance, to round-off of its steps
    assert abs(blade_balance(ledger)) < 1e-9 * ledger.casing


def test_a_tangential_force_is_kept_where_it_is_modelled(coarse_rom):
    """In proportion to the normal force, by the slope of the profile."""
    case = scene(rounds=1, **ROUND_TIP)
    kept = at_speeds(case, coarse_rom, [rad_s(coarse_rom, 0.33)])
    assert kept["force_tangential_mean"].dims == ("speed_over_f1", "round", "share")
    ratio = (kept["force_tangential_mean"] / kept["force_mean"]).values[0, 0]
    steepest = 4 * 2e-5 / 5e-3  # at the ends of the footprint
    assert kept["force_mean"].values[0, 0, 0] > 0
    assert 0 < abs(ratio[0]) <= steepest
    assert "force_tangential_mean" not in at_speeds(
        scene(rounds=1), coarse_rom, kept["speed"].values
    )


def test_every_coordinate_is_explained_and_has_its_values(coarse_rom):
    record = {"spectrum_rounds": 1, "samples_per_round": 64, "states_rounds": 1}
    record |= {"history": {"chord": [0.25]}, "contact_force": True}
    case = scene(rounds=2, record=record)
    kept = at_speeds(case, coarse_rom, [rad_s(coarse_rom, 0.33)])
    for name, coordinate in kept.coords.items():
        assert coordinate.attrs.get("long_name"), name
        assert name == "energy" or coordinate.attrs["units"], name
    unlabelled = set(kept.dims) - set(kept.coords)
    assert unlabelled == {"strip", "strip_end", "dof"}  # xi and end name strips
    nu = case.liner.rods_per_round
    np.testing.assert_allclose(kept["theta"], 2 * np.pi * np.arange(nu) / nu)
    assert kept["engine_order"].values.tolist() == list(range(33))
    assert kept["history_time"].values[[0, -1]].tolist() == [1 / 64, 2.0]
    assert kept["round"].values.tolist() == [1, 2] and kept["share"].values[0] == 1 / 16
    assert kept.history.sel(chord=0.25).shape == (1, 128)
    assert kept["speed_over_f1"].values.tolist() == [0.33]
    for name in ("f1_Hz", "tip_radius_m", "gap_m", "blade", "source", "Conventions", "code"):
        assert kept.attrs[name], name
    assert kept.attrs["f1_Hz"] == coarse_rom.f1
    assert 0 < kept.attrs["tip_radius_m"] - coarse_rom.camber[:, 0].min() < 1e-3


def test_sweeps_are_compared_by_the_speed_over_f1(coarse_rom):
    """Also of blades whose f1(0) differ: the same speeds over f1(0) are other ones in rad/s."""
    stiffer = replace(coarse_rom, f1=1.1 * coarse_rom.f1)
    case = scene(rounds=1)
    one, other = (
        at_speeds(case, rom, [rad_s(rom, speed) for speed in over])
        for rom, over in ((coarse_rom, [0.3, 0.31]), (stiffer, [0.31, 0.32]))
    )
    difference = one["wear"] - other["wear"]
    assert difference["speed_over_f1"].values.tolist() == [0.31]
    assert np.isfinite(difference).all()


def test_runs_are_found_among_the_speeds_of_their_scene(coarse_rom):
    """To the last bit, by the function that makes the index."""
    case = scene(rounds=1, speeds={"over_f1": {"first": 0.061, "last": 0.39, "count": 151}})
    Omega = case.speeds.omega(coarse_rom.f1)
    kept = at_speeds(case, coarse_rom, Omega[1::50])
    assert np.isin(kept["speed_over_f1"], over_f1(Omega, coarse_rom)).all()
    given = case.speeds.over_f1.values()[1::50]
    np.testing.assert_allclose(kept["speed_over_f1"], given, rtol=0, atol=1e-12)


def test_a_file_says_when_it_was_made(coarse_rom, tmp_path):
    save(at_speeds(scene(rounds=1), coarse_rom, [rad_s(coarse_rom, 0.33)]), tmp_path / "sweep.nc")
    made = datetime.fromisoformat(load(tmp_path / "sweep.nc").attrs["date_created"])
    assert abs((datetime.now(UTC) - made).total_seconds()) < 60


def test_a_sweep_holds_its_scene_and_provenance(coarse_rom):
    case = scene(rounds=1, record__states_rounds=1, liner__strips=5)
    kept = at_speeds(case, coarse_rom, [rad_s(coarse_rom, 0.33)])
    assert scene_of(kept) == case and origin(kept) == coarse_rom.provenance
    assert kept.attrs["code"] == code() and len(kept.attrs["code"]) == 16
    assert kept.attrs["gap_m"] == pytest.approx(1.5e-4 * coarse_rom.span, rel=1e-14)
    places = strip_places(coarse_rom, 5)
    for name, dim in (("xi", "strip"), ("width", "strip"), ("end", "strip_end")):
        assert kept[name].dims == (dim,)
    np.testing.assert_array_equal(kept["xi"], places.xi)
    np.testing.assert_array_equal(kept["end"], places.ends)
    np.testing.assert_array_equal(kept["width"], places.width)
    np.testing.assert_array_equal(kept["gap"], case.clearance.gaps(places.xi, coarse_rom.span))
    assert kept["wear"].dims == ("speed_over_f1", "strip", "theta")
    assert kept["history"].dims == ("speed_over_f1", "chord", "history_time")
    assert kept["force_mean"].dims == kept["force_peak"].dims == ("speed_over_f1", "round", "share")
    assert kept.sizes["share"] == 8 and kept.sizes["chord"] == 2
    np.testing.assert_array_equal(kept["P"], coarse_rom.rows(places.xi))


def test_a_sweep_holds_what_the_scene_records_and_no_more(coarse_rom):
    lean = scene(rounds=1, record={"samples_per_round": 64, "wear": False, "spectrum_rounds": 1})
    kept = at_speeds(lean, coarse_rom, [rad_s(coarse_rom, 0.35)])
    assert "spectrum" in kept
    assert not {"wear", "history", "force_peak", "force_mean"} & set(kept)
    full = at_speeds(scene(rounds=1), coarse_rom, [rad_s(coarse_rom, 0.35)])
    assert {"wear", "history", "force_peak", "force_mean"} <= set(full)
    # recording more does not change the results
    np.testing.assert_array_equal(kept["spectrum"].values, full["spectrum"].values)
    assert full["force_peak"].max() >= full["force_mean"].max() > 0
    assert full["largest"].item() == full["history"].values[0, 0, -64:].max()


def test_a_sweep_holds_runs_that_end_early_and_runs_that_do_not(coarse_rom):
    """A soft, thin coating is worn through at the crossing with eo(4), but not far below it."""
    case = scene(rounds=3, liner__thickness_m=8e-6, liner__law__K=0.01)
    result = at_speeds(case, coarse_rom, [rad_s(coarse_rom, 0.1), rad_s(coarse_rom, 0.31)])
    assert sorted(result.status.values) == ["liner-exhausted", "ok"]
    ended, ok = np.argsort(result.status.values)
    assert np.isnan(result.spectrum[ended]).all() and np.isfinite(result.spectrum[ok]).all()
    marched = int(np.ceil(result.rounds[ended]))
    assert np.isfinite(result.force_peak[ended, :marched]).all()
    assert np.isnan(result.force_peak[ended, marched:]).all() and marched < 3
    sampled = int(np.ceil(result.rounds[ended] * 64)) - 1  # no sample in the step that ends it
    assert np.isfinite(result.history[ended, :, :sampled]).all()
    assert np.isnan(result.history[ended, :, sampled:]).all() and sampled > 0
    assert result.end_xi.values[ended] in result.xi.values
    assert 0 <= result.end_theta[ended] < 2 * np.pi
    assert np.isnan(result.end_xi[ok]) and np.isnan(result.end_theta[ok])


def test_blocks_of_other_origin_are_not_merged(coarse_rom):
    """Another model, scene or version of the code: the message names what differs."""
    other = replace(coarse_rom, provenance=replace(coarse_rom.provenance, mesh="another"))
    case, speeds = scene(rounds=1), [rad_s(coarse_rom, 0.3)]
    block = at_speeds(case, coarse_rom, speeds)
    require_rom(block, coarse_rom)
    refused(
        ProvenanceError,
        require_rom,
        block,
        other,
        match=r"sweep\.nc: is of blade coarse, .*mesh another",
    )
    blocks = {
        "rom": at_speeds(case, other, speeds),
        "scene": at_speeds(scene(rounds=1, liner__strips=7), coarse_rom, speeds),
        "code": block.assign_attrs(code="older"),
    }
    for name, found in blocks.items():
        refused(
            ProvenanceError, merge, [block, found], match=f"differ in their {name}: delete them"
        )


def test_a_sweep_of_another_format_is_refused(coarse_rom, tmp_path):
    path = tmp_path / "out.nc"
    kept = at_speeds(scene(rounds=1), coarse_rom, [rad_s(coarse_rom, 0.3)])
    save(kept, path)
    assert load(path).attrs["format"] == FORMAT
    for found in (None, FORMAT - 1, FORMAT + 1):
        other = kept.assign_attrs(format=found)
        if found is None:
            del other.attrs["format"]
        save(other, path)
        error = refused(ProvenanceError, load, path)
        assert (error.file, error.value) == (str(path), found)


def test_another_file_is_no_sweep(coarse_rom, tmp_path):
    coarse_rom.save(tmp_path / "rom.nc")
    (tmp_path / "text.nc").write_text("status: ok")
    faults = {"rom": r"is no sweep \(", "text": "older version .* cut short", "missing": "no such"}
    for name, fault in faults.items():
        refused(ProvenanceError, load, tmp_path / f"{name}.nc", match=rf"{name}\.nc: .*{fault}")


def test_blocks_merge_into_the_sweep(coarse_rom, tmp_path):
    case = scene(rounds=1, speeds={"over_f1": {"first": 0.3, "last": 0.38, "count": 3}})
    whole = at_speeds(case, coarse_rom, case.speeds.omega(coarse_rom.f1))
    for block in range(2):
        speeds = block_speeds(case, coarse_rom, block, 2)
        save(at_speeds(case, coarse_rom, speeds), tmp_path / f"{block}.nc")
    merged = merge([load(tmp_path / f"{block}.nc") for block in (1, 0)])
    assert scene_of(merged) == case
    for name in ("speed_over_f1", "wear", "spectrum", "history", "force_peak", "status"):
        np.testing.assert_array_equal(merged[name].values, whole[name].values)
