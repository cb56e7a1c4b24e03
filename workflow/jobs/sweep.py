"""Whole sweeps: with more speeds around the peaks that the scene asks for."""

from typing import Any

from geometry.base import Say
from rom.model import Rom
from simulate.errors.accuracy import Choice
from simulate.scene import Scene
from simulate.sweeps.dataset import Sweep, merge, require_rom, save
from simulate.sweeps.sweep import close_in


def of_blocks(
    scene: Scene,
    rom: Rom,
    settings: Choice | None,
    start: Sweep | None,
    blocks: list[Sweep],
    sought: dict[str, Any],
    names: dict[str, str],
    sweep: str,
    tell: Say,
) -> None:
    """Merge ``blocks``, and add speeds around peaks.

    ``sought``: the number of ``modes``, and the ``orders``, of which peaks are sought.
    """
    runs = merge(blocks).assign_attrs(sought)
    require_rom(runs, rom)
    swept = close_in(scene, rom, runs, tell, settings, start)
    save(swept.assign_attrs(name=names["scene"]), sweep)
