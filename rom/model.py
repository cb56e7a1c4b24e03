"""``rom-<directions>.nc``: the reduced model, the one file the simulator needs of the blade."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import xarray as xr
from numpy.typing import NDArray
from scipy.linalg import eigh

from geometry.files import whole
from geometry.interface import InterfaceNodes
from rom.polynomial import evaluate

DIRECTIONS = {"r": "radial", "t": "tangential", "z": "axial"}


class RomError(ValueError):
    """A reduced model that cannot be read or used as asked; the message says which and why."""


def direction_names(letters: str) -> tuple[str, ...]:
    """Names of the interface directions "r", "rt" or "rtz".

    Raises
    ------
    RomError
        For other letters.
    """
    if not letters or not "rtz".startswith(letters):
        raise RomError(f"interface directions {letters!r}: allowed r, rt, rtz")
    return tuple(DIRECTIONS[letter] for letter in letters)


def require_speed(Omega: float, Omega_m: float) -> None:
    """Refuse speeds outside [0, Omega_m], rad/s: polynomials in Omega do not extrapolate.

    Raises
    ------
    RomError
        With both.
    """
    if not 0 <= Omega <= Omega_m * (1 + 1e-12):
        raise RomError(f"speed {Omega:.6g} rad/s is outside [0, {Omega_m:.6g}] rad/s")


@dataclass(frozen=True)
class Rom:
    """M and K(Omega) in reduced coordinates (u_b, q) of Eq. (5); u_b first, node by node."""

    M: NDArray[np.float64]  # (n, n), kg
    K: NDArray[np.float64]  # (powers, n, n), N/m per (rad/s)^power, powers 0, 2, 4, ...
    directions: tuple[str, ...]  # of the interface DoFs of each node: radial first
    points: NDArray[np.float64]  # (nodes, 3), m: x, y, z of the interface nodes, leading edge first
    Omega_m: float  # rad/s, highest speed
    f1: float  # Hz, first natural frequency at rest
    span: float  # m, blade length
    provenance: str  # hash of the mesh, settings of the basis

    @property
    def n(self) -> int:
        """Number of reduced DoFs."""
        return len(self.M)

    @property
    def radius(self) -> NDArray[np.float64]:
        """r_i (nodes,), m."""
        return InterfaceNodes(self.points).radius

    @property
    def theta(self) -> NDArray[np.float64]:
        """theta_i (nodes,), rad."""
        return InterfaceNodes(self.points).theta

    @property
    def radial(self) -> NDArray[np.int64]:
        """Reduced DoFs (nodes,) of the radial displacements u_r."""
        return len(self.directions) * np.arange(len(self.points))

    @property
    def tangential(self) -> NDArray[np.int64]:
        """Reduced DoFs (nodes,) of the tangential displacements u_t.

        Raises
        ------
        RomError
            When the model was reduced without them.
        """
        if DIRECTIONS["t"] not in self.directions:
            raise RomError("the reduced model has no tangential interface DoFs: take rom-rt.nc")
        return self.radial + 1

    def stiffness(self, Omega: float) -> NDArray[np.float64]:
        """K(Omega) (n, n), N/m, Eq. (2); Omega in rad/s.

        Raises
        ------
        RomError
            Outside [0, Omega_m].
        """
        require_speed(Omega, self.Omega_m)
        return evaluate(self.K, Omega)

    def modes(self, Omega: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Natural frequencies omega (n,), rad/s, and modes Phi (n, n), M-normalised, at Omega.

        Raises
        ------
        RomError
            Outside [0, Omega_m], or where K(Omega) is not positive definite.
        """
        values, Phi = eigh(self.stiffness(Omega), self.M)
        if not values[0] > 0:
            raise RomError(
                f"the reduced K(Omega) is not positive definite at {Omega:.6g} rad/s (omega^2 = "
                f"{values[0]:.3e} of its lowest mode): between the speeds of its basis the "
                f"polynomial errs; raise basis.speeds, lower max_speed_rad_s or use prestress: "
                f"linear"
            )
        return np.sqrt(values), Phi

    def save(self, path: str | Path) -> None:
        """Write NetCDF."""
        dataset = xr.Dataset(
            {
                "M": (("dof", "dof_"), self.M, {"units": "kg"}),
                "K": (
                    ("power", "dof", "dof_"),
                    self.K,
                    {"units": "N m-1 (rad s-1)^-power", "long_name": "K(Omega) = sum Omega^p K_p"},
                ),
                "points": (("node", "xyz"), self.points, {"units": "m"}),
            },
            coords={
                "power": 2 * np.arange(len(self.K)),
                "node": np.arange(1, len(self.points) + 1),
                "direction": list(self.directions),
            },
            attrs={
                "Omega_m_rad_s": self.Omega_m,
                "f1_Hz": self.f1,
                "span_m": self.span,
                "provenance": self.provenance,
                "order": "interface DoFs first, node by node, directions as in `direction`",
            },
        )
        with whole(path) as temporary:
            dataset.to_netcdf(temporary, engine="h5netcdf")

    @classmethod
    def load(cls, path: str | Path) -> "Rom":
        """Read NetCDF.

        Raises
        ------
        RomError
            When the file is missing or is no reduced model.
        """
        try:
            with xr.open_dataset(path, engine="h5netcdf") as dataset:
                return cls(
                    M=dataset["M"].values,
                    K=dataset["K"].values,
                    directions=tuple(str(name) for name in dataset["direction"].values),
                    points=dataset["points"].values,
                    Omega_m=float(dataset.attrs["Omega_m_rad_s"]),
                    f1=float(dataset.attrs["f1_Hz"]),
                    span=float(dataset.attrs["span_m"]),
                    provenance=str(dataset.attrs["provenance"]),
                )
        except FileNotFoundError:
            raise RomError(
                f"{path}: no such file; build it with `./run snakemake <file>`"
            ) from None
        except (OSError, KeyError) as error:
            reason = str(error).splitlines()[0]
            raise RomError(f"{path}: is no reduced model ({reason})") from None
