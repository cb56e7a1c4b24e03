"""What others send runs no code, and its names are shown as text."""

import json
import os
import pickle
import random
import re
import shutil
import subprocess
import sys
from contextlib import suppress
from pathlib import Path

import gmsh
import meshio
import numba
import numpy as np
import pytest
import xarray as xr
from matplotlib.mathtext import MathTextParser
from own_law import LAW

from fem.solid import read_solid
from geometry.base import (
    ROOT,
    ProvenanceError,
    SettingsError,
    UserError,
    check_settings,
    seal,
)
from geometry.blade import Blade
from geometry.mesh import build_mesh
from geometry.shape import session
from simulate import Runs, Scene, sweep
from simulate.contact import kernel_file
from simulate.contact.compiled import compiled_kernel
from simulate.marching import SceneError
from simulate.scene.own_laws import Unread
from simulate.sweeps import dataset
from workflow import markdown
from workflow.figures.response import liner_and_tip

SCENE = """
blade: coarse
speeds: {over_f1: [0.3]}
rounds: 2
verify: {share: 0}
integrator: {scheme: piecewise-exact, steps_per_round: 640}
damping_ratio: 0.005
clearance: {leading_edge_over_span: 1.5e-4, trailing_edge_over_span: 4.3e-4}
casing: {ramp_rounds: 0.1, harmonics: [{order: 2, amplitude_gaps: 2.0}]}
liner:
  {law: {kind: "foam:Foam", E: 2.0e+9, sigma_Y: 1.0e+6}, thickness_mm: 5,
   strips: 8, footprint_mm: 5, rods_per_round: 512}
record: {samples_per_round: 64, spectrum_rounds: 1, end: true, wear: true}
"""
MINE = ("foam", "helper", "evil", "between", "parts", "space", "wave")  # modules of the tests


@pytest.fixture
def trap(tmp_path):
    """A path that hostile code would make."""
    path = tmp_path / "trapped"
    yield path
    assert not path.exists()


@pytest.fixture
def mine(tmp_path, monkeypatch):
    """A folder with a law of one's own, and a scene."""
    folder = tmp_path / "mine"
    (folder / "workflow/laws").mkdir(parents=True)
    (folder / "workflow/laws/foam.py").write_text(LAW)
    (folder / "scene.yaml").write_text(SCENE)
    monkeypatch.chdir(folder)
    for name in MINE:
        monkeypatch.delitem(sys.modules, name, raising=False)
    return folder


def script(path: Path) -> str:
    return f'SystemCall "touch {path}";\n'


@pytest.mark.parametrize("head", ["", "$Comments\nby gmsh\n$EndComments\n", "\n"])
def test_a_mesh_without_its_head_is_no_script(tmp_path, trap, head, coarse_blade):
    """gmsh itself would run it, sealed as it is."""
    mesh = tmp_path / "blade.msh"
    mesh.write_text(head + script(trap))
    seal(mesh)
    with pytest.raises(ProvenanceError, match="is no mesh of gmsh; make it anew"):
        read_solid(str(mesh), coarse_blade.material)


def test_the_options_of_gmsh_are_not_read(tmp_path, trap, monkeypatch):
    """Its own file at home, or where others may write without a home."""
    (tmp_path / ".gmshrc").write_text(script(trap))
    (tmp_path / ".gmsh-options").write_text("Mesh.MeshSizeFactor = 3;\n")
    monkeypatch.setenv("HOME", str(tmp_path))
    with session("-"):
        assert gmsh.option.getNumber("Mesh.MeshSizeFactor") == 1.0


def test_the_options_beside_a_mesh_are_not_run(tmp_path, trap, coarse_files, coarse_blade):
    mesh = Path(shutil.copy(coarse_files.mesh, tmp_path / "blade.msh"))
    (tmp_path / "blade.msh.opt").write_text(script(trap))
    assert read_solid(str(mesh), coarse_blade.material).tip.size


class Hostile:
    """A pickle that makes a folder."""

    def __init__(self, path):
        self.path = path

    def __reduce__(self):
        return os.mkdir, (str(self.path),)


@compiled_kernel
def doubled(value):
    return 2.0 * value


def another_user(folder, file, monkeypatch):
    monkeypatch.setattr(os, "geteuid", lambda: os.getuid() + 1)


def written_by_a_group(folder, file, monkeypatch):
    file.chmod(0o620)


def behind_a_link(folder, file, monkeypatch):
    file.rename(folder / "other")
    file.symlink_to(folder / "other")


@pytest.mark.parametrize("forgery", [another_user, written_by_a_group, behind_a_link])
def test_a_kernel_of_another_user_is_compiled_anew(tmp_path, monkeypatch, trap, forgery):
    folder, types = tmp_path / "kernels", (numba.float64,)
    monkeypatch.setattr(kernel_file, "FOLDER", folder)
    compiled = kernel_file.kernel.__wrapped__
    folder.mkdir(mode=0o755)
    assert compiled(doubled, types)(2.0) == 4.0
    (file,) = folder.glob("*.kernel")
    assert (folder.stat().st_mode & 0o777, file.stat().st_mode & 0o777) == (0o700, 0o600)
    file.write_bytes(pickle.dumps(Hostile(trap)))
    seal(file)
    forgery(folder, file, monkeypatch)
    assert compiled(doubled, types)(2.0) == 4.0


def test_a_law_is_found_in_the_project_and_known_by_its_code(mine, coarse_rom):
    scene = Scene.load("scene.yaml")
    first = sweep(scene, coarse_rom)
    law = scene.model_dump()["liner"]["law"]
    assert law == {
        "kind": "foam:Foam",
        "hash": type(scene.liner.law).code_hash,
        "E": 2e9,
        "sigma_Y": 1e6,
    }
    assert Scene.model_validate_json(first.dataset.attrs["scene"]) == scene
    first.save("first.nc")
    then = scene.but(start={"scene": "first"})
    assert sweep(then, coarse_rom, first).status.item() == "ok"


def test_no_run_goes_on_from_a_result_of_another_code(mine, coarse_rom):
    """Yield times 30, in a file of the same size and time, for which Python keeps its bytecode."""
    scene = Scene.load("scene.yaml")
    first = sweep(scene, coarse_rom)
    first.save("first.nc")
    file, was = mine / "workflow/laws/foam.py", os.stat("workflow/laws/foam.py")
    file.write_text(LAW.replace("1.0 *", "30. *"))
    os.utime(file, ns=(was.st_atime_ns, was.st_mtime_ns))
    del sys.modules["foam"]  # as in another process
    other = Scene.load("scene.yaml")
    assert sweep(other, coarse_rom).wear.max() < 0.5 * first.wear.max()
    before = Runs.load("first.nc", coarse_rom)
    assert "foam:Foam" in str(before.scene.liner.law.called) and before.peaks() is not None
    assert isinstance(before.scene.liner.law, Unread) and "ok: 1" in repr(before)
    then = other.but(start={"scene": "first"})
    with pytest.raises(
        SceneError, match=r"^start\.scene: 'first': .*its code has the hash .* run the"
    ):
        sweep(then, coarse_rom, before)
    with pytest.raises(SceneError, match=r"^liner\.law: kind: .*its code has the hash"):
        sweep(before.scene, coarse_rom)
    with pytest.raises(SettingsError, match=r"^liner\.law\.kind: .*its code has the hash"):
        check_settings(Scene, json.loads(first.dataset.attrs["scene"]), "")


def test_a_result_imports_nothing(mine, tmp_path, trap, coarse_rom, monkeypatch):
    """Of a module that Python would find: its numbers are read, and no run is made."""
    first = sweep(Scene.load("scene.yaml"), coarse_rom)
    text = first.dataset.attrs["scene"].replace("foam:Foam", "evil:Foam")
    first.dataset.assign_attrs(scene=text).pipe(dataset.save, "sent.nc")
    (tmp_path / "evil.py").write_text(f"import os\nos.mkdir({str(trap)!r})\n")
    monkeypatch.syspath_prepend(str(tmp_path))
    sent = Runs.load("sent.nc", coarse_rom)
    assert sent.scene.liner.law.called == "evil:Foam" and sent.peaks() is not None
    with pytest.raises(
        SceneError, match=r"liner\.law: kind: 'evil:Foam': no such law: put the class Foam"
    ):
        sweep(sent.scene, coarse_rom)
    with pytest.raises(
        SettingsError, match=r"liner\.law\.kind: 'evil:Foam': no such law: put the class Foam"
    ):
        Scene.load("scene.yaml").but(liner={"law": {"kind": "evil:Foam", "E": 1.0}})
    assert "evil" not in sys.modules


@pytest.mark.slow
def test_the_command_line_takes_the_file_of_a_law(mine, coarse_rom, tmp_path):
    (mine / "workflow/laws/foam.py").rename(tmp_path / "foam.py")
    coarse_rom.save("rom-r.nc")
    command = [sys.executable, "-m", "simulate", "rom-r.nc", "scene.yaml", "-o", "out.nc"]
    environment = os.environ | {"PYTHONPATH": str(ROOT)}

    def run(*more):
        return subprocess.run([*command, *more], env=environment, capture_output=True, text=True)

    refused = run()
    assert refused.returncode == 2 and "no such law: put the class Foam" in refused.stderr
    assert refused.stderr.count("\n") == 1
    refused = run("--law", "none.py")
    assert refused.stderr.startswith("none.py: cannot be imported (FileNotFoundError")
    assert refused.stderr.count("\n") == 1
    assert run("--law", str(tmp_path / "foam.py")).returncode == 0
    assert xr.open_dataset("out.nc").attrs["scene"].count('"kind":"foam:Foam","hash":"') == 1


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("1 / 0", "cannot be imported (ZeroDivisionError: 'division by zero')"),
        ("raise SystemExit('bye')", "cannot be imported (SystemExit: 'bye')"),
        ("def", "cannot be imported (SyntaxError: "),
        ("import nowhere", "cannot be imported (ModuleNotFoundError: "),
        ("raise ValueError('\x1b[2K\\n')", "cannot be imported (ValueError: '\\x1b[2K\\n')"),
    ],
)
def test_a_law_that_cannot_be_imported_is_one_line(mine, text, said):
    (mine / "workflow/laws/foam.py").write_text(text)
    with pytest.raises(SettingsError) as caught:
        Scene.load("scene.yaml")
    assert f"liner.law: workflow/laws/foam.py: {said}" in str(caught.value)
    assert str(caught.value).isprintable()


@pytest.mark.parametrize(
    "imports",
    [
        "from helper import A",
        "def f():\n    import helper",
        "import between",  # which imports it
        "def f():\n    from parts import inner",
        "def f():\n    from parts.inner import (\n        A,\n    )",
        "import space.far.inner",  # in folders that are no packages
    ],
)
def test_the_hash_of_a_law_is_of_all_that_it_imports_of_its_folder(mine, monkeypatch, imports):
    folder, hashes = mine / "workflow/laws", []
    (folder / "parts").mkdir()
    (folder / "parts/__init__.py").touch()
    (folder / "foam.py").write_text(f"{imports}\n{LAW}")
    (folder / "between.py").write_text("from helper import A")
    (folder / "space/far").mkdir(parents=True)
    (folder / "dangling.py").symlink_to("nowhere.py")
    for number, other in (("1.0", 1), ("2.0", 1), ("2.0", 2)):
        for file in ("helper.py", "parts/inner.py", "space/far/inner.py"):
            (folder / file).write_text(f"A = {number}")
        (folder / "other.py").write_text(f"A = {other}")  # which it does not import
        for name in [name for name in sys.modules if name.partition(".")[0] in MINE]:
            monkeypatch.delitem(sys.modules, name)
        hashes.append(type(Scene.load("scene.yaml").liner.law).code_hash)
    assert hashes[0] != hashes[1] == hashes[2]


def test_the_hash_is_of_the_helper_that_runs(mine, monkeypatch, tmp_path):
    """Not of another one of its name: here one before the law's own folder on Python's path."""
    law = LAW.replace("from simulate import Law", "from helper import A\nfrom simulate import Law")
    (mine / "workflow/laws/foam.py").write_text(law)
    (mine / "workflow/laws/helper.py").write_text("A = 1.0")
    (tmp_path / "helper.py").write_text("A = 5.0")
    monkeypatch.syspath_prepend(str(tmp_path))
    files = type(Scene.load("scene.yaml").liner.law).code_files
    assert [*files] == [str(mine / "workflow/laws/foam.py"), str(tmp_path / "helper.py")]


def test_a_law_that_is_edited_under_a_running_python_is_refused(mine):
    scene = Scene.load("scene.yaml")
    (mine / "workflow/laws/foam.py").write_text(LAW.replace("1.0 *", "2.0 *"))
    said = "'foam:Foam': edited since it was imported: start Python anew"
    for read in (lambda: Scene.load("scene.yaml"), lambda: scene.but(rounds=3)):
        with pytest.raises(SettingsError, match=said):
            read()


def test_no_run_goes_on_from_a_result_without_a_hash(mine, coarse_rom):
    """Of an older version; a law without a file has the hash of its bytecode."""
    scene = Scene.load("scene.yaml")
    first = sweep(scene, coarse_rom).dataset
    values = json.loads(first.attrs["scene"])
    del values["liner"]["law"]["hash"]
    older = Runs(first.assign_attrs(scene=json.dumps(values)), coarse_rom)
    with pytest.raises(SceneError, match="not 'of no code': it was changed"):
        sweep(scene.but(start={"scene": "first"}), coarse_rom, older)
    laws = []
    for factor in ("1.0", "2.0"):
        interactive = {"__name__": "nowhere"}
        exec(LAW.replace("1.0 *", f"{factor} *").replace("> 0.0", "> 0"), interactive)
        laws.append(interactive["Foam"])
    assert laws[0].code_hash != laws[1].code_hash and not laws[0].code_files


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("time", "cannot be imported"),
        ("sys", "cannot be imported"),
        ("json", "cannot be imported"),
        ("wave", r"wave\.py: cannot be imported \(ImportError: 'its name"),
    ],
)
def test_a_law_of_the_name_of_a_module_of_python_is_refused(mine, name, said):
    """Of one that is imported, and of one that is not: it is not taken for the law."""
    (mine / f"workflow/laws/{name}.py").write_text(LAW)
    (mine / "scene.yaml").write_text(SCENE.replace("foam:", f"{name}:"))
    with pytest.raises(SettingsError, match=said) as caught:
        Scene.load("scene.yaml")
    assert in_lines(caught.value) and "wave" not in sys.modules


@pytest.mark.parametrize("kind", ["foam:Law", "foam:Plastic"])
def test_laws_of_tiprub_are_named_as_such(mine, kind):
    text = f"from simulate.scene.laws.plastic import Plastic\n{LAW}"
    (mine / "workflow/laws/foam.py").write_text(text)
    (mine / "scene.yaml").write_text(SCENE.replace("foam:Foam", kind))
    with pytest.raises(SettingsError, match="no such law"):
        Scene.load("scene.yaml")


PIECES = [
    *("os", "system", "foam", "Foam", "simulate", "Law", "__main__", "sys.modules", "plastic"),
    *(
        ":",
        "::",
        ".",
        "..",
        "/",
        "\\",
        " ",
        "",
        "\n",
        "\r",
        "\x00",
        "\x07",
        "\x1b[2K",
        "\x1b]0;x\x07",
    ),
    *("\u202e", "\u2028", "\ud800", "é", "π", "<img src=x onerror=alert(1)>", "</script>", "&lt;"),
    *(
        "$x$",
        "{}",
        "{0}",
        "%s",
        "`id`",
        "$(id)",
        "|",
        '"',
        "'",
        "#",
        "a" * 300,
        "-1",
        "None",
        "null",
    ),
]


def odd_names(count: int, seed: int) -> list[str]:
    """Names of one to four pieces."""
    draw = random.Random(seed)
    return ["".join(draw.choices(PIECES, k=draw.randint(1, 4))) for _ in range(count)]


def in_lines(error: BaseException) -> bool:
    return isinstance(error, UserError) and all(map(str.isprintable, str(error).split("\n")))


def test_odd_names_of_laws_and_schemes_are_refused_in_lines(mine, trap):
    values, before = Scene.load("scene.yaml").model_dump(), {*sys.modules}
    for name in odd_names(250, 1):
        odd = {
            "liner": values["liner"] | {"law": {"kind": name, "E": 2e9, "sigma_Y": 1e6}},
            "integrator": {"scheme": name},
        }
        for key, value in odd.items():
            with pytest.raises(SettingsError) as caught:
                check_settings(Scene, values | {key: value}, "scene.yaml")
            assert in_lines(caught.value), name
    assert {*sys.modules} == before


@pytest.mark.parametrize(
    "suffix", [".msh", *(pytest.param(of, marks=pytest.mark.nightly) for of in (".inp", ".vtu"))]
)
def test_odd_names_of_groups_are_shown_in_lines(tmp_path, suffix, coarse_files, coarse_blade):
    """Of a mesh file that is refused, as far as meshio writes them, and of the group asked for."""
    values, tried = coarse_blade.model_dump(exclude_unset=True), 0
    del values["sections"], values["mesh"]
    of_ours = meshio.read(coarse_files.mesh)
    cells = [("tetra10", of_ours.cells_dict["tetra10"])]
    for number, name in enumerate(odd_names(100, 2)):
        path = tmp_path / f"{number}{suffix}"
        mesh = meshio.Mesh(of_ours.points, cells, cell_sets={name: [np.arange(3)]})
        with suppress(Exception):
            meshio.write(path, mesh, file_format="gmsh" if suffix == ".msh" else None)
        tried += path.exists()
        faces = {"root": {"group": name[::-1] or "x"}, "tip": {"group": "t"}}
        mesh_file = {"file": path.name, "unit": "m", **faces}
        with pytest.raises(UserError) as caught:
            blade = check_settings(Blade, values | {"mesh_file": mesh_file}, "blade.yaml")
            build_mesh(blade, tmp_path / "out.msh", path)
        assert in_lines(caught.value), name
    assert tried >= 50


def test_names_are_text_in_errors():
    error = UserError("no tip in 'a\x1b]0;x\x07'", key="root.group", file="b\n\u202e.msh")
    assert str(error) == r"b\n\u202e.msh: root.group: no tip in 'a\x1b]0;x\x07'"


def test_names_are_text_in_tables_of_markdown():
    shown = markdown.table(["<b>", "a|b"], [["</td>", "\x1b[2K\n| x |"], ["<= 1 %", 1.0]])
    assert (
        shown.count("\n") == 3 and "\x1b" not in shown and "<b" not in shown and "</" not in shown
    )
    assert "| <= 1 % | 1.0 |" in shown and r"a\|b" in shown


def test_names_are_text_on_the_page():
    """The page's own function, in Node; and nothing else enters its tables."""
    page = (ROOT / "workflow/explore/page.js").read_text()
    (function,) = re.findall(r"^const text = .*$", page, re.MULTILINE)
    tables = re.findall(r"<t[hd]>\$\{([^}]*)\}|<li>\$\{([^}]*)\}|<\$\{kind\}>\$\{([^}]*)\}", page)
    assert len(tables) == 4 and all("".join(of).startswith("text(") for of in tables)
    if not shutil.which("node"):
        pytest.skip("no Node on PATH: the function was not called")
    called = f"{function}\nconsole.log(text('<img src=x onerror=\"alert(1)\">&lt;'), text(1.5))"
    said = subprocess.run(["node", "-e", called], capture_output=True, text=True).stdout
    assert said == '&#60;img src=x onerror="alert(1)"&#62;&#38;lt; 1.5\n'


@pytest.mark.parametrize(
    "scene", ["{}", "[]", '{"liner": 1}', '{"liner": {"law": {"kind": "$:"}}}']
)
def test_a_result_of_another_scene_is_refused(scene):
    with pytest.raises(
        ProvenanceError, match="its scene is none that this version knows"
    ) as caught:
        dataset.scene_of(xr.Dataset(attrs={"scene": scene}))
    assert in_lines(caught.value)


@pytest.mark.parametrize("of", ["foam:Foam", "evil:Foam"])
def test_figures_name_a_law_of_ones_own_and_of_a_result(mine, of):
    """Its numbers by their names, be they no formulas of matplotlib."""
    values = {"scene": Scene.load("scene.yaml").model_dump(mode="json")}
    law = {"kind": of, "E": 2e9, "sigma_Y": 1e6}
    if of.startswith("evil"):
        law |= {r"$\x{": 1.0, "text": "$", "hash": "0" * 16}
    values["scene"]["liner"]["law"] = law
    read = dataset.scene_of(xr.Dataset(attrs={"scene": json.dumps(values["scene"])}))
    label = liner_and_tip(read)
    expected = rf"{of}, $E$ = 2e+09, $\sigma_Y$ = 1e+06"
    assert label == expected + (r", \$\x{ = 1" if of.startswith("evil") else "")
    MathTextParser("agg").parse(label)
