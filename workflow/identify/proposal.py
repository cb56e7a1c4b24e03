"""Where to run the engine next: equal parts of the emulated posteriors with either K."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.stats import chi2

from workflow.identify import emulator
from workflow.identify.likelihood import FITS, FOUR_SHIFTS, WITH_ORDER
from workflow.identify.posterior import systematic
from workflow.identify.priors import Points
from workflow.identify.table import Table, joined, sobol

CANDIDATES = 2**18  # points of the prior from which those of a table are drawn
SEED = 1  # of the prior's points; those after it count on
UNSUPPORTED = 0.1
LEVEL = 0.95  # of the distribution of chi squared, up to which a reading fits
SHIFTS_OF_FOUR = 4  # data of a reading of all four shifts


def served(prior: Table) -> str:
    """Reading of the data that the draws serve: the better one of all four shifts, or k = 4 alone.

    By the least chi squared that the emulator finds. All four shifts are left where it is beyond
    ``LEVEL`` of its distribution.
    """
    among = candidates([prior])
    least = {
        reading: min(
            emulator.least(prior.points, of.deviations(prior.observed.over_crossing), among)
            for of in FITS
            if of.reading == reading
        )
        for reading in FOUR_SHIFTS
    }
    nearest = min(least, key=least.__getitem__)
    return nearest if least[nearest] <= chi2.ppf(LEVEL, SHIFTS_OF_FOUR) else "k = 4"


def candidates(tables: Sequence[Table]) -> Points:
    """Points of the prior from which those of the table after ``tables`` are drawn, its own."""
    return sobol(CANDIDATES, SEED + len(tables))


def drawn(tables: Sequence[Table], number: int, data: str) -> Points:
    """Points of the table after ``tables``, drawn by ``data``, one of ``DATA``."""
    among = candidates(tables)
    rng = np.random.default_rng(SEED + len(tables))
    return among[systematic(proposal(tables, among, data), number, rng)]


def proposal(tables: Sequence[Table], at: Points, data: str) -> NDArray[np.float64]:
    """Density (at,), relative to the prior, from which points are drawn after ``tables``.

    Equal parts of the emulated posteriors with either K of E = 1, without a K whose evidence is
    less than ``UNSUPPORTED`` of the other's. ``data``: one of ``DATA``.
    """
    points, known = np.vstack([table.points for table in tables]), joined(tables)
    reading, everywhere = (
        served(tables[0]),
        np.vstack([candidates(tables), at]),
    )
    likelihoods = np.array(
        [
            emulator.likelihood(
                points,
                of.deviations(known.over_crossing),
                everywhere,
                of.stiffer_is_more(known) if data == WITH_ORDER else None,
            )
            for of in FITS
            if of.reading == reading
        ]
    )
    evidences = likelihoods[:, :CANDIDATES].mean(axis=1)
    parts = likelihoods[:, CANDIDATES:] / evidences[:, None]
    return parts[evidences >= UNSUPPORTED * evidences.max()].mean(axis=0)
