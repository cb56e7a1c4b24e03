"""Points of the tables that are marched, and the tables that were."""

from typing import Any

import numpy as np

from geometry.project import read_json
from rom.model import Rom
from simulate.sweeps.design_runs import load
from workflow.identify.priors import Priors
from workflow.identify.proposal import SEED, drawn
from workflow.identify.table import Table, design, observed, settings, sobol, stiffness


def points(files: Any, number: int, data: str | None) -> dict[str, Any]:
    """Points of a table, and the keys of the scene there.

    They are of the prior, or drawn by ``data`` from what the tables before it say.
    """
    points = sobol(number, SEED) if data is None else drawn(marched(files), number, data)
    ratio = stiffness(Rom.load(files.rom)) / stiffness(Rom.load(files.reference))
    columns = settings(Priors.load(files.priors), points, ratio)
    return {
        "data": data,
        "points": points.tolist(),
        "settings": {column: values.tolist() for column, values in columns.items()},
    }


def csv(table: dict[str, Any]) -> str:
    """The table of a design that these points give."""
    return design({column: np.array(values) for column, values in table["settings"].items()})


def marched(files: Any) -> list[Table]:
    """The tables marched so far."""
    tables = []
    for points, rows in zip(files.points, files.rows, strict=True):
        one = read_json(points)
        tables.append(Table(np.array(one["points"]), observed(load(rows)), one["data"]))
    return tables
