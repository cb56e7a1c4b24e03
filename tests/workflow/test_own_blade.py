"""The page for a user's own blade, followed word by word; new files; what a result depends on."""

import csv
import json
import re
import shlex
from io import StringIO
from pathlib import Path
from types import SimpleNamespace

import gmsh
import pytest
from exports import parts, write_inp
from projects import ROOT, make_project
from refused import refused

from geometry.base import SettingsError, check_settings, read_json, yaml_file
from geometry.blade import Blade, Frame
from geometry.mesh import build_mesh
from geometry.sections import loft_parameters
from geometry.shape import session
from simulate.scene import Scene
from simulate.sweeps.peak import Peak
from workflow import check, new
from workflow.job_cost import cpu_seconds

PAGE = ROOT / "workflow/own-blade.md"
# the page's blade on the coarse mesh of the tests, its scenes with fewer and shorter runs
COARSE = {
    "mesh: {element_size_mm: 3.0}": "mesh: {element_size_mm: 10.0}\ninterface: {patches: 8}",
    "count: 80": "count: 14",
    "rounds: 100": "rounds: 30",
}


def steps():
    """Commands and files of the page, in its order."""
    for kind, body in re.findall(r"```(\w*)\n(.*?)```", PAGE.read_text(), re.DOTALL):
        if kind == "yaml":
            yield "file", body
        else:
            for line in body.splitlines():
                yield "command", line


@pytest.fixture(scope="module")
def followed(tmp_path_factory, coarse_blade, coarse_mesh):
    """The project after each step of the page, with what the terminal said."""
    project = make_project(tmp_path_factory.mktemp("own"))
    export(project.folder, coarse_blade, coarse_mesh)
    said, changed = {}, []
    for kind, body in steps():
        if kind == "file":
            path = re.match(r"# (\S+)", body)[1]
            assert (project.folder / path).is_file()  # written by ./run new
            (project.folder / path).write_text(body)
        else:
            said[body] = run(project, shlex.split(body))
        for file in (project.folder / "workflow").glob("*/*.yaml"):
            if file.stem in ("mine", "rub", "rub-meshed"):
                changed += made_coarse(file)
    assert {*changed} == {*COARSE}
    return project.folder, said


def made_coarse(file):
    """What is coarser now in a file of the page."""
    text = file.read_text()
    found = [old for old in COARSE if old in text]
    for old in found:
        text = text.replace(old, COARSE[old])
    file.write_text(text)
    return found


def export(folder, blade, mesh):
    """The reference blade as ``blade.step`` and ``mesh.inp``, in mm."""
    with session("test"):
        gmsh.option.setString("Geometry.OCCTargetUnit", "M")
        loft_parameters(blade.sections)
        gmsh.write(str(folder / "blade.step"))
    write_inp(folder / "mesh.inp", *parts(mesh.mesh))


def run(project, words):
    """What a command of the page says; it stands in for `./run`."""
    assert words[0] == "./run"
    modules = {"snakemake": ["snakemake", "--cores", "2"], "check": ["workflow.check"]}
    modules["new"] = ["workflow.new", str(project.folder)]
    return project.call(*modules[words[1]], *words[2:])


@pytest.mark.slow
def test_the_page_leads_to_a_summary(followed):
    folder, said = followed
    of_step, of_inp = (text for line, text in said.items() if "--config" in line)
    assert "Design speed 5600 rpm" in of_step and "Summary: results/summary.md" in of_step
    assert "Not in this summary, but with results: rub. " in of_inp and "Not in" not in of_step
    assert "Not known: error of the mesh" in of_inp  # a mesh of another program
    rows = list(csv.DictReader(StringIO((folder / "results/summary.csv").read_text())))
    assert {row["scene"] for row in rows} == {"rub-meshed"}
    assert all(float(row["force (N)"]) > 0 for row in rows)
    for name in ("mine/rub", "meshed/rub-meshed"):
        assert (folder / f"results/{name}/explore.html").is_file()
        answers = read_json(folder / f"results/{name}/answers.json")
        assert all(peak["verdict"] for peak in answers["peaks"])


@pytest.mark.slow
def test_the_check_says_its_cost_and_what_each_change_does(followed):
    folder, said = followed
    told = said["./run check rub"]
    assert re.search(r"rub: \d+ speeds, 8 changes: some .* on one core", told)
    table = (folder / "results/mine/rub/check.md").read_text()
    names = ("as it is", "half the step", "twice the strips", "twice the patches", "finer")
    assert all(name in table and name in told for name in names)
    assert re.search(r"twice the strips \| [+-][\d.e-]+%", table)


def test_the_table_of_a_check_has_units_of_engines_and_changes_in_percent():
    """Over the own number; without columns that no peak has; a change that was refused says why."""
    rom = SimpleNamespace(f1=200.0)
    mine = check.Subject("mine", Path("x"), None, None, rom, None, [Peak(4, 0, 0.35)])
    found = {
        "as it is": [{"amplitude": 4e-5, "force": 0.0}],
        "twice": [{"amplitude": 1e-4, "force": 1.0}],
        "four times": [{"amplitude": 4e-5 * (1 - 1e-6), "force": 0.0}],
        "half": [{}],
        "finer": "interface.patches: too many",
    }
    rows = check.table(mine, found).splitlines()[2:]
    own, *changed, refusal = [[cell.strip() for cell in row[1:-1].split("|")] for row in rows]
    assert own == ["EO 4, 4200 rpm", "as it is", "40", "0"]
    assert [row[2:] for row in changed] == [["+150%", "-"], ["-0%", "-"], ["no result"] * 2]
    assert refusal[1:3] == ["finer", "interface.patches: too many"]


def test_the_time_of_a_job_is_what_its_log_says(tmp_path):
    log = tmp_path / "reduce-r.log"
    assert cpu_seconds(log) == 0.0
    log.write_text("as an older version wrote it\n")
    assert cpu_seconds(log) == 0.0
    log.write_text("used 15.25 s of CPU, 300 MB at most\n")
    assert cpu_seconds(log) == 15.25


@pytest.fixture
def project(tmp_path, monkeypatch):
    """A folder with the blades and scenes of the project."""
    for folder in new.FOLDERS.values():
        (tmp_path / folder).mkdir(parents=True)
        for file in (ROOT / folder).glob("reference.yaml"):
            (tmp_path / folder / file.name).write_text(file.read_text())
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.parametrize(
    ("file", "source"),
    [("a.brep", "cad"), ("a.csv", "section_table"), (None, "sections")],
)
def test_a_new_blade_is_one_and_has_its_file_beside_it(project, file, source):
    if file:
        (project / "elsewhere").mkdir()
        (project / "elsewhere" / file).write_text("the file")
    path = new.new("blade", "mine", file, project / "elsewhere")
    blade = Blade.load(path)
    assert blade.source_key == source
    assert not file or (path.parent / blade.source.file).read_text() == "the file"


def test_a_new_scene_is_one_of_its_blade(project):
    new.new("blade", "mine")
    path = new.new("scene", "rub", "mine")
    scene = Scene.load(path)
    assert (scene.blade, scene.speeds.count) == ("mine", 80)
    highest = Blade.load("workflow/blades/mine.yaml").top_speed
    assert scene.speeds.omega(1.0).max() < highest


MATRICES = """
full_matrices: {M: M.mtx, K: {"0": K.mtx}, nodes: nodes.csv, tip: tip.csv, hub_radius_mm: 400}
max_speed_rad_s: 400
"""


def test_the_next_command_explores_a_blade_with_a_mesh_alone(project, capsys):
    (project / "workflow/blades/given.yaml").write_text(MATRICES)
    for name, blade in (("whole", []), ("matrices", ["given"])):
        assert new.main(["scene", name, *blade]) == 0
        explored = f" 'explore=[{name}]'" if name == "whole" else ""
        command = f"./run snakemake --config 'scenes=[{name}]'{explored}\n"
        assert capsys.readouterr().out.endswith(command)


def test_the_first_line_leads_an_editor_to_the_schema(project):
    for kind in new.FOLDERS:
        path = new.new(kind, "mine", "mine" if kind == "experiment" else None)
        first = path.read_text().splitlines()[0]
        relative = first.removeprefix("# yaml-language-server: $schema=")
        schema = json.loads((path.parent / relative).read_text())
        values = yaml_file.read_mapping(path)
        assert {*values} <= {*schema["properties"]}
        assert schema["properties"].keys() - new.MODELS[kind].model_fields.keys() == {"base"}
        check_settings(new.MODELS[kind], values, "it")
        # a file with a base needs none of the keys
        assert {"required": ["base"]} in schema["anyOf"]
        assert not any("required" in of for of in schema["$defs"].values())


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("blade", "reference"), ("workflow/blades/reference.yaml", "exists", "choose another")),
        (("scene", "s", "none"), ("", "", "none: no workflow/blades/none.yaml: ./run new bl")),
        (("experiment", "e", "none"), ("", "", "none: no workflow/scenes/none.yaml: ./run new sc")),
        (("blade", "b", "none.step"), ("none.step", "", "no such file")),
        (("blade", "b", "a.xyz"), ("a.xyz", "", "unknown kind of file: allowed .step, ")),
        (("blade", "A b"), ("", "", "'A b': a name has letters, digits, - and _")),
    ],
)
def test_what_new_refuses(project, arguments, said):
    (project / "a.xyz").write_text("")
    file, key, text = said
    error = refused(SettingsError, new.new, *arguments)
    assert (error.file, error.key, error.text[: len(text)]) == (file, key, text)
    assert not (project / "workflow/blades/b.yaml").exists()


def test_new_says_what_a_mesh_holds_in_its_own_axes_and_writes_it(project, capsys, coarse_mesh):
    """Axes, in which a blade can be a compressor's, groups, material, patches; left are two lines.

    The engine axis is -x of the file, the radius along -y.
    """
    points, *others = parts(coarse_mesh.mesh)  # mm
    turned = points[:, [2, 0, 1]] * [-1, -1, 1]
    material = "*MATERIAL, NAME=S\n*ELASTIC\n2.1E5, 0.3\n*DENSITY\n7.85E-9\n"
    write_inp(project / "a.inp", turned, *others)
    with (project / "a.inp").open("a") as file:
        file.write(material + "*SOLID SECTION, ELSET=EALL, MATERIAL=S\n")
    capsys.readouterr()  # of the reader of the mesh
    assert new.main(["blade", "mine", "a.inp"], project) == 0
    cells, box, axes, groups, *_ = capsys.readouterr().out.splitlines()
    assert cells == f"{len(others[0])} tetrahedra on {len(points)} nodes"
    z = turned[:, 2]
    assert box.endswith(f", z {z.min():.5g} to {z.max():.5g}")
    assert axes == "radial -y (assumed: farthest from 0)"
    assert re.fullmatch(r"groups: NALL .*, ROOT \(\d+ nodes\), TIP \(\d+ nodes\)", groups)
    text = _text("mine")
    blade = Blade.load("workflow/blades/mine.yaml")
    assert (blade.source.unit, blade.source.root.group) == ("mm", "ROOT")
    assert blade.source.frame == Frame(downstream="-x", radial="-y")
    assert (blade.material.young_modulus_GPa, blade.material.density_kg_m3) == (210, 7850)
    assert [line for line in text.splitlines() if "<--" in line] == [
        line for line in text.splitlines() if line.startswith("max_speed_rpm")
    ]
    tip = re.search(r"tip: radius (.*) mm, chord (.*) mm, along the rotation (.*) mm wide", text)
    assert [*map(float, tip.groups())] == pytest.approx([562.4, 60, 2.9], rel=0.07)
    assert Path("results/mine/look.png").stat().st_size > 10_000
    summary = build_mesh(blade, project / "blade.msh", "workflow/blades/a.inp")
    assert summary.mass == pytest.approx(coarse_mesh.summary.mass * 7850 / 4430, rel=1e-6)


def test_new_says_what_a_step_file_holds_and_writes_it(project, capsys, coarse_blade, coarse_mesh):
    """As it stands: unit, axes, radii and the size of elements are the blade's own."""
    export(project, coarse_blade, coarse_mesh)
    capsys.readouterr()  # of the CAD library
    assert new.main(["blade", "mine", "blade.step"], project) == 0
    unit, box, axes, _ = capsys.readouterr().out.splitlines()
    sections = coarse_blade.sections
    assert unit == "unit mm"
    # of corners: within the sagitta of the tip's end
    tip = pytest.approx(1e3 * sections.tip_radius, rel=1e-3)
    assert float(re.search(r"box x \S+ to (\S+),", box)[1]) == tip
    assert axes.startswith("radial x (assumed")
    blade = Blade.load("workflow/blades/mine.yaml")
    assert blade.source.frame == Frame() and blade.source.unit == "mm"
    # a hundredth of the span from its ends
    assert blade.source.root.radius_mm == pytest.approx(sections.hub_radius_mm + 1.4, abs=0.1)
    assert blade.source.tip.radius_mm == pytest.approx(1e3 * sections.tip_radius - 1.4, abs=0.1)
    assert blade.mesh.element_size_mm == pytest.approx(3.1, rel=0.05)  # the mean thickness
    given = "material: {young_modulus_GPa: 113.8"
    marked = [line for line in _text("mine").splitlines() if "<--" in line]
    assert [line.startswith((given, "max_speed_rpm")) for line in marked] == [True, True]


def _text(name):
    return Path(f"workflow/blades/{name}.yaml").read_text()


def test_a_blade_of_two_materials_is_said_to_be_one(project, capsys, coarse_mesh):
    write_inp(project / "a.inp", *parts(coarse_mesh.mesh))
    with (project / "a.inp").open("a") as file:
        file.write("*ELEMENT, TYPE=MASS, ELSET=M\n9000, 5\n*MASS, ELSET=M\n2e-7\n")
    assert new.main(["blade", "mine", "a.inp"], project) == 0
    assert "not read: " in (told := capsys.readouterr().out) and "full_matrices" in told
    assert "<-- unit" in _text("mine")


def test_a_file_that_cannot_be_read_makes_no_new_blade(project, capsys):
    (project / "a.inp").write_text("*NODE\n1, 0, 0\n")
    assert new.main(["blade", "mine", "a.inp"], project) == 2
    assert capsys.readouterr().err.startswith(f"{project / 'a.inp'}: ")
    assert not (project / "workflow/blades/mine.yaml").exists()
