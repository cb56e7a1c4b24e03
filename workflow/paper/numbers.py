"""Numbers of the claims: of the paper's scenes, and by edition.

Editions are repeats, choices made otherwise, another blade. The first name of a row of an
experiment is that of its edition, its label that of the part.
"""

from collections.abc import Mapping, Sequence
from typing import Any

from geometry.base import read_json
from rom.model import Rom
from simulate.scene import Scene
from simulate.sweeps.dataset import Sweep
from workflow.many.row import ComputedRow
from workflow.many.table import Whole, whole
from workflow.paper import measure
from workflow.paper.grid import growth, long_cases, of_rows, worst
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
    grid: Whole,
    growth: Mapping[str, Any],
    more: list[Numbers],
) -> Numbers:
    """Numbers that the claims compare: of sweeps of scenes, and of the table of E and K."""
    parts = *numbers_of(grid, growth).values(), *more
    return {
        "e1": measure.coating(e1, rom),
        "e10": measure.coating(e10, rom),
        "two_five": measure.two_five(two_five, rom),
        "tilted": measure.tip_force(tilted, rom),
        "tangential": measure.tip_force(tangential, rom),
        **{name: numbers for part in parts for name, numbers in part.items()},
    }


def worst_runs(table: Whole, growth: Mapping[str, Sequence[Any]]) -> dict[str, Any]:
    """Long runs of the worst coatings, and the peak of the bare casing."""
    (cases,) = growth.values()
    (rigid,) = [row["numbers"] for row in table if row["scene"] == "rigid"]
    return {"cases": cases, "rigid": rigid}


def editions(table: str, growth: str = "", model: str = "") -> dict[str, Numbers]:
    """Numbers of all editions in the table of an experiment.

    ``growth``: file of ``growth_of`` the same table; ``model``: of the reduced models.
    """
    model_numbers = read_json(model) if model else {}
    long = read_json(growth) if growth else {}
    return {
        name: numbers | model_numbers for name, numbers in numbers_of(whole(table), long).items()
    }


def numbers_of(rows: Sequence[ComputedRow], long: Mapping[str, Any]) -> dict[str, Numbers]:
    """Numbers by edition and by part; ``long``: ``growth_of`` the same rows.

    Of the coatings they are those of their table, as far as they have peaks, and their growth
    beside the peak of the bare casing, where there is one.
    """
    found = {}
    for name, edition in _by_edition(rows).items():
        parts = {row["scene"]: row["numbers"] for row in edition if row["scene"] != "grid"}
        coatings, cases = of_rows(edition), long.get(name, [])
        if worst(coatings):
            parts["grid"] = measure.table(coatings)
        if "rigid" in parts and cases is not None:
            parts["long"] = measure.long_run(parts["rigid"], cases)
        found[name] = {part: numbers for part, numbers in parts.items() if part != "rigid"}
    return found


def growth_of(table: Whole) -> dict[str, Any]:
    """Long runs of each edition with the table of E and K; None where a coating has no peak."""
    return {
        name: [
            growth(Scene.model_validate(row["settings"]), Rom.load(row["rom"]), long, case)
            for long, case in long_cases(of_rows(edition)).items()
            for row in edition
            if row["numbers"] is case
        ]
        or None
        for name, edition in _by_edition(table).items()
        if any(row["scene"] == "grid" for row in edition)
    }


def _by_edition(rows: Sequence[ComputedRow]) -> dict[str, list[ComputedRow]]:
    names = dict.fromkeys(row["names"][0] for row in rows)
    return {name: [row for row in rows if row["names"][0] == name] for name in names}
