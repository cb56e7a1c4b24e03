"""Twin runs: whether what a run records can be predicted.

A twin is the same run with all gaps changed by 1e-10, far less than they are known to. The march is
deterministic, so nothing else sets the two apart. Where they part by over 1 %, contact has made
chaos of the motion: the numbers of the run are right for its gaps, and another blade's will
differ. Reference: Shaw and Holmes 1983, a periodically forced piecewise linear oscillator.
"""

from dataclasses import replace
from math import inf, nan

import numpy as np
from numpy.linalg import norm
from numpy.typing import NDArray

from simulate.observables import spectrum
from simulate.run import Outcome, Setup, march
from simulate.scene import Record, Scene

GAP_CHANGE = 1e-10  # of the gaps: a million times round-off, a millionth of any tolerance
SENSITIVE_FROM = 0.01  # departure of an observable beyond which it cannot be predicted
WITH_RESULT = ("ok", "sensitive")  # statuses of the runs whose numbers are results


def twin(setup: Setup) -> Setup:
    """``setup`` with every gap g0 changed by ``GAP_CHANGE`` of the widest gap or distortion."""
    g0, d = setup.strips.g0, setup.strips.d
    change = GAP_CHANGE * max(g0.max(), np.abs(d).max())  # a gap may be none
    return replace(setup, strips=setup.strips._replace(g0=g0 + change))


def beside_twin(scene: Scene, setup: Setup, outcome: Outcome) -> tuple[Outcome, dict[str, float]]:
    """March the twin of a run: the run, `sensitive` where it is, and its ``departures``."""
    found = departures(scene.record, outcome, march(scene, twin(setup)))
    if outcome.status == "ok" and max(found.values()) > SENSITIVE_FROM:
        outcome = replace(outcome, status="sensitive")
    return outcome, found


def departures(record: Record, outcome: Outcome, other: Outcome) -> dict[str, float]:
    """Relative departure of two runs in each observable that ``record`` asks for.

    `spectrum`: largest difference of amplitude beyond bin 0, over the largest amplitude. `wear`
    (all rods of all nodes), `history` (all samples of the recorded nodes), `states` and
    `force_peak` (all rounds and nodes): L2 norm of the difference over that of the larger.
    0 where nothing differs, inf where the runs end differently, nan where neither has a result.
    """
    names = record.observables
    if outcome.status != other.status:
        return dict.fromkeys(names, inf)
    if outcome.status != "ok":
        return dict.fromkeys(names, nan)
    return {name: _departure(record, name, outcome, other) for name in names}


def _departure(record: Record, name: str, outcome: Outcome, other: Outcome) -> float:
    order = inf if name == "spectrum" else 2
    run, its_twin = (_values(record, name, of).ravel() for of in (outcome, other))
    difference = norm(run - its_twin, order)
    larger = max(norm(run, order), norm(its_twin, order))
    return float(difference / larger) if difference else 0.0


def _values(record: Record, name: str, outcome: Outcome) -> NDArray[np.float64]:
    """The observable's numbers in one run."""
    if name == "spectrum":
        samples = record.spectrum_rounds * record.samples_per_round
        return spectrum(outcome.u_r[-samples:, 0])[1:]
    if name == "history":
        return outcome.u_r[:, [node - 1 for node in record.history.nodes]]
    return getattr(outcome, name)
