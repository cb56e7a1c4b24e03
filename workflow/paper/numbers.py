"""Functions of the paper's rules: from input files and settings to plain values or text."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from geometry.project import read_json
from rom.check import RomCheck
from rom.model import Rom
from simulate.scene import Scene
from simulate.sweeps.dataset import load
from workflow.identify.priors import Priors
from workflow.identify.shares import distributions
from workflow.paper import causes, conclusions, grid, long, measure, page, report, worst
from workflow.paper.cases import COATINGS, ROWS
from workflow.paper.choices import OF_SCENE
from workflow.paper.claims import CLAIMS
from workflow.paper.cost import cost
from workflow.paper.laws import slopes_over_closed_form

K_OF_E1 = f"{COATINGS['e1'][1]:g}"  # of the draws whose shares are shown

PARTS = {
    **dict.fromkeys(("e1", "e10"), measure.coating),  # the two coatings
    "two_five": measure.two_five,  # the casing of two and five diameters
    **dict.fromkeys(("tilted", "tangential"), measure.tip_force),  # without, with tangential force
}

# Files of further runs (repeats, other blade, causes), by group and name
type Further = Mapping[str, Mapping[str, str]]

STUDIES = {  # function and choice of each cause, by the name of its file
    choice.file: (causes.STUDIES[scene], choice)
    for scene, choices in OF_SCENE.items()
    for choice in choices
}


def _given(files: Any, scene: Mapping[str, Any]) -> tuple[Scene, Rom]:
    return Scene.model_validate(scene), Rom.load(files.rom)


def row(files: Any, scene: Mapping[str, Any], name: str) -> list[dict[str, Any]]:
    """One row of the table of E and K, by its name in ``ROWS``."""
    return grid.row(*_given(files, scene), ROWS[name])


def whole(files: Any) -> dict[str, Any]:
    """The table of E and K from the files of its rows."""
    return grid.grid([read_json(file) for file in files.rows])


def cause(files: Any, scene: Mapping[str, Any], name: str) -> dict[str, Any]:
    """Numbers with one choice changed."""
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
    """Numbers of one set of scenes that the claims compare: of its ``parts``, and of its table."""
    rom = Rom.load(files.rom)
    numbers = {part: PARTS[part](load(files[part]), rom) for part in parts}
    numbers["grid"] = measure.table(read_json(files.grid))
    numbers["long"] = measure.long_run(read_json(files.growth))
    for file in files.get("more", []):
        numbers |= read_json(file)
    return numbers


def long_times(files: Any) -> dict[str, Any]:
    """Runs beyond the paper's twenty rounds, and through its peak."""
    return long.numbers(
        [load(file) for file in files.long], {name: load(files[name]) for name in long.SWEEPS}
    )


def _read(further: Further) -> dict[str, dict[str, Any]]:
    return {
        group: {name: read_json(file) for name, file in files.items()}
        for group, files in further.items()
    }


def claims(files: Any, further: Further) -> list[dict[str, Any]]:
    """Verdicts on the claims, with the repeats, other blades and causes that have been run."""
    of = _read(further)
    drawn = [distributions(found, K_OF_E1) for found in of.pop("shares").values()]
    shares = {name: found["holds"] for each in drawn for name, found in each.items()}
    return report.verdicts(CLAIMS, read_json(files.numbers), **of, shares=shares)


def claims_text(files: Any, further: Further) -> str:
    """The claims table."""
    return report.markdown(claims(files, further))


def claims_page(files: Any, further: Further) -> str:
    """The page of figures and claims."""
    return page.html(claims(files, further))


def conclusions_text(files: Any) -> str:
    """What a reader may conclude."""
    read = (read_json(files[name]) for name in ("claims", "fits", "long"))
    return conclusions.text(*read, Priors.load(files.priors))


def cost_text(files: Any, targets: Mapping[str, list[str]]) -> str:
    """Cost of the targets, from the benchmark files in their folders."""
    return cost(
        {
            target: sorted(file for of in folders for file in Path(of).glob("benchmarks/*.tsv"))
            for target, folders in targets.items()
        }
    )
