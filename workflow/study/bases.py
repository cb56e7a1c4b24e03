"""Errors of reduction bases against the full model."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from geometry.blade import Blade
from rom.check import RomCheck
from rom.model import Rom
from workflow import markdown
from workflow.experiment.row import ExperimentRow
from workflow.markdown import rounded

HEAD = (
    "basis",
    "η",
    "natural modes",
    "rank tolerance",
    "interface",
    "n",
    "ten frequencies (%)",
    "first seven (%)",
    "radial compliance (%)",
    "tangential (%)",
    "highest (MHz)",
)


def numbers(blade: Blade, rom: Rom, check: str) -> dict[str, Any]:
    """The basis of a blade, and the largest errors of its reduced model in the file ``check``."""
    checked = RomCheck.load(check)
    error, compliance = abs(checked.error), abs(checked.compliance_error).max(axis=(0, 1))
    return {
        "basis": blade.basis.model_dump(mode="json"),
        "directions": list(rom.directions),
        "n": rom.n,
        "frequency_error_percent": rounded(100 * error.max(), 2),
        "frequency_error_7_percent": rounded(100 * error[:, :7].max(), 2),
        "compliance_error_percent": {
            direction: rounded(100 * value, 2)
            for direction, value in zip(rom.directions, compliance, strict=True)
        },
        "highest_MHz": rounded(checked.highest / (2e6 * np.pi), 3),
    }


def table(rows: Sequence[ExperimentRow]) -> str:
    """Markdown table of the bases."""
    return markdown.table(HEAD, [_cells(**row["numbers"]) for row in rows])


def _cells(
    basis: Mapping[str, Any],
    directions: Sequence[str],
    compliance_error_percent: Mapping[str, float],
    **numbers: float,
) -> list[Any]:
    names = "n", "frequency_error_percent", "frequency_error_7_percent"
    return [
        basis["kind"],
        basis.get("fixed_interface_modes", ""),
        basis.get("natural_modes", ""),
        f"{basis['rank_tolerance']:g}",
        ", ".join(directions),
        *map(numbers.get, names),
        compliance_error_percent["radial"],
        compliance_error_percent.get("tangential", ""),
        numbers["highest_MHz"],
    ]
