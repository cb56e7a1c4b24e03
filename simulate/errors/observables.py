"""Observables and numbers of a run, and the relative differences of two runs.

Observables are arrays, and runs are compared by them: twins, half steps, companions, references.
Numbers are single values: those of peaks, of the tables of designs and of studies.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from math import ceil, inf, isfinite, nan
from typing import Any

import numpy as np
from numpy.linalg import norm
from numpy.typing import ArrayLike, NDArray

from geometry.tip import JUDGED
from simulate.contact.places import by_share
from simulate.errors.run import Run
from simulate.errors.schema import of_runs
from simulate.marching import WITH_RESULT
from simulate.signals import amplitude, on_rods, spectrum

# smaller root mean squares count as these in relative differences: m, but N for forces
LEAST = {"spectrum": 1e-9, "wear": 1e-9, "history": 1e-9, "states": 1e-9, "force_peak": 1e-2}

type Observables = dict[str, NDArray[np.float64]]
type Numbers = dict[str, float]


def observables(
    run: Run, samples: int | None = None, rods: int | None = None, blade: int | None = None
) -> Observables:
    """Records of a run, by name, at ``samples`` and ``rods`` per revolution (None: of the run).

    `spectrum` (bins,), m, without bin 0; `wear` (eighths, rods), m, mean over each eighth of the
    chord, linear between rods; `history` (time, places) and `states` (time, n), m; `force_peak`
    (revolutions computed, eighths), N. Of a stage spectrum and force of all blades, one after the
    other, and history and states of one ``blade`` (None: the worst).
    """
    record, outcome, each = run.scene.record, run.outcome, run.outcome.each_blade
    one = outcome if blade is None else each[blade]
    samples = samples or record.samples_per_round
    every = record.samples_per_round // samples
    thinned = slice(every - 1, None, every)  # the first lies a sample after the start

    readers = {
        # of the last revolutions; aliasing is the same where both runs are thinned alike
        "spectrum": lambda: np.concatenate(
            [
                spectrum(of.u_r[thinned][-record.rounds_of_spectrum * samples :, 0])[1:]
                for of in each
            ]
        ),
        "wear": lambda: on_rods(
            by_share(outcome.wear, outcome.ends), rods or outcome.wear.shape[1]
        ),
        "history": lambda: one.u_r[thinned][:, 1:],
        "force_peak": lambda: np.concatenate(
            [of.force_peak[: ceil(outcome.rounds)] for of in each]
        ),
        "states": lambda: one.states[thinned],
    }
    return {name: readers[name]() for name in record.observables}


def differences(
    one: Run, other: Run, compared: Iterable[str] = WITH_RESULT, neither: float = nan
) -> dict[str, float]:
    """Relative difference of two runs in each observable that the first records (``apart``).

    Runs may differ in samples, rods and strips. Inf where only one ends with a status of those
    ``compared``, or where neither does and they end with different ones; ``neither`` where neither
    does and they end with the same.
    """
    ends = [run.outcome.status for run in (one, other)]
    if not {*ends} <= {*compared}:
        return dict.fromkeys(one.scene.record.observables, neither if ends[0] == ends[1] else inf)
    samples = min(run.scene.record.samples_per_round for run in (one, other))
    rods = max(run.outcome.wear.shape[1] for run in (one, other))
    blade = next(
        (
            j
            for j in (one.outcome.worst, other.outcome.worst)
            if all(run.outcome.each_blade[j].recorded for run in (one, other))
        ),
        None,
    )
    return relative_differences(*(observables(run, samples, rods, blade) for run in (one, other)))


def relative_differences(one: Observables, other: Observables) -> dict[str, float]:
    """Relative difference of each observable in L2 (``distance``), over ``LEAST`` at least."""
    return {
        name: distance(values, other[name], LEAST[name] * np.sqrt(values.size))
        for name, values in one.items()
    }


def distance(one: NDArray[np.float64], other: NDArray[np.float64], least: float = 0.0) -> float:
    """L2 norm of the difference over the larger of both norms and ``least``; 0 for equal arrays.

    >>> distance(np.array([0.0, 9.0]), np.array([0.0, 10.0]))
    0.1
    """
    difference = norm(np.ravel(one - other))
    larger = max(norm(one), norm(other), least)
    return float(difference / larger) if difference else 0.0


def error(value: ArrayLike, reference: ArrayLike) -> float:
    """Relative error of ``value`` in L2: ||value - reference|| / ||reference||.

    >>> error([3.0, 4.5], [3.0, 4.0])
    0.1
    """
    return float(norm(np.ravel(np.subtract(value, reference))) / norm(np.ravel(reference)))


def last_spectrum(run: Run, place: float | None = None) -> NDArray[np.float32]:
    """Amplitudes of u_r at xi = 1/16 over the revolutions recorded, m, as files hold them.

    Or at a ``place`` of ``JUDGED``.
    """
    samples = run.scene.record.rounds_of_spectrum * run.scene.record.samples_per_round
    at = 0 if place is None else JUDGED.index(place)
    u_r = run.outcome.u_r if place is None else run.outcome.judged
    return spectrum(u_r[-samples:, at]).astype(np.float32)


@dataclass(frozen=True, kw_only=True)
class Readings(Run):
    """A run with what its numbers are read from; nan where it has none.

    ``k``: engine order of the amplitude, or f / Omega; without it the largest. ``place``: where, of
    ``JUDGED``, if it is not that of u_r. Wear is that of files, in single precision.
    """

    k: float | None = None
    place: float | None = None

    @property
    def amplitude(self) -> float:
        """Amplitude of u_r, m."""
        if self.outcome.status not in WITH_RESULT:
            return nan
        bins = last_spectrum(self, self.place)
        return float(amplitude(bins, self.scene.record.rounds_of_spectrum, self.k))

    @cached_property
    def wear(self) -> NDArray[np.float32]:
        """Worn depth (m, nu), m."""
        return self.outcome.wear.astype(np.float32)

    @cached_property
    def profile(self) -> NDArray[Any]:
        """Mean worn depth (nu,), m, of the leading eighth of the chord."""
        return by_share(self.wear, self.outcome.ends)[0]

    @property
    def strips(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Width and radius of the strips (m,), m."""
        return self.setup.places.width, self.setup.places.radius


def numbers(run: Run, k: float | None = None, place: float | None = None) -> Numbers:
    """The numbers of a run that it has recorded, as ``schema`` defines them.

    ``k``, ``place``: as of ``Readings``.
    """
    read = Readings(**vars(run), k=k, place=place)
    values = {
        name: one.of(read)
        for name, one in of_runs().items()
        if one.of and (not one.record or getattr(run.scene.record, one.record))
    }
    return {name: value for name, value in values.items() if isfinite(value)}
