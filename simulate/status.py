"""How a run ended: statuses and what tells them apart."""

from simulate.ledger import Ledger
from simulate.march import ENDED_NOT, WORN_THROUGH

CREATED = 0.1  # of the casing's work: numerical energy from which a run is not physics


def judge(end: int, ledger: Ledger) -> str:
    """Status of a run that ended so.

    ``liner-exhausted``
        The tip has come through the liner.
    ``unstable``
        Numerical energy fed the motion, or the energy is no positive number: numerics.
    ``diverged``
        The motion left all bounds, fed by the casing: physics.
    ``ok``
        None of these.
    """
    sound = ledger.blade >= 0 and ledger.numerical <= CREATED * ledger.casing  # false for nan
    if end == WORN_THROUGH:
        return "liner-exhausted"
    if not sound:
        return "unstable"
    return "ok" if end == ENDED_NOT else "diverged"
