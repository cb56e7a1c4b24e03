"""What the runs of a scene are given, read from its settings and files."""

from collections.abc import Mapping
from typing import Any, NamedTuple

from geometry.base import check_settings
from rom.model import Rom
from simulate.errors.accuracy import Choice
from simulate.scene import Scene
from simulate.sweeps.dataset import Sweep, load


class Given(NamedTuple):
    """A scene, its model, what the pilot chose, and the sweep that it starts from."""

    scene: Scene
    rom: Rom
    choice: Choice | None
    start: Sweep | None


def given(scene: Mapping[str, Any], rom: str, choice: str = "", start: str = "") -> Given:
    """Read all; files of a choice and a start may be missing."""
    return Given(
        check_settings(Scene, dict(scene), ""),
        Rom.load(rom),
        Choice.load(choice) if choice else None,
        load(start) if start else None,
    )
