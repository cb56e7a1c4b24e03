"""``matrices.h5``: what the finite elements hand to the reduced model."""

from dataclasses import dataclass, replace
from pathlib import Path

import h5py
import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.sparse import csr_matrix, triu

from geometry.files import whole


@dataclass(frozen=True)
class Matrices:
    """M, K(Omega) and static deflections on the free DoFs.

    DoF 3 p + c is component c (x, y, z) of free node p; at interface nodes the components are
    radial, tangential (sense of rotation), axial.
    """

    M: csr_matrix  # (n_full, n_full), kg
    K: tuple[csr_matrix, ...]  # one per speed, N/m
    speeds: NDArray[np.float64]  # (speeds,), rad/s, ascending
    u_static: NDArray[np.float64]  # (speeds, n_full), m, Cartesian also at interface nodes
    residuals: NDArray[np.float64]  # (speeds,), equilibrium residual over the centrifugal load
    coordinates: NDArray[np.float64]  # (n_full / 3, 3), m, free nodes
    interface_dofs: NDArray[np.int64]  # (nodes, 3): radial, tangential, axial
    interface_points: NDArray[np.float64]  # (nodes, 3), m
    span: float  # m, mean radius of the interface nodes less that of the clamped ones
    mesh_hash: str  # sha256 of the mesh file

    def at(self, speeds: ArrayLike) -> "Matrices":
        """The same at ``speeds`` (rad/s), each of which must be one of its own.

        Raises
        ------
        ValueError
            When a speed is not among them.
        """
        apart = abs(self.speeds - np.reshape(speeds, (-1, 1)))
        if apart.min(axis=1).max() > 1e-12 * self.speeds[-1]:
            raise ValueError(f"matrices at {self.speeds} rad/s hold none at some of {speeds}")
        kept = apart.argmin(axis=1)
        return replace(
            self,
            K=tuple(self.K[j] for j in kept),
            speeds=self.speeds[kept],
            u_static=self.u_static[kept],
            residuals=self.residuals[kept],
        )

    def save(self, path: str | Path) -> None:
        """Write HDF5, the upper triangle of each matrix as ``data``, ``indices``, ``indptr``."""
        with whole(path) as temporary, h5py.File(temporary, "w") as file:
            _write_csr(file, "M", self.M)
            for i, K in enumerate(self.K):
                _write_csr(file, f"K/{i}", K)
            for name in _ARRAYS:
                file[name] = getattr(self, name)
            file.attrs["span"] = self.span
            file.attrs["mesh_hash"] = self.mesh_hash

    @classmethod
    def load(cls, path: str | Path) -> "Matrices":
        """Read HDF5."""
        with h5py.File(path) as file:
            return cls(
                M=_read_csr(file, "M"),
                K=tuple(_read_csr(file, f"K/{i}") for i in range(len(file["K"]))),
                span=float(file.attrs["span"]),
                mesh_hash=str(file.attrs["mesh_hash"]),
                **{name: file[name][:] for name in _ARRAYS},
            )


_CSR = ("data", "indices", "indptr")


def _write_csr(file: h5py.File, group: str, A: csr_matrix) -> None:
    upper = triu(A, format="csr")
    for part in _CSR:
        file[f"{group}/{part}"] = getattr(upper, part)


def _read_csr(file: h5py.File, group: str) -> csr_matrix:
    upper = csr_matrix(tuple(file[f"{group}/{part}"][:] for part in _CSR))
    return (upper + triu(upper, 1).T).tocsr()


_ARRAYS = (
    "speeds",
    "u_static",
    "residuals",
    "coordinates",
    "interface_dofs",
    "interface_points",
)
