"""Map over step and stiffness: steps at which central differences become unstable or inaccurate.

Engaged: an elastic liner with all strips always in contact. The step map is linear; its spectral
radius predicts the step that is unstable, the bound of ``marching.stability`` lies below it, and
runs of the compiled kernel, also with steps that are refused in scenes, give the step that fails.

Intermittent: some rounds of the scene with its plastic liner, for which there is no theory: steps
at which the errors of wear and of amplitude reach 1 and 10 %, for both schemes.
"""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import brentq

from rom.model import Rom
from simulate.contact.compiled import for_types_of
from simulate.contact.ramp import smooth
from simulate.errors.neighbours import Case
from simulate.errors.observables import error, observables
from simulate.marching import Setup, central_difference, prepare, strip_stiffness
from simulate.marching.kernel import RUNNING, Recorded, at_start, march_round
from simulate.marching.modal import padded_rows
from simulate.scene import Record, Scene
from workflow.study.trade import amplitude

MODULI = np.logspace(-2, 3, 11)  # E of the engaged liner, in the scene's unit
PLASTIC_MODULI = np.logspace(-1, 2, 4)
SPEED = 0.33  # over f1(0)
ROUNDS = 12  # marched
SAMPLES = 64  # per round
RECORD = Record(samples_per_round=SAMPLES, spectrum_rounds=10)
STEPS = 200_000  # of an engaged run: growth by 1e-4 per step is detected
GROWN = 1e3  # times the disturbance
FORCE = 1.0  # N, on every strip at rest
DISTURBED = 1e-6  # disturbance over the penetration at rest
LEVELS = (0.01, 0.1)
FRACTIONS = (1.0, 0.7, 0.5, 0.35, 0.25, 0.15)  # of the limit
EXACT = [256 * 2**k for k in range(9)]  # steps per round
REFERENCE = 0.06  # fraction of the limit


def numbers(files: Any, scene: dict[str, Any]) -> dict[str, Any]:
    """Steps (s) over E: limits and failures of engaged runs, errors of intermittent ones.

    ``scene``: settings of a scene, marched on the reduced model ``files.rom``.
    """
    base, rom = Scene.model_validate(scene), Rom.load(files.rom)
    Omega = rom.omega1 * SPEED
    return {
        "speed_over_f1": SPEED,
        "engaged": [engaged(base, rom, Omega, E) for E in MODULI],
        "intermittent": [intermittent(base, rom, Omega, E) for E in PLASTIC_MODULI],
    }


def with_modulus(scene: Scene, E: float, integrator: dict[str, Any]) -> Scene:
    """The scene with another E, and K in the same ratio."""
    law = scene.liner.law
    return scene.but(
        liner__law__E=E,
        liner__law__K=law.K * E / law.E,
        integrator=integrator,
        twin=False,
        peaks=None,
        rounds=ROUNDS,
        record=RECORD,
    )


def engaged(scene: Scene, rom: Rom, Omega: float, E: float) -> dict[str, float]:
    """Limit, predicted unstable step and failing step of an always engaged elastic liner, s."""
    case = scene.but(
        liner__law={"kind": "elastic", "E": E, "unit_Pa": scene.liner.law.unit_Pa},
        integrator={"scheme": "central-difference", "fraction_of_limit": 1.0},
    )
    setup, xi = prepare(case, rom, Omega), scene.damping_ratio
    k = strip_stiffness(case.liner, setup.places)
    alone = 2 / setup.omega.max()  # limit of the free blade
    predicted = brentq(
        lambda h: spectral_radius(setup, xi, k, h) - (1 + 1e-9), setup.limit, 2 * alone, rtol=1e-6
    )
    low, high = setup.limit * 0.9, 2 * alone
    while high / low > 1.001:
        h = np.sqrt(low * high)
        low, high = (low, h) if fails(setup, xi, k, h) else (h, high)
    return {
        "E": float(E),
        "alone": alone,
        "limit": setup.limit,
        "predicted": float(predicted),
        "failed": float(high),
    }


def spectral_radius(setup: Setup, xi: float, k: NDArray[np.float64], h: float) -> float:
    """Spectral radius of the step map of central differences, all strips engaged; k (m,), N/m."""
    omega, Phi_b = setup.omega, setup.Phi_b
    s = 1 / h**2 + xi * omega / h
    B = np.eye(len(omega)) - (Phi_b / s).T @ (k[:, None] * Phi_b)
    step = np.block(
        [
            [B * ((2 / h**2 - omega**2) / s), -B * ((1 / h**2 - xi * omega / h) / s)],
            [np.eye(len(omega)), np.zeros((len(omega), len(omega)))],
        ]
    )
    return float(abs(np.linalg.eigvals(step)).max())


def fails(setup: Setup, xi: float, k: NDArray[np.float64], h: float) -> bool:
    """Whether a small disturbance of a blade at rest on the elastic liner grows."""
    Phi_b, (m, n) = setup.Phi_b, setup.Phi_b.shape
    rest = -(setup.omega**-2) * (Phi_b.T @ np.full(m, FORCE))
    pressed = FORCE / k
    scheme = central_difference.coefficients(setup.omega, Phi_b, xi, h)
    ahead = scheme.C[:m, :m].sum(axis=1) * FORCE  # of the prediction, where the force is taken
    strips = setup.strips._replace(
        g0=Phi_b @ rest + ahead - pressed,
        d=np.zeros_like(setup.strips.d),
        d_window=np.zeros_like(setup.strips.d),
        first=np.zeros(m),
        advance=0.0,  # the blade does not pass along the rods
    )
    state = at_start(scheme, strips)
    disturbance = np.linalg.pinv(Phi_b) @ (DISTURBED * pressed * np.cos(np.arange(m)))
    state.motion.x[0, :n] = state.motion.x[-1, :n] = rest + disturbance
    state.motion.u[:] = state.motion.x @ scheme.Phi.T
    samples = np.zeros((SAMPLES, m))
    recorded = Recorded(
        samples, np.zeros((3, 0)), np.zeros((0, 0)), padded_rows(Phi_b), np.zeros((0, m))
    )
    steps = STEPS // SAMPLES * SAMPLES
    arguments = scheme, strips, state, recorded, smooth(0.0), 1.0, 0, steps
    *_, end, _ = for_types_of(march_round, *arguments)(*arguments)
    grown = (abs(samples[-1] - Phi_b @ rest) > GROWN * DISTURBED * pressed).any()
    return bool(end != RUNNING or grown)


def intermittent(scene: Scene, rom: Rom, Omega: float, E: float) -> dict[str, Any]:
    """Steps (s) at which the errors of both schemes reach ``LEVELS``, for the plastic liner.

    Errors are of the amplitude at xi = 1/16, and of the worn depth of all rods.
    """

    def run(scheme: str, **step: float) -> tuple[Setup, dict[str, ArrayLike]]:
        case = with_modulus(scene, E, {"scheme": scheme, **step})
        setup = prepare(case, rom, Omega)
        done = Case(case, rom, setup).march()
        return setup, {"peak amplitude": amplitude(observables(done)), "wear": done.outcome.wear}

    central, exact = "central-difference", "piecewise-exact"
    setup, reference = run(central, fraction_of_limit=REFERENCE)
    row: dict[str, Any] = {"E": float(E), "limit": setup.limit}
    for scheme, runs in {
        central: [run(central, fraction_of_limit=part) for part in FRACTIONS],
        exact: [run(exact, steps_per_round=steps) for steps in EXACT],
    }.items():
        h = np.array([setup.h for setup, _ in runs])
        errors = {
            name: np.array([error(observed[name], true) for _, observed in runs])
            for name, true in reference.items()
        }
        row[scheme] = {
            name: {f"{level:g}": passes(h, of, level) for level in LEVELS}
            for name, of in errors.items()
        }
    return row


def passes(h: NDArray[np.float64], error: NDArray[np.float64], level: float) -> float | None:
    """Step at which the error reaches ``level``, interpolated; None if all or no runs meet it."""
    order = np.argsort(h)
    h, error = h[order], error[order]
    beyond = np.flatnonzero(error > level)
    if len(beyond) == 0 or beyond[0] == 0:
        return None
    around = slice(beyond[0] - 1, beyond[0] + 1)
    return float(np.exp(np.interp(np.log(level), np.log(error[around]), np.log(h[around]))))
