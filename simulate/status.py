"""How a run ended: statuses and what tells them apart."""

from simulate.ledger import Ledger
from simulate.march import ENDED_NOT, WORN_THROUGH

CREATED = 0.1  # of the casing's work: numerical energy from which a run is not physics


def judge(end: int, ledger: Ledger, unsolved: int) -> str:
    """Status of a run that ended so, with ``unsolved`` steps whose forces were not found.

    ``liner-exhausted``
        The tip has come through the liner.
    ``unstable``
        Numerical energy fed the motion, the energy is no positive number, or forces were not
        found: numerics.
    ``diverged``
        The motion left all bounds, fed by the casing: physics.
    ``ok``
        None of these.
    """
    fed = not ledger.numerical <= CREATED * ledger.casing  # also where it is no number
    sound = ledger.blade >= 0 and not fed and unsolved == 0
    if end == WORN_THROUGH:
        return "liner-exhausted"
    if not sound:
        return "unstable"
    return "ok" if end == ENDED_NOT else "diverged"
