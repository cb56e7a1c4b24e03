"""Sweeps of drawn scenes with the default share of checks: each reported peak is right or flagged.

Twelve speeds about the crossings of the first mode with EO 3 and 4. Peaks, or the largest response
where there is none, above a hundredth of the gap, are compared with references at their speed
(``matrix``). Silently wrong is an amplitude off by over a tenth in a run that is `ok`.
"""

from dataclasses import replace
from typing import Any

from rom.model import Rom
from simulate.errors.checked import checked
from simulate.errors.observables import LEAST, numbers as numbers_of
from simulate.errors.run import Run
from simulate.marching import STATED, WITH_RESULT, SceneError, check_scene
from simulate.sweeps.over_speeds import as_sweep, at_speeds, check_steps
from simulate.sweeps.peak import along_order
from simulate.sweeps.peak_results import asked
from workflow.study.stability.cases import Case, draw
from workflow.study.stability.matrix import Ready, ready, references

MIDDLE, SPEEDS = 0.31, {"first": 0.24, "last": 0.38, "count": 12}  # over f1(0)
SPECTRUM, MOST = 4, 8  # revolutions of the spectrum, and of a run
LONGER = 30.0  # than a case of the matrix, whose bounds are less than a revolution
RESPONSE = 0.01  # gaps: peaks below are none
RECORD = {"samples_per_round": 64, "spectrum_rounds": SPECTRUM}


def judged(number: int, rom: Rom) -> dict[str, Any]:
    """Peaks of the sweep of case ``number``, from 1, beside their references.

    And the steps of its checks over those of its runs.

    Raises
    ------
    UserError
        When the case is refused, or cannot be swept.
    """
    of = _whole(draw(number - 1, len(rom.xi)), rom)
    scene = of.case.scene
    runs = at_speeds(scene, rom, scene.speeds.omega(rom.f1))
    found, _ = checked(runs, scene.checked_share)
    sweep = as_sweep(found, check=False)
    beside = [
        _beside(of, runs[peak.index], found[peak.index], peak.k)
        for peak in asked(sweep, rom)
        if along_order(sweep, peak.k)[peak.index] > RESPONSE
    ]
    share = sum(run.steps for run in found) / sum(run.steps for run in runs) - 1
    return {"peaks": [peak for peak in beside if peak["error"] is not None], "share": share}


def _whole(case: Case, rom: Rom) -> Ready:
    """The case as a sweep.

    Raises
    ------
    UserError
        When it is refused, or its revolutions are too costly.
    """
    at_middle = replace(case, scene=case.scene | {"speeds": {"over_f1": [MIDDLE]}, "rounds": MOST})
    of = ready(at_middle, rom, LONGER)
    scene, rounds = of.case.scene, of.case.scene.rounds
    if rounds < SPECTRUM or of.case.setup.steps != of.case.steps_of_a_turn:
        raise SceneError("a revolution is too costly", key="rounds")
    scene = scene.but(speeds={"over_f1": SPEEDS}, record=RECORD | {"history": None})
    check_scene(scene, rom)
    check_steps(scene, rom)
    return Ready(replace(of.case, scene=scene), of.finer)


def _beside(of: Ready, run: Run, found: Run, k: int | None) -> dict[str, Any]:
    """A ``run`` at a peak along ``k``, as its check ``found`` it, beside its references."""
    status, bound = found.outcome.status, max(found.errors.values(), default=None)
    told = {"k": k, "status": status, "bound": bound, "error": None, "silent": False}
    if status not in WITH_RESULT:
        return told
    others = references(Ready(replace(of.case, setup=run.setup), of.finer))
    if not {other.outcome.status for other in others} <= {*WITH_RESULT}:
        return told
    own, *exact = (numbers_of(one, k)["amplitude"] for one in (found, *others))
    if not max(exact) - min(exact) <= STATED * max(exact):
        return told
    off = min(abs(own - at) for at in exact) / max(own, *exact, LEAST["spectrum"])
    return told | {"error": off, "silent": status == "ok" and off > STATED}
