"""Import of a CAD file, STEP or BREP: a checked solid in the blade's frame, with root and tip.

Unit and names of faces in a STEP file gmsh does not provide. Such a file (ISO 10303-21) is a list
of entities ``#7 = NAME(...);`` that refer to one another.
"""

import re
from collections import Counter
from itertools import compress
from pathlib import Path

import gmsh
import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

from geometry.base import Fault, MeshError, number, read_text, require, require_file
from geometry.blade import Cad
from geometry.frame import box, rotation, to_blade
from geometry.root_and_tip import within_radius
from geometry.shape import Shape, faces_of, radii, sampled

READ = (".step", ".stp", ".brep")
SAME = 1e-5  # m, distance of equal vertices in the file and in gmsh; tolerance of coarse CAD files
ROUND_OFF = 1e-6  # m, for a face exactly at the radius
ENTITY = re.compile(r"#(\d+)\s*=\s*(.*)", re.DOTALL)
REFERENCE = re.compile(r"#(\d+)")
NUMBERS = re.compile(r"CARTESIAN_POINT\s*\(\s*'[^']*'\s*,\s*\(([^)]*)\)")
# number of leading references of an entity that are its boundary; then comes its geometry
BOUNDARY = {"ADVANCED_FACE": -1, "EDGE_CURVE": 2}
NAME = re.compile(r"'([^']*)'")  # of a face, the first of its texts
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
        require(
            (
                text.lstrip().startswith("ISO-10303-21"),
                "is no STEP file, whose first line is ISO-10303-21;: export it anew",
            ),
            (
                "END-ISO-10303-21" in text,
                "has no end (END-ISO-10303-21;): it was cut short, export it anew",
            ),
        )
        statements = "".join(map(str.strip, text.split("\n"))).split(";")[:-1]
        found = filter(None, map(ENTITY.search, statements))
        self._entities = {number: body for number, body in map(re.Match.groups, found)}

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

    @property
    def described(self) -> str:
        """Its unit and the box of the corners of its faces, in that unit and the file's axes."""
        corners = np.concatenate([points for _, points in self.faces()])
        return f"unit {' and '.join(sorted(self.units)) or 'not declared'}; {box(corners)}"

    def faces(self) -> list[tuple[str, NDArray[np.float64]]]:
        """Name and vertices (n, 3), in the file's unit, of the faces of its closed shells."""
        shells = [body for body in self._entities.values() if body.startswith("CLOSED_SHELL")]
        numbers = [face for shell in shells for face in REFERENCE.findall(shell)]
        texts = [NAME.findall(self._entity(n)) or [""] for n in numbers]
        return [(name, self._vertices([n])) for n, (name, *_) in zip(numbers, texts, strict=True)]

    def _entity(self, number: str) -> str:
        require(
            (
                number in self._entities,
                f"refers to entity #{number}, which is not in it: export it anew",
            )
        )
        return self._entities[number]

    def _vertices(self, numbers: list[str]) -> NDArray[np.float64]:
        """Vertices (n, 3) of entities and their boundaries, without points of curves, surfaces."""
        seen, points = set(numbers), []
        while numbers:
            body = self._entity(numbers.pop())
            if place := NUMBERS.match(body):
                try:
                    points.append([number(value) for value in place[1].split(",")])
                except ValueError as error:
                    raise MeshError(f"has a point ({place[1]}): {error}: export it anew") from None
            below = REFERENCE.findall(body)[: BOUNDARY.get(body.split("(")[0].strip())]
            numbers += [n for n in below if n not in seen]
            seen.update(below)
        return np.array(points)


def import_cad(cad: Cad, path: str | Path) -> Shape:
    """The single solid of a CAD file, in the blade's frame, m.

    The unit that a STEP file declares must be that of the settings; BREP files declare none.

    Raises
    ------
    MeshError
        When the file has no or several solids, the solid is open, non-manifold or inside out, unit
        or frame cannot be those of a blade, or root or tip are not found.
    """
    step = _checked_file(cad, Path(path))
    solid = _import(Path(path))
    _check_manifold(cad, solid)
    points = np.vstack([sampled(curve) for _, curve in gmsh.model.getEntities(1)]) / cad.metres
    declared = f"the file itself declares {cad.unit}: export it anew, to scale"
    to_blade(points, cad, declared if step else "choose another unit")  # checks unit and frame
    groups = _groups(cad, step, solid) if step else {}
    _turn(solid, rotation(cad.frame))
    root, tip = (_find(cad, end, solid, groups) for end in ("root", "tip"))
    require((not set(root) & set(tip), "cad.root and cad.tip have faces in common; choose others"))
    return Shape(solid, root, tip)


def _checked_file(cad: Cad, path: Path) -> StepFile | None:
    """The entities of a STEP file, which gmsh is to read in m, as BREP; None of the latter."""
    require_file(path, READ)
    require((path.stat().st_size > 0, "is empty: export it anew"))
    if path.suffix.lower() == ".brep":
        gmsh.option.setNumber("Geometry.OCCScaling", cad.metres)
        return None
    gmsh.option.setString("Geometry.OCCTargetUnit", "M")
    step = StepFile(path)
    units = " and ".join(sorted(step.units)) or "none"
    require(
        (
            step.units == {cad.unit},
            f"declares the unit {units}, the settings say {cad.unit}; correct cad.unit "
            f"or export the file anew",
        )
    )
    return step


def _import(path: Path) -> int:
    """Tag of the solid, in m and along the axes of the file."""
    try:
        gmsh.model.occ.importShapes(str(path))
    except Exception:  # gmsh raises plain exceptions without a reason
        raise MeshError(f"cannot be read as {path.suffix}; export it anew") from None
    gmsh.model.occ.synchronize()
    solids = [tag for _, tag in gmsh.model.getEntities(3)]
    volumes = ", ".join(f"{gmsh.model.occ.getMass(3, tag):.3g}" for tag in solids)
    require(
        (len(solids) < 2, f"holds {len(solids)} solids of {volumes} m3, not one; unite them"),
        (
            solids,
            f"holds no solid, but {len(gmsh.model.getEntities(2))} faces; close them to a solid",
        ),
    )
    return solids[0]


def _check_manifold(cad: Cad, solid: int) -> None:
    """Check that every edge bounds two faces (a seam: one face twice), with outward normals."""
    edges = Counter(
        tag
        for face in faces_of(solid)
        for _, tag in gmsh.model.getBoundary([(2, face)], combined=False, oriented=False)
    )
    for edge, count in edges.items():
        if count != 2 and gmsh.model.occ.getMass(1, edge) > ROUND_OFF:  # a pole has no length
            middle = sampled(edge).mean(axis=0) / cad.metres
            place = ", ".join(f"{x:.4g}" for x in np.round(middle, 9))
            raise MeshError(
                f"the solid is {'open' if count < 2 else 'non-manifold'}: {count} "
                f"face(s) meet in the edge about ({place}) {cad.unit}; repair it in the CAD"
            )
    volume = gmsh.model.occ.getMass(3, solid)
    require((volume > 0, f"the solid is inside out (volume {volume:.3g} m3); reverse its faces"))


def _turn(solid: int, R: NDArray) -> None:
    """Transform the solid by the orthogonal R (3, 3); if R is left-handed, mirror it first."""
    occ, moved = gmsh.model.occ, [(3, solid)]
    if np.linalg.det(R) < 0:
        occ.mirror(moved, 0, 1, 0, 0)
        R = R @ np.diag([1, -1, 1])
    axis = Rotation.from_matrix(R).as_rotvec()
    angle = float(np.linalg.norm(axis))
    if angle > 0:
        occ.rotate(moved, 0, 0, 0, *axis, angle)
    occ.synchronize()


def _groups(cad: Cad, step: StepFile, solid: int) -> dict[str, list[int]]:
    """Faces by their names in a STEP file; gmsh keeps their order, but not their names."""
    named, tags = step.faces(), sorted(faces_of(solid))
    groups: dict[str, list[int]] = {}
    for (name, vertices), tag in zip(named, tags, strict=False):
        if name:
            groups.setdefault(name, []).append(tag)
            require(
                (
                    len(named) == len(tags) and _same(vertices * cad.metres, _vertices(tag)),
                    f"face {name} is not as in the file once it is read; find root and tip by "
                    "radius_mm",
                )
            )
    return groups


def _vertices(face: int) -> NDArray[np.float64]:
    ends = gmsh.model.getBoundary([(2, face)], combined=False, oriented=False, recursive=True)
    return np.array([gmsh.model.getValue(0, tag, []) for _, tag in ends])


def _same(some: NDArray, others: NDArray) -> bool:
    """Whether two sets of points (n, 3) are equal within ``SAME``."""
    return all(cKDTree(a).query(b)[0].max() <= SAME for a, b in ((some, others), (others, some)))


def _find(cad: Cad, end: str, solid: int, groups: dict[str, list[int]]) -> tuple[int, ...]:
    """Faces of the root or tip: those of its group, or entirely inside or outside its radius."""
    face = getattr(cad, end)
    if face.group is None:
        faces = faces_of(solid)
        r = np.array([radii(tag) for tag in faces])
        chosen = within_radius(f"cad.{end}", face.radius_mm, r, ROUND_OFF)
        return tuple(compress(faces, chosen))
    fault = f"no face has this name; names: {', '.join(sorted(groups)) or 'none; give radius_mm'}"
    require(
        *((name in groups, Fault(fault, value=name)) for name in face.groups),
        key=f"cad.{end}.group",
        allowed=sorted(groups),
    )
    return tuple(tag for name in dict.fromkeys(face.groups) for tag in groups[name])
