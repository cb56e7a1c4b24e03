"""Reader of nodes, solid cells and shells of a bulk data deck of Nastran or OptiStruct.

meshio 5.3 also reads these decks, but leaves out continuation lines that begin with blanks and
elements in large fields, and takes a deck without BEGIN BULK for an empty one.
"""

import re
from pathlib import Path

from geometry.abaqus import INCLUDES, mesh_of
from geometry.base import MeshError, number, read_text, require
from geometry.cards import Card
from geometry.file_mesh import FileMesh

SOLIDS = {"CTETRA": (4, 10), "CPYRAM": (5, 13), "CPENTA": (6, 15), "CHEXA": (8, 20)}  # nodes
UPRIGHT = {15: 6, 20: 8}  # their first middle node; those of upright edges stand before the upper
SOLID = re.compile(r"C(TET|HEX|PEN|PYR)")  # others of this kind are refused
# of solids; others, as MAT4 of heat, may have the number of a MAT1
MATERIAL = re.compile(r"MAT(1|3|9|11|9ORT|9OR|HP|HE|ORT|USR)|PSOLID|PCOMPL?S|PLSOLID")
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
    cards = [card for given in _cards(path) for card in _translated(*given)]
    return mesh_of(cards, cards)


def _translated(line: int, keyword: str, fields: list[str]) -> list[Card]:
    """The equivalent cards of Abaqus; cards that are not read keep their keyword."""
    first, second, *others = fields
    require(
        (
            keyword not in ("GRID", "GRDSET") or second in ("", "0"),
            f"gives nodes in a coordinate system (CP {second}): export them in the basic one",
        ),
        line=line,
    )
    if keyword == "GRID":
        return [Card("NODE", {}, line, [(line, [first, *map(_decimal, others[:3])])])]
    if MATERIAL.fullmatch(keyword):
        return _material(line, keyword, fields)
    nodes = [node for node in others if node]
    shell = SHELLS.get(keyword)
    if not (shell or SOLID.match(keyword)):
        return [Card(keyword, {}, line)]
    fewest, most = SOLIDS.get(keyword, ("", ""))
    kind = shell or f"{keyword}{fewest if len(nodes) == fewest else most}"
    its_nodes = nodes[: int(shell[-1])] if shell else _as_abaqus(nodes)
    options = {"TYPE": kind, "ELSET": f"nastran:ref={second}"}
    return [Card("ELEMENT", options, line, [(line, [first, *its_nodes])])]


def _material(line: int, keyword: str, fields: list[str]) -> list[Card]:
    """A material, or the section that names it; of MAT1 nu may stand for G, or G for nu."""
    name, E, G, nu, density, *_ = map(_decimal, [*fields, *[""] * 5])
    if keyword == "PSOLID":
        options, system = {"ELSET": f"nastran:ref={name}", "MATERIAL": E}, G
        turned = {} if system in ("", "0", "-1") else {"CORDM": system}  # -1: the element's
        return [Card("SOLID SECTION", options | turned, line)]
    if keyword.startswith("P"):
        return [Card("SOLID SECTION", {"ELSET": f"nastran:ref={name}", keyword: ""}, line)]
    material = Card("MATERIAL", {"NAME": name}, line)
    if keyword != "MAT1":
        return [material, Card("ELASTIC", {"TYPE": keyword}, line)]
    if E and G and not nu:
        nu = str(number(E) / (2 * number(G)) - 1)
    return [
        material,
        Card("ELASTIC", {}, line, [(line, [E, nu])]),
        Card("DENSITY", {}, line, [(line, [density])]),
    ]


def _decimal(text: str) -> str:
    """A number with the letter of its exponent."""
    return EXPONENT.sub("E", text)


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
    for place, given in enumerate(read_text(path, most=None, errors="replace").splitlines(), 1):
        line = given.partition("$")[0].expandtabs(8).upper()
        large = "*" in line[:8] or (large and not line[:8].strip())  # blanks go on as before
        keyword, *fields = _fields(line, *((4, 16) if large else (8, 8)))
        if line.lstrip().startswith(END):
            return cards
        if line.startswith("BEGIN BULK"):
            cards.clear()  # those before control the run
            continue
        if line.lstrip().startswith("INCLUDE"):
            raise MeshError(INCLUDES.format("INCLUDE"), line=place)
        if cards and keyword[:1] in ("", "+", "*"):  # continues the card
            cards[-1][2].extend(fields)
        else:
            cards.append((place, keyword.rstrip("*"), fields))
    raise MeshError("has no ENDDATA: is the file cut short? If it is whole, end it with ENDDATA")


def _fields(line: str, count: int, width: int) -> list[str]:
    """Keyword and ``count`` fields of a line, each of ``width`` or between commas."""
    if "," in line:
        cells = line.split(",")[: count + 1]  # the mark of a continuation stands behind them
    else:
        cells = [line[:8], *(line[i : i + width] for i in range(8, 72, width))]
    return [cell.strip() for cell in cells] + [""] * (count + 1 - len(cells))
