"""The table of reduction bases."""

from collections.abc import Mapping, Sequence
from typing import Any


def markdown(rows: Sequence[Mapping[str, Any]]) -> str:
    """Render the table of bases."""
    lines = [
        "| basis | η | natural modes | rank tolerance | interface | n | ten frequencies (%) "
        "| first seven (%) | radial compliance (%) | tangential (%) | highest (MHz) |",
        "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |",
    ]
    return "\n".join([*lines, *(_line(row) for row in rows)]) + "\n"


def _line(row: Mapping[str, Any]) -> str:
    basis, compliance = row["basis"], row["compliance_error_percent"]
    cells = [
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
    return f"| {' | '.join(str(cell) for cell in cells)} |"
