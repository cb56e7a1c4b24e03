"""Convergence of results with mesh, patches, strips and modes: limits, and tables of changes."""

from collections.abc import Sequence

import numpy as np

from workflow import markdown
from workflow.many.row import ComputedRow
from workflow.many.table import Whole

type Rows = Sequence[ComputedRow]

BARS = {  # largest changes allowed from row to row, by observable
    "3.51 to 2.48 mm": {"wear": 0.015, "amplitude": 0.003, "Omega_c": 0.0005},
    "2.48 to 1.75 mm": {"wear": 0.01, "amplitude": 0.003, "Omega_c": 0.0005},
    "16 patches, 16 strips to 32, 32": {"wear": 0.03, "volume": 0.01},
    "24 to 36 natural modes": {"wear": 0.005},
}
DEFAULT = "default"  # row whose difference from its twin is shown, and whose stress is compared
SHOWN = ("wear", "volume", "amplitude", "Omega_c", "force")  # in the tables
PEAK = "peak"  # label of the sweeps over the peak, and of the runs whose stress is compared
MESHES = (  # each mesh with the next finer one, and whether their difference is judged
    ("reference-coarse", "reference", False),
    ("reference", "reference-fine", True),
    ("rotor37", "rotor37-fine", True),
)
COMPLIANCE_BARS = {8: 0.003, 16: 0.006}  # by patches
OPERATOR_BARS = {"constant": 1e-8, "linear": 1e-8, "ST": 1e-9, "compliance_of_model": 1e-6}
FREQUENCY_BAR, STRESS_BAR = 1e-4, 0.03


def table(changes: Whole, models: Whole) -> str:
    """The whole study as Markdown, a table under each title.

    ``changes``, ``models``: rows of the experiments ``interface`` and ``interface-models``.
    """
    of_patches = [row for row in models if row["scene"] != PEAK]
    parts = {
        "Errors of S and of the reduced model": operators(of_patches),
        "Ten frequencies at 17 speeds": frequencies(of_patches),
        "Compliance at the strips, between meshes": compliances(of_patches),
        "Results": results(changes),
        "Largest stress away from clamp and contact": stress(models),
    }
    return "\n\n".join(f"## {title}\n\n{text}" for title, text in parts.items()) + "\n"


def operators(rows: Rows) -> str:
    """Errors of S on fields it represents exactly, of S T = [I 0], of the compliance at rest."""
    lines = [
        [row["blade"], row["numbers"]["patches"], row["numbers"]["n"]]
        + [
            _judged(row["numbers"][key], bar, f"{row['numbers'][key]:.1e}")
            for key, bar in OPERATOR_BARS.items()
        ]
        for row in rows
    ]
    return markdown.table(
        ["blade", "patches", "n", *(f"{k} (<= {bar:g})" for k, bar in OPERATOR_BARS.items())], lines
    )


def frequencies(rows: Rows) -> str:
    """Largest error of ten frequencies of each default model."""
    errors = {row["blade"]: row["numbers"]["frequencies"] for row in rows}
    lines = [
        [blade, _judged(error, FREQUENCY_BAR, markdown.percent(error))]
        for blade, error in errors.items()
    ]
    return markdown.table(["blade", f"largest error (<= {100 * FREQUENCY_BAR:g} %)"], lines)


def compliances(rows: Rows) -> str:
    """Largest change of the compliance at as many strips as patches, from mesh to mesh."""
    found = {
        (row["blade"], row["numbers"]["patches"]): np.array(row["numbers"]["compliance_m_per_N"])
        for row in rows
    }
    lines = [
        [
            one,
            other,
            patches,
            _share(
                float(np.abs(found[one, patches] / found[other, patches] - 1).max()),
                bar if judged else None,
            ),
        ]
        for one, other, judged in MESHES
        for patches, bar in COMPLIANCE_BARS.items()
    ]
    return markdown.table(["from", "to", "patches", "largest change"], lines)


def results(rows: Rows) -> str:
    """Changes of the outputs; for gaps changed by 1e-10, the largest difference of the twin."""
    at_peak = {
        row["row"]: row["numbers"]["errors"]
        for row in rows
        if row["scene"] == PEAK and row["row"] in BARS
    }
    lines = []
    for label in dict.fromkeys(row["scene"] for row in rows if row["scene"] != PEAK):
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


def stress(rows: Rows) -> str:
    """Change with mesh and patches of the largest von Mises stress.

    Away from clamp and contact, and anywhere.
    """
    at_peak = {row["row"]: row["numbers"] for row in rows if row["scene"] == PEAK}
    default = at_peak.pop(DEFAULT)
    lines = [
        [
            name,
            _share(abs(default["away_Pa"] / found["away_Pa"] - 1), STRESS_BAR),
            markdown.percent(abs(default["largest_Pa"] / found["largest_Pa"] - 1)),
        ]
        for name, found in at_peak.items()
    ]
    return markdown.table(["change", "away from clamp and contact", "anywhere"], lines)


def _share(value: float | None, bar: float | None) -> str:
    text = markdown.percent(value)
    return text if None in (value, bar) else _judged(value, bar, f"{text} (<= {100 * bar:g} %)")


def _judged(value: float, bar: float, text: str) -> str:
    return text if value <= bar else f"**{text}** missed"
