"""What a sweep will cost is told within a second, whatever it asks for."""

from time import perf_counter, process_time

import pytest
from refused import refused
from runs import swept
from scenes import of_steps, scene

from geometry.base import WARNING
from simulate.sweeps.cost import START, cost
from simulate.sweeps.sweep import sweep


class Stopped(Exception):  # noqa: N818
    """Raised by a report to stop before the march."""


@pytest.mark.parametrize(
    ("verify", "times"), [({"predictable": True, "share": 0}, 2), ("every", 8)]
)
def test_steps_twins_and_half_steps_are_counted(coarse_rom, verify, times):
    speeds = {"over_f1": {"first": 0.2, "last": 0.38, "count": 10}}
    case = scene(integrator=of_steps(4096), speeds=speeds, rounds=20)
    found = cost(case, coarse_rom)
    assert (found.speeds, found.steps, found.all_steps) == (10, 4096, 10 * 20 * 4096)
    (line,) = found.lines(memory=16e9)
    assert line.startswith("10 speeds of 20 revolutions of 4096 steps: 8.2e+05")
    with_others = cost(case.but(verify=verify), coarse_rom)
    assert with_others.all_steps == times * found.all_steps
    assert with_others.seconds == pytest.approx(times * found.seconds)


def test_rounds_of_runs_that_may_end_before_are_the_most(coarse_rom):
    (line,) = cost(scene(rounds=20, until="steady", record__history=None), coarse_rom).lines(16e9)
    assert line.startswith("1 speeds of at most 20 revolutions")


def test_steps_of_central_differences_are_those_of_the_limit(coarse_rom):
    steps = swept(scene(), coarse_rom)["steps_per_round"].item()
    assert cost(scene(), coarse_rom).steps == steps


def test_a_scene_that_would_never_end_is_warned_of_within_a_second(coarse_rom):
    """A hundred thousand speeds, ten million rods, a billion steps a round."""
    case = scene(
        integrator=of_steps(10**9),
        speeds={"over_f1": {"first": 0.2, "last": 0.38, "count": 100_000}},
        liner__rods_per_round=10**7,
        rounds=100,
        record={"samples_per_round": 1_000_000, "spectrum_rounds": 10},
    )
    lines, start, times = [], perf_counter(), []

    def report(line):
        lines.append(line)
        times.append(perf_counter() - start)
        if len(lines) == 3:
            raise Stopped

    refused(Stopped, sweep, case, coarse_rom, report)
    assert times[0] < 5  # some 0.3 s on an idle machine
    assert "1e+16 steps" in lines[0] and "days on one core" in lines[0]
    assert all(line.startswith(WARNING) for line in lines[1:])
    assert "lower the number of speeds" in lines[1] and "memory" in lines[2]


def test_time_and_memory_are_of_the_right_size(coarse_rom):
    """Within a factor of five of the time that it takes on one core, and of what the file holds."""
    speeds = {"over_f1": {"first": 0.2, "last": 0.38, "count": 6}}
    rods = {"liner__rods_per_round": 2039}
    case = scene(integrator=of_steps(4096), speeds=speeds, rounds=20, **rods)
    swept(case.but(rounds=1, speeds={"over_f1": [0.2]}), coarse_rom)  # compiled
    start = process_time()
    runs = swept(case, coarse_rom)
    spent, found = process_time() - start, cost(case, coarse_rom)
    assert 0.2 < found.total / spent < 5
    assert 0.5 < (found.memory - START) / runs.nbytes < 10
