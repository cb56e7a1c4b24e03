"""Units of what users write: one for each quantity; keys of 0.3.0 give the same bits."""

import re
from decimal import Decimal

import numpy as np
import pytest
import yaml
from refused import refused

from geometry.base import FORMER, RPM, SettingsError, check_settings, in_rpm, merged, shifted
from geometry.blade import Blade
from geometry.elsewhere import MatricesElsewhere
from simulate.scene import Scene
from simulate.scene.casing import Casing, Clearance, Harmonic
from simulate.scene.laws.plastic import Plastic
from simulate.scene.tables import Table, Thermal
from workflow.many.columns import placed, value_at

# of lengths, speeds, stresses, angles, frequencies, masses
UNITS = {"mm", "um", "rpm", "MPa", "GPa", "deg", "Hz", "kg"}
OTHERS = {"m", "cm", "rad_s", "s", "Pa", "kPa", "hz", "kHz", "g", "rad"} | {*FORMER}


@pytest.mark.parametrize("model", [Blade, MatricesElsewhere, Scene])
def test_every_key_with_a_unit_has_that_of_its_quantity(model):
    keys = re.findall(r"'(\w+)': {", str(model.model_json_schema()))
    ends = [key.rpartition("_")[2] for key in keys]
    assert UNITS & {*ends} and not OTHERS & {*ends, *keys}


def test_speeds_in_rpm_are_those_in_rad_s():
    """To the bit where a number in rpm gives it, as of blade `paper` and scene `orbit`."""
    for rad_s in (563.0, 650.0, 633.0, 580.0, 150.0):
        assert in_rpm(rad_s) / RPM == rad_s
    assert in_rpm(1800.0) / RPM == pytest.approx(1800.0, rel=2e-16)


def test_a_length_in_another_unit_is_the_same_to_the_bit():
    given = np.random.default_rng(3).uniform(1e-6, 1e-3, 2000).round(9).tolist()
    assert [shifted(shifted(value, 6), -6) for value in given] == given


@pytest.mark.parametrize(
    ("model", "former", "now"),
    [
        (Clearance, {"leading_edge_m": 8e-5, "trailing_edge_m": 12e-5}, [80.0, 120.0]),
        (Harmonic, {"order": 2, "amplitude_m": 1.33e-5, "speed_rad_s": 150}, [13.3, in_rpm(150)]),
        (Table, {"theta_deg": [0, 90, 180], "depth_m": [0, 4e-5, 0]}, [[0.0, 40.0, 0.0]]),
        (Thermal, {"speed_rad_s": [0, 150], "growth_m": [0, 1e-5]},
         [(0.0, in_rpm(150)), (0.0, 10.0)]),
        (Plastic, {"kind": "plastic", "E": 1, "K": 1, "sigma_Y": 0, "unit_Pa": 3.54e8}, [354.0]),
    ],
)  # fmt: skip
def test_keys_of_before_are_read(model, former, now):
    read = check_settings(model, former, "")
    keys = [FORMER[key].now for key in former if key in FORMER]
    assert [getattr(read, key) for key in keys] == now
    again = check_settings(model, read.model_dump(exclude_none=True), "")
    assert again == read
    for key, value in ((key, value) for key, value in former.items() if key in FORMER):
        assert value_at(read, key) == (pytest.approx(value) if "rad_s" in key else value) or (
            np.array_equal(value_at(read, key), value)
        )


def test_a_key_in_both_units_is_refused():
    both = {"order": 2, "amplitude_m": 1e-5, "amplitude_um": 10}
    error = refused(SettingsError, check_settings, Harmonic, both, "")
    assert "amplitude_m: is given as amplitude_um, too" in str(error)
    for text in ("4e-5", np.float64(4e-5), Decimal("4e-5")):
        assert check_settings(Harmonic, {"order": 2, "amplitude_m": text}, "").size(1.0) == 4e-5
    for odd in ("x", True, 10**400):
        refused(SettingsError, check_settings, Harmonic, {"order": 2, "amplitude_m": odd}, "")
    for none in ({"amplitude_m": None}, {"amplitude_um": None, "amplitude_m": 1e-5}):
        assert check_settings(Harmonic, both | none, "").size(1.0) == 1e-5


def test_what_is_written_later_counts_in_either_unit():
    """A scene of 0.3.0 on one of ours, one of ours on one of 0.3.0, a change by its path."""
    ours, before = {"liner": {"thickness_mm": 5}}, {"liner": {"thickness_m": 0.01, "strips": 8}}
    assert merged(ours, before) == before
    assert merged(before, ours) == {"liner": {"thickness_mm": 5, "strips": 8}}
    assert placed(ours, {"liner.thickness_m": "0.02"}) == {"liner": {"thickness_mm": 20}}
    wave = {"casing": {"harmonics": [{"order": 1, "amplitude_um": 10, "speed_rpm": 60}]}}
    slower = placed(wave, {"casing.harmonics[0].speed_rad_s": np.pi})
    assert slower["casing"]["harmonics"][0] == {"order": 1, "amplitude_um": 10, "speed_rpm": 30}
    turns = {"speeds": {"rpm": {"first": 600, "last": 900, "count": 3}}}
    faster = placed(turns, {"speeds.rad_s.last": 100, "speeds.rad_s.count": 5})["speeds"]["rpm"]
    assert faster == {"first": 600, "last": pytest.approx(100 * RPM), "count": 5}
    of_range = [value_at(turns, f"speeds.rad_s.{name}") for name in ("first", "count")]
    assert of_range == [pytest.approx(20 * np.pi), 3]
    both = merged(turns, {"speeds": {"rad_s": {"count": 9}}})["speeds"]["rad_s"]
    assert both["count"] == 9 and both["last"] == pytest.approx(30 * np.pi)
    own = {"liner": {"law": {"kind": "mine:Law", "stress_Pa": 3.0}}}
    assert placed(own, {"liner.law.stress_Pa": 2}) == {
        "liner": {"law": {"kind": "mine:Law", "stress_Pa": 2}}
    }
    casing = Casing(harmonics=[{"order": 2, "amplitude_um": 10}], ramp_rounds=0)
    other = casing.but(harmonics=[{"order": 2, "amplitude_m": 3e-5}])
    assert other.harmonics[0].size(1.0) == 3e-5


def test_a_scene_and_a_blade_of_before_are_those_of_now(tmp_path):
    scene = """
blade: reference
speeds: {rad_s: {first: 300.0, last: 600.0, count: 3}}
rounds: 4
damping_ratio: 0.001
integrator: {scheme: piecewise-exact, steps_per_round: 2048}
clearance: {leading_edge_m: 5.0e-5, trailing_edge_m: 5.0e-5}
casing: {harmonics: [{order: 2, amplitude_m: 4.0e-5}], ramp_rounds: 1}
liner:
  law: {kind: plastic, E: 1.0, K: 1.0, sigma_Y: 1.0e-3, unit_Pa: 1.0e+9}
  thickness_m: 5.0e-3
  footprint_m: 5.0e-3
  rods_per_round: 512
contact: {profile: {edge_drop_m: 5.0e-6}}
"""
    (tmp_path / "before.yaml").write_text(scene)
    read = Scene.load(tmp_path / "before.yaml")
    # those between the ends of a range are rounded to twelve digits, now in rpm
    np.testing.assert_allclose(read.speeds.omega(f1=1.0), [300, 450, 600], rtol=1e-11)
    assert (read.liner.thickness_m, read.liner.footprint_m) == (5e-3, 5e-3)
    assert read.liner.law.parameters == (1e9, 1e9, 1e6)
    assert read.contact.profile.edge_drop_m == 5e-6
    assert read.clearance.gaps(0.5, span=1.0) == 5e-5
    written = yaml.safe_dump(read.model_dump(mode="json", exclude_none=True))
    (tmp_path / "now.yaml").write_text(written)
    assert Scene.load(tmp_path / "now.yaml") == read and not set(FORMER) & set(written.split(": "))
