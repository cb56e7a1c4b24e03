"""The default scheme on whole runs, against the peer in plain NumPy."""

import numpy as np
import peer
import pytest
from scenes import scene

from geometry.hats import middles
from simulate.run import march
from simulate.setup import prepare

CALM = {"E": 1.0, "strips": 8, "over_f1": 0.38, "rounds": 6, "rods": 512, "steps": 1024}
CASES = {
    "calm": CALM,
    "stiff": CALM | {"E": 10.0, "rounds": 3},
    "stiffer, mu to 0.27": CALM | {"E": 100.0, "rounds": 3},
    "near resonance, more strips than patches": CALM | {"strips": 16, "over_f1": 0.34, "rounds": 3},
    "slow, few strips": CALM | {"strips": 3, "over_f1": 0.12, "rounds": 2},
    "2.5 rods a step": CALM | {"E": 10.0, "over_f1": 0.34, "rounds": 3, "rods": 2560},
    "3.9 rods a step, of 5.7": CALM
    | {"rounds": 3, "rods": 1001, "steps": 256, "footprint_m": 2e-2},
    "3.9 rods a step, of 4": CALM | {"rounds": 3, "rods": 1001, "steps": 256},
}


@pytest.mark.parametrize("case", CASES)
def test_a_run_is_that_of_the_peer(coarse_rom, case):
    """Displacement and every rod's wear, over rounds in which round-off stays small."""
    numbers = CASES[case]
    E, strips, steps, rounds = (numbers[name] for name in ("E", "strips", "steps", "rounds"))
    case = scene(
        rounds=rounds,
        casing__ramp_rounds=1,
        liner__law__E=E,
        liner__law__K=0.45 * E,
        liner__strips=strips,
        liner__rods_per_round=numbers["rods"],
        liner__footprint_m=numbers.get("footprint_m", 5e-3),
        record__history__chord=[float(xi) for xi in middles(strips)],
        integrator={"scheme": "piecewise-exact", "steps_per_round": steps},
    )
    Omega = 2 * np.pi * coarse_rom.f1 * numbers["over_f1"]
    outcome = march(case, prepare(case, coarse_rom, Omega))
    own = peer.piecewise_exact(coarse_rom, case, Omega, steps, steps * rounds)
    assert own.contacts > 0.01 * steps * rounds
    assert outcome.contact_share == own.contacts / (steps * rounds)
    # measured 2e-13 and 7e-12
    atol = 1e-10 * abs(own.u_r).max()
    np.testing.assert_allclose(outcome.u_r[-1, 1:], own.u_r, rtol=0, atol=atol)
    np.testing.assert_allclose(outcome.wear, own.wear, rtol=0, atol=1e-10 * own.wear.max())
