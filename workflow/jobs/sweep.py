"""Whole sweeps: with more speeds around the peaks that the scene asks for."""

from collections.abc import Iterable, Mapping
from typing import Any

from geometry.base import Say
from simulate.sweeps.dataset import load, merge, require_rom, save
from simulate.sweeps.sweep import close_in
from workflow.jobs.given import given


def of_blocks(
    name: str,
    scene: Mapping[str, Any],
    rom: str,
    choice: str,
    start: str,
    blocks: Iterable[str],
    sought: Mapping[str, Any],
    sweep: str,
    tell: Say,
) -> None:
    """Merge ``blocks`` of the scene of this ``name``, and add speeds around peaks.

    ``sought``: the number of ``modes``, and the ``orders``, of which peaks are sought;
    ``choice``, ``start``: as of ``given``.
    """
    of, model, settings, before = given(scene, rom, choice, start)
    runs = merge([*map(load, blocks)]).assign_attrs(sought)
    require_rom(runs, model)
    swept = close_in(of, model, runs, tell, settings, before)
    save(swept.assign_attrs(name=name), sweep)
