"""Points of the tables to be computed, and the computed tables."""

from typing import TypedDict

import numpy as np
import xarray as xr

from rom.model import Rom
from simulate.sweeps.design_runs import Rows
from workflow.identify.priors import Priors
from workflow.identify.proposal import SEED, drawn
from workflow.identify.table import design, observed, settings, sobol, stiffness


class TablePoints(TypedDict):
    """Points of a table, as its file has them."""

    data: str | None  # by which they were drawn, of ``likelihood.DATA``; None of the prior
    points: list[list[float]]  # (points, parameters), in the unit cube
    settings: dict[str, list[float]]  # values (points,) of the scene's keys


def table(
    points: list[TablePoints],
    rows: list[Rows],
    rom: Rom,
    reference: Rom,
    priors: Priors,
    number: int,
    data: str | None,
) -> TablePoints:
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


def csv(table: TablePoints) -> str:
    """The table of a design that these points give."""
    return design({column: np.array(values) for column, values in table["settings"].items()})


def marched(points: list[TablePoints], rows: list[Rows]) -> list[xr.Dataset]:
    """The tables computed so far: the values ``observed``, and `points` (point, parameter).

    Attribute `data`: that its points were drawn by, of ``likelihood.DATA``; None: by none.
    """
    return [
        observed(table_rows)
        .assign(points=(("point", "parameter"), one["points"]))
        .assign_attrs(data=one["data"])
        for one, table_rows in zip(points, rows, strict=True)
    ]
