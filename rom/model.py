"""``rom-<directions>.nc``: the reduced model, the one file the simulator needs of the blade."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import xarray as xr
from numpy.typing import NDArray
from scipy.linalg import eigh

from fem.matrices import CODE as CODE_OF_MATRICES
from geometry.files import whole
from geometry.hats import hats
from geometry.provenance import Provenance
from rom.polynomial import evaluate

CODE = (  # that decides its numbers
    *CODE_OF_MATRICES,
    *(f"rom/{name}.py" for name in ("basis", "components", "modes", "polynomial")),
    *(f"rom/{name}.py" for name in ("projection", "reduce", "speeds")),
)
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
    """M and K(Omega) in reduced coordinates (c, q): interface DoFs c = S u first, one by one."""

    M: NDArray[np.float64]  # (n, n), kg
    K: NDArray[np.float64]  # (powers, n, n), N/m per (rad/s)^power, powers 0, 2, 4, ...
    directions: tuple[str, ...]  # of each interface DoF: radial first
    xi: NDArray[np.float64]  # (n_c,), chord fractions: nodes of the hats, or interface points
    points: NDArray[np.float64]  # (n_c, 3), r, theta, z in m, rad, of points; (0, 3) of patches
    camber: NDArray[np.float64]  # (places, 3), r, theta, z in m, rad, at equally spaced xi, 0 to 1
    Omega_m: float  # rad/s, highest speed
    f1: float  # Hz, first natural frequency at rest
    span: float  # m, blade length
    provenance: Provenance  # blade, mesh, settings, code

    @property
    def n(self) -> int:
        """Number of reduced DoFs."""
        return len(self.M)

    @property
    def of_points(self) -> bool:
        """Whether its interface DoFs are displacements of points, not coefficients of patches."""
        return len(self.points) > 0

    def line(self, xi: NDArray[np.float64]) -> NDArray[np.float64]:
        """Camber line of the tip at chord fractions ``xi`` (k,): r, theta, z (k, 3), m, rad."""
        at = np.linspace(0, 1, len(self.camber))
        return np.column_stack([np.interp(xi, at, column) for column in self.camber.T])

    def rows(self, xi: NDArray[np.float64], direction: str = "r") -> NDArray[np.float64]:
        """P (k, n): displacement at chord fractions ``xi`` (k,) from reduced coordinates.

        Raises
        ------
        RomError
            When the model was reduced without interface DoFs in ``direction``.
        """
        name = DIRECTIONS[direction]
        if name not in self.directions:
            raise RomError(
                f"the reduced model has no {name} interface DoFs: take rom-"
                f"{'rtz'[: 'rtz'.index(direction) + 1]}.nc"
            )
        P = np.zeros((len(xi), self.n))
        first, count = self.directions.index(name), len(self.directions)
        P[:, first : count * len(self.xi) : count] = hats(xi, self.xi)
        return P

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
                "points": (("point", "rtz"), self.points, {"units": "m, rad, m"}),
                "camber": (("place", "rtz"), self.camber, {"units": "m, rad, m"}),
            },
            coords={
                "power": 2 * np.arange(len(self.K)),
                "xi": self.xi,
                "direction": list(self.directions),
            },
            attrs={
                "Omega_m_rad_s": self.Omega_m,
                "f1_Hz": self.f1,
                "span_m": self.span,
                "provenance": self.provenance.dump(),
                "order": "interface DoFs first, one by one along xi, directions as in `direction`",
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
        ProvenanceError
            When another version of the code made it.
        """
        try:
            with xr.open_dataset(path, engine="h5netcdf") as dataset:
                M = dataset["M"].values
                provenance = Provenance.parse(dataset.attrs.get("provenance"), path)
                provenance.require_code(CODE, path)
                return cls(
                    M=M,
                    K=dataset["K"].values,
                    directions=tuple(str(name) for name in dataset["direction"].values),
                    xi=dataset["xi"].values,
                    points=dataset["points"].values,
                    camber=dataset["camber"].values,
                    Omega_m=float(dataset.attrs["Omega_m_rad_s"]),
                    f1=float(dataset.attrs["f1_Hz"]),
                    span=float(dataset.attrs["span_m"]),
                    provenance=provenance,
                )
        except FileNotFoundError:
            raise RomError(
                f"{path}: no such file; build it with `./run snakemake <file>`"
            ) from None
        except (OSError, KeyError) as error:
            reason = str(error).splitlines()[0]
            raise RomError(f"{path}: is no reduced model ({reason})") from None
