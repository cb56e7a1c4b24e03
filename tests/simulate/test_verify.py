"""The key `verify`: its forms, the keys of 0.3.0 in its place, and checks at the peaks."""

import numpy as np
import pytest
from refused import refused
from scenes import of_steps, scene

from geometry.base import SettingsError
from simulate.errors.companion import Fineness
from simulate.scene import Scene
from simulate.scene.verify import FormerKeyWarning, shown
from simulate.sweeps.peak_results import asked
from simulate.sweeps.sweep import sweep

EXACT = of_steps(1280)
WITHIN = {
    "accuracy": 0.02,
    "integrator": None,
    "liner__rods_per_round": None,
    "liner__strips": None,
}
FORMS = [  # verify, other keys: twins, halves, share
    (None, {}, (False, False, 0.1)),
    ({"share": 0}, {}, (False, False, 0)),
    ({"share": 0.3, "predictable": True}, {}, (True, False, 0.3)),
    ("peaks", {}, (False, False, 0)),
    ("every", {}, (True, True, 0)),
    ("every", WITHIN, (True, False, 0)),  # accuracy bounds the step itself: the twin is left
]


@pytest.mark.parametrize(("verify", "others", "parts"), FORMS)
def test_the_form_chooses_the_second_runs(verify, others, parts):
    others = {**others, "integrator": None} if "accuracy" in others else {"integrator": EXACT}
    case = scene(**others, verify=verify)
    assert (case.twins, case.halves, case.checked_share) == parts


@pytest.mark.parametrize(
    ("old", "now", "line"),
    [
        ({"check": 0.2}, {"share": 0.2}, "check: write `verify: {share: 0.2}`"),
        ({"check": 0}, {"share": 0}, "check: write `verify: {share: 0}`"),
        ({"twin": True}, {"predictable": True}, "twin: write `verify: {predictable: true}`"),
        (
            {"check": 0, "twin": False},
            {"share": 0, "predictable": False},
            "check, twin: write `verify: {share: 0, predictable: false}`",
        ),
        ({"halving": True, "twin": True}, "every", "twin, halving: write `verify: every`"),
    ],
)
def test_keys_of_before_are_read_with_one_line(old, now, line):
    with pytest.warns(FormerKeyWarning) as told:
        read = scene(**old, verify=None)
    assert [str(each.message) for each in told] == [f"{line} instead"]
    assert read == scene(verify=now)
    assert shown(now) in line


def test_they_change_what_a_base_says(tmp_path):
    base, of = tmp_path / "base.yaml", tmp_path / "of.yaml"
    text = scene().model_dump(mode="json", exclude_unset=True)
    base.write_text(str(text | {"verify": {"share": 0.2, "predictable": True}}))
    of.write_text("base: base\ntwin: false\n")
    with pytest.warns(FormerKeyWarning, match=r"of\.yaml: twin: write"):
        read = Scene.load(of)
    assert (read.verify.share, read.verify.predictable) == (0.2, False)


@pytest.mark.parametrize(
    ("changes", "key", "value"),
    [
        ({"verify": "all"}, "verify", "all"),
        ({"verify": 0.1}, "verify", 0.1),
        ({"verify": {"share": 2}}, "verify.share", 2),
        ({"verify": {"halving": True}}, "verify.halving", None),
        ({"verify": "every", "twin": True}, "twin", None),
        ({"verify": None, "halving": "often"}, "halving", "often"),
        ({"verify": "peaks", "start": {"scene": "before"}}, "verify", None),
        ({"verify": "peaks", "design": "rows.csv"}, "design", None),
    ],
)
def test_what_is_none_of_them_is_refused(changes, key, value):
    error = refused(SettingsError, scene, **changes)
    assert (error.key, error.value) == (key, value)


def test_at_the_peaks_alone_all_second_runs_are_made(coarse_rom):
    """There they find what they find at every speed; other speeds are as plain ones."""
    speeds = {"over_f1": [0.3, 0.325, 0.34]}
    record = {"samples_per_round": 64, "spectrum_rounds": 2}
    case = scene(integrator=EXACT, rounds=3, speeds=speeds, record=record)
    plain, at_peaks, every = (
        sweep(case.but(verify=verify), coarse_rom) for verify in ({"share": 0}, "peaks", "every")
    )
    (peak,) = {peak.index for peak in asked(plain, coarse_rom)}
    others = np.delete(np.arange(3), peak)
    for name in ("error", "departure"):
        assert np.isnan(at_peaks[name][others]).all()
        np.testing.assert_array_equal(at_peaks[name][peak], every[name][peak])
        assert np.isfinite(every[name]).all()
    np.testing.assert_array_equal(at_peaks["wear"][others], plain["wear"][others])
    assert at_peaks.attrs["scene"] != every.attrs["scene"]
    assert "half" in at_peaks["error"].attrs["long_name"] or "twice" in at_peaks["error"].long_name


def test_with_an_accuracy_every_adds_the_twin_alone():
    """The scene that is marched has the chosen step in place of the accuracy."""
    marched = Fineness(1280, 512, 8).scene(scene(**WITHIN, verify="every"))
    assert (marched.twins, marched.halves, marched.checked_share) == (True, False, 0)
