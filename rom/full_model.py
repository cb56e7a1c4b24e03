"""``full-model.nc``: what a reduced model is checked against, from the full matrices."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from fem.matrices import CODE, Matrices
from geometry.files import whole
from geometry.provenance import Provenance
from rom.modes import ShiftInvert

MODES = 10  # frequencies compared
SHAPES = 5  # mode shapes at rest, kept for pictures


@dataclass(frozen=True)
class FullModel:
    """Frequencies and compliance of the interface of the full model over its speeds."""

    speeds: NDArray[np.float64]  # (speeds,), rad/s, rest first
    omega: NDArray[np.float64]  # (speeds, modes), rad/s
    residuals: NDArray[np.float64]  # (speeds, modes), of these modes
    compliance: NDArray[np.float64]  # (speeds, 3 n, 3 n), m/N, C = S K^-1 S^T, order as in S
    shapes: NDArray[np.float64]  # (shapes, points, 3), modes at rest, Cartesian, kg^-1/2
    coordinates: NDArray[np.float64]  # (points, 3), m, free nodes of the mesh
    provenance: Provenance  # that of the matrices

    def save(self, path: str | Path) -> None:
        """Write NetCDF."""
        modal = ("speed", "mode")
        dataset = xr.Dataset(
            {
                "omega": (modal, self.omega, {"units": "rad s-1"}),
                "residuals": (modal, self.residuals, {"units": "1"}),
                "compliance": (("speed", "dof", "dof_"), self.compliance, {"units": "m N-1"}),
                "shapes": (("shape", "point", "xyz"), self.shapes, {"units": "kg-1/2"}),
                "coordinates": (("point", "xyz"), self.coordinates, {"units": "m"}),
            },
            coords={"speeds": ("speed", self.speeds, {"units": "rad s-1"})},
            attrs={"provenance": self.provenance.dump()},
        )
        with whole(path) as temporary:
            dataset.to_netcdf(temporary, engine="h5netcdf")

    @classmethod
    def load(cls, path: str | Path) -> "FullModel":
        """Read NetCDF."""
        names = set(cls.__dataclass_fields__) - {"provenance"}
        with xr.open_dataset(path, engine="h5netcdf") as dataset:
            provenance = Provenance.parse(dataset.attrs.get("provenance"), path)
            provenance.require_code(CODE, path)
            return cls(provenance=provenance, **{name: dataset[name].values for name in names})


def solve(fom: Matrices) -> FullModel:
    """First modes and compliance of the interface at every speed of ``fom``, of one factor."""
    modes, compliance = [], []
    loads = fom.S.T.toarray()
    for K in fom.K:
        inverse = ShiftInvert(K, fom.M)
        modes.append(inverse.modes(MODES))
        compliance.append(fom.S @ inverse.solve(loads))
    return FullModel(
        speeds=fom.speeds,
        omega=np.array([m.omega for m in modes]),
        residuals=np.array([m.residuals for m in modes]),
        compliance=np.array(compliance),
        shapes=modes[0].Phi[:, :SHAPES].T.reshape(SHAPES, -1, 3),
        coordinates=fom.coordinates,
        provenance=fom.provenance,
    )
