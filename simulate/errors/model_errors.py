"""Errors of a reduced model: against its full model, of its mesh, by what linear kinematics omits.

Displacements are linear in the modal ones, and a strip is worn by the part of the tip over it. A
blade that bends shortens (``fem.second_order``), which changes the gap by the square of the motion;
one that swings farther than half a strip's width meets its neighbour's liner.
"""

from pathlib import Path
from typing import Any, NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from geometry.base import ProvenanceError, anew, read_json, require
from geometry.stored import opened
from geometry.tip import EDGES
from rom.model import Rom
from simulate.contact.places import slope_at
from simulate.scene import Casing

SHARE = 0.1  # of the motion, above which the second order is no small one
BEYOND = "beyond linear kinematics"


class ModelError(NamedTuple):
    """Relative uncertainties of a model."""

    basis: float | None  # largest error in the check of the reduced model; None without one
    mesh: float | None  # of the mesh; None where no coarser one was tried


class ModelErrors(NamedTuple):
    """Errors of a reduced model, and why that of its mesh could not be found, if so."""

    frequencies: ModelError = ModelError(None, None)  # of natural frequencies
    largest: ModelError = ModelError(None, None)  # of frequencies and tip compliances
    no_mesh: str = ""

    @classmethod
    def of(cls, check: str | Path, mesh: str | Path | None, rom: Rom) -> "ModelErrors":
        """From ``rom-check-*.nc``, and from ``mesh-error.json`` where there is one.

        A model from elsewhere has neither: its full model is not known.

        Raises
        ------
        geometry.base.provenance.ProvenanceError
            When there is no check, a file is damaged, or belongs to another model or mesh.
        """
        if rom.elsewhere:
            return cls()
        of_mesh = _of_mesh(mesh, rom) if mesh and Path(mesh).is_file() else {}
        with opened(check, "check of a reduced model") as (checked, provenance):
            provenance.require(rom.provenance, check)
            frequencies = abs(checked["reduced"].values / checked["full"].values - 1)
            largest = np.max([frequencies.max(), abs(checked["compliance_error"]).max()])
        return cls(
            ModelError(float(np.nanmax(frequencies)), of_mesh.get("frequencies")),
            ModelError(float(largest), of_mesh.get("error")),
            of_mesh.get("why", ""),
        )


def _of_mesh(path: str | Path, rom: Rom) -> dict[str, Any]:
    """Errors of the mesh of a reduced model: of `frequencies`, and the largest, `error`."""
    values = read_json(path)
    if not isinstance(values, dict) or not isinstance(values.get("error", ""), float | None):
        raise ProvenanceError(f"holds no error of a mesh; {anew(path)}", file=path)
    require(
        (
            values["error"] is not None or values.get("why"),
            f"says no reason why it holds no error; {anew(path)}",
        ),
        (
            values.get("mesh") == rom.provenance.mesh,
            f"belongs to another mesh; {anew(path)}",
        ),
        kind=ProvenanceError,
        file=path,
    )
    return values


class SecondOrder(NamedTuple):
    """Motion of both ``EDGES`` in the first modes of the full model, at the speeds of its check."""

    speeds: NDArray[np.float64]  # (speeds,), rad/s
    tip: NDArray[np.float64]  # (speeds, 3, 2, modes), u_r, u_t, u_z per modal displacement
    radius: NDArray[np.float64]  # (speeds, 2, modes), change of the radius per square of it

    @classmethod
    def of(cls, check: str | Path) -> Self:
        """From ``rom-check-*.nc``; ``ModelErrors.of`` requires it to be of the model."""
        with opened(check, "check of a reduced model") as (checked, _):
            return cls(*(checked[name].values for name in ("speeds", "tip", "second_order")))

    def at_peak(
        self, rom: Rom, casing: Casing, Omega: float, k: float | None, place: float, motion: float
    ) -> tuple[float, float]:
        """Largest change of the radius of second order, m, and largest u_z, m, of both edges.

        nan where the mode that responds is none of the first ones.

        Parameters
        ----------
        Omega : rad/s
        k : engine order of the peak, whose frequency tells the mode; None: the first mode
        place, motion : its edge, and the displacement u_r - s u_z there, m
        """
        mode = 0 if k is None else int(np.abs(rom.modes(Omega)[0] - k * Omega).argmin())
        if mode >= self.radius.shape[2] or np.isnan(self.radius).any():
            return np.nan, np.nan
        edge, (u_r, _, u_z) = EDGES.index(place), self.tip[..., mode].swapaxes(0, 1)
        slope = slope_at(rom, casing, np.array(EDGES))[edge]
        closing = (u_r - slope * u_z)[:, edge, None]  # of either sign, as the mode
        both = np.hstack([self.radius[..., mode] / closing**2, u_z / closing])
        ratios = [np.interp(Omega**2, self.speeds**2, ratio) for ratio in both.T]
        second, axial = np.abs(ratios).reshape(2, 2).max(axis=1)
        return float(second * motion**2), float(axial * motion)
