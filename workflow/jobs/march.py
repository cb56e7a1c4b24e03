"""Runs of a scene at given speeds, and what is settled before them."""

from collections.abc import Mapping
from typing import Any, NamedTuple

import xarray as xr

from geometry.project import Say
from rom.model import Rom
from simulate.errors.accuracy import NOT_KNOWN, Choice, basis_error, choose
from simulate.errors.accuracy import mesh_error as error_of_mesh
from simulate.scene import Scene
from simulate.sweeps.dataset import load, save
from simulate.sweeps.over_speeds import at_speeds, block_speeds, check_sweep, tell_before


class Given(NamedTuple):
    """What a march needs."""

    scene: Scene
    rom: Rom
    choice: Choice | None  # of a scene with an accuracy
    start: xr.Dataset | None  # the sweep that the scene goes on from

    @classmethod
    def of(cls, scene: Mapping[str, Any], rom: str, settings: str = "", start: str = "") -> "Given":
        """From the settings of a scene and files; the latter two where the scene needs them."""
        return cls(
            Scene.model_validate(scene),
            Rom.load(rom),
            Choice.load(settings) if settings else None,
            load(start) if start else None,
        )


def check(scene: Mapping[str, Any], rom: str, now: Say) -> None:
    """Check a scene against its reduced model: what no block of its sweep could march."""
    check_sweep(Scene.model_validate(scene), Rom.load(rom), now)


def pilot(
    scene: Mapping[str, Any], rom: str, check: str, mesh_error: str, now: Say
) -> dict[str, Any]:
    """Step, density and strips for a scene with an accuracy."""
    of, model, *_ = Given.of(scene, rom)
    if model.foreign:
        print(NOT_KNOWN)
    of_mesh = error_of_mesh(mesh_error, model) if mesh_error else None
    choice = choose(of, model, basis_error(check, model), of_mesh)
    tell_before(choice.scene(of), model, now)
    return choice.plain()


def block(
    scene: Mapping[str, Any],
    rom: str,
    settings: str,
    start: str,
    blocks: int,
    names: Mapping[str, str],
    runs: str,
    tell: Say,
) -> None:
    """Run one of the ``blocks`` of the speeds of a scene."""
    of, model, choice, before = Given.of(scene, rom, settings, start)
    speeds = block_speeds(of, model, int(names["block"]), blocks)
    save(at_speeds(of, model, speeds, tell, choice, before), runs)
