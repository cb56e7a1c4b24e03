"""Relative differences of arrays, and of runs that may differ in steps, samples and rods."""

from dataclasses import dataclass
from math import inf, nan

import numpy as np
from numpy.linalg import norm
from numpy.typing import ArrayLike, NDArray

from simulate.contact.places import by_share
from simulate.errors.signals import on_rods, spectrum
from simulate.marching.run import Outcome
from simulate.marching.status import WITH_RESULT
from simulate.scene import Record


@dataclass(frozen=True)
class Run:
    """A run and what it records."""

    record: Record
    outcome: Outcome


def distance(
    one: NDArray[np.float64], other: NDArray[np.float64], order: float = 2, least: float = 0.0
) -> float:
    """Norm of the difference over the larger of both norms and ``least``; 0 for equal arrays.

    ``order`` 2 is the root of the sum of squares, inf the largest absolute value.

    >>> distance(np.array([0.0, 9.0]), np.array([0.0, 10.0]))
    0.1
    >>> distance(np.array([4.0, 2.0]), np.array([4.0, 1.0]), order=inf)
    0.25
    """
    difference = norm((one - other).ravel(), order)
    larger = max(norm(one.ravel(), order), norm(other.ravel(), order), least)
    return float(difference / larger) if difference else 0.0


def error(value: ArrayLike, reference: ArrayLike) -> float:
    """Relative error of ``value`` in L2: ||value - reference|| / ||reference||.

    >>> error([3.0, 4.5], [3.0, 4.0])
    0.1
    """
    return float(norm(np.ravel(np.subtract(value, reference))) / norm(np.ravel(reference)))


def departures(one: Run, other: Run) -> dict[str, float]:
    """Relative difference of two runs in each observable that the first records.

    ``distance`` of the `spectrum` without bin 0, in the maximum norm, and in L2 of `wear` (all
    rods, mean over each eighth of the chord, the coarser profile linear between its rods),
    `history` (samples of the recorded places that both have), `states` and `force_peak` (all rounds
    and eighths of the chord). Inf where only one run has a result, or where neither has and they
    end with different statuses; nan where neither has and they end with the same.
    """
    names = one.record.observables
    ends = [run.outcome.status for run in (one, other)]
    if not all(end in WITH_RESULT for end in ends):
        return dict.fromkeys(names, nan if ends[0] == ends[1] else inf)
    samples = min(run.record.samples_per_round for run in (one, other))
    rods = max(run.outcome.wear.shape[1] for run in (one, other))
    return {
        name: distance(
            *(_values(run, name, samples, rods) for run in (one, other)),
            order=inf if name == "spectrum" else 2,
        )
        for name in names
    }


def _values(run: Run, name: str, samples: int, rods: int) -> NDArray[np.float64]:
    """The observable's numbers in one run, at ``samples`` and ``rods`` per round."""
    record, outcome = run.record, run.outcome
    every = record.samples_per_round // samples
    thinned = slice(every - 1, None, every)  # the first lies a sample after the start
    if name == "wear":
        return on_rods(by_share(outcome.wear, outcome.ends), rods)
    if name == "spectrum":  # with the samples of both runs thinned alike: aliasing is the same
        return spectrum(outcome.u_r[thinned][-record.spectrum_rounds * samples :, 0])[1:]
    if name == "history":
        return outcome.u_r[thinned][:, 1:]
    return outcome.states[thinned] if name == "states" else outcome.force_peak
