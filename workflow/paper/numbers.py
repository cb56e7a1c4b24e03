"""Functions of the paper's rules: numbers of its parts as plain values."""

from collections.abc import Mapping, Sequence
from typing import Any

from rom.model import Rom
from simulate.scene import Scene
from simulate.sweeps.dataset import Sweep
from workflow.experiment.row import ExperimentRow
from workflow.paper import measure
from workflow.paper.editions import numbers_of
from workflow.paper.laws import slopes_over_closed_form
from workflow.paper.measure import Numbers


def settled(
    rom: Rom, densities: list[Sweep], steps: list[Sweep], stress: Numbers, scene: Scene
) -> Numbers:
    """Numbers that do not depend on the coatings: densities, steps, laws, cost, stress."""
    return {
        "densities": measure.densities(*densities),
        "steps": measure.steps(steps),
        "density_cost": measure.density_cost(scene, rom),
        "laws": slopes_over_closed_form(),
        "stress": measure.stress(stress),
    }


def of_scenes(
    rom: Rom,
    e1: Sweep,
    e10: Sweep,
    two_five: Sweep,
    tilted: Sweep,
    tangential: Sweep,
    grid: Sequence[ExperimentRow],
    growth: Mapping[str, Any],
    more: list[Numbers],
) -> Numbers:
    """Numbers that the claims compare: of sweeps of scenes, and of the table of E and K."""
    numbers = {
        "e1": measure.coating(e1, rom),
        "e10": measure.coating(e10, rom),
        "two_five": measure.two_five(two_five, rom),
        "tilted": measure.tip_force(tilted, rom),
        "tangential": measure.tip_force(tangential, rom),
    }
    for part in [*numbers_of(grid, growth).values(), *more]:
        numbers |= part
    return numbers


def worst(table: Sequence[ExperimentRow], growth: Mapping[str, Sequence[Any]]) -> dict[str, Any]:
    """Long runs of the worst coatings, and the peak of the bare casing."""
    (cases,) = growth.values()
    (rigid,) = [row["numbers"] for row in table if row["scene"] == "rigid"]
    return {"cases": cases, "rigid": rigid}
