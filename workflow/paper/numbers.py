"""Functions of the paper's rules: from input files and settings to plain values or text."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from geometry.files import read_json
from rom.check import RomCheck
from rom.model import Rom
from simulate.dataset import load
from simulate.scene import Scene
from workflow.paper import causes, contact_map, grid, measure, report, stiffness, worst
from workflow.paper.cases import CAUSES, ROWS, TIPS
from workflow.paper.claims import CLAIMS
from workflow.paper.cost import cost
from workflow.paper.laws import slopes_over_closed_form

# Files of further runs (repeats, other blade, causes, maps), by group and name
type Further = Mapping[str, Mapping[str, str]]

TABLES = {  # functions of a row, and of the whole table from its rows
    "grid": (grid.row, grid.grid),
    "contact-map": (contact_map.row, contact_map.contact_map),
    "stiffness": (stiffness.row, stiffness.stiffness),
}
STUDIES = {  # function and choice of each cause, by the name of its file
    choice.file: (study, choice)
    for study, choices in ((causes.pair, CAUSES), (causes.tips, TIPS))
    for choice in choices
}


def _given(files: Any, scene: Mapping[str, Any]) -> tuple[Scene, Rom]:
    return Scene.model_validate(scene), Rom.load(files.rom)


def row(files: Any, scene: Mapping[str, Any], table: str, name: str) -> list[dict[str, Any]]:
    """One row of a table, by its name in ``ROWS``."""
    return TABLES[table][0](*_given(files, scene), ROWS[table][name])


def whole(files: Any, table: str) -> dict[str, Any]:
    """A table from the files of its rows."""
    return TABLES[table][1]([read_json(file) for file in files.rows])


def cause(files: Any, scene: Mapping[str, Any], name: str) -> dict[str, Any]:
    """Both coatings, or both tip forces, with one choice changed."""
    study, choice = STUDIES[name]
    return study(*_given(files, scene), choice)


def growth(files: Any, scene: Mapping[str, Any]) -> dict[str, Any]:
    """The worst coatings over ten times the rounds."""
    return worst.growth(*_given(files, scene), read_json(files.grid), load(files.rigid))


def model(files: Any) -> dict[str, Any]:
    """Sizes and errors of the blade reduced exactly as in the paper, and as here."""
    ours = Rom.load(files.rom), RomCheck.load(files.check)
    paper = Rom.load(files.paper), RomCheck.load(files.paper_check)
    return {"model": measure.model(*ours, *paper)}


def settled(files: Any, scene: Mapping[str, Any]) -> dict[str, Any]:
    """Numbers that do not depend on the coatings: densities, steps, laws, cost, stress."""
    return {
        "densities": measure.densities(*map(load, files.densities)),
        "steps": measure.steps([load(file) for file in files.steps]),
        "density_cost": measure.density_cost(*_given(files, scene)),
        "laws": slopes_over_closed_form(),
        "stress": measure.stress(read_json(files.peak)),
    }


def edition(files: Any, parts: list[str]) -> dict[str, Any]:
    """Numbers of one set of scenes that the claims compare."""
    sweeps = {part: load(files[part]) for part in parts}
    grown = read_json(files.grid), read_json(files.growth)
    numbers = measure.edition(sweeps, Rom.load(files.rom), *grown)
    for file in files.get("more", []):
        numbers |= read_json(file)
    return numbers


def _read(further: Further) -> dict[str, dict[str, Any]]:
    return {
        group: {name: read_json(file) for name, file in files.items()}
        for group, files in further.items()
    }


def claims(files: Any, further: Further) -> list[dict[str, Any]]:
    """Verdicts on the claims, with the repeats, other blades and causes that have been run."""
    of = _read(further)
    return report.verdicts(
        CLAIMS, read_json(files.numbers), of["repeats"], of["other"], of["causes"]
    )


def claims_text(files: Any, further: Further) -> str:
    """The claims table, and tables of the maps that have been run."""
    of = _read(further)
    kept = {"as they are": read_json(files.numbers), **of["repeats"]}
    e1 = {name: numbers["e1"]["peaks"] for name, numbers in kept.items()}
    maps = [contact_map.ranges(results, e1) for results in of["map"].values()]
    maps += [stiffness.units(results) for results in of["stiffness"].values()]
    return report.markdown(claims(files, further), "\n".join(maps))


def cost_text(files: Any, targets: Mapping[str, list[str]]) -> str:
    """Cost of the targets, from the benchmark files in their folders."""
    return cost(
        {
            target: sorted(file for of in folders for file in Path(of).glob("benchmarks/*.tsv"))
            for target, folders in targets.items()
        }
    )
