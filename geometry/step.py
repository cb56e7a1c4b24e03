"""Unit and names of faces in a STEP file, which gmsh does not provide.

A STEP file (ISO 10303-21) is a list of entities ``#7 = NAME(...);`` that refer to one another.
"""

import re
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

ENTITY = re.compile(r"#(\d+)\s*=\s*([^;]*);")
REFERENCE = re.compile(r"#(\d+)")
NUMBERS = re.compile(r"CARTESIAN_POINT\s*\(\s*'[^']*'\s*,\s*\(([^)]*)\)")
# number of leading references of an entity that are its boundary; then comes its geometry
BOUNDARY = {"ADVANCED_FACE": -1, "EDGE_CURVE": 2}
PREFIXES = {"$": "m", ".CENTI.": "cm", ".MILLI.": "mm"}


class StepFile:
    """Entities of a STEP file by number."""

    def __init__(self, path: str | Path) -> None:
        text = Path(path).read_text(encoding="utf-8", errors="replace")
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
        return [
            (re.findall(r"'([^']*)'", self._entities[n])[0], self._vertices([n])) for n in numbers
        ]

    def _vertices(self, numbers: list[str]) -> NDArray[np.float64]:
        """Vertices (n, 3) of entities and their boundaries, without points of curves, surfaces."""
        seen, points = set(numbers), []
        while numbers:
            body = self._entities[numbers.pop()]
            if place := NUMBERS.match(body):
                points.append([float(value) for value in place[1].split(",")])
            below = REFERENCE.findall(body)[: BOUNDARY.get(body.split("(")[0].strip())]
            numbers += [n for n in below if n not in seen]
            seen.update(below)
        return np.array(points)
