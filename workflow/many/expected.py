"""Cost of a design before its rows are computed, from a sample of them."""

from contextlib import suppress
from random import Random
from statistics import mean

from geometry.base import UserError, duration
from rom.model import Rom
from simulate.errors.accuracy import Choice
from simulate.sweeps.cost import cost
from workflow.many.design import Design

SAMPLE = 100  # rows, at random: tables of all combinations repeat their rows in some step


def expected(design: Design, rom: Rom, choice: Choice | None = None) -> str:
    """Rows, runs, steps and time on one core of a design, in a line.

    ``rom``: of the scene's blade, taken for all; ``choice``: of the pilot, for their accuracy.
    """
    costs = []
    chosen = {*Random(1).sample(range(design.count), min(SAMPLE, design.count))}
    for row in design.rows(chosen):
        with suppress(UserError):  # it is refused where it is computed
            scene = choice.scene(row.scene) if choice and row.scene else row.scene
            costs += [cost(scene, rom)] if scene else []
    if not costs:
        return f"{design.count} rows; of {len(chosen)} that were looked at all are refused"
    speeds, steps, seconds = (
        design.count * mean(getattr(of, name) for of in costs)
        for name in ("speeds", "all_steps", "seconds")
    )
    return (
        f"{design.count} rows, some {speeds:.6g} runs without those added around peaks: "
        f"{steps:.2g} steps, some {duration(seconds)} on one core (from "
        f"{len(costs)} rows)"
    )
