"""Twin runs: sensitivity of a run to a tiny change of its gaps.

A twin is the same run with all gaps changed by 1e-10, far less than any manufacturing tolerance.
The march is deterministic, so that only this change makes the two differ. Where they differ by more
than 1 %, the motion is chaotic: the results hold for these exact gaps only, and another blade's
will differ. Reference: Shaw and Holmes 1983, a periodically forced piecewise linear oscillator.
"""

from dataclasses import replace

import numpy as np

from simulate.errors.compare import Run, departures
from simulate.marching.run import Outcome, march
from simulate.marching.setup import Setup
from simulate.marching.start import Left, Worn
from simulate.marching.status import WITH_RESULT
from simulate.scene import Scene

GAP_CHANGE = 1e-10  # of the gaps: a million times round-off, a millionth of any tolerance
SENSITIVE_FROM = 0.01  # relative difference above which an observable cannot be predicted


def twin(setup: Setup) -> Setup:
    """``setup`` with every gap g0 changed by ``GAP_CHANGE`` of the widest gap or distortion."""
    g0, d = setup.strips.g0, setup.strips.d
    change = GAP_CHANGE * max(g0.max(), np.abs(d).max())  # all gaps may be 0
    return replace(setup, strips=setup.strips._replace(g0=g0 + change))


def beside_twin(
    scene: Scene, setup: Setup, outcome: Outcome, left: Left | Worn | None = None
) -> tuple[Outcome, dict[str, float]]:
    """March the twin of a run: the run, `sensitive` if they differ, and their ``departures``.

    ``left``: what both start from.
    """
    runs = Run(scene.record, outcome), Run(scene.record, march(scene, twin(setup), left))
    changed_by = departures(*runs)
    if outcome.status in WITH_RESULT and max(changed_by.values()) > SENSITIVE_FROM:
        outcome = replace(outcome, status="sensitive", reason="")
    return outcome, changed_by
