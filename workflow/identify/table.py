"""Tables of the engine: a row for each point of the unit cube and each coating, and its peaks."""

from collections.abc import Sequence

import numpy as np
import xarray as xr
from numpy.typing import NDArray
from scipy.stats import qmc

from geometry.project import SettingsError, csv_text
from rom.model import Rom
from simulate.scene import LEADING, Scene
from simulate.sweeps.peak import crossing
from workflow.identify.priors import NAMES, Points, Priors, largest_inward
from workflow.identify.steps import steps_per_round

# E and K of a point's rows. The paper does not say K of its figures for E = 1: both readings.
COATINGS = ((1.0, 0.45), (1.0, 4.55), (10.0, 4.55))
ORDERS = (4, 6)  # engine orders whose peaks the paper gives
CONSTANT, FOURTH = "casing.harmonics[0]", "casing.harmonics[2]"  # of the scene; second: 1 gap


def sobol(number: int, seed: int) -> Points:
    """The first points of a scrambled Sobol sequence; a power of 2 fills the cube evenly."""
    return qmc.Sobol(len(NAMES), rng=np.random.default_rng(seed)).random(number)


def settings(priors: Priors, points: Points, stiffness: float) -> dict[str, NDArray[np.float64]]:
    """Values (points,) of the scene's keys by their columns, without those of the coatings.

    ``stiffness``: of the blade's mode 1 over that of the reference blade, a factor on the unit.
    """
    values = priors.values(points)
    fourth, constant = values["fourth_over_second"], values["constant_over_second"]
    return {
        "liner.law.unit_Pa": stiffness * values["unit_Pa"],
        "casing.scale": values["casing_gaps"] / largest_inward(fourth, constant),
        f"{CONSTANT}.amplitude_gaps": constant,
        f"{FOURTH}.amplitude_gaps": abs(fourth),
        f"{FOURTH}.phase_deg": np.where(fourth < 0, 180.0, 0.0),
        "damping_ratio": values["damping_ratio"],
    }


def parameters(scene: Scene) -> dict[str, float]:
    """Values of the parameters of a scene on the blade of the priors: the inverse of `settings`.

    Raises
    ------
    geometry.project.errors.SettingsError
        When its casing is none that the parameters give.
    """
    harmonics = {h.order: h for h in scene.casing.harmonics}
    if [*harmonics] != [0, 2, 4] or not {h.phase_deg for h in harmonics.values()} <= {0.0, 180.0}:
        raise SettingsError(
            f"orders {[*harmonics]}: the parameters of the identification give 0, 2 and 4, of "
            "phase 0 or 180",
            key="casing.harmonics",
        )
    signed = {k: (1 - h.phase_deg / 90) * h.amplitude_gaps for k, h in harmonics.items()}
    fourth, constant = (signed[k] / signed[2] for k in (4, 0))
    inward = float(largest_inward(np.array(fourth), np.array(constant)))
    return {
        "unit_Pa": scene.liner.law.unit_Pa,
        "casing_gaps": scene.casing.scale * signed[2] * inward,
        "fourth_over_second": fourth,
        "constant_over_second": constant,
        "damping_ratio": scene.damping_ratio,
    }


def design(columns: dict[str, NDArray[np.float64]]) -> str:
    """CSV table of a design: the rows of each point, one for each coating."""
    rows: list[list[object]] = [
        [*columns, "liner.law.E", "liner.law.K", "integrator.steps_per_round"]
    ]
    for row in zip(*(values.tolist() for values in columns.values()), strict=True):
        unit_Pa = row[[*columns].index("liner.law.unit_Pa")]
        rows += [[*row, E, K, steps_per_round(E * unit_Pa)] for E, K in COATINGS]
    return csv_text(rows)


def observed(rows: xr.Dataset) -> xr.Dataset:
    """Peaks of a table of rows that figures and tables would name (``sweeps.peak.Peak``).

    `over_crossing`, `amplitude` and `wear`, both gaps, (point, coating, order); nan without a peak.
    """
    table = rows.drop_vars("row").sel(order=list(ORDERS)).rename(peak="amplitude")
    peaks = table.assign(wear=table["wear"] / table["gap"])[["over_crossing", "amplitude", "wear"]]
    named = peaks.where(table["reported"] == 1)
    by_point = named.coarsen(row=len(COATINGS)).construct(row=("point", "coating"))
    return by_point.transpose("point", "coating", "order")


def stiffness(rom: Rom) -> float:
    """Modal stiffness omega^2 / Phi^2 of mode 1 at xi = 1/16, radial, at the crossing of EO 4."""
    omega, Phi = rom.modes(crossing(rom, ORDERS[0]) * 2 * np.pi * rom.f1)
    return float((omega[0] / (rom.rows([LEADING], "r") @ Phi[:, 0])[0]) ** 2)


def joined(tables: Sequence[xr.Dataset]) -> xr.Dataset:
    """Several tables as one."""
    return xr.concat(tables, "point", data_vars="all", join="exact", combine_attrs="drop")
