"""Numbers that the claims compare, at draws of the prior and of posteriors."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from geometry.project import read_json
from rom.model import Rom
from simulate.scene import Scene
from simulate.scene.design import Design
from workflow.identify.fits import DRAWS, POSTERIORS, PRIOR, drawn_of
from workflow.identify.likelihood import K_OF_E1
from workflow.identify.measured import Kept, measured
from workflow.identify.table import COATINGS


def at_draws(
    files: Any,
    scene: Mapping[str, Any],
    parts: Mapping[str, Any],
    draws: str,
    block: int,
    blocks: int,
    folder: str,
) -> list[dict[str, Any]]:
    """Numbers at every ``blocks``-th of the draws, of the prior or of a posterior, from ``block``.

    ``scene``: of the tables; ``parts``: of the claims, by part; ``folder``: of ``Kept``.
    """
    rom, of_points = Rom.load(files.rom), _scenes(files, scene)
    scenes = {part: Scene.model_validate(given) for part, given in parts.items()}
    of_E1 = K_OF_E1 if draws == PRIOR else [POSTERIORS[draws][0]]
    drawn = range(DRAWS) if draws == PRIOR else drawn_of(read_json(files.fits), draws)
    indices = drawn[block::blocks]
    kept = Kept(Path(folder), rom)
    return [{"point": i} | measured(scenes, of_points[i], kept, of_E1) for i in indices]


def _scenes(files: Any, scene: Mapping[str, Any]) -> list[Scene]:
    """A scene of each point: that of its first coating."""
    base = Scene.model_validate(scene)
    designs = [Design.of(base.but(design=Path(file).name), Path(file)) for file in files.tables]
    return [row for each in designs for row in each.scenes[:: len(COATINGS)]]
