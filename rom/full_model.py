"""``full-model.nc``: what a reduced model is checked against, from the full matrices."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from fem.interface import cylindrical
from fem.matrices import Matrices
from geometry.files import whole
from geometry.interface import InterfaceNodes
from rom.modes import ShiftInvert

MODES = 10  # frequencies compared
SHAPES = 5  # mode shapes at rest, kept for pictures


@dataclass(frozen=True)
class FullModel:
    """Frequencies and tip compliance of the full model over its speeds."""

    speeds: NDArray[np.float64]  # (speeds,), rad/s, rest first
    omega: NDArray[np.float64]  # (speeds, modes), rad/s
    residuals: NDArray[np.float64]  # (speeds, modes), of these modes
    compliance: NDArray[np.float64]  # (speeds, nodes, 3), m/N, each DoF under its own unit load
    shapes: NDArray[np.float64]  # (shapes, points, 3), modes at rest, Cartesian, kg^-1/2
    coordinates: NDArray[np.float64]  # (points, 3), m, free nodes of the mesh

    def save(self, path: str | Path) -> None:
        """Write NetCDF."""
        modal = ("speed", "mode")
        dataset = xr.Dataset(
            {
                "omega": (modal, self.omega, {"units": "rad s-1"}),
                "residuals": (modal, self.residuals, {"units": "1"}),
                "compliance": (("speed", "node", "rtz"), self.compliance, {"units": "m N-1"}),
                "shapes": (("shape", "point", "xyz"), self.shapes, {"units": "kg-1/2"}),
                "coordinates": (("point", "xyz"), self.coordinates, {"units": "m"}),
            },
            coords={"speeds": ("speed", self.speeds, {"units": "rad s-1"})},
        )
        with whole(path) as temporary:
            dataset.to_netcdf(temporary, engine="h5netcdf")

    @classmethod
    def load(cls, path: str | Path) -> "FullModel":
        """Read NetCDF."""
        with xr.open_dataset(path, engine="h5netcdf") as dataset:
            return cls(**{name: dataset[name].values for name in cls.__dataclass_fields__})


def solve(fom: Matrices) -> FullModel:
    """First modes and static tip compliance at every speed of ``fom``, one factor for both."""
    modes, compliance = [], []
    b = fom.interface_dofs.ravel()
    loads = np.zeros((fom.M.shape[0], len(b)))
    loads[b, np.arange(len(b))] = 1.0
    for K in fom.K:
        inverse = ShiftInvert(K, fom.M)
        modes.append(inverse.modes(MODES))
        own = np.diag(inverse.solve(loads)[b])
        compliance.append(own.reshape(fom.interface_dofs.shape))
    theta = InterfaceNodes(fom.interface_points).theta
    Q = cylindrical(fom.M.shape[0], fom.interface_dofs, theta)
    return FullModel(
        speeds=fom.speeds,
        omega=np.array([m.omega for m in modes]),
        residuals=np.array([m.residuals for m in modes]),
        compliance=np.array(compliance),
        shapes=(Q @ modes[0].Phi[:, :SHAPES]).T.reshape(SHAPES, -1, 3),
        coordinates=fom.coordinates,
    )
