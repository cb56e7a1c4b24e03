"""Status of a run from its end, its energies and its solver."""

from dataclasses import replace
from math import nan

import pytest

from simulate.contact.ledger import Ledger
from simulate.marching.kernel import ESCAPED, RUNNING, WORN_THROUGH
from simulate.marching.status import SLIDES, judge

SOUND = Ledger(
    casing=10.0, work=4.0, blade=3.0, damping=1.0, elastic=0.5, plastic=4.0, released=1.0
)  # loses 0.5
FED = replace(SOUND, work=6.0, blade=5.0)  # creates 1.5, over a tenth of the casing's work
SLIDING = Ledger(1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0)


@pytest.mark.parametrize(
    ("end", "ledger", "unsolved", "status", "least_sliding"),
    [
        (RUNNING, SOUND, 0, "ok", 1.0),
        (RUNNING, Ledger(*[0.0] * 7), 0, "ok", 1.0),  # without contact
        (RUNNING, replace(SOUND, work=5.4), 0, "ok", 1.0),  # creates 0.9
        (RUNNING, FED, 0, "unstable", 1.0),
        (RUNNING, SOUND, 1, "unstable", 1.0),
        (RUNNING, replace(SOUND, blade=-1.0), 0, "unstable", 1.0),
        (RUNNING, replace(SOUND, blade=nan), 0, "unstable", 1.0),
        (RUNNING, replace(SOUND, plastic=nan), 0, "unstable", 1.0),
        (ESCAPED, SOUND, 0, "diverged", 1.0),
        (ESCAPED, FED, 0, "unstable", 1.0),
        (WORN_THROUGH, SOUND, 0, "liner-exhausted", 1.0),
        (RUNNING, SLIDING, 0, "ok", SLIDES),
        (RUNNING, SLIDING, 0, "inaccurate", 0.99 * SLIDES),
    ],
)
def test_status_of_a_run(end, ledger, unsolved, status, least_sliding):
    assert judge(end, ledger, unsolved, least_sliding=least_sliding) == status
