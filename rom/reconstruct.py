"""``basis-<directions>.h5``: displacement of the full blade from reduced coordinates, Eq. (5)."""

from dataclasses import dataclass
from pathlib import Path

import h5py
import numpy as np
from numpy.typing import NDArray

from fem.matrices import Matrices
from geometry.files import whole
from geometry.provenance import Provenance
from rom.model import CODE, RomError, require_speed
from rom.polynomial import evaluate, interpolate


@dataclass(frozen=True)
class Basis:
    """What turns reduced coordinates into displacements of the free DoFs, Cartesian.

    DoF 3 p + c is component c (x, y, z) of free node p.
    """

    T: NDArray[np.float64]  # (n_full, n), Eq. (5)
    u_static: NDArray[np.float64]  # (powers, n_full), m per (rad/s)^power, powers 2, 4, ...
    coordinates: NDArray[np.float64]  # (n_full / 3, 3), m, free nodes
    Omega_m: float  # rad/s, highest speed
    provenance: Provenance  # that of the reduced model

    @classmethod
    def of(cls, fom: Matrices, T: NDArray[np.float64], provenance: Provenance) -> "Basis":
        """Basis T (n_full, n) of ``rom.reduce.reduce`` on ``fom``, which has rest and more speeds.

        The static deflection is a polynomial in Omega^2 through the speeds; dividing by Omega^2
        beforehand makes it zero at rest to the last bit.
        """
        spun, deflections = fom.speeds[1:], fom.u_static[1:]
        return cls(
            T=T,
            u_static=interpolate(deflections / spun[:, None] ** 2, spun),
            coordinates=fom.coordinates,
            Omega_m=float(fom.speeds[-1]),
            provenance=provenance,
        )

    def reconstruct(self, u: NDArray[np.float64]) -> NDArray[np.float64]:
        """Vibration (n_full,), m, about the static deflection, from reduced displacements u (n,).

        Raises
        ------
        RomError
            When u is of another reduced model.
        """
        if np.shape(u) != self.T.shape[1:]:
            raise RomError(
                f"reduced displacements of shape {np.shape(u)}: this basis needs one state of "
                f"({self.T.shape[1]},); take sweep and basis of the same blade and directions"
            )
        return self.T @ u

    def static(self, Omega: float) -> NDArray[np.float64]:
        """Static deflection u_static(Omega) (n_full,), m; Omega in rad/s.

        Raises
        ------
        RomError
            Outside [0, Omega_m].
        """
        require_speed(Omega, self.Omega_m)
        return Omega**2 * evaluate(self.u_static, Omega)

    def save(self, path: str | Path) -> None:
        """Write HDF5."""
        with whole(path) as temporary, h5py.File(temporary, "w") as file:
            for name in _ARRAYS:
                file[name] = getattr(self, name)
            file.attrs["Omega_m"] = self.Omega_m
            file.attrs["provenance"] = self.provenance.dump()

    @classmethod
    def load(cls, path: str | Path) -> "Basis":
        """Read HDF5.

        Raises
        ------
        ProvenanceError
            When another version of the code made it.
        """
        with h5py.File(path) as file:
            provenance = Provenance.parse(file.attrs.get("provenance"), path)
            provenance.require_code(CODE, path)
            return cls(
                Omega_m=float(file.attrs["Omega_m"]),
                provenance=provenance,
                **{name: file[name][:] for name in _ARRAYS},
            )


_ARRAYS = ("T", "u_static", "coordinates")
