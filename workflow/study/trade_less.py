"""Study of simpler scenes: features of the model left out, fewer rounds, fewer speeds."""

from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import cache
from time import process_time
from typing import Any, NamedTuple

import numpy as np
import xarray as xr
from scipy.sparse import diags

from fem.matrices import Matrices
from geometry.blade import EnrichedBasis
from rom.model import Rom
from rom.projection import project
from rom.reduce import reduce
from simulate.scene import Scene, Speeds
from simulate.sweeps.closing_in import sweep
from simulate.sweeps.over_speeds import at_speeds
from simulate.sweeps.peak import Peak, peak_of
from workflow.study.trade_plan import EIGHT, LINEAR, REFERENCE, SCENES
from workflow.study.trade_runs import (
    SPECTRUM_ROUNDS,
    TURNS,
    Row,
    Run,
    changes,
    recording,
    rom_of,
    run,
    run_as_is,
)

ROUNDS, LONGEST = (5, 10, 20, 40), 80  # rounds before those of the spectrum
ORDERS = (4, 6)
SWEEPS = (  # label, every n-th speed of the scene, spacing around the peaks (over f1(0))
    ("114 speeds", 1, None),
    ("114 speeds, refined", 1, 4e-4),
    ("29 speeds, refined", 4, 4e-4),
    ("15 speeds, refined", 8, 4e-4),
)
TRUE_WITHIN = 1e-4  # spacing around the peaks of the reference, over f1(0)
# What no scene of the study has, to be left out again; the friction is below ``mu_crit`` of all.
FRICTION = 0.05
ORBIT = {"order": 1, "amplitude_gaps": 0.3}  # of the rotor, 0.6 of the largest harmonic
ORBIT_RAD_S = 150.0
PULSE = {"rounds": [0, 2, 5, 6, 8, 10], "factor": [0, 1, 1, 0.3, 0.3, 1]}  # as of scene `pulse`


class Feature(NamedTuple):
    """One feature, what replaces it, and scene and model without it and with it."""

    feature: str
    instead: str
    without: tuple[Scene, Rom]
    full: tuple[Scene, Rom]


def features(files: Any, scenes: dict[str, Row]) -> dict[str, list[Row]]:
    """Changes and ratio of CPU times without each feature, for each scene, by short name.

    ``files.matrices``: matrices for the model without spin softening.
    """
    fom = Matrices.load(files.matrices)
    unsoftened = cache(lambda directions: not_softened(fom, directions))
    return {
        "features": [
            row
            for name, values in scenes.items()
            for row in _of_scene(name, Scene(**values), unsoftened)
        ]
    }


def _of_scene(name: str, scene: Scene, unsoftened: Callable[[str], Rom]) -> Iterator[Row]:
    studied = SCENES[name]
    for of in features_of(scene, unsoftened(scene.directions)):
        without, true = (run_as_is(*case, studied) for case in (of.without, of.full))
        yield {
            "feature": of.feature,
            "instead": of.instead,
            "scene": name,
            "status": without.status,
            "status_with": true.status,
            "changes": changes(without, true),
            "time_ratio": float(f"{without.cpu_s[1] / true.cpu_s[1]:.3g}"),
        }


def features_of(scene: Scene, unsoftened: Rom) -> Iterator[Feature]:
    """Features that may be left out of a scene; absent ones, of a richer model or scene.

    ``unsoftened``: the scene's model without spin softening.
    """
    d = scene.directions
    rom, rt, rtz = (rom_of(REFERENCE.to(directions)) for directions in (d, "rt", "rtz"))
    own, on_rt = (scene, rom), (scene, rt)
    linear, eight = (scene, rom_of(LINEAR.to(d))), (scene, rom_of(EIGHT.to(d)))
    yield Feature("nonlinear prestress", "linear static solve", linear, own)
    if scene.contact.tangential:
        radial = scene.but(contact__tangential=False)
        yield Feature("tangential force", "none", (radial, rom), own)
    else:
        yield Feature("tangential interface DoFs", "r", own, on_rt)
    yield Feature("axial interface DoFs", "rt", on_rt, (scene, rtz))
    yield Feature("wear feedback", "elastic law", (elastic(scene), rom), own)
    alone = strongest_alone(scene), rom
    yield Feature("casing harmonics", "the strongest alone", alone, own)
    yield Feature("16 patches", "8", eight, own)
    yield Feature("spin softening", "K(Omega) without", (scene, unsoftened), own)
    if not scene.contact.tangential:
        slides = scene.but(contact__friction=FRICTION)
        yield Feature("friction", "none", on_rt, (slides, rt))
    travels, stands = ((orbiting(scene, speed), rom) for speed in (ORBIT_RAD_S, 0.0))
    yield Feature("travelling harmonic", "a fixed one", stands, travels)
    pulse = scene.but(casing__ramp_rounds=None, casing__ramp=PULSE)
    yield Feature("ramp as a table", "growing once", own, (pulse, rom))


def orbiting(scene: Scene, speed: float) -> Scene:
    """The scene with an orbit of the rotor that travels around the casing at ``speed``, rad/s."""
    waves = [h.model_dump() for h in scene.casing.harmonics]
    return scene.but(casing__harmonics=[*waves, ORBIT | {"speed_rad_s": speed}])


def elastic(scene: Scene) -> Scene:
    """The scene with a liner that does not wear."""
    law = scene.liner.law
    return scene.but(liner__law={"kind": "elastic", "E": law.E, "unit_Pa": law.unit_Pa})


def strongest_alone(scene: Scene) -> Scene:
    """The scene with the mean and the strongest harmonic of the casing."""
    waves = [h for h in scene.casing.harmonics if h.order > 0]
    kept = max(waves, key=lambda h: h.amplitude_m or h.amplitude_gaps)
    mean = [h for h in scene.casing.harmonics if h.order == 0]
    return scene.but(casing__harmonics=[h.model_dump() for h in (*mean, kept)])


def not_softened(fom: Matrices, directions: str) -> Rom:
    """The reduced model without spin softening: K(Omega) + Omega^2 T^T P M P T.

    P projects on displacements in the plane of rotation, with which the centrifugal force grows.
    """
    rom, T = reduce(fom, EnrichedBasis(), directions)
    P = diags(np.tile([1.0, 1.0, 0.0], fom.M.shape[0] // 3))
    K = rom.K.copy()
    K[1] += project(P @ fom.M @ P, T)
    return replace(rom, K=K)


def smaller(files: Any, scenes: dict[str, Row]) -> dict[str, list[Row]]:
    """Errors with fewer rounds and with fewer speeds; ``scenes`` by name."""
    made = {name: Scene(**values) for name, values in scenes.items()}
    return {
        "rounds": [row for name, scene in made.items() for row in rounds(name, scene)],
        "sweep": list(sweeps(made["calm"], rom_of(REFERENCE))),
    }


def rounds(name: str, scene: Scene) -> Iterator[Row]:
    """Errors with few to many rounds before those of the spectrum, against ``LONGEST``."""
    rom, studied = rom_of(REFERENCE.to(scene.directions)), SCENES[name]._replace(swept=False)
    case = recording(scene, rom, studied.tip.own)

    def after(before: int, turns: int) -> Run:
        return run(case.but(rounds=before + SPECTRUM_ROUNDS), rom, studied, turns)

    true = after(LONGEST, 0)
    for before in ROUNDS:
        done = after(before, TURNS)
        of = {"scene": name, "rounds_before": before, "cpu_s": done.cpu_s}
        yield of | {"errors": changes(done, true)}


def sweeps(scene: Scene, rom: Rom) -> Iterator[Row]:
    """Errors of peaks from coarse sweeps refined around them, against a fully refined sweep."""
    true, _ = _swept(scene, rom, 1, TRUE_WITHIN)
    for label, every, within in SWEEPS:
        swept, seconds = _swept(scene, rom, every, within)
        pairs = [(peak_of(swept, rom, k), peak_of(true, rom, k)) for k in ORDERS]
        yield {
            "label": label,
            "marches": swept.sizes["speed_over_f1"],
            "cpu_s": seconds,
            "errors": {of: _of_peaks(pairs, of) for of in ("Omega_c", "amplitude")},
        }


def _of_peaks(pairs: list[tuple[Peak | None, Peak | None]], name: str) -> float | None:
    """Largest error over the orders; None if a peak is missing."""
    if any(None in pair for pair in pairs):
        return None
    return float(f"{max(abs(getattr(a, name) / getattr(b, name) - 1) for a, b in pairs):.4g}")


def _swept(scene: Scene, rom: Rom, every: int, within: float | None) -> tuple[xr.Dataset, float]:
    """Sweep of every ``every``-th speed, refined around the peaks up to ``within``; CPU time, s."""
    peaks = {"orders": list(ORDERS), "within_over_f1": within} if within else None
    Omega = scene.speeds.omega(rom.f1)[::-1][::every][::-1]  # with the last one, close to peaks
    case = scene.but(twin=False, peaks=peaks, speeds=Speeds(rad_s=list(Omega)))
    at_speeds(case, rom, Omega[:1])  # compiles
    start = process_time()
    swept = sweep(case, rom)
    return swept, float(f"{process_time() - start:.4g}")
