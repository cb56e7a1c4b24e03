"""How a run ended: statuses and what tells them apart."""

from simulate.kernel import RUNNING, WORN_THROUGH
from simulate.ledger import Ledger

WITH_RESULT = ("ok", "sensitive")  # statuses of the runs whose numbers are results

# Numerical energy over the casing's work
CREATED = 0.1  # from which a run is not physics
LOST = 0.2  # from which it is no result: energy goes with the square, so a tenth of what it shows


def judge(end: int, ledger: Ledger, unsolved: int) -> str:
    """Status of a run that ended so, with ``unsolved`` steps whose forces were not found.

    ``liner-exhausted``
        The tip has come through the liner.
    ``unstable``
        Numerical energy fed the motion, the energy is no positive number, or forces were not
        found: numerics.
    ``diverged``
        The motion left all bounds, fed by the casing: physics.
    ``inaccurate``
        Its steps have lost what contact should have returned: take smaller ones.
    ``ok``
        None of these.
    """
    fed = not ledger.numerical <= CREATED * ledger.casing  # also where it is no number
    sound = ledger.blade >= 0 and not fed and unsolved == 0
    if end == WORN_THROUGH:
        return "liner-exhausted"
    if not sound:
        return "unstable"
    if end != RUNNING:
        return "diverged"
    return "inaccurate" if ledger.numerical < -LOST * ledger.casing else "ok"
