"""How far two runs are apart in what they record, whatever their steps, samples and rods."""

from dataclasses import dataclass
from math import inf, nan

import numpy as np
from numpy.linalg import norm
from numpy.typing import NDArray

from simulate.observables import on_rods, spectrum
from simulate.run import Outcome
from simulate.scene import Record


@dataclass(frozen=True)
class Run:
    """A run and what was asked of it."""

    record: Record
    outcome: Outcome


def departures(one: Run, other: Run) -> dict[str, float]:
    """Relative departure of two runs in each observable that the first records.

    `spectrum`: largest difference of amplitude beyond bin 0, over the largest amplitude. `wear`
    (all rods of all nodes, the coarser profile linear between its rods), `history` (samples of the
    recorded nodes that both have), `states` and `force_peak` (all rounds and nodes): L2 norm of
    the difference over that of the larger. 0 where nothing differs, inf where the runs end
    differently, nan where neither has a result.
    """
    names = one.record.observables
    if one.outcome.status != other.outcome.status:
        return dict.fromkeys(names, inf)
    if one.outcome.status != "ok":
        return dict.fromkeys(names, nan)
    return {name: _departure(name, _values(one, name), _values(other, name)) for name in names}


def _departure(name: str, one: NDArray[np.float64], other: NDArray[np.float64]) -> float:
    order = inf if name == "spectrum" else 2
    one, other = (values.ravel() for values in _alike(name, one, other))
    difference = norm(one - other, order)
    larger = max(norm(one, order), norm(other, order))
    return float(difference / larger) if difference else 0.0


def _alike(
    name: str, one: NDArray[np.float64], other: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Both at the bins, rods or samples that can be compared."""
    if name == "wear":
        nu = max(one.shape[1], other.shape[1])
        return on_rods(one, nu), on_rods(other, nu)
    if name == "spectrum":
        bins = min(len(one), len(other))
        return one[:bins], other[:bins]
    common = min(len(one), len(other))
    return one[_last_of(len(one) // common)], other[_last_of(len(other) // common)]


def _last_of(every: int) -> slice:
    """Each ``every``-th sample: the first lies a sample after the start."""
    return slice(every - 1, None, every)


def _values(run: Run, name: str) -> NDArray[np.float64]:
    """The observable's numbers in one run."""
    record, outcome = run.record, run.outcome
    if name == "spectrum":
        samples = record.spectrum_rounds * record.samples_per_round
        return spectrum(outcome.u_r[-samples:, 0])[1:]
    if name == "history":
        return outcome.u_r[:, [node - 1 for node in record.history.nodes]]
    return getattr(outcome, name)
