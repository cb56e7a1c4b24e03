"""Reader of nodes, elements and sets of an Abaqus or CalculiX deck.

meshio 5.3 also reads these decks, but assigns element sets to the wrong elements when only some
*ELEMENT cards name one, keeps only the last of several *NODE, *NSET or *ELSET cards, and supports
neither *SURFACE nor the six-node plane elements that gmsh writes.
"""

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from geometry.errors import MeshError
from geometry.file_mesh import FileMesh, tetrahedra_of
from geometry.text_file import number, read_text, shown

SOLID = re.compile(r"C3D(\d+)")
PLANE = re.compile(r"(?:S|STRI|CPS|CPE|CPEG|CAX|M3D|SFM3D|R3D|DS)(\d)")  # shells and the like
LINE = re.compile(r"B\d|T[23]D|R2D|RB|PIPE|FRAME|SPRING|DASHPOT|GAP|MASS|ROTARYI|CONN|DCOUP")
KINDS = {"4": "tetra", "10": "tetra10", "8": "hexahedron", "20": "hexahedron20", "6": "wedge"}
KINDS |= {"15": "wedge15", "5": "pyramid", "13": "pyramid13", "27": "hexahedron27"}
SIDES = {"S1": (0, 2, 1), "S2": (0, 1, 3), "S3": (1, 2, 3), "S4": (0, 3, 2)}  # of tetrahedra
MOST_DIGITS, MOST_RANGE = 10, 10**8  # of a number, and in a generated set
MOST_UNUSED = 0.1  # of the nodes: those of reference points and beams are fewer
GENERATED = {"NGEN", "NFILL", "NCOPY", "NMAP", "ELGEN", "ELCOPY", "SYSTEM"}


@dataclass
class _Card:
    keyword: str
    options: dict[str, str]
    line: int
    rows: list[list[str]] = field(default_factory=list)
    lines: list[int] = field(default_factory=list)  # of the rows

    def option(self, name: str) -> str:
        """An option without which the card says nothing."""
        if not self.options.get(name):
            raise MeshError(f"line {self.line}: *{self.keyword} has no {name}")
        return self.options[name]


type _Elements = dict[int, tuple[str, list[int]]]  # kind and nodes by number


def read_deck(path: Path) -> FileMesh:
    """Read a deck of a single file; names of groups are in capitals.

    Raises
    ------
    MeshError
        When it includes other files, has parts with a numbering of their own, cards that generate
        nodes or elements, solid elements other than tetrahedra, or is damaged: a line that cannot
        be read, a node or element that is incomplete or defined twice in different ways.
    """
    cards = list(_cards(path))
    _check(cards)
    nodes = _nodes(cards)
    row = {number: i for i, number in enumerate(nodes)}
    elements = _elements(cards, row)
    if cards and cards[-1].keyword == "ELEMENT":
        _check_used(len(nodes), elements)
    node_sets, element_sets = _sets(cards, "NSET", "NODE"), _sets(cards, "ELSET", "ELEMENT")
    faces = {name: _shells(numbers, elements) for name, numbers in element_sets.items()}
    for card in (card for card in cards if card.keyword == "SURFACE"):
        if card.options.get("TYPE") == "NODE":
            members = [
                i
                for line, (value, *_) in zip(card.lines, card.rows, strict=True)
                for i in _numbers(value, node_sets, line)
            ]
            node_sets[card.option("NAME")] = members
        else:
            faces[card.option("NAME")] = _surface(card, elements, element_sets)
    return FileMesh(
        points=np.array(list(nodes.values()), dtype=float),
        cells=tetrahedra_of(_solids(elements)),
        node_groups={
            name: np.array([row[i] for i in numbers if i in row], dtype=int)
            for name, numbers in node_sets.items()
        },
        face_groups={name: np.array(f, dtype=int).reshape(-1, 3) for name, f in faces.items()},
    )


def _nodes(cards: list[_Card]) -> dict[int, list[float]]:
    """Coordinates by number of the node."""
    nodes: dict[int, list[float]] = {}
    for card in (card for card in cards if card.keyword == "NODE"):
        for line, (given, *place) in zip(card.lines, card.rows, strict=True):
            if len(place) < 3:
                raise MeshError(f"line {line}: a node needs its number and three coordinates")
            try:
                point = [number(x) for x in place[:3]]
            except ValueError as error:
                raise MeshError(f"line {line}: {error}: a node has three coordinates") from None
            if nodes.setdefault(_whole(given, line), point) != point:
                raise MeshError(
                    f"line {line}: node {given} is defined twice, in different places: number the "
                    "nodes of all parts anew"
                )
    return nodes


def _elements(cards: list[_Card], row: dict[int, int]) -> _Elements:
    """Kind of each element, and its nodes by their places in ``row``."""
    elements: _Elements = {}
    for card in (card for card in cards if card.keyword == "ELEMENT"):
        for number_, *of in _numbering(card):
            if unknown := [i for i in of if i not in row]:
                raise MeshError(
                    f"element {number_} names node {unknown[0]}, which no *NODE defines: is the "
                    "file cut short?"
                )
            element = card.options["TYPE"], [row[i] for i in of]
            if elements.setdefault(number_, element) != element:
                raise MeshError(
                    f"element {number_} is defined twice, with different nodes: number the "
                    "elements of all parts anew"
                )
    return elements


def _check_used(nodes: int, elements: _Elements) -> None:
    """Refuse many nodes without an element: a deck has no end, and may lack its last elements."""
    unused = nodes - len({node for _, of in elements.values() for node in of})
    if unused > MOST_UNUSED * nodes and elements:
        raise MeshError(
            f"{unused} of {nodes} nodes belong to no element of a solid or shell: is the file cut "
            "short?"
        )


def _cards(path: Path) -> Iterator[_Card]:
    try:
        text = read_text(path, most=None, errors="replace")
    except ValueError as error:
        raise MeshError(str(error)) from None
    card, keyword = None, ""
    for at, line in enumerate(text.splitlines(), 1):
        if line.startswith("**") or not line.strip():
            continue
        if line.startswith("*") or keyword:
            keyword += line.strip()
            if keyword.endswith(","):  # continued in the next line
                continue
            if card:
                yield card
            card, keyword = _card(keyword, at), ""
        elif card:
            card.rows.append([value.strip() for value in line.split(",")])
            card.lines.append(at)
    if card:
        yield card


def _card(text: str, line: int) -> _Card:
    keyword, *options = text.lstrip("*").split(",")
    pairs = [option.partition("=") for option in options]
    values = {name.strip().upper(): value.strip().strip('"').upper() for name, _, value in pairs}
    return _Card(keyword.strip().upper(), values, line)


def _whole(text: str, line: int) -> int:
    """A number of a node or element."""
    if not (text.isascii() and text.isdigit()) or len(text) > MOST_DIGITS:
        raise MeshError(f"line {line}: {shown(text)} is no number of a node or element")
    return int(text)


def _check(cards: list[_Card]) -> None:
    keywords = [card.keyword for card in cards]
    if "INCLUDE" in keywords:  # Snakemake would not see the other file change
        raise MeshError("has *INCLUDE, whose file would not be watched: export one file")
    if generating := sorted(GENERATED & set(keywords)):
        raise MeshError(f"*{generating[0]} generates nodes or elements: export the mesh itself")
    moved = any(card.keyword == "INSTANCE" and card.rows for card in cards)
    if keywords.count("PART") > 1 or keywords.count("INSTANCE") > 1 or moved:
        raise MeshError("has several parts or a moved instance: export a deck without parts")


def _numbering(card: _Card) -> list[list[int]]:
    """Number and nodes of each element of a card; empty for lines and points."""
    kind = card.option("TYPE")
    if LINE.match(kind):
        return []
    known = PLANE.match(kind) or SOLID.match(kind)
    if not known:
        raise MeshError(f"line {card.line}: holds elements {kind}: only tetrahedra are read")
    length = int(known[1]) + 1
    read: list[list[int]] = []
    for line, cells in zip(card.lines, card.rows, strict=True):
        if not read or len(read[-1]) == length:  # else the row continues an element
            read.append([])
        read[-1] += [_whole(value, line) for value in cells if value]
        if len(read[-1]) > length:
            raise MeshError(
                f"line {line}: element {read[-1][0]} has more than the {length - 1} nodes of a "
                f"{kind}: is a line before it incomplete?"
            )
    if read and len(read[-1]) < length:
        raise MeshError(
            f"line {card.lines[-1]}: element {read[-1][0]} has {len(read[-1]) - 1} of the "
            f"{length - 1} nodes of a {kind}: is the file cut short?"
        )
    return read


def _solids(elements: _Elements) -> list[tuple[str, NDArray]]:
    cells: dict[str, list[list[int]]] = {}
    for kind, nodes in elements.values():
        if solid := SOLID.match(kind):
            cells.setdefault(KINDS.get(solid[1], kind), []).append(nodes)
    return [(kind, np.array(data)) for kind, data in cells.items()]


def _sets(cards: list[_Card], keyword: str, definition: str) -> dict[str, list[int]]:
    """Numbers in each set; a later card of the same name adds to it."""
    sets: dict[str, list[int]] = {}
    for card in cards:
        name = card.options.get(keyword)
        if not name or card.keyword not in (keyword, definition):
            continue
        if card.keyword == "NODE":
            numbers = [_whole(r[0], line) for line, r in zip(card.lines, card.rows, strict=True)]
        elif card.keyword == "ELEMENT":
            numbers = [number for number, *_ in _numbering(card)]
        elif "GENERATE" in card.options:
            numbers = [
                i for given in zip(card.lines, card.rows, strict=True) for i in _range(*given)
            ]
        else:
            numbers = [
                i
                for line, row in zip(card.lines, card.rows, strict=True)
                for value in row
                if value
                for i in _numbers(value, sets, line)
            ]
        sets.setdefault(name, []).extend(numbers)
    return sets


def _range(line: int, row: list[str]) -> range:
    """Numbers of a row of a generated set: first, last, and step."""
    first, *others = (_whole(value, line) for value in row if value)
    last, by = [*others, 1][:2] if others else (None, 1)
    if last is None or by < 1 or last - first > MOST_RANGE:
        raise MeshError(f"line {line}: a generated set needs first, last and step")
    return range(first, last + 1, by)


def _numbers(value: str, sets: dict[str, list[int]], line: int) -> list[int]:
    """A number, or those of an earlier set; an instance name before it is ignored."""
    value = value.rpartition(".")[2].upper()
    if value.isdigit():
        return [_whole(value, line)]
    if value not in sets:
        raise MeshError(f"line {line}: {shown(value)}: no set of this name stands before")
    return sets[value]


def _shells(numbers: list[int], elements: _Elements) -> list[list[int]]:
    """Corner nodes of the triangles among ``elements``."""
    members = [elements[i] for i in numbers if i in elements]
    return [nodes[:3] for kind, nodes in members if PLANE.match(kind) and len(nodes) in (3, 6)]


def _surface(card: _Card, elements: _Elements, sets: dict[str, list[int]]) -> list[list[int]]:
    """Corner nodes of the faces of a surface: shells, or sides of tetrahedra."""
    faces = []
    for line, (value, *side) in zip(card.lines, card.rows, strict=True):
        numbers = _numbers(value, sets, line)
        faces += _shells(numbers, elements)
        if corners := SIDES.get("".join(side).upper()):
            solids = [elements[i] for i in numbers if i in elements]
            faces += [[nodes[i] for i in corners] for kind, nodes in solids if SOLID.match(kind)]
    return faces
