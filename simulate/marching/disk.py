"""Several blades over one liner: a revolution of all of them.

A disk has the arrays of one blade with a leading axis, blade by blade; the plastic strains are of
the one liner. The kernel takes views of them in turn, over a leg of time so short that no two
blades touch the same rod in it: within a leg their order does not matter, and the result is that of
any shorter one. On a casing that moves a leg is a step (``common_casing``).
"""

from collections.abc import Sequence
from math import ceil
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from simulate.contact.compiled import FIRST, compiled, compiled_kernel
from simulate.contact.interface_force import Solver
from simulate.contact.rods import Covered
from simulate.contact.strips import Strips
from simulate.marching.common_casing import Common
from simulate.marching.friction import Sliding
from simulate.marching.kernel import (
    RUNNING,
    Recorded,
    State,
    march_sample,
    turns,
    under_load,
)
from simulate.marching.modal import TURNS, Motion, Scheme, zeros

# without a blade axis
OF_ALL = {"eps_p", "Phi", "mu", "soft", "turning"}


class Disk(NamedTuple):
    """N blades as the kernel reads them, of S schemes."""

    schemes: Scheme  # with a leading axis (S,); Phi is that of all
    which: NDArray[np.int64]  # (N,), scheme of each blade
    slides: Any  # compiled: ``Sliding`` of one of the schemes, or None
    rows: Any  # compiled: Phi of one of the schemes
    casing: Any  # compiled: distortion under a blade
    g0: NDArray[np.float64]  # (N, strips), m
    first: NDArray[np.float64]  # (N, strips), rods
    leg: int  # steps
    common: Common
    # (N, nu), m: ``d``, ``d_end`` and ``d_window`` of each, where they differ
    under: tuple[NDArray[np.float64], ...] = ()


class Turned(NamedTuple):
    """How far each blade came in a revolution, (N,) each: as of ``march_sample``."""

    contacts: NDArray[np.int64]
    number: NDArray[np.int64]
    end: NDArray[np.int64]
    strip: NDArray[np.int64]
    loaded: NDArray[np.bool_]

    @classmethod
    def room(cls, blades: int) -> "Turned":
        """For so many blades."""
        return cls(*np.zeros((4, blades), np.int64), loaded=np.zeros(blades, np.bool_))


@compiled
def does_not_slide(sliding, i):
    """A tip without friction."""
    return sliding


@compiled
def slides(sliding, i):
    """Friction of scheme ``i``."""
    return Sliding(sliding.mu, sliding.A[i], sliding.soft)


@compiled
def of_all_schemes(Phi, i):
    """Rows that are the same of all schemes; in a tuple, as compiled code returns arrays."""
    return (Phi,)


@compiled
def of_each_scheme(Phi, i):
    """Rows of scheme ``i``, with columns of a force to which each responds otherwise."""
    return (Phi[i],)


@compiled
def same_casing(of, disk, j):
    """The casing that all blades have."""
    return of.d, of.d_end, of.d_window


@compiled
def own_casing(of, disk, j):
    """That of blade ``j``, which an orbit of the rotor brings nearer."""
    return disk.under[0][j], disk.under[1][j], disk.under[2][j]


@compiled
def scheme_of(disk, j):
    """Scheme of blade ``j``."""
    of, i = disk.schemes, disk.which[j]
    return Scheme(
        of.a[i], of.b[i], of.loss[i], of.gain[i], disk.rows(of.Phi, i)[0], of.C[i], of.advance,
        of.correct, of.find_force, of.forces, disk.slides(of.sliding, i), of.turn, of.book,
        of.turning, of.reach, of.summed,
    )  # fmt: skip


@compiled
def strips_of(of, disk, j):
    """The strips under blade ``j``."""
    d, d_end, d_window = disk.casing(of, disk, j)
    return Strips(
        of.law, disk.g0[j], d, d_end, d_window, disk.first[j], of.advance, of.length,
        of.lengthened, of.rods_covered, of.inset, of.partly_covered, of.placed, of.w_end, of.area,
        of.thickness, of.pitch, of.tip, of.touches, of.tangential, of.rigid_depth, of.first_t,
        of.first_lean, of.lean, of.rows, of.waves,
    )  # fmt: skip


@compiled
def state_of(of, j):
    """State of blade ``j`` over the liner of all."""
    motion, solver, covered = of.motion, of.solver, of.covered
    return State(
        Motion(
            motion.x[j], motion.y[j], motion.u[j], motion.moved[j], motion.force[j],
            motion.modal[j], motion.free[j], motion.came[j],
        ),
        Covered(covered.rods[j], covered.strips[j], covered.lever[j]),
        Solver(
            solver.unknowns[j], solver.F[j], solver.slope[j], solver.arm[j], solver.turned[j],
            solver.trial[j], solver.change[j], solver.start[j], solver.strips[j], solver.C[j],
            solver.matrix[j], solver.unsolved[j],
        ),
        of.eps_p, of.energies[j], of.slowest[j],
    )  # fmt: skip


@compiled
def record_of(of, j):
    """Output buffers of blade ``j``; the casing's are filled by the casing of all."""
    samples, forces, states = of.samples[j], of.forces[j], of.states[j]
    casing, pushed = of.casing[:, :0], of.pushed[j]
    return Recorded(samples, forces, states, of.Phi, of.weights, casing, of.first, pushed)


@compiled_kernel
def march_disk(disk, strips, states, recorded, ramp, bound, done, steps, turned):
    """Compute one revolution of all blades, leg by leg; it ends where the first of them ends.

    Blades that have marched the leg before that one may have gone further, to the leg's end at
    most.

    Parameters
    ----------
    disk : Disk
    strips, states, recorded : those of one blade; ``states`` and ``recorded`` with a blade axis
    ramp, bound, done, steps : as of ``march_round``
    turned : Turned, how far each came
    """
    samples, common, blades = recorded.samples.shape[1], disk.common, disk.which.size
    every, round_turn, number, over = steps // samples, done * steps % TURNS, FIRST, False
    recorded.forces[:] = 0.0
    strips.waves.begin(strips, done * steps)
    for j in range(blades):
        turned.contacts[j] = turned.number[j] = 0
        turned.loaded[j] = under_load(state_of(states, j))
    while number < steps and not over:
        stop = min(number + disk.leg, steps)
        now, last, before = turns(round_turn, stop)
        common.begin(common, now, last, before)
        for j in range(blades):
            common.lend(common, j, now, last)
            state, of_blade = state_of(states, j), strips_of(strips, disk, j)
            at, end, strip, loaded = number, RUNNING, 0, turned.loaded[j]
            while at < stop and end == RUNNING:
                sample = at // every
                to = min((sample + 1) * every, stop)
                touched, at, loaded, end, strip = march_sample(
                    scheme_of(disk, j), of_blade, state, record_of(recorded, j), ramp, bound, done,
                    steps, round_turn, at, to, -1 if to % every else sample, loaded,
                )  # fmt: skip
                turned.contacts[j] += touched
            turned.number[j], turned.end[j], turned.strip[j] = at, end, strip
            turned.loaded[j] = loaded
            if end != RUNNING:  # for the others, too
                over, stop = True, at
            common.take(common, j, state.motion.modal, loaded)
        common.end(common, now, last, before)
        if stop % every == 0:
            common.record(common, now, recorded.casing[stop // every - 1])
        number = stop
    for j in range(blades):  # of several that end in a leg the first ends the run
        if over and turned.number[j] > number:
            turned.end[j] = RUNNING


def stacked(values: Sequence[Any], name: str = "") -> Any:
    """The named tuples of N blades as one, its arrays with a leading axis: but for ``OF_ALL``."""
    first, *_ = values
    if name in OF_ALL or not isinstance(first, tuple | np.ndarray):
        return first
    if isinstance(first, tuple):
        parts = zip(*values, strict=True)
        return type(first)(*map(stacked, parts, first._fields))  # pyright: ignore[reportAttributeAccessIssue]
    together = np.stack(values)
    if isinstance(first, np.recarray):
        return together.view(np.recarray)
    if together.dtype != np.float64:
        return together
    aligned = zeros(together.shape)
    aligned[:] = together
    return aligned


def of_blade(values: Any, j: int, name: str = "") -> Any:
    """The part of blade ``j`` of what ``stacked`` has put together: views."""
    if name in OF_ALL:
        return values
    if isinstance(values, tuple):
        parts = zip(values, values._fields, strict=True)  # pyright: ignore[reportAttributeAccessIssue]
        return type(values)(*(of_blade(part, j, field) for part, field in parts))
    return values[j]


def leg_of(strips: Strips, blades: int, steps: int, samples: int, most: float) -> int:
    """Steps of a leg: the longest in which no two blades touch a rod; 0 where one step is too long.

    Whole samples, or a part of one. ``most``: tangential displacement, m, that the tips may have.
    """
    window = strips.rods_covered + 1 + 2 * strips.partly_covered
    free = strips.d.size / blades - window - 1  # rods; 1: windows begin between two
    if blades == 1:
        return steps
    if free < strips.advance:
        return 0
    aside = 2 * ceil(most / strips.pitch.min()) if strips.tangential else 0
    longest, every = max(int((free - aside) / strips.advance), 1), steps // samples
    if longest >= every:
        return longest // every * every
    return max(part for part in range(1, longest + 1) if every % part == 0)
