"""Numbers of the study of accuracy and time: errors of a row against another.

Rows are those of workflow/experiments/trade.yaml and interface.yaml.
"""

from dataclasses import replace
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray
from scipy.sparse import diags

from fem.matrices import Matrices
from rom.basis import project
from rom.model import Rom
from rom.reconstruct import Basis
from simulate.errors.neighbours import TWIN
from simulate.errors.observables import (
    Observables,
    differences,
    error,
    numbers,
    observables,
)
from simulate.errors.run import Run
from simulate.signals import on_rods
from simulate.sweeps.peak import along_order, peak_of
from workflow.many.engine import Marched
from workflow.markdown import rounded

FIRST_ROUNDS = 5  # of the history
DIGITS = 4  # of errors
ORDERS = (4, 6)  # of the peaks of a sweep

type Row = dict[str, Any]  # plain values, of a JSON file


def errors(single: Run, reference: Marched | None) -> Row:
    """Status, steps per revolution, size of the model, and errors against the ``reference``.

    Relative errors, for lobes the difference of their numbers; None where either run has no result.
    """
    about = {
        "status": single.outcome.status,
        "steps": single.setup.steps,
        "n": single.rom.n,
        "patches": len(single.rom.xi),
    }
    if reference is None:
        return about
    sides = single, reference.single
    changes = _errors(*((observables(side), numbers(side)) for side in sides))
    both_ok = {side.outcome.status for side in sides} == {"ok"}
    return about | {
        "errors": {name: _plain(value) if both_ok else None for name, value in changes.items()}
    }


def _errors(
    run: tuple[Observables, dict[str, float]], reference: tuple[Observables, dict[str, float]]
) -> dict[str, float]:
    (one, run_numbers), (other, reference_numbers) = run, reference
    first = FIRST_ROUNDS * len(other["history"]) // len(other["force_peak"])
    return {
        "amplitude": error(amplitude(one), amplitude(other)),
        "wear": error(on_rods(one["wear"], other["wear"].shape[1]), other["wear"]),
        "volume": error(run_numbers["worn_volume"], reference_numbers["worn_volume"]),
        "lobes": abs(run_numbers["lobes"] - reference_numbers["lobes"]),
        "force": error(run_numbers["force_peak"], reference_numbers["force_peak"]),
        "history": error(one["history"][:first], other["history"][:first]),
    }


def changes(single: Run, reference: Marched | None) -> Row:
    """Errors against the ``reference``; without one the largest difference from the twin."""
    about = errors(single, reference)
    if reference is not None:
        return about
    twin = single.neighbour(TWIN).march()
    return about | {"largest": max(differences(single, twin).values())}


def amplitude(seen: Observables) -> float:
    """||Y||, m: the largest amplitude of the spectrum, which has no mean."""
    return float(seen["spectrum"].max())


def _plain(value: float) -> float | None:
    """A number of a JSON file, which has no nan."""
    return None if np.isnan(value) else rounded(value, DIGITS)


def at_peak(runs: xr.Dataset, rom: Rom, reference: Marched | None) -> Row:
    """Relative error of the critical speed of EO 4 against the ``reference``; None without one."""
    if reference is None:
        return {}
    ours, true = critical(runs, rom), critical(reference.runs, reference.rom)
    return {"errors": {"Omega_c": _plain(error(ours, true))}}


def critical(runs: xr.Dataset, rom: Rom) -> float:
    """Omega_c of EO 4 over f1(0): maximum of a parabola; nan where the peak is at an end."""
    peak = peak_of(runs, rom, ORDERS[0])
    if peak is None or peak.at_end:
        return np.nan
    around = slice(peak.index - 1, peak.index + 2)
    return summit(runs["speed_over_f1"].values[around], along_order(runs, ORDERS[0])[around])


def summit(x: NDArray[np.float64], y: NDArray[np.float64]) -> float:
    """Abscissa of the maximum of the parabola through three points (3,)."""
    a, b, _ = np.polyfit(x - x[1], y, 2)
    return float(x[1] - b / (2 * a))


def peaks(runs: xr.Dataset, rom: Rom, reference: Marched | None) -> Row:
    """Number of runs, and largest errors of the main peaks against the ``reference``, relative."""
    marches = {"marches": runs.sizes["speed_over_f1"]}
    if reference is None:
        return marches
    pairs = [(peak_of(runs, rom, k), peak_of(reference.runs, rom, k)) for k in ORDERS]
    return marches | {
        "errors": {
            name: _plain(max(error(getattr(a, name), getattr(b, name)) for a, b in pairs))
            for name in ("Omega_c", "amplitude")
        }
    }


def not_softened(rom: Rom, matrices: str, basis: str) -> Rom:
    """The reduced model without spin softening: K(Omega) + Omega^2 T^T P M P T.

    P projects on displacements in the plane of rotation, with which the centrifugal force grows.
    """
    M, K = Matrices.load(matrices).M, rom.K.copy()
    P = diags(np.tile([1.0, 1.0, 0.0], M.shape[0] // 3))
    K[1] += project(P @ M @ P, Basis.load(basis).T)
    return replace(rom, K=K)
