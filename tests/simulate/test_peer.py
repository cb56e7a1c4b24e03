"""Both schemes against an independent integrator, SciPy's DOP853, where the motion is smooth."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from systems import elastic_rod, march, march_exact

OMEGA, PHI, XI = np.array([1.0, 7.0, 19.0]), np.array([0.6, -1.1, 0.8]), 0.03
K, DEPTH, TIME = 40.0, 0.5, 6.0  # always engaged: the casing comes in by 0.5 over the ramp


def reference():
    """Displacement at the end: q'' + 2 xi w q' + w^2 q + Phi k (Phi q + a(t) d) = 0."""

    def motion(t, state):
        q, v = state[:3], state[3:]
        x = min(t / TIME, 1.0)
        depth = PHI @ q + x * x * (3 - 2 * x) * DEPTH
        assert depth >= -1e-15  # else the motion is not smooth
        return np.r_[v, -2 * XI * OMEGA * v - OMEGA**2 * q - PHI * K * depth]

    end = solve_ivp(motion, (0, TIME), np.zeros(6), "DOP853", rtol=1e-12, atol=1e-14)
    return PHI @ end.y[:3, -1]


@pytest.mark.parametrize(
    ("run", "order", "least"),
    [(march, 1, 5e-4), (march_exact, 2, 1e-7)],
    ids=["central-difference", "piecewise-exact"],
)
def test_schemes_converge_to_dop853_at_their_order(run, order, least):
    """Always engaged, so that only the scheme has an error.

    Eq. (20) takes the force at the end of the step to come, and puts it at its start: order one.
    The mean force over the way, with the casing of the middle of the step, is of order two.
    """
    system = elastic_rod(K)._replace(d=np.full(4, DEPTH), d_window=np.full(4, DEPTH))
    sizes, errors = np.array([600, 1200, 2400, 4800]), []
    for steps in sizes:
        u = run(
            system, OMEGA, PHI[None], XI, TIME / steps, steps, np.zeros(3), np.zeros(3),
            ramp_rounds=1.0,
        ).u  # fmt: skip
        errors.append(abs(u[-1, 0] - reference()))
    finest = np.log2(errors[-2] / errors[-1])  # before, other orders are as large
    assert finest == pytest.approx(order, abs=0.15 if order == 1 else 0.05), errors
    assert errors[-1] < least * DEPTH
