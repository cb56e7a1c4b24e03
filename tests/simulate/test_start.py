"""Runs that go on from what others left."""

from dataclasses import fields
from unittest.mock import ANY

import numpy as np
import pytest
from refused import refused
from runs import set_up
from scenes import SCHEMES, scene

from simulate.marching import FinalState, SceneError, march
from simulate.sweeps import dataset
from simulate.sweeps.dataset import final_state_of, of_final_state
from simulate.sweeps.sweep import sweep

LAWS = {
    "plastic": {"kind": "plastic", "E": 1.0, "K": 0.45, "sigma_Y": 1e-8, "unit_MPa": 2000},
    "elastic": {"kind": "elastic", "E": 1.0, "unit_MPa": 2000},
    "rigid": {"kind": "rigid"},
    "none": {"kind": "none"},
}
TANGENTIAL = {"tangential": True, "profile": {"tilt": 0.01, "edge_drop_um": 10}}
WHOLE, BEFORE = 6, 2  # rounds
FAILED = {"rounds": 1}  # a run before that is said to have diverged


def made(scheme="piecewise-exact", law="plastic", **changes):
    """A scene that records its end, without spectrum."""
    values = {"integrator": SCHEMES[scheme], "liner__law": LAWS[law], "record__end": True}
    return scene(**values | {"record__spectrum_rounds": None} | changes)


def go_on(case, rom, path, before=BEFORE):
    """The scene in one piece, and the two runs that it is cut into, the second from a file."""
    first = sweep(case.but(rounds=before), rom)
    dataset.save(first, path)
    then = case.but(rounds=WHOLE - before, start={"scene": "before"})
    return sweep(case.but(rounds=WHOLE), rom), first, sweep(then, rom, start=dataset.load(path))


GROWING = {"casing__ramp_rounds": 4.5, "contact": TANGENTIAL}
RUNS = [
    *((scheme, {"law": law}) for scheme in SCHEMES for law in LAWS),
    *((scheme, GROWING) for scheme in SCHEMES),  # with a tangential part
]
# central differences find no reactions of a rigid casing
RUNS.remove(("central-difference", {"law": "rigid"}))


@pytest.mark.parametrize(("scheme", "changes"), RUNS)
def test_a_run_goes_on_to_the_last_bit(scheme, changes, coarse_rom, tmp_path):
    before = 3 if changes is GROWING else BEFORE
    whole, first, then = go_on(made(scheme, **changes), coarse_rom, tmp_path / "first.nc", before)
    rubs = changes.get("law") != "none"
    assert (np.ptp(whole["history"].values[0, 0]) > 0) == rubs
    assert changes is not GROWING or first["wear"].values.max() < whole["wear"].values.max()
    for name, over_time in {"history": -1, "force_peak": 1, "force_mean": 1}.items():
        parts = [part[name].values for part in (first, then)]
        np.testing.assert_array_equal(np.concatenate(parts, axis=over_time), whole[name].values)
    assert whole["status"].values.tolist() == then["status"].values.tolist() == ["ok"]
    for name in ("wear", *(f"end_{field.name}" for field in fields(FinalState))):
        np.testing.assert_array_equal(then[name].values, whole[name].values, err_msg=name)


@pytest.mark.parametrize("scheme", SCHEMES)
def test_the_ledger_of_the_parts_is_that_of_the_whole(scheme, coarse_rom, tmp_path):
    whole, first, then = (
        dict(zip(run["energy"].values, run["ledger"].values[0], strict=True))
        for run in go_on(made(scheme), coarse_rom, tmp_path / "first.nc")
    )
    # the numerical energy is a small difference of large ones, whose round-off it has
    round_off = 1e-12 * whole["casing"]
    for name in ("casing", "work", "damping", "plastic", "released", "numerical"):
        parts = first[name] + then[name]
        assert parts == pytest.approx(whole[name], rel=1e-9, abs=round_off)
    for name in ("blade", "elastic"):
        assert then[f"{name}_before"] == first[name]
        assert then[name] == whole[name]
    balance = then["blade"] + then["damping"] - then["blade_before"]
    assert balance == pytest.approx(then["work"], rel=1e-9)


@pytest.mark.parametrize("scheme", SCHEMES)
def test_at_another_speed_the_blade_keeps_its_displacement_and_velocity(scheme, coarse_rom):
    case = made(scheme)
    setups = [set_up(case, coarse_rom, over_f1) for over_f1 in (0.3, 0.302)]
    left = march(case, setups[0]).final
    still = march(case.but(rounds=1, liner__law={"kind": "none"}), setups[1], left)
    # the first sample is a 64th of a round later: u goes on without a jump
    u = still.u_r[0, 0] - (setups[0].Phi_out @ left.x[0, : len(left.omega)])[0]
    assert abs(u) < 0.05 * np.ptp(still.u_r[:, 0])
    before = setups[0].Phi @ left.x[0, : len(left.omega)]
    modal = np.linalg.solve(setups[1].Phi, before)
    energy = ((setups[1].omega * modal) ** 2).sum() / 2
    assert still.ledger.blade_before == pytest.approx(energy, rel=0.5)


def test_speeds_in_turn_are_runs_that_go_on_one_from_the_other(coarse_rom):
    down = sweep(made(speeds={"over_f1": [0.31, 0.3], "in_turn": True}), coarse_rom)
    assert down["speed_over_f1"].values.tolist() == [0.3, 0.31]  # ascending, as in every sweep
    first = sweep(made(speeds={"over_f1": [0.31]}), coarse_rom)
    start = {"scene": "before", "speed_over_f1": 0.31}
    then = sweep(made(start=start), coarse_rom, start=first)
    for name in ("history", "wear"):
        parts = np.concatenate([then[name].values, first[name].values])
        np.testing.assert_array_equal(down[name].values, parts)


def test_a_run_on_a_worn_liner_starts_at_rest(coarse_rom):
    case = made()
    first = sweep(case, coarse_rom)
    start = {"scene": "before", "liner_only": True}
    again = sweep(case.but(start=start, liner__law__K=4.55), coarse_rom, start=first)
    assert (again["wear"] >= first["wear"]).all()
    assert again["ledger"].sel(energy="blade_before").item() == 0
    fresh = sweep(case.but(liner__law__K=4.55), coarse_rom)
    assert again["ledger"].sel(energy="plastic") < 0.5 * fresh["ledger"].sel(energy="plastic")


def test_a_twin_goes_on_from_the_same_end(coarse_rom):
    first = sweep(made(rounds=BEFORE), coarse_rom)
    then = made(rounds=2, start={"scene": "before"}, verify__predictable=True)
    runs = sweep(then, coarse_rom, start=first)
    assert runs.status.item() == "ok" and runs.departure.max() < 1e-8


def test_windows_of_different_lengths_lie_in_one_file(coarse_rom):
    one = sweep(made("central-difference"), coarse_rom).isel(speed_over_f1=0)
    padded = one.pad(end_rod=(0, 3))
    np.testing.assert_array_equal(final_state_of(padded).stored, final_state_of(one).stored)
    assert of_final_state(final_state_of(one)).keys() >= {"end_stored", "end_part", "end_rod"}


START = {"start": {"scene": "before"}}
WORN = {"start": {"scene": "before", "liner_only": True}}


@pytest.mark.parametrize(
    ("before", "then", "key", "value", "allowed"),
    [
        ({}, START | {"damping_ratio": 0.01}, "damping_ratio", ANY, 0.005),
        ({}, START | {"liner__rods_per_round": 600}, "liner", ANY, ANY),
        ({"record__end": False}, START, "start.scene", ANY, ANY),
        ({}, START | {"speeds": {"over_f1": [0.31]}}, "start.scene", ANY, ANY),
        ({}, WORN | {"liner__strips": 16}, "liner.strips", ANY, 8),
        (FAILED, START, "start.scene", "before", ANY),
        (None, START, "start.scene", "before", ANY),  # without its sweep
        ({}, {}, "start", ANY, ANY),
    ],
)
def test_what_cannot_go_on_is_refused(before, then, key, value, allowed, coarse_rom):
    first = None if before is None else sweep(made(**before), coarse_rom)
    if before is FAILED:
        first = first.assign(status=("speed_over_f1", ["diverged"]))
    error = refused(SceneError, sweep, made(**then), coarse_rom, start=first)
    assert (error.key, error.value, error.allowed) == (key, value, allowed)
