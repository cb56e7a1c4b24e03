"""A computed row of an experiment, as its table and the files of its blocks have it."""

from typing import Any, TypedDict


class ExperimentRow(TypedDict):
    """A row on one of its scenes."""

    group: str
    row: str  # its name
    names: list[str]  # the parts of the name, from each list of the group
    scene: str  # label of the scene
    blade: str
    against: str | None  # name of the row with which it is compared
    rom: str  # file of the reduced model
    settings: dict[str, Any]  # of the scene
    cpu_s: float
    numbers: Any  # of the experiment's function
