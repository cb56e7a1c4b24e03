"""Targets of the paper: the runs that its table of claims includes once they exist, and costs."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from workflow.targets.inputs import OfJob
from workflow.targets.scenes import Scenes

SWEPT = ("e1", "e10", "two-five", "tilted", "tangential")  # scenes of the claims, after `paper-`
OTHERS = ("density-1", "density-4", "step-08", "step-04", "step-02")  # of those about the method
BEYOND = ("long-20", "long-200", "long-2000", "run-up", "run-down", "on-worn")
# Folders in results/ with the benchmarks of the jobs of each target
FOLDERS = {
    "paper": [
        *("paper", "paper-points", "reference-points-coarse", "experiments/grid"),
        *(f"paper/paper-{name}" for name in (*SWEPT, *OTHERS)),
    ],
    "paper_beyond": [f"paper/{name}" for name in BEYOND],
    "paper_uncertainty": ["paper-rich", "experiments/repeats"],
    "paper_causes": ["paper-nonlinear", "paper-wide", "paper-edges", "experiments/causes"],
    "paper_rotor37": ["rotor37-fast", "rotor37-fast-points", "experiments/rotor37"],
}

type Files = Mapping[str, str]  # by what they are


def sweeps(*names: str) -> list[str]:
    """Sweeps of the paper's scenes of these names, after `paper-`."""
    return [f"results/paper/paper-{name}/sweep.nc" for name in names]


def folders() -> dict[str, list[str]]:
    """Paths of ``FOLDERS``."""
    return {target: [f"results/{name}" for name in names] for target, names in FOLDERS.items()}


@dataclass(frozen=True)
class Further:
    """Files that the claims table includes if all of a group exist."""

    scenes: Scenes

    def groups(self) -> dict[str, dict[str, Files]]:
        """All by target and by group."""

        def of(name: str, *files: str) -> Files:
            return {file: f"results/experiments/{name}/{file}.json" for file in ("table", *files)}

        model = f"results/{self.scenes['rotor37-e1'].blade}/paper-model.json"
        return {
            "paper_uncertainty": {"repeats": of("repeats", "growth")},
            "paper_causes": {"causes": of("causes")},
            "paper_rotor37": {"other": {**of("rotor37", "growth"), "model": model}},
        }

    def files(self, *targets: str) -> OfJob[list[str]]:
        """Those that these targets make, of any targets of Snakemake."""
        return lambda wildcards: [
            file
            for target, groups in self.groups().items()
            for files in groups.values()
            for file in files.values()
            if target in targets
        ]

    def existing(self, wildcards: Any) -> dict[str, Files]:
        """Files by group that exist when the table is made."""
        return {
            group: files
            for groups in self.groups().values()
            for group, files in groups.items()
            if all(Path(file).is_file() for file in files.values())
        }

    def times(self, wildcards: Any) -> dict[str, int]:
        """Modification times of the existing files, ns: the table is remade for new ones."""
        groups = self.existing(wildcards).values()
        return {file: Path(file).stat().st_mtime_ns for of in groups for file in of.values()}
