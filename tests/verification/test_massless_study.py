"""The study of errors over CPU time: its table, its words, points that are computed again.

The latter with the numbers of the page, by night. CPU times, and whether the picture is of the same
points, are not tested.
"""

from itertools import product

import pytest
from massless_boundary import FEW, SHORT
from massless_runs import LAWS, MEASURED, PEAK, RICH, error, exact, rub
from massless_study import (
    CENTRAL,
    LEVELS,
    MASSLESS,
    METHODS,
    OWN,
    SPEEDS,
    Point,
    cheapest,
    within,
)
from page import read

from geometry.base import read_json
from simulate import sweep


def measured():
    """Points of the study."""
    return [Point(*of) for of in read_json(MEASURED)["points"]]


def test_the_cheapest_setting_within_an_error_counts():
    casing = "rigid casing"
    points = [
        Point(casing, OWN, 24, 512, [0.01, 0.01, 0.2], [0.004, 0.004, 0.002]),
        Point(casing, OWN, 24, 1024, [0.0009, 0.0001, 0.0009], [0.008, 0.008, 0.004]),
        Point(casing, MASSLESS, 10, 512, [0.01, 0.04, 0.05], [0.002, 0.002, 0.001]),
        Point(casing, MASSLESS, 24, 1024, [0.02, 0.02, 0.02], [0.008, 0.002, 0.002]),
        Point(casing, MASSLESS, 24, 2048, [0.02, 0.02, 0.02], [0.008, 0.007, 0.007]),
    ]
    points += [
        point._replace(casing=other)
        for other in ("elastic liner", "plastic liner")
        for point in points[:2]
    ]
    first, second, third, *_ = cheapest(points)
    assert first == [casing, "10 %", "20 (24)", "0.2 (10)", "0.5, 0.5, 0.2", "-"]
    assert second[3:] == ["0.6 (24)", "0.5, 0.5, 0.5", "-"]
    assert third[3:] == ["-", "0.5, -, -", "-"]


def test_the_table_is_that_of_the_points():
    points = measured()
    assert cheapest(points) == read_json(MEASURED)["levels"]
    assert {(of.method, of.modes) for of in points} == {(of.method, of.modes) for of in METHODS}


def test_the_words_are_those_of_the_table():
    """Where either method is faster by more than the scatter of times, and by how much."""
    rigid, elastic, plastic = LAWS
    ratios = {row[0] + row[1]: row[3:] for row in read_json(MEASURED)["levels"]}
    over = {at: float(cells[0].split()[0]) for at, cells in ratios.items()}
    assert {at for at, ratio in over.items() if ratio < 0.8} == {f"{rigid}10 %", f"{rigid}3 %"}
    slower = {at for at, ratio in over.items() if ratio > 1.2}
    plastic_ones = {at for at in over if at.startswith(plastic)}
    assert slower == plastic_ones | {f"{elastic}1 %", f"{elastic}0.3 %"}
    assert {over[at] for at in slower} == {2, 3}
    alone = [(at, cells[1].split(", ")) for at, cells in ratios.items()]
    assert [at for at, cells in alone if min(map(float, cells)) < 0.8] == [f"{rigid}3 %"]
    longer = [
        sum(within(measured(), casing, CENTRAL, level).cpu)
        / sum(within(measured(), casing, MASSLESS, level).cpu)
        for casing, level in product((elastic, plastic), LEVELS)
    ]
    assert min(longer) > 7 and max(longer) < 35


@pytest.mark.parametrize("casing", LAWS)
def test_errors_are_those_that_the_page_computes(casing):
    """At the peak, with the steps of the page; both converged runs err by up to 2.5e-5."""
    rows = {row.quantity: row.ours for row in read()["massless-boundary"]}
    for method, modes, name in (
        (OWN, RICH, "`piecewise-exact`"),
        (MASSLESS, FEW, f"massless boundary, {FEW} modes"),
    ):
        [of] = [of for of in measured() if of[:4] == (casing, method, modes, SHORT)]
        expected = rows[f"{casing}: error, {SHORT} steps, {name}"]
        assert of.errors[SPEEDS.index(PEAK)] == pytest.approx(expected, rel=0, abs=3e-5)


@pytest.mark.parametrize("law", LAWS.values(), ids=lambda law: law["kind"])
def test_long_steps_at_the_peak_are_found_by_checks_alone(coarse_rom, law):
    """On the coarse blade with its eight patches: an error of over 20 % that no energy tells.

    By default, too: eight times the steps are enough on the plastic liner.
    """
    of = rub(coarse_rom, law, PEAK, blade="coarse", liner__strips=8)
    assert error(exact(of, 512), exact(of, 32768)) > 0.2
    scene = of.scene.but(integrator={"scheme": "piecewise-exact", "steps_per_round": 512})
    alone, *checked = (
        sweep(scene.but(**of), coarse_rom)
        for of in ({"verify": {"share": 0}}, {}, {"verify": "every"})
    )
    assert alone.status.item() == "ok"
    for found in checked:
        mended = found.steps_per_round.item() == 8 * 512
        assert found.status.item() == ("ok" if mended else "inaccurate")
        assert mended == (law["kind"] == "plastic")
