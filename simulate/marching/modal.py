"""The blade in modal coordinates q = Phi^T M u, as the kernels of both schemes read it.

With Phi the modes of K(Omega) and D = M Phi diag(2 zeta omega) Phi^T M, every matrix of Eqs.
(19)-(20) is diagonal in q, so a step costs O(n) and the interface rows of Phi.
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from simulate.contact.compiled import compiled, compiled_sums

LANES = 8  # interface rows summed in one pass over the modes; a cache line of numbers
TURNS = 3  # steps kept: n + 1, n and n - 1, in rows that take turns


@compiled
def stands(scheme, motion, last):
    """A rigid casing."""


@compiled
def takes_nothing(scheme, strips, state, step):
    """A rigid casing."""


@compiled
def stays(scheme, motion, now):
    """A rigid casing."""


class Scheme(NamedTuple):
    """Coefficients of a run as the kernel reads them.

    Modes and interface rows are padded with zeros to multiples of LANES: vectors without a rest.
    Rows are the radial displacements over the strips, then, where modelled, the tangential ones,
    then the leans.
    """

    a: NDArray[np.float64]  # (n,), free motion
    b: NDArray[np.float64]  # (n,), free motion
    loss: NDArray[np.float64]  # (3, n), dissipation in a step
    # (4, n) or (1, n), by a modal force of 1: less x and y after a step; static x and y
    gain: NDArray[np.float64]
    Phi: NDArray[np.float64]  # (rows, n), interface rows
    C: NDArray[np.float64]  # (rows, rows), m/N, displacement of the rows by forces on them
    # compiled functions
    advance: Any  # free motion of one mode over a step
    correct: Any  # effect of the modal force
    find_force: Any  # force of the liner in the step
    forces: Any = None  # of the strips in contact, where they are found implicitly
    sliding: Any = None  # ``friction.Sliding`` where the tip slides with friction
    turn: Any = stands  # what the casing does before a step
    book: Any = takes_nothing  # and after it
    turning: Any = None  # ``moving_casing.Turning`` where it moves, ``common_casing.Lent``
    reach: Any = stays  # where the other blades press it to in the step
    summed: Any = None  # ``forced.Summed`` where sums by mode are kept


class Motion(NamedTuple):
    """The blade's motion: three steps whose rows take turns, and the forces on it."""

    x: NDArray[np.float64]  # (TURNS, n), modal displacements
    y: NDArray[np.float64]  # (TURNS, n), second phase-plane coordinates, piecewise-exact alone
    u: NDArray[np.float64]  # (TURNS, rows), m, interface displacements
    moved: NDArray[np.float64]  # (rows,), m, displacement by the force in the last step
    force: NDArray[np.float64]  # (rows,), N, of the liner on the blade, inward and backward
    modal: NDArray[np.float64]  # (n,), N kg^-1/2, Phi^T force
    free: NDArray[np.float64]  # (rows,), m, radial displacements that meet no rod for some steps
    came: NDArray[np.float64]  # (rows,), m, by turning a casing that moves to the frame of a step


class Step(NamedTuple):
    """One step of a run: its place, and the turns of the steps in ``Motion``."""

    number: int  # of the revolution
    a: float  # share of the casing distortion reached at the time of its rods
    a_end: float  # and at the end of the step
    now: int
    last: int
    before: int


def scheme_arrays(
    a: NDArray[np.float64],
    b: NDArray[np.float64],
    loss: NDArray[np.float64],
    gain: NDArray[np.float64],
    Phi_b: NDArray[np.float64],
    functions: tuple[Any, ...],
) -> Scheme:
    """Pad and align; the compliance C is Phi_b diag(gain[0]) Phi_b^T."""
    C = (Phi_b * gain[0]) @ Phi_b.T
    of_modes = _padded(a), _padded(b), padded_rows(loss), padded_rows(gain)
    return Scheme(*of_modes, _padded(Phi_b), _padded(C), *functions)


def at_rest(scheme: Scheme) -> Motion:
    """A blade that stands still, unloaded."""
    rows, n = scheme.Phi.shape
    x, y, u = (zeros((TURNS, size)) for size in (n, n, rows))
    moved, force, free, came = (np.zeros(rows) for _ in range(4))
    return Motion(x, y, u, moved, force, zeros((n,)), free, came)


def rows_of(*rows: NDArray[np.float64]) -> NDArray[np.float64]:
    """Interface rows of the modes: radial, tangential, lean; those that are modelled.

    All but the last are padded to LANES.
    """
    *others, last = (of for of in rows if len(of))
    return np.concatenate([*map(padded, others), last]) if others else last


def padded(rows: NDArray[np.float64]) -> NDArray[np.float64]:
    """Rows, and as many zeros as make them a multiple of LANES."""
    return np.concatenate([rows, np.zeros((-len(rows) % LANES, *rows.shape[1:]))])


def padded_rows(Phi: NDArray[np.float64]) -> NDArray[np.float64]:
    """Rows (k, n) padded along the modes alone."""
    return _padded(Phi)[: len(Phi)]


def _padded(a: NDArray[np.float64]) -> NDArray[np.float64]:
    padded = zeros(tuple(length + -length % LANES for length in a.shape))
    padded[tuple(slice(length) for length in a.shape)] = a
    return padded


def zeros(shape: tuple[int, ...]) -> NDArray[np.float64]:
    """Zeros that begin on a cache line: vectors across two lines cost the run a tenth."""
    size = int(np.prod(shape))
    room = np.zeros(size + LANES)
    first = -room.ctypes.data % (8 * LANES) // 8
    return room[first : first + size].reshape(shape)


@compiled_sums
def predict(scheme, x, y, now, last, before):
    """Free motion to turn ``now``; returns the damping loss of a free step, J."""
    lost = 0.0
    for k in range(x.shape[1]):
        lost += scheme.advance(scheme, x, y, k, now, last, before)
    return lost


@compiled_sums
def interface(Phi, x, u, now):
    """U = Phi_b q, m, in turn ``now``; LANES rows share each load of a mode."""
    for i in range(0, Phi.shape[0], LANES):
        u0 = u1 = u2 = u3 = u4 = u5 = u6 = u7 = 0.0
        for k in range(x.shape[1]):
            q = x[now, k]
            u0 += Phi[i, k] * q
            u1 += Phi[i + 1, k] * q
            u2 += Phi[i + 2, k] * q
            u3 += Phi[i + 3, k] * q
            u4 += Phi[i + 4, k] * q
            u5 += Phi[i + 5, k] * q
            u6 += Phi[i + 6, k] * q
            u7 += Phi[i + 7, k] * q
        u[now, i], u[now, i + 1], u[now, i + 2], u[now, i + 3] = u0, u1, u2, u3
        u[now, i + 4], u[now, i + 5], u[now, i + 6], u[now, i + 7] = u4, u5, u6, u7


@compiled_sums
def modal_force(Phi, force, modal):
    """Phi_b^T force into ``modal`` (n,), N.

    Rows go by fours: neighbours touch together, and the others cost no pass.
    """
    filled = False
    for i in range(0, force.size, 4):
        f0, f1, f2, f3 = force[i], force[i + 1], force[i + 2], force[i + 3]
        if f0 == 0.0 and f1 == 0.0 and f2 == 0.0 and f3 == 0.0:
            continue
        if filled:
            for k in range(modal.size):
                modal[k] += (
                    Phi[i, k] * f0 + Phi[i + 1, k] * f1 + Phi[i + 2, k] * f2 + Phi[i + 3, k] * f3
                )
        else:
            filled = True
            for k in range(modal.size):
                modal[k] = (
                    Phi[i, k] * f0 + Phi[i + 1, k] * f1 + Phi[i + 2, k] * f2 + Phi[i + 3, k] * f3
                )


@compiled_sums
def observe(Phi, x, now, u):
    """Phi q, m, of the rows ``Phi`` (places, n) in turn ``now``, into ``u`` (places,)."""
    for i in range(Phi.shape[0]):
        total = 0.0
        for k in range(x.shape[1]):
            total += Phi[i, k] * x[now, k]
        u[i] = total
