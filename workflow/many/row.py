"""A row of many runs: a scene on its model, and the function that makes its numbers."""

from typing import Any, NotRequired, TypedDict

from geometry.base import Settings
from simulate.scene import Scene

FILES = {  # of a model, by names that functions of numbers have for them
    "rom": "results/{blade}/rom-{directions}.nc",
    "mesh": "results/{blade}/blade.msh",
    "matrices": "results/{blade}/matrices.h5",
    "full": "results/{blade}/full-model.nc",
    "check": "results/{blade}/rom-check-{directions}.nc",
    "basis": "results/{blade}/basis-{directions}.h5",
}


class About(TypedDict):
    """What a row is: an entry of the file of a block, in which its key finds its numbers."""

    number: int  # in its table, from 1
    key: NotRequired[str]  # hash of all that decides its numbers
    refused: NotRequired[str]  # why it has none
    group: str
    row: str  # its name
    names: list[str]  # the parts of the name, from each list of the group
    scene: str  # label of the scene
    blade: str
    against: str | None  # name of the row with which it is compared
    rom: str  # file of the reduced model
    settings: dict[str, Any]  # of the scene; of a design the values of its columns


class ComputedRow(About):
    """A row of a table, with its numbers."""

    cpu_s: float
    numbers: Any  # of its function; None where it is refused


class Row(Settings):
    """A row before it is computed."""

    number: int = 1  # in its table, from 1
    group: str = ""
    label: str = ""  # of the scene
    names: tuple[str, ...]  # of the row, from each list of the group
    against: str | None = None  # row of the same scene
    scene: Scene | None  # None where it is refused
    refused: tuple[str, ...] = ()  # why it has no valid scene
    given: dict[str, Any] | None = None  # of a design: values of its columns
    directions: str = "r"  # interface directions of its model
    model: str | None = None  # function that makes another model of it, as module:function
    function: str  # of its numbers, as module:function
    needs: tuple[str, ...] = ("rom",)  # of ``FILES``, the reduced model where it is run

    @property
    def row(self) -> str:
        """Name of the row."""
        return ", ".join(self.names)

    def file(self, name: str) -> str:
        """File of its model with a name of ``FILES``."""
        return FILES[name].format(blade=self.scene.blade, directions=self.directions)

    @property
    def about(self) -> About:
        """What its table says of it beside its numbers."""
        settings = self.scene.model_dump(mode="json") if self.given is None else self.given
        return {
            "number": self.number,
            "group": self.group,
            "row": self.row,
            "names": list(self.names),
            "scene": self.label,
            "blade": self.scene.blade if self.scene else "",
            "against": self.against,
            "rom": self.file("rom") if self.scene else "",
            "settings": settings,
        }
