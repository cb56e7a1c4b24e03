"""Both coatings with one choice of ours made otherwise: which of them moves which claim."""

from typing import Any

from rom.model import Rom
from simulate.peaks import close_in
from simulate.scene import Scene
from simulate.sweep import sweep
from workflow.paper.cases import CAUSES, COATINGS, of_coating
from workflow.paper.measure import coating


def pair(scene: Scene, rom: Rom, index: int) -> dict[str, Any]:
    """Numbers of both coatings under cause ``index`` of ``CAUSES``."""
    cause, numbers = CAUSES[index], {}
    for name, (young, plastic) in COATINGS.items():
        K = plastic if cause.K_over_E is None else cause.K_over_E * young
        here = of_coating(scene.changed(**cause.changes), young, K)
        found = close_in(here, rom, sweep(here, rom, here.speeds.omega(rom.f1)))
        numbers[name] = coating(found, rom)
    return numbers
