"""Functions of the paper's rules: numbers of its parts, from input files to plain values."""

from collections.abc import Mapping
from typing import Any

from geometry.project import read_json
from rom.check import RomCheck
from rom.model import Rom
from simulate.scene import Scene
from simulate.sweeps.dataset import load
from workflow.paper import grid, long, measure
from workflow.paper.editions import editions
from workflow.paper.laws import slopes_over_closed_form


def model(files: Any) -> dict[str, Any]:
    """Sizes and errors of the blade reduced exactly as in the paper, and as here."""
    ours = Rom.load(files.rom), RomCheck.load(files.check)
    paper = Rom.load(files.paper), RomCheck.load(files.paper_check)
    return {"model": measure.model(*ours, *paper)}


def settled(files: Any, scene: Mapping[str, Any]) -> dict[str, Any]:
    """Numbers that do not depend on the coatings: densities, steps, laws, cost, stress."""
    given = Scene.model_validate(scene), Rom.load(files.rom)
    return {
        "densities": measure.densities(*map(load, files.densities)),
        "steps": measure.steps([load(file) for file in files.steps]),
        "density_cost": measure.density_cost(*given),
        "laws": slopes_over_closed_form(),
        "stress": measure.stress(read_json(files.peak)),
    }


def of_scenes(files: Any) -> dict[str, Any]:
    """Numbers that the claims compare: of sweeps of scenes, and of the table of E and K."""
    rom = Rom.load(files.rom)
    (of_table,) = editions(files.grid, files.growth).values()
    numbers = {
        part: measure.PARTS[part](load(files[part]), rom) for part in measure.PARTS
    } | of_table
    for file in files.more:
        numbers |= read_json(file)
    return numbers


def of_grid(files: Any) -> dict[str, Any]:
    """The table of E and K."""
    return grid.of_rows(read_json(files.table))


def worst(files: Any) -> dict[str, Any]:
    """Long runs of the worst coatings, and the peak of the bare casing."""
    (cases,) = read_json(files.growth).values()
    (rigid,) = [row["numbers"] for row in read_json(files.table) if row["scene"] == "rigid"]
    return {"cases": cases, "rigid": rigid}


def long_times(files: Any) -> dict[str, Any]:
    """Runs beyond the paper's twenty rounds, and through its peak."""
    return long.numbers(
        [load(file) for file in files.long], {name: load(files[name]) for name in long.SWEEPS}
    )
