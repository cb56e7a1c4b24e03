"""Engine orders that excite a blade, and energies that need sums by mode.

Of the order E with generalised forces P (n,), psi = E (Omega t + ahead) and W = E Omega,

    q'' + 2 zeta omega q' + omega^2 q = Re(P e^{i psi}) - Phi^T F

has without F the steady response Re(Q e^{i psi}), Q = P / (omega^2 - W^2 + 2 i zeta omega W). The
kernel marches x, what q is more than all of these, as a free blade with F alone. To its rows each
order adds Re(Phi_b Q e^{i psi}) by two columns, cos psi and -sin psi: free undamped modes of the
frequency W, on which no force acts.

Energies follow in closed form from sums over the steps in contact: by mode the work of F on x, and
of each order S = sum of f (e^{i psi_{n+1}} - e^{i psi_n}), f = Phi^T F. With J the integral of
x' e^{i psi},

    (-i W + 2 zeta omega + i omega^2 / W) J
        = - S / (i W) - [x' e^{i psi}] - omega^2 [x e^{i psi}] / (i W)

the order does the work Re(P J) on x, and damping takes 4 zeta omega Re(i W Q J) besides what it
takes from x and from the steady response alone. Negative damping gives what these sums take from
its modes.
"""

from dataclasses import dataclass, replace
from typing import Any, NamedTuple, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from geometry.base import RPM, Fault
from rom.crossings import crossing
from rom.model import Rom
from simulate.contact.compiled import compiled_sums
from simulate.contact.ledger import SUMS
from simulate.marching import piecewise_exact
from simulate.marching.modal import LANES, Motion, Scheme, zeros
from simulate.scene import LEADING
from simulate.scene.damping import AnyDamping, Ratios, ratios
from simulate.scene.force import EngineOrder, Force

NEAR = 1e-9  # relative distance of a frequency from an order at which it needs damping

type Moving = tuple[NDArray[np.float64], NDArray[np.float64]]  # modal displacements, velocities


class Summed(NamedTuple):
    """What is summed by mode, as the kernel reads it; behind the other sums of the run."""

    book: Any  # compiled: what is booked besides
    modes: int
    orders: int
    first: int  # column

    @property
    def size(self) -> int:
        """Number of sums."""
        return self.modes * (1 + 2 * self.orders)


@compiled_sums
def book(scheme, strips, state, step):
    """Sum the work of contact on each mode, and of each order the real and the imaginary S."""
    of, motion, sums = scheme.summed, state.motion, state.energies
    of.book(scheme, strips, state, step)
    x, now, last = motion.x, step.now, step.last
    for k in range(of.modes):
        sums[SUMS + k] -= motion.modal[k] * (x[now, k] - x[last, k])
    for column in range(2 * of.orders):
        at = of.first + column
        way = x[now, at] - x[last, at]
        if column % 2:  # - sin
            way = -way
        for k in range(of.modes):
            sums[SUMS + (1 + column) * of.modes + k] += motion.modal[k] * way


def summing(scheme: Scheme, modes: int, orders: int = 0, first: int = 0) -> Scheme:
    """``scheme``, of which sums by mode are kept; columns of its orders from ``first`` on."""
    return scheme._replace(book=book, summed=Summed(scheme.book, modes, orders, first))


@dataclass(frozen=True)
class Forced:
    """Engine orders on a blade, E of them."""

    order: NDArray[np.int64]  # (E,)
    P: NDArray[np.complex128]  # (E, n), N kg^-1/2, generalised forces
    Q: NDArray[np.complex128]  # (E, n), kg^1/2 m, steady response
    Omega: float  # rad/s
    steady: bool  # whether a run begins with it
    ahead: float = 0.0  # rad, of blade 0

    def of_blade(self, ahead: float, omega: NDArray[np.float64], zeta: Ratios) -> Self:
        """On a blade that is ``ahead`` by an angle, rad, of frequencies ``omega`` (n,), rad/s."""
        return replace(self, ahead=ahead, Q=_steady(self.P, self.order, self.Omega, omega, zeta))

    def phasors(self, rounds: ArrayLike) -> NDArray[np.complex128]:
        """e^{i psi} (..., E) after so many revolutions."""
        angle = 2 * np.pi * (np.asarray(rounds) % 1) + self.ahead
        return np.exp(1j * np.multiply.outer(angle, self.order))

    def response(self, rounds: ArrayLike) -> Moving:
        """Steady modal displacements and velocities (..., n) after so many revolutions."""
        at, rate = self.phasors(rounds), 1j * self.order * self.Omega
        return (at @ self.Q).real, ((rate * at) @ self.Q).real

    def beside(self, scheme: Scheme, first: int, h: float) -> Scheme:
        """``scheme`` with the columns of the orders from ``first`` on."""
        n, columns = self.Q.shape[1], np.arange(first, first + 2 * len(self.order))
        turn, U = np.repeat(self.order, 2) * self.Omega * h, scheme.Phi[:, :n] @ self.Q.T
        rows = np.stack([U.real, U.imag], axis=2).reshape(len(U), -1)

        def wider(of: NDArray[np.float64], values: Any = 0.0) -> NDArray[np.float64]:
            """Coefficients with those of the columns."""
            size = columns[-1] + 1
            made = zeros((*of.shape[:-1], int(size + -size % LANES)))
            made[..., : of.shape[-1]] = of
            made[..., columns] = values
            return made

        made = scheme._replace(
            a=wider(scheme.a, np.cos(turn)),
            b=wider(scheme.b, np.sin(turn)),
            loss=wider(scheme.loss),
            gain=wider(scheme.gain),
            Phi=wider(scheme.Phi, rows),
        )
        return summing(made, n, len(self.order), first)

    def turn(self, motion: Motion, row: int, first: int) -> None:
        """Set the columns, from ``first`` on, at the start of a revolution: they would drift."""
        at = self.phasors(0.0)
        columns = slice(first, first + 2 * len(at))
        motion.x[row, columns] = np.stack([at.real, -at.imag], axis=1).ravel()
        motion.y[row, columns] = np.stack([-at.imag, -at.real], axis=1).ravel()

    def start(
        self,
        motion: Motion,
        Phi: NDArray[np.float64],
        first: int,
        omega: NDArray[np.float64],
        zeta: Ratios,
    ) -> None:
        """Set a ``motion`` of rows ``Phi`` to the start: at rest, or in the steady response."""
        self.turn(motion, 0, first)
        if not self.steady:
            n, (q, v) = self.Q.shape[1], self.response(0.0)
            x, y = piecewise_exact.turns_of(omega, zeta, 0.0, -q, -v)
            motion.x[0, :n], motion.y[0, :n] = x[0], y[0]
        motion.u[0] = Phi @ motion.x[0]

    def work(
        self,
        sums: NDArray[np.float64],
        ends: tuple[Moving, Moving],
        rounds: tuple[float, float],
        omega: NDArray[np.float64],
        zeta: Ratios,
    ) -> tuple[float, NDArray[np.float64]]:
        """Work of the orders, J, and what damping takes of each mode (n,) more than from x alone.

        ``sums``: those of ``Summed`` by order; x and x' at both ``ends``, after so many ``rounds``.
        """
        iW, r = 1j * (self.order * self.Omega)[:, None], 2 * zeta * omega
        real, imaginary = sums.reshape(-1, 2, r.size).swapaxes(0, 1)
        S, ((x_0, v_0), (x, v)) = real + 1j * imaginary, ends
        e_0, e = (self.phasors(each)[:, None] for each in rounds)
        J = -S / iW - (v * e - v_0 * e_0) - omega**2 * (x * e - x_0 * e_0) / iW
        J /= -iW + r - omega**2 / iW
        V, time = iW * self.Q, 2 * np.pi * (rounds[1] - rounds[0]) / self.Omega
        by_force, by_damping = (self.P * J).real.sum(), 2 * r * (V * J).real.sum(axis=0)
        for a in range(len(V)):
            for b in range(len(V)):
                plus, minus = iW[a] + iW[b], iW[a] - iW[b]
                both = (e[a] * e[b] - e_0[a] * e_0[b]) / plus
                apart = (e[a] * e[b].conj() - e_0[a] * e_0[b].conj()) / minus if a != b else time
                by_force += (
                    V[a] * self.P[b] * both + V[a] * self.P[b].conj() * apart
                ).real.sum() / 2
                by_damping += r * (V[a] * V[b] * both + V[a] * V[b].conj() * apart).real / 2
        return float(by_force), by_damping


def forced(force: Force, rom: Rom, damping: AnyDamping, Omega: float) -> Forced:
    """The ``force`` on a blade at ``Omega``, rad/s."""
    omega, Phi = rom.modes(Omega)
    family, inward = rom.families(Omega), rom.rows(np.array([LEADING]))[0] @ Phi < 0
    order = np.array(force.numbers)
    P = np.stack([_generalised(one, rom, damping, Omega, family) for one in force.orders])
    P = np.where(inward, -P, P)  # u_r > 0 at xi = 1/16
    Q = _steady(P, order, Omega, omega, _ratios(damping, rom, Omega))
    return Forced(order, P, Q, Omega, force.from_ == "steady")


def _steady(
    P: NDArray[np.complex128],
    order: NDArray[np.int64],
    Omega: float,
    omega: NDArray[np.float64],
    zeta: Ratios,
) -> NDArray[np.complex128]:
    """Steady response (E, n) to forces P (E, n) of engine orders."""
    at = order[:, None] * Omega
    return P / (omega**2 - at**2 + 2j * zeta * omega * at)


def _generalised(
    one: EngineOrder, rom: Rom, damping: AnyDamping, Omega: float, family: NDArray[np.int64]
) -> NDArray[np.complex128]:
    """Generalised forces (n,) of an order, on modes of which u_r > 0 at xi = 1/16."""
    meets = rom.omega1 * crossing(rom, one.order) if one.needs_crossing else np.nan
    if one.modal_force is None:
        omega, Phi = rom.modes(meets)
        xi = np.broadcast_to(_ratios(damping, rom, meets), omega.shape)[0]
        u_r = abs(rom.rows(np.array([LEADING])) @ Phi[:, 0])[0]
        given = np.array([2 * xi * omega[0] ** 2 * (one.amplitude_um or 0.0) / 1e6 / u_r])
    else:
        given = np.array(one.modal_force)
    on_mode = np.where(family < len(given), given[np.minimum(family, len(given) - 1)], 0.0)
    growth = (Omega / meets) ** 2 if one.grows else 1.0
    return growth * on_mode * np.exp(1j * np.radians(one.phase_deg))


def _ratios(damping: AnyDamping, rom: Rom, Omega: float) -> Ratios:
    """Damping ratios of the modes at ``Omega``, rad/s."""
    return ratios(damping, rom.modes(Omega)[0], lambda: rom.families(Omega))


def force_faults(
    force: Force, rom: Rom, damping: AnyDamping, speeds: NDArray[np.float64]
) -> list[Fault]:
    """Faults of a ``force`` on a blade at ``speeds``, rad/s: none where it is known and finite."""
    found = []
    for i, one in enumerate(force.orders):
        key, meets = f"force.orders.{i}", crossing(rom, one.order)
        if one.needs_crossing and np.isnan(meets):
            what = "grows" if one.amplitude_um is None else "amplitude_um"
            found.append(
                Fault(
                    f"refers to the speed at which mode 1 meets EO {one.order}, which is above the "
                    f"highest of the model, {RPM * rom.Omega_m:.6g} rpm: give modal_force, fixed",
                    f"{key}.{what}",
                )
            )
        elif one.amplitude_um and not np.all(
            np.ravel(_ratios(damping, rom, meets * rom.omega1))[:1] > 0
        ):
            found.append(
                Fault(
                    "the response of mode 1 has no limit without damping above 0: give it, or "
                    "modal_force",
                    f"{key}.amplitude_um",
                    one.amplitude_um,
                )
            )
        if len(one.modal_force or ()) > rom.n:
            found.append(
                Fault(f"the model has {rom.n} modes", f"{key}.modal_force", allowed={"le": rom.n})
            )
        for Omega in speeds:
            omega, zeta = rom.modes(Omega)[0], _ratios(damping, rom, Omega)
            near = np.abs(omega - one.order * Omega) < NEAR * omega
            if (near & (np.broadcast_to(zeta, omega.shape) == 0)).any():
                found.append(
                    Fault(
                        f"0 of the mode that EO {one.order} meets at {RPM * Omega:.6g} rpm: its "
                        "response has no limit there; give another ratio, or another speed",
                        "damping_ratio",
                    )
                )
    return found
