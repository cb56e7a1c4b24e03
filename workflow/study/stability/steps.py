"""Steps at which the errors of intermittent contact reach 1 and 10 %, in both schemes.

Some rounds of a scene with its plastic liner, for which there is no theory.
"""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rom.model import Rom
from simulate.errors.observables import error, observables
from simulate.errors.run import Case
from simulate.marching import Setup, prepare
from simulate.scene import Record, Scene

MODULI = np.logspace(-1, 2, 4)  # E of the liner, in the scene's unit
ROUNDS = 12  # marched
RECORD = Record(samples_per_round=64, spectrum_rounds=10)
LEVELS = (0.01, 0.1)
CENTRAL, EXACT = "central-difference", "piecewise-exact"
STEPS = {
    CENTRAL: [{"fraction_of_limit": part} for part in (1.0, 0.7, 0.5, 0.35, 0.25, 0.15)],
    EXACT: [{"steps_per_round": 256 * 2**k} for k in range(9)],
}
REFERENCE = {"fraction_of_limit": 0.06}  # by central differences


def intermittent(scene: Scene, rom: Rom, Omega: float, E: float) -> dict[str, Any]:
    """Steps (s) at which the errors of both schemes reach ``LEVELS``, with another E.

    K has the scene's ratio to it. Errors are of the amplitude at xi = 1/16, and of the worn depth
    of all rods.
    """
    law = scene.liner.law
    changes = {"liner__law__E": E, "liner__law__K": law.K * E / law.E, "rounds": ROUNDS}

    def run(scheme: str, step: dict[str, float]) -> tuple[Setup, dict[str, ArrayLike]]:
        integrator = {"scheme": scheme, **step}
        case = scene.but(**changes, integrator=integrator, twin=False, peaks=None, record=RECORD)
        setup = prepare(case, rom, Omega)
        done = Case(case, rom, setup).march()
        amplitude = observables(done)["spectrum"].max()
        return setup, {"peak amplitude": amplitude, "wear": done.outcome.wear}

    setup, reference = run(CENTRAL, REFERENCE)
    row: dict[str, Any] = {"E": float(E), "limit": setup.limit}
    for scheme, steps in STEPS.items():
        setups, observed = zip(*(run(scheme, step) for step in steps), strict=True)
        h = np.array([setup.h for setup in setups])
        row[scheme] = {}
        for name, true in reference.items():
            errors = np.array([error(of[name], true) for of in observed])
            row[scheme][name] = {f"{level:g}": passes(h, errors, level) for level in LEVELS}
    return row


def passes(h: NDArray[np.float64], error: NDArray[np.float64], level: float) -> float | None:
    """Step at which the error reaches ``level``, interpolated; None if all or no runs meet it."""
    order = np.argsort(h)
    h, error = h[order], error[order]
    beyond = np.flatnonzero(error > level)
    if len(beyond) == 0 or beyond[0] == 0:
        return None
    around = slice(beyond[0] - 1, beyond[0] + 1)
    return float(np.exp(np.interp(np.log(level), np.log(error[around]), np.log(h[around]))))
