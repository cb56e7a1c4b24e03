"""Twin runs: whether what a run records can be predicted.

A twin is the same run with all gaps changed by 1e-10, far less than they are known to. The march is
deterministic, so nothing else sets the two apart. Where they part by over 1 %, contact has made
chaos of the motion: the numbers of the run are right for its gaps, and another blade's will
differ. Reference: Shaw and Holmes 1983, a periodically forced piecewise linear oscillator.
"""

from dataclasses import replace

import numpy as np

from simulate.compare import Run, departures
from simulate.run import Outcome, march
from simulate.scene import Scene
from simulate.setup import Setup

GAP_CHANGE = 1e-10  # of the gaps: a million times round-off, a millionth of any tolerance
SENSITIVE_FROM = 0.01  # departure of an observable beyond which it cannot be predicted


def twin(setup: Setup) -> Setup:
    """``setup`` with every gap g0 changed by ``GAP_CHANGE`` of the widest gap or distortion."""
    g0, d = setup.strips.g0, setup.strips.d
    change = GAP_CHANGE * max(g0.max(), np.abs(d).max())  # a gap may be none
    return replace(setup, strips=setup.strips._replace(g0=g0 + change))


def beside_twin(scene: Scene, setup: Setup, outcome: Outcome) -> tuple[Outcome, dict[str, float]]:
    """March the twin of a run: the run, `sensitive` where it is, and its ``departures``."""
    runs = Run(scene.record, outcome), Run(scene.record, march(scene, twin(setup)))
    changed_by = departures(*runs)
    if outcome.status == "ok" and max(changed_by.values()) > SENSITIVE_FROM:
        outcome = replace(outcome, status="sensitive")
    return outcome, changed_by
