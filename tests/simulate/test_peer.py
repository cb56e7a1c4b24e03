"""Both schemes against an independent integrator, SciPy's DOP853, where the motion is smooth."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from systems import elastic_rod, march, march_exact, strips

OMEGA, XI = np.array([1.0, 7.0, 19.0]), 0.03
K, TIME = 40.0, 6.0
ONE, TWO = np.array([[0.6, -1.1, 0.8]]), np.array([[0.6, -1.1, 0.8], [0.5, 0.9, -0.2]])
SLIDING = 0.2, np.array([[-0.7, 0.4, 0.5], [-0.9, 0.1, 0.8]])  # friction, tangential rows
LEAN = np.array([[-0.3, 0.8, 0.5], [0.4, -0.6, 0.3]])  # edge ahead less edge behind, of TWO
CASES = {  # scheme, order, its tolerance, error over the depth, rows, depth, sliding
    "central-difference": (march, 1, 0.15, 5e-4, ONE, 0.5, None),
    "piecewise-exact": (march_exact, 2, 0.05, 1e-7, ONE, 0.5, None),
    "friction on two strips": (march_exact, 2, 0.1, 2.5e-7, TWO, 1e-3, SLIDING),
}


def reference(Phi_b, depth, sliding):
    """Displacements at the end: q'' + 2 xi w q' + w^2 q + Phi k (Phi q + a(t) d) = 0.

    With friction the first Phi, of the force, is that of radial and mu times the tangential rows.
    """
    mu, Phi_t = sliding or (0.0, 0.0)
    pushed = (Phi_b + mu * Phi_t).T

    def motion(t, state):
        q, v = state[:3], state[3:]
        x = min(t / TIME, 1.0)
        penetration = Phi_b @ q + x * x * (3 - 2 * x) * depth
        assert penetration.min() >= -1e-15  # else the motion is not smooth
        return np.r_[v, -2 * XI * OMEGA * v - OMEGA**2 * q - pushed @ (K * penetration)]

    end = solve_ivp(motion, (0, TIME), np.zeros(6), "DOP853", rtol=1e-12, atol=1e-14)
    return Phi_b @ end.y[:3, -1]


@pytest.mark.parametrize("case", CASES)
def test_schemes_converge_to_dop853_at_their_order(case):
    """Always engaged, so that only the scheme has an error.

    The casing comes in by ``depth`` over the ramp. Eq. (20) takes the force at the end of the step
    to come, and puts it at its start: order one. The mean force over the way, with the casing of
    the middle of the step, is of order two.
    """
    run, order, tolerance, least, Phi_b, depth, sliding = CASES[case]
    system = strips(elastic_rod(K).law, np.zeros(len(Phi_b)), np.full(4, depth))
    exact, more = reference(Phi_b, depth, sliding), {"sliding": sliding} if sliding else {}
    errors = []
    for steps in (600, 1200, 2400, 4800):
        u = run(
            system, OMEGA, Phi_b, XI, TIME / steps, steps, np.zeros(3), np.zeros(3),
            ramp_rounds=1.0, **more,
        ).u  # fmt: skip
        errors.append(abs(u[-1] - exact).max())
    finest = np.log2(errors[-2] / errors[-1])  # before, other orders are as large
    assert finest == pytest.approx(order, abs=tolerance), errors
    assert errors[-1] < least * depth
