"""Materials, sections and masses of a deck by the keywords of Abaqus, and what else it has."""

import re
from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

from geometry.base import MeshError, number
from geometry.cards import Card
from geometry.file_physics import FileMaterial, Physics

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
