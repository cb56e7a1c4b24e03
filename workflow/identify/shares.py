"""The paper's other claims at points of the unit cube, with the step and density of the tables."""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from rom.model import Rom
from simulate.over_speeds import sweep
from simulate.scene import LEADING, Scene
from workflow.paper import measure
from workflow.paper.cases import WORST, E, K, of_coating
from workflow.paper.claims import CLAIMS
from workflow.paper.grid import Case, grid
from workflow.paper.grid import at as at_coating
from workflow.paper.peaks import peak
from workflow.paper.verdict import HOLDS, judge
from workflow.paper.worst import growth

# What is not judged at points: the reduced model, densities, steps and times (C01 to C10), the data
# (C11), the tilted tip (C21 to C23) and stress (C24).
JUDGED = ("C12", "C13", "C14", "C15", "C16", "C17", "C18", "C19", "C20", "C25", "C26")
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


def verdicts(
    scenes: Scenes, point: Scene, rom: Rom, of_E1: Iterable[float]
) -> dict[str, dict[str, Any]]:
    """Verdict and numbers of each claim, by K of the coating with E = 1 and by claim."""
    here = at(scenes, point, rom.span)
    shared = {
        "e10": measure.coating(sweep(here["e10"], rom), rom),
        "two_five": measure.two_five(sweep(here["two_five"], rom), rom),
        **_of_table(here["grid"], here["rigid"], rom),
    }
    return {f"{K:g}": _judged(shared, of_coating(here["e10"], 1.0, K), rom) for K in of_E1}


def _judged(shared: dict[str, Any], ductile: Scene, rom: Rom) -> dict[str, Any]:
    """Claims, with a scene of the coating with E = 1."""
    e1 = measure.coating(sweep(ductile, rom), rom)
    rows = [judge(claim, shared | {"e1": e1}, {}) for claim in CLAIMS if claim.id in JUDGED]
    return {row["id"]: {"verdict": row["verdict"], "ours": row["ours"]} for row in rows}


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


def shares(of_draws: Sequence[Mapping[str, Mapping[str, Any]]]) -> dict[str, Any]:
    """Shares of the draws at which claims hold, whether their numbers agree or not.

    Returns
    -------
    dict
        "holds": by claim; "not judged": by claim, the share at which a peak that it needs is
        missing; "together": by claim and claim, the share of the draws with the first one
        at which the second one holds as well; nan where the first one never holds.
    """
    held = np.array([[draw[c]["verdict"] in HOLDS for c in JUDGED] for draw in of_draws], float)
    count = held.sum(axis=0)
    unknown = [np.mean([d[c]["verdict"] == "not judged" for d in of_draws]) for c in JUDGED]
    with np.errstate(invalid="ignore"):
        together = held.T @ held / count[:, None]
    return {
        "holds": dict(zip(JUDGED, (count / len(held)).tolist(), strict=True)),
        "not judged": dict(zip(JUDGED, map(float, unknown), strict=True)),
        "together": {
            c: dict(zip(JUDGED, row, strict=True))
            for c, row in zip(JUDGED, together.tolist(), strict=True)
        },
    }
