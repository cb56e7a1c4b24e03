"""CPU time to compile the march, as numba does and with inner functions linked only; laws by calls.

./run pytest -n 0 tests/benchmarks/test_compile.py
"""

from time import process_time

import numpy as np
import pytest
from scenes import scene

from simulate import kernel_file
from simulate.law import Law
from simulate.run import make_kernel, march
from simulate.setup import prepare

TURNS = 9
INTEGRATORS = {
    "central-difference": {"scheme": "central-difference", "fraction_of_limit": 0.8},
    "piecewise-exact": {"scheme": "piecewise-exact", "steps_per_round": 8192},
}


class Own(Law):
    """The plastic law of the scene, as a user writes it."""

    E: float
    K: float
    sigma_Y: float

    def stress(law, eps, eps_p):  # noqa: N805
        sigma = law.E * (eps - eps_p)
        if sigma <= 0.0:
            return 0.0, eps_p, 0.0
        f = sigma - (law.sigma_Y + law.K * eps_p)
        if f > 0.0:
            after = eps_p + f / (law.E + law.K)
            return law.sigma_Y + law.K * after, after, law.E * law.K / (law.E + law.K)
        return sigma, eps_p, law.E

    def plastic_work(law, before, after):  # noqa: N805
        return (after - before) * (law.sigma_Y + law.K * (before + after) / 2)


class Other(Own):
    """Another law."""

    def stress(law, eps, eps_p):  # noqa: N805
        sigma = law.E * (eps - eps_p)
        if sigma <= 0.0:
            return 0.0, eps_p, 0.0
        if sigma < law.sigma_Y:
            return sigma, eps_p, law.E
        return law.sigma_Y, eps - law.sigma_Y / law.E, 0.0

    def plastic_work(law, before, after):  # noqa: N805
        return law.sigma_Y * (after - before)


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
        return made, prepare(made, coarse_rom, 2 * np.pi * 0.33 * coarse_rom.f1)

    numbers = case()[0].liner.law.parameters._asdict()
    own, other = Own(**numbers), Other(**numbers)
    ready = {
        "shipped law": seconds(lambda: make_kernel(*case())),
        "own law, called": seconds(lambda: make_kernel(*case(liner__law=own))),
        "another, called": seconds(lambda: make_kernel(*case(liner__law=other))),
        "own law, in the march": seconds(
            lambda: make_kernel(*case(liner__law=own, liner__law_in_march=True))
        ),
    }
    runs = {"shipped": case(), "called": case(liner__law=own)}
    times = [{name: seconds(lambda run=run: march(*run)) for name, run in runs.items()}
             for _ in range(TURNS)]  # fmt: skip
    ratio = np.median([pair["called"] / pair["shipped"] for pair in times])
    with capsys.disabled():
        print(f"\n{scheme}: " + ", ".join(f"{of} {s:.2f} s" for of, s in ready.items()))
        print(f"march that calls its law: {ratio:.2f} of the time, median of {TURNS} pairs")
    assert ready["another, called"] < 2 < ready["shipped law"]
