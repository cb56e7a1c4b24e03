"""``rom-<directions>.nc``: the reduced model, the only file of a blade that the simulator needs."""

from collections.abc import Callable
from functools import lru_cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh
from scipy.optimize import linear_sum_assignment

from geometry.base import RPM, Provenance, UserError, require
from geometry.hats import hats, lean, mean, middles, over_edges, projection
from geometry.stored import Stored, frozen, stored
from geometry.tip import EDGES, on_line, slope_of_line
from rom.polynomial import evaluate, interpolate

CODE = ("fem.assemble", "rom.full_model", "rom.reduce")  # modules that compute its numbers
SAME_F1 = 1e-6  # relative difference of squares, for round-off
DIRECTIONS = {"r": "radial", "t": "tangential", "z": "axial"}
KEPT = 256  # speeds whose modes are kept, of all models: 16 MB with 88 DoFs


class RomError(UserError):
    """A reduced model that cannot be read or used; the message says which and why."""


def require_letters(letters: str) -> None:
    """Refuse interface directions other than "r", "rt" or "rtz".

    Raises
    ------
    RomError
        For other letters.
    """
    if not letters or not "rtz".startswith(letters):
        raise RomError("allowed r, rt, rtz", key="interface directions", value=letters)


def require_speed(Omega: float, Omega_m: float) -> None:
    """Refuse speeds outside [0, Omega_m], rad/s, where the polynomials in Omega do not hold.

    Raises
    ------
    RomError
        If ``Omega`` is outside; the message names both.
    """
    if not 0 <= Omega <= Omega_m * (1 + 1e-12):
        raise RomError(
            f"speed {Omega:.6g} rad/s is outside [0, {Omega_m:.6g}] rad/s ({RPM * Omega:.6g} rpm, "
            f"highest {RPM * Omega_m:.6g})",
            allowed=(0, Omega_m),
        )


@frozen
class Rom(Stored):
    """M and K(Omega) in reduced coordinates (c, q); the interface DoFs c = S u come first.

    DoF d i + j of c belongs to direction j of patch or point i, with d directions; with two rows
    across the thickness come those of the edge behind, then those of the edge ahead.

    >>> rom = Rom.load("rom-r.nc")
    >>> print(f"f1(0) = {rom.f1:.0f} Hz")
    f1(0) = 259 Hz
    >>> omega, Phi = rom.modes(500.0)  # at 500 rad/s
    >>> print(f"f1 = {omega[0] / (2 * np.pi):.0f} Hz")
    f1 = 320 Hz
    """

    code = CODE

    M: NDArray[np.float64] = stored("dof dof_", "kg")
    K: NDArray[np.float64] = stored(
        "power dof dof_", "N m-1 (rad s-1)^-power", long_name="K(Omega) = sum Omega^power K"
    )
    directions: tuple[str, ...] = stored("direction")  # of each interface DoF: radial first
    xi: NDArray[np.float64] = stored("xi")  # (n_c,), chord fractions: nodes of hats, or points
    # (n_c, 3), r, theta, z of interface points; (0, 3) of patches
    points: NDArray[np.float64] = stored("point rtz", "m, rad, m")
    # (places, 3), r, theta, z at equally spaced xi from 0 to 1
    camber: NDArray[np.float64] = stored("place rtz", "m, rad, m")
    Omega_m: float = stored(units="rad s-1")  # highest speed
    f1: float = stored(units="Hz")  # first natural frequency at rest
    span: float = stored(units="m")  # blade length
    provenance: Provenance  # blade, mesh, settings, code
    # rows across the thickness: 1, or 2, of the edges behind and ahead
    across: int = stored(default_factory=lambda: 1)
    # (2, places): angles of the sides behind and ahead at the z of ``camber``; (2, 0): not known
    sides: NDArray[np.float64] = stored(
        "side camber_side", "rad", default_factory=lambda: np.empty((2, 0))
    )
    # (powers, across n_c): radius of the tip at its static equilibrium less that at rest, on the
    # hats or at the points, growth(Omega) = sum Omega^power growth; (0, n_c) where it is not known
    growth: NDArray[np.float64] = stored(
        "growth_power growth_xi",
        "m (rad s-1)^-power",
        default_factory=lambda: np.empty((0, 0)),
        long_name="static growth of the tip's radius",
    )
    # (powers, across n_c): axial displacement of a tip that tapers there, likewise; else (0, n_c)
    advance: NDArray[np.float64] = stored(
        "advance_power advance_xi",
        "m (rad s-1)^-power",
        default_factory=lambda: np.empty((0, 0)),
        long_name="static axial displacement of the tip",
    )
    # of its basis, at which K(Omega) is that of the full model, ascending; empty: not known
    speeds: NDArray[np.float64] = stored(
        "speed", "rad s-1", default_factory=lambda: np.empty(0), long_name="speeds of the basis"
    )
    # (places,): slope dr/dz of the tip at the places of ``camber``; (0,): that of ``camber``
    slope: NDArray[np.float64] = stored("slope_place", default_factory=lambda: np.empty(0))
    # (2, n): rows of u_t at ``EDGES``, of a tip that tapers; else (0, n)
    u_t: NDArray[np.float64] = stored(
        "edge timed_dof",
        default_factory=lambda: np.empty((0, 0)),
        long_name="tangential displacement at xi = 1/16 and 15/16, which blade tip timing measures",
    )
    # (modes, 3): numbers, from 1, of modes whose frequencies at rest are given; these frequencies
    # of the clamped blade, and as given (``rom.measured``)
    measured: NDArray[np.float64] = stored(
        "measured_mode number_clamped_given",
        "1, Hz, Hz",
        default_factory=lambda: np.empty((0, 3)),
        long_name="natural frequencies at rest given in place of those of the clamped blade",
    )
    # names of the grids of strain gauges; none but in a model that is made for a scene
    gauges: tuple[str, ...] = stored("gauge", default_factory=tuple)
    # (powers, 2, gauges, 1 + n), sum Omega^power gauge_rows: strain along each grid, 1, and stress
    # along it, Pa: of the static deflection, then their derivatives about it by each DoF
    gauge_rows: NDArray[np.float64] = stored(
        "gauge_power quantity gauge static_dof",
        "1 and Pa, m-1 and Pa m-1, (rad s-1)^-power",
        default_factory=lambda: np.empty((0, 2, 0, 0)),
        long_name="strain and stress along gauges: static, then by displacements of the DoFs",
    )

    def require_possible(self) -> None:
        """Check that the matrices are those of a blade at rest, and the numbers of one interface.

        Raises
        ------
        ValueError
            If not; the message says which.
        """
        require(
            (
                min(self.Omega_m, self.f1, self.span) > 0,
                "Omega_m, f1 or span: not positive",
            ),
            (
                not np.any(np.diff(self.xi) <= 0) and len(self.points) in (0, len(self.xi)),
                "xi or points: not along the chord",
            ),
            (
                min(len(self.xi), len(self.camber)) >= 2  # displacements are linear between places
                and 0 < self.across * len(self.xi) * len(self.directions) <= self.n,
                "directions, xi or camber: too many or too few for M",
            ),
            kind=ValueError,
        )
        try:
            lowest = eigh(self.K[0], self.M, eigvals_only=True, subset_by_index=[0, 0])[0]
        except np.linalg.LinAlgError:
            raise ValueError("M: not positive definite") from None
        if abs(lowest / self.omega1**2 - 1) > SAME_F1:
            raise ValueError("f1: not that of K and M at rest")

    @property
    def n(self) -> int:
        """Number of reduced DoFs."""
        return len(self.M)

    @property
    def omega1(self) -> float:
        """2 pi f1(0), rad/s: the unit of speeds over f1(0)."""
        return 2 * np.pi * self.f1

    @property
    def of_points(self) -> bool:
        """Whether its interface DoFs are displacements of points, not coefficients of patches."""
        return len(self.points) > 0

    @property
    def elsewhere(self) -> bool:
        """Whether it was made elsewhere: its full model and mesh are not known."""
        return "reduced_model" in self.provenance.settings

    def line(self, xi: NDArray[np.float64]) -> NDArray[np.float64]:
        """Camber line of the tip at chord fractions ``xi`` (k,): r, theta, z (k, 3), m, rad."""
        return on_line(self.camber, xi)

    def weights(self, leans: bool) -> tuple[float, ...]:
        """Weights of the edges in their mean, or in the lean, the edge ahead less that behind."""
        return lean(self.across) if leans else mean(self.across)

    def arc(self, xi: NDArray[np.float64]) -> NDArray[np.float64]:
        """Arc r dtheta (k,), m, that the tip covers at the z of chord fractions ``xi`` (k,).

        Raises
        ------
        RomError
            When the model does not know its sides.
        """
        if not self.sides.size:
            raise RomError(
                "the reduced model does not know the thickness of its tip: give the arc, mm, that "
                "the tip covers",
                key="liner.footprint_mm",
            )
        behind, ahead = (np.interp(xi, np.linspace(0, 1, len(s)), s) for s in self.sides)
        return self.line(xi)[:, 0] * (ahead - behind)

    def rows(
        self, xi: NDArray[np.float64], direction: str = "r", leans: bool = False
    ) -> NDArray[np.float64]:
        """P (k, n): displacement at chord fractions ``xi`` (k,) in a direction = P u.

        Of the tip's middle; where it ``leans``, of the edge ahead less that of the edge behind.

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
        interface = count * self.across * len(self.xi)
        P[:, first:interface:count] = over_edges(xi, self.xi, self.weights(leans))
        return P

    @property
    def taper(self) -> NDArray[np.float64]:
        """Slope dr/dz (places,) of the tip at equally spaced xi from 0 to 1."""
        r, _, z = self.camber.T
        return self.slope if self.slope.size else slope_of_line(r, z)

    def closing_rows(
        self, xi: NDArray[np.float64], slope: NDArray[np.float64], leans: bool = False
    ) -> NDArray[np.float64]:
        """P (k, n): u_r - s u_z = P u at chord fractions ``xi`` (k,), under a casing of ``slope``.

        Of the tip's middle, or where it ``leans`` as ``rows``.
        What closes a gap that is measured along the radius; u_r where the slope s (places,) at
        equally spaced xi is 0. The product s u_z is projected on the hats, as S projects
        displacements: taken at the hats' nodes alone it errs by some per cent where s varies.

        Raises
        ------
        RomError
            When the slope is not 0 and the model was reduced without axial interface DoFs.
        """
        if not slope.any():
            return self.rows(xi, "r", leans)
        axial = self.rows(self.xi, "z", leans)
        if self.of_points:
            N = np.diag(np.interp(self.xi, np.linspace(0, 1, len(slope)), slope))
        else:
            N = projection(self.xi, self.xi, slope)
        return self.rows(xi, "r", leans) - hats(xi, self.xi) @ N @ axial

    @property
    def timing_rows(self) -> NDArray[np.float64]:
        """Rows of u_t (2, n) at ``EDGES``; (0, n) where the model does not know them."""
        if DIRECTIONS["t"] in self.directions:
            return self.rows(np.array(EDGES), "t")
        return self.u_t.reshape(-1, self.n)

    def require_directions(self, letters: str) -> None:
        """Refuse a model without the interface DoFs "r", "rt" or "rtz".

        Raises
        ------
        RomError
            When one of these directions is missing.
        """
        for letter in letters:
            self.rows(self.xi[:1], letter)

    def stiffness(self, Omega: float) -> NDArray[np.float64]:
        """K(Omega) (n, n), N/m, Eq. (2); Omega in rad/s.

        Raises
        ------
        RomError
            Outside [0, Omega_m].
        """
        require_speed(Omega, self.Omega_m)
        return evaluate(self.K, Omega)

    @property
    def places(self) -> NDArray[np.float64]:
        """Chord fractions of the middles of as many strips as it has patches, or of its points."""
        return self.xi if self.of_points else middles(len(self.xi))

    def compliance(self, Omega: float) -> NDArray[np.float64]:
        """Displacement (places, directions), m/N, of each place under a unit load at it.

        Raises
        ------
        RomError
            Outside [0, Omega_m].
        """
        flexibility = np.linalg.inv(self.stiffness(Omega))
        letters = [letter for letter, name in DIRECTIONS.items() if name in self.directions]
        rows = [self.rows(self.places, letter) for letter in letters]
        return np.column_stack([np.diag(P @ flexibility @ P.T) for P in rows])

    def growth_at(
        self, xi: NDArray[np.float64], Omega: float, leans: bool = False
    ) -> NDArray[np.float64]:
        """Static growth (k,), m, of the tip's radius at chord fractions ``xi`` (k,) and a speed.

        Of the tip's middle, or where it ``leans`` as ``rows``.

        Raises
        ------
        RomError
            Outside [0, Omega_m], or when the model does not know its growth.
        """
        require_speed(Omega, self.Omega_m)
        if not self.growth.size:
            raise RomError("the reduced model does not hold the growth of its tip with speed")
        return over_edges(xi, self.xi, self.weights(leans)) @ evaluate(self.growth, Omega)

    def advance_at(
        self, xi: NDArray[np.float64], Omega: float, leans: bool = False
    ) -> NDArray[np.float64]:
        """Static axial displacement (k,), m, as ``growth_at``; 0 without taper."""
        if not self.advance.size:
            return np.zeros(len(xi))
        return over_edges(xi, self.xi, self.weights(leans)) @ evaluate(self.advance, Omega)

    @lru_cache(KEPT)  # noqa: B019  models are few, and leave with their last speed
    def modes(self, Omega: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Natural frequencies omega (n,), rad/s, and modes Phi (n, n), M-normalised, at Omega.

        Those of the last speeds are kept: runs at one speed share them.

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
                f"polynomial errs; raise basis.speeds, lower the highest speed or use prestress: "
                f"linear"
            )
        return np.sqrt(values), Phi

    def families(self, Omega: float) -> NDArray[np.int64]:
        """Family (n,), from 0, of each mode at Omega, rad/s: the mode at rest most like it.

        Of the pairings of all modes with those at rest that of the largest sum of (phi^T M phi)^2.
        """
        likeness = (self.modes(0.0)[1].T @ self.M @ self.modes(Omega)[1]) ** 2
        return linear_sum_assignment(likeness.T, maximize=True)[1]

    def beyond(self, degree: int) -> Callable[[float], NDArray[np.float64]]:
        """Natural frequencies omega (n,), rad/s, over Omega above Omega_m, rad/s.

        omega^2 is a polynomial in Omega^2 of this ``degree``, through the last ``degree`` + 1
        speeds of the basis. That of a rotating blade is nearly linear (Southwell): how far degree 2
        differs from 1 tells how far both are to be trusted.
        """
        last = self.speeds[-1 - degree :]
        through = interpolate(np.array([self.modes(speed)[0] ** 2 for speed in last]), last)
        return lambda Omega: np.sqrt(np.maximum(evaluate(through, Omega), 0.0))

    def save(self, path: str | Path) -> None:
        """Write NetCDF, with the powers of Omega."""
        super().save(path, power=2 * np.arange(len(self.K)))
