"""What the paper's other claims compare, at points of the parameters."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import NamedTuple

import numpy as np

from geometry.project import code_hash, fingerprint, read_json, write_json
from rom.model import Rom
from simulate.marching import STATUSES
from simulate.scene import LEADING, Scene
from simulate.scene.design import Design
from simulate.sweeps.closing_in import sweep
from simulate.sweeps.design_runs import Engine
from workflow.identify.steps import with_steps
from workflow.paper import measure
from workflow.paper.cases import WORST, E, K, of_coating
from workflow.paper.grid import Case, at as at_coating, grid, worst
from workflow.paper.measure import Numbers
from workflow.paper.worst import growth

ORDER = 4  # of the peak over the table of E and K

type Scenes = Mapping[str, Scene]  # of the paper and of its table of E and K, by part


def at_point(scene: Scene, point: Scene) -> Scene:
    """A scene with the parameters of a point's scene."""
    law = (
        {"liner__law__unit_Pa": point.liner.law.unit_Pa} if scene.liner.law.kind != "rigid" else {}
    )
    return scene.but(
        blade=point.blade,
        twin=False,
        damping_ratio=point.damping_ratio,
        casing=point.casing,
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


class Kept(NamedTuple):
    """Numbers of points that were measured, a file each, under a hash of all that decides them."""

    folder: Path
    rom: Rom

    def numbers(self, scenes: Sequence[Scene], compute: Callable[[], Numbers]) -> Numbers:
        """Numbers that ``compute`` makes of ``scenes``: those of the file, if there is one."""
        shared = [self.rom.provenance.hash, code_hash(__name__)]
        key = fingerprint([*shared, *(scene.model_dump_json() for scene in scenes)])
        file = self.folder / f"{key}.json"
        if not file.is_file():
            write_json(compute(), file)
        return read_json(file)


def measured(scenes: Scenes, point: Scene, kept: Kept, of_E1: Iterable[float]) -> Numbers:
    """Numbers by part, as of an edition of the paper; "e1" by K of the coating with E = 1."""
    here = at(scenes, point, kept.rom.span)
    ductile = {f"{K:g}": of_coating(here["e10"], 1.0, K) for K in of_E1}
    return {
        "e1": {
            K: kept.numbers([scene], partial(_coating, scene, kept.rom))
            for K, scene in ductile.items()
        },
        **kept.numbers([*here.values()], partial(_others, here, kept.rom)),
    }


def _coating(scene: Scene, rom: Rom) -> Numbers:
    return measure.coating(sweep(with_steps(scene), rom), rom)


def _others(here: Scenes, rom: Rom) -> Numbers:
    """Numbers of all scenes but that of the coating with E = 1."""
    return {
        "e10": _coating(here["e10"], rom),
        "two_five": measure.two_five(sweep(with_steps(here["two_five"]), rom), rom),
        **_of_table(here["grid"], here["rigid"], rom),
    }


def _of_table(scene: Scene, bare: Scene, rom: Rom) -> Numbers:
    """Numbers of the table of E and K and of its long runs, as far as there are peaks."""
    coatings = [_coated(scene, young, plastic) for young in E for plastic in K]
    engine = Engine.of(Design(Path("coatings"), scene, [], coatings), rom)
    table = grid([[_case(engine, coating) for coating in coatings]])
    if not any(case["peaks"][str(ORDER)] for case in table["cases"]):
        return {}
    numbers = {"grid": measure.table(table)}
    if at_coating(table, *WORST)["peaks"][str(ORDER)]:
        stiffest = max(WORST[0], worst(table, ORDER)["E"])
        enough = _coated(scene, stiffest, WORST[1])  # steps for both long runs
        numbers["long"] = measure.long_run(growth(enough, rom, table, sweep(bare, rom)))
    return numbers


def _coated(scene: Scene, young: float, plastic: float) -> Scene:
    return with_steps(scene.but(liner__law__E=young, liner__law__K=plastic))


def _case(engine: Engine, scene: Scene) -> Case:
    """One coating of the table, without profiles."""
    runs, law = engine.march_row(scene), scene.liner.law
    found = engine.peaks_among(runs, scene)(ORDER)
    values = found and {
        "Omega_c": found.Omega_c,
        "amplitude": found.amplitude,
        "status": STATUSES[runs["status"][found.index]],
    }
    return {"E": law.E, "K": law.K, "peaks": {str(ORDER): values}}
