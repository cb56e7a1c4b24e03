"""One scene at one speed: set-up, checks, march."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from geometry.errors import UserError
from rom.model import DIRECTIONS, Rom
from simulate import central_difference, piecewise_exact
from simulate.compiled import for_types_of
from simulate.ledger import CASING, DAMPING, PLASTIC, RELEASED, WORK, Ledger
from simulate.march import ENDED_NOT, WORN_THROUGH, Recorded, State, at_start, march_round
from simulate.modal import TURNS, padded, padded_rows, rows_of
from simulate.places import SHARES, Places, force_weights, places_of
from simulate.scene import LEADING, Liner, Scene
from simulate.stability import step_limit
from simulate.status import judge
from simulate.strips import (
    FLAT,
    Strips,
    Tip,
    largest_over_window,
    offset,
    rod_law,
    rods_in_footprint,
)

SCHEMES = {"central-difference": central_difference, "piecewise-exact": piecewise_exact}
LARGEST_DISPLACEMENT = 0.1  # of the span: beyond, no linear blade is a model of anything
LEAST_SCALED = 10  # times the first frequency: modes below keep their mass
MAX_STEPS = 10**9  # per round, minutes of march; more is a mistake


class SceneError(UserError):
    """A scene that the reduced model or the scheme cannot serve: key, value, allowed range."""


@dataclass(frozen=True)
class Setup:
    """Everything one march needs."""

    Omega: float  # rad/s
    h: float  # s
    steps: int  # per round
    limit: float  # s, stability limit of central differences with contact
    omega: NDArray[np.float64]  # (n,), rad/s, frequencies that are marched
    Phi: NDArray[np.float64]  # (n, n), modes that are marched
    Phi_b: NDArray[np.float64]  # (m, n), their radial displacements over the strips, P Phi
    Phi_t: NDArray[np.float64] | None  # (m, n), the tangential ones, where modelled
    Phi_out: NDArray[np.float64]  # (places, n), the radial ones where outputs are: xi = 1/16 first
    places: Places
    strips: Strips
    bound: float  # m, displacement beyond which a run has diverged


@dataclass(frozen=True)
class Outcome:
    """What one march gives."""

    status: str  # ok, inaccurate, diverged, unstable, liner-exhausted
    rounds: float  # rounds marched
    xi: float  # of a run that is not ok: chord fraction of the strip through which the tip came, or
    # else over which it was farthest out when the run ended; nan where it is ok
    theta: float  # rad, in the casing, of that place then, in [0, 2 pi); nan where it is ok
    ledger: Ledger
    u_r: NDArray[np.float64]  # (kept rounds * samples, places), m, of xi = 1/16 and the history's:
    # all rounds for a history, else the last
    states: NDArray[np.float64]  # (kept rounds * samples, n), m: reduced displacements, the last
    ends: NDArray[np.float64]  # (m + 1,), chord fractions: ends of the strips
    wear: NDArray[np.float64]  # (m, nu), m, worn depth l eps_p
    # of each eighth of the chord (SHARES), N; nan where not marched, as u_r
    force_peak: NDArray[np.float64]  # (rounds, shares)
    force_mean: NDArray[np.float64]  # (rounds, shares), over the steps marched of the round
    force_tangential_mean: NDArray[np.float64]  # (rounds, shares), against the rotation
    contact_share: float  # steps with contact over all steps


def check_scene(scene: Scene, rom: Rom) -> None:
    """Everything that can be refused before a march, but for the step.

    Raises
    ------
    SceneError
        One line for each fault.
    """
    if scene.accuracy is not None:
        raise SceneError("accuracy: no settings chosen yet: simulate.accuracy.choose does")
    speeds = scene.speeds.omega(rom.f1)
    unit, scale = ("over_f1", 2 * np.pi * rom.f1) if scene.speeds.over_f1 else ("rad_s", 1.0)
    faults = []
    if rom.provenance.blade != scene.blade:
        faults.append(
            f"blade: {scene.blade!r}: the reduced model is of blade {rom.provenance.blade!r}; take "
            f"rom-{scene.directions}.nc of this one: `./run snakemake results/{scene.blade}/"
            f"rom-{scene.directions}.nc`"
        )
    if speeds.max() > rom.Omega_m * (1 + 1e-12):
        faults.append(
            f"speeds.{unit}: {speeds.max() / scale:.6g}: allowed up to {rom.Omega_m / scale:.6g} "
            f"(Omega_m = {rom.Omega_m:.6g} rad/s)"
        )
    if scene.contact.tangential and DIRECTIONS["t"] not in rom.directions:
        faults.append(
            f"contact.tangential: true: the reduced model has no tangential interface DoFs; take "
            f"rom-{scene.directions}.nc: `./run snakemake results/{scene.blade}/"
            f"rom-{scene.directions}.nc`"
        )
    faults += _strips_unserved(scene, rom)
    gaps = scene.clearance.gaps([0, 1], rom.span)
    if gaps.min() < 0:
        faults.append(
            f"clearance: linear along the chord, it is {gaps.min():.3g} m at its "
            f"{'leading' if gaps[0] < 0 else 'trailing'} edge; allowed from 0: gaps at xi = 1/16 "
            f"and 15/16 may differ fifteenfold at most"
        )
    radius = rom.camber[:, 0]
    if rods_in_footprint(scene.liner.footprint_m, radius.min(), scene.liner.rods_per_round) < 0.5:
        least = int(np.ceil(np.pi * radius.max() / scene.liner.footprint_m))
        faults.append(
            f"liner.rods_per_round: {scene.liner.rods_per_round}: the footprint holds less "
            f"than half a rod; allowed from {least}"
        )
    faults += _edge_unseen(scene, rom)
    if scene.liner.footprint_m > 2 * np.pi * radius.min():
        faults.append(
            f"liner.footprint_m: {scene.liner.footprint_m}: longer than the circumference; "
            f"allowed up to {2 * np.pi * radius.min():.6g}"
        )
    if faults:
        raise SceneError("\n".join(faults))


def _strips_unserved(scene: Scene, rom: Rom) -> list[str]:
    """The fault of strips that the interface of the reduced model cannot tell apart."""
    liner, n = scene.liner, len(rom.xi)
    if rom.of_points and liner.m != n:
        return [
            f"liner.strips: {liner.m}: the interface of the reduced model is of {n} points, "
            f"with a strip each; allowed {n}"
        ]
    if liner.rigid_key and liner.m > n:
        return [
            f"liner.strips: {liner.m}: against a rigid casing ({liner.rigid_key}) the reactions "
            f"of more strips than the {n} patches of the reduced model are not unique; allowed up "
            f"to {n}, or raise interface.patches of the blade"
        ]
    return []


def _edge_unseen(scene: Scene, rom: Rom) -> list[str]:
    """The fault of rods over one of which the tip falls by more than the gap."""
    nu, gap = scene.liner.rods_per_round, least_gap(scene, rom)
    least = 2 * np.pi * rom.camber[:, 0].max() * edge_slope(scene) / gap if gap > 0 else 0.0
    if nu >= least:
        return []
    return [
        f"liner.rods_per_round: {nu}: over one rod the edge of the tip that rubs falls by more "
        f"than the gap; allowed from {np.ceil(least):.0f}"
    ]


def least_gap(scene: Scene, rom: Rom) -> float:
    """Least gap amid any strip, m."""
    return float(scene.clearance.gaps(places_of(rom, scene.liner.m).xi, rom.span).min())


def prepare(scene: Scene, rom: Rom, Omega: float, steps: int | None = None) -> Setup:
    """Modes, step and liner at ``Omega`` (rad/s).

    ``steps`` per round instead of the scene's: any, also past what a scene may ask for.

    Raises
    ------
    SceneError
        When the step is above the stability limit with contact, masses are scaled too low, or a
        rigid casing would begin inside the blade.
    """
    omega, Phi = _marched_modes(scene, *rom.modes(Omega))
    places = places_of(rom, scene.liner.m)
    Phi_b = rom.rows(places.xi) @ Phi
    Phi_t = rom.rows(places.xi, "t") @ Phi if scene.contact.tangential else None
    limit = _limit(scene, omega, rows_of(Phi_b, Phi_t), places)
    steps = steps or _steps_per_round(scene, Omega, limit)
    strips = strips_under(scene, rom, places, steps)
    _check_start(scene, strips)
    return Setup(
        Omega=Omega,
        h=2 * np.pi / Omega / steps,
        steps=steps,
        limit=limit,
        omega=omega,
        Phi=Phi,
        Phi_b=Phi_b,
        Phi_t=Phi_t,
        Phi_out=rom.rows(np.array([LEADING, *scene.record.chord])) @ Phi,
        places=places,
        strips=strips,
        bound=LARGEST_DISPLACEMENT * rom.span,
    )


def _marched_modes(
    scene: Scene, omega: NDArray[np.float64], Phi: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Frequencies and modes with the masses of the scene.

    A mode above the frequency asked for gets the mass that brings it there. Its stiffness stays,
    and with it the static compliance Phi omega^-2 Phi^T of the interface.
    """
    if scene.integrator.mass_scaling_hz is None:
        return omega, Phi
    highest = 2 * np.pi * scene.integrator.mass_scaling_hz
    least = LEAST_SCALED * omega[0]
    if highest < least:
        raise SceneError(
            f"integrator.mass_scaling_hz: {scene.integrator.mass_scaling_hz:g}: allowed from "
            f"{least / (2 * np.pi):.6g}, {LEAST_SCALED} times the first frequency"
        )
    scaled = np.minimum(omega, highest)
    return scaled, Phi * (scaled / omega)


def _limit(
    scene: Scene, omega: NDArray[np.float64], rows: NDArray[np.float64], places: Places
) -> float:
    """Stability limit of central differences with contact, s; 0 for a rigid law."""
    stiffness = strip_stiffness(scene.liner, places)
    if np.isinf(stiffness).any():
        return 0.0
    if scene.contact.tangential:  # along the normal (1, p'), at its steepest at the ends
        profile = scene.contact.profile
        steepest = abs(profile.tilt) + 4 * profile.edge_drop_m / scene.liner.footprint_m
        stiffness = np.concatenate([padded(stiffness), stiffness]) * (1 + steepest**2)
    return step_limit(omega, rows, scene.damping_ratio, stiffness)


def strip_stiffness(liner: Liner, places: Places) -> NDArray[np.float64]:
    """Stiffness (m,) of each strip engaged over its footprint, N/m: E w L / l."""
    return liner.law.modulus * places.width * liner.footprint_m / liner.thickness_m


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


def _buffers(scene: Scene, places: int, n: int) -> tuple[_Kept, _Kept, _Kept]:
    """What the kernel fills: u_r at places, forces on shares, modal displacements (padded n)."""
    record, rounds, samples = scene.record, scene.rounds, scene.record.samples_per_round
    of_u_r = rounds if record.history else record.spectrum_rounds or 0
    of_states = record.states_rounds or 0
    return (
        _Kept((samples, places), of_u_r, rounds),
        _Kept((3, SHARES if record.contact_force else 0), rounds, rounds),
        _Kept((samples if of_states else 0, n), of_states, rounds),
    )


def march(scene: Scene, setup: Setup) -> Outcome:
    """March all rounds; stops where the liner is worn through or the blade has left all bounds."""
    strips, steps, xi = setup.strips, setup.steps, scene.damping_ratio
    integrator = SCHEMES[scene.integrator.scheme]
    scheme = integrator.coefficients(setup.omega, rows_of(setup.Phi_b, setup.Phi_t), xi, setup.h)
    state, places = at_start(scheme, strips), len(setup.Phi_out)
    n = state.motion.x.shape[1]
    u_r, forces, states = kept = _buffers(scene, places, n)
    recorded = Recorded(
        *(buffer.now for buffer in kept),
        padded_rows(setup.Phi_out),
        force_weights(setup.places.ends)[: forces.now.shape[1]],
    )
    contacts, done, end = 0, 0, ENDED_NOT
    arguments = scheme, strips, state, recorded, scene.casing.ramp_rounds, setup.bound
    march_on = for_types_of(march_round, *arguments, done, steps)
    while done < scene.rounds and end == ENDED_NOT:
        for buffer in (u_r, states):
            buffer.now[:] = np.nan
        touched, step, end, node = march_on(*arguments, done, steps)
        contacts += touched
        forces.now[1:] /= step
        for buffer in kept:
            buffer.keep(done)
        done += 1
    marched = (done - 1) * steps + step
    ledger = _ledger(integrator, setup, xi, state, marched % TURNS)
    status = judge(end, ledger, int(state.solver.unsolved[0]))
    ended_ok = status == "ok"
    at = (np.nan, np.nan) if ended_ok else _place(setup, state, end, node, step, marched)
    return Outcome(
        status=status,
        rounds=marched / steps,
        xi=at[0],
        theta=at[1],
        ledger=ledger,
        u_r=u_r.rounds.reshape(-1, places),
        states=states.rounds.reshape(-1, n)[:, : len(setup.Phi)] @ setup.Phi.T,
        ends=setup.places.ends,
        wear=strips.thickness * state.eps_p,
        force_peak=forces.rounds[:, 0],
        force_mean=forces.rounds[:, 1],
        force_tangential_mean=forces.rounds[:, 2],
        contact_share=contacts / marched,
    )


def _place(
    setup: Setup, state: State, end: int, node: int, step: int, marched: int
) -> tuple[float, float]:
    """Chord fraction at which a run ended, and its angle in the casing, in [0, 2 pi) rad.

    That of strip ``node`` (from 0), where the tip came through the liner; else of the one over
    which it was farthest out.
    """
    if end != WORN_THROUGH:
        u_r = state.motion.u[marched % TURNS, : len(setup.Phi_b)]
        node = int(np.abs(u_r).argmax())  # a displacement that is no number counts as largest
    strips = setup.strips
    middle = strips.first[node] + step * strips.advance - offset(strips, 0, 0.0)
    return float(setup.places.xi[node]), 2 * np.pi * (middle / strips.d.size % 1)


def _ledger(scheme: Any, setup: Setup, xi: float, state: State, now: int) -> Ledger:
    energies, strips = state.energies, setup.strips
    return Ledger(
        casing=float(energies[CASING]),
        work=float(energies[WORK]),
        blade=scheme.energy(setup.omega, xi, setup.h, state.motion, now),
        damping=float(energies[DAMPING]),
        elastic=float(state.covered.strips.loaded @ strips.area * strips.thickness),
        plastic=float(energies[PLASTIC]),
        released=float(energies[RELEASED]),
    )


def _steps_per_round(scene: Scene, Omega: float, limit: float) -> int:
    """Steps per round, a multiple of the samples per round.

    Raises
    ------
    SceneError
        When the step is above the limit, no multiple, or too small to finish a round.
    """
    samples, given = scene.record.samples_per_round, scene.integrator.steps_per_round
    if given is not None and given % samples:
        raise SceneError(
            f"integrator.steps_per_round: {given}: allowed multiples of record.samples_per_round = "
            f"{samples}"
        )
    if scene.integrator.scheme == "piecewise-exact":
        return given
    round_time = 2 * np.pi / Omega
    least = _multiple(round_time / limit, samples)
    if given is not None and given < least:
        raise SceneError(
            f"integrator.steps_per_round: {given}: the step of {round_time / given:.4g} s at "
            f"{Omega:.6g} rad/s is above the stability limit with contact of {limit:.4g} s; "
            f"allowed from {least}, or any with scheme: piecewise-exact"
        )
    steps = given or _multiple(round_time / (scene.integrator.fraction_of_limit * limit), samples)
    if steps > MAX_STEPS:
        raise SceneError(
            f"integrator: {steps:.3g} steps per round at {Omega:.6g} rad/s; allowed up to "
            f"{MAX_STEPS:.0e}: take scheme: piecewise-exact, or raise the speed"
        )
    return int(steps)


def _multiple(steps: float, of: int) -> int:
    return int(np.ceil(steps / of)) * of


def strips_under(scene: Scene, rom: Rom, places: Places, steps: int) -> Strips:
    """Liner, casing, gaps and tip at ``places``, for so many steps per round."""
    liner, nu = scene.liner, scene.liner.rods_per_round
    gap = float(scene.clearance.gaps(LEADING, rom.span))
    d = scene.casing.inward(2 * np.pi * np.arange(nu) / nu, gap)
    passed = int(np.ceil(nu / steps))  # rods passed in a step
    radius = float(rom.camber[:, 0].mean())
    length = max(rods_in_footprint(liner.footprint_m, radius, nu), passed, 1.0)
    m = int(np.ceil(length))
    behind = passed if scene.contact.profile else 0
    return Strips(
        law=rod_law(type(liner.law), liner.law.parameters),
        g0=scene.clearance.gaps(places.xi, rom.span),
        d=d,
        d_window=np.roll(largest_over_window(d, min(m + behind + 3, nu)), 1),
        first=(places.theta * nu / (2 * np.pi) - behind - (m - 1) / 2) % nu,
        advance=nu / steps,
        length=length,
        m=m,
        behind=behind,
        area=places.width * liner.footprint_m / length,
        thickness=liner.thickness_m,
        pitch=2 * np.pi * places.radius / nu,
        tip=_tip(scene),
        touches=liner.law.touches,
        tangential=scene.contact.tangential,
        rigid_from=_rigid_from(liner),
    )


def _check_start(scene: Scene, strips: Strips) -> None:
    """Refuse a rigid casing that begins inside the blade.

    It would throw the blade out the harder the shorter the step.

    Raises
    ------
    SceneError
        When it does.
    """
    if scene.casing.ramp_rounds > 0 or np.isinf(strips.rigid_from):
        return
    d = strips.d_window[strips.first.astype(int)]
    if (d - strips.g0).max() > strips.rigid_from:
        raise SceneError(
            "casing.ramp_rounds: 0: the rigid casing would begin inside the blade; allowed above 0"
        )


def _tip(scene: Scene) -> Tip:
    profile, half = scene.contact.profile, scene.liner.footprint_m / 2
    if profile is None:
        return FLAT
    curvature = profile.edge_drop_m / half**2
    ends = half * np.sign(profile.tilt)
    apex = -np.clip(profile.tilt / (2 * curvature), -half, half) if curvature > 0 else -ends
    return Tip(profile.tilt, curvature, float(apex), half)


def edge_slope(scene: Scene) -> float:
    """Slope of the tip where it is closest to the casing: that of its edge, 0 of a round one."""
    tip = _tip(scene)
    return abs(tip.tilt + 2 * tip.curvature * tip.apex)


def _rigid_from(liner: Liner) -> float:
    """Penetration from which a rod gives no further, m."""
    if liner.law.rigid_from is not None:
        return liner.law.rigid_from * liner.thickness_m
    return liner.thickness_m if liner.worn_through == "casing" else np.inf
