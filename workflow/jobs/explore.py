"""The page to explore a sweep."""

from typing import Any

from geometry.blade import Blade
from geometry.project import read_json, write_whole
from rom.reconstruct import Basis
from simulate.sweeps.dataset import origin
from simulate.sweeps.peak import critical
from workflow.explore import page
from workflow.explore.blade import moving
from workflow.explore.results import arrays, facts
from workflow.figures.response import Response
from workflow.summary import panel


def write(
    blade: Blade,
    mesh: str,
    rom: str,
    basis: str,
    sweep: str,
    answers: str,
    stress: dict[str, Any] | None,
    operating: dict[str, object],
    names: dict[str, str],
    html: str,
) -> None:
    """Write the page.

    ``operating``: as of ``simulate.sweeps.peak.critical``.
    """
    response = Response.read(sweep, rom)
    of_basis = Basis.load(basis, origin(response.sweep))
    motion, of_blade = None, {}
    if "motion" in response.sweep:
        motion, of_blade = moving(blade, mesh, of_basis, response.sweep, response.rom)
    found = operating and critical(response.rom, operating)
    told = panel(read_json(answers), found, stress)
    shown = facts(response, names["blade"], names["scene"]) | {
        "motion": motion,
        "answers": told,
        "operating": operating.get("lines", {}),
    }
    write_whole(page.html(shown, arrays(response) | of_blade), html)
