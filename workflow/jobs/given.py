"""What the runs of a scene are given, read from its settings and files."""

from collections.abc import Mapping
from typing import Any

from geometry.base import check_settings
from rom.model import Rom
from simulate.errors.accuracy import Choice
from simulate.scene import Scene
from simulate.sweeps.dataset import Sweep, load


def given(
    scene: Mapping[str, Any], rom: str, choice: str = "", start: str = ""
) -> tuple[Scene, Rom, Choice | None, Sweep | None]:
    """The scene, its model, what the pilot chose, and the sweep that it starts from.

    Files of a choice and a start may be missing.
    """
    return (
        check_settings(Scene, dict(scene), ""),
        Rom.load(rom),
        Choice.load(choice) if choice else None,
        load(start) if start else None,
    )
