"""The rows of an experiment, workflow/experiments/NAME.yaml: scenes with other values of some keys.

Changes are written as in a scene file, or by paths of keys: `liner: {law: {K: 0.45}}` is
`liner.law.K: 0.45`. Besides keys of a scene, the blade among them, a row may have `times`, factors
on values that the scene has; `directions`, which the interface of its model has at least; `model`,
a function that makes another of it; and labels of scenes, each with changes of that scene alone.

Snakemake's rules import this module to list their jobs: it imports no compiled code.
"""

import re
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from itertools import product
from operator import attrgetter
from pathlib import Path
from typing import Any, Literal

from pydantic import Field, field_validator

from geometry.base import (
    ROOT,
    Fault,
    Settings,
    SettingsError,
    SettingsFile,
    check_settings,
    checked,
    refuse,
    yaml_file,
)
from simulate.scene import Scene
from workflow.many.columns import placed, value_at
from workflow.many.row import Row

SCENES = Path("workflow/scenes")
OF_A_ROW = ("times", "directions", "model")  # its keys that are none of a scene
DIRECTIONS = ("r", "rt", "rtz")  # of the interface DoFs
REFUSED = (
    "accuracy",
    "design",
    "start",
    "record.gauges",
)  # keys that need other files than the model

type Changes = dict[str, Any]
type Rows = dict[str, Changes]  # by name
type Keys = tuple[str, ...]  # of a place in a file


class Group(Settings):
    """Rows with the same scenes."""

    name: str = Field(default="", description="Column `group` of the table")
    of: Any = Field(default=(), description="Labels of its scenes; by default all")
    rows: Rows = Field(default={}, description="Changes by the name of their row")
    each: list[str] = Field(
        default=[], description="Instead of rows: names of `lists`; every combination is a row"
    )
    drawn: int = Field(
        default=0, ge=0, description="Instead of rows: how many without changes, told by `number`"
    )
    against: str | None = Field(default=None, description="Row to compare the others with")

    @checked
    def _has_one_source(self) -> None:
        if self.drawn and (self.rows or self.each):
            raise SettingsError("give either rows or each, or drawn", key="drawn", value=self.drawn)

    def combined(self, place: Keys, lists: Mapping[str, Rows]) -> Iterator[tuple[list[Keys], list]]:
        """Places, in a file that has the group ``place`` one, and changes of each row."""
        choices = [(("lists", name), lists[name]) for name in self.each] or [
            ((*place, "rows"), self.rows or {str(row + 1): {} for row in range(self.drawn)})
        ]
        for items in product(*([(where, *row) for row in rows.items()] for where, rows in choices)):
            yield [(*where, name) for where, name, _ in items], [changes for *_, changes in items]


class Picture(Settings):
    """Picture of a table. A column is a column of the table, or a key of the scenes by its path."""

    kind: Literal["lines", "cells"] = Field(description="Curves over x, or a matrix of a number")
    x: str = Field(default="scene", description="Column: of curves, or of the matrix's columns")
    y: str | list[str] = Field(default="row", description="Columns of curves; or of its rows")
    value: str | None = Field(default=None, description="Column of the number in a cell")
    line: str | None = Field(default=None, description="Column; a curve for each of its values")
    panel: str = Field(default="", description="Column; a panel for each of its values")
    labels: dict[str, str] = Field(
        default={}, description="Text for a column, with its unit, or for a value"
    )
    log: Literal["", "x", "y", "xy", "value"] = Field(
        default="", description="On logarithmic scales"
    )

    @checked
    def _has_a_quantity(self) -> None:
        key = "value" if self.kind == "cells" else "y"
        if key not in self.model_fields_set:
            raise SettingsError(f"missing: {self.kind} draw this column", key=key)


class Experiment(SettingsFile, Group):
    """An experiment: one group of rows, or several."""

    of: dict[str, str | Changes] = Field(
        min_length=1,
        description="Scenes by label: the name of a scene file, or its `base` and changes of it",
    )
    lists: dict[str, Rows] = Field(default={}, description="Lists of rows, for `each`")
    groups: list[Group] = Field(default=[], description="Instead of rows and each")
    numbers: str | dict[str, str] = Field(
        default="peaks",
        description="Function of a row: one of workflow/many/numbers.py, or module:function "
        "in workflow/; or one for each label",
    )
    needs: list[Literal["mesh", "matrices", "full", "check", "basis"]] = Field(
        default=[], description="Files of each row's model that the function takes"
    )
    marched: bool = Field(
        default=True,
        description="Whether the function takes runs or the reduced model; if not, none are made",
    )
    picture: Picture | None = Field(default=None, description="Picture of the table")

    @field_validator("of", mode="before")
    @classmethod
    def _names_are_labels(cls, scenes: Any) -> Any:
        return {name: name for name in scenes} if isinstance(scenes, list) else scenes

    @checked
    def _names_are_there(self) -> None:
        groups, by_label = self.groups or [self], isinstance(self.numbers, dict)
        for key, names, allowed in (
            ("groups.of", [label for group in groups for label in group.of], self.of),
            ("numbers", self.numbers if by_label else (), self.of),
            ("each", [name for group in groups for name in group.each], self.lists),
        ):
            if unknown := [name for name in names if name not in allowed]:
                text = f"is not there; there are {', '.join(allowed) or 'none'}"
                raise SettingsError(text, key=key, value=unknown[0])

    @checked
    def _functions_are_there(self) -> None:
        numbers = self.numbers
        for name in [numbers] if isinstance(numbers, str) else numbers.values():
            require_function(function_named(name), "numbers")


def function_named(name: str) -> str:
    """A function of numbers as module:function.

    >>> function_named("peaks"), function_named("paper.measure:coating")
    ('workflow.many.numbers:peaks', 'workflow.paper.measure:coating')
    """
    return f"workflow.{name if ':' in name else f'many.numbers:{name}'}"


def require_function(named: str, key: str) -> None:
    """Refuse a value of ``key`` that names no function of workflow/; nothing is imported."""
    module, _, function = named.partition(":")
    file = Path(f"{module.replace('.', '/')}.py")
    text = (ROOT / file).read_text() if (ROOT / file).is_file() else ""
    there = re.findall(r"^def ([^_]\w*)", text, re.MULTILINE)
    if function not in there:
        fault = f"no function of {file}, which has {', '.join(there) or 'none'}"
        raise SettingsError(fault, key=key, value=function)


def cases(path: str | Path) -> list[Row]:
    """Rows of the experiment in a file on each of their scenes.

    Raises
    ------
    SettingsError
        When it is not valid: a line for each fault, with file, line and key.
    """
    experiment, scenes, planned, faults = Experiment.load(path), {}, [], []
    lines = yaml_file.read_layers(path)[0].lines

    @contextmanager
    def kept_faults(*places: Keys) -> Iterator[None]:
        """Keep the faults of values at these places, and go on."""
        try:
            yield
        except SettingsError as error:
            unplaced = (fault for fault in error.faults if not fault.file)
            faults.extend(fault for fault in error.faults if fault.file)  # of a scene's own file
            faults.extend(_placed(fault, path, places, lines) for fault in unplaced)

    for label, given in experiment.of.items():
        with kept_faults(("of", label)):
            scenes[label] = _values(given)
    groups = [(("groups", str(i)), group) for i, group in enumerate(experiment.groups)]
    for where, group in groups or [((), experiment)]:
        for places, rows in group.combined(where, experiment.lists):
            for label in [label for label in group.of or experiment.of if label in scenes]:
                with kept_faults(*places):
                    names = [place[-1] for place in places]
                    case = _case(experiment, group, label, names, rows, scenes[label])
                    planned.append(case.but(number=len(planned) + 1))
    labelled = {(case.label, case.row) for case in planned}
    for label, against in dict.fromkeys((case.label, case.against) for case in planned):
        if against is not None and (label, against) not in labelled and not faults:
            text = f"is no row on the scene {label!r}"
            faults.append(Fault(text, "against", against, file=str(path)))
    refuse(faults)
    return planned


def _values(given: str | Changes) -> dict[str, Any]:
    """Values of a scene: those of its file, or of its base with some changed."""
    changes = dict(given) if isinstance(given, dict) else {yaml_file.BASE: given}
    name = str(changes.pop(yaml_file.BASE, ""))
    if name not in yaml_file.names(SCENES):
        raise SettingsError(
            f"needs the name of a scene in {SCENES}", key=yaml_file.BASE, value=name
        )
    values = placed(Scene.load(SCENES / f"{name}.yaml").model_dump(exclude_unset=True), changes)
    check_settings(Scene, values, "")
    return values


def _case(
    experiment: Experiment,
    group: Group,
    label: str,
    names: Sequence[str],
    rows: Sequence[Changes],
    values: dict[str, Any],
) -> Row:
    """A row with these ``names`` and changes on the scene of a label, which has ``values``."""
    directions, model = ["r"], None
    for changes in [part for row in rows for part in (row, row.get(label, {}))]:
        settings = {
            k: value for k, value in changes.items() if k not in (*experiment.of, *OF_A_ROW)
        }
        values = _multiplied(placed(values, settings), changes.get("times", {}))
        directions.append(changes.get("directions", "r"))
        model = f"workflow.{changes['model']}" if "model" in changes else model
    if unknown := set(directions) - set(DIRECTIONS):
        raise SettingsError(
            f"allowed {', '.join(DIRECTIONS)}", key="directions", value=unknown.pop()
        )
    if model:
        require_function(model, "model")
    scene = check_settings(Scene, values, "")
    if refused := [key for key in REFUSED if attrgetter(key)(scene)]:
        text = (
            f"an experiment takes no scene with it: name another one, or write `{refused[0]}: null`"
        )
        raise SettingsError(text, key=refused[0])
    numbers = experiment.numbers
    function = numbers if isinstance(numbers, str) else numbers.get(label, "peaks")
    return Row(
        group=group.name,
        label=label,
        names=names,
        against=group.against,
        scene=scene,
        directions=max(*directions, scene.directions, key=len),
        model=model,
        function=function_named(function),
        needs=[*(["rom"] if experiment.marched else []), *experiment.needs],
    )


def _multiplied(values: dict[str, Any], factors: Mapping[str, float]) -> dict[str, Any]:
    """Values of a scene, some of them times a factor."""
    for key in factors:
        if not isinstance(value_at(values, key), int | float):
            text = "no number that the scene has: give the value itself, without `times`"
            raise SettingsError(text, key=f"times.{key}", value=value_at(values, key))
    return placed(values, {key: factor * value_at(values, key) for key, factor in factors.items()})


def _placed(
    fault: Fault, path: str | Path, places: Sequence[Keys], lines: Mapping[Keys, int]
) -> Fault:
    """A fault of a scene with file and line of the change that it is about, or of its row.

    ``lines``: of each place in the file.
    """
    about = [
        (len(keys), line)
        for place in places
        for keys, line in lines.items()
        if keys[: len(place)] == place and f"{fault.key}.".startswith(".".join(keys[len(place) :]))
    ]
    return fault._replace(
        file=str(path),
        key=".".join([*places[-1], fault.key] if fault.key else places[-1]),
        line=max(about, default=(0, None))[1],
    )
