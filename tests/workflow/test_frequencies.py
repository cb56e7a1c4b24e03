"""Tables of a blade's frequencies."""

import numpy as np
import pytest

from workflow.study.rotor37 import crossing, edge_cuts_table, prestress_table

SPEEDS = [0.0, 50.0, 100.0]


def test_the_crossing_is_that_of_a_stiffening_beam():
    """omega^2 = omega_0^2 + c Omega^2 crosses k Omega at omega_0 / sqrt(k^2 - c)."""
    omega = np.sqrt(300.0**2 + 6 * np.square(SPEEDS))
    assert crossing(SPEEDS, omega, 4) == pytest.approx(1 / np.sqrt(10), rel=1e-8)
    assert np.isnan(crossing(SPEEDS, 2 * omega, 4))  # beyond the last speed


def test_crossing_with_a_fourth_power():
    """9e4 + 6 x + 1e-4 x^2 crosses 16 x at x = 1e4 and 9e4: the first counts."""
    speeds = [0.0, 60.0, 120.0]
    squares = np.square(speeds)
    omega = np.sqrt(9e4 + 6 * squares + 1e-4 * squares**2)
    assert crossing(speeds, omega, 4) * omega[0] == pytest.approx(100, rel=1e-8)


def test_table_has_either_prestress_at_speed_and_one_row_at_rest():
    rest = 2 * np.pi * np.array([40.0, 200.0])
    found = {
        "speeds_rad_s": SPEEDS,
        "nonlinear_rad_s": [list(rest), list(1.1 * rest), list(1.4 * rest)],
        "linear_rad_s": [list(rest), list(1.2 * rest), list(1.5 * rest)],
    }
    assert prestress_table(found).splitlines()[2:7] == [
        "| at rest | 40.0 | 200.0 |",
        "| 50 rad/s, nonlinear | 44.0 | 220.0 |",
        "| 50 rad/s, linear | 48.0 | 240.0 |",
        "| 100 rad/s, nonlinear | 56.0 | 280.0 |",
        "| 100 rad/s, linear | 60.0 | 300.0 |",
    ]


def test_cuts_are_compared_with_the_blade_s_own():
    study = {
        "own_percent": 1.2,
        "cut_percent": [0.8, 1.2, 2.0],
        "at_rest_Hz": [[99.0, 10.0], [100.0, 10.0], [102.0, 9.9]],
    }
    assert edge_cuts_table(study).splitlines()[2:] == [
        "| 0.8 instead of 1.2 | -1.00 % | +0.00 % |",
        "| 2 instead of 1.2 | +2.00 % | -1.00 % |",
    ]
