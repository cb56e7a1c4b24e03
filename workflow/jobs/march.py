"""Runs of a scene at given speeds, and the decisions before them.

Their check is ``simulate.sweeps.over_speeds.check_sweep``.
"""

from collections.abc import Mapping
from typing import Any

from geometry.base import Say
from simulate.errors import accuracy
from simulate.sweeps.dataset import merge, save
from simulate.sweeps.over_speeds import as_sweep, at_speeds, tell_before
from workflow.jobs.given import given

GROUPS = 4  # of speeds, each with its own checks: the same ones in 1, 2 or 4 blocks


def pilot(
    scene: Mapping[str, Any], rom: str, check: str, mesh_error: str, report: Say
) -> dict[str, Any]:
    """Step, density and strips for a scene with an accuracy."""
    of = given(scene, rom)
    choice = accuracy.pilot(of.scene, of.rom, check, mesh_error)
    tell_before(choice.scene(of.scene), of.rom, report)
    return choice.plain()


def block(
    scene: Mapping[str, Any],
    rom: str,
    choice: str,
    start: str,
    block: int,
    blocks: int,
    runs: str,
    tell: Say,
) -> None:
    """Run one of the ``blocks`` of the speeds of a scene.

    ``choice``, ``start``: as of ``given``.
    """
    of = given(scene, rom, choice, start)
    speeds = of.scene.speeds.omega(of.rom.f1)[block::blocks]  # all blocks cost the same
    marched = at_speeds(of.scene, of.rom, speeds, tell, of.choice, of.start)
    step = max(GROUPS // blocks, 1)
    save(
        merge(
            [
                as_sweep(marched[first::step], tell, of.choice)
                for first in range(min(step, len(marched)))
            ]
        ),
        runs,
    )
