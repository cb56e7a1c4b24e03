"""The page to explore a sweep."""

from geometry.blade import Blade
from geometry.project import read_json, write_json, write_whole
from rom.reconstruct import Basis
from simulate.sweeps.dataset import origin
from simulate.sweeps.peak import critical
from workflow.explore import page
from workflow.explore.blade import moving
from workflow.explore.results import arrays, facts
from workflow.figures.response import Response
from workflow.summary import panel


def write(
    blade: str,
    mesh: str,
    rom: str,
    basis: str,
    sweep: str,
    answers: str,
    operating: dict[str, object],
    names: dict[str, str],
    html: str,
    stress: str,
) -> None:
    """Write the page, and the largest stress at every speed.

    ``operating``: as of ``simulate.sweeps.peak.critical``.
    """
    response, of_basis = Response.read(sweep, rom), Basis.load(basis)
    of_basis.provenance.require(origin(response.sweep), basis)
    motion, of_blade, largest = None, {}, []
    if "motion" in response.sweep:
        settings = Blade.load(blade)
        motion, of_blade = moving(settings, mesh, of_basis, response.sweep, response.rom)
        largest = motion.pop("stress")
    of = {
        "scene": names["scene"],
        "speed_over_f1": response.speeds.tolist(),
        "largest_Pa": largest,
    }
    told = panel(read_json(answers), operating and critical(response.rom, operating), of)
    shown = facts(response, names["blade"], names["scene"]) | {
        "motion": motion,
        "answers": told,
        "operating": operating.get("lines", {}),
    }
    write_whole(page.html(shown, arrays(response) | of_blade), html)
    write_json(of, stress)
