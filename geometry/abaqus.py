"""Reader of nodes, elements and sets of an Abaqus or CalculiX deck.

meshio 5.3 also reads these decks, but assigns element sets to the wrong elements when only some
*ELEMENT cards name one, keeps only the last of several *NODE, *NSET or *ELSET cards, and supports
neither *SURFACE nor the six-node plane elements that gmsh writes.
"""

import re
from collections.abc import Collection, Iterable, Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np

from geometry.base import MeshError, number, require, shown
from geometry.cards import Card, physics_of, read_cards
from geometry.file_mesh import FileMesh, as_tetrahedra
from geometry.split import KINDS, NODES, Block

SOLID = re.compile(r"(?:C3D|CTETRA|CHEXA|CPENTA|CPYRAM)(\d+)")
# shells and the like
PLANE = re.compile(r"(?:S|STRI|CTRIA|CQUAD|CPS|CPE|CPEG|CAX|M3D|SFM3D|R3D|DS)(\d)")
LINE = re.compile(r"B\d|T[23]D|R2D|RB|PIPE|FRAME|SPRING|DASHPOT|GAP|MASS|ROTARYI|CONN|DCOUP")
CORNERS = {3: 3, 6: 3, 4: 4, 8: 4, 9: 4}  # of shells, by the number of their nodes
MOST_DIGITS = 10  # of a number
MOST_UNUSED = 0.1  # of the nodes: those of reference points and beams are fewer
ELSEWHERE = {  # options that change the rows of a card, or take their place
    "INPUT": "its rows are in another file",
    "OFFSET": "its numbers are shifted",
    "SYSTEM": "its coordinates are not Cartesian",
}
INCLUDES = "has {}, whose file would not be watched: export one file"  # by Snakemake
READ = ("NODE", "ELEMENT", "NSET", "ELSET", "SURFACE")
# whether the cards after them are the assembly's own
OUTSIDE = {"ASSEMBLY": True, "INSTANCE": False, "END INSTANCE": True, "END ASSEMBLY": False}
REFUSED = {"INCLUDE": INCLUDES} | dict.fromkeys(
    ("NGEN", "NFILL", "NCOPY", "NMAP", "ELGEN", "ELCOPY", "SYSTEM"),
    "{} generates nodes or elements: export the mesh itself",
)


type _Elements = dict[int, tuple[str, list[int]]]  # kind and nodes by number
type _Sets = dict[str, list[int]]  # numbers by name


def read_deck(path: Path) -> FileMesh:
    """Read a deck of a single file; names of groups are in capitals.

    Raises
    ------
    MeshError
        When it includes other files, has parts with a numbering of their own, cards that generate
        nodes or elements, solid elements that are not read, or is damaged: a line that cannot
        be read, a node or element that is incomplete or defined twice in different ways, a set of
        some that are not defined.
    """
    whole = read_cards(path)
    cards = list(_of_part(whole))
    _check(cards)
    mesh = mesh_of(cards, whole)
    nodes, unused = len(mesh.points), len(mesh.points) - len(np.unique(mesh.cells))
    # a deck has no end, and may lack its last elements
    require(
        (
            cards[-1].keyword != "ELEMENT" or unused <= MOST_UNUSED * nodes,
            f"{unused} of {nodes} nodes belong to no solid cell: is the file cut short?",
        )
    )
    return mesh


def mesh_of(cards: list[Card], whole: list[Card]) -> FileMesh:
    """The mesh that ``cards`` define, by the keywords of Abaqus.

    ``whole``: with those of an assembly's own, of which materials and masses are read.

    Raises
    ------
    MeshError
        When nodes, elements or sets are incomplete, not consistent or not known.
    """
    nodes = _nodes(cards)
    elements = _elements(cards, nodes)
    element_sets = _sets(cards, "ELSET", "ELEMENT", elements, {})
    node_sets = _sets(
        cards,
        "NSET",
        "NODE",
        nodes,
        {
            name: [node for i in numbers for node in elements[i][1]]
            for name, numbers in element_sets.items()
        },
    )
    faces = {name: _shells(numbers, elements) for name, numbers in element_sets.items()}
    for card in (card for card in cards if card.keyword == "SURFACE"):
        if card.options.get("TYPE") == "NODE":
            rows = [(line, row[:1]) for line, row in card.rows]  # without their areas
            node_sets[card.option("NAME")] = _members(replace(card, rows=rows), node_sets, nodes)
        else:
            faces[card.option("NAME")] = _surface(card, elements, element_sets)
    row = {number: i for i, number in enumerate(nodes)}
    rows = np.vectorize(row.__getitem__, otypes=[int])
    numbers_by_kind = {
        kind: [i for i, (its_kind, _) in elements.items() if its_kind == kind]
        for kind in sorted({kind for kind, _ in elements.values() if SOLID.match(kind)})
    }
    return as_tetrahedra(
        np.array(list(nodes.values()), dtype=float),
        np.array(list(nodes)),
        [
            Block(rows([elements[i][1] for i in numbers]), np.array(numbers), kind)
            for kind, numbers in numbers_by_kind.items()
        ],
        {name: rows(numbers) for name, numbers in node_sets.items()},
        {name: [[row[i] for i in face] for face in corners] for name, corners in faces.items()},
        physics_of(whole, set().union(*numbers_by_kind.values()), element_sets),
    )


def _nodes(cards: list[Card]) -> dict[int, list[float]]:
    """Coordinates by number of the node."""
    nodes: dict[int, list[float]] = {}
    for card in (card for card in cards if card.keyword == "NODE"):
        for line, (given, *place) in card.rows:
            try:
                point = [number(x) for x in [*place, "", "", ""][:3]]
            except ValueError as error:
                raise MeshError(f"{error}: a node has three coordinates", line=line) from None
            if nodes.setdefault(_whole(given, line), point) != point:
                raise MeshError(
                    f"node {given} is defined twice, in different places: number the nodes of "
                    "all parts anew",
                    line=line,
                )
    return nodes


def _elements(cards: list[Card], nodes: Collection[int]) -> _Elements:
    """Kind and nodes of each element."""
    elements: _Elements = {}
    for card in (card for card in cards if card.keyword == "ELEMENT"):
        for number_, *its_nodes in _numbering(card):
            if unknown := [i for i in its_nodes if i not in nodes]:
                raise MeshError(
                    f"element {number_} names node {unknown[0]}, which is not defined: is the file "
                    "cut short?"
                )
            element = card.options["TYPE"], its_nodes
            if elements.setdefault(number_, element) != element:
                raise MeshError(
                    f"element {number_} is defined twice, with different nodes: number the "
                    "elements of all parts anew"
                )
    return elements


def _of_part(cards: Iterable[Card]) -> Iterator[Card]:
    """Cards without an assembly's own definitions: it numbers its reference points anew."""
    outside = False
    for card in cards:
        outside = OUTSIDE.get(card.keyword, outside)
        if not outside or card.options.get("INSTANCE") or card.keyword not in READ:
            yield card
        elif card.keyword in ("NSET", "ELSET", "SURFACE"):
            rows = ((line, [v for v in row if not v.isdigit()]) for line, row in card.rows)
            yield replace(card, rows=[(line, row) for line, row in rows if any(row)])
        elif card.keyword == "ELEMENT" and not LINE.match(card.option("TYPE")):
            raise MeshError("elements of the assembly itself: export the part", line=card.line)


def _whole(text: str, line: int) -> int:
    """A number of a node or element."""
    if not (text.isascii() and text.isdigit()) or len(text) > MOST_DIGITS:
        raise MeshError(f"{shown(text)} is no number of a node or element", line=line)
    return int(text)


def _check(cards: list[Card]) -> None:
    for card in (card for card in cards if card.keyword in (*REFUSED, *READ)):
        if card.keyword in REFUSED:
            raise MeshError(REFUSED[card.keyword].format(f"*{card.keyword}"))
        if option := next((o for o in ELSEWHERE if card.options.get(o, "R") != "R"), None):
            raise MeshError(
                f"*{card.keyword} with {option}: {ELSEWHERE[option]}: export the mesh itself",
                line=card.line,
            )
    parts, instances = ([c for c in cards if c.keyword == of] for of in ("PART", "INSTANCE"))
    require(
        (
            len(parts) < 2 and len(instances) < 2 and not any(card.rows for card in instances),
            "has several parts or a moved instance: export a deck without parts",
        )
    )


def _numbering(card: Card) -> list[list[int]]:
    """Number and nodes of each element of a card."""
    kind = card.option("TYPE")
    if LINE.match(kind):  # one row each
        return [[_whole(value, line) for value in row if value] for line, row in card.rows]
    match = PLANE.match(kind) or SOLID.match(kind)
    if not match:
        raise MeshError(
            f"holds elements {kind}: read are tetrahedra, bricks, wedges and pyramids",
            line=card.line,
        )
    length = int(match[1]) + 1
    read: list[list[int]] = []
    for line, cells in card.rows:
        if not read or len(read[-1]) == length:  # else the row continues an element
            read.append([])
        read[-1] += [_whole(value, line) for value in cells if value]
        if len(read[-1]) > length:
            raise MeshError(
                f"element {read[-1][0]} has more than the {length - 1} nodes of a {kind}: is a "
                "line before it incomplete?",
                line=line,
            )
    if read and len(read[-1]) < length:
        raise MeshError(
            f"element {read[-1][0]} has {len(read[-1]) - 1} of the {length - 1} nodes of a "
            f"{kind}: is the file cut short?",
            line=card.rows[-1][0],
        )
    return read


def _sets(
    cards: list[Card], keyword: str, definition: str, defined: Collection[int], others: _Sets
) -> _Sets:
    """Numbers in each set; a later card of the same name adds to it.

    ``defined``: numbers of all nodes or elements; ``others``: sets of elements, by their nodes.
    """
    sets: _Sets = {}
    instances: dict[str, str | None] = {}
    named = (card for card in cards if card.options.get(keyword))
    for card in (card for card in named if card.keyword in (keyword, definition)):
        if card.keyword == "NODE":
            numbers = [_whole(row[0], line) for line, row in card.rows]
        elif card.keyword == "ELEMENT":
            numbers = [number for number, *_ in _numbering(card)]
        elif keyword == "NSET" and "ELSET" in card.options:
            numbers = _numbers(card.options["ELSET"], others, card.line, defined)
        else:
            numbers = _members(card, sets, defined)
        name, instance = card.options[keyword], card.options.get("INSTANCE")
        if instances.setdefault(name, instance) != instance:  # that of the assembly is meant
            sets[name], instances[name] = [], instance
        sets.setdefault(name, []).extend(numbers)
    return sets


def _members(card: Card, sets: _Sets, defined: Collection[int]) -> list[int]:
    """Numbers that the rows of a set give, by themselves, as ranges or as other sets."""
    if "GENERATE" in card.options:
        return [i for line, row in card.rows for i in _range(line, row, defined)]
    return [
        i
        for line, row in card.rows
        for value in filter(None, row)
        for i in _numbers(value, sets, line, defined)
    ]


def _range(line: int, row: list[str], defined: Collection[int]) -> list[int]:
    """Numbers of a row of a generated set: first, last, and step; some may not be defined."""
    values = [_whole(value, line) for value in row if value]
    require(
        (
            len(values) > 1 and 0 not in values[2:],
            "a generated set needs first, last and step",
        ),
        line=line,
    )
    first, last, *by = values[:3]
    given = range(first, last + 1, *by)
    numbers = [i for i in min(given, defined, key=len) if i in given and i in defined]
    require((numbers, f"none of {first} to {last} is defined: correct the set"), line=line)
    return numbers


def _numbers(value: str, sets: _Sets, line: int, defined: Collection[int]) -> list[int]:
    """A number, or those of an earlier set; an instance name before it is ignored."""
    value = value.rpartition(".")[2].strip('"').upper()
    if not value.isdigit():
        if value not in sets:
            raise MeshError(f"{shown(value)}: no set of this name stands before", line=line)
        return sets[value]
    if (number_ := _whole(value, line)) not in defined:
        raise MeshError(
            f"a set names {value}, which is not defined: is the file cut short?", line=line
        )
    return [number_]


def _shells(numbers: list[int], elements: _Elements) -> list[list[int]]:
    """Corner nodes of the triangles and quadrilaterals among ``elements``."""
    return [
        nodes[: CORNERS[len(nodes)]]
        for kind, nodes in map(elements.get, numbers)
        if PLANE.match(kind) and len(nodes) in CORNERS
    ]


def _surface(card: Card, elements: _Elements, sets: _Sets) -> list[list[int]]:
    """Corner nodes of the faces of a surface: shells, or sides of solid elements."""
    faces = []
    for line, (value, *side) in card.rows:
        numbers = _numbers(value, sets, line, elements)
        faces += _shells(numbers, elements)
        solids = [nodes for kind, nodes in map(elements.get, numbers) if SOLID.match(kind)]
        faces += [_side(nodes, "".join(side).upper(), line) for nodes in solids]
    return faces


def _side(nodes: list[int], side: str, line: int) -> list[int]:
    """Corner nodes of a side of a solid element, as ``S1``."""
    sides = KINDS[NODES[len(nodes)][0]].faces
    named = {f"S{i}": face for i, face in enumerate(sides, 1)}
    require(
        (
            side in named,
            f"a surface of solid elements needs their sides, here S1 to S{len(sides)}",
        ),
        line=line,
    )
    return [nodes[i] for i in named[side]]
