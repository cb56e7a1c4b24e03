"""One scene at one speed: set-up, checks, march."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rom.model import Rom
from simulate.central_difference import coefficients, march_kernel, modal_zeros
from simulate.contact import Strips, largest_over_window, rods_in_footprint
from simulate.plastic import Plastic
from simulate.scene import Liner, Scene
from simulate.stability import step_limit

MAX_STEPS = 10**9  # per round, minutes of march; more is a mistake


class SceneError(ValueError):
    """A scene that the reduced model or the scheme cannot serve: key, value, allowed range."""


@dataclass(frozen=True)
class Setup:
    """Everything one march needs."""

    Omega: float  # rad/s
    h: float  # s
    steps: int  # per round
    limit: float  # s, stability limit with contact
    omega: NDArray[np.float64]  # (n,), rad/s, natural frequencies at Omega
    Phi: NDArray[np.float64]  # (n, n), modes at Omega, M-normalised
    radial: NDArray[np.int64]  # (nodes,), DoFs of the radial displacements
    strips: Strips

    @property
    def Phi_b(self) -> NDArray[np.float64]:
        """Modes at the radial interface DoFs (nodes, n)."""
        return self.Phi[self.radial]


@dataclass(frozen=True)
class Outcome:
    """What one march gives."""

    status: str  # ok, liner-exhausted, unstable
    rounds: int  # rounds marched
    u_r: NDArray[np.float64]  # (kept rounds * samples, nodes), m: all for a history, else the last
    states: NDArray[np.float64]  # (kept rounds * samples, n), m: reduced displacements, the last
    wear: NDArray[np.float64]  # (nodes, nu), m, worn depth l eps_p
    force_peak: NDArray[np.float64]  # (rounds, nodes), N; nan where not marched, as u_r
    force_mean: NDArray[np.float64]  # (rounds, nodes), N
    contact_share: float  # steps with contact over all steps


def check_scene(scene: Scene, rom: Rom) -> None:
    """Everything that can be refused before a march, but for the step.

    Raises
    ------
    SceneError
        One line for each fault.
    """
    speeds = scene.speeds.omega(rom.f1)
    unit, scale = ("over_f1", 2 * np.pi * rom.f1) if scene.speeds.over_f1 else ("rad_s", 1.0)
    faults = []
    if speeds.max() > rom.Omega_m * (1 + 1e-12):
        faults.append(
            f"speeds.{unit}: {speeds.max() / scale:.6g}: allowed up to {rom.Omega_m / scale:.6g} "
            f"(Omega_m = {rom.Omega_m:.6g} rad/s)"
        )
    for node in scene.record.history.nodes if scene.record.history else []:
        if node > len(rom.points):
            faults.append(f"record.history.nodes: {node}: allowed 1 to {len(rom.points)}")
    if rods_in_footprint(scene.liner.footprint_m, rom.radius.min(), scene.liner.rods_per_round) < 1:
        least = int(np.ceil(np.pi * rom.radius.max() / scene.liner.footprint_m))
        faults.append(
            f"liner.rods_per_round: {scene.liner.rods_per_round}: the footprint holds less "
            f"than half a rod; allowed from {least}"
        )
    if scene.liner.footprint_m > 2 * np.pi * rom.radius.min():
        faults.append(
            f"liner.footprint_m: {scene.liner.footprint_m}: longer than the circumference; "
            f"allowed up to {2 * np.pi * rom.radius.min():.6g}"
        )
    if faults:
        raise SceneError("\n".join(faults))


def prepare(scene: Scene, rom: Rom, Omega: float) -> Setup:
    """Modes, step and liner at ``Omega`` (rad/s).

    Raises
    ------
    SceneError
        When the step is above the stability limit with contact, or rods would be jumped over.
    """
    omega, Phi = rom.modes(Omega)
    k_strip = strip_stiffness(scene.liner)
    limit = step_limit(omega, Phi[rom.radial], scene.damping_ratio, k_strip)
    steps = _steps_per_round(scene, Omega, limit)
    h = 2 * np.pi / Omega / steps
    return Setup(Omega, h, steps, limit, omega, Phi, rom.radial, _strips(scene, rom, steps))


def strip_stiffness(liner: Liner) -> float:
    """Stiffness of one strip engaged over its footprint, N/m: E w L / l."""
    return liner.E * liner.unit_Pa * liner.strip_width_m * liner.footprint_m / liner.thickness_m


class _Kept:
    """The last rounds of what the kernel fills anew in every round; nan where not marched."""

    def __init__(self, shape: tuple[int, ...], rounds: int, of: int) -> None:
        self.now = np.zeros(shape)
        self.rounds = np.full((rounds, *shape), np.nan)
        self._first = of - rounds

    def keep(self, done: int) -> None:
        """Keep what round ``done`` (from 0) has filled, if it is one of the last."""
        if done >= self._first:
            self.rounds[done - self._first] = self.now


def _buffers(scene: Scene, nodes: int, n: int) -> tuple[_Kept, _Kept, _Kept]:
    """What the kernel fills: u_r and forces of the nodes, modal displacements (padded n)."""
    record, rounds, samples = scene.record, scene.rounds, scene.record.samples_per_round
    of_u_r = rounds if record.history else record.spectrum_rounds or 0
    of_states = record.states_rounds or 0
    return (
        _Kept((samples, nodes), of_u_r, rounds),
        _Kept((2, nodes), rounds, rounds),
        _Kept((samples if of_states else 0, n), of_states, rounds),
    )


def march(scene: Scene, setup: Setup) -> Outcome:
    """March all rounds; stops where the liner is worn through or a displacement is not finite."""
    Phi_b, steps, strips = setup.Phi_b, setup.steps, setup.strips
    scheme = coefficients(setup.omega, Phi_b, scene.damping_ratio, setup.h)
    kernel = march_kernel(scene.record.contact_force, scene.record.states_rounds is not None)
    q, q_old = modal_zeros(scheme), modal_zeros(scheme)
    eps_p = np.zeros((len(Phi_b), strips.d.size))
    u_r, forces, states = kept = _buffers(scene, len(Phi_b), q.size)
    filled = [buffer.now for buffer in kept]
    status, contacts, done, ramp = "ok", 0, 0, scene.casing.ramp_rounds
    while done < scene.rounds and status == "ok":
        in_contact, deepest = kernel(scheme, strips, ramp, done, steps, q, q_old, eps_p, *filled)
        contacts += in_contact
        for buffer in kept:
            buffer.keep(done)
        done += 1
        status = _status(q, deepest, strips.thickness)
    return Outcome(
        status=status,
        rounds=done,
        u_r=u_r.rounds.reshape(-1, len(Phi_b)),
        states=states.rounds.reshape(-1, q.size)[:, : len(setup.Phi)] @ setup.Phi.T,
        wear=strips.thickness * eps_p,
        force_peak=forces.rounds[:, 0],
        force_mean=forces.rounds[:, 1] / steps,
        contact_share=contacts / (done * steps),
    )


def _status(q: NDArray[np.float64], deepest: float, thickness: float) -> str:
    """`liner-exhausted` where the tip has come through the liner to the rigid casing."""
    if not np.isfinite(q).all():
        return "unstable"
    return "liner-exhausted" if deepest >= thickness else "ok"


def _steps_per_round(scene: Scene, Omega: float, limit: float) -> int:
    """Steps per round, a multiple of the samples per round.

    Raises
    ------
    SceneError
        When the step is above the limit, no multiple, or too small to finish a round.
    """
    samples, given = scene.record.samples_per_round, scene.step.per_round
    if given is not None and given % samples:
        raise SceneError(
            f"step.per_round: {given}: allowed multiples of record.samples_per_round = {samples}"
        )
    round_time = 2 * np.pi / Omega
    least = _multiple(round_time / limit, samples)
    if given is not None and given < least:
        raise SceneError(
            f"step.per_round: {given}: the step of {round_time / given:.4g} s at {Omega:.6g} rad/s "
            f"is above the stability limit with contact of {limit:.4g} s; allowed from {least}"
        )
    steps = given or _multiple(round_time / (scene.step.fraction_of_limit * limit), samples)
    if steps > MAX_STEPS:
        raise SceneError(
            f"step: {steps:.3g} steps per round at {Omega:.6g} rad/s; allowed up to "
            f"{MAX_STEPS:.0e}: raise the speed or step.fraction_of_limit, or soften liner.E"
        )
    return int(steps)


def _multiple(steps: float, of: int) -> int:
    return int(np.ceil(steps / of)) * of


def _strips(scene: Scene, rom: Rom, steps: int) -> Strips:
    liner, nu = scene.liner, scene.liner.rods_per_round
    g0 = scene.clearance.gaps(len(rom.points), rom.span)
    d = scene.casing.inward(2 * np.pi * np.arange(nu) / nu, g0[0])
    m = rods_in_footprint(liner.footprint_m, float(rom.radius.mean()), nu)
    if m < nu / steps:
        raise SceneError(
            f"liner.footprint_m: {liner.footprint_m}: the blade advances further in one of "
            f"{steps} steps per round and would jump over rods; allowed from "
            f"{2 * np.pi * rom.radius.mean() / steps:.4g}, or take more steps"
        )
    return Strips(
        law=Plastic(
            liner.E * liner.unit_Pa, liner.K * liner.unit_Pa, liner.sigma_Y * liner.unit_Pa
        ),
        g0=g0,
        d=d,
        d_window=largest_over_window(d, m),
        first=(rom.theta * nu / (2 * np.pi) - m / 2 + 1) % nu,
        advance=nu / steps,
        m=m,
        area=liner.strip_width_m * liner.footprint_m / m,
        thickness=liner.thickness_m,
    )
