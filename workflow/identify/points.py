"""Points of the tables to be computed, and the computed tables."""

from typing import Any

import numpy as np
import xarray as xr

from rom.model import Rom
from simulate.sweeps.design_runs import Rows
from workflow.identify.priors import Priors
from workflow.identify.proposal import SEED, drawn
from workflow.identify.table import design, observed, settings, sobol, stiffness

type Points = dict[str, Any]  # of a table, as its file has them


def table(
    points: list[Points],
    rows: list[Rows],
    rom: Rom,
    reference: Rom,
    priors: Priors,
    number: int,
    data: str | None,
) -> Points:
    """Points of a table, and the keys of the scene there.

    They are of the prior, or drawn by ``data`` from the tables before it.
    """
    new = sobol(number, SEED) if data is None else drawn(marched(points, rows), number, data)
    columns = settings(priors, new, stiffness(rom) / stiffness(reference))
    return {
        "data": data,
        "points": new.tolist(),
        "settings": {column: values.tolist() for column, values in columns.items()},
    }


def csv(table: Points) -> str:
    """The table of a design that these points give."""
    return design({column: np.array(values) for column, values in table["settings"].items()})


def marched(points: list[Points], rows: list[Rows]) -> list[xr.Dataset]:
    """The tables computed so far: the values ``observed``, and `points` (point, parameter).

    Attribute `data`: that its points were drawn by, of ``likelihood.DATA``; None: by none.
    """
    return [
        observed(table_rows)
        .assign(points=(("point", "parameter"), one["points"]))
        .assign_attrs(data=one["data"])
        for one, table_rows in zip(points, rows, strict=True)
    ]
