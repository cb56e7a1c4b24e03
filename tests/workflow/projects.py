"""A copy of the project with a coarse blade and short sweeps, for tests that edit it."""

import atexit
import filecmp
import os
import re
import runpy
import shutil
import subprocess
import sys
import warnings
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from multiprocessing import get_context
from pathlib import Path
from tempfile import TemporaryDirectory

import yaml

ROOT = Path(__file__).parents[2]
PACKAGES = ("workflow", "geometry", "fem", "rom", "simulate")
COPIED = ("Snakefile", "pyproject.toml", "profiles", *PACKAGES)
# Imported once, before any program starts
LIBRARIES = ["snakemake.cli", "snakemake.notebook", "snakemake.report", "snakemake.workflow"]
LIBRARIES += ["grimp", "h5py", "pandas", "pydantic", "scipy.sparse", "xarray"]
MADE = {"results", ".snakemake", "__pycache__"}  # folders of what runs make
TABLES = [ROOT / f"workflow/{of}/figures.yaml" for of in ("figures", "paper")]
SPEEDS = [0.28, 0.3, 0.32, 0.34, 0.36, 0.38]  # about the crossing of f1 with eo(4)


@dataclass(frozen=True)
class Project:
    """A folder in which Snakemake runs."""

    folder: Path

    def command(self, *arguments: str) -> list[str]:
        ends_at_once = "--max-jobs-per-timespan", "100/1s"
        return [sys.executable, "-m", "snakemake", "--cores", "2", *ends_at_once, *arguments]

    @property
    def environment(self) -> dict[str, str]:
        return os.environ | {"PYTHONPATH": str(self.folder), "OMP_NUM_THREADS": "1"}

    def run(self, *arguments: str, expect: int = 0) -> str:
        """Run Snakemake; return stdout and stderr together."""
        return self.call(*self.command(*arguments)[2:], expect=expect)

    def call(self, module: str, *arguments: str, expect: int = 0) -> str:
        """Run a module in the folder as a program, likewise.

        A fork of one process runs it, which has imported the libraries, and no module of a project:
        of a dry run in a process of its own half are imports.
        """
        context = get_context("forkserver")
        context.set_forkserver_preload(LIBRARIES)
        with TemporaryDirectory() as folder:
            said = Path(folder) / "said"
            given = self.folder, self.environment, [module, *arguments], said
            process = context.Process(target=_program, args=given)
            process.start()
            process.join()
            assert process.exitcode == expect, said.read_text()
            return said.read_text()

    def python(self, *arguments: str) -> str:
        """Output of Python in a process of its own."""
        command = [sys.executable, *arguments]
        to_one = {"stdout": subprocess.PIPE, "stderr": subprocess.STDOUT, "text": True}
        done = subprocess.run(command, cwd=self.folder, env=self.environment, **to_one)
        assert done.returncode == 0, done.stdout
        return done.stdout

    def planned(self, *arguments: str) -> Counter:
        """Jobs that a dry run would start, by rule."""
        output = self.run("-n", *arguments)
        rows = re.findall(r"^(\w+) +(\d+)$", output.split("Job stats:")[-1], re.MULTILINE)
        if "Nothing to be done" in output:
            return Counter()
        return Counter({rule: int(count) for rule, count in rows if rule not in ("total", "all")})

    def edit(self, path: str, change) -> None:
        """Rewrite a YAML file through ``change(values)``, in place."""
        file = self.folder / path
        values = yaml.safe_load(file.read_text())
        change(values)
        file.write_text(yaml.safe_dump(values))


def _program(folder: Path, environment: Mapping[str, str], command: list[str], said: Path) -> None:
    """Run a module as a program in a folder, whose packages it imports; ends the process."""
    with said.open("w") as file:
        for stream in (1, 2):
            os.dup2(file.fileno(), stream)
    os.chdir(folder)
    os.environ.update(environment)
    outside = [path for path in sys.path if "site-packages" in path or str(ROOT) not in path]
    sys.argv, sys.path = command, [str(folder), *outside]
    if command[0].startswith("workflow."):  # ours; Snakemake has warnings
        warnings.simplefilter("error")
    try:
        runpy.run_module(command[0], run_name="__main__", alter_sys=True)
    finally:
        atexit._run_exitfuncs()  # multiprocessing does not
        sys.stdout.flush()


def bring_up_to_date(files: Path, project: Path) -> None:
    """Bring the files of a project to those of another; equal ones keep their times."""
    project.mkdir(parents=True, exist_ok=True)
    wanted, found = _files(files), _files(project)
    for name in found - wanted:
        (project / name).unlink()
    for name in wanted:
        if name not in found or not filecmp.cmp(files / name, project / name, shallow=False):
            (project / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(files / name, project / name)


def _files(folder: Path) -> set[Path]:
    """Paths in a project of the files that no run makes."""
    names = {file.relative_to(folder) for file in folder.rglob("*") if file.is_file()}
    return {name for name in names if not MADE & {*name.parts}}


def copied(folder: Path) -> Project:
    """Copy the sources as they are."""
    for name in COPIED:
        source = ROOT / name
        copy = shutil.copytree if source.is_dir() else shutil.copy2
        copy(source, folder / name)
    return Project(folder)


def make_project(folder: Path) -> Project:
    """Copy the sources; coarsen the reference blade and shorten the paper's scenes.

    Blade `paper` has the shape of `reference`: tests know its numbers, whatever is inferred.
    """
    project = copied(folder)
    project.edit("workflow/blades/reference.yaml", _coarsen)
    project.edit("workflow/blades/paper.yaml", _of_the_reference)
    project.edit("workflow/scenes/paper.yaml", _shorten)
    for coating in ("e1", "e10"):
        project.edit(f"workflow/scenes/paper-{coating}.yaml", _close_in_no_further)
    at_one_speed = {"over_f1": [0.34]}
    project.edit("workflow/scenes/peak-e1.yaml", lambda scene: scene.update(speeds=at_one_speed))
    project.edit("workflow/scenes/one-percent.yaml", _at_speeds_of_base)
    scenes = ["paper-e1", "paper-e10", "peak-e1"]  # of two speeds or one, with states
    project.edit("workflow/config.yaml", lambda config: config.update(blocks=2, scenes=scenes))
    return project


def _of_the_reference(blade):
    del blade["sections"], blade["max_speed_rpm"]


def _coarsen(blade):
    blade["mesh"]["element_size_mm"] = 10
    blade["interface"]["patches"] = 8


def _close_in_no_further(scene):
    scene["peaks"]["within_over_f1"] = 0.02  # as near as the speeds are


def _shorten(scene):
    scene.update(speeds={"over_f1": SPEEDS}, rounds=4)
    _close_in_no_further(scene)
    scene["casing"]["ramp_rounds"] = 1
    scene["record"].update(spectrum_rounds=2, samples_per_round=256)
    scene["liner"]["rods_per_round"] = 512


def _at_speeds_of_base(scene):
    del scene["speeds"], scene["peaks"]
