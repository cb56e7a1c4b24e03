"""A casing that moves under several blades: each step of all of them together.

The coordinates of the casing are those of ``moving_casing``, in the frame of blade 0. In the frame
of blade j, an angle theta_j ahead, a pair of n diameters is turned by n theta_j. A step begins with
the forces of all blades in the last step on the casing. Before a blade's own forces are found, its
old ones are taken off; found, they are put in their place. What a blade does not know of the step
is the change of the forces of the blades after it: an error of order two in h. (Blades that did not
know these forces at all would create energy of order one.)

Each blade has the columns of the casing beside its modes, as lent to it for the step. The casing's
own damping is booked once, with the forces of all.
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from simulate.contact.compiled import compiled, compiled_sums
from simulate.contact.ledger import DAMPING, SUMS
from simulate.marching import piecewise_exact
from simulate.marching.modal import Motion, Scheme, at_rest, padded_rows, predict
from simulate.marching.moving_casing import Moving, book


class Lent(NamedTuple):
    """Columns of the casing in the frame of the blade that marches, as its kernel reads them."""

    columns: tuple[int, int]  # first of them, and the one after the last
    rows: NDArray[np.float64]  # (c, rows), interface rows of each
    start: NDArray[np.float64]  # (c,), x at the start of the step
    x: NDArray[np.float64]  # (c,), at its end, with the forces of the other blades
    y: NDArray[np.float64]  # (c,), the same


class Common(NamedTuple):
    """The casing of all blades, c columns padded as modes, and its functions; N blades."""

    begin: Any  # compiled: free motion in a step
    lend: Any  # compiled: the columns as a blade meets them
    take: Any  # compiled: the forces of a blade
    end: Any  # compiled: motion under all forces
    record: Any  # compiled: its coordinates at a sample
    scheme: Any = None  # of its columns alone
    motion: Any = None
    lent: Any = None
    pulled: NDArray[np.float64] = np.zeros((0, 0))  # (N, c), modal forces by each, in its frame
    total: NDArray[np.float64] = np.zeros(0)  # (c,), of all, in that of blade 0
    pairs: NDArray[np.int64] = np.zeros(0, np.int64)  # first column of each pair
    cosine: NDArray[np.float64] = np.zeros((0, 0))  # (N, pairs), of n theta_j
    sine: NDArray[np.float64] = np.zeros((0, 0))  # (N, pairs)
    energies: NDArray[np.float64] = np.zeros(SUMS)  # its damping, J


@compiled
def stands(common, now, last, before):
    """A rigid casing."""


@compiled
def lends_nothing(common, j, now, last):
    """A rigid casing."""


@compiled
def takes_nothing(common, j, modal, loaded):
    """A rigid casing."""


@compiled
def records_nothing(common, now, into):
    """A rigid casing."""


RIGID = Common(stands, lends_nothing, takes_nothing, stands, records_nothing)


@compiled_sums
def step_begins(common, now, last, before):
    """Turn the casing to the frame of the step; its free motion, and the last forces of all."""
    scheme, motion = common.scheme, common.motion
    scheme.turn(scheme, motion, last)
    predict(scheme, motion.x, motion.y, now, last, before)
    common.total[:] = 0.0
    for j in range(common.pulled.shape[0]):
        add(common, j, 1.0)


@compiled
def add(common, j, sign):
    """Add the forces of blade ``j``, times ``sign``, to those of all."""
    pulled, total, pairs = common.pulled, common.total, common.pairs
    first = 0  # columns of order 0 lie between pairs
    for p in range(pairs.size + 1):
        k = pairs[p] if p < pairs.size else total.size
        while first < k:
            total[first] += sign * pulled[j, first]
            first += 1
        if p < pairs.size:
            c, s = sign * common.cosine[j, p], sign * common.sine[j, p]
            total[k] += c * pulled[j, k] - s * pulled[j, k + 1]
            total[k + 1] += s * pulled[j, k] + c * pulled[j, k + 1]
            first = k + 2


@compiled
def to_frame(common, j, of):
    """Turn the pairs of ``of`` (c,), in place, to the frame of blade ``j``."""
    for p in range(common.pairs.size):
        k, c, s = common.pairs[p], common.cosine[j, p], common.sine[j, p]
        of[k], of[k + 1] = c * of[k] + s * of[k + 1], c * of[k + 1] - s * of[k]


@compiled
def lend(common, j, now, last):
    """The columns as blade ``j`` meets them: without its own last forces, with those of others."""
    lent, x, y, gain = common.lent, common.motion.x, common.motion.y, common.scheme.gain
    add(common, j, -1.0)
    for k in range(lent.start.size):
        lent.start[k] = x[last, k]
        lent.x[k] = x[now, k] - gain[0, k] * common.total[k]
        lent.y[k] = y[now, k] - gain[1, k] * common.total[k]
    to_frame(common, j, lent.start)
    to_frame(common, j, lent.x)
    to_frame(common, j, lent.y)


@compiled
def take(common, j, modal, loaded):
    """The forces of blade ``j`` in the step, none where it is not ``loaded``."""
    first = common.lent.columns[0]
    for k in range(common.lent.start.size):
        common.pulled[j, k] = modal[first + k] if loaded else 0.0
    add(common, j, 1.0)


@compiled
def step_ends(common, now, last, before):
    """Motion of the casing under the forces of all, and its damping."""
    scheme, motion = common.scheme, common.motion
    common.energies[DAMPING] += scheme.correct(
        scheme, motion.x, motion.y, common.total, now, last, before
    )


@compiled
def record(common, now, into):
    """Coordinates of the casing, in the frame of blade 0, into a row of the record."""
    for k in range(into.size):
        into[k] = common.motion.x[now, k]


@compiled
def arrive(scheme, motion, last):
    """The columns at the start of a step, and what that displaces the rows of the blade by."""
    x, u, lent = motion.x, motion.u, scheme.turning
    motion.came[:] = 0.0
    for k in range(lent.start.size):
        column = lent.columns[0] + k
        way = lent.start[k] - x[last, column]
        x[last, column] = lent.start[k]
        for row in range(u.shape[1]):
            came = lent.rows[k, row] * way
            u[last, row] += came
            motion.came[row] += came


@compiled
def reach(scheme, motion, now):
    """The columns at the end of a step, without the forces of the blade."""
    lent = scheme.turning
    for k in range(lent.start.size):
        motion.x[now, lent.columns[0] + k] = lent.x[k]
        motion.y[now, lent.columns[0] + k] = lent.y[k]


def lending(scheme: Scheme, first: int, lent: Lent) -> Scheme:
    """``scheme`` of a blade, whose columns from ``first`` on are lent, and damped elsewhere."""
    loss = scheme.loss.copy()
    loss[:, first : lent.columns[1]] = 0.0
    return scheme._replace(loss=loss, turn=arrive, book=book, turning=lent, reach=reach)


def lent_columns(moving: Moving, scheme: Scheme, first: int) -> Lent:
    """Room for what is lent to the blades of a ``scheme``, whose columns begin at ``first``."""
    c = moving.order.size
    rows = np.ascontiguousarray(scheme.Phi.T[first : first + c])
    return Lent((first, first + c), rows, *np.zeros((3, c)))


def common_casing(
    moving: Moving, theta: NDArray[np.float64], lent: Lent, h: float, Omega: float
) -> Common:
    """The casing under blades at angles ``theta`` (N,), rad, at ``Omega``, rad/s; at rest."""
    if not moving.order.size:
        return RIGID
    columns = np.zeros((1, moving.order.size))
    scheme = piecewise_exact.coefficients(moving.omega, columns, moving.zeta, h)
    scheme = moving.turned(scheme, 0, Omega * h)
    motion: Motion = at_rest(scheme)
    pairs = np.flatnonzero(moving.twin) - 1
    angle = np.outer(theta, moving.order[pairs])
    return Common(
        *(step_begins, lend, take, step_ends, record),
        scheme=scheme,
        motion=motion,
        lent=lent,
        pulled=padded_rows(np.zeros((len(theta), moving.order.size))),
        total=motion.modal,
        pairs=pairs,
        cosine=np.cos(angle),
        sine=np.sin(angle),
        energies=np.zeros(SUMS),
    )
