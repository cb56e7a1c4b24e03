"""What the paper's other claims compare, at points, with the step and density of the tables."""

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from rom.model import Rom
from simulate.over_speeds import sweep
from simulate.scene import LEADING, Scene
from workflow.paper import measure
from workflow.paper.cases import WORST, E, K, of_coating
from workflow.paper.grid import Case, grid
from workflow.paper.grid import at as at_coating
from workflow.paper.peaks import peak
from workflow.paper.worst import growth

ORDER = 4  # of the peak over the table of E and K

type Scenes = Mapping[str, Scene]  # of the paper and of its table of E and K, by part


def at_point(scene: Scene, point: Scene) -> Scene:
    """A scene with the parameters, the step and the density of a point's scene."""
    law = (
        {"liner__law__unit_Pa": point.liner.law.unit_Pa} if scene.liner.law.kind != "rigid" else {}
    )
    return scene.but(
        blade=point.blade,
        twin=False,
        damping_ratio=point.damping_ratio,
        integrator=point.integrator,
        casing=point.casing,
        record__samples_per_round=point.record.samples_per_round,
        liner__rods_per_round=point.liner.rods_per_round,
        **law,
    )


def at(scenes: Scenes, point: Scene, span: float) -> dict[str, Scene]:
    """All scenes at a point. That of two and five diameters keeps its shape of the casing."""
    here = {part: at_point(scene, point) for part, scene in scenes.items()}
    return here | {"two_five": with_own_shape(scenes["two_five"], point, span)}


def with_own_shape(scene: Scene, point: Scene, span: float) -> Scene:
    """``at_point``, but the casing of ``scene``, as far inward as that of the point."""
    largest = [_largest_inward(one, span) for one in (point, scene.but(casing__scale=1.0))]
    return at_point(scene, point).but(casing=scene.casing.but(scale=largest[0] / largest[1]))


def _largest_inward(scene: Scene, span: float) -> float:
    """Largest inward distortion of a scene's casing, gaps."""
    gap = float(scene.clearance.gaps(LEADING, span))
    return float(scene.casing.inward(np.linspace(0, 2 * np.pi, 3601), gap).max()) / gap


def measured(scenes: Scenes, point: Scene, rom: Rom, of_E1: Iterable[float]) -> dict[str, Any]:
    """Numbers by part, as of an edition of the paper; "e1" by K of the coating with E = 1."""
    here = at(scenes, point, rom.span)

    def ductile(K: float) -> dict[str, Any]:
        return measure.coating(sweep(of_coating(here["e10"], 1.0, K), rom), rom)

    return {
        "e1": {f"{K:g}": ductile(K) for K in of_E1},
        "e10": measure.coating(sweep(here["e10"], rom), rom),
        "two_five": measure.two_five(sweep(here["two_five"], rom), rom),
        **_of_table(here["grid"], here["rigid"], rom),
    }


def _of_table(scene: Scene, bare: Scene, rom: Rom) -> dict[str, Any]:
    """Numbers of the table of E and K and of its long runs, as far as there are peaks."""
    table = grid([[_case(scene, rom, young, plastic) for plastic in K] for young in E])
    if not any(case["peaks"][str(ORDER)] for case in table["cases"]):
        return {}
    numbers = {"grid": measure.table(table)}
    if at_coating(table, *WORST)["peaks"][str(ORDER)]:
        numbers["long"] = measure.long_run(growth(scene, rom, table, sweep(bare, rom)))
    return numbers


def _case(scene: Scene, rom: Rom, young: float, plastic: float) -> Case:
    """One coating of the table."""
    runs = sweep(of_coating(scene, young, plastic), rom)
    return {"E": young, "K": plastic, "peaks": {str(ORDER): peak(runs, rom, ORDER)}}
