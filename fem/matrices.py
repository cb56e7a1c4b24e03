"""``matrices.h5``: the matrices of the finite elements, from which the reduced model is made."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from io import BytesIO
from pathlib import Path
from typing import Self

import h5py
import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.sparse import csr_matrix, tril, triu

from geometry.project import Provenance, legible, require_format, write_whole

FORMAT = 1
CODE = ("fem.assemble",)  # module that computes its numbers; the mesh has a hash of its own


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
        """Write HDF5: ``data``, ``indices``, ``indptr`` of S and of the upper triangles of M, K.

        It is made in memory: where a disk is full HDF5 may crash.

        Raises
        ------
        geometry.project.errors.WriteError
            When it cannot be written.
        """
        image = BytesIO()
        with h5py.File(image, "w") as file:
            _write_csr(file, "S", self.S)
            _write_csr(file, "M", triu(self.M, format="csr"))
            for i, K in enumerate(self.K):
                _write_csr(file, f"K/{i}", triu(K, format="csr"))
            for name in _ARRAYS:
                file[name] = getattr(self, name)
            file.attrs["format"] = FORMAT
            file.attrs["span"] = self.span
            file.attrs["provenance"] = self.provenance.dump()
        write_whole(image.getvalue(), path)

    @classmethod
    def load(cls, path: str | Path) -> "Matrices":
        """Read HDF5.

        Raises
        ------
        ProvenanceError
            When it is missing, damaged, of another format, or another version of the code made it,
            or its values cannot be: other shapes, nan, not symmetric, zero.
        """
        with legible(path, "file of matrices") as whole_file, h5py.File(whole_file) as file:
            require_format(file.attrs, FORMAT, path)
            provenance = Provenance.parse(file.attrs.get("provenance"), path)
            provenance.require_code(CODE, path)
            return cls._read(file, provenance)

    @classmethod
    def _read(cls, file: h5py.File, provenance: Provenance) -> "Matrices":
        arrays = {name: _read_array(file, name) for name in _ARRAYS}
        n_full, speeds = 3 * len(arrays["coordinates"]), len(arrays["speeds"])
        shapes = {"u_static": (speeds, n_full), "residuals": (speeds,), "K": (speeds,)}
        for name, shape in shapes.items():
            if (arrays[name].shape if name in arrays else (len(file[name]),)) != shape:
                raise ValueError(f"{name}: not of shape {shape}")
        return cls(
            M=_read_symmetric(file, "M", n_full),
            K=tuple(_read_symmetric(file, f"K/{i}", n_full) for i in range(speeds)),
            span=float(file.attrs["span"]),
            S=_read_csr(file, "S", (3 * len(arrays["xi"]), n_full)),
            provenance=provenance,
            **arrays,
        )


_CSR = ("data", "indices", "indptr")


def _write_csr(file: h5py.File, group: str, A: csr_matrix) -> None:
    for part in _CSR:
        file[f"{group}/{part}"] = getattr(A, part)


def _read_csr(file: h5py.File, group: str, shape: tuple[int, int]) -> csr_matrix:
    data, indices, indptr = (file[f"{group}/{part}"][:] for part in _CSR)
    if data.dtype != float or {indices.dtype.kind, indptr.dtype.kind} != {"i"}:
        raise ValueError(f"{group}: no sparse matrix")
    A = csr_matrix((data, indices, indptr), shape=shape)
    A.check_format(full_check=True)
    if not (np.isfinite(data).all() and data.any()):
        raise ValueError(f"{group}: not finite, or zero")
    return A


def _read_symmetric(file: h5py.File, group: str, n: int) -> csr_matrix:
    """Matrix (n, n) from its upper triangle; its diagonal must be positive."""
    upper = _read_csr(file, group, (n, n))
    if not (upper.diagonal() > 0).all():
        raise ValueError(f"{group}: not positive on its diagonal")
    if tril(upper, -1).nnz:
        raise ValueError(f"{group}: not an upper triangle")
    return (upper + triu(upper, 1).T).tocsr()


def _read_array(file: h5py.File, name: str) -> NDArray[np.float64]:
    values = file[name][:]
    known = np.isfinite(values)
    possible = known.all() or (name in _PERHAPS_NOT_KNOWN and not known.any())
    if values.ndim != _ARRAYS[name] or values.dtype != float or not possible:
        raise ValueError(f"{name}: not finite numbers in {_ARRAYS[name]} dimensions")
    return values


_PERHAPS_NOT_KNOWN = ("u_static", "residuals")  # of matrices made elsewhere: nan throughout
_ARRAYS = {  # with their numbers of dimensions
    "speeds": 1,
    "u_static": 2,
    "residuals": 1,
    "coordinates": 2,
    "xi": 1,
    "points": 2,
    "camber": 2,
}
