"""Status of a run from its end, its energies and its solver."""

from dataclasses import replace
from math import inf, nan

import pytest

from simulate.contact.ledger import Ledger
from simulate.marching import SENSITIVE_FROM, STATED, Facts
from simulate.marching.kernel import ESCAPED, RUNNING, WORN_THROUGH
from simulate.marching.status import SLIDES, judge

SOUND = Ledger(
    casing=10.0, work=4.0, blade=3.0, damping=1.0, elastic=0.5, plastic=4.0, released=1.0
)  # loses 0.5
FED = replace(SOUND, work=6.0, blade=5.0)  # creates 1.5, over a tenth of the casing's work
LOSSY = replace(SOUND, work=2.0)  # loses 2.5
SLIDING = Ledger(1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0)


@pytest.mark.parametrize(
    ("facts", "status"),
    [
        (Facts(RUNNING, SOUND), "ok"),
        (Facts(RUNNING, Ledger(*[0.0] * 7)), "ok"),  # without contact
        (Facts(RUNNING, Ledger(*[0.0] * 7), untouched=True), "no-contact"),
        (Facts(RUNNING, replace(SOUND, work=5.4)), "ok"),  # creates 0.9
        (Facts(RUNNING, FED), "unstable"),
        (Facts(RUNNING, SOUND, unsolved=1), "unstable"),
        (Facts(RUNNING, replace(SOUND, blade=-1.0)), "unstable"),
        (Facts(RUNNING, replace(SOUND, blade=nan)), "unstable"),
        (Facts(RUNNING, replace(SOUND, plastic=nan)), "unstable"),
        (Facts(ESCAPED, SOUND), "diverged"),
        (Facts(ESCAPED, FED), "unstable"),
        (Facts(ESCAPED, replace(FED, force=6.0)), "diverged"),  # a tenth of what all gave
        (Facts(ESCAPED, replace(FED, fed=6.0)), "diverged"),
        (Facts(ESCAPED, replace(FED, force=-6.0)), "unstable"),
        (Facts(WORN_THROUGH, SOUND), "liner-exhausted"),
        (Facts(RUNNING, SLIDING, least_sliding=SLIDES), "ok"),
        (Facts(RUNNING, SLIDING, least_sliding=0.99 * SLIDES), "inaccurate"),
    ],
)
def test_status_of_a_march(facts, status):
    assert judge(facts) == status


AT_REST = {"untouched": True}
BESIDE = {  # what second runs tell, further facts, and the status that they leave
    "its twin departs": ({"twin": 1.01 * SENSITIVE_FROM}, {}, "sensitive"),
    "not by much": ({"twin": 0.99 * SENSITIVE_FROM}, {}, "ok"),
    "its twin fails": ({"twin": inf}, {}, "sensitive"),
    "the accuracy is not met": ({"accurate": False}, {}, "sensitive"),
    "its error may be too large": ({"error": 1.01 * STATED}, {}, "inaccurate"),
    "its error is stated": ({"error": STATED}, {}, "ok"),
    "no error is known": ({"error": nan}, {}, "inaccurate"),
    # a motion that cannot be predicted says more than a step that is too long
    "both": ({"twin": 0.5, "error": 0.5}, {}, "sensitive"),
    "alone, less may be lost": ({"lost": 0.04}, {}, "inaccurate"),
    "as much may be lost": ({"lost": 0.06}, {}, "ok"),
    "sensitive, and much is lost": ({"lost": 0.04, "twin": 0.5}, {}, "sensitive"),
    "at rest": ({}, AT_REST, "no-contact"),
    "at rest, and half the step touches": ({"error": inf}, AT_REST, "inaccurate"),
    "it lost too much": ({"twin": 0.5, "accurate": False}, {"ledger": LOSSY}, "inaccurate"),
    "at rest, its accuracy not met": ({"accurate": False}, AT_REST, "sensitive"),
    "it failed": ({"twin": 0.5, "error": 0.5, "accurate": False}, {"end": ESCAPED}, "diverged"),
}


@pytest.mark.parametrize("name", BESIDE)
def test_second_runs_decide_on_a_run_that_has_a_result(name):
    beside, more, status = BESIDE[name]
    assert judge(replace(Facts(RUNNING, SOUND), **more), **beside) == status
