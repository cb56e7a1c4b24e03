"""The default scheme on whole runs, against the peer in plain NumPy."""

import numpy as np
import peer
import pytest
from scenes import scene

from geometry.hats import middles
from simulate.run import march
from simulate.setup import prepare

EXACT = {"integrator": {"scheme": "piecewise-exact", "steps_per_round": 1024}}


@pytest.mark.parametrize(
    ("E", "strips", "over_f1", "rounds"),
    [(1.0, 8, 0.38, 6), (10.0, 8, 0.38, 3), (1.0, 16, 0.34, 3), (1.0, 3, 0.12, 2)],
    ids=["calm", "stiff", "near resonance, more strips than patches", "slow, few strips"],
)
def test_a_run_is_that_of_the_peer(coarse_rom, E, strips, over_f1, rounds):
    """Displacement and every rod's wear, over rounds in which round-off stays small."""
    case = scene(
        rounds=rounds,
        casing__ramp_rounds=1,
        liner__law__E=E,
        liner__law__K=0.45 * E,
        liner__strips=strips,
        record__history__chord=[float(xi) for xi in middles(strips)],
        **EXACT,
    )
    Omega = 2 * np.pi * coarse_rom.f1 * over_f1
    outcome = march(case, prepare(case, coarse_rom, Omega))
    own = peer.piecewise_exact(coarse_rom, case, Omega, 1024, 1024 * rounds)
    assert own.contacts > 0.01 * 1024 * rounds
    assert outcome.contact_share == own.contacts / (1024 * rounds)
    atol = 1e-9 * abs(own.u_r).max()
    np.testing.assert_allclose(outcome.u_r[-1, 1:], own.u_r, rtol=0, atol=atol)
    np.testing.assert_allclose(outcome.wear, own.wear, rtol=0, atol=1e-9 * own.wear.max())
