"""Many runs: the rows of a design, and their two tables of numbers, by run and by row.

Rows that are done are kept in part files, each whole, under a hash of all that decides their
numbers: their scene, the reduced model, the code. Rows asked for next, in a larger design or in
another number of blocks, are run only if they are in no part.
"""

import json
from collections.abc import Callable, Iterable, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cached_property, partial
from itertools import chain
from operator import attrgetter
from pathlib import Path
from time import monotonic
from typing import Annotated, Any, Self

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from geometry.base import (
    ProvenanceError,
    Say,
    UserError,
    code_hash,
    fingerprint,
    progress,
    require_format,
    silent,
)
from geometry.blade import ORDERS
from geometry.stored import read, write as save
from rom.model import Rom
from simulate.contact.gaps import given_gaps
from simulate.errors.accuracy import Choice
from simulate.errors.checked import checked
from simulate.errors.observables import NUMBERS, last_spectrum, numbers
from simulate.errors.run import Run
from simulate.marching import STATUSES, WITH_RESULT, check_scene
from simulate.scene import LEADING, TRENDS, Scene
from simulate.scene.design import Design, refuse, value_at
from simulate.signals import amplitude
from simulate.sweeps import dataset
from simulate.sweeps.dataset import entry, require_numbers
from simulate.sweeps.over_speeds import check_steps, march_one, set_up
from simulate.sweeps.peak import Responses, only_at
from simulate.sweeps.sweep import further
from simulate.sweeps.unusual import doubts, warn_of

SAVED_EVERY = 120.0  # s: lost at most when the process is killed, and one row
FORMAT = 2


def _flags(words: Sequence[str]) -> dict[str, Any]:
    """Attributes that name the codes of a variable."""
    named = " ".join(word.replace(" ", "-") for word in words)
    return {"flag_values": np.arange(len(words), dtype=np.int8), "flag_meanings": named}


SINGLE = np.float32
LEADING_WEAR = ("wear", "wear_mean", "wear_anywhere")
FORCES = ("force_peak", "force_mean", "force_tangential_mean")
UNKNOWN = "; nan without record.contact_force"
COLUMNS = {  # numbers of each run: type, unit, meaning
    "speed": (np.float64, "rad s-1", "rotational speed Omega"),
    "speed_over_f1": (np.float64, "1", "Omega over f1(0)"),
    "status": (np.int8, "1", "how the run ended", _flags(STATUSES)),
    "rounds": (SINGLE, "1", "revolutions computed"),
    "trend": (np.int8, "1", "whether the motion is steady at the end", _flags(TRENDS)),
    "time_constant": (SINGLE, "1", "revolutions in which the mode that responds dies out to 1/e"),
    "displacement": (SINGLE, *NUMBERS["displacement"]),
    "largest_round": (SINGLE, "1", "number of the revolution of the displacement"),
    "end_xi": (SINGLE, "1", "chord fraction where a run ended early; else nan"),
    "f1": (SINGLE, "1", "f1(Omega) over f1(0)"),
    "amplitude": (SINGLE, "m", "largest amplitude of u_r at xi = 1/16; nan without spectrum"),
    **{name: (SINGLE, *NUMBERS[name]) for name in LEADING_WEAR},
    "lobes": (np.int16, *NUMBERS["lobes"]),
    **{name: (SINGLE, NUMBERS[name][0], NUMBERS[name][1] + UNKNOWN) for name in FORCES},
    "contact_share": (SINGLE, "1", "steps with contact over all steps"),
    "casing_work": (SINGLE, "J", "work of the casing on the rods"),
    "numerical": (SINGLE, "J", "energy created (> 0) or lost (< 0) by the scheme"),
    "departure": (SINGLE, "1", "largest relative difference from the twin run; nan without"),
    "error": (SINGLE, "1", "largest relative error, estimated; nan of runs that are not checked"),
    "seconds": (SINGLE, "s", "wall time of the run and of its second runs"),
    "amplitudes": (SINGLE, "m", "amplitude of u_r at xi = 1/16 along each engine order"),
}
ALWAYS = {"speed", "speed_over_f1", "f1", "wear", "wear_mean", "contact_share", "casing_work"}


@dataclass(frozen=True)
class Engine:
    """Runs the rows of one design on one reduced model."""

    design: Design
    rom: Rom
    choice: Choice | None
    scenes: list[Scene]  # of the rows, as they are run
    orders: list[int]  # engine orders whose amplitudes are kept: 1, 2, ...
    sought: list[int]  # those whose peaks its rows tell

    @classmethod
    def of(cls, design: Design, rom: Rom, choice: Choice | None = None) -> Self:
        """Check all rows against the reduced model.

        ``choice``: step, rods and strips of all rows, chosen for the accuracy of the base scene.

        Raises
        ------
        geometry.base.errors.SettingsError
            When scenes do not fit the model: one line for each fault, with its rows.
        """
        choice = choice and replace(choice, runs={})  # the pilot's runs are those of the base
        scenes = [choice.scene(scene) for scene in design.scenes] if choice else design.scenes
        asked = {k for scene in scenes for k in (scene.peaks and scene.peaks.orders) or ()}
        sought = sorted({*ORDERS, *asked})
        farthest = max(chain(*(scene.casing.orders for scene in scenes)), default=0)
        highest = min(sought[-1] + farthest, *(scene.record.highest_order for scene in scenes))
        engine = cls(design, rom, choice, scenes, [*range(1, highest + 1)], sought)
        engine.require(range(len(scenes)), partial(check_scene, rom=rom))
        warnings: dict[str, str] = {}
        for row, scene in enumerate(scenes, start=1):
            for key, line in doubts(scene, rom).items():
                warnings.setdefault(key, f"row {row}: {line}")
        warn_of(warnings.values())
        return engine

    def require(self, rows: Iterable[int], check: Callable[[Scene], None]) -> None:
        """Refuse the faults that ``check`` finds in the scenes of ``rows`` (from 0).

        Raises
        ------
        geometry.base.errors.SettingsError
            When there are some: one line for each fault, with its rows.
        """
        faults = []
        for row in rows:
            try:
                check(self.scenes[row])
            except UserError as error:
                faults += [(row + 1, fault) for fault in error.faults]
        refuse(self.design.path, faults)

    @cached_property
    def keys(self) -> list[str]:
        """Hash of all that decides the numbers of each row."""
        choice = self.choice.plain() if self.choice else None
        shared = [self.rom.provenance.hash, code_hash(__name__), choice, self.orders]
        return [fingerprint([*shared, scene.model_dump_json()]) for scene in self.design.scenes]

    @property
    def row_type(self) -> np.dtype:
        """Structured type of the numbers of a run."""
        lengths = {"amplitudes": (len(self.orders),)}
        return np.dtype(
            [(name, kind, lengths.get(name, ())) for name, (kind, *_) in COLUMNS.items()]
        )

    def march_row(self, scene: Scene, budget: float) -> tuple[NDArray, float]:
        """Numbers of the runs of one row, speeds ascending, closed in on the peaks asked for.

        And the steps that checks of other rows may take, with the ``budget`` of those before.
        """
        runs, table, speeds = [], self._table([]), scene.speeds.omega(self.rom.f1).tolist()
        seen = {}
        while speeds:
            new = [
                march_one(set_up(scene, self.rom, Omega, self.choice), self.choice)
                for Omega in speeds
            ]
            runs, table = runs + new, np.sort(np.append(table, self._table(new)), order="speed")
            if not scene.peaks:
                break
            of, added = self.responses(table, scene), len(runs) - scene.speeds.count
            speeds = further(
                scene.peaks, table["speed"], of, partial(of.series, place=LEADING), seen, added
            )
        runs, budget = checked(runs, scene.checked_share, budget)
        return self._table(runs), budget

    def _table(self, runs: Iterable[Run]) -> NDArray:
        """Numbers of ``runs``, speeds ascending."""
        numbers = np.array([_numbers(run, self.orders) for run in runs], self.row_type)
        return np.sort(numbers, order="speed")

    def responses(self, runs: NDArray, scene: Scene) -> Responses:
        """Amplitudes of a row along engine orders, at the place of u_r alone, gaps."""
        told = np.zeros(len(runs), int)
        along = runs["amplitudes"].astype(float) / given_gaps(scene.gaps, self.rom, LEADING)
        return Responses(self.rom, scene, runs["speed_over_f1"], told, *only_at(told, along))


def _numbers(run: Run, orders: Sequence[int]) -> tuple:
    """Numbers of a run by column; nan where it has not recorded them."""
    outcome = run.outcome
    values = numbers(run) | {
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


def read_parts(folder: Path, row_type: np.dtype) -> dict[str, NDArray]:
    """Numbers of all rows that are done, by key; those of other engines may lack some.

    These are left out, as are parts that are damaged or of another version: their rows are run
    again.
    """
    done = {}
    for path in sorted(folder.glob("[!.]*.nc")):  # others are being written
        with suppress(ProvenanceError):
            table = load(path)
            runs, row = _runs(table, row_type), table["row"].values
            keys = json.loads(table.attrs.get("keys", "[]"))
            done |= {key: runs[row == number] for number, key in enumerate(keys, 1)}
    return done


def save_part(folder: Path, rows: dict[str, NDArray], orders: Sequence[int]) -> None:
    """Write one more part, of ``rows`` by key."""
    table = _table(dict(enumerate(rows.values(), 1)), orders)
    save(table.assign_attrs(keys=json.dumps([*rows])), folder / f"{fingerprint([*rows])}.nc")


def march_block(
    engine: Engine,
    folder: str | Path,
    block: int = 0,
    blocks: int = 1,
    report: Say = silent,
) -> xr.Dataset:
    """Runs of every ``blocks``-th row from ``block`` on; rows in parts of ``folder`` are not run.

    Raises
    ------
    geometry.base.errors.SettingsError
        When the step of a row is above its limit, before any run.
    """
    folder, keys, rows = Path(folder), engine.keys, range(block, len(engine.scenes), blocks)
    done = read_parts(folder, engine.row_type)
    missing = [i for i in rows if keys[i] not in done]
    engine.require(missing, partial(check_steps, rom=engine.rom, choice=engine.choice))
    once, new, begun = {keys[i]: i for i in missing}, {}, monotonic()  # rows may stand twice
    saved, budget = begun, 0.0  # steps for checks
    try:
        for count, (key, i) in enumerate(once.items(), 1):
            new[key], budget = engine.march_row(engine.scenes[i], budget)
            done[key] = new[key]
            far = progress.remaining(count, len(once), monotonic() - begun)
            report(f"{_line(i + 1, done[key])}; design {far}")
            if monotonic() - saved > SAVED_EVERY:
                save_part(folder, new, engine.orders)
                new, saved = {}, monotonic()
    finally:  # an error or Ctrl-C loses no row that is done
        if new:
            save_part(folder, new, engine.orders)
    table = _table({i + 1: done[keys[i]] for i in rows}, engine.orders)
    return table.assign_attrs(_attributes(engine))


def _line(row: int, runs: NDArray) -> str:
    """Line of the log for a row."""
    ok = int((runs["status"] == STATUSES.index("ok")).sum())
    return f"row {row}: {len(runs)} runs, {ok} ok, {runs['seconds'].sum():.2f} s"


def _attributes(engine: Engine) -> dict[str, Any]:
    attrs = dataset.attributes(engine.design.base, engine.rom, engine.choice)
    of_design = {"format": FORMAT, "design": engine.design.path.name}
    # rows may differ in their gap
    return {name: value for name, value in attrs.items() if name != "gap_m"} | of_design


def merge(blocks: Sequence[xr.Dataset]) -> xr.Dataset:
    """The runs of all blocks, by row, then by speed."""
    return xr.concat(blocks, dim="run", combine_attrs="override").sortby(["row", "speed"])


def row_table(engine: Engine, runs: xr.Dataset) -> xr.Dataset:
    """Numbers of each row: its peaks along engine orders and the values there, its extremes."""
    numbers, of_row = _runs(runs, engine.row_type), runs["row"].values
    rows = [
        _of_row(engine, scene, numbers[of_row == row]) for row, scene in enumerate(engine.scenes, 1)
    ]
    variables = {
        name: entry(dims, np.array([row[name] for row in rows]), *about)
        for name, (dims, *about) in ROW_COLUMNS.items()
    }
    for column in engine.design.columns:
        values = [value_at(scene, column) for scene in engine.design.scenes]
        variables[column] = "row", _plain(values), {"long_name": "given"}
    coords = {"row": np.arange(1, len(rows) + 1), "order": engine.sought}
    attrs = _attributes(engine)
    if sobol := engine.design.sobol:
        meaning = "factors on values of the scene"
        variables["factors"] = entry(("row", "factor"), sobol.points(), "1", meaning)
        coords["factor"] = [*sobol.factors]
        attrs["sobol"] = sobol.model_dump_json()
    return xr.Dataset(variables, coords, attrs)


AT_PEAK = ("row", "order")
ROW_COLUMNS = {  # numbers of each row: dimensions, unit, meaning
    "critical_speed": (AT_PEAK, "1", "Omega_c of the peak along each order, over f1(0)"),
    "over_crossing": (AT_PEAK, "1", "Omega_c over the linear crossing of f1 with the order"),
    "peak": (AT_PEAK, "1", "amplitude of u_r at the peak over the gap at xi = 1/16"),
    "reported": (AT_PEAK, "1", "1 for peaks that figures and tables name"),
    "status": (AT_PEAK, "1", "how the run at the peak ended; -1 without a peak", _flags(STATUSES)),
    "trend": (AT_PEAK, "1", "whether the motion is steady at the peak; -1: none", _flags(TRENDS)),
    "wear": (AT_PEAK, "m", COLUMNS["wear"][-1] + ", at the peak"),
    "lobes": (AT_PEAK, "1", "worn lobes at the peak; -1 without a peak"),
    "force_peak": (AT_PEAK, *COLUMNS["force_peak"][1:]),
    "gap": (("row",), "m", "initial gap at xi = 1/16"),
    "runs": (("row",), "1", "runs, with those added around peaks"),
    "not_ok": (("row",), "1", "runs that ended otherwise than ok"),
    "largest_amplitude": (("row",), "m", "largest amplitude of all runs"),
    "largest_wear": (("row",), "m", COLUMNS["wear"][-1] + ", of all runs"),
}


OF_PEAK = {"critical_speed": "Omega_c", "over_crossing": "over_crossing", "peak": "amplitude"}
NO_PEAK = {
    "status": -1,
    "trend": -1,
    "wear": np.nan,
    "lobes": -1,
    "force_peak": np.nan,
}  # of no run


def _of_row(engine: Engine, scene: Scene, runs: NDArray) -> dict[str, Any]:
    """Numbers of a row, and of its peaks and the runs that stand there, by engine order."""
    of = engine.responses(runs, scene)
    along = partial(of.series, place=LEADING)
    of_order = {peak.k: peak for peak in sorted(of.stand_out(), key=attrgetter("amplitude"))}
    peaks = [of_order.get(k) or of.near_f1(k, along) for k in engine.sought]
    at_peaks = [runs[peak.index] if peak else NO_PEAK for peak in peaks]
    return {
        **{name: [getattr(peak, key, np.nan) for peak in peaks] for name, key in OF_PEAK.items()},
        "reported": [int(peak is not None and peak.reported) for peak in peaks],
        **{name: [run[name] for run in at_peaks] for name in NO_PEAK},
        "gap": float(given_gaps(scene.gaps, engine.rom, LEADING)),
        "runs": len(runs),
        "not_ok": int((runs["status"] != STATUSES.index("ok")).sum()),
        "largest_amplitude": np.fmax.reduce(runs["amplitude"]),
        "largest_wear": runs["wear"].max(),
    }


def _plain(values: Sequence[Any]) -> NDArray:
    """Numbers, nan for None, where all values are numbers; else their text."""
    if all(value is None or isinstance(value, int | float) for value in values):
        return np.array([np.nan if value is None else value for value in values], float)
    return np.array(["" if value is None else str(value) for value in values])


def _table(rows: dict[int, NDArray], orders: Sequence[int]) -> xr.Dataset:
    """Dataset of the runs of ``rows``, by their numbers."""
    runs = np.concatenate([*rows.values()])
    number = np.repeat([*rows], [len(table) for table in rows.values()]).astype(np.int32)
    variables = {"row": entry(("run",), number, "", "row of the design, from 1")}
    for name, (_, *about) in COLUMNS.items():
        variables[name] = entry(("run", "order")[: runs[name].ndim], runs[name], *about)
    return xr.Dataset(variables, {"order": [*orders]}, {"format": FORMAT})


def _runs(table: xr.Dataset, row_type: np.dtype) -> NDArray:
    """Structured array of a table of runs.

    Raises
    ------
    ProvenanceError
        When it has not the same columns.
    """
    shape = table["amplitudes"].shape[1:] if set(COLUMNS) <= set(table) else None
    if shape != row_type["amplitudes"].shape:
        raise ProvenanceError("has other columns than those of this design: run it again")
    runs = np.zeros(table.sizes["run"], row_type)
    for name in COLUMNS:
        runs[name] = table[name].values
    return runs


def load(path: str | Path) -> xr.Dataset:
    """Read a table.

    Raises
    ------
    ProvenanceError
        When it is missing, damaged, or none.
    """
    run_again = "delete it, and run the design again"
    with read(path, "table of runs", run_again) as table:
        require_format(table.attrs, FORMAT, path, run_again)
        _require_columns(table.load())
        return table


Rows = Annotated[xr.Dataset, load]  # an argument of a job, read by ``load`` from its path


def _require_columns(table: xr.Dataset) -> None:
    """Check the columns of a table of runs or of rows, as they are written.

    Raises
    ------
    KeyError, ValueError
        When one is missing, has other dimensions, or no number in a run that has a result.
    """
    of_runs = "run" in table.sizes
    dims = {name: axes for name, (axes, *_) in ROW_COLUMNS.items()}
    if of_runs:
        dims = dict.fromkeys(COLUMNS, ("run",)) | {"row": ("run",), "amplitudes": ("run", "order")}
    if "design" not in table.attrs:  # a part, of whatever columns, or made by hand
        dims = {name: axes for name, axes in dims.items() if name in table}
    with_result = [STATUSES.index(status) for status in WITH_RESULT]
    codes = range(-1, len(STATUSES))
    require_numbers(table, dims, codes, with_result, ALWAYS if of_runs else set())
