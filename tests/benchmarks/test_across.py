"""Time of a march with two rows across the thickness over that of one, side by side.

./run pytest -n 0 tests/benchmarks/test_across.py
"""

from dataclasses import replace
from time import perf_counter

from scenes import RUBBING, of_steps, scene

from fem.interface_operator import interface_of
from fem.solid import read_solid
from rom.reduce import reduce
from simulate.marching import march, prepare

TURNS = 8
SPEEDS = 0.2, 0.3, 0.34  # over f1(0)
MODELS = ((8, 1), (8, 2), (4, 2))  # strips, as many as patches; rows of each


def test_two_rows_against_twice_the_strips(
    coarse_blade, coarse_mesh, coarse_matrices, benchmark, capsys
):
    """Eight strips of one row against four of two, and eight of two."""
    solid, runs = read_solid(str(coarse_mesh.mesh), coarse_blade.material), {}
    for strips, across in MODELS:
        blade = coarse_blade.but(interface={"patches": strips, "across": across})
        of = vars(interface_of(solid, blade))
        rom, _ = reduce(replace(coarse_matrices, **of), blade.basis, "r")
        more = {"liner__strips": strips, "liner__footprint_mm": None, "rounds": 10}
        case = scene(**RUBBING | more, integrator=of_steps(4096), liner__rods_per_round=2039)
        runs[strips, across] = [(case, prepare(case, rom, of * rom.omega1)) for of in SPEEDS]
    best = dict.fromkeys(runs, float("inf"))
    for turn in range(1 + TURNS):  # the first compiles
        for model, marches in runs.items():
            start = perf_counter()
            for of_speed in marches:
                march(*of_speed)
            best[model] = min(best[model], perf_counter() - start) if turn else best[model]
    rates = {model: best[8, 1] / seconds for model, seconds in best.items()}
    benchmark.extra_info |= {f"{n} x {rows}": f"{rate:.3g}" for (n, rows), rate in rates.items()}
    benchmark(march, *runs[8, 2][-1])
    with capsys.disabled():
        print(*(f"\n{n} strips of {rows}: rate {rate:.2f}" for (n, rows), rate in rates.items()))
