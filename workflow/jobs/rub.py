"""The animation of a scene at one speed."""

from typing import Any

from workflow.explore.rub import by_rounds, save
from workflow.figures.response import liner_and_tip
from workflow.jobs.march import given


def animate(
    scene: dict[str, Any],
    rom: str,
    settings: str,
    start: str,
    names: dict[str, str],
    animation: str,
) -> None:
    """March the scene round by round, and draw it."""
    of, model, choice, before = given(scene, rom, settings, start)
    rub = by_rounds(of, model, float(names["speed"]), choice, before)
    title = f"scene {names['scene']}, blade {names['blade']}: {liner_and_tip(of)}"
    save(rub, title, animation)
