"""Blades of a project: their settings and files, and what jobs read of them."""

import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from itertools import chain
from math import ceil
from pathlib import Path
from typing import Any, Self

from geometry.base import SettingsError, hashes, printable, yaml_file
from geometry.blade import Blade, given_frequencies
from geometry.elsewhere import ELSEWHERE, MatricesElsewhere, ModelElsewhere, read_blade
from rom.polynomial import basis_speeds, speeds_between
from workflow.model_cost import costs, nodes_of
from workflow.targets.inputs import OfJob, Once, Told

FOLDER = "workflow/blades"
UNKNOWN = 4000  # MB, for a model of up to 50,000 nodes

type AnyBlade = Blade | MatricesElsewhere | ModelElsewhere


@dataclass(frozen=True)
class Blades:
    """The blades of ``workflow/blades``; files other than the names' own are read when used."""

    settings: Once[AnyBlade]  # by name, of a scene or not
    foreign: list[str]  # of a reduced model made elsewhere
    with_matrices: list[str]  # made elsewhere
    as_it_runs: list[str]  # whose shape at rest is computed

    @classmethod
    def read(cls) -> Self:
        """Those in the working directory."""
        names = yaml_file.names(FOLDER)
        keys = ModelElsewhere.key, MatricesElsewhere.key, "geometry_at_rpm"
        return cls(
            Once(names, _settings),
            *([name for name in names if _has(name, key)] for key in keys),
        )

    @cached_property
    def meshed(self) -> list[str]:
        """Names of those that are meshed."""
        return [name for name in self.reduced if name not in self.with_matrices]

    @cached_property
    def reduced(self) -> list[str]:
        """Names of those whose reduced model is made here."""
        return [name for name in self.settings if name not in self.foreign]

    def require(self, name: str, where: str) -> AnyBlade:
        """Settings of a blade that a user names.

        Raises
        ------
        SettingsError
            When there is no such blade; ``where`` says where it is named.
        """
        if name not in self.settings:
            raise SettingsError(f"{where}: blade: {name!r}: no {FOLDER}/{name}.yaml")
        return self.settings[name]

    def file(self, wildcards: Any) -> str:
        """The blade's own file."""
        return f"{FOLDER}/{wildcards.blade}.yaml"

    def of(self, wildcards: Any) -> AnyBlade:
        """The blade's settings."""
        return self.settings[wildcards.blade]

    def files(self, wildcards: Any) -> list[str]:
        """Paths of the files that the blade's file names."""
        return list(map(str, chain(*_files(self.of(wildcards)).values())))

    def source(self, wildcards: Any) -> list[str] | str:
        """The file with the blade's geometry, all where it names several; none for parameters."""
        files = self.files(wildcards)
        return files[0] if len(files) == 1 else files

    def contents(self, wildcards: Any) -> Told:
        """Hashes of the files that the blade's file names, for the jobs that read them."""
        return Told(hashes(self.files(wildcards)))

    def uses(self, *keys: str) -> OfJob[Told]:
        """The settings of the blade that a job uses: of all settings, only these rerun it."""

        def settings(wildcards: Any) -> Told:
            values = self.of(wildcards).model_dump(mode="json", exclude_none=True)
            return Told({key: values[key] for key in keys if key in values})

        return settings

    def uses_of_basis(self, wildcards: Any) -> Told:
        """The settings that determine the model: the basis, without the tolerance of its check."""
        blade = self.of(wildcards)
        of_basis = blade.basis.model_dump(mode="json", exclude={"tolerance_percent"})
        return Told(of_basis | given_frequencies(blade.frequencies_Hz))

    def modes_of_basis(self, wildcards: Any) -> int:
        """Number of natural modes that the basis takes at each speed; that of the paper none."""
        return getattr(self.of(wildcards).basis, "natural_modes", 0)

    def speeds_of_basis(self, wildcards: Any) -> tuple[list[float], float]:
        """Speeds, rad/s, at which the basis needs the full matrices, and what decides on more."""
        blade = self.of(wildcards)
        speeds = basis_speeds(blade.basis, blade.top_speed).tolist()
        return speeds, blade.basis.tolerance_percent

    def speeds_between(self, wildcards: Any) -> list[float]:
        """Speeds at which the reduced model is checked beside those of its basis, rad/s."""
        return speeds_between(self.speeds_of_basis(wildcards)[0]).tolist()

    def between(self, wildcards: Any) -> list[str] | str:
        """The full model at these speeds, where the blade has a mesh."""
        blade = wildcards.blade
        return f"results/{blade}/full-between.nc" if blade in self.meshed else []

    def memory(self, job: str) -> Callable[[Any, Any, int], int]:
        """Memory, MB, that a ``job`` of the blade needs, of the rules from the mesh to the model.

        More with each ``attempt``. Of matrices from elsewhere it is not known: ``UNKNOWN``.
        """

        def needed(wildcards: Any, input: Any, attempt: int) -> int:
            if wildcards.blade not in self.meshed:
                return attempt * UNKNOWN
            nodes = nodes_of(f"results/{wildcards.blade}/blade.msh")
            return attempt * ceil(costs(self.of(wildcards), nodes)[job].memory / 1e6)

        return needed

    def linear(self, wildcards: Any) -> list[str] | str:
        """The blade's matrices, where they hold K at all speeds: those of prestress `linear`."""
        is_linear = getattr(self.of(wildcards), "prestress", "") == "linear"
        return f"results/{wildcards.blade}/matrices.h5" if is_linear else []

    def mesh(self, wildcards: Any) -> list[str] | str:
        """The blade's mesh, where it has one."""
        blade = wildcards.blade
        return f"results/{blade}/blade.msh" if blade in self.meshed else []

    def mesh_error(self, wildcards: Any) -> list[str] | str:
        """Error of the mesh, if a coarser mesh can be made."""
        known = self.mesh(wildcards) and self.of(wildcards).mesh
        return f"results/{wildcards.blade}/mesh-error.json" if known else []

    def meets(self) -> Mapping[str, Any]:
        """Whether a blade meets the needs of figures, by need."""
        return {
            "matrices": lambda blade: blade not in self.foreign,
            "mesh": lambda blade: blade in self.meshed,
            "fatigue": lambda blade: blade in self.meshed and self.settings[blade].fatigue,
        }


def require_shown(path: str, key: str, named: str) -> None:
    """Refuse a file that Snakemake cannot name in a line: it shows names as they are."""
    if printable(named) != named:
        raise SettingsError(f"{path}: {key}: {named!r}: rename it, without control characters")


def _files(blade: AnyBlade) -> dict[str, list[Path]]:
    """Paths of the files that the blade's file names, by their key; none for parameters."""
    if isinstance(blade, ELSEWHERE):
        return {blade.key: [Path(FOLDER, file) for file in blade.files]}
    return {f"{blade.source_key}.file": [Path(FOLDER, blade.file)]} if blade.file else {}


def _settings(name: str) -> AnyBlade:
    path = f"{FOLDER}/{name}.yaml"
    blade = read_blade(path)
    for key, files in _files(blade).items():
        for file in files:
            named = str(file).removeprefix(f"{FOLDER}/")
            require_shown(path, key, named)
            if not os.path.isfile(file):
                raise SettingsError(f"{path}: {key}: {named!r}: no such file")
    return blade


def _has(name: str, key: str) -> bool:
    """Whether a blade's file has a key; one that cannot be read is refused when it is used."""
    try:
        return key in yaml_file.read_mapping(f"{FOLDER}/{name}.yaml")
    except SettingsError:
        return False
