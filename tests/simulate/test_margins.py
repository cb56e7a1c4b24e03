"""Linear crossings below and above the top speed, with closed forms."""

from dataclasses import replace

import numpy as np
import pytest
from made_sweeps import F1, STIFFENING, made_rom

from rom.crossings import crossing
from rom.polynomial import basis_speeds
from simulate.sweeps.crossings import critical

TOP = 0.4  # of the made model, over f1(0)
ORDERS = (1, 2, 3, 4, 5, 8, 9, 10)


def crossings_of(rom, modes=3, orders=ORDERS, lines=(("idle", 600.0),)):
    """What is found, and its crossings by mode and order."""
    given = {"modes": modes, "orders": orders, "lines": dict(lines), "excited": {}}
    found = critical(rom, given)
    return found, {(of["modes"][0], of["k"]): of for of in found["crossings"]}


def test_crossings_are_those_of_closed_form_also_above_the_top_speed():
    """f^2 = f0^2 + B Omega^2 meets k Omega at f0 / sqrt(k^2 - B): extrapolated without an error.

    With B > k^2 never.
    """
    expected = {
        (mode, k): at
        for mode, f0 in ((1, 1), (2, 4), (3, 4))
        for k in ORDERS
        if k**2 > STIFFENING and (at := f0 / np.sqrt(k**2 - STIFFENING)) <= 1.25 * TOP
    }
    found, crossings = crossings_of(made_rom())
    assert {*crossings} == {*expected}
    assert {of for of, at in expected.items() if at > TOP} == {(2, 9), (2, 10), (3, 9), (3, 10)}
    for of, at in expected.items():
        assert crossings[of]["rpm"] == pytest.approx(60 * F1 * at, rel=1e-8)
        assert crossings[of]["quadratic_rpm"] == pytest.approx(crossings[of]["rpm"], rel=1e-8)
        assert crossings[of]["what"].startswith("extrapolated") == (at > TOP)
    top = 60 * F1 * TOP
    assert [*found["through"], found["up_to"]] == pytest.approx([top / 2, top, 1.25 * top])
    met = {(mode, k): crossing(made_rom(), k, mode) for mode in (1, 2, 3) for k in ORDERS}
    below = {of: at if at <= TOP else np.nan for of, at in expected.items()}
    assert met == pytest.approx(dict.fromkeys(met, np.nan) | below, rel=1e-8, nan_ok=True)
    within, _ = crossings_of(made_rom(), lines=())  # without operating speeds nothing beyond
    assert (within["through"], within["up_to"]) == ([], pytest.approx(top))
    assert {of["what"] for of in within["crossings"]} == {"crossing"}


@pytest.mark.parametrize(("bend", "known"), [(-8.0, True), (8.0, True), (150.0, False)])
def test_the_quadratic_tells_how_far_the_line_is_to_be_trusted(bend, known):
    """f^2 = f0^2 + B Omega^2 + A Omega^4: the line through its last speeds, and the truth."""
    made = made_rom()
    unit = made.omega1
    K = made.K + np.array([0 * made.M, 0 * made.M, bend / unit**2 * np.eye(3)])
    crossing = crossings_of(replace(made, K=K))[1][2, 10]
    x = np.array([TOP / 2, TOP]) ** 2
    squares = 16 + STIFFENING * x + bend * x**2
    slope = np.diff(squares)[0] / np.diff(x)[0]
    line = np.sqrt((squares[1] - slope * x[1]) / (100 - slope))
    assert crossing["rpm"] == pytest.approx(60 * F1 * line, rel=1e-8)
    roots = np.roots([bend, STIFFENING - 100, 16])
    truth = min(np.sqrt(roots[roots > TOP**2]), default=np.inf) if known else np.nan
    assert crossing["quadratic_rpm"] == pytest.approx(60 * F1 * truth, rel=1e-7, nan_ok=True)


def test_frequencies_at_the_operating_speeds():
    found, _ = crossings_of(made_rom(), lines={"design": 0.3 * 60 * F1, "idle": 600.0})
    squares = np.add([1, 16, 16], STIFFENING * 0.3**2)
    assert found["Hz"]["design"] == pytest.approx(F1 * np.sqrt(squares), rel=1e-9)
    assert found["Hz"]["idle"] == pytest.approx(F1 * np.sqrt([1.056, 16.056, 16.056]), rel=1e-9)


def test_a_blade_of_finite_elements_crosses_where_its_model_of_higher_speeds_says(
    coarse_rom, coarse_blade
):
    """With 0.9 of the speed of the crossing as the top speed: off by less than 0.1 %."""
    at = crossing(coarse_rom, 4)
    top = 0.9 * at * coarse_rom.omega1
    slower = replace(coarse_rom, Omega_m=top, speeds=basis_speeds(coarse_blade.basis, top))
    found = crossings_of(slower, modes=1, orders=[4])[1][1, 4]
    truth = 60 * coarse_rom.f1 * at
    assert found["rpm"] == pytest.approx(truth, rel=1e-3)
    off = [abs(found[of] - truth) for of in ("rpm", "quadratic_rpm")]
    assert off[1] < off[0] < 2 * abs(found["rpm"] - found["quadratic_rpm"])
