"""Time that each feature of a scene adds to a run without it, for both schemes, in turn.

./run pytest -n 0 tests/benchmarks
"""

from time import process_time

import numpy as np
import pytest
from runs import set_up
from scenes import SCHEMES, of_steps, scene

from geometry.blade import EnrichedBasis
from rom.reduce import reduce
from simulate.errors.neighbours import judged
from simulate.errors.run import Case
from simulate.marching import march

TURNS = 12
INTEGRATORS = SCHEMES | {"piecewise-exact": of_steps(8192)}
BARE = {"samples_per_round": 64, "wear": False, "history": {"chord": [0.0625]}}
ROUNDED = {"contact": {"profile": {"edge_drop_um": 2}}}
HEAVY = {"frequency_Hz": 500.0, "modal_mass_kg": 1e9, "damping_ratio": 0.01}
VARIANTS = {
    "spectrum only": {"record": {"samples_per_round": 64, "wear": False, "spectrum_rounds": 2}},
    "wear only": {"record": {"samples_per_round": 64, "wear": True}},
    "finer samples (512)": {"record": BARE | {"samples_per_round": 512}},
    "contact force": {"record": BARE | {"contact_force": True}},
    "states, last round": {"record": BARE | {"states_rounds": 1}},
    "elastic law": {"liner__law": {"kind": "elastic", "E": 1.0, "unit_MPa": 2000}},
    "no contact": {"liner__law": {"kind": "none"}},
    "profile": ROUNDED,
    "tangential part": {"contact": ROUNDED["contact"] | {"tangential": True}},
    "friction": {"contact": {"friction": 0.1}},
    "travelling harmonic": {
        "casing__harmonics": [
            {"order": 2, "amplitude_gaps": 2.0},
            {"order": 1, "amplitude_gaps": 1e-3, "speed_rad_s": 100},
        ]
    },
    "ramp as a table": {
        "casing__ramp_rounds": None,
        "casing__ramp": {"rounds": [0, 0.1], "factor": [0, 1]},
    },
    "twice the rods": {"liner__rods_per_round": 4096},
    # too heavy to change the rub
    "casing of one pair": {"casing__modes": [HEAVY | {"order": 2}]},
    "casing of five pairs": {"casing__modes": [HEAVY | {"order": n} for n in (2, 3, 4, 5, 6)]},
    # eight runs are +700 %
    "eight blades": {"stage": {"count": 8}},
    "eight, casing of one pair": {
        "stage": {"count": 8},
        "casing__modes": [HEAVY | {"order": 2}],
    },
    "history, directions, force": {
        "record": BARE | {"history": {"chord": [0.0625], "directions": "rt", "force": True}}
    },
}
EXACT_ALONE = "friction", *(name for name in VARIANTS if "casing of" in name)


@pytest.fixture(scope="module")
def models(coarse_matrices):
    """The radial model, and that with tangential DoFs."""
    return {of: reduce(coarse_matrices, EnrichedBasis(), of)[0] for of in ("r", "rt")}


def case_of(scheme, **changes):
    values = {"rounds": 4, "liner__rods_per_round": 2048, "record": BARE} | changes
    return scene(integrator=INTEGRATORS[scheme], **values)


def best(runs):
    """Least CPU time of each, s, in turn; the first turn compiles."""
    least = dict.fromkeys(runs, np.inf)
    for turn in range(TURNS + 1):
        for name, run in runs.items():
            start = process_time()
            run()
            if turn:
                least[name] = min(least[name], process_time() - start)
    return least


@pytest.mark.parametrize("scheme", INTEGRATORS)
def test_the_cost_of_each_feature(scheme, models, capsys):
    def run_of(case):
        setup = set_up(case, models[case.directions], 0.33)
        return lambda: march(case, setup)

    bare = case_of(scheme)
    setup = set_up(bare, models["r"], 0.33)
    runs = {"bare": run_of(bare)}
    asked = [name for name in VARIANTS if name not in EXACT_ALONE or scheme == "piecewise-exact"]
    runs |= {name: run_of(case_of(scheme, **VARIANTS[name])) for name in asked}
    twins = Case(bare.but(verify={"predictable": True}), models["r"], setup)
    runs["twin"] = lambda: judged(twins.march())
    least = best(runs)
    outcome = march(bare, setup)
    with capsys.disabled():
        print(f"\n{scheme}, n = {models['r'].n}, {setup.steps} steps a round, 4 rounds, contact on")
        print(f"{outcome.contact_share:.0%} of the steps; bare run {1e3 * least['bare']:.1f} ms")
        for name, seconds in least.items():
            print(f"  {name:<28}{seconds / least['bare'] - 1:>+8.0%}")
    assert least["no contact"] < least["bare"] < least["twin"]
