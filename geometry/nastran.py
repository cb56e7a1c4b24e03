"""Reader of nodes, solid cells and shells of a bulk data deck of Nastran or OptiStruct.

meshio 5.3 also reads these decks, but leaves out continuation lines that begin with blanks and
elements in large fields, and takes a deck without BEGIN BULK for an empty one.
"""

import re
from pathlib import Path

from geometry.abaqus import INCLUDES, Card, mesh_of
from geometry.file_mesh import FileMesh
from geometry.project import MeshError, read_text

SOLIDS = {"CTETRA": (4, 10), "CPYRAM": (5, 13), "CPENTA": (6, 15), "CHEXA": (8, 20)}  # nodes
UPRIGHT = {15: 6, 20: 8}  # their first middle node; those of upright edges stand before the upper
SOLID = re.compile(r"C(TET|HEX|PEN|PYR)")  # others of this kind are refused
SHELLS = {  # by their corners
    **dict.fromkeys(("CTRIA3", "CTRIA6", "CTRIAR"), "CTRIA3"),
    **dict.fromkeys(("CQUAD4", "CQUAD8", "CQUADR"), "CQUAD4"),
}
END = ("ENDDATA", "END DATA", "END BULK")
EXPONENT = re.compile(r"(?<=[\d.])(?=[-+])")  # without its letter: 1.5-3 is 1.5E-3


def read_bulk(path: Path) -> FileMesh:
    """Read a deck of a single file; shells are grouped by the number of their property.

    Raises
    ------
    MeshError
        When it includes other files or has no end, nodes stand twice, are incomplete or in other
        coordinate systems, or elements lack nodes.
    """
    return mesh_of([card for given in _cards(path) if (card := _translated(*given))])


def _translated(line: int, keyword: str, fields: list[str]) -> Card | None:
    """The equivalent card of Abaqus; none for cards that are not read."""
    number, second, *others = fields
    if keyword in ("GRID", "GRDSET") and second not in ("", "0"):
        raise MeshError(
            f"gives nodes in a coordinate system (CP {second}): export them in the basic one",
            line=line,
        )
    if keyword == "GRID":
        row = [number, *(EXPONENT.sub("E", x) for x in others[:3])]
        return Card("NODE", {}, line, [(line, row)])
    nodes = [node for node in others if node]
    if shell := SHELLS.get(keyword):
        options = {"TYPE": shell, "ELSET": f"nastran:ref={second}"}
        return Card("ELEMENT", options, line, [(line, [number, *nodes[: int(shell[-1])]])])
    if not SOLID.match(keyword):
        return None
    first, most = SOLIDS.get(keyword, ("", ""))
    kind = f"{keyword}{first if len(nodes) == first else most}"
    return Card("ELEMENT", {"TYPE": kind}, line, [(line, [number, *_as_abaqus(nodes)])])


def _as_abaqus(nodes: list[str]) -> list[str]:
    """Nodes of a solid cell, its middle nodes in the order of Abaqus: lower, upper, upright."""
    if (first := UPRIGHT.get(len(nodes))) is None:
        return nodes
    around = first // 2
    lower, upright = first + around, first + 2 * around
    return [*nodes[:lower], *nodes[upright:], *nodes[lower:upright]]


def _cards(path: Path) -> list[tuple[int, str, list[str]]]:
    """Line, keyword and fields of each card to the end of the deck, other sections included."""
    cards: list[tuple[int, str, list[str]]] = []
    large = False
    for number, given in enumerate(read_text(path, most=None, errors="replace").splitlines(), 1):
        line = given.partition("$")[0].expandtabs(8).upper()
        large = "*" in line[:8] or (large and not line[:8].strip())  # blanks go on as before
        keyword, *fields = _fields(line, *((4, 16) if large else (8, 8)))
        if line.lstrip().startswith(END):
            return cards
        if line.lstrip().startswith("INCLUDE"):
            raise MeshError(INCLUDES.format("INCLUDE"), line=number)
        if cards and keyword[:1] in ("", "+", "*"):  # continues the card
            cards[-1][2].extend(fields)
        else:
            cards.append((number, keyword.rstrip("*"), fields))
    raise MeshError("has no ENDDATA: is the file cut short? If it is whole, end it with ENDDATA")


def _fields(line: str, count: int, width: int) -> list[str]:
    """Keyword and ``count`` fields of a line, each of ``width`` or between commas."""
    if "," in line:
        cells = line.split(",")[: count + 1]  # the mark of a continuation stands behind them
    else:
        cells = [line[:8], *(line[i : i + width] for i in range(8, 72, width))]
    return [cell.strip() for cell in cells] + [""] * (count + 1 - len(cells))
