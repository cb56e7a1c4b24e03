"""The animation of a run: the liner after every round, and a file that moves."""

import numpy as np
import pytest
from PIL import Image
from refused import refused
from scenes import scene

from geometry.base import UserError
from simulate.signals import leading_gap, leading_wear
from simulate.sweeps.over_speeds import as_sweep, at_speeds
from workflow.explore import rub

SPEED = 0.36


@pytest.fixture(scope="module")
def case():
    return scene(rounds=4, record={"samples_per_round": 64, "history": {"chord": [0.0625]}})


@pytest.fixture(scope="module")
def marched(case, coarse_rom):
    return rub.by_rounds(case, coarse_rom, SPEED)


def test_the_rounds_are_those_of_the_run_in_one_piece(case, coarse_rom, marched):
    whole = as_sweep(at_speeds(case, coarse_rom, [2 * np.pi * coarse_rom.f1 * SPEED]))
    gap = leading_gap(whole)
    np.testing.assert_array_equal(marched.u_r.ravel(), whole["history"].values[0, 0] / gap)
    np.testing.assert_allclose(marched.wear[-1], leading_wear(whole)[0] / gap, rtol=1e-6)  # single
    assert (np.diff(marched.wear, axis=0) >= 0).all() and marched.wear[0].max() == 0
    assert marched.wear[-1].max() > 0


def test_the_liner_wears_behind_the_tip(marched, coarse_rom):
    """After half of the second round: half of the circle, from where the tip was at its start."""
    nu = marched.wear.shape[1]
    assert marched.tip == coarse_rom.line(np.array([1 / 16]))[0, 1] != 0
    since = (np.arange(nu) / nu - marched.tip / (2 * np.pi)) % 1
    half, passed = marched.liner(1, 31), since < 0.5
    np.testing.assert_array_equal(half[passed], marched.wear[2][passed])
    np.testing.assert_array_equal(half[~passed], marched.wear[1][~passed])
    assert marched.turn(31) == pytest.approx(0.5 + marched.tip / (2 * np.pi))


def test_the_casing_distorts_over_its_ramp(case, marched):
    """As in the march: x^2 (3 - 2 x) of the ramp."""
    x = np.minimum((np.arange(4 * 64) + 1) / 64 / case.casing.ramp_rounds, 1)
    np.testing.assert_allclose(marched.share.ravel(), x**2 * (3 - 2 * x), rtol=1e-14)
    assert marched.share[0, 0] < 0.1 and marched.share[-1, -1] == 1


def test_a_scene_goes_on_from_what_it_starts_from(case, coarse_rom):
    """Three rounds and then two, as five in one piece; the first liner is the one left."""
    Omega = 2 * np.pi * coarse_rom.f1 * SPEED
    first = as_sweep(at_speeds(case.but(rounds=3, record={"end": True}), coarse_rom, [Omega]))
    on = case.but(rounds=2, start={"scene": "first"})
    one = rub.by_rounds(case.but(rounds=5), coarse_rom, SPEED)
    both = rub.by_rounds(on, coarse_rom, SPEED, start=first)
    for ours, expected in (
        (both.u_r, one.u_r),
        (both.share, one.share),
        (both.wear[1:], one.wear[1:]),
    ):
        np.testing.assert_array_equal(ours, expected[3:])
    np.testing.assert_allclose(both.wear[0], one.wear[3], atol=1e-12)


def test_speeds_in_rad_s_and_outputs_of_its_own_are_no_hindrance(case, coarse_rom, marched):
    Omega = 2 * np.pi * coarse_rom.f1 * 0.3
    other = case.but(
        speeds={"over_f1": None, "rad_s": [Omega]},
        verify={"predictable": True},
        record={"history": {"chord": [0.5]}, "spectrum_rounds": 4, "states_rounds": 2},
        peaks={"orders": [4], "within_over_f1": 0.01},
    )
    np.testing.assert_array_equal(rub.by_rounds(other, coarse_rom, SPEED).u_r, marched.u_r)


def test_a_run_that_ends_is_shown_up_to_there(case, coarse_rom, tmp_path):
    thin = case.but(
        liner={"thickness_mm": 0.0005}, casing={"harmonics": [{"order": 2, "amplitude_um": 40}]}
    )
    found = rub.by_rounds(thin, coarse_rom, SPEED)
    assert found.ended == "liner-exhausted" and 1 <= len(found.u_r) < 4
    assert np.isnan(found.u_r[-1, -1]) and np.isfinite(found.u_r[0, 0])
    rub.save(found, "mine", tmp_path / "rub.gif")
    assert rub.by_rounds(case.but(rounds=1), coarse_rom, SPEED).ended is None


def test_the_animation_moves(case, coarse_rom, tmp_path):
    rub.save(rub.by_rounds(case.but(rounds=1), coarse_rom, SPEED), "mine", tmp_path / "rub.gif")
    with Image.open(tmp_path / "rub.gif") as picture:
        assert picture.n_frames == rub.FRAMES
        frames = []
        for n in (0, 1, picture.n_frames - 1):
            picture.seek(n)
            frames.append(np.asarray(picture.convert("L")))
    assert (frames[0] != frames[1]).any() and (frames[1] != frames[2]).any()


def test_a_format_without_its_encoder_is_refused(marched, tmp_path, monkeypatch):
    monkeypatch.setattr(rub.writers, "list", lambda: ["pillow"])
    error = refused(UserError, rub.save, marched, "mine", tmp_path / "rub.mp4")
    assert error.file == str(tmp_path / "rub.mp4") and "needs ffmpeg" in error.text
    assert not list(tmp_path.iterdir())
