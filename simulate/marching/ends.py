"""Ends of runs, from which others start: the blade's motion, the rods under its tip, the wear.

At the same speed a run goes on to the last bit as one that never stopped. At another speed the
blade keeps its displacement u = Phi q and velocity Phi q', on the modes of K(Omega) there.
"""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from simulate.marching.common_casing import Common
from simulate.marching.kernel import State
from simulate.marching.modal import TURNS
from simulate.marching.setup import SCHEMES, Setup

UNDER = ("at", "passed", "stored", "ramp", "low", "high")  # of ``rods.STRIP``
SOLVER = ("F", "moment", "reaction")  # of ``interface_force.AT_STRIP``


@dataclass(frozen=True)
class FinalState:
    """End of a run; modes and rows are padded as those of the kernel."""

    Omega: float  # rad/s
    h: float  # s
    rounds: int  # since the casing began to distort
    omega: NDArray[np.float64]  # (n,), rad/s
    zeta: NDArray[np.float64]  # (n,), damping ratios
    # (2, n), modal displacements and velocities of the steady response to forces, without which x
    # and y are
    steady: NDArray[np.float64]
    Phi: NDArray[np.float64]  # (n, n)
    x: NDArray[np.float64]  # (2, modes), modal displacements
    y: NDArray[np.float64]  # (2, modes), second phase-plane coordinates
    u: NDArray[np.float64]  # (2, rows), m, interface displacements
    moved: NDArray[np.float64]  # (rows,), m, displacement by the force of the last step
    eps_p: NDArray[np.float64]  # (strips, nu), plastic strains
    part: NDArray[np.float64]  # (strips, window), of each rod that the tip covers
    stored: NDArray[np.float64]  # (strips, window), J/m3, its elastic energy
    under: NDArray[np.float64]  # (UNDER, strips)
    solver: NDArray[np.float64]  # (SOLVER, strips)


@dataclass(frozen=True)
class Worn:
    """Liner at the end of a run, for a blade at rest."""

    eps_p: NDArray[np.float64]  # (strips, nu), plastic strains
    rounds: int = 0  # since the casing began to distort: it does so anew


@dataclass(frozen=True)
class EndOfStage:
    """End of a run of several blades, N of them, on a casing of c columns, padded."""

    blades: list[FinalState]  # over one liner
    casing_x: NDArray[np.float64]  # (2, c), coordinates of the casing
    casing_y: NDArray[np.float64]  # (2, c)
    pulled: NDArray[np.float64]  # (N, c), modal forces on it in the last step

    @property
    def rounds(self) -> int:
        """Revolutions since the casing began to distort."""
        return self.blades[0].rounds

    @property
    def eps_p(self) -> NDArray[np.float64]:
        """Plastic strains (strips, nu)."""
        return self.blades[0].eps_p


type AnyEnd = FinalState | EndOfStage | Worn


def rows_at(rounds: int, steps: int) -> list[int]:
    """Rows, of TURNS in a ring, of the last step and the one before after so many revolutions."""
    row = rounds * steps % TURNS
    return [row, (row - 1) % TURNS]


def final_state(state: State, setup: Setup, rounds: int) -> FinalState:
    """End of a run after ``rounds``, since the casing began to distort."""
    motion, covered, rows = state.motion, state.covered, rows_at(rounds, setup.steps)
    zeta, steady = _at_a_turn(setup)
    return FinalState(
        Omega=setup.Omega,
        h=setup.h,
        rounds=rounds,
        omega=setup.omega,
        zeta=zeta,
        steady=steady,
        Phi=setup.Phi,
        x=motion.x[rows],
        y=motion.y[rows],
        u=motion.u[rows],
        moved=motion.moved.copy(),
        eps_p=state.eps_p.copy(),
        part=covered.rods["part"].copy(),
        stored=covered.rods["stored"].copy(),
        under=np.array([covered.strips[name] for name in UNDER], float),
        solver=np.array([state.solver.strips[name] for name in SOLVER]),
    )


def _at_a_turn(setup: Setup) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Damping ratios (n,), and modal displacements and velocities (2, n) that forces alone cause.

    Between two revolutions.
    """
    n = setup.omega.size
    steady = np.stack(setup.forced.response(0.0)) if setup.forced else np.zeros((2, n))
    return np.full(n, setup.zeta), steady


def begin(state: State, start: FinalState | Worn, setup: Setup) -> None:
    """Put the end of a run into a ``state`` at rest."""
    state.eps_p[:] = start.eps_p
    if isinstance(start, Worn):
        return
    motion, rows, own = state.motion, rows_at(start.rounds, setup.steps), slice(setup.columns)
    zeta, steady = _at_a_turn(setup)
    same = ("omega", setup.omega), ("zeta", zeta), ("steady", steady)
    motion.x[rows, own], motion.y[rows, own] = start.x[:, own], start.y[:, own]
    if start.Omega == setup.Omega and all(
        np.array_equal(getattr(start, name), values) for name, values in same
    ):
        motion.u[rows] = start.u
    else:
        n, integrator = setup.omega.size, SCHEMES[setup.scheme]
        x, y = start.x[:, :n], start.y[:, :n]
        moves = integrator.motion_of(start.omega, start.zeta, start.h, x, y)
        q, v = (
            np.linalg.solve(setup.Phi, start.Phi @ (free + forced)) - of_force
            for free, forced, of_force in zip(moves, start.steady, steady, strict=True)
        )
        x, y = integrator.turns_of(setup.omega, zeta, setup.h, q, v)
        # those of the casing: in the frame of the middle of its last step, as many to a revolution
        motion.x[rows, :n], motion.y[rows, :n] = x, y
        if setup.forced:
            setup.forced.turn(motion, rows[0], setup.columns)
        motion.u[rows] = motion.x[rows] @ setup.blade.Phi.T
    motion.moved[:] = start.moved
    state.covered.rods["part"], state.covered.rods["stored"] = start.part, start.stored
    for name, values in zip(UNDER, start.under, strict=True):
        state.covered.strips[name] = values
    for name, values in zip(SOLVER, start.solver, strict=True):
        state.solver.strips[name] = values


def end_of_stage(blades: list[FinalState], common: Common, steps: int) -> EndOfStage:
    """End of a run of ``blades``, of ``steps`` per revolution, with that of their casing."""
    rows = rows_at(blades[0].rounds, steps)
    x, y = common.motion[:2] if common.motion else np.zeros((2, TURNS, 0))
    pulled = common.pulled if common.motion else np.zeros((len(blades), 0))
    of_one = [replace(blade, eps_p=blades[0].eps_p) for blade in blades]  # liner
    return EndOfStage(of_one, x[rows], y[rows], pulled.copy())


def begin_casing(common: Common, start: EndOfStage, steps: int) -> None:
    """Put the end of a run into a casing at rest."""
    if common.motion:
        rows = rows_at(start.rounds, steps)
        common.motion.x[rows], common.motion.y[rows] = start.casing_x, start.casing_y
        common.pulled[:] = start.pulled
