"""``matrices.h5``: the matrices of the finite elements, from which the reduced model is made."""

from collections.abc import Collection, Iterable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Self

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.sparse import csr_matrix

from geometry.base import Provenance, require
from geometry.stored import Stored, frozen, stored
from geometry.tip import slope_of_tip

CODE = ("fem.assemble",)  # module that computes its numbers; the mesh has a hash of its own


@dataclass(frozen=True)
class Prestressed:
    """Prestressed state at one speed, free DoFs."""

    speed: float  # rad/s
    # factors and matrices, whose sum is K: several share one pattern
    terms: tuple[tuple[float, csr_matrix], ...]
    u_static: NDArray[np.float64]  # m
    residual: float  # equilibrium residual over the centrifugal load

    @cached_property
    def K(self) -> csr_matrix:
        """K, N/m: the one matrix itself where it stands alone."""
        (_, first), *more = terms = [term for term in self.terms if term[0]]
        if not more and terms[0][0] == 1:
            return first
        data = sum(factor * A.data for factor, A in terms)
        return csr_matrix((data, first.indices, first.indptr), first.shape)


@frozen
class InterfaceOperator:
    """S, with the places of the interface on the tip."""

    # (3 n, n_full), 3 i + d: direction d (radial, tangential, axial) of patch or point i; with two
    # rows across the thickness (6 n, n_full), first those of the edge behind
    S: csr_matrix = stored("coefficient dof", sparse=True)
    xi: NDArray[np.float64] = stored("xi")  # (n,), chord fractions: nodes of hats, or points
    # (n, 3), r, theta, z of points; (0, 3) of patches
    points: NDArray[np.float64] = stored("place rtz", "m, rad, m")
    # (places, 3), r, theta, z at equally spaced xi from 0 to 1
    camber: NDArray[np.float64] = stored("camber_place rtz", "m, rad, m")
    # (2, places): angles of the sides behind and ahead at the z of these places; (2, 0): not known
    sides: NDArray[np.float64] = stored("side camber_side", "rad")

    @property
    def across(self) -> int:
        """Rows across the thickness."""
        return self.S.shape[0] // (3 * len(self.xi))


@frozen
class Constants(InterfaceOperator):
    """M, the interface operator S and all else that does not depend on the speed, free DoFs.

    DoF 3 p + c is component c (x, y, z) of free node p.
    """

    M: csr_matrix = stored("dof dof_", "kg", sparse=True)  # (n_full, n_full)
    coordinates: NDArray[np.float64] = stored("point xyz", "m")  # (n_full / 3, 3), free nodes
    # mean radius of the camber line at the tip less that of the clamped nodes
    span: float = stored(units="m")
    provenance: Provenance  # the blade, its mesh and settings, the code

    def rows(self, directions: Collection[str]) -> csr_matrix:
        """Rows of S (directions n, n_full) of each patch or point in ``directions``, of "rtz"."""
        return self.S[self.kept(directions)]

    def kept(self, directions: Collection[str]) -> NDArray[np.bool_]:
        """Whether each row of S is of one of the ``directions``."""
        return np.tile([letter in directions for letter in "rtz"], self.S.shape[0] // 3)

    @property
    def slope(self) -> NDArray[np.float64]:
        """Slope dr/dz (places,) of the tip at the places of its camber line."""
        return slope_of_tip(self.coordinates[np.unique(self.S.indices // 3)], self.camber)


@frozen
class Matrices(Constants, Stored):
    """The constants, with K(Omega) and static deflections at some speeds."""

    code = CODE

    # K at rest first; in all, K at speed i is the sum of weights[i, j] K[j]
    K: tuple[csr_matrix, ...] = stored("matrix dof dof_", "N m-1 / weight", sparse=True)
    weights: NDArray[np.float64] = stored("speed matrix", "1, or Omega^2: rad2 s-2")
    speeds: NDArray[np.float64] = stored("speed", "rad s-1")  # ascending
    u_static: NDArray[np.float64] = stored("speed dof", "m", may_be_nan=True)
    # equilibrium residual over the centrifugal load
    residuals: NDArray[np.float64] = stored("speed", may_be_nan=True)

    @property
    def given(self) -> bool:
        """Whether they were made elsewhere, at speeds of their own."""
        return "full_matrices" in self.provenance.settings

    @property
    def top_speed(self) -> float:
        """Omega_m, rad/s: the last of the speeds, or the given one for matrices at rest alone."""
        return float(self.speeds[-1] or self.provenance.settings["max_speed_rad_s"])

    @classmethod
    def of(cls, constants: Constants, states: Iterable[Prestressed]) -> Self:
        """Matrices at the speeds of ``states``."""
        states = list(states)
        K = {id(A): A for state in states for _, A in state.terms}
        factors = [{id(A): factor for factor, A in state.terms} for state in states]
        return cls(
            **vars(constants),
            K=tuple(K.values()),
            weights=np.array([[of.get(A, 0.0) for A in K] for of in factors]),
            speeds=np.array([state.speed for state in states]),
            u_static=np.array([state.u_static for state in states]),
            residuals=np.array([state.residual for state in states]),
        )

    def states(self) -> Iterator[Prestressed]:
        """The state at each speed."""
        terms = (tuple(zip(of_speed, self.K, strict=True)) for of_speed in self.weights)
        return map(Prestressed, self.speeds, terms, self.u_static, self.residuals)

    def at(self, speeds: ArrayLike) -> "Matrices":
        """The matrices at ``speeds`` (rad/s) only, which must be among their own.

        Raises
        ------
        ValueError
            When a speed is not among them.
        """
        distance = abs(self.speeds - np.reshape(speeds, (-1, 1)))
        require(
            (
                distance.min(axis=1).max() <= 1e-12 * self.speeds[-1],
                f"matrices at {self.speeds} rad/s hold none at some of {speeds}",
            ),
            kind=ValueError,
        )
        kept = distance.argmin(axis=1)
        return replace(
            self,
            weights=self.weights[kept],
            speeds=self.speeds[kept],
            u_static=self.u_static[kept],
            residuals=self.residuals[kept],
        )

    def require_possible(self) -> None:
        """Check that nodes, interface and states are those of M, S and one another.

        Raises
        ------
        ValueError
            If not; the message says which.
        """
        finite = {name: np.isfinite(getattr(self, name)) for name in ("u_static", "residuals")}
        require(
            (
                self.S.shape[0] in (3 * len(self.xi), 6 * len(self.xi))
                and self.M.shape[0] == 3 * len(self.coordinates),
                "xi or coordinates: not of three DoFs each",
            ),
            (
                self.weights.shape == (len(self.speeds), len(self.K)),
                f"K: {len(self.K)} matrices with weights {self.weights.shape} at "
                f"{len(self.speeds)} speeds",
            ),
            # of matrices made elsewhere: nan throughout
            *((of.all() or not of.any(), f"{name}: not finite") for name, of in finite.items()),
            kind=ValueError,
        )
