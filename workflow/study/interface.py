"""Do results converge with mesh, patches, strips and modes: numbers and their bars."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from rom.model import Rom
from simulate.compare import Run as Recorded
from simulate.compare import departures
from simulate.run import Outcome, Setup, march, prepare
from simulate.scene import Scene
from simulate.twin import twin
from workflow.study.interface_models import DEFAULT, MODES, RICH, Reduction
from workflow.study.trade_errors import errors, read
from workflow.study.trade_runs import SAMPLES, peak, recording

STEPS, RODS, RODS_OF_EDGE = 2**15, 4093, 308411  # per round
TILTED = ("tangential", "tilted")
SCENES = {  # file, speed over f1(0)
    "calm": ("paper-e1", 0.38),
    "resonance": ("paper-e1", 0.346),
    "stiff": ("paper-e10", 0.38),
    "tangential": ("paper-tangential", 0.31),
    "tilted": ("paper-tilted", 0.31),
}
BARS = {  # of each comparison, by observable
    "3.51 to 2.48 mm": {"wear": 0.015, "amplitude": 0.003, "Omega_c": 0.0005},
    "2.48 to 1.75 mm": {"wear": 0.01, "amplitude": 0.003, "Omega_c": 0.0005},
    "16 patches, 16 strips to 32, 32": {"wear": 0.03, "volume": 0.01},
    "24 to 36 natural modes": {"wear": 0.005},
}
MESHES = (
    ("reference-coarse", "reference"),
    ("reference", "reference-fine"),
    ("rotor37", "rotor37-fine"),
)
JUDGED = MESHES[1:]
COMPLIANCE_BARS = {8: 0.003, 16: 0.006}
OPERATOR_BARS = {"constant": 1e-8, "linear": 1e-8, "ST": 1e-9, "compliance_of_model": 1e-6}
FREQUENCY_BAR, STRESS_BAR = 1e-4, 0.03
TOLD = ("wear", "volume", "amplitude", "Omega_c", "force")

type Row = dict[str, Any]
type Report = Callable[[str], None]


@dataclass(frozen=True)
class Marched:
    """One model marched on one scene."""

    setup: Setup
    outcome: Outcome
    Omega_c: float | None

    @property
    def volume(self) -> float:
        """Worn volume, m3."""
        places, wear = self.setup.places, self.outcome.wear
        return float((places.width * 2 * np.pi * places.radius) @ wear.mean(axis=1))


def compare(name: str, scene: Scene, folder: Path, report: Report = print) -> list[Row]:
    """Rows of one scene: each comparison, and how far the run departs from its twin."""
    d = "rt" if scene.contact.tangential else "r"
    default = DEFAULT._replace(directions=d)
    twice, rich = Reduction(32, MODES, d), Reduction(16, RICH, d)

    @cache
    def run(blade: str, reduction: Reduction, strips: int) -> Marched:
        rom = Rom.load(Path(folder, blade, f"{reduction.name}.nc"))
        return _march(_case(name, scene, rom, strips), rom, name)

    pairs = {
        "3.51 to 2.48 mm": (run("reference-coarse", default, 16), run("reference", default, 16)),
        "2.48 to 1.75 mm": (run("reference", default, 16), run("reference-fine", default, 16)),
        "16 patches, 16 strips to 32, 32": (
            run("reference", default, 16),
            run("reference", twice, 32),
        ),
        "24 to 36 natural modes": (run("reference", default, 16), run("reference", rich, 16)),
    }
    rows = [_row(name, label, *pair) for label, pair in pairs.items()]
    for row in rows:
        report(str(row))
    rom = Rom.load(Path(folder, "reference", f"{default.name}.nc"))
    return [*rows, _twin(name, _case(name, scene, rom, 16), run("reference", default, 16))]


def _case(name: str, scene: Scene, rom: Rom, strips: int) -> Scene:
    """The scene on a model, at the steps and rods of the study."""
    edge = name in TILTED
    steps, rods = (STEPS // 2, RODS_OF_EDGE) if edge else (STEPS, RODS)
    return recording(scene).changed(
        blade=rom.provenance.blade,
        integrator={"scheme": "piecewise-exact", "steps_per_round": steps},
        liner__rods_per_round=rods,
        liner__strips=strips,
    )


def _march(case: Scene, rom: Rom, name: str) -> Marched:
    setup = prepare(case, rom, 2 * np.pi * rom.f1 * SCENES[name][1])
    outcome, Omega_c = march(case, setup), None
    if name == "resonance":
        found = peak(case, rom)
        Omega_c = np.nan if found is None else found  # lost: it meets no bar
    return Marched(setup, outcome, Omega_c)


def _row(name: str, label: str, one: Marched, other: Marched) -> Row:
    """Changes from one to the other, over the other."""
    reads = [replace(read(m.outcome, SAMPLES), Omega_c=m.Omega_c) for m in (one, other)]
    changes = errors(*reads) | {"volume": abs(one.volume / other.volume - 1)}
    changes = {name: changes[name] for name in TOLD}
    bars = BARS[label]
    met = all(changes[key] is None or changes[key] <= bar for key, bar in bars.items())
    status = [m.outcome.status for m in (one, other)]
    return {
        "scene": name,
        "change": label,
        "changes": changes,
        "bars": bars,
        "met": met,
        "status": status,
    }


def _twin(name: str, case: Scene, run: Marched) -> Row:
    """The largest departure from the run with all gaps 1e-10 of themselves apart."""
    other = march(case, twin(run.setup))
    found = departures(Recorded(case.record, run.outcome), Recorded(case.record, other))
    return {"scene": name, "change": "gaps by 1e-10", "largest": max(found.values())}


def between_meshes(rows: list[Row]) -> list[Row]:
    """Largest change of the compliance of strips, and of stress, from one mesh to the next."""
    found = {(row["blade"], row["patches"]): row for row in rows}
    changes = []
    for one, other in MESHES:
        for patches, bar in COMPLIANCE_BARS.items():
            pair = [np.array(found[b, patches]["compliance_m_per_N"]) for b in (one, other)]
            change = float(np.abs(pair[0] / pair[1] - 1).max())
            judged = bar if (one, other) in JUDGED else None
            changes.append(
                {"from": one, "to": other, "patches": patches, "compliance": change, "bar": judged}
            )
    return changes


def stresses(rows: list[Row]) -> list[Row]:
    """Change of the settled stress, and of the largest anywhere, with mesh and patches."""
    found = {(r["blade"], r["patches"]): r["stress"] for r in rows if "stress" in r}
    default = found["reference", DEFAULT.patches]
    others = {
        "2.48 to 1.75 mm": found["reference-fine", DEFAULT.patches],
        "16 to 32 patches": found["reference", 2 * DEFAULT.patches],
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
