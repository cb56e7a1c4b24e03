"""Errors of reduction bases against the full model.

The paper's bases belong to a blade with an interface of points, all others to one of patches.
"""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from fem.matrices import Matrices
from geometry.blade import EnrichedBasis, PaperBasis
from rom.check import RomCheck, check
from rom.full_model import FullModel
from rom.model import Rom
from rom.reduce import reduce
from rom.speeds import basis_speeds
from workflow import markdown


def paper(eta: int, rank_tolerance: float) -> PaperBasis:
    """The paper's basis with ``eta`` fixed-interface modes and another rank tolerance."""
    return PaperBasis(kind="paper", fixed_interface_modes=eta, rank_tolerance=rank_tolerance)


type Bases = Sequence[tuple[EnrichedBasis | PaperBasis, str]]

# On points: the paper's own, and with more modes.
ON_POINTS: Bases = ((paper(6, 1e-6), "rtz"), (paper(9, 1e-4), "rtz"), (paper(12, 1e-4), "rtz"))
# On patches: the default, with more or fewer vectors, and with fewer directions.
ON_PATCHES: Bases = (
    (EnrichedBasis(natural_modes=10), "rtz"),
    (EnrichedBasis(rank_tolerance=1e-2), "rtz"),
    (EnrichedBasis(), "rtz"),
    (EnrichedBasis(rank_tolerance=1e-3), "rtz"),
    (EnrichedBasis(natural_modes=36), "rtz"),
    (EnrichedBasis(), "rt"),
    (EnrichedBasis(), "r"),
)
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


def numbers(files: Any) -> list[dict[str, Any]]:
    """Rows of our bases and, if ``files.of_paper`` has matrices and full model, of the paper's."""
    rows = []
    if files.of_paper:  # the blade with the paper's interface of points
        matrices, full = files.of_paper
        rows += compare(Matrices.load(matrices), FullModel.load(full), ON_POINTS)
    rows += compare(Matrices.load(files.matrices), FullModel.load(files.full), ON_PATCHES)
    return rows


def compare(fom: Matrices, full: FullModel, bases: Bases) -> Iterator[dict[str, Any]]:
    """One row for each basis; ``fom`` at their speeds, ``full`` with the same interface."""
    for basis, directions in bases:
        needed = basis_speeds(basis, float(fom.speeds[-1]))
        rom, _ = reduce(fom.at(needed), basis, directions)
        yield _row(basis, rom, check(rom, full))


def _row(basis: EnrichedBasis | PaperBasis, rom: Rom, checked: RomCheck) -> dict[str, Any]:
    compliance = 100 * abs(checked.compliance_error).max(axis=(0, 1))
    return {
        "basis": basis.model_dump(mode="json"),
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
