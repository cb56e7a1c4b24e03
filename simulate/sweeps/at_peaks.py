"""Answers at the peaks of a sweep, each with what it were if run or model were a little other.

At the speed of each peak the run is marched again with its contact force, and beside it

    a twin      with all gaps changed by 1e-10 (``errors.twin``)
    two models  with all natural frequencies raised and lowered by the largest error that the check
                of the reduced model found; two more by that of the mesh, where it is known, at the
                same speed over f1 if the scene gives speeds so
    a companion coarser in step, rods, strips, patches and modes (``errors.companion``)

The uncertainty of a number is the root of the squares of these changes. A peak whose numbers jump
from model to model is `bistable` (``errors.bistable``).
"""

from collections.abc import Callable
from dataclasses import asdict, dataclass, replace
from math import hypot
from pathlib import Path
from time import perf_counter, process_time
from typing import Any

import numpy as np
import xarray as xr

from geometry.project import progress
from rom.model import Rom, RomError
from rom.stored import opened
from simulate.contact.places import by_share
from simulate.errors.accuracy import Choice, mesh_errors
from simulate.errors.bistable import LAST, Numbers, change, jump, largest
from simulate.errors.companion import TIMES, Fineness, Models, coarser_run
from simulate.errors.loads import mean_force, mean_opening, torque_of_rounds, worn_volume
from simulate.errors.signals import amplitude, worn
from simulate.errors.twin import SENSITIVE_FROM, twin
from simulate.marching.run import Outcome, march
from simulate.marching.setup import Setup, prepare
from simulate.marching.start import Left, Worn
from simulate.marching.status import WITH_RESULT
from simulate.scene import Scene
from simulate.sweeps.before import before
from simulate.sweeps.dataset import last_spectrum, scene_of
from simulate.sweeps.over_speeds import Report, no_report
from simulate.sweeps.peak import Peak, peaks_of

UNITS = {  # of each number, and what it is
    "amplitude": ("m", "amplitude of u_r at xi = 1/16: along the engine order, or the largest"),
    "wear": ("m", "deepest wear, mean over the leading eighth of the chord"),
    "worn_volume": ("m3", "volume worn off the liner"),
    "opening": ("m", "mean opening of the clearance by wear"),
    "force_peak": ("N", "largest normal force on an eighth of the chord"),
    "force": ("N", "normal force on the chord, mean of the run"),
    "torque": ("N m", "torque on the rotor, mean of the run"),
}
TELL_APART = ("amplitude", "worn_volume")  # one motion from another
CLOSE = (-LAST, 0.0, LAST)
SETTLED, BISTABLE, CHAOTIC = "settled", "bistable", "not predictable"


@dataclass(frozen=True)
class Doubt:
    """What is not known of the natural frequencies of a model, relative."""

    basis: float | None  # largest error in the check of the reduced model; None without one
    mesh: float | None  # of the mesh; None where no coarser one was tried

    @classmethod
    def of(cls, check: str | Path, mesh: str | Path | None, rom: Rom) -> "Doubt":
        """From ``rom-check-*.nc``, and from ``mesh-error.json`` where there is one.

        A model from elsewhere has neither.

        Raises
        ------
        geometry.project.provenance.ProvenanceError
            When they belong to another model or mesh.
        """
        if rom.foreign:
            return cls(None, None)
        with opened(check) as (checked, provenance):
            provenance.require(rom.provenance, check)
            basis = float(np.abs(checked["reduced"] / checked["full"] - 1).max())
        errors = mesh_errors(mesh, rom) if mesh else None
        return cls(basis, errors and errors["frequencies"])


@dataclass(frozen=True)
class Answer:
    """Numbers at one peak, or where a sweep without a peak responds most."""

    k: int | None  # engine order; None without a peak
    speed_over_f1: float
    spacing_over_f1: float | None  # to the further neighbour in the sweep; None without one
    crossing: float | None  # linear, over f1(0)
    at_end: bool  # the sweep ends there, on the rise
    status: str
    word: str  # SETTLED, BISTABLE, CHAOTIC; empty where no other run was tried
    numbers: Numbers  # in the units of UNITS
    errors: dict[str, float | None]  # of each, in its unit; None where nothing is known
    other: Numbers  # of the other motion of a bistable peak; else empty
    parts: dict[str, Numbers]  # relative changes by twin, models, mesh and companion
    runs: int  # marched for it
    seconds: float  # CPU time


def numbers_of(scene: Scene, rom: Rom, setup: Setup, outcome: Outcome, k: int | None) -> Numbers:
    """The numbers of a run with its contact force; none where it has no result."""
    if outcome.status not in WITH_RESULT:
        return {}
    found: Numbers = {}
    if rounds := scene.record.spectrum_rounds:
        found["amplitude"] = float(amplitude(last_spectrum(scene.record, outcome), rounds, k))
    if scene.liner.law.touches:
        found |= _of_contact(scene, rom, setup, outcome)
    return found


def _of_contact(scene: Scene, rom: Rom, setup: Setup, outcome: Outcome) -> Numbers:
    where = outcome.wear, setup.places.width, setup.places.radius
    found = {
        "wear": worn(by_share(outcome.wear, outcome.ends)[0]).deepest,
        "worn_volume": float(worn_volume(*where)),
        "opening": float(mean_opening(*where)),
        "force_peak": float(np.nanmax(outcome.force_peak)),
        "force": float(mean_force(outcome.force_mean)),
    }
    if scene.no_torque is None:
        found["torque"] = float(np.nanmean(torque_of_rounds(scene, rom, outcome)))
    return found


def raised(rom: Rom, share: float) -> Rom:
    """The model with all natural frequencies higher by a ``share`` of themselves."""
    return replace(rom, K=rom.K * (1 + share) ** 2)


class _At:
    """Runs of a scene at one speed on models that differ a little; counts them."""

    def __init__(
        self,
        scene: Scene,
        rom: Rom,
        Omega: float,
        steps: int,
        k: int | None,
        left: Left | Worn | None,
    ) -> None:
        self.scene, self.rom, self.Omega, self.steps = scene, rom, Omega, steps
        self.k, self.left, self.runs = k, left, 0

    def numbers(
        self,
        share: float = 0.0,
        along: bool = False,
        change: Callable[[Setup], Setup] | None = None,
    ) -> Numbers:
        """Numbers with frequencies raised by a ``share``; the speed goes ``along`` or stays."""
        speed = self.Omega * (1 + share if along else 1)
        model = raised(self.rom, share) if share else self.rom
        setup = prepare(self.scene, model, min(speed, model.Omega_m), self.steps)
        setup = change(setup) if change else setup
        self.runs += 1
        return self._told(setup, march(self.scene, setup, self.left))

    def _told(self, setup: Setup, outcome: Outcome) -> Numbers:
        return numbers_of(self.scene, self.rom, setup, outcome, self.k)

    def of_companion(self) -> Numbers | None:
        """Numbers of the coarser companion; None where there is none."""
        liner, exact = self.scene.liner, self.scene.integrator.scheme == "piecewise-exact"
        if not exact or self.left is not None:
            return None
        try:
            models = Models.of(self.rom)
        except RomError:  # of points, or too few patches to leave some out
            return None
        fineness = Fineness(self.steps, liner.rods_per_round, liner.m)
        setup, run = coarser_run(self.scene, models, self.Omega, fineness)
        self.runs += 1
        return numbers_of(
            self.scene.but(record=run.record), models.coarse, setup, run.outcome, self.k
        )


def answers(
    runs: xr.Dataset,
    rom: Rom,
    doubt: Doubt,
    choice: Choice | None = None,
    start: xr.Dataset | None = None,
    report: Report = no_report,
) -> list[Answer]:
    """Answers at the reported peaks of a sweep; without any, where it responds most.

    ``choice`` and ``start``: as of ``closing_in.sweep``. Runs in turn are not marched again: their
    numbers have no uncertainty.
    """
    scene = to_march(runs, choice)
    left_at = before(scene, rom, start) if scene.start else lambda Omega: None
    found, peaks, start_of_all = [], asked(runs, rom), perf_counter()
    for done, (k, index, peak) in enumerate(peaks, 1):
        begun = process_time()
        answer = _of_sweep(runs, index, k, peak)
        if answer.status in WITH_RESULT and not scene.speeds.in_turn:
            Omega = float(runs["speed"][index])
            steps = int(runs["steps_per_round"][index])
            answer = _tried(answer, _At(scene, rom, Omega, steps, k, left_at(Omega)), doubt)
        answer = replace(answer, seconds=process_time() - begun)
        far = progress.left(done, len(peaks), perf_counter() - start_of_all)
        report(f"{told(answer)}: {answer.runs} runs, {answer.seconds:.2f} s; peak {far}")
        found.append(answer)
    return found


def of_sweep(runs: xr.Dataset, doubt: Doubt, found: list[Answer]) -> dict[str, Any]:
    """Answers of a sweep with its names and units, as plain values for JSON."""
    names, counts = np.unique(runs["status"].values.astype(str), return_counts=True)
    return {
        "scene": runs.attrs.get("name", ""),
        "blade": runs.attrs["blade"],
        "f1_Hz": runs.attrs["f1_Hz"],
        "gap_m": runs.attrs["gap_m"],
        "status": dict(zip(names.tolist(), counts.tolist(), strict=True)),
        "sweep_s": float(runs["seconds"].sum()),
        "doubt": asdict(doubt),
        "no_torque": scene_of(runs).no_torque,
        "mu_crit": float(runs["mu_crit"].min()) if "mu_crit" in runs else None,
        "answers": [asdict(answer) for answer in found],
    }


def told(answer: Answer) -> str:
    """Where the answer is, and its word."""
    of = f"k = {answer.k}" if answer.k else "no peak"
    return f"{of} at {answer.speed_over_f1:.4f} f1(0), {answer.word or answer.status}"


def to_march(runs: xr.Dataset, choice: Choice | None) -> Scene:
    """The scene of a sweep as it is marched again at single speeds, with its contact force."""
    scene = scene_of(runs)
    scene = choice.scene(scene) if choice else scene
    unused = dict.fromkeys(("history", "states_rounds", "motion"))
    record = unused | {"contact_force": True, "end": False}
    return scene.but(twin=False, halving=False, peaks=None, record=record)


def asked(runs: xr.Dataset, rom: Rom) -> list[tuple[int | None, int, Peak | None]]:
    """Engine order, index of the speed and peak of each answer."""
    peaks = peaks_of(runs, rom) if "spectrum" in runs else {}
    if found := [(k, peak.index, peak) for k, peak in peaks.items() if peak.reported]:
        return found
    with_result = np.flatnonzero(runs["status"].isin(WITH_RESULT))
    if len(with_result) == 0:
        return [(None, len(runs["speed"]) - 1, None)]
    return [(None, int(with_result[_response(runs)[with_result].argmax()]), None)]


def _response(runs: xr.Dataset) -> np.ndarray:
    """What of each run says how much it responds: amplitude, else wear, else work on the rods."""
    if "spectrum" in runs:
        return amplitude(runs["spectrum"].values, scene_of(runs).record.spectrum_rounds)
    if "wear" in runs:
        return runs["wear"].values.max(axis=(1, 2))
    return runs["ledger"].sel(energy="casing").values


def _of_sweep(runs: xr.Dataset, index: int, k: int | None, peak: Peak | None) -> Answer:
    """What the sweep itself knows."""
    speeds = runs["speed_over_f1"].values
    beside = np.abs(np.diff(speeds[max(index - 1, 0) : index + 2]))
    return Answer(
        k=k,
        speed_over_f1=float(speeds[index]),
        spacing_over_f1=float(beside.max()) if len(beside) else None,
        crossing=peak.crossing if peak else None,
        at_end=bool(peak and peak.at_end),
        status=str(runs["status"].values[index]),
        word="",
        numbers={},
        errors={},
        other={},
        parts={},
        runs=0,
        seconds=0.0,
    )


def _tried(answer: Answer, at: _At, doubt: Doubt) -> Answer:
    """The answer with its numbers, their errors, and its word."""
    own = at.numbers()
    parts = {"twin": change(own, at.numbers(change=twin))}
    sides = None
    along = at.scene.speeds.over_f1 is not None
    for name, share, moves in (("model", doubt.basis, False), ("mesh", doubt.mesh, along)):
        if share:
            known = {0.0: own} | {s: at.numbers(s, moves) for s in (share, -share)}
            parts[name] = _larger(change(own, known[share]), change(own, known[-share]))
            sides = sides or _sides(at, known, moves)
    if (coarse := at.of_companion()) is not None:
        parts["companion"] = {n: of / TIMES for n, of in change(own, coarse).items()}
    chaotic = largest(parts["twin"]) > SENSITIVE_FROM
    return replace(
        answer,
        word=CHAOTIC if chaotic else BISTABLE if sides else SETTLED,
        numbers=own,
        errors={name: _error(parts, name) * value for name, value in own.items()},
        other=_further(own, sides) if sides else {},
        parts=parts,
        runs=at.runs,
    )


def _sides(at: _At, known: dict[float, Numbers], along: bool) -> list[Numbers] | None:
    """All numbers on both sides of a jump of those that tell motions apart; None without one.

    Models that differ by more than ``LAST`` are not looked between, but those that differ by that.
    """
    if max(known) > LAST:
        known = {share: known[0.0] if share == 0 else at.numbers(share, along) for share in CLOSE}
    apart = {share: _telling(of) for share, of in known.items()}

    def tried(share: float) -> Numbers:
        known[share] = at.numbers(share, along)
        return _telling(known[share])

    return None if jump(tried, apart) is None else list(known.values())


def _telling(numbers: Numbers) -> Numbers:
    return {name: numbers[name] for name in TELL_APART if name in numbers}


def _further(own: Numbers, tried: list[Numbers]) -> Numbers:
    """Numbers of the run that differs most from the own one."""
    return max(tried, key=lambda of: largest(change(own, of)))


def _larger(one: Numbers, other: Numbers) -> Numbers:
    return {name: max(one.get(name, 0.0), other.get(name, 0.0)) for name in one | other}


def _error(parts: dict[str, Numbers], name: str) -> float:
    """Relative uncertainty of a number: the root of the squares of its changes."""
    return hypot(*(changes.get(name, 0.0) for changes in parts.values()))
