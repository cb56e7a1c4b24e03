"""``rom-check-<directions>.nc``: the reduced model against the full one over its speed range."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from geometry.files import whole
from rom.full_model import FullModel
from rom.model import Rom, RomError


@dataclass(frozen=True)
class RomCheck:
    """Frequencies and static tip compliance of full and reduced model."""

    speeds: NDArray[np.float64]  # (speeds,), rad/s
    full: NDArray[np.float64]  # (speeds, modes), rad/s
    reduced: NDArray[np.float64]  # (speeds, modes), rad/s
    compliance_error: NDArray[np.float64]  # (speeds, nodes, directions), relative
    highest: float  # rad/s, highest frequency of the reduced model over the speeds

    @property
    def error(self) -> NDArray[np.float64]:
        """Relative frequency error (speeds, modes)."""
        return self.reduced / self.full - 1

    def require(self, tolerance_percent: float) -> None:
        """Refuse a model whose worst frequency error exceeds ``tolerance_percent``.

        Raises
        ------
        RomError
            With mode, speed, error and what to change.
        """
        worst = np.nan_to_num(abs(self.error), nan=np.inf)
        speed, mode = np.unravel_index(worst.argmax(), worst.shape)
        if not worst.max() <= tolerance_percent / 100:
            raise RomError(
                f"frequency {mode + 1} is off by {100 * worst.max():.3g} % at "
                f"{self.speeds[speed]:.6g} rad/s, above basis.tolerance_percent "
                f"{tolerance_percent:g}; {self._remedy(worst)} or allow more"
            )

    def _remedy(self, worst: NDArray[np.float64]) -> str:
        """Both ends of the range are speeds of every basis: there the polynomial adds nothing."""
        if worst[[0, -1]].max() < worst.max() / 4:
            return (
                "at the ends of the range it is far less, so K(Omega) errs between its speeds: "
                "raise basis.speeds, lower max_speed_rad_s, use prestress: linear"
            )
        return "raise basis.natural_modes, lower basis.rank_tolerance"

    def save(self, path: str | Path) -> None:
        """Write NetCDF."""
        modal, tip = ("speed", "mode"), ("speed", "node", "direction")
        dataset = xr.Dataset(
            {
                "full": (modal, self.full, {"units": "rad s-1"}),
                "reduced": (modal, self.reduced, {"units": "rad s-1"}),
                "compliance_error": (tip, self.compliance_error, {"units": "1"}),
            },
            coords={"speeds": ("speed", self.speeds, {"units": "rad s-1"})},
            attrs={"highest_rad_s": self.highest},
        )
        with whole(path) as temporary:
            dataset.to_netcdf(temporary, engine="h5netcdf")

    @classmethod
    def load(cls, path: str | Path) -> "RomCheck":
        """Read NetCDF."""
        with xr.open_dataset(path, engine="h5netcdf") as dataset:
            names = ("speeds", "full", "reduced", "compliance_error")
            return cls(
                highest=float(dataset.attrs["highest_rad_s"]),
                **{name: dataset[name].values for name in names},
            )


def check(rom: Rom, full: FullModel) -> RomCheck:
    """Compare frequencies and tip compliances at the speeds of ``full``.

    Where the reduced K(Omega) is not positive definite its frequencies are nan.

    Raises
    ------
    RomError
        When the reduced model has fewer DoFs than frequencies are compared.
    """
    modes = full.omega.shape[1]
    if rom.n < modes:
        raise RomError(
            f"the reduced model has {rom.n} DoFs, fewer than the {modes} frequencies checked; "
            "raise basis.fixed_interface_modes or natural_modes, or lower basis.rank_tolerance"
        )
    reduced = np.array([_frequencies(rom, speed) for speed in full.speeds])
    own = full.compliance[:, :, : len(rom.directions)]
    compliance = np.array([_tip_compliance(rom, speed) for speed in full.speeds])
    return RomCheck(
        speeds=full.speeds,
        full=full.omega,
        reduced=reduced[:, :modes],
        compliance_error=compliance / own - 1,
        highest=float(np.nanmax(reduced)),
    )


def _frequencies(rom: Rom, Omega: float) -> NDArray[np.float64]:
    try:
        return rom.modes(Omega)[0]
    except RomError:
        return np.full(rom.n, np.nan)


def _tip_compliance(rom: Rom, Omega: float) -> NDArray[np.float64]:
    """Each interface DoF under its own unit load (nodes, directions), m/N."""
    shape = len(rom.points), len(rom.directions)
    flexibility = np.linalg.inv(rom.stiffness(Omega))
    return np.diag(flexibility)[: shape[0] * shape[1]].reshape(shape)
