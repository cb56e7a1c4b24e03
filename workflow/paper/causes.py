"""Numbers of the claims with one choice changed: its influence on each claim."""

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

from rom.model import Rom
from simulate.errors.neighbour import Neighbour, same
from simulate.scene import Scene
from simulate.sweeps.closing_in import sweep
from workflow.paper import grid, measure
from workflow.paper.cases import COATINGS, ROWS, of_coating
from workflow.paper.choices import OF_SCENE, but
from workflow.paper.peaks import peak


def parts(
    scene: Scene, rom: Rom, cause: Neighbour, made: Mapping[str, Callable[[Scene], Scene]]
) -> dict[str, Any]:
    """Numbers of parts of the paper with the choice ``cause`` changed.

    ``made``: how the scene of each part is made of that of the cause.
    """
    scenes = {part: cause.scene(of(scene)) for part, of in made.items()}
    return {part: measure.PARTS[part](sweep(one, rom), rom) for part, one in scenes.items()}


def tips(scene: Scene, rom: Rom, cause: Neighbour) -> dict[str, Any]:
    """Numbers without and with tangential force, with the choice ``cause`` changed."""
    made = {"tilted": but(contact__tangential=False), "tangential": same}
    model = {"tangential_over_radial": measure.direction(rom)}
    return {**parts(scene, rom, cause, made), "model": model}


def table(scene: Scene, rom: Rom, cause: Neighbour) -> dict[str, Any]:
    """Numbers of the table of E and K, and the bare casing's, with ``cause`` changed."""
    here = cause.scene(scene)
    bare = sweep(here.but(liner__law={"kind": "rigid"}), rom)
    rows = [grid.row(here, rom, young) for young in ROWS.values()]
    return {"grid": measure.table(grid.grid(rows)), "long": {"rigid": peak(bare, rom, 4)}}


COATED = {part: partial(of_coating, E=E, K=K) for part, (E, K) in COATINGS.items()}
BY_SCENE = {  # by the scene of the causes, as in ``choices``
    "paper": partial(parts, made=COATED),
    "paper-tangential": tips,
    "paper-two-five": partial(parts, made={"two_five": same}),
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
