"""Numbers of long times, on prescribed sweeps."""

import pytest

from tests.workflow.test_long_times_figure import sweep
from workflow.paper import long


def test_amplitudes_over_the_rounds_and_on_ways_through_the_peak():
    runs = [sweep([0.1, 2.0, 0.3], 0.5, rounds=20), sweep([0.1, 2.5, 0.0], 0.9, rounds=180)]
    found = long.numbers(runs, {"run_up": sweep([0.1, 4.5, 4.0], [0.5, 0.6, 2.0])})
    assert found["rounds"] == [20, 200] and found["speeds"] == [0.3, 0.35, 0.4]
    assert found["amplitude"][1] == pytest.approx([0.1, 2.5, 0.0])
    assert found["wear"][1] == pytest.approx([0.9] * 3)
    way = {"largest": 4.5, "at": 0.35, "at_highest": 4.0, "deepest_wear": 2.0}
    assert found["through"]["run_up"] == pytest.approx(way)
    text = long.table(found)
    assert "| after 200 rounds | 0.10 | 2.50 | 0.00 |" in text
    assert "| run-up | 4.50 | 0.350 | 4.00 | 2.00 |" in text
