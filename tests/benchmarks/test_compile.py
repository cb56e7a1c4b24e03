"""CPU time to compile the march, as numba does and with inner functions linked only; laws by calls.

./run pytest -n 0 tests/benchmarks/test_compile.py
"""

from time import process_time

import numpy as np
import pytest
from runs import set_up
from scenes import SCHEMES, of_steps, scene
from test_face import PerfectlyPlastic
from test_law_check import Hardening

from simulate.contact import kernel_file
from simulate.marching import make_kernel, march

TURNS = 9
INTEGRATORS = SCHEMES | {"piecewise-exact": of_steps(8192)}


def seconds(run):
    start = process_time()
    run()
    return process_time() - start


@pytest.mark.parametrize("scheme", INTEGRATORS)
def test_laws_of_ones_own(scheme, coarse_rom, tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(kernel_file, "FOLDER", tmp_path)

    def case(**changes):
        made = scene(integrator=INTEGRATORS[scheme], rounds=4, liner__rods_per_round=2048)
        made = made.but(**changes)
        return made, set_up(made, coarse_rom, 0.33)

    E, K, sigma_Y = case()[0].liner.law.parameters
    own, other = Hardening(E=E, H=K, sigma_Y=sigma_Y), PerfectlyPlastic(E=E, sigma_Y=sigma_Y)
    ready = {
        "shipped law": seconds(lambda: make_kernel(*case())),
        "own law, called": seconds(lambda: make_kernel(*case(liner__law=own))),
        "another, called": seconds(lambda: make_kernel(*case(liner__law=other))),
    }
    runs = {"shipped": case(), "called": case(liner__law=own)}
    times = [{name: seconds(lambda run=run: march(*run)) for name, run in runs.items()}
             for _ in range(TURNS)]  # fmt: skip
    ratio = np.median([pair["called"] / pair["shipped"] for pair in times])
    with capsys.disabled():
        print(f"\n{scheme}: " + ", ".join(f"{of} {s:.2f} s" for of, s in ready.items()))
        print(f"march that calls its law: {ratio:.2f} of the time, median of {TURNS} pairs")
    assert ready["another, called"] < 2 < ready["shipped law"]
