"""Map over step and stiffness: steps at which central differences become unstable or inaccurate.

Rows are those of workflow/experiments/stability.yaml.

Engaged: an elastic liner with all strips always in contact. The step map is linear; its spectral
radius predicts the step that is unstable, the bound of ``marching.stability`` lies below it, and
runs of the compiled kernel, also with steps that are refused in scenes, give the step that fails.

Intermittent: errors of a plastic liner over the step, in both schemes, for which there is no
theory.
"""

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from simulate.contact.compiled import for_types_of
from simulate.contact.ramp import smooth
from simulate.errors.observables import error, observables
from simulate.errors.run import Run
from simulate.marching import Setup, central_difference, strip_stiffness
from simulate.marching.kernel import RUNNING, Recorded, at_start, march_round
from simulate.marching.modal import padded_rows
from simulate.scene import Scene
from workflow.many.engine import Marched
from workflow.study.trade import amplitude

SAMPLES = 64  # of a run
STEPS = 200_000  # of a run: growth by 1e-4 per step is detected
GROWN = 1e3  # times the disturbance
FORCE = 1.0  # N, on every strip at rest
DISTURBED = 1e-6  # disturbance over the penetration at rest


def errors(single: Run, reference: Marched | None) -> dict[str, float]:
    """Step and limit of central differences, s, and relative errors against the ``reference``.

    Errors are of the amplitude at xi = 1/16, and of the worn depth of all rods.
    """
    steps = {"h": single.setup.h, "limit": single.setup.limit}
    if reference is None:
        return steps
    true = reference.single
    return steps | {
        "amplitude": error(*(amplitude(observables(run)) for run in (single, true))),
        "wear": error(single.outcome.wear, true.outcome.wear),
    }


def engaged(scene: Scene, setup: Setup) -> dict[str, float]:
    """Limit, predicted unstable step and failing step, s, of an always engaged elastic liner."""
    xi, k = scene.damping_ratio, strip_stiffness(scene.liner, setup.places)
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
        "E": scene.liner.law.E,
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
