"""Errors of reduction bases against the full model."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from geometry.blade import Blade
from rom.check import RomCheck
from rom.model import Rom
from workflow import markdown

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
    compliance = 100 * abs(checked.compliance_error).max(axis=(0, 1))
    return {
        "basis": blade.basis.model_dump(mode="json"),
        "directions": list(rom.directions),
        "n": rom.n,
        "frequency_error_percent": _digits(100 * abs(checked.error).max()),
        "frequency_error_7_percent": _digits(100 * abs(checked.error[:, :7]).max()),
        "compliance_error_percent": dict(
            zip(rom.directions, map(_digits, compliance), strict=True)
        ),
        "highest_MHz": _digits(checked.highest / (2e6 * np.pi), 3),
    }


def _digits(value: float, digits: int = 2) -> float:
    return float(f"{value:.{digits}g}")


def table(rows: Sequence[Mapping[str, Any]]) -> str:
    """Markdown table of the bases."""
    return markdown.table(HEAD, map(_cells, rows))


def _cells(row: Mapping[str, Any]) -> list[Any]:
    row = row["numbers"]
    basis, compliance = row["basis"], row["compliance_error_percent"]
    return [
        basis["kind"],
        basis.get("fixed_interface_modes", ""),
        basis.get("natural_modes", ""),
        f"{basis['rank_tolerance']:g}",
        ", ".join(row["directions"]),
        row["n"],
        row["frequency_error_percent"],
        row["frequency_error_7_percent"],
        compliance["radial"],
        compliance.get("tangential", ""),
        row["highest_MHz"],
    ]
