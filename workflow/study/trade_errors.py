"""What users read of a run, on places and rods that runs of any fineness share, and its errors."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from simulate.observables import lobe_count, on_rods, spectrum

OBSERVABLES = ("amplitude", "Omega_c", "wear", "lobes", "force", "history")
JUDGED = ("amplitude", "wear", "force", "history")  # what the worst error is of
PLACES = 8  # places along the tip, those of eight nodes
FIRST_ROUNDS = 5
SPECTRUM_ROUNDS = 10

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Read:
    """What users read of a run."""

    amplitude: float  # m, ||Y|| at the place of node 1
    wear: Array  # (places, nu), m
    lobes: int  # of the place most worn
    force: float  # N, largest at any place, of an eighth of the tip
    history: Array  # (samples,), m, u_r at the place of node 1, first rounds
    Omega_c: float | None = None  # over f1(0), where speeds were swept


def shares(nodes: int) -> Array:
    """Chord shares (nodes,) at which interface nodes stand, each amid its share of the tip."""
    return (np.arange(nodes) + 0.5) / nodes


def to_places(nodes: int) -> Array:
    """Weights (places, nodes): linear between the nodes, and on beyond them."""
    at, places = shares(nodes), shares(PLACES)
    left = np.clip(np.searchsorted(at, places) - 1, 0, nodes - 2)
    beyond = (places - at[left]) * nodes
    weights = np.zeros((PLACES, nodes))
    rows = np.arange(PLACES)
    weights[rows, left] = 1 - beyond
    weights[rows, left + 1] = beyond
    return weights


def amplitude(u: Array, samples: int) -> float:
    """||Y|| of u (time,), m: largest beyond bin 0 over the last rounds."""
    return float(spectrum(u[-SPECTRUM_ROUNDS * samples :])[1:].max())


def read(u_r: Array, wear: Array, force_peak: Array, samples: int) -> Read:
    """Read a run that recorded u_r (time, nodes) from its start.

    ``force_peak`` (rounds, nodes), N, goes with a node's share of the tip; an eighth is told.
    """
    nodes = u_r.shape[1]
    weights = to_places(nodes)
    u, worn = u_r @ weights[0], weights @ wear
    return Read(
        amplitude=amplitude(u, samples),
        wear=worn,
        lobes=lobe_count(worn[worn.sum(axis=1).argmax()]),
        force=float(np.nanmax(force_peak @ weights.T)) * nodes / PLACES,
        history=u[: FIRST_ROUNDS * samples],
    )


def errors(run: Read, reference: Read) -> dict[str, float | None]:
    """Errors by observable, each over the reference; of lobes the difference of their counts."""
    wear = on_rods(run.wear, reference.wear.shape[1])
    return {
        "amplitude": _relative(run.amplitude, reference.amplitude),
        "Omega_c": _relative(run.Omega_c, reference.Omega_c),
        "wear": _departure(wear, reference.wear),
        "lobes": abs(run.lobes - reference.lobes),
        "force": _relative(run.force, reference.force),
        "history": _departure(run.history, reference.history),
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


def _relative(value: float | None, reference: float | None) -> float | None:
    if value is None or reference is None:
        return None
    return abs(value / reference - 1)


def _departure(value: Array, reference: Array) -> float:
    return float(np.linalg.norm(value - reference) / np.linalg.norm(reference))
