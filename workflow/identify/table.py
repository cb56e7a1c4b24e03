"""Tables of the engine: a row for each point of a prior and each coating, and its peaks."""

from collections.abc import Sequence
from pathlib import Path
from typing import TypedDict

import numpy as np
import xarray as xr

from geometry.project import Say, silent
from rom.model import Rom
from simulate.scene import Scene
from simulate.scene.design import Design
from simulate.sweeps.design_runs import Engine, march_block, row_table
from workflow.identify.blades import BladeNumbers
from workflow.identify.measured import at_point
from workflow.identify.points import Blades, TablePoints, parameters_at
from workflow.identify.priors import Priors
from workflow.identify.steps import with_steps

# E and K of a point's rows. The paper does not say K of its figures for E = 1: both readings.
COATINGS = ((1.0, 0.45), (1.0, 4.55), (10.0, 4.55))
ORDERS = (4, 6)  # engine orders whose peaks the paper gives
PEAKS = ("point", "coating", "order")


class TableRows(TypedDict):
    """Points of a part of a table and their peaks, as its file has them; null without a peak."""

    sample: str  # name of the table
    data: str | None  # by which its points were drawn, as of ``points.TablePoints``
    cube: list[list[float]]
    over_crossing: list[list[list[float]]]  # of ``PEAKS``
    amplitude: list[list[list[float]]]  # gaps
    wear: list[list[list[float]]]  # gaps


def march(
    table: TablePoints,
    blades: list[BladeNumbers],
    roms: list[str],
    priors: Priors,
    scene: Scene,
    folder: str,
    names: dict[str, str],
    blocks: int,
    tell: Say = silent,
) -> TableRows:
    """Peaks at the points on every ``blocks``-th blade of a table, from that of the block on.

    ``scene``: of all points; ``folder``: of the rows that are done.
    """
    cube, all_blades = np.array(table["cube"]), Blades.of(blades, priors)
    numbers, values = all_blades.number(cube), priors.values(all_blades.points(cube))
    parts, order = [], []
    for number in np.unique(numbers)[int(names["block"]) :: blocks]:
        points = np.flatnonzero(numbers == number)
        base = scene.but(blade=f"{names['prior']}-{number}")
        rows = [row for i in points for row in coated(at_point(base, parameters_at(values, i)))]
        engine = Engine.of(Design(Path(base.blade), base, [], rows), Rom.load(roms[number]))
        parts.append(observed(row_table(engine, march_block(engine, folder, report=tell))))
        order += points.tolist()
    peaks = {name: each.values.tolist() for name, each in joined(parts).items()}
    return {
        "sample": names["sample"],
        "data": table["data"],
        "cube": cube[order].tolist(),
        "over_crossing": peaks["over_crossing"],
        "amplitude": peaks["amplitude"],
        "wear": peaks["wear"],
    }


def coated(scene: Scene) -> list[Scene]:
    """The scenes of the coatings of a point, with the steps that they ask for."""
    return [with_steps(scene.but(liner__law__E=E, liner__law__K=K)) for E, K in COATINGS]


def observed(rows: xr.Dataset) -> xr.Dataset:
    """Peaks of a table of rows that figures and tables would name (``sweeps.peak.Peak``).

    `over_crossing`, `amplitude` and `wear`, both gaps, (point, coating, order); nan without a peak.
    """
    table = rows.drop_vars("row").sel(order=list(ORDERS)).rename(peak="amplitude")
    peaks = table.assign(wear=table["wear"] / table["gap"])[["over_crossing", "amplitude", "wear"]]
    named = peaks.where(table["reported"] == 1)
    by_point = named.coarsen(row=len(COATINGS)).construct(row=("point", "coating"))
    return by_point.transpose(*PEAKS)


def tables(blocks: Sequence[TableRows], blades: Blades) -> list[xr.Dataset]:
    """The tables of these files, each ``placed``."""
    samples = dict.fromkeys(block["sample"] for block in blocks)
    return [placed([b for b in blocks if b["sample"] == name], blades) for name in samples]


def placed(blocks: Sequence[TableRows], blades: Blades) -> xr.Dataset:
    """A table: the values ``observed``; `cube`, `points`, `features`, `number` of the blade.

    Attributes: `data`, by which the points were drawn, of ``likelihood.DATA``, None: by the prior;
    `blades`.
    """
    cube = np.vstack([block["cube"] for block in blocks])
    peaks = {
        name: (PEAKS, np.concatenate([np.array(block[name], float) for block in blocks]))
        for name in ("over_crossing", "amplitude", "wear")
    }
    where = {
        "cube": (("point", "coordinate"), cube),
        "points": (("point", "parameter"), blades.points(cube)),
        "features": (("point", "feature"), blades.features(cube)),
        "number": ("point", blades.number(cube)),
    }
    return xr.Dataset(peaks | where, attrs={"data": blocks[0]["data"], "blades": blades})


def joined(tables: Sequence[xr.Dataset]) -> xr.Dataset:
    """Several tables as one."""
    return xr.concat(tables, "point", data_vars="all", join="exact", combine_attrs="drop")
