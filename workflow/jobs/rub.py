"""The animation of a scene at one speed."""

from rom.model import Rom
from simulate.errors.accuracy import Choice
from simulate.scene import Scene
from simulate.sweeps.dataset import Sweep
from workflow.explore.rub import by_rounds, save
from workflow.figures.response import liner_and_tip


def animate(
    scene: Scene,
    rom: Rom,
    settings: Choice | None,
    start: Sweep | None,
    names: dict[str, str],
    animation: str,
) -> None:
    """Run the scene revolution by revolution, and draw it."""
    rub = by_rounds(scene, rom, float(names["speed"]), settings, start)
    title = f"scene {names['scene']}, blade {names['blade']}: {liner_and_tip(scene)}"
    save(rub, title, animation)
