"""Observables of a run that are compared, and their errors."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from simulate.compare import error
from simulate.loads import worn_volume
from simulate.observables import amplitude, lobe_count, on_rods, spectrum
from simulate.places import Places, by_share
from simulate.run import Outcome

OBSERVABLES = ("amplitude", "Omega_c", "wear", "lobes", "force", "history")
JUDGED = ("amplitude", "wear", "force", "history")  # over which the largest error is taken
FIRST_ROUNDS = 5
SPECTRUM_ROUNDS = 10

Array = NDArray[np.float64]
type Errors = dict[str, float | None]  # by observable
type Row = dict[str, Any]  # plain values, of a JSON file


@dataclass(frozen=True)
class Read:
    """Observables of a run."""

    amplitude: float  # m, ||Y|| at xi = 1/16
    wear: Array  # (shares, nu), m, mean depth over each eighth of the chord
    volume: float  # m3, worn
    lobes: int  # on the eighth of the chord with most wear
    force: float  # N, largest on any eighth
    history: Array  # (samples,), m, u_r at xi = 1/16, first rounds
    Omega_c: float | None = None  # over f1(0); None without a sweep, nan without a peak


def last_amplitude(u: Array, samples: int) -> float:
    """||Y|| of u (time,), m, over the last rounds."""
    return float(amplitude(spectrum(u[-SPECTRUM_ROUNDS * samples :]), SPECTRUM_ROUNDS))


def read(outcome: Outcome, places: Places, samples: int, Omega_c: float | None = None) -> Read:
    """Observables of a run over ``places`` that recorded u_r from its start and contact forces."""
    u, worn = outcome.u_r[:, 0], by_share(outcome.wear, outcome.ends)
    return Read(
        amplitude=last_amplitude(u, samples),
        wear=worn,
        volume=float(worn_volume(outcome.wear, places.width, places.radius)),
        lobes=lobe_count(worn[worn.sum(axis=1).argmax()]),
        force=float(np.nanmax(outcome.force_peak)),
        history=u[: FIRST_ROUNDS * samples],
        Omega_c=Omega_c,
    )


def errors(run: Read, reference: Read) -> Errors:
    """Relative error of each observable; for lobes the difference of their numbers."""
    wear = on_rods(run.wear, reference.wear.shape[1])
    swept = run.Omega_c is not None and reference.Omega_c is not None
    return {
        "amplitude": error(run.amplitude, reference.amplitude),
        "Omega_c": error(run.Omega_c, reference.Omega_c) if swept else None,
        "wear": error(wear, reference.wear),
        "lobes": abs(run.lobes - reference.lobes),
        "force": error(run.force, reference.force),
        "history": error(run.history, reference.history),
    }


def rounded(of: Errors) -> Errors:
    """Errors rounded to four digits."""
    return {key: value if value is None else float(f"{value:.4g}") for key, value in of.items()}


def worst(of: Errors) -> float:
    """Largest error of the observables in ``JUDGED``; inf if one is missing."""
    values = [of[name] for name in JUDGED]
    return np.inf if None in values else float(max(values))
