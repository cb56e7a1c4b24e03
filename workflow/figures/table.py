"""Tables of figures, ``figures.yaml``: their names, files and needs."""

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from operator import attrgetter
from pathlib import Path
from typing import Any, Literal, NamedTuple

from pydantic import Field

from geometry.base import Settings, SettingsError, check_settings, merged, read_mapping
from simulate.scene import Scene
from workflow.many.design import over_seeds
from workflow.many.plan import SCENES

DELIVERED = "delivered"  # the part of the table that a plain run delivers
OF_SCENE = {  # demands on the value of a key of a scene
    "set": bool,
    "changing with the speed": lambda gaps: gaps.vary,
    "a YAML file": lambda path: path is not None and path.endswith((".yaml", ".yml")),
    "over seeds": lambda path: path is not None and over_seeds(SCENES / path),
}

type Need = Literal[
    *("set", "changing with the speed", "a YAML file", "over seeds", "matrices", "mesh", "fatigue")
]


class FigureRow(Settings):
    """A figure, or a figure of each blade or scene; the keys are explained in ``figures.yaml``."""

    title: str
    caption: str
    more: str = ""
    draw: str
    files: dict[str, str | list[str]] = Field(default={})
    needs: dict[str, Need] = Field(default={})
    given: dict[str, Any] = Field(default={})
    operating: bool = False
    blade: str | None = None
    scenes: list[str] | Literal["with loads"] = Field(default=[])
    like: str | None = None
    part: str  # of the table
    category: str  # of the report


class FigureSubject(NamedTuple):
    """Blade, scenes and directions of a figure."""

    blade: str | None
    scenes: Sequence[str]
    directions: str | None


def read(*paths: str | Path) -> dict[str, FigureRow]:
    """Rows of some tables by name; one with a ``like`` has its missing keys from that row.

    Raises
    ------
    SettingsError
        When a file is not valid; the message has file, row and key.
    """
    rows = [
        (path, name, {**row, "part": part, "category": category})
        for path in paths
        for part, categories in read_mapping(path).items()
        for category, rows in categories.items()
        for name, row in rows.items()
    ]
    raw = {name: row for _, name, row in rows}
    for path, name, row in rows:
        if (like := row.get("like", name)) not in raw:
            raise SettingsError("no such row", key=f"{name}.like", value=like, file=path)
    return {
        name: check_settings(FigureRow, merged(raw[row.get("like", name)], row), f"{path}: {name}")
        for path, name, row in rows
    }


def path_of(name: str) -> str:
    """Path of a figure, without its suffix."""
    return f"results/{name}" if "/" in name else f"results/figures/{name}"


class Figures(NamedTuple):
    """The figures of a project. ``wildcards``: those of a row's name, with their values."""

    rows: Mapping[str, FigureRow]  # by name
    scenes: Mapping[str, Scene]  # all
    delivered: Mapping[str, Scene]  # those of workflow/config.yaml
    stressed: Collection[str]  # scenes whose stresses are known
    directions: Callable[[str], str]  # of the interface that the scenes of a blade need
    operating: Callable[[str], Mapping[str, float]]  # speeds of a blade by name, rpm
    blades: Mapping[str, Callable[[str], bool]]  # whether a blade meets a need of a figure

    def subject(self, name: str, wildcards: Mapping[str, str]) -> FigureSubject:
        """Blade and scenes of a figure, and the directions of their interface."""
        row = self.rows[name]
        blade, scenes = wildcards.get("blade", row.blade), row.scenes
        if "scene" in wildcards:
            scenes = [wildcards["scene"]]
        elif isinstance(scenes, str):
            scenes = [  # sweeps of the blade over several speeds, with a liner
                name
                for name, scene in self.delivered.items()
                if scene.blade == blade
                and not scene.design
                and scene.speeds.count > 1
                and scene.liner.law.touches
            ]
        if scenes and blade is None:
            scene = self.scenes[scenes[0]]
            return FigureSubject(scene.blade, scenes, scene.directions)
        return FigureSubject(blade, scenes, blade and self.directions(blade))

    def files(self, name: str, wildcards: Mapping[str, str]) -> dict[str, str | list[str]]:
        """Paths of the files of a figure, by name.

        Raises
        ------
        SettingsError
            When its blade or a scene does not meet a need of the figure.
        """
        row, subject = self.rows[name], self.subject(name, wildcards)
        for fault in self._faults(row, subject):
            raise fault
        fields = {**wildcards, **subject._asdict(), "name": name.format_map(wildcards)}
        stressed = [scene for scene in subject.scenes if scene in self.stressed]

        def paths(pattern: str) -> list[str]:
            """Paths of a pattern, one for each scene where it depends on these."""
            each = stressed if "{stressed}" in pattern else subject.scenes or [""]
            filled = (pattern.format_map(fields | {"scene": s, "stressed": s}) for s in each)
            return [*dict.fromkeys(filled)]  # one where it does not depend on the scene

        return {
            key: paths(patterns)[0]
            if isinstance(patterns, str)
            else [path for pattern in patterns for path in paths(pattern)]
            for key, patterns in row.files.items()
        }

    def given(self, name: str, wildcards: Mapping[str, str]) -> dict[str, Any]:
        """Further arguments of ``draw``: those of the row, and operating speeds where there are."""
        row, blade = self.rows[name], self.subject(name, wildcards).blade
        speeds = self.operating(blade) if row.operating else {}
        return row.given | ({"operating": speeds} if speeds else {})

    def caption(self, name: str, wildcards: Mapping[str, str]) -> str:
        """Caption in the report, with the names of blade and scenes."""
        row, subject = self.rows[name], self.subject(name, wildcards)
        return f"{row.caption} {row.more}".format(
            blade=subject.blade, scene=", ".join(subject.scenes)
        )

    def configured(self, wanted: Callable[[FigureRow], bool]) -> list[str]:
        """Names of the wanted figures of configured blades and scenes whose needs are met.

        They are by the sweep, or by the design, of each scene.
        A row of the same category that is like another for its blade or scene is there instead.
        """
        candidates = [
            (name, row, wildcards, self.subject(name, wildcards))
            for name, row in self.rows.items()
            if wanted(row)
            for wildcards in self._configured(name)
        ]
        instead = [(row.like, row.category, subject) for _, row, _, subject in candidates]
        return [
            name.format_map(wildcards)
            for name, row, wildcards, subject in candidates
            if {bool(self.delivered[scene].design) for scene in subject.scenes}
            <= {"design" in row.needs}
            and not any(self._faults(row, subject))
            and (name, row.category, subject) not in instead
        ]

    def _configured(self, name: str) -> list[dict[str, str]]:
        """Wildcards of a row, of configured blades and scenes; none if it is of others."""
        scenes, row = self.delivered, self.rows[name]
        blades = sorted({scene.blade for scene in scenes.values()})
        if "{blade}" in name:
            return [{"blade": blade} for blade in blades]
        if "{scene}" in name:
            return [{"scene": scene} for scene in scenes]
        return [{}] if {*row.scenes} <= {*scenes} and row.blade in (None, *blades) else []

    def _faults(self, row: FigureRow, subject: FigureSubject) -> Iterator[SettingsError]:
        """Needs of a figure that its blade or scenes do not meet."""
        if row.scenes and not subject.scenes:
            fault = f"no scene of blade {subject.blade} in workflow/config.yaml has loads to draw"
            yield SettingsError(fault)
        for key, need in row.needs.items():
            if key == "blade" and not self.blades[need](subject.blade):
                file = f"workflow/blades/{subject.blade}.yaml"
                yield SettingsError(f"without the {need} that this figure needs", file=file)
            for scene in subject.scenes if key != "blade" else ():
                if not OF_SCENE[need](attrgetter(key)(self.scenes[scene])):
                    file = f"workflow/scenes/{scene}.yaml"
                    yield SettingsError(f"must be {need} for this figure", key=key, file=file)
