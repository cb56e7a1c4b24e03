"""``rom-check.nc``: the reduced model against the full one over its speed range."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from fem.interface import cylindrical
from fem.matrices import Matrices
from geometry.files import whole
from rom.model import Rom
from rom.modes import ShiftInvert

MODES = 10  # frequencies compared
SHAPES = 5  # full-model mode shapes at rest, kept for pictures


@dataclass(frozen=True)
class RomCheck:
    """Frequencies of full and reduced model."""

    speeds: NDArray[np.float64]  # (speeds,), rad/s
    full: NDArray[np.float64]  # (speeds, modes), rad/s
    reduced: NDArray[np.float64]  # (speeds, modes), rad/s
    residuals: NDArray[np.float64]  # (speeds, modes), of the full modes
    highest: float  # rad/s, highest frequency of the reduced model over the speeds
    shapes: NDArray[np.float64]  # (shapes, points, 3), full modes at rest, Cartesian
    coordinates: NDArray[np.float64]  # (points, 3), m, free nodes of the mesh

    @property
    def error(self) -> NDArray[np.float64]:
        """Relative frequency error (speeds, modes)."""
        return self.reduced / self.full - 1

    def save(self, path: str | Path) -> None:
        """Write NetCDF."""
        frequencies = ("speed", "mode")
        dataset = xr.Dataset(
            {
                "full": (frequencies, self.full, {"units": "rad s-1"}),
                "reduced": (frequencies, self.reduced, {"units": "rad s-1"}),
                "residuals": (frequencies, self.residuals, {"units": "1"}),
                "shapes": (("shape", "point", "xyz"), self.shapes, {"units": "kg-1/2"}),
                "coordinates": (("point", "xyz"), self.coordinates, {"units": "m"}),
            },
            coords={"speed": ("speed", self.speeds, {"units": "rad s-1"})},
            attrs={"highest_rad_s": self.highest},
        )
        with whole(path) as temporary:
            dataset.to_netcdf(temporary, engine="h5netcdf")

    @classmethod
    def load(cls, path: str | Path) -> "RomCheck":
        """Read NetCDF."""
        with xr.open_dataset(path, engine="h5netcdf") as dataset:
            names = ("full", "reduced", "residuals", "shapes", "coordinates")
            return cls(
                speeds=dataset["speed"].values,
                highest=float(dataset.attrs["highest_rad_s"]),
                **{name: dataset[name].values for name in names},
            )


def check(rom: Rom, fom: Matrices) -> RomCheck:
    """Compare the first frequencies at the speeds of ``fom``, rest first, with the full model's."""
    full = [ShiftInvert(K, fom.M).modes(MODES) for K in fom.K]
    reduced = np.array([rom.modes(speed)[0] for speed in fom.speeds])
    Q = cylindrical(fom.M.shape[0], fom.interface_dofs, rom.theta)
    return RomCheck(
        speeds=fom.speeds,
        full=np.array([modes.omega for modes in full]),
        reduced=reduced[:, :MODES],
        residuals=np.array([modes.residuals for modes in full]),
        highest=float(reduced.max()),
        shapes=(Q @ full[0].Phi[:, :SHAPES]).T.reshape(SHAPES, -1, 3),
        coordinates=fom.coordinates,
    )
