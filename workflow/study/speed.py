"""What accuracy costs in time: errors and CPU time of both schemes on three scenes.

Every run marches the same modal model. The reference is central differences far below their limit;
piecewise-exact at many steps gives a second one, and where the two part no error is known to be
smaller. A twin of the reference run says whether the scene can be predicted at all.
"""

from dataclasses import dataclass
from time import process_time
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rom.model import Rom
from simulate.observables import spectrum
from simulate.run import Outcome, march, prepare
from simulate.scene import CentralDifference, PiecewiseExact, Record, Scene
from simulate.twin import twin

SPEEDS = {"calm": 0.38, "resonance": 0.346, "stiff": 0.38}  # over f1(0); stiff: E = 10
LEVELS = (0.1, 0.03, 0.01)
OBSERVABLES = ("peak amplitude", "wear", "first rounds")
SAMPLES, FIRST_ROUNDS = 64, 5
TURNS = 3  # the least CPU time of these counts
SCALED_HZ = 25e3  # modes above are given more mass

Integrator = CentralDifference | PiecewiseExact
EXACT = [1024 * 2**k for k in range(7)]  # steps per round
FRACTIONS = (0.8, 0.5, 0.3, 0.2)  # of the limit with contact
SCALED_FRACTIONS = (0.8, 0.4, 0.2, 0.1)
REFERENCE, SECOND = 0.08, 2**17  # fraction of the limit; steps per round


@dataclass(frozen=True)
class Observed:
    """What users read of a run."""

    peak: float  # m, largest amplitude of the spectrum
    wear: NDArray[np.float64]  # (nodes, nu), m
    history: NDArray[np.float64]  # (samples,), m, u_r of node 1 in the first rounds


def exact(steps: int) -> PiecewiseExact:
    """Piecewise-exact with ``steps`` per round."""
    return PiecewiseExact(scheme="piecewise-exact", steps_per_round=steps)


def central(fraction: float, scaled_Hz: float | None = None) -> CentralDifference:
    """Central differences at a fraction of their limit."""
    return CentralDifference(
        scheme="central-difference", fraction_of_limit=fraction, mass_scaling_hz=scaled_Hz
    )


def settings() -> list[Integrator]:
    """What is compared."""
    scaled = [central(fraction, SCALED_HZ) for fraction in SCALED_FRACTIONS]
    return [*map(exact, EXACT), *map(central, FRACTIONS), *scaled]


def work_precision(scene: Scene, rom: Rom, speed: float) -> dict[str, Any]:
    """Errors and CPU time of every setting on ``scene`` at ``speed`` (over f1(0))."""
    record = Record(samples_per_round=SAMPLES, spectrum_rounds=10, history={"nodes": [1]})
    scene = scene.model_copy(update={"record": record, "twin": False})
    Omega = 2 * np.pi * rom.f1 * speed
    reference = observed(_march(scene, rom, Omega, central(REFERENCE))[0])
    second = observed(_march(scene, rom, Omega, exact(SECOND))[0])
    rows = []
    for integrator in settings():
        outcome, steps, seconds = _fastest(scene, rom, Omega, integrator)
        rows.append(
            {
                "scheme": integrator.scheme,
                "mass_scaling_hz": integrator.mass_scaling_hz,
                "steps_per_round": steps,
                "cpu_s": seconds,
                "contact_share": outcome.contact_share,
                "error": errors(observed(outcome), reference),
            }
        )
    return {
        "speed_over_f1": speed,
        "n": rom.n,
        "spread": errors(second, reference),
        "twin": _twin_errors(scene, rom, Omega),
        "runs": rows,
    }


def observed(outcome: Outcome) -> Observed:
    """Read a run that recorded its whole history."""
    u = outcome.u_r[:, 0]
    return Observed(
        peak=float(spectrum(u[-10 * SAMPLES :])[1:].max()),
        wear=outcome.wear,
        history=u[: FIRST_ROUNDS * SAMPLES],
    )


def errors(run: Observed, reference: Observed) -> dict[str, float]:
    """Relative errors: of the peak, of wear and first rounds in L2."""
    values = (
        abs(run.peak / reference.peak - 1),
        np.linalg.norm(run.wear - reference.wear) / np.linalg.norm(reference.wear),
        np.linalg.norm(run.history - reference.history) / np.linalg.norm(reference.history),
    )
    return {name: float(f"{v:.3g}") for name, v in zip(OBSERVABLES, values, strict=True)}


def cheapest(
    study: dict[str, Any], observable: str, level: float, scheme: str, scaled: bool = False
) -> dict[str, Any] | None:
    """The run of least CPU time that meets ``level``, or None."""
    meets = [
        run
        for run in study["runs"]
        if run["scheme"] == scheme
        and (run["mass_scaling_hz"] is not None) == scaled
        and run["error"][observable] <= level
    ]
    return min(meets, key=lambda run: run["cpu_s"], default=None)


def _march(
    scene: Scene, rom: Rom, Omega: float, integrator: Integrator
) -> tuple[Outcome, int, float]:
    """Outcome, steps per round, CPU time of the march (s)."""
    case = scene.model_copy(update={"integrator": integrator})
    setup = prepare(case, rom, Omega)
    start = process_time()
    outcome = march(case, setup)
    return outcome, setup.steps, process_time() - start


def _fastest(
    scene: Scene, rom: Rom, Omega: float, integrator: Integrator
) -> tuple[Outcome, int, float]:
    runs = [_march(scene, rom, Omega, integrator) for _ in range(TURNS)]
    return min(runs, key=lambda run: run[2])


def _twin_errors(scene: Scene, rom: Rom, Omega: float) -> dict[str, float]:
    """How far 1e-10 of the gaps moves the run at the finest setting that is compared."""
    case = scene.model_copy(update={"integrator": exact(EXACT[-1])})
    setup = prepare(case, rom, Omega)
    return errors(observed(march(case, twin(setup))), observed(march(case, setup)))
