"""Steps a second: the modal kernel against dense marches of Eqs. (19)-(20), side by side.

The blade's reduced model has the paper's size (eta = 6: n = 86, 8 points); all three loops call the
same compiled contact function. They run in turn, so that a drift of the machine meets all alike;
the best turn of each counts.

    ./run pytest -n 0 tests/benchmarks
"""

from time import perf_counter

import numpy as np
import pytest
from dense import dense_matrices, march_dense, march_dense_compiled, under
from scenes import scene

from simulate import central_difference
from simulate.compiled import for_types_of
from simulate.kernel import Recorded, at_start, march_round
from simulate.modal import padded_rows
from simulate.places import force_weights
from simulate.ramp import smooth
from simulate.setup import prepare

TURNS = 8
DENSE_STEPS = 5_000  # the dense loops take the first steps of the round, where contact is, too


@pytest.fixture(scope="module", params=[1.3, 2.6], ids=["a fifth", "half"])
def setup(request, paper_reduced):
    """A round at 0.33 f1 over twelve bumps, in contact from the first step."""
    rom, _ = paper_reduced
    case = scene(
        casing={
            "ramp_rounds": 0,
            "harmonics": [{"order": 12, "amplitude_gaps": request.param}],
        },
        liner__rods_per_round=2048,
        rounds=1,
    )
    return rom, case, prepare(case, rom, 2 * np.pi * 0.33 * rom.f1)


def modal(setup, xi=0.005):
    """One round by the modal kernel: steps, steps with contact, displacement at the end."""
    scheme = central_difference.coefficients(setup.omega, setup.Phi_b, xi, setup.h)
    state, Phi_out = at_start(scheme, setup.strips), padded_rows(setup.Phi_out)
    weights = force_weights(setup.places.ends)
    samples, forces = np.zeros((64, len(Phi_out))), np.zeros((3, len(weights)))
    recorded = Recorded(samples, forces, np.zeros((0, 0)), Phi_out, weights)
    arguments = scheme, setup.strips, state, recorded, smooth(0.0), np.inf, 0, setup.steps
    contacts, *_ = for_types_of(march_round, *arguments)(*arguments)
    return setup.steps, contacts


def dense(loop, matrices, setup, steps):
    """The first ``steps`` steps of the round by a dense loop: steps, steps with contact."""
    n = len(matrices.now)
    eps_p = np.zeros((len(setup.Phi_b), len(setup.strips.d)))
    _, _, contacts = loop(
        matrices,
        setup.strips,
        under(setup.strips),
        0.0,
        0,
        steps,
        setup.steps,
        np.zeros(n),
        np.zeros(n),
        eps_p,
    )
    return steps, contacts


def test_modal_kernel_against_dense_loops(setup, benchmark, capsys):
    rom, case, prepared = setup
    matrices = dense_matrices(rom, prepared, case.damping_ratio)
    loops = {
        "modal kernel": lambda: modal(prepared),
        "compiled dense loop": lambda: dense(
            march_dense_compiled, matrices, prepared, 4 * DENSE_STEPS
        ),
        "numpy dense loop": lambda: dense(march_dense, matrices, prepared, DENSE_STEPS),
    }
    share = {name: np.divide(*reversed(loop())) for name, loop in loops.items()}  # compiles too
    best = dict.fromkeys(loops, 0.0)
    for _ in range(TURNS):
        for name, loop in loops.items():
            start = perf_counter()
            steps, _ = loop()
            best[name] = max(best[name], steps / (perf_counter() - start))
    benchmark.extra_info |= {name: f"{rate:.4g} steps/s" for name, rate in best.items()}
    benchmark(loops["modal kernel"])
    with capsys.disabled():
        print(f"\nn = {rom.n}, {len(prepared.Phi_b)} strips, {prepared.steps} steps per round")
        print(f"{'loop':<22}{'steps/s':>12}{'contact':>10}{'modal is':>12}")
        for name, rate in best.items():
            ratio = best["modal kernel"] / rate
            print(f"{name:<22}{rate:>12.3g}{share[name]:>10.0%}{ratio:>10.1f} x")
    # the loops compared are at the same work: contact on a fifth of the steps at least
    assert min(share.values()) > 0.2
