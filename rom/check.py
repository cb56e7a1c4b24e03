"""``rom-check-<directions>.nc``: the reduced model against the full one over its speed range."""

import warnings

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray

from geometry.base import Caution, Provenance, require
from geometry.hats import mean, over_edges
from geometry.stored import Stored, frozen, stored
from rom.full_model import FullModel, error_between
from rom.model import CODE, DIRECTIONS, Rom, RomError
from rom.polynomial import node_polynomial, places_between

MORE = "raise basis.speeds, lower the highest speed"  # remedies of an error between the speeds

APART = 5.0  # times that c of neighbours may differ: at most 3.7 times on the blades tried
SMALL = 0.1  # of the tolerance: an error that does not matter


@frozen
class RomCheck(Stored):
    """Frequencies and static compliance of the tip of full and reduced model."""

    code = CODE

    speeds: NDArray[np.float64] = stored("speed", "rad s-1")
    full: NDArray[np.float64] = stored("speed mode", "rad s-1")
    reduced: NDArray[np.float64] = stored("speed mode", "rad s-1", may_be_nan=True)
    xi: NDArray[np.float64] = stored("place", long_name="chord fraction")  # of strips, or points
    # relative; compliance: displacement of a place under a unit load at the same place
    compliance_error: NDArray[np.float64] = stored("speed place direction", may_be_nan=True)
    # frequency of the reduced model over all speeds
    highest: float = stored(units="rad s-1", may_be_nan=True)
    # relative, of frequencies, between the speeds of matrices from elsewhere; nan: not known
    between: float = stored(may_be_nan=True)
    provenance: Provenance  # that of the reduced model
    # of the full model, see there
    tip: NDArray[np.float64] = stored(
        "bent_speed rtz edge bent_mode", "kg-1/2", default_factory=lambda: np.empty((0, 3, 2, 0))
    )
    second_order: NDArray[np.float64] = stored(
        "bent_speed edge bent_mode",
        "m-1 kg-1",
        default_factory=lambda: np.empty((0, 2, 0)),
        may_be_nan=True,
    )

    @property
    def error(self) -> NDArray[np.float64]:
        """Relative frequency error (speeds, modes)."""
        return self.reduced / self.full - 1

    @property
    def worst(self) -> tuple[int, int]:
        """Indices (speed, mode) of the largest frequency error; nan counts as the largest."""
        speed, mode = np.unravel_index(abs(self.error).argmax(), self.error.shape)
        return int(speed), int(mode)

    def require(self, tolerance_percent: float) -> None:
        """Refuse a model whose largest frequency error exceeds ``tolerance_percent``.

        Raises
        ------
        RomError
            If it does; the message names mode, speed, error and remedy.

        Warns
        -----
        Caution
            Where the error between the speeds of matrices from elsewhere is not known.
        """
        error, (speed, mode) = abs(self.error), self.worst
        allowed = f"basis.tolerance_percent {tolerance_percent:g}"
        where = f"at {self.speeds[speed]:.6g} rad/s"
        # both ends of the range are speeds of every basis, at which the polynomial has no error
        remedy = (
            "at the ends of the range the error is far smaller, so it is that of K(Omega) "
            f"between its speeds: {MORE}"
            if error[[0, -1]].max() < error.max() / 4
            else "raise basis.natural_modes, lower basis.rank_tolerance"
        )
        require(
            (
                not np.isfinite(tolerance_percent) or np.isfinite(error).all(),
                f"the reduced K(Omega) is not positive definite {where}, where the full one "
                f"is: {MORE}",
            ),
            (
                not error.max() > tolerance_percent / 100,
                f"frequency {mode + 1} is off by {100 * error.max():.3g} % {where}, above "
                f"{allowed}; {remedy} or allow more",
            ),
            (
                not self.between > tolerance_percent / 100,  # holds for nan as well
                f"frequencies of K(Omega) are off by some {100 * self.between:.2g} % between its "
                f"{len(self.speeds)} speeds (one left out, and compared there), above {allowed}; "
                f"give K at more speeds, or allow more",
            ),
            kind=RomError,
        )
        if np.isnan(self.between) and "full_matrices" in self.provenance.settings:
            warnings.warn(
                f"full_matrices.K: {len(self.speeds)} speeds: how far K(Omega) is off between them "
                "is not known; it is from four on, as one can then be left out",
                Caution,
                stacklevel=2,
            )


def check(rom: Rom, full: FullModel) -> RomCheck:
    """Compare frequencies and compliances of the tip at the speeds of ``full``.

    The compliances are those of the middles of as many strips as there are patches, or of the
    points. Where the reduced K(Omega) is not positive definite, its frequencies are nan.

    Raises
    ------
    RomError
        When the reduced model has fewer DoFs than the frequencies that are compared.
    """
    modes = full.omega.shape[1]
    if rom.n < modes:
        raise RomError(
            f"the reduced model has {rom.n} DoFs, fewer than the {modes} frequencies checked; "
            "raise interface.patches or basis.natural_modes, or lower basis.rank_tolerance"
        )
    reduced = np.array([_frequencies(rom, speed) for speed in full.speeds])
    # of the full model in each direction: speeds, places, 3
    P = over_edges(rom.places, rom.xi, mean(rom.across))
    C = full.compliance.reshape(-1, *(P.shape[1], 3) * 2)
    of_each = np.einsum("pi,sidjd,pj->spd", P, C, P)
    compliance = np.array([rom.compliance(speed) for speed in full.speeds])
    kept = [name in rom.directions for name in DIRECTIONS.values()]
    # of matrices from elsewhere: our own basis sees to K(Omega) between its speeds itself
    elsewhere = "full_matrices" in rom.provenance.settings
    K = np.array([rom.stiffness(Omega) for Omega in full.speeds])
    return RomCheck(
        speeds=full.speeds,
        full=full.omega,
        reduced=reduced[:, :modes],
        xi=rom.places,
        compliance_error=compliance / of_each[..., kept] - 1,
        highest=float(np.nanmax(reduced)),
        between=error_between(rom.M, K, full.speeds) if elsewhere else np.nan,
        provenance=rom.provenance,
        tip=full.tip,
        second_order=full.second_order,
    )


def further_speeds(
    check: RomCheck, basis: NDArray[np.float64], tolerance_percent: float
) -> NDArray[np.float64]:
    """Speeds, rad/s, at which a model is to be checked, too: none where neighbours agree.

    Between the speeds of its ``basis``, ascending, a smooth K(Omega) errs by c w, w the product of
    the distances to them in Omega^2, with about the same c everywhere. Where that of two neighbours
    among its speeds differs by more than ``APART`` times, and the error matters, two more
    speeds around each of them tell more.
    """
    x = (basis / basis[-1]) ** 2
    places = places_between(x)
    near = abs(check.speeds[:, None] - basis[-1] * np.sqrt(places)).argmin(axis=0)
    error = abs(check.error).max(axis=1)[near]
    c = error / node_polynomial(x, places)
    pairs = sliding_window_view(c, 2), sliding_window_view(error, 2)
    differs = pairs[0].max(axis=1) > APART * pairs[0].min(axis=1)
    unclear = np.flatnonzero(differs & (pairs[1].max(axis=1) > SMALL * tolerance_percent / 100))
    around = np.union1d(unclear, unclear + 1)
    halfway = [(places[around] + ends[around]) / 2 for ends in (x[:-1], x[1:])]
    return basis[-1] * np.sqrt(np.sort(np.concatenate(halfway)))


def _frequencies(rom: Rom, Omega: float) -> NDArray[np.float64]:
    try:
        return rom.modes(Omega)[0]
    except RomError:
        return np.full(rom.n, np.nan)
