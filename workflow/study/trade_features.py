"""What a scene requires: what changes where one feature of the model is left out."""

from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import cache
from typing import Any, NamedTuple

import numpy as np
from scipy.sparse import diags

from fem.matrices import Matrices
from geometry.blade import EnrichedBasis
from rom.model import Rom
from rom.projection import project
from rom.reduce import reduce
from simulate.scene import Scene
from workflow.study.trade_errors import errors, rounded
from workflow.study.trade_models import EIGHT, LINEAR, REFERENCE, Model
from workflow.study.trade_plan import SCENES
from workflow.study.trade_runs import rom_of, run_as_is

type Row = dict[str, Any]


class Feature(NamedTuple):
    """One feature, the case without it, and the model with it."""

    feature: str
    instead: str
    scene: Scene
    rom: Rom
    full: Model


def numbers(files: Any, scenes: dict[str, Row]) -> dict[str, list[Row]]:
    """Changes and time ratio of each feature on each scene, from ``files.matrices``."""
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
    full = cache(lambda model: run_as_is(scene, rom_of(model), studied))
    for feature, instead, changed, rom, model in features_of(scene, unsoftened(scene.directions)):
        without, true = run_as_is(changed, rom, studied), full(model)
        yield {
            "feature": feature,
            "instead": instead,
            "scene": name,
            "status": without.status,
            "changes": rounded(errors(without.read, true.read)),
            "time_ratio": float(f"{without.cpu_s[1] / true.cpu_s[1]:.3g}"),
        }


def features_of(scene: Scene, unsoftened: Rom) -> Iterator[Feature]:
    """What a scene may do without; what it has not is left out of a fuller model.

    ``unsoftened`` is its model without spin softening.
    """
    d = scene.directions
    own, rom = REFERENCE.to(d), rom_of(REFERENCE.to(d))
    yield Feature("nonlinear prestress", "linear static solve", scene, rom_of(LINEAR.to(d)), own)
    rt = REFERENCE.to("rt")
    if scene.contact.tangential:
        radial = scene.changed(contact__tangential=False)
        yield Feature("tangential force", "none", radial, rom, own)
    else:
        yield Feature("tangential interface DoFs", "r", scene, rom, rt)
    yield Feature("axial interface DoFs", "rt", scene, rom_of(rt), REFERENCE.to("rtz"))
    yield Feature("wear feedback", "elastic law", elastic(scene), rom, own)
    yield Feature("casing harmonics", "the strongest alone", strongest_alone(scene), rom, own)
    yield Feature("16 patches", "8", scene, rom_of(EIGHT.to(d)), own)
    yield Feature("spin softening", "K(Omega) without", scene, unsoftened, own)


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
