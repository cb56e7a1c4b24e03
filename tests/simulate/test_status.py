"""Status of a run from its end, its energies and its solver."""

from dataclasses import replace
from math import nan

import pytest

from simulate.kernel import ESCAPED, RUNNING, WORN_THROUGH
from simulate.ledger import Ledger
from simulate.status import judge

SOUND = Ledger(
    casing=10.0, work=4.0, blade=3.0, damping=1.0, elastic=0.5, plastic=4.0, released=1.0
)  # loses 0.5
FED = replace(SOUND, work=6.0, blade=5.0)  # creates 1.5, over a tenth of the casing's work


@pytest.mark.parametrize(
    ("end", "ledger", "unsolved", "status"),
    [
        (RUNNING, SOUND, 0, "ok"),
        (RUNNING, replace(SOUND, work=5.4), 0, "ok"),  # creates 0.9
        (RUNNING, FED, 0, "unstable"),
        (RUNNING, SOUND, 1, "unstable"),
        (RUNNING, replace(SOUND, blade=-1.0), 0, "unstable"),
        (RUNNING, replace(SOUND, blade=nan), 0, "unstable"),
        (RUNNING, replace(SOUND, plastic=nan), 0, "unstable"),
        (ESCAPED, SOUND, 0, "diverged"),
        (ESCAPED, FED, 0, "unstable"),
        (WORN_THROUGH, SOUND, 0, "liner-exhausted"),
    ],
)
def test_status_of_a_run(end, ledger, unsolved, status):
    assert judge(end, ledger, unsolved) == status


def test_a_blade_without_contact_is_ok():
    assert judge(RUNNING, Ledger(*[0.0] * 7), 0) == "ok"
