"""Reader of nodes, tetrahedra and triangles of a bulk data deck of Nastran or OptiStruct.

meshio 5.3 also reads these decks, but leaves out continuation lines that begin with blanks and
elements in large fields, and takes a deck without BEGIN BULK for an empty one.
"""

import re
from pathlib import Path

from geometry.abaqus import INCLUDES, Card, mesh_of
from geometry.file_mesh import FileMesh
from geometry.project import MeshError, read_text

SOLID = re.compile(r"C(TET|HEX|PEN|PYR)")
TRIANGLES = ("CTRIA3", "CTRIA6", "CTRIAR")
END = ("ENDDATA", "END DATA", "END BULK")
EXPONENT = re.compile(r"(?<=[\d.])(?=[-+])")  # without its letter: 1.5-3 is 1.5E-3


def read_bulk(path: Path) -> FileMesh:
    """Read a deck of a single file; triangles are grouped by the number of their property.

    Raises
    ------
    MeshError
        When it includes other files or has no end, nodes stand twice, are incomplete or in other
        coordinate systems, or elements lack nodes or are solids other than tetrahedra.
    """
    return mesh_of([card for given in _cards(path) if (card := _translated(*given))])


def _translated(line: int, keyword: str, fields: list[str]) -> Card | None:
    """The card of Abaqus that says the same; none for what is not read."""
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
    if keyword in TRIANGLES:  # by their corners
        options = {"TYPE": "CTRIA3", "ELSET": f"nastran:ref={second}"}
        return Card("ELEMENT", options, line, [(line, [number, *nodes[:3]])])
    kind = f"CTETRA{4 if len(nodes) == 4 else 10}" if keyword == "CTETRA" else keyword
    element = Card("ELEMENT", {"TYPE": kind}, line, [(line, [number, *nodes])])
    return element if SOLID.match(keyword) else None


def _cards(path: Path) -> list[tuple[int, str, list[str]]]:
    """Line, keyword and fields of each card to the end of the deck, other sections included."""
    cards: list[tuple[int, str, list[str]]] = []
    large = False
    for at, given in enumerate(read_text(path, most=None, errors="replace").splitlines(), 1):
        line = given.partition("$")[0].expandtabs(8).upper()
        large = "*" in line[:8] or (large and not line[:8].strip())  # blanks go on as before
        keyword, *fields = _fields(line, *((4, 16) if large else (8, 8)))
        if line.lstrip().startswith(END):
            return cards
        if line.lstrip().startswith("INCLUDE"):
            raise MeshError(INCLUDES.format("INCLUDE"), line=at)
        if cards and keyword[:1] in ("", "+", "*"):  # continues the card
            cards[-1][2].extend(fields)
        else:
            cards.append((at, keyword.rstrip("*"), fields))
    raise MeshError("has no ENDDATA: is the file cut short? If it is whole, end it with ENDDATA")


def _fields(line: str, count: int, width: int) -> list[str]:
    """Keyword and ``count`` fields of a line, each of ``width`` or between commas."""
    if "," in line:
        cells = line.split(",")[: count + 1]  # the mark of a continuation stands behind them
    else:
        cells = [line[:8], *(line[i : i + width] for i in range(8, 72, width))]
    return [cell.strip() for cell in cells] + [""] * (count + 1 - len(cells))
