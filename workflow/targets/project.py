"""A project: its blades and scenes, those that a plain run delivers, and their figures."""

import os
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from itertools import chain
from pathlib import Path
from tempfile import gettempdir
from typing import Any, Self

from geometry.base import SettingsError, yaml_file
from simulate.scene import Scene
from simulate.scene.casing import CASING
from workflow.at_work import not_writable
from workflow.config import read_config
from workflow.figures import table
from workflow.many.design import over_seeds
from workflow.targets.blades import AnyBlade, Blades
from workflow.targets.inputs import ROOT, OfJob, own_files
from workflow.targets.scenes import Scenes

CONFIG = "workflow/config.yaml"
SUMMARY = "results/summary.json"


def pictures(names: Iterable[str]) -> list[str]:
    """Both files of each figure."""
    return [f"{table.path_of(name)}.{suffix}" for name in names for suffix in ("png", "pdf")]


@dataclass(frozen=True)
class Project:
    """A project in the working directory. Its configured scenes and blades are checked at once."""

    blades: Blades
    scenes: Scenes
    delivered: Mapping[str, Scene]  # those of workflow/config.yaml, by name
    delivered_blades: Mapping[str, AnyBlade]

    @classmethod
    def read(cls, given: Mapping[str, Any]) -> Self:
        """Read it, with the settings that --config gives.

        Raises
        ------
        SettingsError
            With a line for each fault.
        """
        folder = os.getcwd()
        if not os.path.isfile(CONFIG):
            raise SettingsError(
                f"{folder}: no {CONFIG}; start in the folder of a project, as ./run does, or add "
                f"--directory {ROOT}"
            )
        for place, remedy in (
            (folder, ""),
            (os.environ.get("TMPDIR", gettempdir()), "; or set TMPDIR"),
        ):
            if fault := not_writable(place):
                raise SettingsError(fault + remedy)
        blades, names = Blades.read(), yaml_file.names("workflow/scenes")
        config = read_config(CONFIG, given, names)
        explored = [name for name in config.explore if name in config.scenes]
        scenes = Scenes(names, blades, explored, config.blocks)
        delivered = scenes.all(config.scenes)
        of_scenes = sorted({scene.blade for scene in delivered.values()})
        return cls(blades, scenes, delivered, blades.settings.all(of_scenes))

    @cached_property
    def sweeps(self) -> dict[str, Scene]:
        """Scenes to deliver but for designs."""
        return {name: scene for name, scene in self.delivered.items() if not scene.design}

    @cached_property
    def designs(self) -> dict[str, Scene]:
        """Designs to deliver."""
        return {name: scene for name, scene in self.delivered.items() if scene.design}

    @cached_property
    def stressed(self) -> list[str]:
        """Names of the sweeps to deliver whose stresses are known."""
        return [name for name, scene in self.sweeps.items() if self.scenes.keeps_motion(scene)]

    @cached_property
    def figures(self) -> table.Figures:
        """All figures, of users and of the paper."""
        tables = own_files(f"workflow/{of}/figures.yaml" for of in ("figures", "paper"))
        return table.Figures(
            table.read(*tables),
            scenes=self.scenes,
            delivered=self.delivered,
            stressed=self.stressed,
            directions=self.directions,
            operating=self.operating,
            blades=self.blades.meets(),
        )

    def directions(self, blade: str) -> str:
        """Interface directions that the blade's scenes need; all directions without a scene."""
        needed = [scene.directions for scene in self.delivered.values() if scene.blade == blade]
        return max(needed, key=len, default="rtz")

    def sought(self, wildcards: Any) -> dict[str, Any]:
        """The number of modes, and the engine orders, whose critical speeds are told of a blade."""
        return self.blades.of(wildcards).margins.model_dump()

    def operating(self, blade: str) -> dict[str, Any]:
        """Operating speeds of a blade, rpm by name, the crossings that are told, their causes.

        Of all scenes to deliver of the blade, so that all its figures and tables tell the same.
        """
        scenes = [scene for scene in self.delivered.values() if scene.blade == blade]
        by_orders = (scene.excites.items() for scene in scenes)
        # an order of one casing may be a side band of another: the harmonic is told
        excited = dict(sorted(chain(*by_orders), key=lambda item: item[1] == CASING))
        settings = self.blades.settings[blade]
        sought, lines = settings.margins.model_dump(), settings.operating_rpm
        orders = sorted({*sought["orders"], *excited})
        moves = {(of.order, of.frequency_Hz) for scene in scenes for of in scene.casing.moves}
        of_scenes = {"excited": excited, "casing": sorted(moves)}
        return sought | {"lines": lines, "orders": orders} | of_scenes

    def of_sweeps(self, pattern: str) -> list[str]:
        """``pattern`` for every sweep to deliver, with its blade and its model's directions."""
        return [
            pattern.format(blade=scene.blade, scene=name, directions=scene.directions)
            for name, scene in self.sweeps.items()
        ]

    def operating_of_delivered(self, wildcards: Any) -> dict[str, Any]:
        """The same of every blade to deliver."""
        return {blade: self.operating(blade) for blade in self.delivered_blades}

    def others_with_results(self, wildcards: Any) -> list[str]:
        """Scenes that are there, have results of the summary, and are not to be delivered."""
        found = {path.parent.name for path in Path("results").glob("*/*/answers.json")}
        return sorted(found & self.scenes.keys() - self.sweeps.keys())

    def tables_of_designs(self) -> list[str]:
        """The tables of every design to deliver."""
        return [
            f"results/{scene.blade}/{name}/{file}"
            for name, scene in self.designs.items()
            for file in (
                *("design-runs.nc", "design-rows.nc", "design.csv"),
                *["quantiles.csv"] * over_seeds(self.scenes.designs[name].path),
            )
        ]

    def roms(self) -> list[str]:
        """The reduced model of each blade to deliver, with its check."""
        return [
            f"results/{blade}/{file}-{self.directions(blade)}.nc"
            for blade in self.delivered_blades
            for file in ("rom", *(() if blade in self.blades.foreign else ("rom-check",)))
        ]

    def delivered_files(self, wildcards: Any) -> list[str]:
        """Outputs of the workflow: every sweep, design and figure."""
        return [
            *self.of_sweeps("results/{blade}/{scene}/sweep.nc"),
            *self.tables_of_designs(),
            *(
                f"results/{of.blade}/{name}/gauges.csv"
                for name, of in self.sweeps.items()
                if of.record.gauges
            ),
            *self.delivered_figures(),
            *(
                f"results/{self.scenes[name].blade}/{name}/explore.html"
                for name in self.scenes.explored
            ),
            *([SUMMARY] if self.sweeps else []),
        ]

    def delivered_figures(self) -> list[str]:
        """Every figure of the scenes to deliver."""
        return pictures(self.figures.configured(lambda row: row.part == table.DELIVERED))

    def of_figure(self, told: Any, name: str) -> OfJob[Any]:
        """What a method of ``figures`` tells of the figure ``name``."""
        return lambda wildcards: told(name, dict(wildcards.items()))
