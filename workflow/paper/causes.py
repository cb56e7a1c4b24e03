"""Numbers of the claims with one choice of ours changed: its influence on each claim."""

from collections.abc import Mapping
from typing import Any

from rom.model import Rom
from simulate.errors.neighbour import Neighbour
from simulate.scene import Scene
from simulate.sweeps.closing_in import sweep
from workflow.paper import grid, measure
from workflow.paper.cases import COATINGS, ROWS, of_coating
from workflow.paper.choices import OF_SCENE
from workflow.paper.peaks import peak


def pair(scene: Scene, rom: Rom, cause: Neighbour) -> dict[str, Any]:
    """Numbers of both coatings with the choice ``cause`` changed."""
    numbers = {}
    for name, coating in COATINGS.items():
        here = cause.scene(of_coating(scene, *coating))
        numbers[name] = measure.coating(sweep(here, rom), rom)
    return numbers


def tips(scene: Scene, rom: Rom, cause: Neighbour) -> dict[str, Any]:
    """Numbers without and with tangential force, with the choice ``cause`` changed."""
    here = cause.scene(scene)
    scenes = {"tilted": here.but(contact__tangential=False), "tangential": here}
    numbers = {name: measure.tip_force(sweep(tip, rom), rom) for name, tip in scenes.items()}
    return numbers | {"model": {"tangential_over_radial": measure.direction(rom)}}


def two_five(scene: Scene, rom: Rom, cause: Neighbour) -> dict[str, Any]:
    """Numbers of the casing with two and five diameters, with the choice ``cause`` changed."""
    return {"two_five": measure.two_five(sweep(cause.scene(scene), rom), rom)}


def table(scene: Scene, rom: Rom, cause: Neighbour) -> dict[str, Any]:
    """Numbers of the table of E and K, and the bare casing's, with ``cause`` changed."""
    here = cause.scene(scene)
    bare = sweep(here.but(liner__law={"kind": "rigid"}), rom)
    rows = [grid.row(here, rom, young) for young in ROWS.values()]
    return {"grid": measure.table(grid.grid(rows)), "long": {"rigid": peak(bare, rom, 4)}}


BY_SCENE = {  # by the scene of the causes, as in ``choices``
    "paper": pair,
    "paper-tangential": tips,
    "paper-two-five": two_five,
    "paper-grid": table,
}
STUDIES = {  # function and choice of each cause, by the name of its file
    choice.file: (BY_SCENE[scene], choice)
    for scene, choices in OF_SCENE.items()
    for choice in choices
}


def of_cause(files: Any, scene: Mapping[str, Any], name: str) -> dict[str, Any]:
    """Numbers with one choice changed, from the files of a rule."""
    study, choice = STUDIES[name]
    return study(Scene.model_validate(scene), Rom.load(files.rom), choice)
