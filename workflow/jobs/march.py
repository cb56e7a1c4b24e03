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
    of, model, *_ = given(scene, rom)
    choice = accuracy.pilot(of, model, check, mesh_error)
    tell_before(choice.scene(of), model, report)
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
    of, model, settings, before = given(scene, rom, choice, start)
    speeds = of.speeds.omega(model.f1)[block::blocks]  # all blocks cost the same
    marched = at_speeds(of, model, speeds, tell, settings, before)
    step = max(GROUPS // blocks, 1)
    save(
        merge(
            [
                as_sweep(marched[first::step], tell, settings)
                for first in range(min(step, len(marched)))
            ]
        ),
        runs,
    )
