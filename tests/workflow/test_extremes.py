"""Some cases of the stability matrix on the coarse blade: none is wrong with status ok.

Only cases whose kernels the two schemes need anyway; `./run snakemake stability` has them all.
"""

from collections import Counter
from itertools import count, islice

import numpy as np
import pytest

from geometry.blade import EnrichedBasis
from geometry.hats import middles
from rom.reduce import reduce
from workflow.study.stability.cases import FIRST_STRIP_DEG, draw, draw_changing
from workflow.study.stability.matrix import judge_case

pytestmark = pytest.mark.slow

CASES, CHANGING = 30, 100


def is_plain(number):
    case = draw(number)
    return (
        case.scene["liner"]["law"]["kind"] == "plastic"
        and case.scene["liner"]["worn_through"] == "stop"
        and not case.scene["contact"]
    )


@pytest.fixture(scope="module")
def rom(coarse_matrices):
    return reduce(coarse_matrices, EnrichedBasis(), "rt")[0]


@pytest.fixture(scope="module")
def ends(rom):
    numbers = islice(filter(is_plain, count()), CASES)
    return [judge_case(draw(number), rom) for number in numbers]


def test_no_case_is_wrong_with_status_ok(ends):
    wrong = [end for end in ends if end.kind == "wrong"]
    assert not wrong, [(end.why, end.change, end.error, end.spread) for end in wrong]
    assert sum(end.kind == "unjudged" for end in ends) <= 1


def test_cases_have_all_outcomes(ends):
    kinds = Counter(end.kind for end in ends)
    assert min(kinds[kind] for kind in ("right", "flagged", "refused")) >= 4, kinds
    assert sum(end.kind == "right" and end.contact for end in ends) >= 4


def test_refusals_name_what_is_allowed(ends):
    refused = [end for end in ends if end.kind == "refused"]
    assert all(end.message and "\n" not in end.message.strip() for end in refused)


def test_no_case_with_friction_or_a_changing_casing_is_wrong_with_status_ok(rom):
    """A hundred, with travelling harmonics, clearances that change, and friction drawn in.

    One is known: on a liner of 2e13 Pa halving the step changes little, with friction or without.
    """
    ends = [judge_case(draw_changing(number), rom) for number in range(CHANGING)]
    wrong = [
        (n, end.why, end.change, end.error) for n, end in enumerate(ends) if end.kind == "wrong"
    ]
    assert not wrong, wrong
    kinds = Counter(end.kind for end in ends)
    assert kinds["unjudged"] <= 3, kinds
    assert min(kinds[kind] for kind in ("right", "flagged", "refused")) >= 10, kinds


def test_casings_are_turned_to_where_the_first_strip_starts(rom):
    """To the digits given."""
    for strips, degrees in FIRST_STRIP_DEG.items():
        assert np.degrees(rom.line(middles(strips))[0, 1]) == pytest.approx(degrees, abs=0.01)


def test_the_same_number_is_the_same_case():
    assert draw(7) == draw(7) and draw(7) != draw(8)
