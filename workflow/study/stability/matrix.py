"""The stability matrix: verdict on each of its cases, as a plain run and with all checks.

right    Its status has a result, and every observable is within a tenth of the reference.
flagged  Its status says that it has no result, or none that can be relied on.
refused  Before the start, with one line for each fault.
wrong    None of these: silently wrong.
unjudged Its status has a result, but the two references differ, or have none.

A plain run is what a scene gives without further keys: the look at the still blade before it
(``errors.resolution``) and its status. All checks are those of a scene with `verify:
every`: its twin, and half its step or a quarter, which state an error of at most 0.1
(``errors.neighbours``). The reference is marched by both schemes with a fine step; the difference
of the two does not count as an error of the run.
"""

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from geometry.base import SettingsError, UserError, check_settings
from rom.model import Rom
from simulate.contact.ramp import ramp_of
from simulate.errors.checked import checked
from simulate.errors.neighbour import Neighbour
from simulate.errors.neighbours import judged as judged_run
from simulate.errors.observables import Observables, observables, relative_differences
from simulate.errors.resolution import check_resolution
from simulate.errors.run import Case as Marched, Run
from simulate.marching import (
    STATED,
    TO_THE_END,
    SceneError,
    Setup,
    check_scene,
    prepare,
)
from simulate.scene import CentralDifference, PiecewiseExact, Scene
from workflow.many.row import ComputedRow
from workflow.study.stability.cases import EXACT, EXPLICIT, SAMPLES, Case, draw

KINDS = ("plain", "default", "checked")  # verdicts on a case
FINE = 0.1  # largest step of the references over the limit
FINER, FINEST = 8, 5000  # least and largest ratio of the case's step to that of the references
# Bounds of the cost of a case
LIMITS = 3e4  # time marched over the limit step
STEPS = 4e5  # of a reference
RODS = 1.5e8  # rods passed in all steps of a reference
NO_REFERENCE = {"error": {}, "spread": {}, "accurate": None}

type Verdict = dict[str, str]  # `kind`, and `why`: status, or the key that was refused
type End = dict[str, Any]  # outcome of a case, as of ``judge_case``


class Ready(NamedTuple):
    """A valid case, cut to the time that is marched."""

    case: Marched
    finer: int  # ratio of its step to that of the references


def ready(case: Case, rom: Rom, longer: float = 1.0) -> Ready:
    """Check and prepare a case as a sweep does, and cut the time marched to bound its cost.

    ``longer``: times the bounds of the time marched.

    Raises
    ------
    SettingsError, SceneError
        When the case is refused.
    """
    without = {**case.scene, "contact": {**case.scene["contact"], "friction": None}}
    any_step = {"scheme": EXACT, "steps_per_round": SAMPLES}
    _, setup = _prepared(replace(case, scene=without), rom, any_step)
    limit = setup.limit or 2 / setup.omega.max()  # of the free blade for a rigid liner
    scene, setup = _prepared(case, rom, _integrator(case, rom, limit))
    times = min(max(FINER, int(np.ceil(setup.h / (FINE * limit)))), FINEST)
    marched = Marched(scene, rom, setup)
    return Ready(_cut(case, marched, longer * _seconds(limit, setup, times)), times)


def _prepared(case: Case, rom: Rom, integrator: Mapping[str, Any]) -> tuple[Scene, Setup]:
    """The case's scene and set-up with an integrator, checked."""
    values = {**case.scene, "blade": rom.provenance.blade, "integrator": integrator}
    scene = check_settings(Scene, values, "scene.yaml")
    check_scene(scene, rom)
    return scene, prepare(scene, rom, float(scene.speeds.omega(rom.f1)[0]))


def _integrator(case: Case, rom: Rom, limit: float) -> dict[str, Any]:
    """Settings of the integrator; ``limit`` of central differences, s."""
    if case.footprints:
        around = 2 * np.pi * rom.camber[:, 0].mean() / (case.scene["liner"]["footprint_mm"] / 1e3)
        steps = {"steps_per_round": max(int(around / case.footprints / SAMPLES), 1) * SAMPLES}
    elif case.scheme == EXPLICIT and case.as_fraction:
        steps = {"fraction_of_limit": case.step_over_limit}
    else:
        round_time = 1 / (case.scene["speeds"]["over_f1"][0] * rom.f1)
        of_round = round_time / (case.step_over_limit * limit) / SAMPLES
        steps = {"steps_per_round": max(round(of_round), 1) * SAMPLES}
    return {"scheme": case.scheme} | steps


def _seconds(limit: float, setup: Setup, times: int) -> float:
    """Simulated time that may be marched, s."""
    rods = len(setup.strips.g0) * (setup.strips.rods_covered + 10)  # 10: cost of a strip without
    return min(LIMITS * limit, setup.h / times * min(STEPS, RODS / rods))


def _cut(case: Case, of: Marched, seconds: float) -> Marched:
    """Cut to the rounds, or the part of the first, within ``seconds``; at least SAMPLES steps."""
    rounds = min(int(seconds / (of.setup.h * of.setup.steps)), of.scene.rounds)
    steps = of.setup.steps
    if rounds == 0:
        rounds, steps = 1, min(max(int(seconds / of.setup.h / SAMPLES), 1) * SAMPLES, steps)
    scene = of.scene.but(rounds=rounds, **case.grows(rounds))
    setup = replace(of.setup, steps=steps, ramp=ramp_of(scene.casing))
    return replace(of, scene=scene, setup=setup)


def references(of: Ready) -> tuple[Run, Run]:
    """Runs with a fine step by both schemes; by piecewise-exact alone at two steps.

    This for a rigid liner, and with friction.
    """
    exact, scene = _by(EXACT, of, of.finer), of.case.scene
    if scene.liner.rigid_key or scene.contact.friction is not None:
        return exact, _by(EXACT, of, 2 * of.finer)
    return exact, _by(EXPLICIT, of, of.finer)


def _by(scheme: str, of: Ready, times: int) -> Run:
    """March by ``scheme`` with a step ``times`` shorter."""
    by = CentralDifference if scheme == EXPLICIT else PiecewiseExact
    # steps_per_round is replaced by the steps of the set-up
    of_scheme = by(scheme=scheme, steps_per_round=SAMPLES)
    case = replace(of.case, scene=of.case.scene.but(integrator=of_scheme))
    return case.neighbour(Neighbour("a reference", steps=times)).march()


def judge_case(case: Case, rom: Rom) -> End:
    """March a case and its checks.

    Returns
    -------
    dict
        A verdict by each of ``KINDS``: of the `plain` run; by `default`, with a check where it
        touches, as of a sweep of one speed; `checked`, with all checks. And the `message` of a
        refusal; `steps` marched; `cost`, steps of the check by default over those of the run;
        whether there was `contact`; `bound` of the relative error, by all checks; `error`,
        relative, against the reference, whose own is `spread`; `accurate`: within a tenth of the
        reference, None without one.
    """
    try:
        of = ready(case, rom)
    except (SettingsError, SceneError) as error:
        not_marched = {"steps": 0, "cost": 0.0, "contact": False, "bound": {}} | NO_REFERENCE
        return dict.fromkeys(KINDS, _refused(error)) | {"message": str(error)} | not_marched
    run = judged_run(of.case.march())
    outcome = run.outcome
    exact = references(of) if outcome.status in TO_THE_END else ()
    (by_default,), _ = checked([run], run.scene.checked_share)
    alone, with_all = _refusal(run, halves=False), _refusal(run, halves=True)
    best = judged_run(replace(run, scene=run.scene.but(verify="every")))
    return {
        "plain": alone or _verdict(run, exact),
        "default": alone or _verdict(by_default, exact),
        "checked": with_all or _verdict(best, exact),
        "message": "",
        "steps": run.setup.steps * run.scene.rounds,
        "cost": 0.0 if alone else by_default.steps / run.steps - 1,
        "contact": outcome.contact_share > 0,
        "bound": best.errors,
        **_against(exact, run),
    }


def _refusal(run: Run, halves: bool) -> Verdict | None:
    """Refusal of the step of a run; None where it is not too long."""
    try:
        check_resolution(run.setup, run.scene.record.samples_per_round, halves)
    except SceneError as error:
        return _refused(error)
    return None


def _verdict(run: Run, exact: Sequence[Run]) -> Verdict:
    """Verdict on a judged run beside its references."""
    status = run.outcome.status
    if status not in ("ok", "no-contact"):
        return {"kind": "flagged", "why": status}
    accurate = _against(exact, run)["accurate"]
    return {"kind": {None: "unjudged", True: "right", False: "wrong"}[accurate], "why": status}


def _refused(error: UserError) -> Verdict:
    """A refusal is right where it names the keys that it is about."""
    named = all(fault.key for fault in error.faults)
    return {"kind": "refused" if named else "wrong", "why": error.key}


def _against(exact: Sequence[Run], run: Run) -> dict[str, Any]:
    """Errors of a run, difference of its references, and whether it is accurate."""
    if not exact:
        return NO_REFERENCE
    own, one, other = map(observables, (run, *exact))
    error, spread = (
        relative_differences(own, _nearest(own, one, other)),
        relative_differences(one, other),
    )
    usable = all(of.outcome.status in TO_THE_END for of in exact)  # checked by their difference
    known = usable and max(spread.values()) <= STATED
    accurate = max(error.values()) <= STATED if known else None
    return {"error": error, "spread": spread, "accurate": accurate}


def _nearest(own: Observables, one: Observables, other: Observables) -> Observables:
    """For each observable, the point between the two references that is closest to the run."""
    return {name: _closest_between(values, one[name], other[name]) for name, values in own.items()}


def _closest_between(
    own: NDArray[np.float64], one: NDArray[np.float64], other: NDArray[np.float64]
) -> NDArray[np.float64]:
    difference = (other - one).ravel()
    length = float(difference @ difference)
    share = float((own - one).ravel() @ difference) / length if length else 0.0
    return one + min(max(share, 0.0), 1.0) * (other - one)


def judged(number: int, rom: Rom) -> End:
    """The end of case ``number``, from 1, of the study."""
    return judge_case(draw(number - 1, len(rom.xi)), rom)


def counts(rows: Iterable[ComputedRow]) -> dict[str, Any]:
    """Counts of the cases, as plain runs, by default and with all checks; cost of the default."""
    ends = [row["numbers"] for row in rows]
    return {
        "cases": len(ends),
        **{name: _counts([(end[name], end) for end in ends]) for name in KINDS},
        "cost": sum(end["cost"] * end["steps"] for end in ends)
        / max(sum(end["steps"] for end in ends), 1),
        "checks": sum(end["cost"] > 0 for end in ends),
    }


def _counts(judged: list[tuple[Verdict, End]]) -> dict[str, Any]:
    """Counts by kind and why; right runs that were not let through, and errors of the wrong."""
    accurate = [(verdict, max(end["error"].values())) for verdict, end in judged if end["accurate"]]
    # a sensitive run may be accurate for these exact gaps, but it is not predictable
    stopped = [
        (verdict, error)
        for verdict, error in accurate
        if verdict["kind"] in ("flagged", "refused") and verdict["why"] != "sensitive"
    ]
    return {
        "kinds": Counter(verdict["kind"] for verdict, _ in judged),
        "why": {
            kind: Counter(verdict["why"] for verdict, _ in judged if verdict["kind"] == kind)
            for kind in ("right", "flagged", "refused", "wrong", "unjudged")
        },
        "right_in_contact": sum(v["kind"] == "right" and end["contact"] for v, end in judged),
        "accurate": len(accurate),
        "stopped": Counter(verdict["why"] for verdict, _ in stopped),
        # a bound is larger than the error: those right by little are stopped
        "well_accurate": sum(error <= STATED / 2 for _, error in accurate),
        "well_stopped": sum(error <= STATED / 2 for _, error in stopped),
        "wrong_by": sorted(
            max(end["error"].values()) for verdict, end in judged if verdict["kind"] == "wrong"
        ),
    }
