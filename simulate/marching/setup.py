"""Set-up of one run: its arrays and numbers, and refusals of its step."""

from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import partial
from math import ceil, radians
from typing import NamedTuple

import numpy as np
from numba.core import errors
from numpy.typing import NDArray

from geometry.base import Fault, UserError, known
from geometry.tip import EDGES, JUDGED
from rom.model import Rom
from rom.polynomial import evaluate
from simulate.contact.gaps import gaps_at, given_gaps, growth_fault, lean_of_gaps
from simulate.contact.law_check import compile_fault
from simulate.contact.places import (
    Places,
    closing_rows,
    strip_places,
    strip_xi,
)
from simulate.contact.ramp import Ramp, ramp_of
from simulate.contact.rod_law import RodLaw, rod_law
from simulate.contact.strips import Strips, Tip, largest_over_window
from simulate.contact.travelling import STANDING, Waves, waves
from simulate.marching import central_difference, piecewise_exact
from simulate.marching.common_casing import Lent, lending, lent_columns
from simulate.marching.disk import leg_of
from simulate.marching.forced import Forced, force_faults, forced, summing
from simulate.marching.friction import Modes, sliding, steps_with_one_solution
from simulate.marching.modal import LANES, Scheme, rows_of
from simulate.marching.moving_casing import Moving, moving_casing
from simulate.marching.piecewise_exact import gain, share_of_end
from simulate.marching.stability import step_limit
from simulate.scene import LEADING, Casing, Contact, Gaps, Liner, Profile, Scene, Stage
from simulate.scene.damping import Ratios, ratios
from simulate.scene.law import Law
from simulate.scene.laws import LAWS
from simulate.scene.scene import Integrator

SCHEMES = {"central-difference": central_difference, "piecewise-exact": piecewise_exact}
LARGEST_DISPLACEMENT = 0.1  # of the span: beyond this, linear elasticity no longer applies
INERTIA = 1 / 12  # of a footprint: the moment under a lean of 1, over the force under a w of 1
UNDER = ("d", "d_end", "d_window")  # distortion, of ``Strips``
MARGIN = 2  # rods on either side of the window, where the casing is met at the end of a step
MAX_STEPS = 10**9  # per revolution, minutes of computing


class SceneError(UserError):
    """A scene that does not fit the reduced model or the scheme: key, value, allowed range."""


@dataclass(frozen=True)
class Blades:
    """What differs from blade to blade of a stage of N."""

    longer: NDArray[np.float64]  # (N,), m, by which each is longer
    omega: NDArray[np.float64]  # (N, n), rad/s, natural frequencies
    schemes: list[Scheme]  # each once
    which: NDArray[np.int64]  # (N,), scheme of each
    leg: int  # steps, as of ``disk``
    lent: Lent  # columns of a casing that moves
    nearer: NDArray[np.float64]  # (N,), m, than the first by an orbit of the rotor


@dataclass(frozen=True)
class Setup:
    """Arrays and numbers of one run."""

    Omega: float  # rad/s
    h: float  # s
    steps: int  # per revolution
    limit: float  # s, stability limit of central differences with contact
    omega: NDArray[np.float64]  # (n,), rad/s, natural frequencies, with scaled masses
    Phi: NDArray[np.float64]  # (n, n), their modes
    Phi_b: NDArray[np.float64]  # (m, n), their u_r - s u_z over the strips, P Phi
    Phi_t: NDArray[np.float64]  # (m, n), the tangential ones; (0, n) for radial contact
    Phi_lean: NDArray[np.float64]  # (m, n), of the edge ahead less the edge behind; (0, n): of one
    # (outputs, n), u_r - s u_z at the edges, with a spectrum at all of ``JUDGED``; of the history
    Phi_out: NDArray[np.float64]
    edges: tuple[float, ...]  # xi of the first of them: 1/16; where the casing tapers 15/16 too
    Phi_timing: NDArray[np.float64]  # (2, n), u_t at both edges there; else (0, n)
    # (directions * places, n), displacements of a history in its directions; else (0, n)
    Phi_history: NDArray[np.float64]
    Phi_gauges: NDArray[np.float64]  # (2 gauges, n): strain along gauges, 1, then stress, Pa
    places: Places
    strips: Strips
    bound: float  # m, displacement beyond which a run has diverged
    zeta: Ratios  # damping ratio of its modes
    scheme: str  # key of ``SCHEMES``
    # the modes, with their interface rows, as the kernel reads them; those of the casing behind
    blade: Scheme
    moving: Moving  # modes of the casing; none if it is rigid
    ramp: Ramp
    law: Law
    forced: Forced | None = None  # engine orders beside the rub
    stage: Blades | None = None  # several blades, of which the above is one of no changes

    def of_blade(self, j: int) -> "Setup":
        """That of blade ``j`` of a stage."""
        stage, strips = known(self.stage, "stage"), self.strips
        nu, blades = strips.d.size, len(stage.which)
        strips = strips._replace(
            g0=strips.g0 - stage.longer[j], first=(strips.first + j * nu / blades) % nu
        )
        if stage.nearer.any():
            strips = strips._replace(
                **{name: getattr(strips, name) + stage.nearer[j] for name in UNDER}
            )
        scheme, forced = stage.schemes[stage.which[j]], self.forced
        if forced:
            forced = forced.of_blade(2 * np.pi * j / blades, stage.omega[j], self.zeta)
        return replace(
            self, strips=strips, omega=stage.omega[j], blade=scheme, forced=forced, stage=None
        )

    def damping_at(self, orders: NDArray[np.float64]) -> Ratios:
        """Damping ratio of the modes nearest to ``orders`` (k,), frequencies over Omega."""
        if np.ndim(self.zeta) == 0:
            return self.zeta
        apart = np.abs(self.omega / self.Omega - orders[:, None])
        return np.full(self.omega.size, self.zeta)[apart.argmin(axis=1)]

    @property
    def outputs(self) -> NDArray[np.float64]:
        """Rows of all outputs of the kernel (outputs, n)."""
        return np.vstack([self.Phi_out, self.Phi_timing, self.Phi_history])

    @property
    def columns(self) -> int:
        """Columns of the blade and of a casing that moves, behind which are those of forces."""
        return self.omega.size + self.moving.order.size

    @property
    def blades(self) -> list["Setup"]:
        """Those of all blades; of one without a stage itself."""
        if self.stage is None:
            return [self]
        return [self.of_blade(j) for j in range(len(self.stage.which))]


def least_gap(of: Gaps, rom: Rom, strips: int, speeds: Iterable[float]) -> float:
    """Smallest gap at the places of so many strips, m, over the ``speeds``, rad/s."""
    xi, at = strip_xi(rom, strips), speeds if of.vary else [0.0]
    return float(min(gaps_at(of, rom, xi, Omega).min() for Omega in at))


def prepare(scene: Scene, rom: Rom, Omega: float, steps: int | None = None) -> Setup:
    """Modes, step and liner at ``Omega`` (rad/s).

    ``steps`` per revolution replace those of the scene, and may exceed the limit of a scene.

    Raises
    ------
    SceneError
        When the step is above the stability limit with contact, or too long for friction, a gap at
        rest is less than the growth of the tip, or a rigid casing would overlap the blade at the
        start.
    """
    integrator, contact, gaps = scene.stepping, scene.contact, scene.gaps
    liner, casing = scene.liner, scene.casing
    omega, Phi = rom.modes(Omega)
    zeta = ratios(scene.damping_ratio, omega, partial(rom.families, Omega))
    places, leans = strip_places(rom, liner, casing), rom.across == 2
    stiffness = strip_stiffness(liner, places)
    Phi_b = closing_rows(rom, casing, places.xi) @ Phi
    Phi_t = rom.rows(places.xi, "t") @ Phi if contact.along else Phi[:0]
    Phi_lean = closing_rows(rom, casing, places.xi, leans) @ Phi if leans else Phi[:0]
    along = Phi_t if contact.tangential else Phi[:0]  # with friction as without
    shares = scene.stage.relative if scene.stage else np.zeros(1)
    fastest = (1 + shares.max()) * omega
    limit = _limit(stiffness, contact, zeta, fastest, (Phi_b, along, Phi_lean), places.footprint)
    steps = steps or _steps_per_round(integrator, scene.record.samples_per_round, Omega, limit)
    h = 2 * np.pi / Omega / steps
    moving = moving_casing(casing.moves, places, contact.along, leans)
    (closing, tangential, lean), marched, damped = moving.beside(
        (Phi_b, Phi_t, Phi_lean), omega, zeta
    )

    def own(share: float) -> NDArray[np.float64]:
        """Frequencies of a blade that differ by a ``share``, and those of the casing, rad/s."""
        return np.concatenate([(1 + share) * omega, marched[omega.size :]])

    if (mu := contact.friction) is not None:
        for share in {shares.min(), shares.max()}:
            modes = sliding_modes(own(share), closing, tangential, places)
            modes, of_rows = with_lean(modes, stiffness, lean)
            _require_one_solution(modes, mu, damped, h, steps, of_rows)
    pushed = _pushed(mu, closing, tangential, places)
    if leans:  # an edge moves by the lean, too
        pushed = pushed + INERTIA * lean**2
    compliance = np.maximum(pushed @ gain(marched, damped, h), 0)
    if faults := growth_fault(gaps, rom, places.xi, np.array([Omega])):
        raise SceneError(*faults)
    gap = float(given_gaps(gaps, rom, LEADING))
    closes, blades = np.zeros(1), scene.stage.count if scene.stage else 1
    if scene.unbalance:
        closes = scene.unbalance.closes(blades, Omega, rom.f1)
    of_force = None
    if scene.force:
        if faults := force_faults(scene.force, rom, scene.damping_ratio, np.array([Omega])):
            raise SceneError(*faults)
        of_force = forced(scene.force, rom, scene.damping_ratio, Omega)
    strips = strips_under(
        liner,
        distortion(casing, liner.nu, gap, h, closes[0]),
        contact,
        places,
        g0=gaps_at(gaps, rom, places.xi, Omega),
        lean=lean_of_gaps(gaps, rom, places.xi, Omega) if leans else None,
        steps=steps,
        w_end=share_of_end(compliance * stiffness)
        if integrator.scheme == "piecewise-exact"
        else None,
    )
    strips = strips._replace(waves=moving.under(strips.waves))
    _check_start(casing, strips)
    rows = rows_of(closing, tangential, lean)

    def scheme_at(share: float, lent: Lent | None = None) -> Scheme:
        """Scheme of a blade whose frequencies differ by a ``share``."""
        scheme = SCHEMES[integrator.scheme].coefficients(own(share), rows, damped, h)
        if lent is None:
            scheme = moving.turned(scheme, omega.size, Omega * h)
        elif moving.order.size:
            scheme = lending(scheme, omega.size, lent)
        if mu is not None:
            scheme = sliding(scheme, strips.first_t, mu * places.secant, stiffness)
        if of_force:
            of_blade = of_force.of_blade(0.0, own(share)[: omega.size], zeta)
            return of_blade.beside(scheme, len(marched), h)
        return summing(scheme, omega.size) if np.min(zeta) < 0 else scheme

    tapers = places.slope.any()
    edges = EDGES if tapers else EDGES[:1]
    judged = JUDGED if scene.record.spectrum_rounds else edges
    chord = scene.record.chord
    outputs = np.array([*judged, *chord])
    setup = Setup(
        Omega=Omega,
        h=h,
        steps=steps,
        limit=limit,
        omega=omega,
        Phi=Phi,
        Phi_b=Phi_b,
        Phi_t=Phi_t,
        Phi_lean=Phi_lean,
        Phi_out=closing_rows(rom, casing, outputs) @ Phi,
        edges=edges,
        Phi_timing=rom.timing_rows @ Phi if tapers else Phi[:0],
        Phi_history=np.vstack(
            [Phi[:0], *(rom.rows(np.array(chord), to) @ Phi for to in scene.record.directions)]
        ),
        Phi_gauges=evaluate(rom.gauge_rows, Omega)[..., 1:].reshape(-1, rom.n) @ Phi
        if rom.gauges and scene.record.gauges  # companions have none
        else Phi[:0],
        places=places,
        strips=strips,
        bound=LARGEST_DISPLACEMENT * rom.span,
        zeta=zeta,
        scheme=integrator.scheme,
        blade=scheme_at(0.0),
        moving=moving,
        ramp=ramp_of(casing),
        law=liner.law,
        forced=of_force,
    )
    if scene.stage is None:
        return setup
    return _with_stage(
        setup, scene.stage, casing, gap, scene.record.samples_per_round, scheme_at, closes
    )


def _with_stage(
    setup: Setup,
    stage: Stage,
    casing: Casing,
    gap: float,
    samples: int,
    scheme_at: Callable[[float, Lent], Scheme],
    closes: NDArray[np.float64],
) -> Setup:
    """The ``setup`` of one blade with what differs from blade to blade of a ``stage``.

    ``gap`` at xi = 1/16, m; ``samples`` per revolution; ``scheme_at``: by share of the frequencies
    and columns lent; ``closes`` (N,), m: what an orbit takes from the gap of each.

    Raises
    ------
    SceneError
        When one is longer than its gap, or two touch the same rods in one step.
    """
    strips, steps = setup.strips, setup.steps
    if faults := longer_fault(longer := stage.longer(gap), float(strips.g0.min())):
        raise SceneError(*faults)
    if not (leg := leg_of(strips, stage.count, steps, samples, setup.bound)):
        raise SceneError(
            f"two of them are over the same rods in one step, of {strips.d.size} around the "
            "casing: allowed are fewer, or more steps per revolution and rods",
            key="stage.count",
            value=stage.count,
        )
    shares, which = np.unique(stage.relative, return_inverse=True)
    lent = lent_columns(setup.moving, setup.blade, setup.omega.size)
    made = replace(
        setup,
        stage=Blades(
            longer=longer,
            omega=(1 + stage.relative)[:, None] * setup.omega,
            schemes=[scheme_at(float(share), lent) for share in shares],
            which=which,
            leg=1 if setup.moving.order.size else leg,
            lent=lent,
            nearer=closes - closes[0],
        ),
    )
    for blade in made.blades:
        _check_start(casing, blade.strips)
    return made


def longer_fault(longer: NDArray[np.float64], gap: float) -> list[Fault]:
    """The fault of a blade that is ``longer`` (N,), m, than the least ``gap``, m; or none."""
    j = int(longer.argmax())
    if longer[j] <= gap:
        return []
    return [
        Fault(
            f"blade {j} is longer by {1e6 * longer[j]:.4g} um, the smallest gap is "
            f"{1e6 * gap:.4g} um: contact before the casing distorts; allowed up to that",
            "stage.longer_um",
            allowed={"le": 1e6 * gap},
        )
    ]


def sliding_modes(
    omega: NDArray[np.float64],
    Phi_b: NDArray[np.float64],
    Phi_t: NDArray[np.float64],
    places: Places,
) -> Modes:
    """The modes with tangential displacements (m, n) times t_N over the generalised force.

    With them mu times the generalised force does the work of friction, mu t_N.
    """
    return omega, Phi_b, places.secant[:, None] * Phi_t


def with_lean(
    modes: Modes, stiffness: NDArray[np.float64], Phi_lean: NDArray[np.float64]
) -> tuple[Modes, NDArray[np.float64]]:
    """Modes and stiffness (rows,) of strips that slide with the rows of their lean, if any."""
    omega, closing, along = modes
    rows = omega, np.vstack([closing, Phi_lean]), np.vstack([along, 0 * Phi_lean])
    return rows, np.concatenate([stiffness, INERTIA * stiffness[: len(Phi_lean)]])


def _pushed(
    mu: float | None, Phi_b: NDArray[np.float64], Phi_t: NDArray[np.float64], places: Places
) -> NDArray[np.float64]:
    """Closing displacements (m, n) over the strips times those along the force on each.

    Where friction makes the compliance in a step negative, its share of the end is 0: at the end
    alone, a force that pulls would feed the motion.
    """
    if mu is None:
        return Phi_b**2
    return Phi_b * (Phi_b + mu * places.secant[:, None] * Phi_t)


def _limit(
    stiffness: NDArray[np.float64],
    contact: Contact,
    zeta: Ratios,
    omega: NDArray[np.float64],
    rows: tuple[NDArray[np.float64], ...],
    footprint: NDArray[np.float64],
) -> float:
    """Stability limit of central differences with contact, s; 0 for a rigid law.

    ``stiffness`` of each strip (strips,), N/m, and its ``footprint``, m; ``rows``: radial,
    tangential and lean ones, those that are modelled.
    """
    if np.isinf(stiffness).any():
        return 0.0
    if contact.tangential:  # along the normal (1, p'), steepest at the ends of the profile
        profile = known(contact.profile, "contact.profile")
        steepest = abs(profile.tilt) + 4 * profile.edge_drop_m / footprint
        stiffness = stiffness * (1 + steepest**2)
    of_rows = [
        factor * stiffness for factor, of in zip((1.0, 1.0, INERTIA), rows, strict=True) if len(of)
    ]
    return step_limit(omega, rows_of(*rows), zeta, rows_of(*of_rows))


def _require_one_solution(
    modes: Modes,
    mu: float,
    zeta: Ratios,
    h: float,
    steps: int,
    stiffness: NDArray[np.float64],
) -> None:
    """Refuse a step in which the forces of a sliding tip are not unique.

    Raises
    ------
    SceneError
        When they are not.
    """
    shorter = steps_with_one_solution(modes, mu, zeta, h, stiffness)
    if shorter != 1:
        instead = f"allowed {shorter * steps} or" if shorter else "allowed is"
        raise SceneError(
            f"at {2 * np.pi / h / steps:.6g} rad/s friction of {mu:g} leaves the contact forces of "
            f"a step not unique; {instead} a smaller contact.friction",
            key="integrator.steps_per_round",
            value=steps,
            allowed=shorter * steps or None,
        )


def strip_stiffness(liner: Liner, places: Places) -> NDArray[np.float64]:
    """Stiffness (m,) of each strip engaged over its footprint, N/m: E w L / l."""
    return liner.law.modulus * places.width * places.footprint / liner.thickness_m


def _steps_per_round(integrator: Integrator, samples: int, Omega: float, limit: float) -> int:
    """Steps per revolution of a scene's ``integrator``, a multiple of ``samples``.

    Raises
    ------
    SceneError
        When the step is above the limit, or the steps are too many.
    """
    if integrator.scheme == "piecewise-exact":
        return integrator.steps_per_round
    given, round_time = integrator.steps_per_round, 2 * np.pi / Omega
    least = _multiple(round_time / limit, samples)
    if given is not None and given < least:
        raise SceneError(
            f"the step of {round_time / given:.4g} s at {Omega:.6g} rad/s is above the stability "
            f"limit with contact of {limit:.4g} s; allowed from {least}, or any with scheme: "
            "piecewise-exact",
            key="integrator.steps_per_round",
            value=given,
            allowed={"ge": least},
        )
    steps = given or _multiple(
        round_time / (known(integrator.fraction_of_limit, "fraction_of_limit") * limit), samples
    )
    if steps > MAX_STEPS:
        raise SceneError(
            f"{steps:.3g} steps per revolution at {Omega:.6g} rad/s; allowed up to "
            f"{MAX_STEPS:.0e}: take scheme: piecewise-exact, or raise the speed",
            key="integrator",
        )
    return int(steps)


def _multiple(steps: float, unit: int) -> int:
    return int(np.ceil(steps / unit)) * unit


class Distortion(NamedTuple):
    """Casing at the rods (nu,), m, inward, at its largest."""

    d: NDArray[np.float64]  # in the first step
    fixed: NDArray[np.float64]  # of it what does not travel
    waves: Waves  # harmonics that travel


def distortion(casing: Casing, nu: int, gap: float, h: float, closes: float = 0.0) -> Distortion:
    """Distortion at ``nu`` rods, over the ``gap`` (m) at xi = 1/16, in steps of ``h``, s.

    ``closes``: by how much the casing is nearer all around, m.
    """
    theta = 2 * np.pi * np.arange(nu) / nu
    d = casing.inward(theta, gap) + closes
    if not casing.travelling:
        return Distortion(d, d, STANDING)
    fixed = casing.fixed(theta, gap) + closes
    moving = [
        (
            casing.scale * harmonic.size(gap),
            harmonic.order,
            radians(harmonic.phase_deg),
            harmonic.turn(h),
        )
        for harmonic in casing.travelling
    ]
    return Distortion(d, fixed, waves(fixed, np.array(moving, float)))


def strips_under(
    liner: Liner,
    casing: Distortion,
    contact: Contact,
    places: Places,
    *,
    g0: NDArray[np.float64],
    lean: NDArray[np.float64] | None,
    steps: int,
    w_end: NDArray[np.float64] | None,
) -> Strips:
    """Liner, casing, gaps and tip at ``places``, for ``steps`` per revolution.

    ``g0``: gaps (strips,), m; ``lean``: gaps ahead less gaps behind, None for one row across;
    ``w_end`` (strips,): weight of the end of the step, None in central differences.

    A strip's window is in rods, its middle the tip's at the middle of a step (at the end of one in
    central differences). ``d_window`` at ``first`` is the largest d from margin to margin::

                      first                middle
        .  .  .  .  .  [  .  .  (  .  .  .  .  x  .  .  .  .  )  .  .  ]  .  .  .  .  .
        margin         | partly |     footprint, m rods     | partly |         margin
                         passed                                passed
                        in a step                             in a step
    """
    nu, strips = liner.nu, len(places.xi)
    passed = nu / steps  # rods, in a step
    length = np.maximum(places.rods, max(np.ceil(passed), 1))
    m = int(np.ceil(length.max()))
    partly_covered = min(max(ceil((passed - 1) / 2), 0), max(nu - m, 0) // 2)
    placed, w_end = (1.0, np.ones(strips)) if w_end is None else (0.5, w_end)
    blocks = strips + -strips % LANES
    middle = places.theta * nu / (2 * np.pi) - (1 - placed) * nu / steps
    backing = liner.thickness_m if liner.worn_through == "casing" else np.inf
    # a rigid casing is met at the end of a step
    margin = MARGIN if liner.rigid_key or casing.waves is not STANDING else 1
    return Strips(
        law=_rod_law(liner),
        g0=g0,
        d=casing.d,
        d_end=casing.d.copy(),
        d_window=_deepest(casing.fixed, m, partly_covered, margin),
        first=(middle - partly_covered - (m - 1) / 2) % nu,
        advance=passed,
        length=length,
        lengthened=length / places.rods,
        rods_covered=m,
        inset=(m - np.ceil(length).astype(int)) // 2,
        partly_covered=partly_covered,
        placed=placed,
        w_end=w_end,
        area=places.width * places.footprint / length,
        thickness=liner.thickness_m,
        pitch=2 * np.pi * places.radius / nu,
        tip=_tip(contact.profile, places.footprint),
        touches=liner.law.touches,
        tangential=contact.along,
        rigid_depth=backing if liner.law.deforms else 0.0,
        first_t=blocks,
        first_lean=blocks * (1 + contact.along),
        lean=np.zeros(strips) if lean is None else lean,
        rows=(0.0,) * (1 if lean is None else 2),
        waves=casing.waves,
    )


def _deepest(
    d: NDArray[np.float64], m: int, partly_covered: int, margin: int
) -> NDArray[np.float64]:
    """Largest d over the window from each rod on, and over ``margin`` rods on its either side."""
    m_window = m + 1 + 2 * (partly_covered + margin)  # 1: it may begin between two rods
    return np.roll(largest_over_window(d, min(m_window, len(d))), margin)


def _check_start(casing: Casing, strips: Strips) -> None:
    """Refuse a rigid casing that overlaps the blade at the start.

    The overlap would be removed within one step: the impulse grows with 1/h.

    Raises
    ------
    SceneError
        When they overlap.
    """
    share = casing.at_start
    if share == 0 or np.isinf(strips.rigid_depth):
        return
    deepest = _deepest(strips.d, strips.rods_covered, strips.partly_covered, MARGIN)
    d = deepest[strips.first.astype(int) % len(deepest)]  # a remainder by nu may be nu
    if (share * d - strips.g0).max() > strips.rigid_depth:
        ramp = (f"ramp.factor: {share:g}", "0 at revolution 0")
        key, least = ramp if casing.ramp else ("ramp_rounds: 0", "above 0")
        raise SceneError(
            f"the rigid casing would overlap the blade at the start; allowed {least}",
            key=f"casing.{key}",
        )


def _tip(profile: Profile | None, footprint: NDArray[np.float64]) -> Tip:
    """Profile over each ``footprint`` (m,), m."""
    if profile is None:
        return Tip(0.0, *np.zeros((3, len(footprint))))
    half = footprint / 2
    curvature = profile.edge_drop_m / half**2
    if profile.edge_drop_m > 0:
        apex = -np.clip(profile.tilt / (2 * curvature), -half, half)
    else:
        apex = -half * np.sign(profile.tilt)
    return Tip(profile.tilt, curvature, apex, half)


def edge_slope(profile: Profile | None, footprint: float) -> float:
    """Slope of the tip where it is closest to the casing: 0 unless that is an edge."""
    tip = _tip(profile, np.array([footprint]))
    return float(abs(tip.tilt + 2 * tip.curvature * tip.apex)[0])


def _rod_law(liner: Liner) -> RodLaw:
    """Law of the rods: a user's own, whose parameters are numbers, is called through pointers."""
    law, parameters = liner.law, liner.law.parameters
    numbers = len(parameters) > 0 and all(isinstance(value, int | float) for value in parameters)
    called = numbers and not isinstance(law, LAWS)
    with compiling(law):
        return rod_law(type(law), parameters, called)


@contextmanager
def compiling(law: Law) -> Iterator[None]:
    """In the block, report the fault of a user's own law that cannot be compiled.

    Raises
    ------
    SceneError
        In place of numba's error.
    """
    try:
        yield
    except errors.NumbaError as error:
        if isinstance(law, LAWS):
            raise
        raise SceneError(compile_fault(law, error)) from None
