"""Some of the stability matrix's cases on the coarse blade: none is silently wrong.

Only cases whose kernels the two schemes need anyway; `./run snakemake stability` has them all.
"""

from collections import Counter
from itertools import count, islice

import pytest

from geometry.blade import EnrichedBasis
from rom.reduce import reduce
from workflow.study.stability_cases import draw
from workflow.study.stability_matrix import judge_cases, models
from workflow.study.stability_runs import Budget

CASES = 30


def is_plain(number):
    case = draw(number)
    return (
        case.nodes < 16
        and case.scene["liner"]["law"]["kind"] == "plastic"
        and case.scene["liner"]["worn_through"] == "stop"
        and not case.scene["contact"]
    )


@pytest.fixture(scope="module")
def ends(coarse_matrices):
    rom, _ = reduce(coarse_matrices, EnrichedBasis(), "rt")
    numbers = islice(filter(is_plain, count()), CASES)
    return judge_cases(models(rom, rom), numbers, Budget())


def test_no_case_is_silently_wrong(ends):
    wrong = [end for end in ends if end.kind == "wrong"]
    assert not wrong, [(end.why, end.change, end.error, end.spread) for end in wrong]
    assert sum(end.kind == "unjudged" for end in ends) <= 1


def test_cases_end_in_every_way(ends):
    kinds = Counter(end.kind for end in ends)
    assert min(kinds[kind] for kind in ("right", "flagged", "refused")) >= 4, kinds
    assert sum(end.kind == "right" and end.contact for end in ends) >= 4


def test_refusals_say_what_is_allowed(ends):
    refused = [end for end in ends if end.kind == "refused"]
    assert all(end.message and "\n" not in end.message.strip() for end in refused)


def test_the_same_number_is_the_same_case():
    assert draw(7) == draw(7) and draw(7) != draw(8)
