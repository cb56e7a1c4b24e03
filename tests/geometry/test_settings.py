"""Every fault of a blade file is one line with the file, the key, the value and what is allowed."""

from math import inf, nan, nextafter
from pathlib import Path

import numpy as np
import pytest
from refused import refused

from geometry.base import RPM, Settings, SettingsError, check_settings
from geometry.base.settings import _listed
from geometry.blade import MOST_TIP_SPEED, Blade, Material
from geometry.profile import profile_at
from workflow.config import Config  # noqa: F401
from workflow.many.design import Design  # noqa: F401  with all settings of scenes

PACKAGES = ("geometry", "simulate", "workflow")
REFERENCE = (Path(__file__).parents[2] / "workflow/blades/reference.yaml").read_text()
SPEED, SPAN = "max_speed_rpm: 6207.042780583919", "span_mm: 140"
PATCHES = "patches: 16\n  across: 1"
PAPER = f"{SPEED}\nbasis: {{kind: paper}}"
LISTED = "points_mm: [[562, 1, 1], [562, 0, 2]]"
PATCHES_ALONE = ["patches", "across", "nodes", "points_mm"]


@pytest.fixture
def read(tmp_path):
    """Read the reference file with each text written as another."""

    def read(changes):
        text = REFERENCE
        for old, new in changes.items():
            assert text.count(old) == 1
            text = text.replace(old, new)
        path = tmp_path / "blade.yaml"
        path.write_text(text)
        return Blade.load(path)

    return read


@pytest.fixture
def refusal(read, tmp_path):
    """Return the error of the reference file with each text written as another."""

    def refusal(changes):
        with pytest.raises(SettingsError) as caught:
            read(changes)
        assert {fault.file for fault in caught.value.faults} == {str(tmp_path / "blade.yaml")}
        return caught.value

    return refusal


def basis(keys):
    return {SPEED: f"{SPEED}\nbasis: {keys}"}


@pytest.mark.parametrize(
    ("changes", "key", "value", "allowed"),
    [
        ({SPAN: "span_mm: .nan"}, "sections.span_mm", nan, None),
        ({SPEED: f"{SPEED}\nmax_speeds: 3"}, "max_speeds", None, ["max_speed_rpm"]),
        ({SPAN: "span_m: 0.14"}, "sections.span_m", None, ["span_mm"]),  # in another unit
        ({PATCHES: "colour: red"}, "interface.colour", None, PATCHES_ALONE),
        (
            basis("{kind: paper, natural_modes: 3}"),
            "basis.natural_modes",
            None,
            ["kind", "fixed_interface_modes", "rank_tolerance"],
        ),
        (basis("{fixed_interface_modes: 9}"), "basis.fixed_interface_modes", None, None),
        (basis("{natural_mods: 3}"), "basis.natural_mods", None, ["natural_modes"]),
        (basis("paper"), "basis", "paper", ["enriched", "paper"]),
        (basis("{kind: papre}"), "basis.kind", "papre", ["enriched", "paper"]),
        ({"mesh:\n  element_size_mm: 2.48": ""}, "mesh", None, None),
        ({SPEED: ""}, "max_speed_rpm", None, None),
        ({SPEED: f"{SPEED}\nmax_speed_rad_s: 650"}, "max_speed_rad_s", None, None),
        (
            {SPEED: "max_speed_rpm: 62070"},
            "max_speed_rpm",
            62070.0,
            {"le": pytest.approx(MOST_TIP_SPEED / 0.5624 * RPM)},
        ),
        (
            {SPEED: "max_speed_rpm: 5000\ndesign_rpm: 5600"},
            "design_rpm",
            5600.0,
            {"le": pytest.approx(5000)},
        ),
        ({PATCHES: f"{PATCHES}\nformat: 2\nrotor: mine"}, "format", 2, 1),
        ({PATCHES: f"{PATCHES}\nformat: 0"}, "format", 0, 1),
        ({PATCHES: f"{PATCHES}\nformat: '2'"}, "format", "2", {"expected": "1"}),
        (
            {"thickness_mm: 5.6": "thickness_mm: 56"},
            "sections.hub.thickness_mm",
            56.0,
            {"le": pytest.approx(0.4 * 66)},
        ),
        (
            {SPEED: f"{SPEED}\nidle_rpm: 3000\nmargins: {{modes: 11}}"},
            "margins.modes",
            11,
            {"le": 10},
        ),
        (
            {SPEED: f"{SPEED}\ndesign_rpm: 5000\nmargins: {{orders: []}}"},
            "margins.orders",
            [],
            {"min_length": 1},
        ),
        ({SPEED: "max_speed_rpm: true"}, "max_speed_rpm", True, None),
        ({PATCHES: "patches: yes"}, "interface.patches", True, None),
        (
            {PATCHES: "points_mm: [[560, 1, on], [560, 0, 2]]"},
            "interface.points_mm",
            [[560, 1, True], [560, 0, 2]],
            None,
        ),
        ({"density_kg_m3: 4430": "density_kg_m3: true"}, "material.density_kg_m3", True, None),
        ({PATCHES: "nodes: 8"}, "interface.nodes", None, None),
        ({PATCHES: "along: pressure-side"}, "interface.along", None, None),
        ({PATCHES: LISTED}, "interface.points_mm", None, None),
        ({SPEED: PAPER}, "interface.patches", None, None),
        ({SPEED: PAPER, PATCHES: f"nodes: 5\n  {LISTED}"}, "interface", None, None),
    ],
)
def test_a_fault_has_key_value_and_what_is_allowed(refusal, changes, key, value, allowed):
    error = refusal(changes)
    (fault,) = error.faults
    assert (fault.key, str(fault.value), fault.allowed) == (key, str(value), allowed)
    assert "\n" not in str(error)


def below(model):
    """All settings of the project that derive from a model."""
    for one in model.__subclasses__():
        yield from below(one)
        if one.__module__.startswith(PACKAGES):
            yield one


STEPS = {  # bounds in a schema: their names in an error, and where the next value beyond is
    "minimum": ("ge", -1),
    "maximum": ("le", 1),
    "exclusiveMinimum": ("gt", 0),
    "exclusiveMaximum": ("lt", 0),
}
OTHER_TYPES = {"number": "x", "integer": "x", "boolean": "x", "string": 3}


def beyond(field):
    """Values that the schema of a field just does not allow, with what it does.

    Of a field with one form that is no model: what a union allows depends on what is given.
    """
    forms = [form for form in field.get("anyOf", [field]) if form.get("type") != "null"]
    form = forms[0] if len(forms) == 1 else {}
    for name in STEPS.keys() & form.keys():
        bound, (rule, step) = form[name], STEPS[name]
        whole = form["type"] == "integer" or not step
        yield bound + step if whole else nextafter(bound, step * inf), {rule: bound}
    if "enum" in form:
        yield "other", {"expected": _listed(form["enum"])}
    elif "const" in form:
        yield "other", {"expected": repr(form["const"])}
    elif other := OTHER_TYPES.get(form.get("type")):
        yield other, None


FIELDS = [
    (model, key, value, allowed)
    for model in sorted(set(below(Settings)), key=lambda model: f"{model.__module__}{model}")
    for key, field in model.model_json_schema().get("properties", {}).items()
    for value, allowed in sorted(beyond(field), key=str)
    if key != "format"
]


@pytest.mark.parametrize(
    ("model", "key", "value", "allowed"),
    FIELDS,
    ids=[f"{model.__module__}.{model.__name__}.{key}-{value}" for model, key, value, _ in FIELDS],
)
def test_every_field_refuses_what_is_just_not_allowed(model, key, value, allowed):
    """As its schema says; further keys that its model needs are missing here."""
    with pytest.raises(SettingsError) as caught:
        check_settings(model, {key: value}, "a.yaml")
    faults = [fault for fault in caught.value.faults if fault.key == key]
    assert [(fault.value, fault.allowed) for fault in faults] == [(value, allowed)]


def test_the_line_of_a_fault_has_all_of_it(refusal):
    error = refusal({SPAN: "span_mm: -140"})
    assert str(error) == (
        f"{error.file}: sections.span_mm: -140: should be greater than 0 (line {error.line})"
    )
    assert REFERENCE.splitlines()[error.line - 1].strip() == SPAN


def test_a_file_may_say_its_format(read):
    assert read({SPEED: f"{SPEED}\nformat: 1"}) == read({})


@pytest.mark.parametrize(
    ("root", "key"),
    [
        ({"group": "a", "radius_mm": 1}, "mesh_file.root"),
        ({}, "mesh_file.root"),
        ({"group": "a"}, "mesh"),
    ],
)
def test_a_mesh_file_with_excess_or_missing_keys_is_refused(coarse_blade, root, key):
    source = {"file": "b.inp", "unit": "mm", "root": root, "tip": {"group": "b"}}
    values = coarse_blade.model_dump(exclude_unset=True, exclude={"sections"})
    error = refused(SettingsError, check_settings, Blade, values | {"mesh_file": source}, "b.yaml")
    assert [(fault.file, fault.key) for fault in error.faults] == [("b.yaml", key)]


@pytest.mark.parametrize(
    ("old", "slips"),
    [
        ("density_kg_m3: 4430", ["4.43e-9", "4.43", "4.43e6", ".nan"]),  # t/mm3, g/cm3, g/m3
        ("young_modulus_GPa: 113.8", ["113800", "113.8e+9", "0.1138"]),  # MPa, Pa, TPa
    ],
)
def test_a_value_in_another_unit_says_which_is_meant(refusal, old, slips):
    name = old.split(":")[0]
    for slip in slips:
        error = refusal({old: f"{name}: {slip}"})
        assert error.key == f"material.{name}"
        assert error.text.endswith(Material.hints[name])


def test_numbers_are_read_as_yaml_and_people_write_them(read):
    """YAML 1.1 takes 4.43e3 for a text; a whole number stands for any."""
    material = read({"4430": "4.43e3", "113.8": "114"}).material
    assert (material.density_kg_m3, material.young_modulus) == (4430, 114e9)


def test_two_faults_are_two_lines(refusal):
    error = refusal({PATCHES: "patches: 1", SPEED: "max_speed_rpm: 0"})
    assert [fault.key for fault in error.faults] == ["interface.patches", "max_speed_rpm"]
    assert str(error).count("\n") == 1


@pytest.mark.parametrize("rule", ["nodes: 8", LISTED])
def test_points_are_given_by_one_rule(read, rule):
    assert read({PATCHES: rule, SPEED: PAPER}).of_points


def test_default_is_of_sixteen_patches(read):
    blade = read({f"interface:\n  {PATCHES}": ""})
    assert blade.interface.patches == 16
    assert not blade.of_points


def test_the_highest_speed_in_rpm_is_that_in_rad_s(read):
    in_rpm, in_rad_s = (
        read({SPEED: text}) for text in ("max_speed_rpm: 6000", f"max_speed_rad_s: {200 * np.pi!r}")
    )
    assert in_rpm.top_speed == pytest.approx(200 * np.pi, rel=1e-15)
    assert in_rpm.settings_of_matrices().keys() == in_rad_s.settings_of_matrices().keys()
    assert in_rpm.settings_of_matrices()["max_speed_rad_s"] == in_rpm.top_speed


def test_the_settings_of_a_model_are_those_that_affect_it(coarse_blade, paper_blade):
    """Not the tolerance of its check, nor keys of points where there are patches."""
    of_matrices = coarse_blade.settings_of_matrices()
    assert set(of_matrices) == {"material", "prestress", "max_speed_rad_s", "interface"}
    assert of_matrices["interface"] == {"patches": 8, "across": 1}
    assert set(paper_blade.settings_of_matrices()["interface"]) == {"nodes"}
    judged = coarse_blade.basis.model_copy(update={"tolerance_percent": 5.0})
    richer = coarse_blade.basis.model_copy(update={"natural_modes": 30})
    of_model = coarse_blade.settings_of_model()
    assert of_model["basis"]["natural_modes"] == 24
    for basis, same in ((judged, True), (richer, False)):
        other = coarse_blade.model_copy(update={"basis": basis})
        assert (other.settings_of_model() == of_model) is same
        assert other.settings_of_matrices() == of_matrices


@pytest.mark.parametrize(
    ("content", "line"),
    [
        (b"sections: [1,\nmesh: }", 2),
        (b"\xff\xfe", None),
        (b"mesh: 1\nmesh: 2", 2),
        (b"- a\n- b", 1),
        (b"", None),
        (None, None),
    ],
)
def test_what_is_no_mapping_is_one_line(tmp_path, content, line):
    path = tmp_path / "blade.yaml"
    if content is not None:
        path.write_bytes(content)
    error = refused(SettingsError, Blade.load, path)
    assert (error.file, error.key, error.line) == (str(path), "", line)


def test_blade_in_metres_and_radians(coarse_blade):
    assert coarse_blade.sections.hub_radius == pytest.approx(0.4224)
    assert coarse_blade.sections.tip_radius == pytest.approx(0.5624)
    assert coarse_blade.material.young_modulus == pytest.approx(113.8e9)
    middle = profile_at(coarse_blade.sections, 0.4924)
    assert middle.stagger == pytest.approx(0.5759586531581288)  # 33 degrees


@pytest.mark.parametrize(
    ("name", "value", "allowed"),
    [("element_size_mm", -1.0, {"gt": 0}), ("elemnt_size_mm", None, ["element_size_mm"])],
)
def test_settings_with_other_values_are_checked_again(coarse_blade, name, value, allowed):
    finer = coarse_blade.but(mesh__element_size_mm=3.0)
    assert finer.mesh.element_size_mm == 3.0
    assert finer.but(mesh__element_size_mm=coarse_blade.mesh.element_size_mm) == coarse_blade
    error = refused(SettingsError, coarse_blade.but, **{f"mesh__{name}": -1.0})
    assert (error.file, error.key) == ("blade", f"mesh.{name}")
    assert (error.value, error.allowed) == (value, allowed)
