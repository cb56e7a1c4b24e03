"""The animation of a run: the liner after every round, and a file that moves."""

import numpy as np
import pytest
from PIL import Image
from scenes import scene

from geometry.errors import UserError
from simulate.observables import leading_gap, leading_wear
from simulate.over_speeds import at_speeds
from workflow.explore import rub

SPEED = 0.36


@pytest.fixture(scope="module")
def case():
    return scene(rounds=4, record={"samples_per_round": 64, "history": {"chord": [0.0625]}})


@pytest.fixture(scope="module")
def marched(case, coarse_rom):
    return rub.march(case, coarse_rom, SPEED)


def test_the_rounds_are_those_of_the_run_in_one_piece(case, coarse_rom, marched):
    whole = at_speeds(case, coarse_rom, [2 * np.pi * coarse_rom.f1 * SPEED])
    gap = leading_gap(whole)
    np.testing.assert_array_equal(marched.u_r.ravel(), whole["history"].values[0, 0] / gap)
    np.testing.assert_array_equal(marched.wear[-1], leading_wear(whole)[0] / gap)
    assert (np.diff(marched.wear, axis=0) >= 0).all() and marched.wear[0].max() == 0
    assert marched.wear[-1].max() > 0


def test_the_liner_wears_behind_the_tip(marched):
    nu = marched.wear.shape[1]
    half = marched.liner(1, 31)  # after half of the second round
    np.testing.assert_array_equal(half[: nu // 2], marched.wear[2][: nu // 2])
    np.testing.assert_array_equal(half[nu // 2 + 1 :], marched.wear[1][nu // 2 + 1 :])


def test_the_casing_distorts_over_its_ramp(case, marched):
    """As in the march: x^2 (3 - 2 x) of the ramp."""
    x = np.minimum((np.arange(4 * 64) + 1) / 64 / case.casing.ramp_rounds, 1)
    np.testing.assert_allclose(marched.share.ravel(), x**2 * (3 - 2 * x), rtol=1e-14)
    assert marched.share[0, 0] < 0.1 and marched.share[-1, -1] == 1


def test_the_animation_moves(marched, tmp_path):
    rub.save(marched, tmp_path / "rub.gif")
    with Image.open(tmp_path / "rub.gif") as picture:
        assert picture.n_frames == 4 * rub.FRAMES
        frames = []
        for n in (0, 1, picture.n_frames - 1):
            picture.seek(n)
            frames.append(np.asarray(picture.convert("L")))
    assert (frames[0] != frames[1]).any() and (frames[1] != frames[2]).any()


def test_a_format_without_its_encoder_is_refused(marched, tmp_path, monkeypatch):
    monkeypatch.setattr(rub.writers, "list", lambda: ["pillow"])
    with pytest.raises(
        UserError, match=r"rub\.mp4: needs ffmpeg on PATH: install it, or ask for a \.gif"
    ):
        rub.save(marched, tmp_path / "rub.mp4")
    assert not list(tmp_path.iterdir())
