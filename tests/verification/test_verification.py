"""Every number of tests/VERIFICATION.md is within its tolerance, and is what the page shows."""

import pytest
from cases import Row
from page import CASES, PAGE, page, read

SAME = 0.1  # of a tolerance: what another machine may change


def by_night(name: str) -> object:
    """A case of the parametrised test, marked where it takes long."""
    return pytest.param(name, marks=[pytest.mark.nightly] if CASES[name].nightly else [])


@pytest.mark.parametrize("name", [*map(by_night, CASES)])
def test_numbers_are_theirs_and_those_of_the_page(name):
    rows, shown = list(CASES[name].rows()), read()[name]
    assert [row.quantity for row in rows if row.share > 1] == []
    assert [row.quantity for row in rows] == [row.quantity for row in shown]
    for now, then in zip(rows, shown, strict=True):
        assert (now.theirs is None) == (then.theirs is None), now.quantity
        for side in ("theirs", "ours"):
            both = getattr(then, side), getattr(now, side)
            assert Row(side, *both, SAME * now.tolerance, now.scale).share <= 1, now.quantity


def test_page_is_written_from_its_numbers():
    assert PAGE.read_text() == page(read())
