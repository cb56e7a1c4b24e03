"""Results at the peaks of a sweep, each with its changes by other runs and models.

At the speed of each peak the run is repeated with its contact force, and beside it

    a twin      with all gaps changed by 1e-10 (``errors.neighbours``)
    two runs    halfway to the neighbours in the sweep, of which the amplitude alone is taken
    two models  with all natural frequencies raised and lowered by the largest error that the check
                of the reduced model found; two more by that of the mesh, where it is known, at the
                same speed over f1 if the scene gives speeds so
    a coarser   reduced model, with fewer patches and modes (``rom.coarser``)
    a finer run of twice the steps, rods and strips; one of half of them is often too coarse for the
                order of their errors to hold

The uncertainty of a number is the root of the squares of these changes; that of the amplitude
includes the rise to the top of the resonance through the three speeds. A peak whose numbers jump
from model to model has two motions.

Where two motions are possible, the last digits of the model choose. Across such a jump the change
of the numbers stays as the difference of the models is halved; where the numbers are steep alone,
it is halved with it. Models whose frequencies differ by as much as a resonance is wide, as those of
coarse meshes do, are no last digits: between them the resonance itself passes the speed.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from itertools import chain, pairwise
from math import hypot, inf, isfinite, nan
from time import perf_counter, process_time
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from fem.worst_node import NodeStress
from geometry.base import Say, SettingsError, known, progress, silent
from geometry.blade import MODES, Fatigue
from geometry.tip import EDGES
from rom.coarser import coarser
from rom.measured import told
from rom.model import Rom, RomError
from simulate.errors.companion import FINER_TIMES, TIMES, Fineness, companion
from simulate.errors.model_errors import BEYOND, SHARE, ModelError, SecondOrder
from simulate.errors.neighbour import CHAOTIC, ONE_MOTION, TWO_MOTIONS, Neighbour
from simulate.errors.neighbours import ITSELF, TWIN, raised
from simulate.errors.observables import Numbers, numbers
from simulate.errors.run import Case, Run, as_long
from simulate.errors.schema import CONTACT, MOTION, STRESS, of_peaks
from simulate.marching import SENSITIVE_FROM, WITH_RESULT, prepare
from simulate.marching.states import every
from simulate.scene import LEADING, OF_LAST_ROUNDS, Scene
from simulate.signals import gaps_at_ends, leading_gap, leading_wear, lobe_count
from simulate.sweeps.continued import before
from simulate.sweeps.dataset import checks, course, scene_of, statuses
from simulate.sweeps.peak import Peak, Responses, peaks_or_largest, rise
from simulate.sweeps.result_types import OfBlades
from simulate.sweeps.whirls import whirls

JUMP_FROM = 0.05  # relative change between two models from which a jump is looked for
LAST = 3e-3  # relative, of frequencies: the last digits of a model; a usual damping ratio
HALVINGS = 4  # of their difference: the change of a steep number falls to some sixteenth
JUMPS = 0.5  # share of the change that is left across a jump
TELL_APART = ("amplitude", "worn_volume")  # numbers that tell one motion from another
# of the largest change of a run's numbers: that of one may pass through zero, as where its errors
# of step and strips cancel
LEAST_PART = 1 / 3


def results(
    runs: xr.Dataset,
    rom: Rom,
    model_error: ModelError,
    start: xr.Dataset | None = None,
    report: Say = silent,
    second_order: SecondOrder | None = None,
    stress: Mapping[str, Any] | None = None,
    peaks: Sequence[Peak] | None = None,
) -> list[Peak]:
    """The reported peaks of a sweep with their results; without any, where it responds most.

    ``second_order``, ``stress``: of the blade, and as of ``workflow.stress.write``, where known;
    ``peaks``: others than those reported.

    ``start``: as of ``sweep.sweep``. Runs in turn are not repeated: their numbers have no
    uncertainty.
    """
    scene = to_march(runs, stress)
    start_at = before(scene, rom, start)
    peaks = asked(runs, rom) if peaks is None else peaks
    done_peaks, start_of_all = [], perf_counter()
    for done, peak in enumerate(peaks, 1):
        begun = process_time()
        if peak.status in WITH_RESULT and not scene.speeds.in_turn:
            case = case_of(runs, scene, rom, peak)
            case = replace(case, start=start_at(case.setup.Omega))
            if peak.k and not peak.at_end:
                peak = _with_rise(peak, case, runs, stress)
            peak = _with_errors(peak, case, model_error, stress)
            if second_order is not None:
                peak = _with_second_order(peak, case, second_order, runs.attrs["gap_m"])
        peak = replace(peak, seconds=process_time() - begun)
        far = progress.remaining(done, len(peaks), perf_counter() - start_of_all)
        report(
            f"{peak.name or 'no peak'} at {peak.Omega_c:.4f} f1(0), {peak.verdict or peak.status}: "
            f"{peak.runs} runs, {peak.seconds:.2f} s; peak {far}"
        )
        done_peaks.append(peak)
    return done_peaks


def worst_stressed(
    runs: xr.Dataset, stress: Mapping[str, Any] | None, peaks: Sequence[Peak]
) -> list[Peak]:
    """The speed of the worst ``stress``, as a peak along no order; none where it is one of them."""
    speeds = runs["speed_over_f1"].values
    indices = np.flatnonzero(speeds == (stress or {}).get("worst"))
    others = (int(index) for index in indices if index not in {peak.index for peak in peaks})
    status = runs["status"].values.astype(str)
    return [Peak(None, i, float(speeds[i]), status=status[i].item()) for i in others]


def of_sweep(
    runs: xr.Dataset,
    rom: Rom,
    model_error: ModelError,
    peaks: Sequence[Peak],
    worst: Sequence[Peak] = (),
) -> dict[str, Any]:
    """Results of a sweep with its names and units, as plain values for JSON.

    ``worst``: that of ``worst_stressed``, with its results.
    """
    of = scene_of(runs)
    return {
        "scene": runs.attrs.get("name", ""),
        "blade": runs.attrs["blade"],
        "f1_Hz": runs.attrs["f1_Hz"],
        "gap_m": runs.attrs["gap_m"],
        "status": dict(sorted(statuses(runs).items())),
        "checks": checks(runs),
        "sweep_s": float(runs["seconds"].sum()),
        "dofs": rom.n,
        "model_error": model_error._asdict(),
        "swept": runs["speed_over_f1"].values[[0, -1]].tolist(),
        "seen": Responses.of(runs, rom).seen() if "spectrum" in runs else [],
        "half_bin": 0.5 / of.record.rounds_of_spectrum,
        "free": int(runs["free"].sum()) if "free" in runs else 0,
        "no_torque": of.no_torque,
        "mu_crit": float(runs["mu_crit"].min()) if "mu_crit" in runs else None,
        "reasons": sorted({*runs["reason"].values.astype(str)} - {""}) if "reason" in runs else [],
        "assumed": [*of.assumes, *told(rom)],
        "ends": ends(runs),
        "blades": of.stage.count if of.stage else 1,
        "whirls": whirls(rom, of.liner, of.casing, MODES),
        "peaks": [peak.plain() for peak in peaks],
        "worst": [peak.plain() for peak in worst],
    }


def ends(runs: xr.Dataset) -> list[dict[str, Any]]:
    """The first and the last run with a result: away from resonance, where the paper counts lobes.

    With the gaps there, m, of a scene that gives them at rest.
    """
    vary = scene_of(runs).gaps.vary
    indices = np.flatnonzero(runs["status"].isin(WITH_RESULT))
    return [
        {
            "over_f1": float(runs["speed_over_f1"][index]),
            "status": str(runs["status"].values[index]),
            "lobes": _lobes(runs, index),
            "gaps_m": gaps_at_ends(runs)[index].tolist() if vary else [],
        }
        for index in dict.fromkeys([*indices[:1], *indices[-1:]])
    ]


def _lobes(runs: xr.Dataset, index: int) -> int | None:
    """Lobes that a run has worn; None without a result, and where no wear is recorded."""
    run = runs.isel(speed_over_f1=index)
    counted = "wear" in runs and run["status"].item() in WITH_RESULT
    return lobe_count(leading_wear(run)) if counted else None


def to_march(runs: xr.Dataset, stress: Mapping[str, Any] | None = None) -> Scene:
    """The scene of a sweep for repeated runs at single speeds, with its contact force.

    It has the step, rods and strips that a sweep with an accuracy was run with; for its ``stress``
    its motion, and for the damage all states.
    """
    scene, unused = scene_of(runs), dict.fromkeys(OF_LAST_ROUNDS)
    blades = "all" if scene.stage else "worst"
    if stress:
        unused["motion"] = scene.record.motion
        if (stress["fatigue"] or {}).get("slope_k"):
            unused["states_rounds"] = scene.rounds
    return scene.but(
        verify={"share": 0.0, "predictable": False},
        peaks=None,
        record={**unused, "contact_force": True, "end": False, "blades": blades},
    )


def asked(runs: xr.Dataset, rom: Rom) -> list[Peak]:
    """The peaks of ``peaks_or_largest``, with what the sweep tells of them."""
    speeds = runs["speed_over_f1"].values  # ascending
    return [
        replace(
            peak,
            spacing=max(  # distance to the further neighbour
                np.diff(speeds[max(peak.index - 1, 0) : peak.index + 2]).tolist(), default=None
            ),
            status=str(runs["status"].values[peak.index]),
            lobes=_lobes(runs, peak.index),
            course=course(runs.isel(speed_over_f1=peak.index)),
        )
        for peak in peaks_or_largest(runs, rom)
    ]


def _with_rise(peak: Peak, case: Case, runs: xr.Dataset, stress: Mapping[str, Any] | None) -> Peak:
    """The peak with the rise of its amplitude to the top between the speeds, by two runs.

    And of its alternating stress, by which the margin falls. Halfway to its neighbours in the
    sweep. A run that goes on from another is there at the speeds of the sweep alone: then the rise
    is that through the peak and its neighbours.
    """
    three = slice(peak.index - 1, peak.index + 2)
    Omega, of = runs["speed"].values[three].copy(), Responses.of(runs, case.rom)
    along = of.series(known(peak.k, "k"), peak.place)[three].copy()
    at, alternating = at_node(stress, peak.index) if stress else None, np.full(3, nan)
    if case.start is None:
        Omega[::2] = (Omega[::2] + Omega[1]) / 2
        for side in (0, 2):
            setup = prepare(case.scene, case.rom, Omega[side], case.steps_of_a_turn)
            values = at_peak(replace(case, setup=setup), peak, at)
            along[side] = values.get("amplitude", nan) / leading_gap(runs)
            alternating[side] = values.get("alternating", nan)
    parts = {"speeds": {"amplitude": rise(Omega, along)}}
    if stress and at:
        alternating[1] = stress["speeds"][peak.index]["alternating"]
        parts["speeds"] |= dict.fromkeys(("alternating", "margin"), rise(Omega, alternating))
    return replace(peak, parts=parts, runs=0 if case.start else 2)


def _with_errors(
    peak: Peak, case: Case, model_error: ModelError, stress: Mapping[str, Any] | None
) -> Peak:
    """The peak with its numbers, their errors, and the verdict on it; stress has no part in that.

    ``stress``: as of ``results``.
    """
    runs, at = [ITSELF], at_node(stress, peak.index) if stress else None
    run = case.march()
    first = read(run, peak, at)

    def numbers_of(other: Neighbour, T: NDArray[np.float64] | None = None) -> Numbers:
        """Numbers of a second run, which is counted; u = T u' of its displacements u'."""
        runs.append(other)
        return at_peak(case.neighbour(other), peak, through(at, T))

    by_twin = {"twin": change(first, numbers_of(TWIN))}
    by_models, both = _of_models(first, numbers_of, case, model_error)
    parts = peak.parts | by_twin | by_models | _of_fineness(first, numbers_of, case)
    if peak.k and peak.at_end:
        parts["speeds"] = {"amplitude": inf}
    if stress and at:
        parts["stress"] = mesh_errors(stress, peak.index)
    chaotic = largest(parts["twin"]) > SENSITIVE_FROM
    return replace(
        peak,
        verdict=CHAOTIC if chaotic else TWO_MOTIONS if both else ONE_MOTION,
        numbers=first,
        blades=of_blades(run, peak) if len(run.outcome.blades) > 1 else None,
        errors={
            name: abs(value)
            * hypot(*filter(isfinite, (part.get(name, 0.0) for part in parts.values())))
            for name, value in first.items()
            if name in parts["twin"]  # no exact one
        },
        # of the run that differs most from the first
        other=max(both, key=lambda side: largest(change(first, side)), default={}),
        parts=parts,
        runs=peak.runs + len(runs),
    )


def _of_models(
    first: Numbers, numbers_of: Callable[[Neighbour], Numbers], case: Case, model_error: ModelError
) -> tuple[dict[str, Numbers], Sequence[Numbers]]:
    """Changes of the ``first`` numbers by models off by each known error; numbers of two motions.

    The latter from both sides of the first jump that is found.
    """
    parts, both = {}, ()
    along = case.scene.speeds.over_f1 is not None
    for name, error, moves in (
        ("model", model_error.basis, False),
        ("mesh", model_error.mesh, along),
    ):
        if error:
            by_share = {
                share: numbers_of(raised(share, moves)) if share else first
                for share in (-error, 0.0, error)
            }
            parts[name] = change(first, by_share[error], by_share[-error])
            both = both or sides(
                lambda share, moves=moves: numbers_of(raised(share, moves)), by_share
            )
    return parts, both


def _of_fineness(
    first: Numbers, numbers_of: Callable[..., Numbers], case: Case
) -> dict[str, Numbers]:
    """Errors that follow from the changes of the ``first`` numbers by runs of other fineness."""
    parts = {}
    for name, (other, times, T) in _of_other_fineness(case).items():
        changes = change(first, numbers_of(other, T))
        least = LEAST_PART * largest(changes)
        parts[name] = {number: max(size, least) / times for number, size in changes.items()}
    return parts


def _with_second_order(peak: Peak, case: Case, known: SecondOrder, gap: float) -> Peak:
    """The peak with the change of the tip's radius of second order over the ``gap``, m.

    Of the mode that responds, with the largest displacement where that is mode 1, which most of it
    is; of a higher mode with the amplitude along its order.
    """
    of_higher = peak.modes and 1 not in peak.modes
    name, setup = "amplitude" if of_higher else "displacement", case.setup
    motion = peak.numbers.get(name, nan)
    place = peak.place if of_higher else peak.course.get("place", LEADING)
    if place not in EDGES or not motion:
        return peak
    of_peak = setup.Omega, peak.k, place, motion
    second, axial = known.at_peak(case.rom, case.scene.casing, *of_peak)
    if not isfinite(second):
        return peak
    half = setup.places.width.mean() / 2
    error = 2 * second * peak.errors[name] / motion / gap
    return replace(
        peak,
        beyond=BEYOND if second > SHARE * motion or axial > half else "",
        numbers=peak.numbers | {"second_order": second / gap},
        errors=peak.errors | {"second_order": error},
    )


def case_of(runs: xr.Dataset, scene: Scene, rom: Rom, peak: Peak) -> Case:
    """The sweep's run at a peak, from rest, as long as there; ``scene``: as of ``to_march``."""
    names = ("speed", "steps_per_round", "rounds")
    Omega, steps, rounds = (float(runs[name][peak.index]) for name in names)
    return Case(as_long(scene, rounds), rom, prepare(scene, rom, Omega, int(steps)))


def at_peak(case: Case, peak: Peak, stress: NodeStress | None = None) -> Numbers:
    """Numbers of the run of a case along the order of a peak, as of ``read``."""
    return read(case.march(), peak, stress)


def read(run: Run, peak: Peak, stress: NodeStress | None = None) -> Numbers:
    """Numbers of a run along the order of a peak, at its place; none without result.

    Those of contact where there is any, of ``stress`` where it is known.
    """
    if run.outcome.status not in WITH_RESULT:
        return {}
    values = numbers(run, peak.k, peak.place if peak.k else None)
    kinds = {MOTION, *[CONTACT] * run.scene.liner.law.touches}
    told = {
        name: values[one.name]
        for name, one in of_peaks().items()
        if one.peak in kinds and one.name in values
    }
    return told | (stress_of(run, stress) if stress else {})


def of_blades(run: Run, peak: Peak) -> OfBlades:
    """Numbers of each blade of a stage in the run at a peak."""
    blades, stage = run.outcome.blades, known(run.scene.stage, "stage")
    each = [read(replace(run, outcome=blade), peak) for blade in blades]
    by_blade = [name for name, one in of_peaks().items() if one.by_blade]
    return {
        "worst": run.outcome.worst,
        "rub": [j for j, blade in enumerate(blades) if blade.contact_share],
        "longer": known(run.setup.stage, "stage").longer.tolist(),
        "frequencies": stage.relative.tolist(),
        "numbers": {
            name: [values[name] for values in each]
            for name in by_blade
            if all(name in values for values in each)
        },
    }


def at_node(stress: Mapping[str, Any], speed: int) -> NodeStress | None:
    """The stress over reduced displacements at the worst node of a speed; None if not told.

    ``stress``: as ``workflow.stress.write`` found it.
    """
    sigma, fatigue = stress["speeds"][speed].get("sigma"), stress["fatigue"]
    return sigma and NodeStress(np.array(sigma), fatigue and Fatigue.model_validate(fatigue))


def mesh_errors(stress: Mapping[str, Any], speed: int) -> Numbers:
    """Relative errors by the mesh there; that of the damage follows from the margin's."""
    errors, k = stress["speeds"][speed]["mesh"], (stress["fatigue"] or {}).get("slope_k")
    return errors | ({"damage": (1 - errors["margin"]) ** -k - 1} if k else {})


def through(at: NodeStress | None, T: NDArray[np.float64] | None) -> NodeStress | None:
    """The same over displacements u' (n',) of another model, u = T u'; the same without T."""
    if at is None or T is None:
        return at
    return NodeStress(np.vstack([at.sigma[:1], T.T @ at.sigma[1:]]), at.fatigue)


def stress_of(run: Run, at: NodeStress) -> Numbers:
    """Mean and alternating stress, Pa, and margin, of the worst revolution that a run keeps.

    And with a slope of the S-N line the damage of the run, whose states are all recorded.
    """
    outcome, record, setup = run.outcome, run.scene.record, run.setup
    states, samples = outcome.states, record.samples_per_round
    step = every(known(record.motion, "motion"), samples, setup.omega, setup.Omega)
    rounds = states.reshape(-1, samples, states.shape[1])[:, step - 1 :: step]
    strained = outcome.strained[outcome.strained_rounds > 0]
    of_rounds = map(with_rotation, [*rounds, *strained])
    slope = at.fatigue and at.fatigue.slope_k
    return at.worst(of_rounds) | ({"damage": at.damage(with_rotation(states))} if slope else {})


def with_rotation(u: NDArray[np.float64]) -> NDArray[np.float64]:
    """Amplitudes (times, 1 + n) of displacements (times, n): 1, of rotation, before them."""
    return np.hstack([np.ones((len(u), 1)), u])


def _of_other_fineness(
    case: Case,
) -> dict[str, tuple[Neighbour, float, NDArray[np.float64] | None]]:
    """Second runs of other fineness, and how many errors of the run each differs from it by.

    And T of u = T u', from displacements u' of another model. None where there are none. A rigid
    casing takes no more strips than patches: there one run is coarser in all.
    """
    if case.scene.stepping.scheme != "piecewise-exact" or case.start is not None:
        return {}
    try:
        coarse, T = coarser(case.rom)
        finer = Fineness.of(case.setup).finer().scene(case.scene)
    except (RomError, SettingsError):  # points, too few patches; more strips than are allowed
        return {}
    if case.scene.liner.rigid_key:
        return {"companion": (companion(case.setup, coarse), TIMES, T)}
    return {
        "patches": (Neighbour("fewer patches and modes", rom=lambda _: coarse), TIMES, T),
        "finer": (Neighbour("finer", scene=lambda _: finer), FINER_TIMES, None),
    }


def change(one: Numbers, *others: Numbers) -> Numbers:
    """Relative change of each number, over the larger; inf where one alone has it.

    But for those that are exact. The largest of those to the ``others``.

    >>> change({"amplitude": 1.0, "wear": 2.0}, {"amplitude": 2.0, "wear": 2.0})
    {'amplitude': 0.5, 'wear': 0.0}
    """
    exact = {name for name, known in of_peaks().items() if known.exact}
    names = [name for name in dict.fromkeys(chain(one, *others)) if name not in exact]
    return {
        name: max(_change(one.get(name), other.get(name)) for other in others) for name in names
    }


def _change(a: float | None, b: float | None) -> float:
    if a == b:
        return 0.0
    return inf if a is None or b is None else abs(a - b) / max(abs(a), abs(b))


def largest(changes: Numbers) -> float:
    """Largest change of the numbers of the motion, 0 without any.

    Without those that follow from others, as those of stress do, some steeply.
    """
    follow = {name for name, of in of_peaks().items() if of.follows or of.peak == STRESS}
    return max((size for name, size in changes.items() if name not in follow), default=0.0)


def sides(at: Callable[[float], Numbers], results: Mapping[float, Numbers]) -> Sequence[Numbers]:
    """Numbers on both sides of a jump between models; none without one.

    The interval with the larger change is halved, ``HALVINGS`` times. Changes are those of
    ``TELL_APART``. Models that differ by more than ``LAST`` are not looked between, but those that
    differ by that.

    Parameters
    ----------
    at : numbers of the model that differs by a share
    results : those at some shares, 0 among them

    >>> step = lambda share: {"amplitude": 1 + (share > 0.001) + share}
    >>> both = sides(step, {share: step(share) for share in (-1.0, 0.0, 1.0)})
    >>> sorted({round(of["amplitude"], 1) for of in both})
    [1.0, 2.0]
    """
    found = dict(results)
    if max(found) > LAST:
        found = {share: at(share) if share else found[0.0] for share in (-LAST, 0.0, LAST)}
    low, high = max(pairwise(sorted(found)), key=lambda ends: _across(found, *ends))
    first = _across(found, low, high)
    if first < JUMP_FROM:
        return ()
    for _ in range(HALVINGS):
        middle = (low + high) / 2
        found[middle] = at(middle)
        halves = (low, middle), (middle, high)
        low, high = max(halves, key=lambda ends: _across(found, *ends))
    return () if _across(found, low, high) < JUMPS * min(first, 1.0) else [*found.values()]


def _across(results: Mapping[float, Numbers], low: float, high: float) -> float:
    changes = change(results[low], results[high])
    return max(changes.get(name, 0.0) for name in TELL_APART)
