"""The full model at the speeds of a reduced one: ``full-model.nc``, and matrices at enough speeds.

The error of a polynomial K(Omega) through n places x = (Omega / Omega_m)^2 is c_n w(x), with w the
product of the distances to the places. K is smooth: c_n falls by about the same factor with each
further place. Leaving out two speeds, and one, shows c_(n-2) and c_(n-1) at those left out, and so
c_n. On blades whose f1 rises by 30 to 120 %, with 4 to 8 speeds, the estimate was 0.15 to 8 times
the error, in nine of ten cases from a quarter of it to twice.
"""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from itertools import combinations, islice
from math import isinf
from typing import Self

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh

from fem.cholesky import Cholesky
from fem.matrices import CODE, Constants, Matrices, Prestressed
from geometry.base import Provenance, Say, silent
from geometry.blade import EnrichedBasis, PaperBasis
from geometry.hats import hat_nodes, mean, middles, over_edges
from geometry.stored import Stored, frozen, stored
from geometry.tip import EDGES, on_line
from rom.basis import project
from rom.components import AtSpeed
from rom.model import RomError
from rom.modes import ShiftInvert
from rom.polynomial import evaluate, interpolate, node_polynomial, places_between

MODES = 10  # frequencies compared
SHAPES = 5  # mode shapes at rest, for figures
BENT = 3  # modes whose second order is computed
FURTHER = 4  # modes of the range beyond those that are compared
SAFETY = 5.0  # times the estimate must be within the tolerance, so that the check is met
MOST = 12  # speeds; the powers of Omega^2 then lose eight digits of sixteen


type Along = Callable[[NDArray, NDArray, NDArray], float]  # ``SecondOrder.along``


@frozen
class FullModel(Stored):
    """Frequencies and compliance of the interface of the full model over its speeds."""

    code = CODE

    speeds: NDArray[np.float64] = stored("speed", "rad s-1")  # rest first
    omega: NDArray[np.float64] = stored("speed mode", "rad s-1")
    residuals: NDArray[np.float64] = stored("speed mode")  # of these modes
    # C = S K^-1 S^T, (speeds, 3 across n, 3 across n), order as in S
    compliance: NDArray[np.float64] = stored("speed dof dof_", "m N-1")
    shapes: NDArray[np.float64] = stored("shape point xyz", "kg-1/2")  # modes at rest, Cartesian
    coordinates: NDArray[np.float64] = stored("point xyz", "m")  # free nodes of the mesh
    provenance: Provenance  # that of the matrices
    # of the first modes at ``EDGES``, per modal displacement: u_r, u_t, u_z, and per square of it
    # the change of the tip's radius of second order; nan: not known
    tip: NDArray[np.float64] = stored(
        "bent_speed rtz edge bent_mode", "kg-1/2", default_factory=lambda: np.empty((0, 3, 2, 0))
    )
    second_order: NDArray[np.float64] = stored(
        "bent_speed edge bent_mode",
        "m-1 kg-1",
        default_factory=lambda: np.empty((0, 2, 0)),
        may_be_nan=True,
    )

    def joined(self, other: Self) -> Self:
        """With the results of ``other``, at further speeds."""
        order = np.argsort(np.concatenate([self.speeds, other.speeds]))
        names = "speeds", "omega", "residuals", "compliance", "tip", "second_order"
        both = {
            name: np.concatenate([getattr(model, name) for model in (self, other)])
            for name in names
        }
        return replace(self, **{name: values[order] for name, values in both.items()})


def solve(
    fom: Constants,
    states: Iterable[Prestressed],
    cholesky: Cholesky | None = None,
    along: Along | None = None,
) -> FullModel:
    """First modes, and compliance of the interface, at every state.

    Parameters
    ----------
    states : at ascending speeds; one at a time is kept
    cholesky : factorises K of the states, unless it holds the factor already
    along : of ``fem.second_order``; None: the second order is not known

    Raises
    ------
    rom.modes.ModesError
        When K is not positive definite, or modes do not converge.
    """
    cholesky = cholesky or Cholesky()
    return of_components(fom, (AtSpeed.of(fom, of, MODES, cholesky) for of in states), along)


def of_components(
    fom: Constants, at_speeds: Iterable[AtSpeed], along: Along | None = None
) -> FullModel:
    """The full model, of its component modes at ascending speeds; ``along``: as of ``solve``.

    More than ``MODES`` natural modes may be known.
    """
    P = over_edges(EDGES, fom.xi, mean(fom.across))
    edges = np.stack([P @ fom.rows(letter) for letter in "rtz"])
    radius = on_line(fom.camber, np.array(EDGES))[:, :1]
    rows: list[tuple] = []
    shapes: list[NDArray[np.float64]] = []  # at rest, once known
    for at in at_speeds:
        modes, compliance = at.modes, fom.S @ at.A
        Phi, omega = modes.Phi[:, :BENT], modes.omega[:BENT]
        tip = edges @ Phi
        second = np.full(tip.shape[1:], np.nan)
        if along:
            loaded = at.A[:, fom.kept("r")] @ P.T
            for edge, mode in np.ndindex(*second.shape):
                # the mode itself leaves the static field: its amplitude is given
                x = loaded[:, edge] - Phi[:, mode] * tip[0, edge, mode] / omega[mode] ** 2
                second[edge, mode] = along(at.u_static, x, Phi[:, mode])
        second += tip[1] ** 2 / 2 / radius
        compared = modes.omega[:MODES], modes.residuals[:MODES]
        rows.append((at.speed, *compared, compliance, tip, second))
        shapes = shapes or [modes.Phi]
    speeds, omega, residuals, compliances, tip, second = map(np.array, zip(*rows, strict=True))
    return FullModel(
        speeds=speeds,
        omega=omega,
        residuals=residuals,
        compliance=compliances,
        shapes=shapes[0][:, :SHAPES].T.reshape(SHAPES, -1, 3),
        coordinates=fom.coordinates,
        provenance=fom.provenance,
        tip=tip,
        second_order=second,
    )


def compliance_of_strips(C: NDArray[np.float64], across: int = 1) -> NDArray[np.float64]:
    """Displacement (n,), m/N, of the middle of each of n strips under a unit load at it.

    ``C`` (across n, across n): compliance of n patches in one direction.
    """
    n = len(C) // across
    P = over_edges(middles(n), hat_nodes(n), mean(across))
    return np.diag(P @ C @ P.T)


def error_between(
    M: NDArray[np.float64], K: NDArray[np.float64], speeds: NDArray[np.float64]
) -> float:
    """Estimate of the largest relative error of the first frequencies of K(Omega) over its range.

    Parameters
    ----------
    M, K : (n, n) and (speeds, n, n), kg and N/m, in one basis
    speeds : ascending from rest, rad/s

    Returns
    -------
    nan if there are fewer than four speeds: two cannot be left out between their ends.
    """
    between = range(1, len(speeds) - 1)
    if len(between) < 2:
        return np.nan
    x = (speeds / speeds[-1]) ** 2
    one, two = (
        max(_coefficient(M, K, x, list(out)) for out in combinations(between, count))
        for count in (1, 2)
    )
    return one**2 / two * float(node_polynomial(x, places_between(x)).max()) if two > 0 else 0.0


def _coefficient(M: NDArray, K: NDArray, x: NDArray, out: list[int]) -> float:
    """Largest error of a frequency at the places ``out`` of a polynomial without them, over w."""
    kept = np.delete(x, out)
    polynomial = interpolate(np.delete(K, out, axis=0), np.sqrt(kept))
    errors = [
        abs(_frequencies(evaluate(polynomial, np.sqrt(x[j])), M) / _frequencies(K[j], M) - 1).max()
        / abs(x[j] - kept).prod()
        for j in out
    ]
    return float(max(errors))


def _frequencies(K: NDArray, M: NDArray) -> NDArray:
    """First frequencies, rad/s; 0 for those that are not real."""
    values = eigh(K, M, eigvals_only=True, subset_by_index=[0, min(MODES, len(M)) - 1])
    return np.sqrt(np.maximum(values, 0))


def resolved(
    fom: Constants,
    states: Iterator[Prestressed],
    speeds: list[float],
    basis: EnrichedBasis | PaperBasis,
    say: Say = silent,
) -> Matrices:
    """Matrices at ``speeds``, and at further ones until K(Omega) meets the tolerance of ``basis``.

    Parameters
    ----------
    states : at the ``speeds``, from which it takes each when the state is asked for
    speeds : ascending, rad/s; each further one is appended: where w is largest (Leja's points)
    say : called with each further speed and its reason

    Raises
    ------
    RomError
        When ``MOST`` speeds are not enough.
    """
    chosen = list(islice(states, len(speeds)))
    if isinf(basis.tolerance_percent):
        return Matrices.of(fom, chosen)
    # modes at an inner speed stand for those of the whole range
    T = ShiftInvert(chosen[-2].K, fom.M).modes(MODES + FURTHER).Phi
    M = project(fom.M, T)
    # nan, of three speeds, is not small enough either
    while not (error := _error(M, T, chosen)) <= basis.tolerance_percent / 100 / SAFETY:
        through = f"frequencies of K(Omega) through {len(chosen)} speeds"
        shown = f"{through} err by some {100 * error:.2g} %"
        if len(chosen) == MOST:
            raise RomError(
                f"{shown}, for basis.tolerance_percent {basis.tolerance_percent:g} too much: lower "
                f"the highest speed, or allow more"
            )
        speeds.append(_next(speeds))
        say(f"{shown}: one more, {speeds[-1]:.6g} rad/s")
        chosen = sorted([*chosen, next(states)], key=lambda state: state.speed)
    return Matrices.of(fom, chosen)


def _error(M: NDArray, T: NDArray, states: list[Prestressed]) -> float:
    """Error between the speeds of ascending ``states``, in the basis T."""
    K = np.array([project(state.K, T) for state in states])
    return error_between(M, K, np.array([state.speed for state in states]))


def _next(speeds: list[float]) -> float:
    """The speed at which w is largest."""
    x = (np.sort(speeds) / max(speeds)) ** 2
    places = places_between(x)
    return float(max(speeds) * np.sqrt(places[node_polynomial(x, places).argmax()]))
