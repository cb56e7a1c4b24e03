"""Functions of the rules of `identify`: fits and shares, from input files to plain values."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from geometry.project import read_json
from workflow.identify.fits import Drawn, fit, off_medoid
from workflow.identify.likelihood import FITS, K_OF_E1, SHIFTS, WITH_ORDER, Fit
from workflow.identify.points import marched
from workflow.identify.priors import Priors
from workflow.identify.proposal import served
from workflow.identify.shares import shares, verdicts


def fits(files: Any) -> dict[str, Any]:
    """All fits from all tables."""
    tables, priors = marched(files), Priors.load(files.priors)
    drawn = Drawn.of(tables)
    values = priors.values(drawn.points)
    return {
        "values": {name: of.tolist() for name, of in values.items()},
        "served": served(tables[0]),
        "fits": {of.name: fit(of, drawn, values) for of in FITS},
    }


def of_scene(files: Any, parameters: Mapping[str, float]) -> dict[str, float | None]:
    """How near to the medoid of the fit that they are taken from the parameters of a scene are."""
    points = np.vstack([read_json(table)["points"] for table in files.points])
    at = Priors.load(files.priors).point(parameters)
    return {"off_medoid": off_medoid(read_json(files.fits), points, at)}


def blades(files: Any, names: Sequence[str]) -> dict[str, dict[str, Any]]:
    """Fits of the reading that the draws served, by blade and by K of the coating with E = 1."""
    return {name: _of_served(read_json(file)) for name, file in zip(names, files.fits, strict=True)}


def _of_served(found: Mapping[str, Any]) -> dict[str, Any]:
    fits = {f"{K:g}": found["fits"][Fit(K, found["served"]).name] for K in K_OF_E1}
    return {
        "served": found["served"],
        "fits": {
            K: {
                "chi_squared": of["chi_squared"],
                **{key: of[SHIFTS][key] for key in ("met", "effective", "evidence", "ranges")},
                "evidence_with_order": of[WITH_ORDER]["evidence"],
            }
            for K, of in fits.items()
        },
    }


def shares_of(files: Any, draws: Sequence[str]) -> dict[str, dict[str, Any]]:
    """Shares at which the claims hold, by draws and by K of the coating with E = 1.

    ``draws``: of each file of ``files.measured``.
    """
    of_draws: dict[str, list[dict[str, Any]]] = {name: [] for name in draws}
    for name, file in zip(draws, files.measured, strict=True):
        of_draws[name] += read_json(file)
    return {
        name: {K: shares([verdicts(draw, K) for draw in each]) for K in sorted(each[0]["e1"])}
        for name, each in of_draws.items()
        if each  # a posterior of too few effective points has no draws
    }
