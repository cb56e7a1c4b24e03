"""Reader of nodes, elements and sets of an Abaqus or CalculiX deck.

meshio 5.3 also reads these decks, but assigns element sets to the wrong elements when only some
*ELEMENT cards name one, keeps only the last of several *NODE, *NSET or *ELSET cards, and supports
neither *SURFACE nor the six-node plane elements that gmsh writes.
"""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from geometry.errors import MeshError
from geometry.file_mesh import FileMesh, tetrahedra_of

SOLID = re.compile(r"C3D(\d+)")
PLANE = re.compile(r"(?:S|STRI|CPS|CPE|CPEG|CAX|M3D|SFM3D|R3D|DS)(\d)")  # shells and the like
LINE = re.compile(r"B\d|T[23]D|R2D|RB|PIPE|FRAME|SPRING|DASHPOT|GAP|MASS|ROTARYI|CONN|DCOUP")
KINDS = {"4": "tetra", "10": "tetra10", "8": "hexahedron", "20": "hexahedron20", "6": "wedge"}
KINDS |= {"15": "wedge15", "5": "pyramid", "13": "pyramid13", "27": "hexahedron27"}
SIDES = {"S1": (0, 2, 1), "S2": (0, 1, 3), "S3": (1, 2, 3), "S4": (0, 3, 2)}  # of tetrahedra
GENERATED = {"NGEN", "NFILL", "NCOPY", "NMAP", "ELGEN", "ELCOPY", "SYSTEM"}


@dataclass
class _Card:
    keyword: str
    options: dict[str, str]
    rows: list[list[str]]


type _Elements = dict[int, tuple[str, list[int]]]  # kind and nodes by number


def read_deck(path: Path) -> FileMesh:
    """Read a deck of a single file; names of groups are in capitals.

    Raises
    ------
    MeshError
        When it includes other files, has parts with a numbering of their own, cards that generate
        nodes or elements, or solid elements other than tetrahedra. A damaged deck raises other
        exceptions.
    """
    cards = list(_cards(path))
    _check(cards)
    nodes = {
        int(number): [float(x) for x in place[:3]]
        for card in cards
        if card.keyword == "NODE"
        for number, *place in card.rows
    }
    row = {number: i for i, number in enumerate(nodes)}
    elements = {
        number: (card.options["TYPE"], [row[i] for i in of])
        for card in cards
        if card.keyword == "ELEMENT"
        for number, *of in _numbering(card)
    }
    node_sets, element_sets = _sets(cards, "NSET", "NODE"), _sets(cards, "ELSET", "ELEMENT")
    faces = {name: _shells(numbers, elements) for name, numbers in element_sets.items()}
    for card in (card for card in cards if card.keyword == "SURFACE"):
        if card.options.get("TYPE") == "NODE":
            numbers = [i for value, *_ in card.rows for i in _numbers(value, node_sets)]
            node_sets[card.options["NAME"]] = numbers
        else:
            faces[card.options["NAME"]] = _surface(card, elements, element_sets)
    return FileMesh(
        points=np.array(list(nodes.values()), dtype=float),
        cells=tetrahedra_of(_solids(elements)),
        node_groups={
            name: np.array([row[i] for i in numbers if i in row], dtype=int)
            for name, numbers in node_sets.items()
        },
        face_groups={name: np.array(f, dtype=int).reshape(-1, 3) for name, f in faces.items()},
    )


def _cards(path: Path) -> Iterator[_Card]:
    card, keyword = None, ""
    for line in path.read_text(encoding="utf-8", errors="replace").splitlines():
        if line.startswith("**") or not line.strip():
            continue
        if line.startswith("*") or keyword:
            keyword += line.strip()
            if keyword.endswith(","):  # continued in the next line
                continue
            if card:
                yield card
            card, keyword = _card(keyword), ""
        elif card:
            card.rows.append([value.strip() for value in line.split(",")])
    if card:
        yield card


def _card(line: str) -> _Card:
    keyword, *options = line.lstrip("*").split(",")
    pairs = [option.partition("=") for option in options]
    values = {name.strip().upper(): value.strip().strip('"').upper() for name, _, value in pairs}
    return _Card(keyword.strip().upper(), values, [])


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
    kind = card.options["TYPE"]
    if LINE.match(kind):
        return []
    known = PLANE.match(kind) or SOLID.match(kind)
    if not known:
        raise MeshError(f"holds elements {kind}: only tetrahedra are read")
    numbers = [int(value) for row in card.rows for value in row if value]
    return np.reshape(numbers, (-1, int(known[1]) + 1)).tolist()


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
            numbers = [int(row[0]) for row in card.rows]
        elif card.keyword == "ELEMENT":
            numbers = [number for number, *_ in _numbering(card)]
        elif "GENERATE" in card.options:
            ranges = [[int(value) for value in row if value] for row in card.rows]
            numbers = [i for first, last, *by in ranges for i in range(first, last + 1, *by)]
        else:
            numbers = [i for row in card.rows for v in row if v for i in _numbers(v, sets)]
        sets.setdefault(name, []).extend(numbers)
    return sets


def _numbers(value: str, sets: dict[str, list[int]]) -> list[int]:
    """A number, or those of an earlier set; an instance name before it is ignored."""
    value = value.rpartition(".")[2].upper()
    return [int(value)] if value.isdigit() else sets[value]


def _shells(numbers: list[int], elements: _Elements) -> list[list[int]]:
    """Corner nodes of the triangles among ``elements``."""
    members = [elements[i] for i in numbers if i in elements]
    return [nodes[:3] for kind, nodes in members if PLANE.match(kind) and len(nodes) in (3, 6)]


def _surface(card: _Card, elements: _Elements, sets: dict[str, list[int]]) -> list[list[int]]:
    """Corner nodes of the faces of a surface: shells, or sides of tetrahedra."""
    faces = []
    for value, *side in card.rows:
        numbers = _numbers(value, sets)
        faces += _shells(numbers, elements)
        if corners := SIDES.get("".join(side).upper()):
            solids = [elements[i] for i in numbers if i in elements]
            faces += [[nodes[i] for i in corners] for kind, nodes in solids if SOLID.match(kind)]
    return faces
