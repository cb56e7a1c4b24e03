"""The table of reduction bases."""

from collections.abc import Mapping, Sequence
from typing import Any

from workflow.markdown import table

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


def markdown(rows: Sequence[Mapping[str, Any]]) -> str:
    """Render the table of bases."""
    return table(HEAD, map(_cells, rows)) + "\n"


def _cells(row: Mapping[str, Any]) -> list[Any]:
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
