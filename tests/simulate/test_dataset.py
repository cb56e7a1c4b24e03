"""``sweep.nc``: what a sweep holds, what it says of its origin, and how blocks merge."""

from dataclasses import asdict, replace
from datetime import UTC, datetime

import numpy as np
import pytest
from refused import refused
from runs import marched, swept
from scenes import blade_balance, scene

from geometry.base import ProvenanceError, code_hash
from simulate.contact.places import strip_places
from simulate.sweeps.dataset import (
    FORMAT,
    load,
    merge,
    origin,
    over_f1,
    require_rom,
    save,
    scene_of,
)
from simulate.sweeps.over_speeds import as_sweep, at_speeds

ROUND_TIP = {"contact__profile": {"edge_drop_um": 20}, "contact__tangential": True}

OF_CASING = "on_casing", "casing_kinetic", "casing_elastic", "casing_damping", "casing_before"


@pytest.fixture(scope="module")
def plain(coarse_rom):
    """A sweep of one round at one speed."""
    return swept(scene(rounds=1), coarse_rom)


def test_a_sweep_holds_the_ledger(coarse_rom, plain):
    ledger = marched(scene(rounds=1), coarse_rom).ledger
    assert plain["ledger"].dims == ("speed_over_f1", "energy") and plain["ledger"].units == "J"
    by_name = dict(zip(plain["energy"].values, plain["ledger"].values[0], strict=True))
    energies = asdict(ledger) | {"numerical": ledger.numerical}
    for name in ("friction", "heat", *OF_CASING, "force", "fed"):
        assert energies.pop(name) == 0  # kept where there is such a thing
    assert by_name == energies
    # every energy is said in the file
    assert all(f"{name}: " in plain["energy"].long_name for name in by_name)
    assert by_name["casing"] > by_name["plastic"] > 0
    # the blade's own balance, to round-off of its steps
    assert abs(blade_balance(ledger)) < 1e-9 * ledger.casing


def test_a_tangential_force_is_kept_where_it_is_modelled(coarse_rom, plain):
    """In proportion to the normal force, by the slope of the profile."""
    kept = swept(scene(rounds=1, **ROUND_TIP), coarse_rom)
    assert kept["force_tangential_mean"].dims == ("speed_over_f1", "round", "share")
    ratio = (kept["force_tangential_mean"] / kept["force_mean"]).values[0, 0]
    steepest = 4 * 2e-5 / 5e-3  # at the ends of the footprint
    assert kept["force_mean"].values[0, 0, 0] > 0
    assert 0 < abs(ratio[0]) <= steepest
    assert "force_tangential_mean" not in plain


def test_every_coordinate_is_explained_and_has_its_values(coarse_rom):
    record = {"spectrum_rounds": 1, "samples_per_round": 64, "states_rounds": 1}
    record |= {"history": {"chord": [0.25]}, "contact_force": True}
    case = scene(rounds=2, record=record)
    kept = swept(case, coarse_rom)
    for name, coordinate in kept.coords.items():
        assert coordinate.attrs.get("long_name"), name
        assert name == "energy" or coordinate.attrs["units"], name
    unlabelled = set(kept.dims) - set(kept.coords)
    assert unlabelled == {"strip", "strip_end", "dof"}  # xi and end name strips
    nu = case.liner.rods_per_round
    values = {
        "theta": 2 * np.pi * np.arange(nu) / nu,
        "engine_order": range(33),
        "history_time": np.arange(1, 129) / 64,
        "round": [1, 2],
        "share": (np.arange(8) + 0.5) / 8,
        "speed_over_f1": [0.3],
    }
    for name, expected in values.items():
        np.testing.assert_allclose(kept[name], expected, rtol=1e-15, atol=1e-15)
    assert kept.history.sel(chord=0.25).shape == (1, 128)
    for name in ("f1_Hz", "tip_radius_m", "gap_m", "blade", "source", "Conventions", "code"):
        assert kept.attrs[name], name
    assert kept.attrs["f1_Hz"] == coarse_rom.f1
    assert 0 < kept.attrs["tip_radius_m"] - coarse_rom.camber[:, 0].min() < 1e-3


def test_sweeps_are_compared_by_the_speed_over_f1(coarse_rom):
    """Also of blades whose f1(0) differ: the same speeds over f1(0) are other ones in rad/s."""
    stiffer = replace(coarse_rom, f1=1.1 * coarse_rom.f1)
    one, other = (
        swept(scene(rounds=1, speeds={"over_f1": over}), rom)
        for rom, over in ((coarse_rom, [0.3, 0.31]), (stiffer, [0.31, 0.32]))
    )
    difference = one["wear"] - other["wear"]
    assert difference["speed_over_f1"].values.tolist() == [0.31]
    assert np.isfinite(difference).all()


def test_runs_are_found_among_the_speeds_of_their_scene(coarse_rom):
    """To the last bit, by the function that makes the index."""
    case = scene(rounds=1, speeds={"over_f1": {"first": 0.061, "last": 0.39, "count": 151}})
    Omega = case.speeds.omega(coarse_rom.f1)
    kept = as_sweep(at_speeds(case, coarse_rom, Omega[1::50]))
    assert np.isin(kept["speed_over_f1"], over_f1(Omega, coarse_rom)).all()
    given = case.speeds.over_f1.values()[1::50]
    np.testing.assert_allclose(kept["speed_over_f1"], given, rtol=0, atol=1e-12)


def test_a_sweep_holds_its_scene_and_provenance(coarse_rom):
    case = scene(rounds=1, record__states_rounds=1, liner__strips=12)
    kept = swept(case, coarse_rom)
    assert scene_of(kept) == case and origin(kept) == coarse_rom.provenance
    assert (
        kept.attrs["code"] == code_hash("simulate.sweeps.over_speeds")
        and len(kept.attrs["code"]) == 16
    )
    assert kept.attrs["gap_m"] == pytest.approx(1.5e-4 * coarse_rom.span, rel=1e-14)
    places = strip_places(coarse_rom, case.liner, case.casing)
    held = {
        "xi": ("strip", places.xi),
        "end": ("strip_end", places.ends),
        "width": ("strip", places.width),
        "gap": ("strip", case.clearance.gaps(places.xi, coarse_rom.span)),
    }
    for name, (dim, values) in held.items():
        assert kept[name].dims == (dim,)
        np.testing.assert_array_equal(kept[name], values)
    assert kept["wear"].dims == ("speed_over_f1", "strip", "theta")
    assert kept["history"].dims == ("speed_over_f1", "chord", "history_time")
    assert kept["force_mean"].dims == kept["force_peak"].dims == ("speed_over_f1", "round", "share")
    assert kept.sizes["share"] == 8 and kept.sizes["chord"] == 2
    np.testing.assert_array_equal(kept["P"], coarse_rom.rows(places.xi))


def test_a_sweep_holds_what_the_scene_records_and_no_more(coarse_rom, plain):
    lean = {"samples_per_round": 64, "wear": False, "spectrum_rounds": 1}
    kept = swept(scene(rounds=1, record=lean), coarse_rom)
    assert "spectrum" in kept
    assert not {"wear", "history", "force_peak", "force_mean"} & set(kept)
    assert {"wear", "history", "force_peak", "force_mean"} <= set(plain)
    # recording more does not change the results
    np.testing.assert_array_equal(kept["spectrum"].values, plain["spectrum"].values)
    assert plain["force_peak"].max() >= plain["force_mean"].max() > 0
    assert plain["largest"].item() == plain["history"].values[0, 0, -64:].max()


def test_a_sweep_holds_runs_that_end_early_and_runs_that_do_not(coarse_rom):
    """A soft, thin coating is worn through at the crossing with eo(4), but not far below it."""
    thin = {"liner__thickness_mm": 0.008, "liner__law__K": 0.01}
    speeds = {"over_f1": [0.1, 0.31]}
    result = swept(scene(rounds=3, **thin, speeds=speeds, record__end=True), coarse_rom)
    assert result.status.values.tolist() == ["ok", "liner-exhausted"]
    ok, ended = (result.isel(speed_over_f1=k) for k in (0, 1))
    assert np.isnan(ended.spectrum).all() and np.isfinite(ok.spectrum).all()
    marched = int(np.ceil(ended.rounds))
    assert np.isfinite(ended.force_peak[:marched]).all()
    assert np.isnan(ended.force_peak[marched:]).all() and marched < 3
    sampled = int(np.ceil(ended.rounds * 64)) - 1  # no sample in the step that ends it
    assert np.isfinite(ended.history[:, :sampled]).all()
    assert np.isnan(ended.history[:, sampled:]).all() and sampled > 0
    assert ended.end_xi.item() in result.xi.values
    assert 0 <= ended.end_theta < 2 * np.pi
    assert np.isnan(ok.end_xi) and np.isnan(ok.end_theta)
    assert np.isfinite(ok.end_under).all() and np.isnan(ended.end_under).all()


def test_blocks_of_other_origin_are_not_merged(coarse_rom, plain):
    """Another model, scene or version of the code: the message names what differs."""
    other = replace(coarse_rom, provenance=replace(coarse_rom.provenance, mesh="another"))
    require_rom(plain, coarse_rom)
    assert "mesh another" in refused(ProvenanceError, require_rom, plain, other).text
    blocks = {
        "rom": swept(scene(rounds=1), other),
        "scene": swept(scene(rounds=1, liner__strips=9), coarse_rom),
        "code": plain.assign_attrs(code="older"),
    }
    for name, found in blocks.items():
        error = refused(ProvenanceError, merge, [plain, found])
        assert f"differ in their {name}: " in error.text


@pytest.mark.parametrize("found", [None, FORMAT - 1, FORMAT, FORMAT + 1])
def test_a_sweep_of_another_format_is_refused(plain, tmp_path, found):
    path = tmp_path / "out.nc"
    kept = plain.assign_attrs(format=found)
    if found is None:
        kept.attrs.pop("format")
    save(kept, path)
    if found == FORMAT:
        again = load(path).attrs
        assert again["format"] == FORMAT
        made = datetime.fromisoformat(again["date_created"])
        assert abs((datetime.now(UTC) - made).total_seconds()) < 60
    else:
        error = refused(ProvenanceError, load, path)
        assert (error.file, error.value) == (str(path), found)


def test_another_file_is_no_sweep(coarse_rom, tmp_path):
    coarse_rom.save(tmp_path / "rom.nc")
    (tmp_path / "text.nc").write_text("status: ok")
    for name in ("rom", "text", "missing"):
        path = tmp_path / f"{name}.nc"
        assert str(path) in str(refused(ProvenanceError, load, path))


def test_a_longer_status_of_another_block_is_kept_whole(coarse_rom, tmp_path):
    """Files give the width of their texts; that of the first block would cut those of others."""
    speeds, ends = coarse_rom.omega1 * np.array([0.3, 0.31]), ("ok", "inaccurate")
    for speed, status in zip(speeds, ends, strict=True):
        block = as_sweep(at_speeds(scene(rounds=1), coarse_rom, [speed]))
        named = block.assign(status=("speed_over_f1", [status]))
        save(named, tmp_path / f"{status}.nc")
    save(merge([load(tmp_path / f"{status}.nc") for status in ends]), tmp_path / "whole.nc")
    assert load(tmp_path / "whole.nc").status.values.tolist() == [*ends]


def test_blocks_merge_into_the_sweep(coarse_rom, tmp_path):
    """With what twins tell of each run."""
    speeds = {"over_f1": {"first": 0.3, "last": 0.38, "count": 3}}
    case = scene(rounds=1, verify__predictable=True, speeds=speeds)
    whole = swept(case, coarse_rom)
    for block in range(2):
        speeds = case.speeds.omega(coarse_rom.f1)[block::2]
        save(as_sweep(at_speeds(case, coarse_rom, speeds)), tmp_path / f"{block}.nc")
    merged = merge([load(tmp_path / f"{block}.nc") for block in (1, 0)])
    assert scene_of(merged) == case
    assert merged.departure.dims == ("speed_over_f1", "observable")
    assert merged.departure.attrs["units"] == "1"
    for name in set(whole.variables) - {"seconds"}:
        np.testing.assert_array_equal(merged[name].values, whole[name].values)
