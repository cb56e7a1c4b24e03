"""Numbers of the claims with one choice of ours changed: its influence on each claim."""

from typing import Any

from rom.model import Rom
from simulate.over_speeds import sweep
from simulate.scene import Scene
from workflow.paper.cases import COATINGS, of_coating
from workflow.paper.choices import Cause
from workflow.paper.measure import coating, tip_force


def pair(scene: Scene, rom: Rom, cause: Cause) -> dict[str, Any]:
    """Numbers of both coatings with the choice ``cause`` changed."""
    numbers = {}
    for i, (name, (young, plastic)) in enumerate(COATINGS.items()):
        K = cause.K[i] if cause.K else plastic
        here = of_coating(scene.but(blade=cause.blade, **cause.changes), young, K)
        numbers[name] = coating(sweep(here, rom), rom)
    return numbers


def tips(scene: Scene, rom: Rom, cause: Cause) -> dict[str, Any]:
    """Numbers without and with tangential force, with the choice ``cause`` changed."""
    here = scene.but(**cause.changes)
    scenes = {"tilted": here.but(contact__tangential=False), "tangential": here}
    return {name: tip_force(sweep(tip, rom), rom) for name, tip in scenes.items()}
