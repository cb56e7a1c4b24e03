"""Where to run the engine next: equal parts of the emulated posteriors with either K."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from workflow.identify import emulator
from workflow.identify.likelihood import FITS, FOUR_SHIFTS, WITH_ORDER
from workflow.identify.priors import Points
from workflow.identify.table import Table, joined

UNSUPPORTED = 0.1
FAR = 2.0  # sigma, root mean square deviation of the best point of a reading that does not fit


def served(over_crossing: NDArray[np.float64]) -> str:
    """Reading of the data that the draws serve: the better one of all four shifts, or k = 4 alone.

    ``over_crossing``: shifts (points, coatings, orders) of the prior's points. All four shifts are
    left where none of these points comes near them (``FAR``).
    """
    best = {
        reading: min(of.chi_squared(over_crossing).min() for of in FITS if of.reading == reading)
        for reading in FOUR_SHIFTS
    }
    nearest = min(best, key=best.__getitem__)
    return nearest if best[nearest] <= 4 * FAR**2 else "k = 4"


def proposal(
    tables: Sequence[Table], candidates: Points, at: Points, data: str
) -> NDArray[np.float64]:
    """Density (at,), relative to the prior, from which points are drawn after ``tables``.

    Equal parts of the emulated posteriors with either K of E = 1, without a K whose evidence is
    less than ``UNSUPPORTED`` of the other's. ``candidates``: points of the prior, by which they are
    normalised; ``data``: one of ``DATA``.
    """
    points, known = np.vstack([table.points for table in tables]), joined(tables)
    reading, everywhere = served(tables[0].observed.over_crossing), np.vstack([candidates, at])
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
    evidences = likelihoods[:, : len(candidates)].mean(axis=1)
    parts = likelihoods[:, len(candidates) :] / evidences[:, None]
    return parts[evidences >= UNSUPPORTED * evidences.max()].mean(axis=0)
