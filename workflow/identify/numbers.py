"""Functions of the rules of `identify`: from input files and settings to plain values or text."""

from typing import Any

import numpy as np

from geometry.files import read_json
from rom.model import Rom
from simulate.design_runs import load
from workflow.identify.fits import Drawn, fit
from workflow.identify.likelihood import FITS
from workflow.identify.posterior import systematic
from workflow.identify.priors import Points, Priors
from workflow.identify.proposal import proposal, served
from workflow.identify.table import Table, design, observed, settings, sobol, stiffness

SEED, SEED_OF_CANDIDATES = 1, 2
CANDIDATES = 2**16  # points at which the emulated posteriors are known


def csv(table: dict[str, Any]) -> str:
    """The table of a design that these points give."""
    return design({column: np.array(values) for column, values in table["settings"].items()})


def _table(files: Any, points: Points) -> dict[str, Any]:
    """Points, and the keys of the scene there."""
    ratio = stiffness(Rom.load(files.rom)) / stiffness(Rom.load(files.reference))
    columns = settings(Priors.load(files.priors), points, ratio)
    return {
        "points": points.tolist(),
        "settings": {column: values.tolist() for column, values in columns.items()},
    }


def points(files: Any, number: int) -> dict[str, Any]:
    """Points of a table: of the prior, or drawn from what the tables before it say."""
    tables = _marched(files)
    if not tables:
        return _table(files, sobol(number, SEED))
    candidates = sobol(CANDIDATES, SEED_OF_CANDIDATES)
    density = proposal(tables, candidates, candidates)
    return _table(files, candidates[systematic(density, number, np.random.default_rng(SEED))])


def _marched(files: Any) -> list[Table]:
    """The tables marched so far: points of the unit cube, and their peaks."""
    return [
        Table(np.array(read_json(points)["points"]), observed(load(rows)))
        for points, rows in zip(files.points, files.rows, strict=True)
    ]


def fits(files: Any) -> dict[str, Any]:
    """All fits from all tables."""
    tables, parameters = _marched(files), Priors.load(files.priors)
    drawn = Drawn.of(tables, sobol(CANDIDATES, SEED_OF_CANDIDATES))
    values = parameters.values(drawn.points)
    return {
        "points": drawn.points.tolist(),
        "counts": [len(table.points) for table in tables],
        "values": {name: of.tolist() for name, of in values.items()},
        "served": served(tables[0].observed.over_crossing),
        "fits": {of.name: fit(of, drawn, values) for of in FITS},
    }
