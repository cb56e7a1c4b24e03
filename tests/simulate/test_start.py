"""Runs that go on from what others left."""

from dataclasses import fields

import numpy as np
import pytest
from refused import refused
from scenes import scene

from simulate import dataset
from simulate.before import left_of, variables
from simulate.over_speeds import sweep
from simulate.run import march
from simulate.setup import SceneError, prepare
from simulate.start import Left

SCHEMES = {
    "central-difference": {"scheme": "central-difference", "fraction_of_limit": 0.8},
    "piecewise-exact": {"scheme": "piecewise-exact", "steps_per_round": 640},
}
LAWS = {
    "plastic": {"kind": "plastic", "E": 1.0, "K": 0.45, "sigma_Y": 1e-8, "unit_Pa": 2e9},
    "elastic": {"kind": "elastic", "E": 1.0, "unit_Pa": 2e9},
    "rigid": {"kind": "rigid"},
    "none": {"kind": "none"},
}
TANGENTIAL = {"tangential": True, "profile": {"tilt": 0.01, "edge_drop_m": 1e-5}}
WHOLE, BEFORE = 6, 2  # rounds


def made(scheme="piecewise-exact", law="plastic", **changes):
    """A scene that records its end, without spectrum."""
    values = {"integrator": SCHEMES[scheme], "liner__law": LAWS[law], "record__end": True}
    return scene(**values | {"record__spectrum_rounds": None} | changes)


def go_on(case, rom, before=BEFORE):
    """The scene in one piece, and the two runs that it is cut into."""
    first = sweep(case.but(rounds=before), rom)
    then = case.but(rounds=WHOLE - before, start={"scene": "before"})
    return sweep(case.but(rounds=WHOLE), rom), first, sweep(then, rom, start=first)


def assert_is_the_same(whole, first, then):
    for name, over_time in {"history": -1, "force_peak": 1, "force_mean": 1}.items():
        parts = [part[name].values for part in (first, then)]
        np.testing.assert_array_equal(np.concatenate(parts, axis=over_time), whole[name].values)
    np.testing.assert_array_equal(then["wear"].values, whole["wear"].values)
    assert whole["status"].values.tolist() == then["status"].values.tolist() == ["ok"]
    for field in fields(Left):
        name = f"end_{field.name}"
        np.testing.assert_array_equal(then[name].values, whole[name].values, err_msg=name)


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("scheme", SCHEMES)
def test_a_run_goes_on_to_the_last_bit(scheme, law, coarse_rom):
    if (scheme, law) == ("central-difference", "rigid"):
        pytest.skip("central differences find no reactions of a rigid casing")
    whole, first, then = go_on(made(scheme, law), coarse_rom)
    assert np.ptp(whole["history"].values[0, 0]) > 0 or law == "none"
    assert_is_the_same(whole, first, then)


@pytest.mark.parametrize("scheme", SCHEMES)
def test_also_where_the_casing_still_grows_and_the_force_has_a_tangential_part(scheme, coarse_rom):
    case = made(scheme, casing__ramp_rounds=4.5, contact=TANGENTIAL)
    whole, first, then = go_on(case, coarse_rom, before=3)
    assert first["wear"].values.max() < whole["wear"].values.max()
    assert_is_the_same(whole, first, then)


@pytest.mark.parametrize("scheme", SCHEMES)
def test_also_from_a_file(scheme, coarse_rom, tmp_path):
    case = made(scheme)
    first = sweep(case.but(rounds=BEFORE), coarse_rom)
    dataset.save(first, tmp_path / "first.nc")
    then = case.but(rounds=WHOLE - BEFORE, start={"scene": "before"})
    found = sweep(then, coarse_rom, start=dataset.load(tmp_path / "first.nc"))
    assert_is_the_same(sweep(case.but(rounds=WHOLE), coarse_rom), first, found)


@pytest.mark.parametrize("scheme", SCHEMES)
def test_the_ledger_of_the_parts_is_that_of_the_whole(scheme, coarse_rom):
    whole, first, then = (
        run["ledger"].sel(speed=run["speed"][0]) for run in go_on(made(scheme), coarse_rom)
    )
    # the numerical energy is a small difference of large ones, whose round-off it has
    round_off = 1e-12 * float(whole.sel(energy="casing"))
    for name in ("casing", "work", "damping", "plastic", "released", "numerical"):
        parts = float(first.sel(energy=name) + then.sel(energy=name))
        assert parts == pytest.approx(float(whole.sel(energy=name)), rel=1e-9, abs=round_off)
    for name in ("blade", "elastic"):
        assert float(then.sel(energy=f"{name}_before")) == float(first.sel(energy=name))
        assert float(then.sel(energy=name)) == float(whole.sel(energy=name))
    balance = then.sel(energy=["blade", "damping"]).sum() - then.sel(energy="blade_before")
    assert float(balance) == pytest.approx(float(then.sel(energy="work")), rel=1e-9)


@pytest.mark.parametrize("scheme", SCHEMES)
def test_at_another_speed_the_blade_keeps_its_displacement_and_velocity(scheme, coarse_rom):
    case = made(scheme)
    setups = [prepare(case, coarse_rom, x * 2 * np.pi * coarse_rom.f1) for x in (0.3, 0.302)]
    left = march(case, setups[0]).left
    still = march(case.but(rounds=1, liner__law={"kind": "none"}), setups[1], left)
    # the first sample is a 64th of a round later: u goes on without a jump
    u = still.u_r[0, 0] - (setups[0].Phi_out @ left.x[0, : len(left.omega)])[0]
    assert abs(u) < 0.05 * np.ptp(still.u_r[:, 0])
    before = setups[0].Phi @ left.x[0, : len(left.omega)]
    modal = np.linalg.solve(setups[1].Phi, before)
    energy = ((setups[1].omega * modal) ** 2).sum() / 2
    assert still.ledger.blade_before == pytest.approx(energy, rel=0.5)


def test_speeds_in_turn_are_runs_that_go_on_one_from_the_other(coarse_rom):
    case = made(speeds={"over_f1": [0.31, 0.3], "in_turn": True})
    down = sweep(case, coarse_rom)
    assert down["speed_over_f1"].values.tolist() == [0.3, 0.31]  # ascending, as in every sweep
    first = sweep(made(speeds={"over_f1": [0.31]}), coarse_rom)
    start = {"scene": "before", "speed_over_f1": 0.31}
    then = sweep(made(start=start), coarse_rom, start=first)
    for name in ("history", "wear"):
        np.testing.assert_array_equal(down[name].values[1], first[name].values[0])
        np.testing.assert_array_equal(down[name].values[0], then[name].values[0])


def test_a_run_on_a_worn_liner_starts_at_rest(coarse_rom):
    case = made()
    first = sweep(case, coarse_rom)
    start = {"scene": "before", "liner_only": True}
    again = sweep(case.but(start=start, liner__law__K=4.55), coarse_rom, start=first)
    assert (again["wear"] >= first["wear"]).all()
    assert again["ledger"].sel(energy="blade_before").item() == 0
    fresh = sweep(case.but(liner__law__K=4.55), coarse_rom)
    assert again["ledger"].sel(energy="plastic") < 0.5 * fresh["ledger"].sel(energy="plastic")


def test_windows_of_different_lengths_lie_in_one_file(coarse_rom):
    runs = sweep(made("central-difference", speeds={"over_f1": [0.2, 0.3]}), coarse_rom)
    one = runs.isel(speed_over_f1=0)
    longer = {"end_rod": (0, 3)}
    padded = one.pad(longer)
    np.testing.assert_array_equal(left_of(padded).stored, left_of(one).stored)
    assert variables(left_of(one)).keys() >= {"end_stored", "end_part", "end_rod"}


@pytest.mark.parametrize(
    ("before", "then", "key", "allowed"),
    [
        (
            {},
            {"damping_ratio": 0.01},
            "damping_ratio",
            0.005,
        ),
        ({}, {"liner__rods_per_round": 600}, "liner", None),
        ({"record__end": False}, {}, "start.scene", None),
        ({}, {"speeds": {"over_f1": [0.31]}}, "start.scene", None),
        (
            {},
            {"start": {"scene": "before", "liner_only": True}, "liner__strips": 4},
            "liner.strips",
            8,
        ),
    ],
)
def test_what_cannot_go_on_is_refused(before, then, key, allowed, coarse_rom):
    first = sweep(made(**before), coarse_rom)
    error = refused(
        SceneError,
        sweep,
        made(**{"start": {"scene": "before"}, **then}),
        coarse_rom,
        start=first,
    )
    assert error.key == key
    assert allowed in (None, error.allowed)


def test_a_start_without_its_sweep_and_a_sweep_without_a_start_are_refused(coarse_rom):
    error = refused(SceneError, sweep, made(start={"scene": "before"}), coarse_rom)
    assert (error.key, error.value) == ("start.scene", "before")
    assert (
        refused(SceneError, sweep, made(), coarse_rom, start=sweep(made(rounds=1), coarse_rom)).key
        == "start"
    )


def test_nothing_goes_on_from_a_run_that_failed(coarse_rom):
    first = sweep(made(rounds=1), coarse_rom)
    failed = first.assign(status=("speed_over_f1", ["diverged"]))
    error = refused(SceneError, sweep, made(start={"scene": "before"}), coarse_rom, start=failed)
    assert (error.key, error.value) == ("start.scene", "before")
