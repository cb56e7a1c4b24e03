"""Whole sweeps: with more speeds around the peaks that the scene asks for."""

from typing import Any

from geometry.project import Say
from simulate.sweeps import closing_in
from simulate.sweeps.dataset import load, merge, require_rom, save
from workflow.jobs.march import given


def of_blocks(
    scene: dict[str, Any],
    rom: str,
    settings: str,
    start: str,
    blocks: list[str],
    names: dict[str, str],
    sweep: str,
    tell: Say,
) -> None:
    """Merge ``blocks``, and add speeds around peaks."""
    runs = merge([load(path) for path in blocks])
    of, model, choice, before = given(scene, rom, settings, start)
    require_rom(runs, model)
    swept = closing_in.close_in(of, model, runs, tell, choice, before)
    save(swept.assign_attrs(name=names["scene"]), sweep)
