"""Full disks, and places where nothing may be written: one line, nothing lost or half done."""

import os
import shutil
import subprocess
import tempfile
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import Any

from fem.petsc import MPI

import numpy as np
import pytest
from matplotlib.figure import Figure
from projects import Project
from refused import refused
from scenes import SCENE
from test_kills import require_same_arrays

import ufl
from dolfinx.mesh import create_unit_cube

from fem import forms
from fem.fields import Fields, Stress
from fem.matrices import Matrices
from geometry.base import WriteError, require_writable, write_json
from geometry.blade import Blade
from geometry.mesh import build_mesh
from rom.check import RomCheck
from rom.full_model import FullModel
from rom.model import Rom
from rom.reconstruct import Basis
from simulate.__main__ import main
from simulate.sweeps import dataset
from simulate.sweeps.sweep import sweep
from workflow.figures import style
from workflow.many import design_tables

BLADE, SWEEP = "results/paper", "paper-e1/sweep.nc"
ROOM = 60_000  # bytes: less than each of the files


class Disk:
    """A small file system in memory."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def mount(self, *options: str) -> None:
        command = ["mount", "-t", "tmpfs", "-o", ",".join(options), "tmpfs", str(self.folder)]
        if subprocess.run(command, capture_output=True).returncode:
            pytest.skip("not allowed to mount a small file system: full disks are not tested")

    def fill(self, room: int = ROOM) -> None:
        """Leave ``room`` bytes."""
        free = shutil.disk_usage(self.folder).free
        (self.folder / "filler").write_bytes(bytes(free - room))

    def names(self) -> set[str]:
        return {path.name for path in self.folder.iterdir()}


@pytest.fixture
def disk(tmp_path) -> Iterator[Disk]:
    disk = Disk(tmp_path / "disk")
    disk.folder.mkdir()
    disk.mount("size=20M", "mode=0755")
    yield disk
    subprocess.run(["umount", "-l", str(disk.folder)], check=True)


# What writes each kind of file of the chain, from the folder of a finished blade, and a blade
SAVERS: dict[str, Callable[[Path, Blade], Callable[[Path], Any]]] = {
    "blade.msh": lambda _, coarse: lambda path: build_mesh(coarse, path),
    "matrices.h5": lambda blade, _: Matrices.load(blade / "matrices.h5").save,
    "full-model.nc": lambda blade, _: FullModel.load(blade / "full-model.nc").save,
    "rom-r.nc": lambda blade, _: Rom.load(blade / "rom-r.nc").save,
    "basis-r.h5": lambda blade, _: Basis.load(blade / "basis-r.h5").save,
    "sweep.nc": lambda blade, _: partial(dataset.save, dataset.load(blade / SWEEP)),
    "runs.nc": lambda blade, _: partial(design_tables.save, dataset.load(blade / SWEEP)),
    "settings.json": lambda *_: partial(write_json, {"speeds": [0.1] * ROOM}),
    "field.vtu": lambda *_: lambda path: made_fields().save(path, {"time": 1.0}),
    "figure.pdf": lambda *_: partial(style.save, drawn()),
    "figure.png": lambda *_: partial(style.save, drawn()),
}


def made_fields() -> Fields:
    """Fields of as many nodes as take more than the room."""
    points = np.random.default_rng(1).normal(size=(2000, 3))
    tensor = points[:, :, None] * np.ones(3)
    of = Stress(tensor, tensor)
    return Fields(points, np.arange(2000).reshape(-1, 10), points, points, of, of)


def drawn() -> Figure:
    figure = Figure()
    figure.subplots().imshow(np.random.default_rng(1).random((300, 300)))
    return figure


@pytest.mark.nightly
@pytest.mark.parametrize("name", SAVERS)
def test_a_full_disk_is_one_line_and_keeps_what_was_there(disk, project, coarse_blade, name):
    """Also where the library that writes, gmsh, HDF5 or VTK, says nothing or crashes."""
    path, save = disk.folder / name, SAVERS[name](project.folder / BLADE, coarse_blade)
    path.write_text("of before")
    disk.fill()
    refused(WriteError, save, path, match=rf"^{path}: cannot be written .*make room there, .*$")
    assert path.read_text() == "of before"
    assert disk.names() == {name, "filler"}
    (disk.folder / "filler").unlink()
    save(path)
    assert disk.names() == {name} and path.stat().st_size > ROOM


@pytest.fixture
def command(coarse_rom, disk, tmp_path) -> list[str]:
    """Run a small scene into the small disk."""
    coarse_rom.save(tmp_path / "rom-r.nc")
    (tmp_path / "scene.yaml").write_text(SCENE.replace("rounds: 2", "rounds: 1"))
    return [*(str(tmp_path / of) for of in ("rom-r.nc", "scene.yaml")), "-o", f"{disk.folder}/o.nc"]


@pytest.mark.nightly
@pytest.mark.parametrize("fault", ["full", "read-only"])
def test_a_place_for_the_output_is_tried_before_the_march(
    disk, command, monkeypatch, capsys, fault
):
    if fault == "full":
        disk.fill(room=0)
    else:
        subprocess.run(["mount", "-o", "remount,ro", str(disk.folder)], check=True)
    monkeypatch.setattr("simulate.__main__.sweep", None)  # nothing marches
    assert main(command) == 2
    (line,) = capsys.readouterr().err.splitlines()
    why = {"full": "No space left on device", "read-only": "Read-only file system"}[fault]
    assert line.startswith(f"{disk.folder}/o.nc: cannot be written ({why})")


@pytest.mark.nightly
def test_a_result_is_kept_where_the_disk_fills_while_it_is_marched(
    disk, command, monkeypatch, capsys, tmp_path
):
    def filling(*arguments):
        swept = sweep(*arguments)
        disk.fill(room=0)
        return swept

    (tmp_path / "temporary").mkdir()
    monkeypatch.setattr("tempfile.gettempdir", lambda: str(tmp_path / "temporary"))
    monkeypatch.setattr("simulate.__main__.sweep", filling)
    assert main(command) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert "o.nc: cannot be written (No space left on device)" in line
    kept = Path(line.partition("; the result is in ")[2])
    assert dataset.load(kept).status.values.tolist() == ["ok"]
    assert kept.is_relative_to(tmp_path / "temporary") and disk.names() == {"filler"}


@pytest.mark.nightly
@pytest.mark.skipif(os.geteuid() != 0, reason="needs the rights to become another user")
def test_a_place_of_another_user_is_refused():
    with tempfile.TemporaryDirectory() as folder:
        Path(folder).chmod(0o755)
        place = Path(folder) / "new/o.nc"
        os.seteuid(65534)
        try:
            for write in (require_writable, lambda path: write_json({"a": 1}, path)):
                error = refused(WriteError, write, place, match="Permission denied")
                assert error.file == str(place)
        finally:
            os.seteuid(0)


@pytest.mark.nightly
def test_a_job_on_a_full_disk_fails_in_one_line_and_runs_when_there_is_room(
    project, disk, tmp_path
):
    """The check of the reduced model: its numbers are afterwards those of the other project."""
    shutil.copytree(project.folder, tmp_path / "copy", symlinks=True)
    full = Project(tmp_path / "copy")
    blade = full.folder / BLADE
    for name in ("blade.msh", "matrices.h5", "rom-r.nc", "full-model.nc", "full-between.nc"):
        shutil.copy2(blade / name, disk.folder / name)
    right = RomCheck.load(blade / "rom-check-r.nc")
    shutil.rmtree(blade)
    blade.symlink_to(disk.folder)
    disk.fill(room=20_000)  # the logs, but not the trial of a place
    target = f"{BLADE}/rom-check-r.nc"
    rule = ("--allowed-rules", "check_rom", "--rerun-triggers", "input", "--")
    output = full.run(*rule, target, expect=1)
    assert f"check_rom: {target}: cannot be written (No space left on device)" in output
    assert "Traceback" not in output
    (disk.folder / "filler").unlink()
    full.run(*rule, target)
    require_same_arrays(vars(RomCheck.load(blade / "rom-check-r.nc")), vars(right))


@pytest.mark.nightly
@pytest.mark.parametrize("room", [0, 5_000, 40_000, 60_000])
def test_forms_that_a_full_disk_has_no_room_for_are_compiled_when_it_has(disk, room, monkeypatch):
    """The source, the object or the library is cut short, and none of them is taken for whole."""
    monkeypatch.setattr(forms, "FOLDER", disk.folder / "forms")
    disk.fill(room)
    volume = 1.0 * ufl.dx(create_unit_cube(MPI.COMM_SELF, 1, 1, 1))
    error = refused(WriteError, forms.compiled, volume)
    assert error.file == str(forms.FOLDER) and "XDG_CACHE_HOME" in error.text
    (disk.folder / "filler").unlink()
    forms.compiled(volume)
    (ended,) = forms.FOLDER.glob("*.c.cached")
    assert {path.name.split(".")[0] for path in forms.FOLDER.iterdir()} == {ended.name[:-9]}
