"""The animation of a scene at one speed."""

from collections.abc import Mapping
from typing import Any

from workflow.explore.rub import by_rounds, save
from workflow.figures.response import liner_and_tip
from workflow.jobs.march import Given


def animate(
    scene: Mapping[str, Any],
    rom: str,
    settings: str,
    start: str,
    names: Mapping[str, str],
    animation: str,
) -> None:
    """March the scene round by round, and draw it."""
    of, model, choice, before = Given.of(scene, rom, settings, start)
    rub = by_rounds(of, model, float(names["speed"]), choice, before)
    title = f"scene {names['scene']}, blade {names['blade']}: {liner_and_tip(of)}"
    save(rub, title, animation)
