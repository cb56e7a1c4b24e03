"""What users read of a run, at places and on shares of the chord, and its errors."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from simulate.compare import error
from simulate.observables import amplitude, lobe_count, on_rods, spectrum
from simulate.places import by_share
from simulate.run import Outcome

OBSERVABLES = ("amplitude", "Omega_c", "wear", "lobes", "force", "history")
JUDGED = ("amplitude", "wear", "force", "history")  # what the worst error is of
FIRST_ROUNDS = 5
SPECTRUM_ROUNDS = 10

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Read:
    """What users read of a run."""

    amplitude: float  # m, ||Y|| at xi = 1/16
    wear: Array  # (shares, nu), m, mean depth over each eighth of the chord
    lobes: int  # of the eighth most worn
    force: float  # N, largest on any eighth
    history: Array  # (samples,), m, u_r at xi = 1/16, first rounds
    Omega_c: float | None = None  # over f1(0), where speeds were swept


def last_amplitude(u: Array, samples: int) -> float:
    """||Y|| of u (time,), m, over the last rounds."""
    return float(amplitude(spectrum(u[-SPECTRUM_ROUNDS * samples :]), SPECTRUM_ROUNDS))


def read(outcome: Outcome, samples: int) -> Read:
    """Read a run that recorded u_r from its start, and the contact force."""
    u, worn = outcome.u_r[:, 0], by_share(outcome.wear, outcome.ends)
    return Read(
        amplitude=last_amplitude(u, samples),
        wear=worn,
        lobes=lobe_count(worn[worn.sum(axis=1).argmax()]),
        force=float(np.nanmax(outcome.force_peak)),
        history=u[: FIRST_ROUNDS * samples],
    )


def errors(run: Read, reference: Read) -> dict[str, float | None]:
    """Errors by observable, each over the reference; of lobes the difference of their counts."""
    wear = on_rods(run.wear, reference.wear.shape[1])
    return {
        "amplitude": error(run.amplitude, reference.amplitude),
        "Omega_c": _where_both(run.Omega_c, reference.Omega_c),
        "wear": error(wear, reference.wear),
        "lobes": abs(run.lobes - reference.lobes),
        "force": error(run.force, reference.force),
        "history": error(run.history, reference.history),
    }


def worst(found: dict[str, float | None]) -> float:
    """Largest error of those that are judged; inf where one is missing."""
    values = [found[name] for name in JUDGED]
    return np.inf if None in values else float(max(values))


def summit(x: Array, y: Array) -> float | None:
    """Where the parabola through the largest y and its neighbours is highest; None at an end."""
    at = int(np.argmax(y))
    if at in (0, len(y) - 1):
        return None
    (left, middle), step = pairwise(y[at - 1 : at + 2]), x[at + 1] - x[at]
    rise, fall = left[1] - left[0], middle[1] - middle[0]
    return float(x[at] + step * (rise + fall) / (rise - fall) / 2)


def _where_both(value: float | None, reference: float | None) -> float | None:
    return None if value is None or reference is None else error(value, reference)
