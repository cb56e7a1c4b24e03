import numpy as np
import pytest
from scenes import scene

from geometry.settings import SettingsError


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"liner__modulus": 1.0}, ["liner.modulus", "unknown key", "unit_Pa"]),
        ({"liner__thickness_mm": 5}, ["liner.thickness_mm", "did you mean 'thickness_m'"]),
        ({"clearance__leading_edge_mm": 5}, ["clearance.leading_edge_mm", "leading_edge_m"]),
        ({"clearance__leading_edge_m": 1e-5}, ["clearance", "exactly one of leading_edge_m"]),
        ({"liner__E": -1}, ["liner.E", "-1", "greater than 0"]),
        ({"liner__K": -0.1}, ["liner.K", "-0.1", "greater than or equal to 0"]),
        (
            {"step__fraction_of_limit": 1.2},
            ["step.fraction_of_limit", "1.2", "less than or equal to 1"],
        ),
        ({"step__per_round": 4000}, ["step", "exactly one of per_round, fraction_of_limit"]),
        ({"speeds__rad_s": [100.0]}, ["speeds", "exactly one of over_f1, rad_s"]),
        ({"speeds__over_f1": [-3]}, ["speeds.over_f1.0: -3", "greater than 0"]),
        (
            {"speeds": {"over_f1": {"first": 0.1, "last": 0.3, "cuont": 3}}},
            ["speeds.over_f1.cuont: unknown key; did you mean 'count'?"],
        ),
        ({"speeds__over_f1": []}, ["speeds.over_f1", "at least 1"]),
        ({"liner__thickness_m": 1e-300}, ["liner.thickness_m", "greater than or equal to"]),
        ({"rounds": 0}, ["rounds", "0", "greater than or equal to 1"]),
        ({"record__spectrum_rounds": 3}, ["spectrum_rounds is 3", "allowed up to rounds = 2"]),
        ({"record__states_rounds": 3}, ["states_rounds is 3", "allowed up to rounds = 2"]),
        ({"record__states_rounds": 0}, ["record.states_rounds", "greater than or equal to 1"]),
        ({"damping_ratio": 1.0}, ["damping_ratio", "1.0", "less than 1"]),
        ({"damping_ratio": None}, ["damping_ratio", "required"]),
    ],
)
def test_a_fault_is_one_line_with_file_key_and_allowed_range(changes, words):
    with pytest.raises(SettingsError) as caught:
        scene(**changes)
    message = str(caught.value)
    assert message.startswith("scene.yaml: ")
    assert "\n" not in message
    assert all(word in message for word in words), message


def test_speeds_in_both_units_are_the_same_speeds():
    f1 = 250.0
    ratio = scene(speeds={"over_f1": {"first": 0.1, "last": 0.4, "count": 4}}).speeds.omega(f1)
    rad_s = scene(speeds={"rad_s": list(ratio)}).speeds.omega(f1)
    np.testing.assert_allclose(ratio, 2 * np.pi * 250 * np.array([0.1, 0.2, 0.3, 0.4]), rtol=1e-15)
    np.testing.assert_array_equal(ratio, rad_s)


def test_clearances_in_both_units_are_linear_along_the_chord():
    over_span = scene().clearance.gaps(8, 0.14)
    in_m = scene(
        clearance={"leading_edge_m": 1.5e-4 * 0.14, "trailing_edge_m": 4.3e-4 * 0.14}
    ).clearance.gaps(8, 0.14)
    np.testing.assert_allclose(over_span, in_m, rtol=1e-14)
    np.testing.assert_allclose(over_span[[0, -1]], [1.5e-4 * 0.14, 4.3e-4 * 0.14], rtol=1e-14)
    np.testing.assert_allclose(np.diff(over_span, 2), 0, atol=1e-18)


def test_casing_harmonics_add_up_inward_in_both_units():
    theta, gap = np.linspace(0, 2 * np.pi, 9), 2e-5
    casing = scene(
        casing={
            "ramp_rounds": 1,
            "harmonics": [
                {"order": 2, "amplitude_gaps": 3, "phase_deg": 90},
                {"order": 5, "amplitude_m": 1e-5},
            ],
        }
    ).casing
    exact = -3 * gap * np.sin(2 * theta) + 1e-5 * np.cos(5 * theta)
    np.testing.assert_allclose(casing.inward(theta, gap), exact, atol=1e-18)
