"""The page to explore a sweep."""

from pathlib import Path
from typing import Any

from geometry.base import read_json, write_whole
from geometry.blade import Blade
from rom.reconstruct import Basis
from simulate.sweeps.crossings import critical
from simulate.sweeps.dataset import origin
from workflow.explore import page
from workflow.explore.blade import moving
from workflow.explore.results import arrays, facts
from workflow.figures.response import Response
from workflow.summary import panel


def write(
    blade: str,
    scene: str,
    mesh: str,
    rom: str,
    basis: str,
    sweep: str,
    answers: str,
    stress: str,
    operating: dict[str, Any],
    html: str,
) -> None:
    """Write the page of a ``scene``; its stresses may be missing.

    ``blade``: its file; ``operating``: as of ``simulate.sweeps.crossings.critical``.
    """
    response = Response.read(sweep, rom)
    full_basis = Basis.load(basis, origin(response.sweep))
    motion, blade_arrays = (
        moving(Blade.load(blade), mesh, full_basis, response.sweep, response.rom)
        if "motion" in response.sweep
        else (None, {})
    )
    campbell = critical(response.rom, operating)
    stresses = read_json(stress) if stress else None
    shown = facts(response, Path(blade).stem, scene, campbell) | {
        "motion": motion,
        "answers": panel(read_json(answers), campbell, stresses),
        "operating": operating["lines"],
    }
    write_whole(page.html(shown, arrays(response) | blade_arrays), html)
