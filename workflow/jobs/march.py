"""Runs of a scene at given speeds, and the decisions before them.

Their check is ``simulate.sweeps.over_speeds.check_sweep``.
"""

from typing import Any

from geometry.base import Say
from rom.model import Rom
from simulate.errors import accuracy
from simulate.errors.accuracy import Choice
from simulate.scene import Scene
from simulate.sweeps.dataset import Sweep, merge, save
from simulate.sweeps.over_speeds import as_sweep, at_speeds, tell_before

GROUPS = 4  # of speeds, each with its own checks: the same ones in 1, 2 or 4 blocks


def pilot(scene: Scene, rom: Rom, check: str, mesh_error: str, report: Say) -> dict[str, Any]:
    """Step, density and strips for a scene with an accuracy."""
    choice = accuracy.pilot(scene, rom, check, mesh_error)
    tell_before(choice.scene(scene), rom, report)
    return choice.plain()


def block(
    scene: Scene,
    rom: Rom,
    settings: Choice | None,
    start: Sweep | None,
    blocks: int,
    names: dict[str, str],
    runs: str,
    tell: Say,
) -> None:
    """Run one of the ``blocks`` of the speeds of a scene."""
    speeds = scene.speeds.omega(rom.f1)[int(names["block"]) :: blocks]  # all blocks cost the same
    marched, step = at_speeds(scene, rom, speeds, tell, settings, start), max(GROUPS // blocks, 1)
    save(
        merge(
            [
                as_sweep(marched[first::step], tell, settings)
                for first in range(min(step, len(marched)))
            ]
        ),
        runs,
    )
