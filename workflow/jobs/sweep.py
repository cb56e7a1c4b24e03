"""Whole sweeps: with more speeds around the peaks that the scene asks for."""

from collections.abc import Mapping, Sequence
from typing import Any

from geometry.project import Say
from simulate.sweeps import closing_in
from simulate.sweeps.dataset import load, merge, require_rom, save
from workflow.jobs.march import Given


def of_blocks(
    scene: Mapping[str, Any],
    rom: str,
    settings: str,
    start: str,
    blocks: Sequence[str],
    names: Mapping[str, str],
    sweep: str,
    tell: Say,
) -> None:
    """Merge ``blocks``, and add speeds around peaks."""
    runs = merge([load(path) for path in blocks])
    of, model, choice, before = Given.of(scene, rom, settings, start)
    require_rom(runs, model)
    swept = closing_in.close_in(of, model, runs, tell, choice, before)
    save(swept.assign_attrs(name=names["scene"]), sweep)


def at_once(scene: Mapping[str, Any], rom: str, sweep: str, tell: Say) -> None:
    """Run the whole sweep in one job."""
    of, model, *_ = Given.of(scene, rom)
    save(closing_in.sweep(of, model, tell), sweep)
