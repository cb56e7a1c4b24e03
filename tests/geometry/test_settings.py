"""Every fault of a blade file is one line with the file, the key, the value and what is allowed."""

import re
from pathlib import Path

import pytest

from geometry.blade import Blade
from geometry.profile import profile_at
from geometry.settings import SettingsError, check_settings, read_settings
from geometry.version import version

REFERENCE = (Path(__file__).parents[2] / "workflow/blades/reference.yaml").read_text()


@pytest.fixture
def message(tmp_path):
    """Return the message on the reference file with ``old`` written as ``new``, after its path."""

    def read(old, new):
        assert REFERENCE.count(old) == 1
        path = tmp_path / "blade.yaml"
        path.write_text(REFERENCE.replace(old, new))
        with pytest.raises(SettingsError) as caught:
            read_settings(Blade, path)
        lines = str(caught.value).splitlines()
        assert all(line.startswith(f"{path}: ") for line in lines)
        return [re.sub(r" \(line \d+\)$", "", line.removeprefix(f"{path}: ")) for line in lines]

    return read


@pytest.mark.parametrize(
    ("old", "new", "line"),
    [
        (
            "span_mm: 140",
            "span_mm: -140",
            "sections.span_mm: -140: should be greater than 0",
        ),
        (
            "stagger_deg: 48",
            "stagger_deg: 480",
            "sections.tip.stagger_deg: 480: should be less than 90",
        ),
        (
            "patches: 16",
            "patches: 80",
            "interface.patches: 80: should be less than or equal to 64",
        ),
        (
            "span_mm: 140",
            "span_mm: 140 mm",
            "sections.span_mm: '140 mm': should be a valid number, "
            "unable to parse string as a number",
        ),
        (
            "span_mm: 140",
            "span_mm: .nan",
            "sections.span_mm: nan: should be a finite number",
        ),
        (
            "prestress: nonlinear",
            "prestress: none",
            "prestress: 'none': should be 'nonlinear' or 'linear'",
        ),
        (
            "max_speed_rad_s: 650",
            "max_speed_rad_s: 650\nmax_speeds: 3",
            "max_speeds: unknown key; did you mean 'max_speed_rad_s'?",
        ),
        (
            "patches: 16",
            "colour: red",
            "interface.colour: unknown key; known keys: patches, nodes, along, points_mm",
        ),
        (
            "max_speed_rad_s: 650",
            "max_speed_rad_s: 650\nbasis: {kind: paper, natural_modes: 3}",
            "basis.natural_modes: unknown key; known keys: kind, fixed_interface_modes, "
            "rank_tolerance",
        ),
        (
            "max_speed_rad_s: 650",
            "max_speed_rad_s: 650\nbasis: {fixed_interface_modes: 9}",
            "basis.fixed_interface_modes: no longer a key; natural modes stand for them: "
            "natural_modes",
        ),
        (
            "max_speed_rad_s: 650",
            "max_speed_rad_s: 650\nbasis: {natural_mods: 3}",
            "basis.natural_mods: unknown key; did you mean 'natural_modes'?",
        ),
        (
            "max_speed_rad_s: 650",
            "max_speed_rad_s: 650\nbasis: paper",
            "basis: 'paper': needs keys, among them kind: enriched (the default) or kind: paper, "
            "as in `basis: {kind: paper}`",
        ),
        (
            "max_speed_rad_s: 650",
            "max_speed_rad_s: 650\nbasis: {kind: papre}",
            "basis: kind: 'papre': should be 'enriched' or 'paper'",
        ),
        (
            "mesh:\n  element_size_mm: 2.48",
            "",
            "mesh: missing; sections needs it: `mesh: {element_size_mm: ...}`",
        ),
        (
            "max_speed_rad_s: 650",
            "",
            "max_speed_rad_s: missing and required",
        ),
        (
            "patches: 16",
            "patches: 16\nformat: 2\nrotor: mine",
            f"format 2: this Tiprub ({version()}) reads format 1; use a later Tiprub",
        ),
        (
            "patches: 16",
            "patches: 16\nformat: 0",
            f"format 0: this Tiprub ({version()}) reads format 1; CHANGELOG.md says what "
            "has changed",
        ),
        ("patches: 16", "patches: 16\nformat: '2'", "format: '2': should be 1"),
    ],
)
def test_one_fault_is_one_line(message, old, new, line):
    assert message(old, new) == [line]


def test_thickness_ten_times_too_large_is_told_by_its_key(message):
    assert message("thickness_mm: 5.6", "thickness_mm: 56") == [
        "sections.hub: thickness_mm: 56: 85 % of the chord of 66 mm; allowed up to 40 %: is one of "
        "them in another unit, or ten times what was meant?"
    ]


def test_speed_in_rpm_is_told_from_the_file_alone(message):
    assert message("max_speed_rad_s: 650", "max_speed_rad_s: 6207") == [
        "the tip, at radius 0.5624 m, runs at 3491 m/s (allowed up to 1000); check the lengths and "
        "max_speed_rad_s: 6207 (rad/s, not rpm: 6207 rpm are 650 rad/s)"
    ]


def test_a_fault_has_the_line_of_its_key(tmp_path):
    path = tmp_path / "blade.yaml"
    path.write_text(REFERENCE.replace("span_mm: 140", "span_mm: -140"))
    with pytest.raises(SettingsError, match=r"sections.span_mm: -140: .* than 0 \(line 5\)$"):
        read_settings(Blade, path)


def test_a_file_may_say_its_format(tmp_path):
    path = tmp_path / "blade.yaml"
    path.write_text("format: 1\n" + REFERENCE)
    with_it = read_settings(Blade, path)
    path.write_text(REFERENCE)
    assert with_it == read_settings(Blade, path)


def test_wrong_unit_in_the_key_names_the_right_one(message):
    assert message("span_mm: 140", "span_m: 0.14") == [
        "sections.span_m: unknown key; did you mean 'span_mm'?",
    ]


@pytest.mark.parametrize(
    ("root", "line"),
    [
        ({"group": "a", "radius_mm": 1}, "mesh_file.root: needs one of group and radius_mm"),
        ({}, "mesh_file.root: needs one of group and radius_mm"),
        ({"group": "a"}, "mesh: not allowed with mesh_file, whose file is the mesh; remove it"),
    ],
)
def test_a_mesh_file_with_excess_or_missing_keys_is_refused(coarse_blade, root, line):
    source = {"file": "b.inp", "unit": "mm", "root": root, "tip": {"group": "b"}}
    values = coarse_blade.model_dump(exclude_unset=True, exclude={"sections"})
    with pytest.raises(SettingsError) as caught:
        check_settings(Blade, values | {"mesh_file": source}, "b.yaml")
    assert str(caught.value) == f"b.yaml: {line}"


@pytest.mark.parametrize("slip", ["4.43e-9", "4.43", "4.43e6", ".nan"])
def test_density_in_another_unit_says_which_is_meant(message, slip):
    """In t/mm3, g/cm3, g/m3."""
    (line,) = message("density_kg_m3: 4430", f"density_kg_m3: {slip}")
    assert line.startswith("material.density_kg_m3: ") and ": should be " in line
    assert line.endswith("; 1 g/cm3 is 1000 kg/m3, 1 t/mm3 is 1e12 kg/m3")


@pytest.mark.parametrize("slip", ["113800", "113.8e+9", "0.1138"])
def test_modulus_in_another_unit_says_which_is_meant(message, slip):
    """In MPa, Pa, TPa."""
    (line,) = message("young_modulus_GPa: 113.8", f"young_modulus_GPa: {slip}")
    bound = "greater than or equal to 1" if float(slip) < 1 else "less than or equal to 1000"
    assert line.startswith("material.young_modulus_GPa: ")
    assert line.endswith(f": should be {bound}; 1 MPa, or N/mm2, is 1e-3 GPa, 1 Pa is 1e-9 GPa")


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("max_speed_rad_s: 650", "max_speed_rad_s: true"),
        ("patches: 16", "patches: yes"),
        ("patches: 16", "points_mm: [[560, 1, on], [560, 0, 2]]"),
        ("density_kg_m3: 4430", "density_kg_m3: true"),
    ],
)
def test_a_boolean_is_no_number(message, old, new):
    (line,) = message(old, new)
    assert line.split(": ")[0].endswith(new.split(": ")[0])
    assert line.endswith("are booleans: give a number, or a name in quotes")


def test_numbers_are_read_as_yaml_and_people_write_them(tmp_path):
    """YAML 1.1 takes 4.43e3 for a text; a whole number stands for any."""
    path = tmp_path / "blade.yaml"
    path.write_text(REFERENCE.replace("4430", "4.43e3").replace("113.8", "114"))
    material = read_settings(Blade, path).material
    assert (material.density_kg_m3, material.young_modulus) == (4430, 114e9)


def test_two_faults_are_two_lines(message):
    lines = message("patches: 16\nmax_speed_rad_s: 650", "patches: 1\nmax_speed_rad_s: 0")
    assert [line.split(":")[0] for line in lines] == ["interface.patches", "max_speed_rad_s"]


PAPER = "max_speed_rad_s: 650\nbasis: {kind: paper}"
LISTED = "points_mm: [[562, 1, 1], [562, 0, 2]]"


@pytest.mark.parametrize("rule", ["nodes: 8", "along: pressure-side", LISTED])
def test_points_are_the_papers_basis_alone(message, rule):
    (line,) = message("patches: 16", rule)
    assert line == (
        f"interface.{rule.split(':')[0]}: only with `basis: {{kind: paper}}`, whose interface is "
        "of points; all others have interface.patches"
    )


def test_patches_are_not_the_papers_basis(message):
    assert message("max_speed_rad_s: 650", PAPER) == [
        "interface.patches: basis paper has points: give nodes and along, or points_mm"
    ]


@pytest.mark.parametrize(
    ("rule", "words"),
    [
        ("nodes: 8", None),
        ("nodes: 5\n  along: pressure-side", None),
        (LISTED, None),
        (f"nodes: 5\n  {LISTED}", "interface: needs either points_mm or nodes and along"),
    ],
)
def test_points_are_given_by_one_rule(tmp_path, rule, words):
    path = tmp_path / "blade.yaml"
    path.write_text(REFERENCE.replace("patches: 16", rule).replace("max_speed_rad_s: 650", PAPER))
    if words is None:
        assert read_settings(Blade, path).of_points
        return
    with pytest.raises(SettingsError) as caught:
        read_settings(Blade, path)
    assert str(caught.value) == f"{path}: {words} (line 19)"


def test_default_is_of_sixteen_patches(tmp_path):
    path = tmp_path / "blade.yaml"
    path.write_text(REFERENCE.replace("interface:\n  patches: 16\n", ""))
    blade = read_settings(Blade, path)
    assert blade.interface.patches == 16
    assert not blade.of_points


def test_the_settings_of_a_model_are_those_that_affect_it(coarse_blade, paper_blade):
    """Not the tolerance of its check, nor keys of points where there are patches."""
    of_matrices = coarse_blade.settings_of_matrices()
    assert set(of_matrices) == {"material", "prestress", "max_speed_rad_s", "interface"}
    assert of_matrices["interface"] == {"patches": 8}
    assert set(paper_blade.settings_of_matrices()["interface"]) == {"nodes", "along"}
    judged = coarse_blade.basis.model_copy(update={"tolerance_percent": 5.0})
    richer = coarse_blade.basis.model_copy(update={"natural_modes": 30})
    of_model = coarse_blade.settings_of_model()
    assert of_model["basis"]["natural_modes"] == 24
    for basis, same in ((judged, True), (richer, False)):
        other = coarse_blade.model_copy(update={"basis": basis})
        assert (other.settings_of_model() == of_model) is same
        assert other.settings_of_matrices() == of_matrices


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"sections: [1,\nmesh: }", "is not YAML: while parsing"),
        (b"\xff\xfe", "is no UTF-8 text (it is UTF-16): save it as UTF-8"),
        (b"mesh: 1\nmesh: 2", "is not YAML: key 'mesh' is given twice"),
        (b"- a\n- b", "holds no 'key: value' lines"),
        (b"", "holds no 'key: value' lines"),
    ],
)
def test_what_is_no_mapping_is_one_line(tmp_path, content, words):
    path = tmp_path / "blade.yaml"
    path.write_bytes(content)
    with pytest.raises(SettingsError) as caught:
        read_settings(Blade, path)
    assert str(caught.value).startswith(f"{path}: {words}")
    assert "\n" not in str(caught.value)


def test_missing_file_is_one_line(tmp_path):
    path = tmp_path / "none.yaml"
    with pytest.raises(SettingsError) as caught:
        read_settings(Blade, path)
    assert str(caught.value) == f"{path}: cannot be read (No such file or directory)"


def test_blade_in_metres_and_radians(coarse_blade):
    assert coarse_blade.sections.hub_radius == pytest.approx(0.4224)
    assert coarse_blade.sections.tip_radius == pytest.approx(0.5624)
    assert coarse_blade.material.young_modulus == pytest.approx(113.8e9)
    middle = profile_at(coarse_blade.sections, 0.4924)
    assert middle.stagger == pytest.approx(0.5759586531581288)  # 33 degrees


def test_settings_with_other_values_are_checked_again(coarse_blade):
    finer = coarse_blade.but(mesh__element_size_mm=3.0)
    assert finer.mesh.element_size_mm == 3.0
    assert finer.but(mesh__element_size_mm=coarse_blade.mesh.element_size_mm) == coarse_blade
    with pytest.raises(SettingsError, match=r"blade: mesh.element_size_mm: -1.0: should be"):
        coarse_blade.but(mesh__element_size_mm=-1.0)
    with pytest.raises(SettingsError, match="elemnt_size_mm: unknown key; did you mean 'element_s"):
        coarse_blade.but(mesh__elemnt_size_mm=1.0)
