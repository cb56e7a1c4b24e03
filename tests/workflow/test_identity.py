"""Files of users are known by their bytes: what read others reruns, whatever their time stamps."""

import os
import re
import shutil
import time
from contextlib import closing, nullcontext
from pathlib import Path

import meshio
import own_law
import pytest
import yaml
from projects import ROOT, Project, make_project

from fem.assemble import assemble
from geometry.base import (
    ProvenanceError,
    SettingsError,
    contents,
    file_hash,
    hashes,
    unchanged,
)
from geometry.elsewhere import read_blade
from geometry.mesh import build_mesh, write_moved
from geometry.shape import source_of
from workflow.at_work import ANOTHER, hold

LAW = "from math import sqrt\nfrom helper import PORES\n" + own_law.LAW.replace("1.0 *", "PORES *")
OF_MESH = {"unit": "mm", "root": {"group": "ROOT"}, "tip": {"group": "TIP"}}
MATRICES = {"M": "M.mtx", "K": {"0": "K0.mtx"}, "nodes": "x.csv", "tip": "tip.csv"}
BLADES = {  # that differ from the reference blade
    "table": {"section_table": {"file": "a.csv", "unit": "mm", "edge_cut_percent": 1}},
    "step": {"cad": {"file": "a.step", **OF_MESH}},
    "running": {"cad": {"file": "b.step", **OF_MESH}, "geometry_at_rpm": 5000},
    "meshed": {"mesh": None, "mesh_file": {"file": "a.cdb", **OF_MESH}},
}
CURVE = "workflow/scenes/curve.csv"
LINER = {"kind": "table", "E": 1.0, "unit_MPa": 1640}
SCENES = {  # that differ from the scene of the model from elsewhere
    "own-law": {"liner": {"law": {"kind": "foam:Foam", "E": 1e9, "sigma_Y": 1e6}}},
    "curved": {"liner": {"law": LINER | {"curve": CURVE}}},
    "bumps": {"casing": {"harmonics": None, "table": "workflow/scenes/casing.csv"}},
    "rows": {"design": "rows.csv", "peaks": None, "liner": {"law": LINER | {"curve": CURVE}}},
    "laws": {"design": "laws.csv", "peaks": None},
}
FILES = {  # of the user, with the output whose job reads it
    "workflow/blades/a.csv": "results/table/blade.msh",
    "workflow/blades/a.step": "results/step/blade.msh",
    "workflow/blades/b.step": "results/running/blade.msh",
    "workflow/blades/a.cdb": "results/meshed/blade.msh",
    "workflow/blades/M.mtx": "results/matrices/matrices.h5",
    "workflow/blades/K0.mtx": "results/matrices/matrices.h5",
    "workflow/blades/x.csv": "results/matrices/matrices.h5",
    "workflow/blades/tip.csv": "results/matrices/matrices.h5",
    "workflow/blades/foreign.nc": "results/foreign/rom-r.nc",
    "workflow/laws/foam.py": "results/foreign/own-law/block-0.nc",
    "workflow/laws/helper.py": "results/foreign/own-law/block-0.nc",
    "workflow/laws/row.py": "results/foreign/laws/design-block-0.json",
    "workflow/scenes/curve.csv": "results/foreign/curved/block-0.nc",
    "workflow/scenes/casing.csv": "results/foreign/bumps/block-0.nc",
    "workflow/scenes/rows.csv": "results/foreign/rows/design-block-0.json",
    "workflow/scenes/of-row.csv": "results/foreign/rows/design-block-0.json",
    "workflow/scenes/laws.csv": "results/foreign/laws/design-block-0.json",
    "workflow/scenes/within.csv": "results/foreign/laws/design-block-0.json",
}
BY_DAY = "a.step", "M.mtx", "foreign.nc", "helper.py", "rows.csv"  # one of each kind
NO_JOB = """
from pathlib import Path

for file in snakemake.output:
    Path(file).touch()
"""
OUTPUTS = sorted(set(FILES.values()))


def texts(digit: str) -> dict[str, str]:
    """Texts of all files, which differ in a digit."""
    read = {path: f"{digit} mm, which no plan reads" for path in FILES}
    curve = f"strain,stress_MPa\n0,0\n0.1,{digit}\n0.5,20\n"
    row = LAW.replace("from helper import PORES", f"PORES = 0.{digit}")
    return read | {
        "workflow/laws/foam.py": LAW.replace("sqrt", f"sqrt as root_{digit}"),
        "workflow/laws/helper.py": f"PORES = 0.{digit}\n",
        "workflow/laws/row.py": row,
        "workflow/scenes/curve.csv": curve,
        "workflow/scenes/of-row.csv": curve,
        "workflow/scenes/within.csv": curve,
        "workflow/scenes/casing.csv": f"theta_deg,depth_um\n0,{digit}\n90,20\n200,15\n",
        "workflow/scenes/rows.csv": f"liner.law.curve,rounds\nworkflow/scenes/of-row.csv,{digit}\n",
        "workflow/scenes/laws.csv": "liner.law\n"
        f'"{{kind: row:Foam, E: 1.0e+9, sigma_Y: {digit}.0e+6}}"\n'
        '"{kind: table, E: 1.0, unit_MPa: 1640, curve: workflow/scenes/within.csv}"\n',
    }


@pytest.fixture(scope="module")
def finished(tmp_path_factory) -> Project:
    """A project with all that is read by a plan, whose jobs were done without any work."""
    project = make_project(tmp_path_factory.mktemp("identity"))
    (project.folder / "workflow/laws").mkdir()
    for path, text in texts("3").items():
        (project.folder / path).write_text(text)
    for name, change in BLADES.items():
        values = {"base": "reference", "sections": None} | change
        write(project, f"blades/{name}.yaml", values)
    matrices = {"full_matrices": MATRICES | {"hub_radius_mm": 200}, "max_speed_rad_s": 500}
    write(project, "blades/matrices.yaml", matrices)
    for name, change in SCENES.items():
        write(project, f"scenes/{name}.yaml", {"base": "foreign"} | change)
    for script in (project.folder / "workflow/scripts").glob("[!_]*.py"):
        script.write_text(NO_JOB)
    project.run(*OUTPUTS)
    assert not project.planned(*OUTPUTS)
    return project


def write(project: Project, name: str, values: dict) -> None:
    (project.folder / "workflow" / name).write_text(yaml.safe_dump(values))


@pytest.fixture
def copy(finished, tmp_path) -> Project:
    return Project(shutil.copytree(finished.folder, tmp_path / "copy", symlinks=True))


def remade(project: Project) -> set[str]:
    """Outputs that a run makes anew."""
    before = {output: (project.folder / output).stat().st_mtime_ns for output in OUTPUTS}
    project.run(*OUTPUTS)
    return {of for of in OUTPUTS if (project.folder / of).stat().st_mtime_ns != before[of]}


def replaced_by_older(path: Path, text: str) -> None:
    """As by mv, cp -p, unzip, rsync -t of a file that was written before."""
    other = path.with_name("other")
    other.write_text(text)
    os.utime(other, ns=(0, path.stat().st_mtime_ns - 10**12))
    other.rename(path)


def overwritten_in_place(path: Path, text: str) -> None:
    """Size, inode and time as they were."""
    was = path.stat()
    assert len(text.encode()) == was.st_size
    with path.open("r+") as file:
        file.write(text)
    os.utime(path, ns=(was.st_atime_ns, was.st_mtime_ns))
    now = path.stat()
    assert (now.st_ino, now.st_mtime_ns) == (was.st_ino, was.st_mtime_ns)


@pytest.mark.slow
@pytest.mark.parametrize("attack", [replaced_by_older, overwritten_in_place])
def test_other_bytes_with_an_old_time_rerun_what_read_them(copy, attack):
    """For every kind of file of a user. Nothing else reruns, in a project that was moved, too."""
    assert not copy.planned(*OUTPUTS)
    for path, text in texts("7").items():
        attack(copy.folder / path, text)
    assert remade(copy) == {*OUTPUTS}
    assert not copy.planned(*OUTPUTS)


@pytest.mark.parametrize(
    "path",
    [
        pytest.param(of, marks=pytest.mark.slow if Path(of).name in BY_DAY else pytest.mark.nightly)
        for of in FILES
    ],
)
def test_each_file_alone_reruns_the_job_that_reads_it(copy, path):
    replaced_by_older(copy.folder / path, texts("7")[path])
    both = {"results/foreign/rows/design-block-0.json", "results/foreign/curved/block-0.nc"}
    of_model = {output for output in OUTPUTS if output.startswith("results/foreign/")}
    assert remade(copy) == {"curve.csv": both, "foreign.nc": of_model}.get(
        Path(path).name, {FILES[path]}
    )


@pytest.mark.slow
def test_a_second_run_says_that_another_is_at_work(copy):
    """It runs: both end right, or the other one says which file it misses."""
    attacked = "workflow/blades/a.step"
    replaced_by_older(copy.folder / attacked, texts("7")[attacked])
    at_work = copy.folder / ".snakemake/at-work"
    with closing(hold(at_work)):
        assert hold(at_work) is None
        assert ANOTHER in " ".join(copy.run(*OUTPUTS).split())
    replaced_by_older(copy.folder / attacked, texts("5")[attacked])
    assert "another run" not in copy.run(*OUTPUTS)


@pytest.mark.slow
def test_a_geometry_that_is_edited_while_its_job_runs_is_refused(tmp_path):
    """By its own job, between reading and writing."""
    project = make_project(tmp_path)
    table = tmp_path / "workflow/blades/mine.csv"
    shutil.copy(ROOT / "workflow/blades/rotor37-sections.csv", table)
    coarse = {"mesh": {"element_size_mm": 15}, "interface": {"patches": 8}}
    blade = {"base": "rotor37", "section_table": {"file": "mine.csv"}}
    write(project, "blades/mine.yaml", blade | coarse)
    job = tmp_path / "workflow/jobs/mesh.py"
    edit = f"    open({str(table)!r}, 'a').write('# thicker')\n    report_mesh("
    job.write_text(job.read_text().replace("    report_mesh(", edit, 1))
    said = project.run("results/mine/blade.msh", expect=1)
    assert "workflow/blades/mine.csv: changed while it was read: run it again" in said
    assert "Traceback" not in said and not (tmp_path / "results/mine/blade.msh").exists()
    assert project.planned("results/mine/blade.msh")["build_mesh"] == 1


@pytest.fixture
def path(tmp_path) -> Path:
    """A file of one digit."""
    path = tmp_path / "a.csv"
    path.write_text("1")
    return path


def test_a_file_is_hashed_anew_when_its_state_changes_and_only_then(path, monkeypatch):
    first, other = file_hash(path), path.with_name("b.csv")
    digest = contents.hashlib.file_digest
    counted = []
    monkeypatch.setattr(
        contents.hashlib, "file_digest", lambda *of: counted.append(1) or digest(*of)
    )
    assert file_hash(path) == first and not counted
    time.sleep(0.05)  # the clock of a file system has ticks
    overwritten_in_place(path, "2")
    assert file_hash(path) != first and len(counted) == 1
    other.write_text("1")
    assert file_hash(other) == first


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda path: overwritten_in_place(path, "2"), "changed while it was read"),
        (lambda path: replaced_by_older(path, "2"), "changed while it was read"),
        # with the bytes that it had: others may have been read in between
        (lambda path: replaced_by_older(path, path.read_text()), "changed while it was read"),
        (Path.unlink, "cannot be read (No such file or directory)"),
        (lambda path: os.link(path, path.with_name("kept")), None),  # by a backup
    ],
)
def test_a_change_during_a_job_is_refused(path, change, said):
    refused = pytest.raises(SettingsError, match=re.escape(f"{path}: {said}"))
    with nullcontext() if said is None else refused, unchanged(hashes([path])):
        change(path)


def test_a_change_within_a_tick_of_the_clock_is_refused(path, monkeypatch):
    monkeypatch.setattr(contents, "_state", lambda path: (0, 0, 0, 0, 0))
    with pytest.raises(SettingsError, match="while it was read"), unchanged(hashes([path])):
        path.write_text("2")


def test_a_change_before_a_job_is_refused(path):
    planned = hashes([path])
    path.write_text("2")
    refused = pytest.raises(SettingsError, match="changed since this run was planned: start it")
    with refused, unchanged(planned):
        raise AssertionError("the job began")


def test_what_is_made_of_a_file_holds_its_hash(tmp_path):
    """A mesh, the mesh at rest made of it, and the matrices."""
    folder, mesh, moved = ROOT / "workflow/blades", tmp_path / "a.msh", tmp_path / "b.msh"
    blade = read_blade(folder / "ansys.yaml")
    build_mesh(blade, mesh, folder / "ansys.cdb")
    write_moved(mesh, moved, meshio.read(mesh).points)
    made = assemble(blade, "ansys", moved, [0.0]).provenance
    assert source_of(mesh) == source_of(moved) == made.settings["source"]
    assert made.settings["source"] == file_hash(folder / "ansys.cdb") == blade.hash_of_files(folder)
    made.require_files(blade.hash_of_files(folder), "rom.nc")
    with pytest.raises(
        ProvenanceError, match=r"other files than those that blade ansys names; make it"
    ):
        made.require_files("another", "rom.nc")
