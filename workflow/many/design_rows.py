"""The numbers of a row of a design: of its runs, and of its peaks; and the tables of all rows."""

from collections.abc import Iterable, Sequence
from functools import cache, partial
from operator import attrgetter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from geometry.blade import ORDERS
from rom.model import Rom
from simulate.contact.gaps import given_gaps
from simulate.errors.checked import checked
from simulate.errors.observables import last_spectrum, numbers as numbers_of
from simulate.errors.run import Run
from simulate.errors.schema import of_runs
from simulate.marching import STATUSES, WITH_RESULT, check_scene
from simulate.scene import LEADING, TRENDS, Scene
from simulate.signals import amplitude
from simulate.sweeps import dataset
from simulate.sweeps.over_speeds import check_steps, march_one, set_up
from simulate.sweeps.peak import Responses, only_at
from simulate.sweeps.sweep import further
from simulate.sweeps.unusual import doubts, warn_of
from workflow.many.engine import Shared


def _flags(words: Sequence[str]) -> dict[str, Any]:
    """Attributes that name the codes of a variable."""
    named = " ".join(word.replace(" ", "-") for word in words)
    return {"flag_values": np.arange(len(words), dtype=np.int8), "flag_meanings": named}


SINGLE = np.float32
COLUMNS = {  # numbers of each run: type, unit, meaning
    "speed": (np.float64, "rad s-1", "rotational speed Omega"),
    "speed_over_f1": (np.float64, "1", "Omega over f1(0)"),
    "status": (np.int8, "1", "how the run ended", _flags(STATUSES)),
    "rounds": (SINGLE, "1", "revolutions computed"),
    "trend": (np.int8, "1", "whether the motion is steady at the end", _flags(TRENDS)),
    "time_constant": (SINGLE, "1", "revolutions in which the mode that responds dies out to 1/e"),
    "largest_round": (SINGLE, "1", "number of the revolution of the displacement"),
    "end_xi": (SINGLE, "1", "chord fraction where a run ended early; else nan"),
    "f1": (SINGLE, "1", "f1(Omega) over f1(0)"),
    "amplitude": (SINGLE, "m", "largest amplitude of u_r at xi = 1/16; nan without spectrum"),
    **{name: (one.design, *one.said) for name, one in of_runs().items() if one.design},
    "contact_share": (SINGLE, "1", "steps with contact over all steps"),
    "casing_work": (SINGLE, "J", "work of the casing on the rods"),
    "numerical": (SINGLE, "J", "energy created (> 0) or lost (< 0) by the scheme"),
    "departure": (SINGLE, "1", "largest relative difference from the twin run; nan without"),
    "error": (SINGLE, "1", "largest relative error, estimated; nan of runs that are not checked"),
    "seconds": (SINGLE, "s", "wall time of the run and of its second runs"),
    "amplitudes": (SINGLE, "m", "amplitude of u_r at xi = 1/16 along each engine order"),
}
ALWAYS = {"speed", "speed_over_f1", "f1", "wear", "wear_mean", "contact_share", "casing_work"}


@cache  # one for all rows: it takes kilobytes
def run_type(orders: int) -> np.dtype:
    """Structured type of the numbers of a run, with amplitudes along engine orders 1, 2, ..."""
    lengths = {"amplitudes": (orders,)}
    return np.dtype([(name, kind, lengths.get(name, ())) for name, (kind, *_) in COLUMNS.items()])


def numbers(scene: Scene, rom: Rom, shared: Shared) -> dict[str, Any]:
    """Numbers of the runs of a row, speeds ascending, and of its peaks; plain values.

    The runs are closed in on the peaks that the scene asks for. Checks take their share of the
    steps of the rows of a block together.

    Raises
    ------
    geometry.base.errors.UserError
        When the scene does not fit its model.
    """
    scene = shared.choice.scene(scene) if shared.choice else scene
    check_scene(scene, rom)
    check_steps(scene, rom, shared.choice)
    new = {key: line for key, line in doubts(scene, rom).items() if key not in shared.warned}
    shared.warned |= {*new}
    warn_of(f"row {shared.row}: {line}" for line in new.values())
    sought = sorted({*ORDERS, *((scene.peaks and scene.peaks.orders) or ())})
    farthest = max(scene.casing.orders, default=0)
    orders = range(1, min(sought[-1] + farthest, scene.record.highest_order) + 1)
    runs, shared.budget = checked(
        _marched(scene, rom, shared, orders), scene.checked_share, shared.budget
    )
    table = _of_runs(runs, orders)
    of_row = _of_row(scene, rom, table, sought)
    plain = [[*single, along.tolist()] for *single, along in table.tolist()]
    return {"runs": plain, "sought": sought, "row": list(of_row.values())}


def _marched(scene: Scene, rom: Rom, shared: Shared, orders: Sequence[int]) -> list[Run]:
    """Runs of a row, with those around its peaks."""
    runs, table, seen = [], _of_runs([], orders), {}
    speeds = scene.speeds.omega(rom.f1).tolist()
    while speeds:
        cases = (set_up(scene, rom, Omega, shared.choice) for Omega in speeds)
        new = [march_one(case, shared.choice) for case in cases]
        runs += new
        if not scene.peaks:
            break
        table = np.sort(np.append(table, _of_runs(new, orders)), order="speed")
        of, added = _responses(scene, rom, table), len(runs) - scene.speeds.count
        along = partial(of.series, place=LEADING)
        speeds = further(scene.peaks, table["speed"], of, along, seen, added)
    return runs


def _of_runs(runs: Iterable[Run], orders: Sequence[int]) -> NDArray:
    """Numbers of ``runs``, speeds ascending."""
    table = np.array([_numbers(run, orders) for run in runs], run_type(len(orders)))
    return np.sort(table, order="speed")


def _responses(scene: Scene, rom: Rom, runs: NDArray) -> Responses:
    """Amplitudes of a row along engine orders, at the place of u_r alone, gaps."""
    told = np.zeros(len(runs), int)
    along = runs["amplitudes"].astype(float) / given_gaps(scene.gaps, rom, LEADING)
    return Responses(rom, scene, runs["speed_over_f1"], told, *only_at(told, along))


def _numbers(run: Run, orders: Sequence[int]) -> tuple:
    """Numbers of a run by column; nan where it has not recorded them."""
    outcome = run.outcome
    values = numbers_of(run) | {
        "speed": run.setup.Omega,
        "speed_over_f1": dataset.over_f1(np.array(run.setup.Omega), run.rom),
        "status": STATUSES.index(outcome.status),
        "rounds": outcome.rounds,
        "trend": TRENDS.index(outcome.trend),
        "time_constant": outcome.time_constant,
        "largest_round": outcome.each.largest[1],
        "end_xi": outcome.xi,
        "f1": run.setup.omega[0] / run.rom.omega1,
        "contact_share": outcome.contact_share,
        "casing_work": outcome.ledger.casing,
        "numerical": outcome.ledger.numerical,
        "departure": max(run.departures.values(), default=np.nan),
        "error": max(run.errors.values(), default=np.nan),
        "seconds": run.seconds,
        "amplitudes": _amplitudes(run, orders),
    }
    return tuple(values.get(name, np.nan) for name in COLUMNS)


def _amplitudes(run: Run, orders: Sequence[int]) -> NDArray[np.floating]:
    """Amplitudes along ``orders``; nan without a spectrum."""
    rounds = run.scene.record.spectrum_rounds
    if not rounds or run.outcome.status not in WITH_RESULT:
        return np.full(len(orders), np.nan)
    bins = last_spectrum(run)[: (max(orders) + 1) * rounds]  # fewer, the same maxima
    return np.array([amplitude(bins, rounds, k) for k in orders])


AT_PEAK, OF_ROW = ("row", "order"), ("row",)
ROW_COLUMNS = {  # numbers of each row: dimensions, type, unit, meaning
    "critical_speed": (AT_PEAK, float, "1", "Omega_c of the peak along each order, over f1(0)"),
    "over_crossing": (AT_PEAK, float, "1", "Omega_c over the linear crossing of f1 with the order"),
    "peak": (AT_PEAK, float, "1", "amplitude of u_r at the peak over the gap at xi = 1/16"),
    "reported": (AT_PEAK, int, "1", "1 for peaks that figures and tables name"),
    "status": (AT_PEAK, int, "1", "how the run at the peak ended; -1: no peak", _flags(STATUSES)),
    "trend": (AT_PEAK, int, "1", "whether the peak's motion is steady; -1: none", _flags(TRENDS)),
    "wear": (AT_PEAK, float, "m", COLUMNS["wear"][2] + ", at the peak"),
    "lobes": (AT_PEAK, int, "1", "worn lobes at the peak; -1 without a peak"),
    "force_peak": (AT_PEAK, float, *COLUMNS["force_peak"][1:]),
    "f1_Hz": (OF_ROW, float, "Hz", "f1(0) of the blade"),
    "gap": (OF_ROW, float, "m", "initial gap at xi = 1/16"),
    "runs": (OF_ROW, int, "1", "runs, with those added around peaks"),
    "not_ok": (OF_ROW, int, "1", "runs that ended otherwise than ok"),
    "largest_amplitude": (OF_ROW, SINGLE, "m", "largest amplitude of all runs"),
    "largest_wear": (OF_ROW, SINGLE, "m", COLUMNS["wear"][2] + ", of all runs"),
}
OF_PEAK = {"critical_speed": "Omega_c", "over_crossing": "over_crossing", "peak": "amplitude"}
NO_PEAK = {"status": -1, "trend": -1, "wear": np.nan, "lobes": -1, "force_peak": np.nan}
NO_ROW = NO_PEAK | dict.fromkeys(("reported", "runs", "not_ok"), 0)  # others are nan


def _of_row(scene: Scene, rom: Rom, runs: NDArray, sought: Sequence[int]) -> dict[str, Any]:
    """Numbers of a row, and of its peaks and the runs that stand there, by engine order."""
    of = _responses(scene, rom, runs)
    along = partial(of.series, place=LEADING)
    of_order = {peak.k: peak for peak in sorted(of.stand_out(), key=attrgetter("amplitude"))}
    peaks = [of_order.get(k) or of.near_f1(k, along) for k in sought]
    at_peaks = [runs[peak.index] if peak else NO_PEAK for peak in peaks]
    found = {
        **{name: [getattr(peak, key, np.nan) for peak in peaks] for name, key in OF_PEAK.items()},
        "reported": [int(peak is not None and peak.reported) for peak in peaks],
        **{name: [float(run[name]) for run in at_peaks] for name in NO_PEAK},
        "f1_Hz": rom.f1,
        "gap": float(given_gaps(scene.gaps, rom, LEADING)),
        "runs": len(runs),
        "not_ok": int((runs["status"] != STATUSES.index("ok")).sum()),
        "largest_amplitude": float(np.fmax.reduce(runs["amplitude"])),
        "largest_wear": float(runs["wear"].max()),
    }
    return {name: found[name] for name in ROW_COLUMNS}


@cache
def row_type(orders: int) -> np.dtype:
    """Structured type of the numbers of a row, of whose peaks ``orders`` are sought."""
    return np.dtype(
        [
            (name, kind, (orders,) * (axes == AT_PEAK))
            for name, (axes, kind, *_) in ROW_COLUMNS.items()
        ]
    )
