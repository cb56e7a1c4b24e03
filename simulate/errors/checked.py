"""Which runs of a sweep or a design are checked by second runs.

First that of the largest response, then by risk, while they take no more than a share of the steps
of all runs. One run in contact is checked beyond that where nothing is overdrawn, so one that
stands alone. Beside a run found wrong, or cleared of what its energies said, its neighbours in
speed are checked, whatever that takes.
"""

from collections.abc import Sequence
from dataclasses import replace
from time import perf_counter

from geometry.base import Say, silent
from simulate.errors.neighbours import TWICE, judged
from simulate.errors.observables import last_spectrum
from simulate.errors.resolution import risk
from simulate.errors.run import Run
from simulate.marching import TO_THE_END


def checked(
    runs: Sequence[Run], share: float, budget: float = 0.0, report: Say = silent
) -> tuple[list[Run], float]:
    """Check some of the ``runs``, speeds ascending; also what remains for others, in steps.

    ``runs`` are ``judged``; ``share``: of their steps that checks may take, with what others have
    not used, ``budget``.
    """
    ordered = sorted(runs, key=lambda run: run.setup.Omega)
    budget += share * sum(run.steps for run in ordered)
    queue, next_to_wrong, any_yet = _in_turn(ordered) if share else [], set(), False
    while queue:
        run, begun = ordered[i := queue.pop(0)], perf_counter()
        one_more = budget >= 0 and not any_yet and risk(run) > 0
        if not (budget >= TWICE * run.steps or one_more or i in next_to_wrong):
            continue
        new, any_yet = judged(run, check=True), True
        budget -= new.steps - run.steps
        ordered[i] = replace(new, seconds=run.seconds + perf_counter() - begun)
        report(f"{ordered[i].line}; checked, error {new.largest_error:.2g}")
        if "inaccurate" in (run.outcome.status, new.outcome.status) or new.setup.h != run.setup.h:
            next_to_wrong |= {i - 1, i + 1}
            queue.sort(key=lambda j: j not in next_to_wrong)
    return ordered, budget


def _in_turn(runs: Sequence[Run]) -> list[int]:
    """Indices of the runs that can be checked: that of the largest response first, then by risk."""
    able = [i for i, run in enumerate(runs) if run.outcome.status in TO_THE_END]
    largest = max(able, key=lambda i: _response(runs[i]), default=None)
    return sorted(able, key=lambda i: (i == largest, risk(runs[i])), reverse=True)


def _response(run: Run) -> float:
    """Largest amplitude of a run, without a spectrum its largest displacement, m."""
    return (
        float(last_spectrum(run)[1:].max())
        if run.scene.record.spectrum_rounds
        else run.outcome.each.largest[0]
    )
