"""Map over step and stiffness: steps at which central differences become unstable or inaccurate.

Engaged: an elastic liner with all strips always in contact. The step map is linear; its spectral
radius predicts the step that is unstable, the bound of ``marching.stability`` lies below it, and
runs of the compiled kernel, also with steps that are refused in scenes, give the step that fails.

Intermittent: ``steps``.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from rom.model import Rom
from simulate.contact.compiled import for_types_of
from simulate.contact.ramp import smooth
from simulate.marching import Setup, central_difference, prepare, strip_stiffness
from simulate.marching.kernel import RUNNING, Recorded, at_start, march_round
from simulate.marching.modal import padded_rows
from simulate.scene import Scene
from workflow.study.stability import steps

MODULI = np.logspace(-2, 3, 11)  # E of the engaged liner, in the scene's unit
SPEED = 0.33  # over f1(0)
SAMPLES = 64  # of a run
STEPS = 200_000  # of a run: growth by 1e-4 per step is detected
GROWN = 1e3  # times the disturbance
FORCE = 1.0  # N, on every strip at rest
DISTURBED = 1e-6  # disturbance over the penetration at rest


def numbers(files: Any, scene: dict[str, Any]) -> dict[str, Any]:
    """Steps (s) over E: limits and failures of engaged runs, errors of intermittent ones.

    ``scene``: settings of a scene, marched on the reduced model ``files.rom``.
    """
    base, rom = Scene.model_validate(scene), Rom.load(files.rom)
    case = base, rom, rom.omega1 * SPEED
    return {
        "speed_over_f1": SPEED,
        "engaged": [engaged(*case, E) for E in MODULI],
        "intermittent": [steps.intermittent(*case, E) for E in steps.MODULI],
    }


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
        lambda h: spectral_radius(h, setup.omega, setup.Phi_b, xi, k) - (1 + 1e-9),
        setup.limit,
        2 * alone,
        rtol=1e-6,
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


def spectral_radius(
    h: float,
    omega: NDArray[np.float64],
    Phi_b: NDArray[np.float64],
    xi: float,
    k: NDArray[np.float64],
) -> float:
    """Spectral radius of the map (q_n, q_{n-1}) -> (q_{n+1}, q_n), all strips of Phi_b engaged.

    Of central differences; k (m,), N/m.
    """
    n, s = len(omega), 1 / h**2 + xi * omega / h
    B = np.eye(n) - (Phi_b / s).T @ (k[:, None] * Phi_b)
    c1, c2 = (2 / h**2 - omega**2) / s, (1 / h**2 - xi * omega / h) / s
    step = np.block([[B * c1, -B * c2], [np.eye(n), np.zeros((n, n))]])
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
        samples, np.zeros((3, 0)), np.zeros((0, 0)), padded_rows(Phi_b), np.zeros((2, 0, m))
    )
    arguments = scheme, strips, state, recorded, smooth(0.0), 1.0, 0, STEPS
    *_, end, _ = for_types_of(march_round, *arguments)(*arguments)
    grown = (abs(samples[-1] - Phi_b @ rest) > GROWN * DISTURBED * pressed).any()
    return bool(end != RUNNING or grown)
