"""Convergence of results with mesh, patches, strips and modes: changes, limits, and tables."""

from pathlib import Path
from typing import Any

import numpy as np

from geometry.base import read_json
from rom.check import RomCheck
from simulate.errors.neighbours import TWIN
from simulate.errors.observables import differences
from simulate.errors.run import Run
from workflow import markdown
from workflow.experiment.engine import Marched
from workflow.study.interface_models import STRESSED
from workflow.study.trade import Row, errors

BARS = {  # largest changes allowed from row to row, by observable
    "3.51 to 2.48 mm": {"wear": 0.015, "amplitude": 0.003, "Omega_c": 0.0005},
    "2.48 to 1.75 mm": {"wear": 0.01, "amplitude": 0.003, "Omega_c": 0.0005},
    "16 patches, 16 strips to 32, 32": {"wear": 0.03, "volume": 0.01},
    "24 to 36 natural modes": {"wear": 0.005},
}
DEFAULT = "default"  # row whose difference from its twin is shown
SHOWN = ("wear", "volume", "amplitude", "Omega_c", "force")  # in the tables
MESHES = (  # each mesh with the next finer one, and whether their difference is judged
    ("reference-coarse", "reference", False),
    ("reference", "reference-fine", True),
    ("rotor37", "rotor37-fine", True),
)
COMPLIANCE_BARS = {8: 0.003, 16: 0.006}  # by patches
OPERATOR_BARS = {"constant": 1e-8, "linear": 1e-8, "ST": 1e-9, "compliance_of_model": 1e-6}
FREQUENCY_BAR, STRESS_BAR = 1e-4, 0.03


def changes(single: Run, reference: Marched | None) -> Row:
    """Errors against the ``reference``; without one the largest difference from the twin."""
    numbers = errors(single, reference)
    if reference is not None:
        return numbers
    twin = single.neighbour(TWIN).march()
    return numbers | {"largest": max(differences(single, twin).values())}


def numbers(files: Any) -> Row:
    """The whole study: rows of each mesh, and of the experiment."""
    models = [row for path in files.models for row in read_json(path)]
    checks = {Path(path).parent.name: RomCheck.load(path) for path in files.checks}
    return {
        "models": models,
        "frequencies": {blade: float(abs(c.error).max()) for blade, c in checks.items()},
        "between_meshes": between_meshes(models),
        "changes": read_json(files.table),
        "stress": stresses(models),
    }


def between_meshes(rows: list[Row]) -> list[Row]:
    """Largest change of the compliance of strips from one mesh to the next."""
    compliances = {
        (row["blade"], row["patches"]): np.array(row["compliance_m_per_N"]) for row in rows
    }
    return [
        {
            "from": one,
            "to": other,
            "patches": patches,
            "compliance": float(
                np.abs(compliances[one, patches] / compliances[other, patches] - 1).max()
            ),
            "bar": bar if judged else None,
        }
        for one, other, judged in MESHES
        for patches, bar in COMPLIANCE_BARS.items()
    ]


def stresses(rows: list[Row]) -> list[Row]:
    """Change with mesh and patches of the largest stress: away from clamp and tip, and anywhere."""
    by_model = {(r["blade"], r["patches"]): r["stress"] for r in rows if "stress" in r}
    default, fine, twice = (by_model[model] for model in STRESSED)
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
    }
    return "\n\n".join(f"## {title}\n\n{text}" for title, text in parts.items()) + "\n"


def operators(study: Row) -> str:
    """Errors of S on fields it represents exactly, of S T = [I 0], of the compliance at rest."""
    rows = [
        [r["blade"], str(r["patches"]), str(r["n"])]
        + [_judged(r[key], bar, f"{r[key]:.1e}") for key, bar in OPERATOR_BARS.items()]
        for r in study["models"]
    ]
    return markdown.table(
        ["blade", "patches", "n", *(f"{k} (<= {bar:g})" for k, bar in OPERATOR_BARS.items())], rows
    )


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
    rows = study["changes"]
    at_peak = {
        row["row"]: row["numbers"]["errors"]
        for row in rows
        if row["scene"] == "peak" and row["row"] in BARS
    }
    lines = []
    for label in dict.fromkeys(row["scene"] for row in rows if row["scene"] != "peak"):
        numbers = {row["row"]: row["numbers"] for row in rows if row["scene"] == label}
        for name, bars in BARS.items():
            errors = (
                {"Omega_c": None}
                | numbers[name]["errors"]
                | (at_peak[name] if label == "resonance" else {})
            )
            lines.append([label, name, *(_share(errors[key], bars.get(key)) for key in SHOWN)])
        lines.append([label, "gaps by 1e-10", f"{numbers[DEFAULT]['largest']:.1e}", *[""] * 4])
    return markdown.table(["scene", "change", *(name.replace("_", " ") for name in SHOWN)], lines)


def stress(study: Row) -> str:
    """Change of the largest von Mises stress, away from clamp and contact, and anywhere."""
    rows = [
        [r["change"], _share(r["away"], r["bar"]), markdown.percent(r["anywhere"])]
        for r in study["stress"]
    ]
    return markdown.table(["change", "away from clamp and contact", "anywhere"], rows)


def _share(value: float | None, bar: float | None) -> str:
    text = markdown.percent(value)
    return text if None in (value, bar) else _judged(value, bar, f"{text} (<= {100 * bar:g} %)")


def _judged(value: float, bar: float, text: str) -> str:
    return text if value <= bar else f"**{text}** missed"
