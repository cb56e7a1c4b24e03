"""Numbers for the paper's other claims, at points of the parameters: rows of an experiment."""

from collections.abc import Iterable, Mapping
from itertools import product

import numpy as np

from simulate.scene import LEADING, Scene
from workflow.experiment.plan import PlannedRow
from workflow.identify.steps import with_steps
from workflow.paper.printed import E, K

NUMBERS = {  # function of a part's numbers
    "e1": "workflow.paper.measure:coating",
    "e10": "workflow.paper.measure:coating",
    "two_five": "workflow.paper.measure:two_five",
    "grid": "workflow.paper.grid:without_twins",
    "rigid": "workflow.paper.measure:bare_casing",
}

type Scenes = Mapping[str, Scene]  # of the paper and of its table of E and K, by part


def at_point(scene: Scene, point: Scene) -> Scene:
    """A scene with the parameters of a point's scene."""
    law = (
        {"liner__law__unit_Pa": point.liner.law.unit_Pa} if scene.liner.law.kind != "rigid" else {}
    )
    return scene.but(
        blade=point.blade,
        twin=False,
        damping_ratio=point.damping_ratio,
        casing=point.casing,
        **law,
    )


def scenes_at(scenes: Scenes, point: Scene, span: float) -> dict[str, Scene]:
    """All scenes at a point. That of two and five diameters keeps its shape of the casing."""
    by_part = {part: at_point(scene, point) for part, scene in scenes.items()}
    return by_part | {"two_five": with_own_shape(scenes["two_five"], point, span)}


def with_own_shape(scene: Scene, point: Scene, span: float) -> Scene:
    """``at_point``, but the casing of ``scene``, as far inward as that of the point."""
    largest = [_largest_inward(one, span) for one in (point, scene.but(casing__scale=1.0))]
    return at_point(scene, point).but(casing=scene.casing.but(scale=largest[0] / largest[1]))


def _largest_inward(scene: Scene, span: float) -> float:
    """Largest inward distortion of a scene's casing, gaps."""
    gap = float(scene.clearance.gaps(LEADING, span))
    return float(scene.casing.inward(np.linspace(0, 2 * np.pi, 3601), gap).max()) / gap


def cases(name: str, scenes: Scenes, K_of_E1: Iterable[float]) -> list[PlannedRow]:
    """Rows of a point, as those of an edition of the paper called ``name``.

    Those of the coating with E = 1 are labelled with its K, as `e1 0.45`. All have the steps that
    their liner asks for.
    """
    soft, grid = scenes["e10"].but(liner__law__E=1.0), scenes["grid"]
    rows = [
        *((f"e1 {k:g}", "", soft.but(liner__law__K=k)) for k in K_of_E1),
        *((part, "", scenes[part]) for part in ("e10", "two_five", "rigid")),
        *(
            ("grid", f"E = {e:g}, K = {k:g}", grid.but(liner__law__E=e, liner__law__K=k))
            for e, k in product(E, K)
        ),
    ]
    return [
        PlannedRow(
            group="",
            label=label,
            names=(name, row),
            scene=with_steps(scene),
            directions=scene.directions,
            model=None,
            function=NUMBERS[label.partition(" ")[0]],
            against=None,
            needs=("rom",),
        )
        for label, row, scene in rows
    ]
