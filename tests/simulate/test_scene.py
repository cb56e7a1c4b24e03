import numpy as np
import pytest
from scenes import scene

from geometry.settings import SettingsError
from simulate.scene import Scene, fault_of_blade

WITHIN = {
    "accuracy": 0.01, "integrator": None, "liner__rods_per_round": None, "liner__strips": None
}  # fmt: skip


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"liner__modulus": 1.0}, ["liner.modulus", "unknown key", "known keys: law, thickness_m"]),
        ({"liner__thickness_mm": 5}, ["liner.thickness_mm", "did you mean 'thickness_m'"]),
        ({"clearance__leading_edge_mm": 5}, ["clearance.leading_edge_mm", "leading_edge_m"]),
        ({"clearance__leading_edge_m": 1e-5}, ["clearance", "exactly one of leading_edge_m"]),
        ({"liner__law__E": -1}, ["liner.law.E: -1", "greater than 0"]),
        ({"liner__law__K": -0.1}, ["liner.law.K: -0.1", "greater than or equal to 0"]),
        (
            {"integrator__fraction_of_limit": 1.2},
            ["integrator.fraction_of_limit: 1.2", "less than or equal to 1"],
        ),
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
        ({"damping_ratio": None}, ["damping_ratio: missing and required"]),
        ({"damping_ratio": 50}, ["damping_ratio: 50", "less than 1; ", "0.5 % is 0.005"]),
        ({"speeds": {"over_f1": [1e-6]}}, ["speeds: over_f1: 1e-06", "0.0001 to 20", "rad/s"]),
        ({"speeds": {"over_f1": [0.3, 500]}}, ["speeds: over_f1: 500", "speeds.rad_s"]),
        (
            {"speeds": {"rad_s": {"first": 0.3, "last": 0.4, "count": 3}}},
            ["speeds: rad_s: 0.3: allowed from 1 to 100000", "1 rpm is 0.1047", "speeds.over_f1"],
        ),
        (
            {"clearance__leading_edge_over_span": None, "clearance__leading_edge_m": 0.3},
            ["clearance.leading_edge_m: 0.3", "equal to 0.05; in m: 0.1 mm is 1.0e-4"],
        ),
        (
            {"clearance__trailing_edge_over_span": 2},
            ["clearance.trailing_edge_over_span: 2", "0.02 % of it is 2.0e-4"],
        ),
        (
            {"casing__harmonics": [{"order": 2, "amplitude_m": 40}]},
            ["casing.harmonics.0.amplitude_m: 40", "equal to 0.1; in m: 0.1 mm"],
        ),
        (
            {"casing": {"table": {"theta_deg": [0, 90], "depth_m": [0, 5]}, "ramp_rounds": 1}},
            ["casing.table", "depth_m: 5: allowed up to 0.1 m", "depth_mm or depth_um"],
        ),
        ({"casing__scale": 1e5}, ["casing.scale: 100000", "a factor: 127 % is 1.27"]),
        ({"casing__ramp_rounds": 1e6}, ["casing.ramp_rounds: 1000000", "in rounds of the blade"]),
        ({"liner__footprint_m": 3.4}, ["liner.footprint_m: 3.4", "equal to 0.3; in m: 5 mm"]),
        ({"liner__thickness_m": 5.0}, ["liner.thickness_m: 5", "equal to 0.1; in m: 5 mm"]),
        (
            {"liner__law__unit_Pa": 8.0},
            ["liner: law.E: 1 times unit_Pa: 8 is 8 Pa", "from 100000", "1.0e+9 for GPa"],
        ),
        (
            {"liner__law__E": 6e3},
            ["law.E: 6000 times unit_Pa", "1.2e+13 Pa; allowed", "stiffer liner is `kind: rigid`"],
        ),
        (
            {"liner__law__K": 4.5e8},
            ["liner: law.K: 4.5e+08 times unit_Pa: 2e+09", "K is given in unit_Pa"],
        ),
        ({"contact": {"profile": {"tilt": 3}}}, ["contact.profile.tilt: 3", "1 deg is 0.01745"]),
        (
            {"contact": {"profile": {"edge_drop_m": 0.05}}},
            ["contact.profile.edge_drop_m: 0.05", "in m: 5 um is 5.0e-6"],
        ),
        (
            {"peaks": {"orders": [4], "within_over_f1": 50}},
            ["peaks.within_over_f1: 50", "over f1(0), like speeds.over_f1"],
        ),
        (
            {"accuracy": 0.01},
            [
                "accuracy chooses",
                "integrator and liner.rods_per_round and liner.strips is set",
                "take out accuracy",
            ],
        ),
        (
            {"accuracy": 0.01, "integrator": None, "liner__strips": None},
            ["but liner.rods_per_round is set"],
        ),
        (WITHIN | {"liner__strips": 16}, ["accuracy chooses", "but liner.strips is set"]),
        (
            {"liner__strip_width_m": 5e-3},
            ["liner.strip_width_m: no longer a key", "from the tip", "give liner.strips"],
        ),
        (
            {"record__history__nodes": [1, 8]},
            ["record.history.nodes: no longer a key", "give chord", "node 1 of 8 was 0.0625"],
        ),
        ({"record__history": {"chord": [1.5]}}, ["record.history.chord.0: 1.5", "less than or"]),
        ({"record__history": {"chord": []}}, ["record.history.chord", "at least 1"]),
        ({"liner__strips": 0}, ["liner.strips: 0", "greater than or equal to 1"]),
        ({"integrator": None}, ["give integrator", "or `accuracy: 0.01`"]),
        (WITHIN | {"accuracy": 0.5}, ["accuracy: 0.5", "less than or equal to 0.1"]),
        (
            WITHIN | {"record": {"samples_per_round": 64, "wear": False}},
            ["accuracy is that of what is recorded"],
        ),
        ({"twin": "perhaps"}, ["twin: 'perhaps': should be true or false"]),
        ({"contact": {"profile": 1e-5}}, ["contact.profile: 1e-05: needs keys: edge_drop_m"]),
    ],
)
def test_a_fault_is_one_line_with_file_key_and_allowed_range(changes, words):
    with pytest.raises(SettingsError) as caught:
        scene(**changes)
    message = str(caught.value)
    assert message.startswith("scene.yaml: ")
    assert "\n" not in message
    assert all(word in message for word in words), message


STEPS = {"scheme": "piecewise-exact", "steps_per_round": 640}
RIGID = {"kind": "rigid"}
LAWS = "should be 'elastic', 'none', 'plastic', 'rigid' or 'table'"
EXACT = (
    "needs `integrator: {scheme: piecewise-exact, steps_per_round: ...}`: central differences "
    "cannot find the reaction of a rigid casing"
)


@pytest.mark.parametrize(
    ("changes", "line"),
    [
        ({"liner__law": RIGID}, f"liner.law.kind: rigid {EXACT}"),
        ({"liner__worn_through": "casing"}, f"liner.worn_through: casing {EXACT}"),
        (
            {"contact": {"tangential": True}},
            "contact: tangential: true needs `profile: {edge_drop_m: ...}`: on a flat tip the "
            "force is radial",
        ),
        ({"liner__law__kind": "plastik"}, f"liner.law: kind: 'plastik': {LAWS}"),
        ({"liner__law__kind": None}, f"liner.law: kind is missing: {LAWS}"),
        ({"liner__law": None}, "liner.law: missing and required"),
        (
            {"liner__law": "plastic"},
            "liner.law: 'plastic': needs keys, among them kind: elastic or kind: none or kind: "
            "plastic or kind: rigid or kind: table, as in `law: {kind: elastic, E: ..., unit_Pa: "
            "...}`",
        ),
        (
            {"liner__law": {"kind": "elastic", "E": 1, "K": 1, "unit_Pa": 1}},
            "liner.law.K: unknown key; known keys: kind, E, unit_Pa",
        ),
        ({"liner__law__sigma_Y": None}, "liner.law.sigma_Y: missing and required"),
        (
            {"integrator__scheme": "newmark"},
            "integrator: scheme: 'newmark': should be 'piecewise-exact' or 'central-difference'",
        ),
        (
            {"integrator__scheme": None},
            "integrator: scheme is missing: should be 'piecewise-exact' or 'central-difference'",
        ),
        (
            {"integrator__scheme": "piecewise-exact"},
            "integrator: fraction_of_limit: piecewise-exact has no stability limit; give "
            "steps_per_round instead",
        ),
        (
            {"integrator": {"scheme": "piecewise-exact"}},
            "integrator.steps_per_round: missing and required",
        ),
        (
            {"integrator__steps_per_round": 4000},
            "integrator: give exactly one of steps_per_round, fraction_of_limit; found 2",
        ),
        (
            {"integrator__fraction_of_limit": None},
            "integrator: give exactly one of steps_per_round, fraction_of_limit; found 0",
        ),
        (
            {"integrator__mass_scaling_Hz": 2e4},
            "integrator.mass_scaling_Hz: unknown key; did you mean 'mass_scaling_hz'?",
        ),
    ],
)
def test_an_invalid_law_or_scheme_is_refused_with_its_remedy(changes, line):
    with pytest.raises(SettingsError) as caught:
        scene(**changes)
    assert str(caught.value) == f"scene.yaml: {line}"


PEAKS = {"orders": [4, 31], "within_over_f1": 0.01}


def test_peaks_beyond_the_spectrum_are_refused_by_the_scene():
    """64 samples hold 32 engine orders; a peak is compared with two orders beside it."""
    assert scene(peaks=PEAKS | {"orders": [4, 30]}).peaks.orders == [4, 30]
    with pytest.raises(SettingsError) as caught:
        scene(peaks=PEAKS)
    assert str(caught.value) == (
        "scene.yaml: peaks.orders: 31: allowed up to 30, half of record.samples_per_round = 64 "
        "less 2, which the spectrum holds"
    )


def test_steps_that_are_no_multiple_of_the_samples_are_refused_by_the_scene():
    with pytest.raises(SettingsError, match=r"steps_per_round: 650: allowed multiples .* = 64$"):
        scene(integrator={"scheme": "piecewise-exact", "steps_per_round": 650})


@pytest.mark.parametrize(
    ("speeds", "fault"),
    [
        ({"rad_s": [600.0, 650.0]}, None),
        ({"over_f1": [20.0]}, None),  # f1(0) is that of the model
        (
            {"rad_s": [600.0, 651.0]},
            "651: allowed up to 650, the highest speed of blade coarse; 651",
        ),
        ({"rad_s": {"first": 60, "last": 6207, "count": 9}}, "; 6207 rpm are 650 rad/s"),
    ],
)
def test_what_the_blade_alone_does_not_allow(coarse_blade, speeds, fault):
    found = fault_of_blade(scene(speeds=speeds), coarse_blade)
    assert (found is None) if fault is None else (fault in found)


@pytest.mark.parametrize(
    "changes",
    [
        {"liner__law": RIGID, "integrator": STEPS},
        {"liner__worn_through": "casing", "integrator": STEPS},
        {"liner__law": {"kind": "none"}, "liner__worn_through": "casing"},  # no casing to meet
        {"contact": {"tangential": True, "profile": {"edge_drop_m": 1e-5}}},
        {"integrator": STEPS | {"mass_scaling_hz": 2.5e4}, "twin": True},
        {"liner__law": {"kind": "elastic", "E": 1, "unit_Pa": 2e9}},
    ],
)
def test_the_remedies_are_accepted_and_read_back_from_a_sweep(changes):
    """A sweep holds its scene as JSON."""
    case = scene(**changes)
    assert Scene.model_validate_json(case.model_dump_json()) == case


def test_only_a_tangential_force_asks_for_the_tangential_interface():
    profile = {"edge_drop_m": 1e-5}
    assert scene(contact={"profile": profile}).directions == "r"
    assert scene(contact={"profile": profile, "tangential": True}).directions == "rt"


def test_speeds_in_both_units_are_the_same_speeds():
    f1 = 250.0
    ratio = scene(speeds={"over_f1": {"first": 0.1, "last": 0.4, "count": 4}}).speeds.omega(f1)
    rad_s = scene(speeds={"rad_s": list(ratio)}).speeds.omega(f1)
    np.testing.assert_allclose(ratio, 2 * np.pi * 250 * np.array([0.1, 0.2, 0.3, 0.4]), rtol=1e-15)
    np.testing.assert_array_equal(ratio, rad_s)


def test_clearances_in_both_units_are_linear_along_the_chord():
    """Given at xi = 1/16 and 15/16, evaluated anywhere."""
    xi = np.linspace(0, 1, 33)
    over_span = scene().clearance.gaps(xi, 0.14)
    in_m = scene(
        clearance={"leading_edge_m": 1.5e-4 * 0.14, "trailing_edge_m": 4.3e-4 * 0.14}
    ).clearance.gaps(xi, 0.14)
    np.testing.assert_allclose(over_span, in_m, rtol=1e-14)
    np.testing.assert_allclose(over_span[[2, -3]], [1.5e-4 * 0.14, 4.3e-4 * 0.14], rtol=1e-14)
    np.testing.assert_allclose(np.diff(over_span, 2), 0, atol=1e-18)


def test_strips_are_sixteen_by_default():
    assert scene(liner__strips=None).liner.m == 16 and scene(liner__strips=5).liner.m == 5


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
