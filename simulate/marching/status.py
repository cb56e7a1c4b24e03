"""Status of a run from its end and its energies."""

import numpy as np

from simulate.contact.ledger import Ledger
from simulate.marching.kernel import RUNNING, WORN_THROUGH

# in the order in which tables number them
STATUSES = (
    "ok",
    "sensitive",
    "inaccurate",
    "liner-exhausted",
    "diverged",
    "unstable",
    "no-contact",
)
# statuses of the runs whose numbers are results; without contact, those of a blade at rest
WITH_RESULT = ("ok", "sensitive", "no-contact")

# Numerical energy over what casing and rods at the start give: limits of an `ok` run
CREATED = 0.1  # above, the run is `unstable`
LOST = 0.2  # above, it is `inaccurate`: energy is quadratic, so 20 % is 10 % of the amplitude
SLIDES = 0.1  # least sliding speed over Omega r of an `ok` run with friction


def judge(
    end: int,
    ledger: Ledger,
    unsolved: int,
    at_rest: bool = False,
    least_sliding: float = np.inf,
) -> str:
    """Status of a run from its ``end``, its energies and the ``unsolved`` steps.

    Unsolved are steps in which the solver of the contact forces did not converge. ``at_rest``: no
    force has ever moved the blade, though it should rub. ``least_sliding``: least sliding speed of
    a tip with friction in contact, over Omega r.

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
    ``no-contact``
        The blade has stayed ``at_rest``.
    ``ok``
        None of these.
    """
    given = ledger.casing + ledger.elastic_before
    created = not ledger.numerical <= CREATED * given  # true for nan as well
    sound = ledger.blade >= 0 and not created and unsolved == 0
    if end == WORN_THROUGH:
        return "liner-exhausted"
    if not sound:
        return "unstable"
    if end != RUNNING:
        return "diverged"
    if ledger.numerical < -LOST * given or least_sliding < SLIDES:
        return "inaccurate"
    return "no-contact" if at_rest else "ok"
