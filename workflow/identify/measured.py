"""Scenes at points of the parameters, and rows of an experiment for the paper's other claims."""

from collections.abc import Mapping
from itertools import product

import numpy as np

from simulate.scene import Scene
from workflow.experiment.plan import PlannedRow
from workflow.identify.steps import with_steps
from workflow.paper.printed import E, K

NUMBERS = {  # function of a part's numbers
    "e1": "workflow.paper.measure:coating",
    "e10": "workflow.paper.measure:coating",
    "two_five": "workflow.paper.measure:two_five",
    "grid": "workflow.paper.grid:without_twins",
    "rigid": "workflow.paper.measure:main_peak",
}
HARMONICS = {4: "fourth_over_second", 5: "fifth_over_second"}

type Scenes = Mapping[str, Scene]  # of the paper and of its table of E and K, by part


def at_point(scene: Scene, values: Mapping[str, float], order: int = 4) -> Scene:
    """A scene with the parameters of a point; ``order``: that of the casing's third harmonic."""
    unit = {} if scene.liner.law.kind == "rigid" else {"liner__law__unit_Pa": values["unit_Pa"]}
    shape = {0: values["constant_over_second"], 2: 1.0, order: values[HARMONICS[order]]}
    return scene.but(
        twin=False,
        damping_ratio=values["damping_ratio"],
        casing__scale=values["casing_gaps"] / largest_inward(shape),
        casing__harmonics=[
            {"order": k, "amplitude_gaps": abs(size), "phase_deg": 180.0 * (size < 0)}
            for k, size in shape.items()
        ],
        **unit,
    )


def largest_inward(shape: Mapping[int, float]) -> float:
    """Largest of the sum of cosines of these orders and amplitudes.

    >>> round(largest_inward({0: 0.75, 2: 1.0, 4: 0.25}), 6)
    2.0
    """
    theta = np.linspace(0, 2 * np.pi, 7201)
    return float(sum(size * np.cos(k * theta) for k, size in shape.items()).max())


def scenes_at(scenes: Scenes, values: Mapping[str, float], blade: str) -> dict[str, Scene]:
    """All scenes at a point; the casing of two and five diameters has no fourth harmonic."""
    return {
        part: at_point(scene.but(blade=blade), values, 5 if part == "two_five" else 4)
        for part, scene in scenes.items()
    }


def cases(name: str, scenes: Scenes, K_of_E1: float) -> list[PlannedRow]:
    """Rows of a point, as those of an edition of the paper called ``name``.

    ``K_of_E1``: K of the coating with E = 1. All have the steps that their liner asks for.
    """
    soft, grid = scenes["e10"].but(liner__law__E=1.0), scenes["grid"]
    rows = [
        ("e1", "", soft.but(liner__law__K=K_of_E1)),
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
            function=NUMBERS[label],
            against=None,
            needs=("rom",),
        )
        for label, row, scene in rows
    ]
