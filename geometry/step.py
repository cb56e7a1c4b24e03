"""Unit and names of faces in a STEP file, which gmsh does not provide.

A STEP file (ISO 10303-21) is a list of entities ``#7 = NAME(...);`` that refer to one another.
"""

import re
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from geometry.errors import MeshError
from geometry.text_file import number, read_text

ENTITY = re.compile(r"#(\d+)\s*=\s*([^;]*);")
REFERENCE = re.compile(r"#(\d+)")
NUMBERS = re.compile(r"CARTESIAN_POINT\s*\(\s*'[^']*'\s*,\s*\(([^)]*)\)")
# number of leading references of an entity that are its boundary; then comes its geometry
BOUNDARY = {"ADVANCED_FACE": -1, "EDGE_CURVE": 2}
NAME = re.compile(r"[^']*'([^']*)'")
PREFIXES = {"$": "m", ".CENTI.": "cm", ".MILLI.": "mm"}


class StepFile:
    """Entities of a STEP file by number.

    Raises
    ------
    MeshError
        When it cannot be read, is no STEP file or has no end.
    """

    def __init__(self, path: str | Path) -> None:
        text = read_text(path, most=None, errors="replace")
        if not text.lstrip().startswith("ISO-10303-21"):
            raise MeshError("is no STEP file, whose first line is ISO-10303-21;: export it anew")
        if "END-ISO-10303-21" not in text:
            raise MeshError("has no end (END-ISO-10303-21;): it was cut short, export it anew")
        self._entities = dict(ENTITY.findall(re.sub(r"\s*\n\s*", "", text)))

    @property
    def units(self) -> set[str]:
        """Length units that the file declares: m, cm, mm, in, or other names of the file."""
        lengths = [body for body in self._entities.values() if "LENGTH_UNIT" in body]
        # an inch is declared as a multiple of an SI unit, which is declared as well
        converted = re.findall(r"CONVERSION_BASED_UNIT\s*\(\s*'(\w+)'", " ".join(lengths))
        prefixes = re.findall(r"SI_UNIT\s*\(\s*(\$|\.\w+\.)\s*,\s*\.METRE\.", " ".join(lengths))
        return {"in" if name.upper().startswith("INCH") else name for name in converted} or {
            PREFIXES.get(prefix, f"{prefix}METRE") for prefix in prefixes
        }

    def faces(self) -> list[tuple[str, NDArray[np.float64]]]:
        """Name and vertices (n, 3), in the file's unit, of the faces of its closed shells."""
        shells = [body for body in self._entities.values() if body.startswith("CLOSED_SHELL")]
        numbers = [face for shell in shells for face in REFERENCE.findall(shell)]
        return [(self._name(n), self._vertices([n])) for n in numbers]

    def _name(self, number: str) -> str:
        """Name of a face; empty where it has none."""
        name = NAME.match(self._entity(number))
        return name[1] if name else ""

    def _entity(self, number: str) -> str:
        if number not in self._entities:
            raise MeshError(f"refers to entity #{number}, which is not in it: export it anew")
        return self._entities[number]

    @staticmethod
    def _point(text: str) -> list[float]:
        try:
            return [number(value) for value in text.split(",")]
        except ValueError as error:
            raise MeshError(f"has a point ({text}): {error}: export it anew") from None

    def _vertices(self, numbers: list[str]) -> NDArray[np.float64]:
        """Vertices (n, 3) of entities and their boundaries, without points of curves, surfaces."""
        seen, points = set(numbers), []
        while numbers:
            body = self._entity(numbers.pop())
            if place := NUMBERS.match(body):
                points.append(self._point(place[1]))
            below = REFERENCE.findall(body)[: BOUNDARY.get(body.split("(")[0].strip())]
            numbers += [n for n in below if n not in seen]
            seen.update(below)
        return np.array(points)
