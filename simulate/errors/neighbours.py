"""Second runs beside a run: a twin, twice, half and a quarter of its step, models; its status.

A twin is the same run with all gaps changed by 1e-10, far less than any manufacturing tolerance.
The computation is deterministic, so that only this change makes the two differ. Where they differ
by more than 1 %, the motion is chaotic: the results hold for these exact gaps only, and another
blade's will differ. Reference: Shaw and Holmes 1983, a periodically forced piecewise linear
oscillator.

The error of the step is bounded by runs with twice, half and, in doubt, a quarter of it. Central
differences are of order one in contact: halving the step halves the error, so that the error is
twice the change. Piecewise-exact is of order two: its error is 4/3 of the change, but at long steps
on hard liners its order is lower, too. The bound is that of order one for both, with a safety
factor of 1.5 (Roache 1994, grid convergence index). A run with twice the step costs a quarter of
one with half of it.

A bound with such a factor stops runs that are right by little, and of two runs no order can be
seen. So in doubt a third run takes a quarter of the step. By order one the error is 4/3 of the
change to it, and its own error is the change by the last halving: the bounds are 1.3 and 2 times
these.

On stiff liners long steps agree before they resolve the fast modes that contact excites: changes
fall first, then grow. So an eighth of the step confirms what a quarter has found where the quarter
is within its bound and the run is not, where the change to it is larger than that before, and with
`verify: every`. Where the change is larger again, the bounds are of one that goes on so. Where the
eighth is within its bound and the run is not, it is the result.

A contact shorter than a step may be seen, or missed, by both runs alike, since they share every
second instant. Its steps then are as many in both, though the time in contact should be the same:
the share of steps with contact tells. Not in central differences, whose rods throw the tip back
within few steps at any step near their limit.

Where rods pass the tip in time with the steps, errors may repeat at half the step. So runs with
twice and half of it have one rod more; in doubt the third, which has the rods of the run, decides.
"""

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial
from math import inf, isfinite

import numpy as np

from rom.model import Rom
from simulate.errors.neighbour import Neighbour
from simulate.errors.observables import differences
from simulate.errors.resolution import LOST, footprints_passed
from simulate.errors.run import Run
from simulate.marching import SENSITIVE_FROM, STATED, TO_THE_END, SceneError, Setup, status
from simulate.scene import Scene

GAP_CHANGE = 1e-10  # of the gaps: a million times round-off, a millionth of any tolerance
# Bounds of the error over the change by twice, half, a quarter and an eighth of the step
OF_TWICE, OF_HALF, OF_QUARTER, OF_EIGHTH = 1.5, 3.0, 1.75, 1.5
LAST_HALVING = 2.0  # and of that of the shortest step over the change from twice that,
GROWING = 3.0  # or where changes grow from one halving to the next
# bounds above which shorter steps decide: of twice the step, and of half the step
NEAR, AGREE = STATED / 2, STATED / 5
TWICE = 0.5  # steps of a run with twice the step over those of the run
CONTACT_CHANGE = 0.25  # relative, of the share of steps with contact: above, it is `inaccurate`


def shifted(setup: Setup) -> Setup:
    """``setup`` with every gap g0 changed by ``GAP_CHANGE`` of the widest gap or distortion."""
    g0, d = setup.strips.g0, setup.strips.d
    change = GAP_CHANGE * max(g0.max(), np.abs(d).max())  # all gaps may be 0
    return replace(setup, strips=setup.strips._replace(g0=g0 + change))


def one_rod_more(scene: Scene, samples: int | None = None) -> Scene:
    """The scene with one rod more around the casing, and so many ``samples`` per revolution."""
    changes = {
        "record": {"samples_per_round": samples or scene.record.samples_per_round},
        "liner": {"rods_per_round": scene.liner.nu + 1},
    }
    return scene.model_copy(
        update={key: getattr(scene, key).model_copy(update=value) for key, value in changes.items()}
    )


ITSELF = Neighbour("as it is")
TWIN = Neighbour("a twin (all gaps changed by 1e-10)", setup=shifted)
HALF = Neighbour("half the step", one_rod_more, steps=2, cost=2.0)
QUARTER = Neighbour("a quarter of the step", steps=4, cost=4.0)
EIGHTH = Neighbour("an eighth of the step", steps=8, cost=8.0)


def raised(share: float, along: bool = False) -> Neighbour:
    """The run on a model with all natural frequencies higher by a ``share`` of themselves."""
    changed = partial(_raised, share=share, along=along)
    return Neighbour(f"frequencies by {share:g}", rom=changed, along=along)


def _raised(rom: Rom, share: float, along: bool) -> Rom:
    # f1(0), by which speeds and tables of thermal growth may be given, stays where the speed does
    f1 = rom.f1 * (1 + share) if along else rom.f1
    return replace(rom, K=rom.K * (1 + share) ** 2, f1=f1)


def judged(run: Run, accurate: bool = True, check: bool = False) -> Run:
    """March the second runs that the scene asks for beside a run, and decide on its status.

    ``accurate``: whether the errors that it has are within its ``accuracy``. ``check``: bound the
    error of its step, by twice the step where that is enough, else as with `verify: every`. Where
    only an eighth of the step converges, its run is the result. A run without second runs and
    errors may lose less energy (``resolution``).
    """
    marched = [run := replace(run, outcome=status.judged(run.outcome))]

    def march_second(other: Neighbour) -> Run:
        """March a second run, and keep it for the count of steps."""
        marched.append(run.neighbour(other).march())
        return marched[-1]

    result, bound = _from_second_runs(run, march_second, check)
    departure, outcome = max(result.departures.values(), default=0.0), result.outcome
    lost = status.LOST if result.errors else LOST[run.scene.stepping.scheme]
    verdict = status.judged(outcome, departure, bound, accurate, lost)
    reason = outcome.reason if verdict.status == outcome.status else ""
    return replace(
        result,
        scene=run.scene,  # that of a second run does not end where it is steady
        outcome=replace(verdict, reason=reason),
        steps=run.steps
        + sum(each.outcome.rounds * each.setup.steps for each in marched[bool(run.steps) :]),
    )


def _from_second_runs(
    run: Run, march_second: Callable[[Neighbour], Run], check: bool
) -> tuple[Run, float]:
    """The run, or that in its place, with what second runs find; the bound that counts."""
    errors, bound, departures = run.errors, 0.0, run.departures
    ended = run.outcome.status in TO_THE_END
    # two steps that agree are no proof
    long = run.outcome.contact_share > 0 and footprints_passed(run.setup) > 1
    doubtful = ended and (run.scene.halves or (check and long))
    if check and ended and not doubtful:
        errors, bound = from_twice(run, march_second)
        doubtful = bound > NEAR
    if doubtful:
        half = march_second(HALF)
        errors, bound = _against(run, half, OF_HALF)
        doubtful = bound > AGREE or long
    if not departures and (run.scene.twins or (check and doubtful)):
        departures = differences(run, march_second(TWIN))
    result, departure = run, max(departures.values(), default=0.0)
    if doubtful and not departure > SENSITIVE_FROM:  # nan of runs without a result
        result, errors, bound = _in_doubt(run, half, march_second)
    return replace(result, errors=errors, departures=departures), bound


def from_twice(
    run: Run, march_second: Callable[[Neighbour], Run]
) -> tuple[dict[str, float], float]:
    """Bounds of errors from a run with twice the step, and the one that counts.

    The latter is inf where such a step may be too long for the scheme, friction, the samples, or
    the blades of a stage.
    """
    scene, steps, samples = run.scene, run.setup.steps, run.scene.record.samples_per_round
    samples //= 1 + steps // samples % 2
    if (
        (scene.stepping.scheme == "central-difference" and 2 * run.setup.h > run.setup.limit)
        or scene.contact.friction is not None
        or steps % (2 * samples)
    ):
        return {}, inf
    thinned = partial(one_rod_more, samples=samples)
    longer = Neighbour("twice the step", thinned, steps=TWICE, cost=TWICE)
    try:
        return _against(run, march_second(longer), OF_TWICE)
    except SceneError:  # of a stage, whose blades would come too near each other in a step
        return {}, inf


def _in_doubt(
    run: Run, half: Run, march_second: Callable[[Neighbour], Run]
) -> tuple[Run, dict[str, float], float]:
    """What a quarter of the step finds, as of ``from_shorter``; an eighth where that is unsure."""
    first, quarter = differences(run, half, neither=inf), march_second(QUARTER)
    found = result, _, bound = from_shorter(run, half, quarter)
    if bound > STATED or not (
        run.scene.halves
        or result is quarter
        or from_shorter(run, half, quarter, first)[-1] > STATED  # changes grow
    ):
        return found
    return from_shorter(run, quarter, march_second(EIGHTH), differences(half, quarter, neither=inf))


def from_shorter(
    run: Run, longer: Run, shorter: Run, before: Mapping[str, float] | None = None
) -> tuple[Run, dict[str, float], float]:
    """The run, bounds of its errors from one of a ``shorter`` step, and the one that counts.

    Or in its place the shorter one, if the bound is above 0.1, and that one's not. ``longer``: one
    of twice the shorter step; ``before``: change to it by the halving before, where that counts.
    """
    errors, bound = _against(run, longer, OF_HALF)
    if isfinite(bound):
        errors, bound = _against(run, shorter, OF_QUARTER if before is None else OF_EIGHTH)
    finer, of_finer = _against(shorter, longer, LAST_HALVING)
    for name, change in (before or {}).items():
        if finer[name] > LAST_HALVING * change:
            finer[name] *= GROWING / LAST_HALVING
            errors[name] = max(errors[name], errors[name] / OF_EIGHTH + finer[name])
    bound, of_finer = max(bound, *errors.values()), max(of_finer, *finer.values())
    return (shorter, finer, of_finer) if bound > STATED >= of_finer else (run, errors, bound)


def _against(run: Run, other: Run, safety: float) -> tuple[dict[str, float], float]:
    """Bounds of the errors of a run, ``safety`` times its difference, and the one that counts.

    The largest; inf where one fails, where they end differently, and where the share of steps with
    contact differs by over a quarter.
    """
    errors = {name: safety * value for name, value in differences(run, other, neither=inf).items()}
    same = run.outcome.status == other.outcome.status and not _other_contact(run, other)
    return errors, max(errors.values()) if same else inf


def _other_contact(run: Run, other: Run) -> bool:
    """Whether the steps in contact are not as many times more as all steps are."""
    shares = [sum(blade.contact_share for blade in of.outcome.each_blade) for of in (run, other)]
    chatters = run.scene.stepping.scheme == "central-difference"
    return not chatters and abs(shares[1] - shares[0]) > CONTACT_CHANGE * max(shares)
