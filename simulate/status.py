"""Status of a run from its end and its energies."""

import numpy as np

from simulate.kernel import RUNNING, WORN_THROUGH
from simulate.ledger import Ledger

STATUSES = "ok", "sensitive", "inaccurate", "liner-exhausted", "diverged", "unstable"
WITH_RESULT = ("ok", "sensitive")  # statuses of the runs whose numbers are results

# Numerical energy over the casing's work: limits of an `ok` run
CREATED = 0.1  # above, the run is `unstable`
LOST = 0.2  # above, it is `inaccurate`: energy is quadratic, so 20 % is 10 % of the amplitude
SLIDES = 0.1  # least sliding speed over Omega r of an `ok` run with friction


def judge(end: int, ledger: Ledger, unsolved: int, least_sliding: float = np.inf) -> str:
    """Status of a run from its ``end``, its energies and the ``unsolved`` steps.

    Unsolved are steps in which the solver of the contact forces did not converge.
    ``least_sliding``: least sliding speed of a tip with friction in contact, over Omega r.

    ``liner-exhausted``
        The tip has worn through the liner.
    ``unstable``
        The scheme created energy, the energy is negative or nan, or steps are unsolved: a numerical
        failure.
    ``diverged``
        The displacement exceeded its bound, driven by the work of the casing, or of friction:
        physical.
    ``inaccurate``
        The scheme lost energy in contact: the step is too long. Or the vibration of the tip came
        near its sliding speed, where friction would change its direction.
    ``ok``
        None of these.
    """
    created = not ledger.numerical <= CREATED * ledger.casing  # true for nan as well
    sound = ledger.blade >= 0 and not created and unsolved == 0
    if end == WORN_THROUGH:
        return "liner-exhausted"
    if not sound:
        return "unstable"
    if end != RUNNING:
        return "diverged"
    lost = ledger.numerical < -LOST * ledger.casing
    return "inaccurate" if lost or least_sliding < SLIDES else "ok"
