"""Whether the steps resolve the rub, judged without a second run at half the step.

Before the run the still blade is looked at. Where the casing comes closest, the tip is inside for
some steps: a contact of a few steps is computed wrong by either scheme, and half the step may see
the same wrong contact, since it shares every second instant. In contact the blade answers in its
first mode: free motion is exact at any step, its excitation is not. After the run its energies
are judged: the loss by the steps.

Limits by measurement, on 400 cases of the stability study with other seeds: of 215 that were right
the shortest window lasted 12 steps, while all of 11 with a window below 6 steps were wrong; of 8
more with a period below 100 steps in which the tip could touch 5 were; of 6 with piecewise-exact
that had lost over 1.5 % of the casing's work 5 were, of 9 with central differences and over 6 % 4.
With half the step beside it a run may have a period of 10: below, all steps may miss a contact.

Both facts together tell the risk of a run that is within these limits: few steps in a period, and
energy lost. Its power is from 700 cases of one seed. It sorts the runs that are to be checked, and
clears none: of 3000 cases (seeds 20261127, 20261130, 20261201 of ``draw``) five wrong runs had less
than most right ones.
"""

import numpy as np
from numpy.typing import NDArray

from simulate.contact.places import rods_in_footprint
from simulate.contact.travelling import distortion_passed, farthest
from simulate.errors.run import Run
from simulate.marching import SceneError, Setup

DEEP = 0.3  # of the deepest penetration: a window reaches this,
EDGE = 0.15  # and lasts while above this: a rough casing crosses one level often
WINDOW = 12.0  # least steps of a window: errors are about a tenth there
PERIOD = 100.0  # least steps of a period of the first mode where the tip can touch,
HALVED = 10.0  # and where half the step is run, too
FOOTPRINTS = 2.0  # most that the tip passes in a step where there is no half step
# of the casing's work: above, a run that stands alone is `inaccurate`; the predicted force of
# central differences loses some also where they are accurate
LOST = {"central-difference": 0.06, "piecewise-exact": 0.015}
POWER, LEAST_LOST = 0.25, 1e-8  # of the share lost, in the risk; smaller shares are round-off


def check_resolution(setup: Setup, samples: int, halves: bool) -> None:
    """Refuse a step too long for the shortest contact of the still blade, or for its first mode.

    And one in which the tip passes more than two footprints. With ``halves``, runs of half the
    step at each speed, these tell the latter two, but for very long steps. Steps are a multiple of
    ``samples``.

    Raises
    ------
    SceneError
        With the least steps per revolution.
    """
    longest = min(setup.blades, key=lambda blade: blade.strips.g0.min())
    strips = longest.strips
    deepest = farthest(strips) - float(strips.g0.min())
    if not strips.touches or deepest <= 0:  # a blade at rest stays so
        return
    period, footprints = _period(setup), footprints_passed(setup)
    window = shortest_window(longest, deepest)
    times, what = max(
        (
            (HALVED if halves else PERIOD) / period,
            f"the first mode has {period:.3g} steps in a period",
        ),
        (WINDOW / window, f"the closest part of the casing is passed in {window:.3g} steps"),
        (
            0.0 if halves else footprints / FOOTPRINTS,
            f"the tip passes {footprints:.3g} of its footprints in a step",
        ),
    )
    if times <= 1:
        return
    of_round = 2 * np.pi / (setup.Omega * setup.h)
    least = int(np.ceil(times * of_round / samples)) * samples
    raise SceneError(
        f"at {setup.Omega:.6g} rad/s {what}; allowed from {least}, or `accuracy`, which chooses it",
        key="integrator.steps_per_round",
        value=round(of_round),
        allowed={"ge": least},
    )


def risk(run: Run) -> float:
    """Risk that a run is wrong, from it alone: 1 where period and energy are at their limits.

    Inf for a run that is stopped, which may be right; 0 without contact.
    """
    ledger, limit = run.outcome.ledger, LOST[run.scene.stepping.scheme]
    if run.outcome.status == "inaccurate":
        return np.inf
    if run.outcome.contact_share == 0:
        return 0.0
    lost = abs(ledger.numerical) / max(abs(ledger.casing), np.finfo(float).tiny)
    return float(PERIOD / _period(run.setup) * (max(lost, LEAST_LOST) / limit) ** POWER)


def footprints_passed(setup: Setup) -> float:
    """Footprints that the tip passes in a step, the mean of the strips."""
    strips = setup.strips
    return float(strips.advance / (strips.length / strips.lengthened).mean())


def _period(setup: Setup) -> float:
    """Steps in a period of the first mode, of the fastest blade."""
    return 2 * np.pi / (max(blade.omega[0] for blade in setup.blades) * setup.h)


def shortest_window(setup: Setup, deepest: float) -> float:
    """Steps of the shortest window of penetration into the casing, of ``deepest`` (m), or inf.

    Of the strip with the smallest gap, from the first rod under its footprint to the last; a casing
    that travels is taken as the blade meets it in its first revolution.
    """
    strips, nu = setup.strips, setup.strips.d.size
    lengths = _windows((distortion_passed(strips) - strips.g0.min()) / deepest)
    flat = not strips.tip.half.any()  # else it bears with a part of its footprint
    footprint = setup.places.footprint[strips.g0.argmin()]
    rods = rods_in_footprint(footprint, setup.places.radius.mean(), nu)
    return float((lengths.min(initial=np.inf) + flat * rods) / strips.advance)


def _windows(depth: NDArray[np.float64]) -> NDArray[np.float64]:
    """Lengths, in rods, of the windows of a relative ``depth`` (nu,); inf if all around."""
    from scipy.ndimage import label, maximum  # a slow import, for jobs that march alone

    inside = depth > EDGE
    if inside.all():
        return np.array([np.inf])
    start = -int(np.argmin(inside))  # at a rod outside, so that no window is cut
    number, count = label(np.roll(inside, start))
    index = np.arange(1, count + 1)
    reaches = maximum(np.roll(depth, start), number, index) > DEEP
    return np.bincount(number)[1:][reaches].astype(float)
