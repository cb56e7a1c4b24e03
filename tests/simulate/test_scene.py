import numpy as np
import pytest
from refused import refused
from scenes import scene

from geometry.base import ROOT, SettingsError
from simulate.scene import OF_RPM, OVER_F1, Liner, Scene, fault_of_blade

WITHIN = {
    "accuracy": 0.01, "integrator": None, "liner__rods_per_round": None, "liner__strips": None
}  # fmt: skip


STEPS = {"scheme": "piecewise-exact", "steps_per_round": 640}
RIGID = {"kind": "rigid"}
LAWS = sorted(file.stem for file in (ROOT / "simulate/scene/laws").glob("[!_]*.py"))
SCHEMES = ["piecewise-exact", "central-difference"]


@pytest.mark.parametrize(
    ("changes", "key", "value", "allowed"),
    [
        (
            {"liner__modulus": 1},
            "liner.modulus",
            None,
            [*Liner.model_fields],
        ),
        ({"liner__thickness_um": 5}, "liner.thickness_um", None, ["thickness_mm"]),
        ({"clearance__leading_edge_mm": 5}, "clearance.leading_edge_mm", None, ["leading_edge_um"]),
        (
            {"clearance__leading_edge_um": 10},
            "clearance",
            None,
            ("leading_edge_um", "leading_edge_over_span"),
        ),
        ({"liner__law__E": -1}, "liner.law.E", -1, {"gt": 0}),
        ({"liner__law__K": -0.1}, "liner.law.K", -0.1, {"ge": 0}),
        ({"integrator__fraction_of_limit": 1.2}, "integrator.fraction_of_limit", 1.2, {"le": 1}),
        ({"speeds__rpm": [1000.0]}, "speeds", None, ("over_f1", "rpm")),
        ({"speeds__over_f1": [-3]}, "speeds.over_f1.0", -3, {"gt": 0}),
        (
            {"speeds": {"over_f1": {"first": 0.1, "last": 0.3, "cuont": 3}}},
            "speeds.over_f1.cuont",
            None,
            ["count"],
        ),
        ({"speeds__over_f1": []}, "speeds.over_f1", [], {"min_length": 1}),
        ({"liner__thickness_mm": 1e-297}, "liner.thickness_mm", 1e-297, {"ge": 1e-4}),
        ({"rounds": 0}, "rounds", 0, {"ge": 1}),
        ({"record__spectrum_rounds": 3}, "record.spectrum_rounds", 3, {"le": 2}),
        ({"record__states_rounds": 3}, "record.states_rounds", 3, {"le": 2}),
        ({"record__states_rounds": 0}, "record.states_rounds", 0, {"ge": 1}),
        ({"damping_ratio": 1}, "damping_ratio", 1.0, {"lt": 1}),
        ({"damping_ratio": None}, "damping_ratio", None, None),
        ({"damping_ratio": 50}, "damping_ratio", 50, {"lt": 1}),
        ({"speeds": {"over_f1": [1e-6]}}, "speeds.over_f1", 1e-06, OVER_F1),
        ({"speeds": {"over_f1": [0.3, 500]}}, "speeds.over_f1", 500.0, OVER_F1),
        ({"speeds": {"rpm": [0.3, 0.4]}}, "speeds.rpm", 0.3, OF_RPM),
        (
            {"clearance__leading_edge_over_span": None, "clearance__leading_edge_um": 300000},
            "clearance.leading_edge_um",
            300000,
            {"le": 50000},
        ),
        (
            {"clearance__trailing_edge_over_span": 2},
            "clearance.trailing_edge_over_span",
            2,
            {"le": 0.5},
        ),
        (
            {"casing__harmonics": [{"order": 2, "amplitude_um": 40000000}]},
            "casing.harmonics.0.amplitude_um",
            40000000,
            {"le": 100000},
        ),
        (
            {
                "casing": {
                    "table": {"theta_deg": [0, 90], "depth_um": [0, 5000000]},
                    "ramp_rounds": 1,
                }
            },
            "casing.table.depth_um",
            5000000,
            {"le": 100000},
        ),
        ({"casing__scale": 1e5}, "casing.scale", 100000.0, {"le": 10000}),
        ({"casing__ramp_rounds": 1e6}, "casing.ramp_rounds", 1000000.0, {"le": 100000}),
        ({"liner__footprint_mm": 3400}, "liner.footprint_mm", 3400, {"le": 300}),
        ({"liner__thickness_mm": 5000}, "liner.thickness_mm", 5000, {"le": 100}),
        ({"liner__law__unit_MPa": 8e-06}, "liner.law.E", 1.0, (12500.0, 1250000000000.0)),
        ({"liner__law__E": 6e3}, "liner.law.E", 6000.0, (5e-05, 5000.0)),
        ({"liner__law__K": 4.5e8}, "liner.law.K", 450000000.0, (0.0, 5000000.0)),
        ({"contact": {"profile": {"tilt": 3}}}, "contact.profile.tilt", 3, {"le": 1}),
        (
            {"contact": {"profile": {"edge_drop_um": 50000}}},
            "contact.profile.edge_drop_um",
            50000,
            {"le": 20000},
        ),
        ({"peaks": {"orders": [4], "within_over_f1": 50}}, "peaks.within_over_f1", 50, {"le": 1}),
        ({"accuracy": 0.01}, "accuracy", None, None),
        ({"accuracy": 0.01, "integrator": None, "liner__strips": None}, "accuracy", None, None),
        (WITHIN | {"liner__strips": 16}, "accuracy", None, None),
        ({"liner__strip_width_m": 5e-3}, "liner.strip_width_m", None, None),
        ({"record__history__nodes": [1, 8]}, "record.history.nodes", None, None),
        ({"record__history": {"chord": [1.5]}}, "record.history.chord.0", 1.5, {"le": 1}),
        ({"record__history": {"chord": []}}, "record.history.chord", [], {"min_length": 1}),
        ({"liner__strips": 0}, "liner.strips", 0, {"ge": 1}),
        ({"integrator": None}, "", None, ["integrator", "accuracy"]),
        (WITHIN | {"accuracy": 0.5}, "accuracy", 0.5, {"le": 0.1}),
        (WITHIN | {"record": {"samples_per_round": 64, "wear": False}}, "accuracy", None, None),
        ({"verify": {"predictable": "perhaps"}}, "verify.predictable", "perhaps", None),
        ({"contact": {"profile": 1e-5}}, "contact.profile", 1e-05, None),
        ({"liner__law": RIGID}, "liner.law.kind", "rigid", None),
        ({"liner__worn_through": "casing"}, "liner.worn_through", "casing", None),
        ({"contact": {"tangential": True}}, "contact.tangential", True, None),
        ({"liner__law__kind": "plastik"}, "liner.law.kind", "plastik", LAWS),
        ({"liner__law__kind": None}, "liner.law.kind", None, LAWS),
        ({"liner__law": None}, "liner.law", None, None),
        ({"liner__law": "plastic"}, "liner.law", "plastic", LAWS),
        (
            {"liner__law": {"kind": "elastic", "E": 1, "K": 1, "unit_MPa": 1e-06}},
            "liner.law.K",
            None,
            ["kind", "E", "unit_MPa"],
        ),
        ({"liner__law__sigma_Y": None}, "liner.law.sigma_Y", None, None),
        ({"integrator__scheme": "newmark"}, "integrator.scheme", "newmark", SCHEMES),
        ({"integrator__scheme": None}, "integrator.scheme", None, SCHEMES),
        ({"integrator__scheme": "piecewise-exact"}, "integrator.fraction_of_limit", None, None),
        ({"integrator": {"scheme": "piecewise-exact"}}, "integrator.steps_per_round", None, None),
        (
            {"integrator__steps_per_round": 4000},
            "integrator",
            None,
            ("steps_per_round", "fraction_of_limit"),
        ),
        (
            {"integrator__fraction_of_limit": None},
            "integrator",
            None,
            ("steps_per_round", "fraction_of_limit"),
        ),
        ({"integrator__mass_scaling_hz": 2e4}, "integrator.mass_scaling_hz", None, None),
        ({"liner__law_in_march": True}, "liner.law_in_march", None, None),
        (
            {"integrator": STEPS | {"steps_per_round": 650}},
            "integrator.steps_per_round",
            650,
            {"multiple_of": 64},
        ),
    ],
)
def test_a_fault_has_file_key_value_and_what_is_allowed(changes, key, value, allowed):
    error = refused(SettingsError, scene, **changes)
    (fault,) = error.faults
    assert fault[1:5] == (key, value, allowed, "scene.yaml")
    assert "\n" not in str(fault)


def test_a_fault_is_one_line_with_its_remedy():
    error = refused(SettingsError, scene, liner__law=RIGID)
    assert str(error) == (
        "scene.yaml: liner.law.kind: 'rigid': needs `integrator: {scheme: piecewise-exact, "
        "steps_per_round: ...}`: central differences cannot find the reaction of a rigid casing"
    )


PEAKS = {"orders": [4, 31], "within_over_f1": 0.01}


def test_peaks_beyond_the_spectrum_are_refused_by_the_scene():
    """64 samples hold less than 32 engine orders."""
    assert scene(peaks=PEAKS | {"orders": [4, 31]}).peaks.orders == [4, 31]
    error = refused(SettingsError, scene, peaks=PEAKS | {"orders": [32]})
    assert error.faults[0][1:4] == ("peaks.orders", 32, {"le": 31})


TOP = {"rpm": pytest.approx(650 * 30 / np.pi), "over_f1": None}


@pytest.mark.parametrize(
    ("speeds", "highest"),
    [
        ({"rpm": [6000.0, 6207.042780583919]}, None),
        ({"over_f1": [20.0]}, None),  # f1(0) is that of the model
        ({"rpm": {"first": 60, "last": 6207, "count": 9}}, None),
        ({"rpm": [6000, 6208]}, 6208.0),
    ],
)
def test_what_the_blade_alone_does_not_allow(coarse_blade, speeds, highest):
    found = fault_of_blade(scene(speeds=speeds), coarse_blade)
    unit, allowed = next((unit, of) for unit, of in TOP.items() if unit in speeds)
    expected = (f"speeds.{unit}", highest, {"le": allowed})
    assert (found is None) if highest is None else (found[1:4] == expected)


@pytest.mark.parametrize(
    "changes",
    [
        {"liner__law": RIGID, "integrator": STEPS},
        {"liner__worn_through": "casing", "integrator": STEPS},
        {"liner__law": {"kind": "none"}, "liner__worn_through": "casing"},  # no casing to meet
        {"contact": {"tangential": True, "profile": {"edge_drop_um": 10}}},
        {"integrator": STEPS, "verify": {"predictable": True}},
        {"liner__law": {"kind": "elastic", "E": 1, "unit_MPa": 2000}},
    ],
)
def test_the_remedies_are_accepted_and_read_back_from_a_sweep(changes):
    """A sweep holds its scene as JSON."""
    case = scene(**changes)
    assert Scene.model_validate_json(case.model_dump_json()) == case


@pytest.mark.parametrize(("contact", "directions"), [({}, "r"), ({"tangential": True}, "rt")])
def test_only_a_tangential_force_asks_for_the_tangential_interface(contact, directions):
    profile = {"profile": {"edge_drop_um": 10}}
    assert scene(contact=profile | contact).directions == directions


def test_speeds_in_all_units_are_the_same_speeds():
    f1 = 250.0
    ratio = scene(speeds={"over_f1": {"first": 0.1, "last": 0.4, "count": 4}}).speeds.omega(f1)
    rad_s = scene(speeds={"rad_s": list(ratio)}).speeds.omega(f1)
    np.testing.assert_allclose(ratio, 2 * np.pi * 250 * np.array([0.1, 0.2, 0.3, 0.4]), rtol=1e-15)
    np.testing.assert_allclose(ratio, rad_s, rtol=2e-16)
    rpm = scene(speeds={"rpm": {"first": 1500, "last": 6000, "count": 4}}).speeds.omega(f1)
    np.testing.assert_allclose(rpm, ratio, rtol=1e-15)


def test_clearances_in_both_units_are_linear_along_the_chord():
    """Given at xi = 1/16 and 15/16, evaluated anywhere."""
    xi = np.linspace(0, 1, 33)
    over_span = scene().clearance.gaps(xi, 0.14)
    in_m = scene(
        clearance={"leading_edge_um": 150 * 0.14, "trailing_edge_um": 430 * 0.14}
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
                {"order": 5, "amplitude_um": 10},
            ],
        }
    ).casing
    exact = -3 * gap * np.sin(2 * theta) + 1e-5 * np.cos(5 * theta)
    np.testing.assert_allclose(casing.inward(theta, gap), exact, atol=1e-18)
