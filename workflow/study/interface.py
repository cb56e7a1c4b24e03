"""Do results converge with mesh, patches, strips and modes: numbers and their bars."""

from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from geometry.files import read_json
from rom.check import RomCheck
from rom.model import Rom
from simulate.compare import Run as Recorded
from simulate.compare import departures
from simulate.run import Outcome, Setup, march, prepare
from simulate.scene import STRIPS, Scene
from simulate.twin import twin
from workflow.study.interface_plan import (
    COMPARED,
    COMPLIANCE_BARS,
    DEFAULT,
    FINE,
    MESHES,
    RODS,
    SCENES,
    STEPS,
    STRESS_BAR,
    TOLD,
    TWICE,
    Reduction,
)
from workflow.study.interface_table import table
from workflow.study.trade_errors import Read, errors, read
from workflow.study.trade_plan import Studied
from workflow.study.trade_runs import SAMPLES, peak, recording

__all__ = ["numbers", "table"]

type Row = dict[str, Any]


def numbers(files: Any, scenes: dict[str, Row]) -> Row:
    """The whole study: of each mesh from ``files``, and marches of ``scenes`` by short name."""
    models = [row for path in files.models for row in read_json(path)]
    checks = {Path(path).parent.name: RomCheck.load(path) for path in files.checks}
    return {
        "models": models,
        "frequencies": {blade: float(abs(c.error).max()) for blade, c in checks.items()},
        "between_meshes": between_meshes(models),
        "changes": [row for name, values in scenes.items() for row in compare(name, values)],
        "stress": stresses(models),
        "all_nodes": read_json(files.all_nodes),
    }


@dataclass(frozen=True)
class Marched:
    """One model marched on one scene."""

    case: Scene
    setup: Setup
    outcome: Outcome
    Omega_c: float | None

    @property
    def volume(self) -> float:
        """Worn volume, m3."""
        places, wear = self.setup.places, self.outcome.wear
        return float((places.width * 2 * np.pi * places.radius) @ wear.mean(axis=1))

    @property
    def read(self) -> Read:
        """What users read of it."""
        return read(self.outcome, SAMPLES, self.Omega_c)


def compare(name: str, values: Row) -> list[Row]:
    """Rows of one scene: each comparison, and how far the run departs from its twin."""
    studied, scene = SCENES[name], Scene(**values)

    @cache
    def run(model: Reduction, strips: int) -> Marched:
        rom = Rom.load(model._replace(directions=scene.directions).file)
        return _march(case_of(studied, scene, rom, strips), rom, studied)

    rows = []
    for label, of in COMPARED.items():
        rows.append(_row(name, label, run(of.one, of.strips[0]), run(of.other, of.strips[1])))
        print(rows[-1])
    return [*rows, _twin(name, run(DEFAULT, STRIPS))]


def case_of(studied: Studied, scene: Scene, rom: Rom, strips: int) -> Scene:
    """The scene on a model, at the steps and rods of the study."""
    steps, rods = STEPS[studied.tip], RODS[studied.tip]
    return recording(scene, rom, rods, strips, scheme="piecewise-exact", steps_per_round=steps)


def _march(case: Scene, rom: Rom, studied: Studied) -> Marched:
    setup = prepare(case, rom, 2 * np.pi * rom.f1 * studied.speed)
    outcome, Omega_c = march(case, setup), None
    if studied.swept:
        found = peak(case, rom)
        Omega_c = np.nan if found is None else found  # lost: it meets no bar
    return Marched(case, setup, outcome, Omega_c)


def _row(name: str, label: str, one: Marched, other: Marched) -> Row:
    """Changes from one to the other, over the other."""
    volume = abs(one.volume / other.volume - 1)
    changes = errors(one.read, other.read) | {"volume": volume}
    bars = COMPARED[label].bars
    return {
        "scene": name,
        "change": label,
        "changes": {key: changes[key] for key in TOLD},
        "bars": bars,
        "met": all(changes[key] is None or changes[key] <= bar for key, bar in bars.items()),
        "status": [one.outcome.status, other.outcome.status],
    }


def _twin(name: str, run: Marched) -> Row:
    """The largest departure from the run with all gaps 1e-10 of themselves apart."""
    other = march(run.case, twin(run.setup))
    found = departures(Recorded(run.case.record, run.outcome), Recorded(run.case.record, other))
    return {"scene": name, "change": "gaps by 1e-10", "largest": max(found.values())}


def between_meshes(rows: list[Row]) -> list[Row]:
    """Largest change of the compliance of strips from one mesh to the next."""
    found = {(row["blade"], row["patches"]): np.array(row["compliance_m_per_N"]) for row in rows}
    return [
        {
            "from": one,
            "to": other,
            "patches": patches,
            "compliance": float(np.abs(found[one, patches] / found[other, patches] - 1).max()),
            "bar": bar if judged else None,
        }
        for one, other, judged in MESHES
        for patches, bar in COMPLIANCE_BARS.items()
    ]


def stresses(rows: list[Row]) -> list[Row]:
    """Change of the settled stress, and of the largest anywhere, with mesh and patches."""
    found = {(r["blade"], r["patches"]): r["stress"] for r in rows if "stress" in r}
    default = found[DEFAULT.blade, DEFAULT.patches]
    others = {
        "2.48 to 1.75 mm": found[FINE.blade, FINE.patches],
        "16 to 32 patches": found[TWICE.blade, TWICE.patches],
    }
    return [
        {
            "change": label,
            "settled": abs(default["settled_Pa"] / other["settled_Pa"] - 1),
            "anywhere": abs(default["largest_Pa"] / other["largest_Pa"] - 1),
            "bar": STRESS_BAR,
            "settled_Pa": [default["settled_Pa"], other["settled_Pa"]],
        }
        for label, other in others.items()
    ]
