"""A copy of the project with a coarse blade and short sweeps, for tests that edit it."""

import os
import re
import shutil
import subprocess
import sys
from collections import Counter
from dataclasses import dataclass
from pathlib import Path

import yaml

ROOT = Path(__file__).parents[2]
PACKAGES = ("workflow", "geometry", "fem", "rom", "simulate")
COPIED = (
    "Snakefile",
    "pyproject.toml",
    "profiles",
    "tests/simulate/stability",
    "tests/simulate/interface",
    *PACKAGES,
)
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
        return self.call(*self.command(*arguments), expect=expect)

    def call(self, *command: str, expect: int = 0) -> str:
        """Run any command in the folder, likewise."""
        done = subprocess.run(
            command,
            cwd=self.folder,
            env=self.environment,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
        )
        assert done.returncode == expect, done.stdout
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


def make_project(folder: Path) -> Project:
    """Copy the sources; coarsen the reference blade and shorten the paper's scenes.

    Blade `paper` has the shape of `reference`: tests know its numbers, whatever is inferred.
    """
    for name in COPIED:
        source = ROOT / name
        copy = shutil.copytree if source.is_dir() else shutil.copy2
        copy(source, folder / name)
    project = Project(folder)
    project.edit("workflow/blades/reference.yaml", _coarsen)
    project.edit("workflow/blades/paper.yaml", _of_the_reference)
    project.edit("workflow/scenes/paper.yaml", _shorten)
    for coating in ("e1", "e10"):
        project.edit(f"workflow/scenes/paper-{coating}.yaml", _close_in_no_further)
    project.edit("workflow/scenes/peak-e1.yaml", _at_one_speed)
    project.edit("workflow/scenes/one-percent.yaml", _at_speeds_of_base)
    scenes = ["paper-e1", "paper-e10", "peak-e1"]  # of two speeds or one, with states
    project.edit("workflow/config.yaml", lambda config: config.update(blocks=2, scenes=scenes))
    return project


def _of_the_reference(blade):
    del blade["sections"], blade["max_speed_rad_s"]


def _coarsen(blade):
    blade["mesh"]["element_size_mm"] = 10
    blade["interface"]["patches"] = 8


def _close_in_no_further(scene):
    scene["peaks"]["within_over_f1"] = 0.02  # as near as the speeds are


def _shorten(scene):
    scene["speeds"] = {"over_f1": SPEEDS}
    _close_in_no_further(scene)
    scene["rounds"] = 4
    scene["casing"]["ramp_rounds"] = 1
    scene["record"]["spectrum_rounds"] = 2
    scene["record"]["samples_per_round"] = 256
    scene["liner"]["rods_per_round"] = 512


def _at_speeds_of_base(scene):
    del scene["speeds"], scene["peaks"]


def _at_one_speed(scene):
    scene["speeds"] = {"over_f1": [0.34]}
