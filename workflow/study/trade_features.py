"""What a scene requires: what changes where one feature of the model is left out."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from scipy.sparse import diags

from fem.matrices import Matrices
from geometry.blade import EnrichedBasis
from rom.model import Rom
from rom.projection import project
from rom.reduce import reduce
from simulate.scene import Scene
from workflow.study.trade import rounded
from workflow.study.trade_errors import errors
from workflow.study.trade_models import EIGHT, LINEAR, REFERENCE, Model
from workflow.study.trade_plan import SCENES, least_of, tip_of
from workflow.study.trade_runs import TURNS, Run, exact, of_setting, run_case

type Row = dict[str, Any]
type Models = Callable[[Model], Rom]
type Change = Callable[[Scene], Scene]


@dataclass(frozen=True)
class Feature:
    """One feature, and the case without it."""

    feature: str
    instead: str
    scene: Scene
    model: Model
    fuller: Model | None = None  # what it is compared with, where that is not the scene's own


def features_of(name: str, scene: Scene) -> Iterator[Feature]:
    """What a scene may do without; what it has not is left out of a fuller model."""
    least = least_of(name)
    own = REFERENCE.to(least)
    yield Feature("nonlinear prestress", "linear static solve", scene, LINEAR.to(least))
    if scene.contact.tangential:
        yield Feature("tangential force", "none", scene.changed(contact__tangential=False), own)
    else:
        yield Feature("tangential interface DoFs", "r", scene, own, REFERENCE.to("rt"))
    yield Feature("axial interface DoFs", "rt", scene, REFERENCE.to("rt"), REFERENCE.to("rtz"))
    yield Feature("wear feedback", "elastic law", elastic(scene), own)
    yield Feature("casing harmonics", "the strongest alone", strongest_alone(scene), own)
    yield Feature("16 patches", "8", scene, EIGHT.to(least), own)


def elastic(scene: Scene) -> Scene:
    """The scene with a liner that does not wear."""
    law = scene.liner.law
    return scene.changed(liner__law={"kind": "elastic", "E": law.E, "unit_Pa": law.unit_Pa})


def strongest_alone(scene: Scene) -> Scene:
    """The scene with the strongest harmonic of the casing beside its mean."""
    waves = [h for h in scene.casing.harmonics if h.order > 0]
    kept = max(waves, key=lambda h: h.amplitude_m or h.amplitude_gaps)
    mean = [h for h in scene.casing.harmonics if h.order == 0]
    return scene.changed(casing__harmonics=[h.model_dump() for h in (*mean, kept)])


def not_softened(fom: Matrices, directions: str) -> Rom:
    """The reduced model without spin softening: K(Omega) + Omega^2 T^T P M P T.

    P keeps the displacements in the plane of rotation, across which the centrifugal force grows.
    """
    rom, T = reduce(fom, EnrichedBasis(), directions)
    P = diags(np.tile([1.0, 1.0, 0.0], fom.M.shape[0] // 3))
    K = rom.K.copy()
    K[1] += project(P @ fom.M @ P, T)
    return replace(rom, K=K)


def features(
    name: str, scene: Scene, rom_of: Models, unsoftened: Callable[[str], Rom]
) -> list[Row]:
    """Changes and time ratio of each feature on one scene.

    ``unsoftened`` gives the model of ``not_softened`` for interface directions.
    """
    own = REFERENCE.to(least_of(name))
    marched: dict[str, Run] = {}

    def full(model: Model) -> Run:
        if model.file not in marched:
            marched[model.file] = _run(name, scene, rom_of(model))
        return marched[model.file]

    rows = [
        _row(
            name, f.feature, f.instead, _run(name, f.scene, rom_of(f.model)), full(f.fuller or own)
        )
        for f in features_of(name, scene)
    ]
    soft = _run(name, scene, unsoftened(least_of(name)))
    return [*rows, _row(name, "spin softening", "K(Omega) without", soft, full(own))]


def _run(name: str, scene: Scene, rom: Rom) -> Run:
    setting = exact(REFERENCE, scene.integrator.steps_per_round, tip_of(name).own)
    case = of_setting(scene, rom, setting)
    return run_case(case, rom, SCENES[name][1], TURNS, swept=name == "resonance")


def _row(name: str, feature: str, instead: str, without: Run, full: Run) -> Row:
    return {
        "feature": feature,
        "instead": instead,
        "scene": name,
        "status": without.status,
        "changes": rounded(errors(without.read, full.read)),
        "time_ratio": float(f"{without.cpu_s[1] / full.cpu_s[1]:.3g}"),
    }
