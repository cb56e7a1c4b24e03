"""The animation of a scene at one speed."""

from collections.abc import Mapping
from typing import Any

from workflow.explore.rub import by_rounds, save
from workflow.figures.response import liner_and_tip
from workflow.jobs.given import given


def animate(
    scene: Mapping[str, Any],
    rom: str,
    choice: str,
    start: str,
    speed: float,
    subject: str,
    animation: str,
) -> None:
    """Run the scene at a ``speed`` over f1(0) revolution by revolution, and draw it.

    ``subject``: what its title names; ``choice``, ``start``: as of ``given``.
    """
    of, model, settings, before = given(scene, rom, choice, start)
    rub = by_rounds(of, model, speed, settings, before)
    save(rub, f"{subject}: {liner_and_tip(of)}", animation)
