"""Runs of a scene at given speeds, and what is decided before them."""

from typing import Any

import xarray as xr

from geometry.project import Say
from rom.model import Rom
from simulate.errors import accuracy
from simulate.errors.accuracy import Choice
from simulate.scene import Scene
from simulate.sweeps.dataset import load, save
from simulate.sweeps.over_speeds import at_speeds, check_sweep, tell_before

type Given = tuple[Scene, Rom, Choice | None, xr.Dataset | None]


def given(scene: dict[str, Any], rom: str, settings: str = "", start: str = "") -> Given:
    """A scene, its model, the choice of its accuracy, and the sweep that it goes on from.

    The latter two are None where there is no file of theirs.
    """
    choice = Choice.load(settings) if settings else None
    return Scene.model_validate(scene), Rom.load(rom), choice, load(start) if start else None


def check(scene: dict[str, Any], rom: str, now: Say) -> None:
    """Check a scene against its reduced model: what no block of its sweep could march."""
    check_sweep(Scene.model_validate(scene), Rom.load(rom), now)


def pilot(scene: dict[str, Any], rom: str, check: str, mesh_error: str, now: Say) -> dict[str, Any]:
    """Step, density and strips for a scene with an accuracy."""
    of, model, *_ = given(scene, rom)
    choice = accuracy.pilot(of, model, check, mesh_error)
    tell_before(choice.scene(of), model, now)
    return choice.plain()


def block(
    scene: dict[str, Any],
    rom: str,
    settings: str,
    start: str,
    blocks: int,
    names: dict[str, str],
    runs: str,
    tell: Say,
) -> None:
    """Run one of the ``blocks`` of the speeds of a scene."""
    of, model, choice, before = given(scene, rom, settings, start)
    speeds = of.speeds.omega(model.f1)[int(names["block"]) :: blocks]  # all blocks cost the same
    save(at_speeds(of, model, speeds, tell, choice, before), runs)
