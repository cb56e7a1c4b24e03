"""The study of errors over CPU time: its table, and whether its files are of one run."""

from massless_boundary import MEASURED, OTHERS, OWN
from massless_study import METHODS, Point, cheapest

from geometry.project import read_json


def test_the_cheapest_setting_within_an_error_counts():
    casing, boundary = "rigid casing", OTHERS[0]
    points = [
        Point(casing, OWN, None, 512, 0.2, 0.010),
        Point(casing, OWN, None, 1024, 0.0009, 0.020),
        Point(casing, boundary, 10, 512, 0.05, 0.005),
        Point(casing, boundary, 24, 1024, 0.02, 0.012),
        Point(casing, boundary, 24, 2048, 0.02, 0.022),
    ]
    points += [
        point._replace(casing=other)
        for other in ("elastic liner", "plastic liner")
        for point in points[:2]
    ]
    first, second, third, *_ = cheapest(points)
    assert first == [casing, "10 %", "20", "0.25 (10 modes)", "-", "-"]
    assert second[3:] == ["0.6 (24 modes)", "-", "-"]
    assert third[3:] == ["-"] * 3


def test_the_table_is_that_of_the_points():
    measured = read_json(MEASURED)
    points = [Point(*of) for of in measured["points"]]
    assert cheapest(points) == measured["levels"]
    assert {(of.method, of.modes) for of in points} == {(of.method, of.modes) for of in METHODS}
