"""Cards of an Abaqus or CalculiX deck, to which decks of Nastran are translated too.

And what they say besides the mesh: materials, sections and masses by the keywords of Abaqus.
"""

import re
from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from pathlib import Path
from typing import Any

from geometry.base import MeshError, number, read_text, require
from geometry.file_mesh import FileMaterial, Physics

# a row with options: one that has a value, or first one that has none
OPTION = re.compile(r".*=|(GENERATE|INTERNAL|UNSORTED)\s*(,|$)", re.IGNORECASE)
ISOTROPIC = ("", "ISO", "ISOTROPIC")  # TYPE of *ELASTIC
# other laws of a material than *ELASTIC
NOT_ELASTIC = re.compile(r"HYPER|USER ?MATERIAL|LOW DENSITY|ANISOTROPIC")
# options of a section by which its material is not isotropic, or turned
TURNED = ("ORIENTATION", "COMPOSITE", "CORDM", "PCOMPS", "PCOMPLS", "PLSOLID")
# elements and cards that add mass
MASS = re.compile(r"MASS\d*$|ROTARYI$|NONSTRUCTURAL MASS$|CONM\d|CMASS\d|NSM(ADD|L?1?)$")
TAKEN = {  # cards that are read, and those that only frame or name others
    *("", "NODE", "NSET", "ELSET", "SURFACE", "MATERIAL", "ELASTIC", "DENSITY", "SOLID SECTION"),
    *("HEADING", "PREPRINT", "PART", "END PART", "ASSEMBLY", "END ASSEMBLY", "INSTANCE"),
    *("END INSTANCE", "MASS", "ROTARY INERTIA"),  # the last two: values of elements
}


@dataclass
class Card:
    """A card of a deck, with its options and its rows."""

    keyword: str
    options: dict[str, str]
    line: int
    rows: list[tuple[int, list[str]]] = field(default_factory=list)  # with their lines

    def option(self, name: str) -> str:
        """An option without which the card says nothing."""
        require((self.options.get(name), f"*{self.keyword} has no {name}"), line=self.line)
        return self.options[name]


def read_cards(path: Path) -> list[Card]:
    """All cards, the first with the rows before them.

    Of CalculiX also those that end with a comma, which Abaqus takes for "goes on".
    """
    cards = [Card("", {}, 0)]
    lines = enumerate(map(str.strip, read_text(path, most=None, errors="replace").splitlines()), 1)
    read = ((place, line) for place, line in lines if line and not line.startswith("**"))
    for (_, before), (place, line) in pairwise([(0, ""), *read]):
        if line.startswith("*"):
            keyword, _, options = line.lstrip("*").partition(",")
            cards.append(Card(keyword.strip().upper(), _options(options), place))
        elif before.endswith(",") and not cards[-1].rows and OPTION.match(line):
            cards[-1].options |= _options(line)
        else:
            cards[-1].rows.append((place, [value.strip() for value in line.split(",")]))
    return cards


def _options(text: str) -> dict[str, str]:
    pairs = (option.partition("=") for option in text.upper().split(","))
    return {name.strip(): value.strip().strip('"') for name, _, value in pairs}


def physics_of(
    cards: Sequence[Card],
    solids: Collection[int],
    element_sets: Mapping[str, Iterable[int]],
) -> Physics:
    """What ``cards`` say of the ``solids``, numbers of elements, besides their mesh.

    Raises
    ------
    MeshError
        When a value of a material is no number.
    """
    others = Counter(name for card in cards for name in _not_read(card))
    masses = Counter({name: count for name, count in others.items() if MASS.match(name)})
    defined = _materials(cards)
    of_cells: dict[int, tuple[str, str]] = {}  # material, and what it is turned or layered by
    for card in (card for card in cards if card.keyword == "SOLID SECTION"):
        name = card.options.get("ELSET", "")
        if name not in element_sets:
            others[f"section of a set that is not defined ({name})"] += 1
        turned = " ".join(key for key in TURNED if key in card.options)
        section = card.options.get("MATERIAL", "none"), turned
        of_cells |= dict.fromkeys(element_sets.get(name, ()), section)
    sections = Counter(of_cells.get(i, ("none", "")) for i in solids)
    if {*sections} <= {("none", "")}:  # no cell has one
        materials = tuple(defined.values())
    else:
        materials = tuple(
            replace(material, cells=count, other=" and ".join(filter(None, [material.other, by])))
            for (name, by), count in sorted(sections.items())
            for material in [defined.get(name, FileMaterial(name))]
        )
    return Physics(materials, masses, +others - masses)


def _not_read(card: Card) -> Iterator[str]:
    """The card or, of elements that are no solid cells, the kind of each."""
    kind = card.options.get("TYPE", "")
    if card.keyword != "ELEMENT":
        if card.keyword not in TAKEN and not NOT_ELASTIC.match(card.keyword):
            yield card.keyword
        elif card.keyword in ("ELASTIC", "DENSITY") and len(card.rows) > 1:
            yield f"{card.keyword} at other temperatures"
    elif not kind.startswith("C3D") and not re.match(r"C(TETRA|HEXA|PENTA|PYRAM)", kind):
        yield from [kind] * len(card.rows)


def _materials(cards: Iterable[Card]) -> dict[str, FileMaterial]:
    """Materials by name with their first values, that is at the first of their temperatures."""
    given: list[dict[str, Any]] = []
    for card in cards:
        kind = card.options.get("TYPE", "")
        if card.keyword == "MATERIAL":
            given.append({"name": card.option("NAME")})
        elif given and card.keyword == "DENSITY":
            given[-1]["density"] = _values(card, 1)[0]
        elif given and card.keyword == "ELASTIC" and kind in ISOTROPIC:
            given[-1] |= zip(("young_modulus", "poisson_ratio"), _values(card, 2), strict=True)
        elif given and card.keyword == "ELASTIC":
            given[-1]["other"] = f"ELASTIC, TYPE={kind}"
        elif given and NOT_ELASTIC.match(card.keyword):
            given[-1]["other"] = card.keyword
    return {values["name"]: FileMaterial(**values) for values in given}


def _values(card: Card, count: int) -> list[float | None]:
    """The first ``count`` values of a card; None for those that are left out."""
    line, row = card.rows[0] if card.rows else (card.line, [])
    try:
        return [number(value) if value else None for value in [*row, *[""] * count][:count]]
    except ValueError as error:
        raise MeshError(f"*{card.keyword}: {error}", line=line) from None
