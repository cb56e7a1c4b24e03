"""Convergence of results with mesh, patches, strips and modes: changes, limits, and tables."""

from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from geometry.project import read_json
from rom.check import RomCheck
from rom.model import Rom
from simulate.errors.neighbours import TWIN, Case
from simulate.errors.observables import differences
from simulate.marching import prepare
from simulate.scene import STRIPS, Scene
from workflow import markdown
from workflow.study.interface_plan import (
    COMPARED,
    COMPLIANCE_BARS,
    DEFAULT,
    FREQUENCY_BAR,
    MESHES,
    OPERATOR_BARS,
    RODS,
    SCENES,
    SHOWN,
    STEPS,
    STRESS_BAR,
    STRESSED,
)
from workflow.study.trade import case_of
from workflow.study.trade_plan import Model, Studied, exact
from workflow.study.trade_runs import Row, Run, errors, rom_of, run


def numbers(files: Any, scenes: dict[str, Row]) -> Row:
    """The whole study: rows of each mesh from ``files``, and runs of ``scenes`` by short name."""
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


def compare(name: str, values: Row) -> Iterator[Row]:
    """Rows of one scene: each comparison, and the difference of the default from its twin."""
    studied, scene = SCENES[name], Scene(**values)

    def case_on(model: Model, strips: int) -> tuple[Scene, Rom]:
        setting = exact(model.to(scene.directions), STEPS, RODS[studied.tip], strips)
        rom = rom_of(setting.model)
        return case_of(scene, rom, setting), rom

    @cache
    def marched(model: Model, strips: int) -> Run:
        return run(*case_on(model, strips), studied, turns=0)

    for label, pair in COMPARED.items():
        row = _row(name, label, *map(marched, (pair.one, pair.other), pair.strips))
        print(row)
        yield row
    yield _twin(name, studied, *case_on(DEFAULT, STRIPS))


def _row(name: str, label: str, one: Run, other: Run) -> Row:
    """Changes from one run to the other, over the other; without a peak (nan) no limit is met."""
    volume = abs(one.numbers["worn_volume"] / other.numbers["worn_volume"] - 1)
    changes = errors(one, other) | {"volume": volume}
    bars = COMPARED[label].bars
    return {
        "scene": name,
        "change": label,
        "changes": {key: changes[key] for key in SHOWN},
        "bars": bars,
        "met": all(changes[key] is None or changes[key] <= bar for key, bar in bars.items()),
        "status": [one.status, other.status],
    }


def _twin(name: str, studied: Studied, case: Scene, rom: Rom) -> Row:
    """The largest relative difference from the run with all gaps changed by 1e-10."""
    of = Case(case, rom, prepare(case, rom, rom.omega1 * studied.speed))
    departures = differences(of.march(), of.beside(TWIN).march())
    return {"scene": name, "change": "gaps by 1e-10", "largest": max(departures.values())}


def between_meshes(rows: list[Row]) -> list[Row]:
    """Largest change of the compliance of strips from one mesh to the next."""
    of = {(row["blade"], row["patches"]): np.array(row["compliance_m_per_N"]) for row in rows}
    return [
        {
            "from": one,
            "to": other,
            "patches": patches,
            "compliance": float(np.abs(of[one, patches] / of[other, patches] - 1).max()),
            "bar": bar if judged else None,
        }
        for one, other, judged in MESHES
        for patches, bar in COMPLIANCE_BARS.items()
    ]


def stresses(rows: list[Row]) -> list[Row]:
    """Change with mesh and patches of the largest stress: away from clamp and tip, and anywhere."""
    of = {(r["blade"], r["patches"]): r["stress"] for r in rows if "stress" in r}
    default, fine, twice = (of[model] for model in STRESSED)
    others = {"2.48 to 1.75 mm": fine, "16 to 32 patches": twice}
    return [
        {
            "change": label,
            "away": abs(default["away_Pa"] / other["away_Pa"] - 1),
            "anywhere": abs(default["largest_Pa"] / other["largest_Pa"] - 1),
            "bar": STRESS_BAR,
            "away_Pa": [default["away_Pa"], other["away_Pa"]],
        }
        for label, other in others.items()
    ]


def table(study: Row) -> str:
    """The whole study as Markdown, a table under each title."""
    parts = {
        "Errors of S and of the reduced model": operators(study),
        "Ten frequencies at 17 speeds": frequencies(study),
        "Compliance at the strips, between meshes": compliances(study),
        "Results": results(study),
        "Largest stress away from clamp and contact": stress(study),
        "All nodes of the tip as interface": all_nodes(study),
    }
    return "\n\n".join(f"## {title}\n\n{text}" for title, text in parts.items()) + "\n"


def operators(study: Row) -> str:
    """Errors of S on fields it represents exactly, of S T = [I 0], of the compliance at rest."""
    head = ["blade", "patches", "n", *(f"{k} (<= {bar:g})" for k, bar in OPERATOR_BARS.items())]
    rows = [
        [r["blade"], str(r["patches"]), str(r["n"])]
        + [_judged(r[key], bar, f"{r[key]:.1e}") for key, bar in OPERATOR_BARS.items()]
        for r in study["models"]
    ]
    return markdown.table(head, rows)


def frequencies(study: Row) -> str:
    """Largest error of ten frequencies of each default model."""
    rows = [
        [blade, _judged(error, FREQUENCY_BAR, markdown.percent(error))]
        for blade, error in study["frequencies"].items()
    ]
    return markdown.table(["blade", f"largest error (<= {100 * FREQUENCY_BAR:g} %)"], rows)


def compliances(study: Row) -> str:
    """Largest change of the compliance at as many strips as patches."""
    rows = [
        [r["from"], r["to"], str(r["patches"]), _share(r["compliance"], r["bar"])]
        for r in study["between_meshes"]
    ]
    return markdown.table(["from", "to", "patches", "largest change"], rows)


def results(study: Row) -> str:
    """Changes of the outputs; for gaps changed by 1e-10, the largest difference of the twin."""
    rows = []
    for row in study["changes"]:
        if "largest" in row:
            rows.append([row["scene"], row["change"], f"{row['largest']:.1e}", *[""] * 4])
        else:
            changes = [_share(row["changes"][key], row["bars"].get(key)) for key in SHOWN]
            rows.append([row["scene"], row["change"], *changes])
    return markdown.table(["scene", "change", *(name.replace("_", " ") for name in SHOWN)], rows)


def stress(study: Row) -> str:
    """Change of the largest von Mises stress, away from clamp and contact, and anywhere."""
    rows = [
        [r["change"], _share(r["away"], r["bar"]), markdown.percent(r["anywhere"])]
        for r in study["stress"]
    ]
    return markdown.table(["change", "away from clamp and contact", "anywhere"], rows)


def all_nodes(study: Row) -> str:
    """The default against contact at every node of the tip, moving freely or with the patches."""
    rows = [
        [
            r["scene"],
            r["moving"],
            markdown.percent(r["wear"]),
            *(f"{100 * r[key]:+.2g} %" for key in ("volume", "amplitude")),
        ]
        for r in study["all_nodes"]
    ]
    return markdown.table(["scene", "nodes move", "wear", "volume", "amplitude"], rows)


def _share(value: float | None, bar: float | None) -> str:
    text = markdown.percent(value)
    return text if None in (value, bar) else _judged(value, bar, f"{text} (<= {100 * bar:g} %)")


def _judged(value: float, bar: float, text: str) -> str:
    return text if value <= bar else f"**{text}** missed"
