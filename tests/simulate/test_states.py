"""Recorded states: the same motion as the history, and the state of largest displacement."""

import numpy as np
import pytest
import xarray as xr
from runs import swept
from scenes import over_strips, scene

from simulate.marching import largest_state
from simulate.marching.states import INSTANTS, MostStrained

RECORD = {
    "samples_per_round": 64,
    "wear": False,
    "contact_force": True,
    "history": {"chord": over_strips()},
}


OVER_F1 = [0.3, 0.345]


def states_of(rom, **changes):
    """Three rounds at two speeds."""
    return swept(scene(**{"rounds": 3, "speeds": {"over_f1": OVER_F1}} | changes), rom)


@pytest.fixture(scope="module")
def recorded(coarse_rom):
    """Of which the last two rounds are kept."""
    return states_of(coarse_rom, record=RECORD | {"states_rounds": 2})


def test_displacements_over_the_strips_are_the_history_there(recorded, coarse_rom):
    states = recorded["states"]
    assert states.dims == ("speed_over_f1", "time", "dof") and states.dtype == np.float64
    assert states.shape == (2, 2 * 64, coarse_rom.n)
    # in rounds, at the end of each sample
    np.testing.assert_allclose(recorded["time"], 1 + np.arange(1, 129) / 64, rtol=1e-15)
    assert recorded["P"].dims == ("strip", "dof")
    radial = states.values @ recorded["P"].values.T
    history = recorded["history"].values[:, :, 64:].transpose(0, 2, 1)
    # two sums over the same modes in another order
    np.testing.assert_allclose(radial, history, rtol=0, atol=1e-13 * abs(history).max())
    assert abs(history).max() > 1e-6


def test_recording_states_changes_nothing_else(recorded, coarse_rom):
    plain = states_of(coarse_rom, record=RECORD)
    assert not {"states", "time", "P"} & set(plain.variables)
    np.testing.assert_array_equal(plain["history"].values, recorded["history"].values)


def test_states_of_a_run_that_ends_early_are_missing(coarse_rom):
    ended = states_of(
        coarse_rom,
        liner__thickness_mm=0.0005,
        casing__harmonics=[{"order": 2, "amplitude_um": 40}],
        speeds={"over_f1": OVER_F1[:1]},
        record=RECORD | {"states_rounds": 1},
    )
    assert list(ended.status.values) == ["liner-exhausted"] and np.isnan(ended["states"]).all()


def made_up():
    """Two speeds, three times, two patches of two DoFs each, gaps of 0.6 and 0.1, one mode."""
    states = np.full((2, 3, 5), 0.1)
    states[1, 2, 2] = 0.7  # of strip 2: 0.6 beyond its gap
    states[0, 2, 0] = 0.8  # 0.2 beyond
    states[1, 0, 2] = -0.9  # inward
    states[0, 1, 1] = 5.0  # tangential
    states[0, 1, 4] = 9.0  # a mode
    return xr.Dataset(
        {
            "states": (("speed_over_f1", "time", "dof"), states),
            "status": ("speed_over_f1", ["ok", "ok"]),
        },
        coords={
            "speed": ("speed_over_f1", [300.0, 400.0]),
            "speed_over_f1": ("speed_over_f1", [0.3, 0.4]),
            "time": [8.5, 9.0, 9.5],
            "xi": ("strip", [0.0, 1.0]),
            "gap": ("strip", [0.6, 0.1]),
            "P": (("strip", "dof"), np.eye(5)[[0, 2]]),
        },
    )


def test_largest_state_is_the_farthest_beyond_its_gap():
    """Of the runs that did not fail."""
    Omega, u_r, u = largest_state(made_up())
    assert (Omega, u_r) == (400.0, 0.7)
    np.testing.assert_array_equal(u, [0.1, 0.1, 0.7, 0.1, 0.1])
    failed = made_up().assign(status=("speed_over_f1", ["ok", "unstable"]))
    assert largest_state(failed)[0] == 300.0


def test_states_for_pictures_are_some_of_all(coarse_rom):
    """Eight in a period of mode 2 at least, at each speed as few as that takes."""
    record = {"samples_per_round": 512, "states_rounds": 1, "motion": 2}
    runs = states_of(coarse_rom, record=record)
    for speed, Omega in enumerate(runs["speed"].values):
        motion = runs["motion"][speed].dropna("motion_time")
        period = 2 * np.pi / coarse_rom.modes(Omega)[0][1]
        step = 2 * np.pi / Omega * float(motion.motion_time.diff("motion_time")[0])
        assert period / 16 < step <= period / 8
        assert motion.motion_time[-1] == 3.0
        same = runs["states"][speed].sel(time=motion.motion_time.values)
        np.testing.assert_array_equal(motion.values, same.values.astype(np.float32))


def test_the_range_for_pictures_is_that_of_the_history(coarse_rom):
    record = {"samples_per_round": 64, "motion": 1, "history": {"chord": [0.0625]}}
    runs = states_of(coarse_rom, record=record)
    history = runs["history"].values[:, 0].reshape(2, 3 * 16, 4).astype(np.float32)
    for bound, values in {"least": history.min(axis=-1), "largest": history.max(axis=-1)}.items():
        np.testing.assert_array_equal(runs["envelope"].sel(bound=bound), values)


def test_pictures_change_no_number_and_are_no_observable(coarse_rom):
    """With a twin: the same status and differences with and without."""
    plain, shown = (
        states_of(coarse_rom, verify__predictable=True, **more)
        for more in ({}, {"record__motion": 3})
    )
    assert {"motion", "envelope", "strained", "strained_round"} == set(shown) - set(plain)
    for name in set(plain) - {"seconds"}:
        np.testing.assert_array_equal(plain[name].values, shown[name].values)
    assert "states" not in shown["observable"]


def test_the_revolutions_kept_are_the_largest_by_each_measure():
    """Two of each: most energy, most of mode 1, most of both at different instants."""
    omega, phase = np.array([1.0, 10.0]), 2 * np.pi * np.arange(64) / 64
    amplitudes = {1: (3, 0), 2: (1, 0), 3: (0, 0.5), 4: (2.8, 0.35), 5: (0.1, 0.42), 6: (2.9, 0)}
    kept = MostStrained.room(omega, 1, 64)
    for number, (one, two) in amplitudes.items():
        q = np.stack([one * np.cos(phase), two * np.sin(2 * phase), 0 * phase], axis=1)
        kept.add(number, q)
    energy, mode_1, ranges = (set(numbers) for numbers in kept.numbers.tolist())
    assert mode_1 == {1, 6} and energy == {3, 5} and ranges == {3, 4}
    at = np.argwhere(kept.numbers == 4)[0]
    np.testing.assert_allclose(np.ptp(kept.q[tuple(at)], axis=0), [5.6, 0.7], rtol=0.02)


def test_instants_near_the_mean_are_left_out():
    """Of 1024 states those farthest from the mean are kept, in order; few are all kept."""
    phase = 2 * np.pi * np.arange(2048) / 2048
    kept = MostStrained.room(np.array([1.0]), 2, 2048)
    kept.add(1, 5.0 + np.sin(phase)[:, None])
    q = kept.q[0, 0, :, 0] - 5.0
    assert len(q) == INSTANTS and abs(q).min() > 0.9 and np.ptp(q) > 1.9999
    assert (np.diff(np.flatnonzero(np.isin(5.0 + np.sin(phase), kept.q[0, 0]))) > 0).all()
    few = MostStrained.room(np.array([1.0]), 32, 65)
    few.add(1, phase[:65, None])
    assert few.q.shape == (3, 2, 65, 1) and not np.isnan(few.q[:, 0]).any()
