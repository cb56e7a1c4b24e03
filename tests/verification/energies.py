"""The energy ledger: closed forms, balance, and the energy that the schemes lose."""

from collections.abc import Iterator

import numpy as np
from cases import Case, Row
from rubs import LAWS, SCHEMES, lost, pressed, rub

ROUND_OFF = 1e-11  # over some thousand steps
ORDERS = {"central-difference": (1.0, 0.2), "piecewise-exact": (3.0, 0.2 / 9)}  # and tolerances
STEPS = (1e-3, 1e-2, 0.1, 1.0, 10.0)  # s; modes of 1 to 30 rad/s


def rows() -> Iterator[Row]:
    """Energies of rods, balances of a rub, orders of the energy lost, none created."""
    ledger, expected = pressed()
    for name, energy in expected.items():
        yield Row(f"{name} energy of a liner pressed once, J", energy, getattr(ledger, name), 1e-9)
    share = ledger.numerical / ledger.casing
    yield Row("its numerical energy over the work of the casing", 0.0, share, ROUND_OFF, scale=1)
    for scheme, law in ((scheme, law) for scheme in SCHEMES for law in LAWS):
        run = rub(scheme, law)
        left = run.ledger.blade + run.ledger.damping - run.start_energy - run.ledger.work
        share = left / (run.ledger.damping + run.start_energy)
        yield Row(f"balance of the blade, {scheme}, {law}", 0.0, share, ROUND_OFF, scale=1)
        long, short = lost(scheme, law, (2400, 4800))
        order, tolerance = ORDERS[scheme]
        found = float(np.log2(long / short))
        yield Row(f"order of the energy lost, {scheme}, {law}", order, found, tolerance)
    for law in LAWS:
        ledgers = [rub("piecewise-exact", law, h=h).ledger for h in STEPS]
        assert min(of.casing for of in ledgers) > 0
        created = max(max(of.numerical, 0.0) / of.casing for of in ledgers)
        at = f"energy created, piecewise-exact, {law}, steps of 1e-3 to 10 s, over casing's work"
        yield Row(at, 0.0, created, 1e-12, scale=1)


CASE = Case(
    title="Energy ledger (closed forms)",
    source="closed forms and balances: rods pressed once at constant depth; the blade's energy and "
    "its damping are the start's and the work; the orders that the schemes are built for",
    compared="A liner pressed by a blade that cannot move; three strips on eleven modes of 1 to 30 "
    "rad/s over a lobed casing, in and out of contact.",
    reason="round-off of a thousand steps. Orders are found from two steps, at which the next "
    "order of the error is still a share of the first.",
    rows=rows,
)
