"""Points of the tables that are marched, and the tables that were."""

from typing import Any

import numpy as np
import xarray as xr

from geometry.project import read_json
from rom.model import Rom
from simulate.sweeps.design_runs import load
from workflow.identify.priors import Priors
from workflow.identify.proposal import SEED, drawn
from workflow.identify.table import design, observed, settings, sobol, stiffness


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


def marched(files: Any) -> list[xr.Dataset]:
    """The tables marched so far: what is ``observed``, and `points` (point, parameter).

    Attribute `data`: that its points were drawn by, of ``likelihood.DATA``; None: by none.
    """
    tables = []
    for points, rows in zip(files.points, files.rows, strict=True):
        one = read_json(points)
        at = {"points": (("point", "parameter"), one["points"])}
        tables.append(observed(load(rows)).assign(at).assign_attrs(data=one["data"]))
    return tables
