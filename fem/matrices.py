"""``matrices.h5``: the matrices of the finite elements, from which the reduced model is made."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Self

import h5py
import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.sparse import csr_matrix, triu

from geometry.files import whole
from geometry.provenance import Provenance
from geometry.version import require_format

FORMAT = 1
CODE = (  # files on which its numbers depend; the mesh has a hash of its own
    *(f"geometry/{name}.py" for name in ("facets", "hats", "interface", "mesh_faces", "tip")),
    *(f"fem/{name}.py" for name in ("assemble", "cholesky", "interface", "prestress", "solid")),
)


@dataclass(frozen=True)
class State:
    """Prestressed state at one speed, free DoFs."""

    speed: float  # rad/s
    K: csr_matrix  # N/m
    u_static: NDArray[np.float64]  # m
    residual: float  # equilibrium residual over the centrifugal load


@dataclass(frozen=True)
class Constants:
    """M, the interface operator S and all else that does not depend on the speed, free DoFs.

    DoF 3 p + c is component c (x, y, z) of free node p.
    """

    M: csr_matrix  # (n_full, n_full), kg
    coordinates: NDArray[np.float64]  # (n_full / 3, 3), m, free nodes
    S: csr_matrix  # (3 n, n_full), 3 i + d: direction d (radial, tangential, axial) of patch i
    xi: NDArray[np.float64]  # (n,), chord fractions of the hats' nodes, or of interface points
    points: NDArray[np.float64]  # (n, 3), r, theta, z in m, rad, of points; (0, 3) of patches
    camber: NDArray[np.float64]  # (places, 3), r, theta, z in m, rad, at equally spaced xi
    span: float  # m, mean radius of the camber line at the tip less that of the clamped nodes
    provenance: Provenance  # the blade, its mesh and settings, the code

    def rows(self, directions: int) -> csr_matrix:
        """Rows of S (directions n, n_full) for the first ``directions`` of each patch or point."""
        return self.S[np.arange(self.S.shape[0]) % 3 < directions]


@dataclass(frozen=True)
class Matrices(Constants):
    """The constants, with K(Omega) and static deflections at some speeds."""

    K: tuple[csr_matrix, ...]  # one per speed, N/m
    speeds: NDArray[np.float64]  # (speeds,), rad/s, ascending
    u_static: NDArray[np.float64]  # (speeds, n_full), m
    residuals: NDArray[np.float64]  # (speeds,), equilibrium residual over the centrifugal load

    @property
    def given(self) -> bool:
        """Whether they were made elsewhere, at speeds of their own."""
        return "full_matrices" in self.provenance.settings

    @property
    def top_speed(self) -> float:
        """Omega_m, rad/s: the last of the speeds, or the one told for matrices at rest alone."""
        return float(self.speeds[-1] or self.provenance.settings["max_speed_rad_s"])

    @classmethod
    def of(cls, constants: Constants, states: Iterable[State]) -> Self:
        """Matrices at the speeds of ``states``."""
        states = list(states)
        return cls(
            **vars(constants),
            K=tuple(state.K for state in states),
            speeds=np.array([state.speed for state in states]),
            u_static=np.array([state.u_static for state in states]),
            residuals=np.array([state.residual for state in states]),
        )

    def states(self) -> Iterator[State]:
        """The state at each speed."""
        return map(State, self.speeds, self.K, self.u_static, self.residuals)

    def at(self, speeds: ArrayLike) -> "Matrices":
        """The matrices at ``speeds`` (rad/s) only, which must be among their own.

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
        """Write HDF5: ``data``, ``indices``, ``indptr`` of S and of the upper triangles of M, K."""
        with whole(path) as temporary, h5py.File(temporary, "w") as file:
            _write_csr(file, "S", self.S)
            _write_csr(file, "M", triu(self.M, format="csr"))
            for i, K in enumerate(self.K):
                _write_csr(file, f"K/{i}", triu(K, format="csr"))
            for name in _ARRAYS:
                file[name] = getattr(self, name)
            file.attrs["format"] = FORMAT
            file.attrs["span"] = self.span
            file.attrs["provenance"] = self.provenance.dump()

    @classmethod
    def load(cls, path: str | Path) -> "Matrices":
        """Read HDF5.

        Raises
        ------
        ProvenanceError
            When it is of another format, or another version of the code made it.
        """
        with h5py.File(path) as file:
            require_format(file.attrs, FORMAT, path)
            provenance = Provenance.parse(file.attrs.get("provenance"), path)
            provenance.require_code(CODE, path)
            shape = 3 * len(file["xi"]), 3 * len(file["coordinates"])
            return cls(
                M=_read_symmetric(file, "M"),
                K=tuple(_read_symmetric(file, f"K/{i}") for i in range(len(file["K"]))),
                span=float(file.attrs["span"]),
                S=_read_csr(file, "S", shape),
                provenance=provenance,
                **{name: file[name][:] for name in _ARRAYS},
            )


_CSR = ("data", "indices", "indptr")


def _write_csr(file: h5py.File, group: str, A: csr_matrix) -> None:
    for part in _CSR:
        file[f"{group}/{part}"] = getattr(A, part)


def _read_csr(file: h5py.File, group: str, shape: tuple[int, int] | None = None) -> csr_matrix:
    return csr_matrix(tuple(file[f"{group}/{part}"][:] for part in _CSR), shape=shape)


def _read_symmetric(file: h5py.File, group: str) -> csr_matrix:
    upper = _read_csr(file, group)
    return (upper + triu(upper, 1).T).tocsr()


_ARRAYS = (
    "speeds",
    "u_static",
    "residuals",
    "coordinates",
    "xi",
    "points",
    "camber",
)
