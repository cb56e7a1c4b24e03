"""What a file of a blade says of its unit, axes, root and tip: tried by meshing it, and drawn."""

import warnings
from collections.abc import Iterator
from contextlib import redirect_stdout, suppress
from io import StringIO
from itertools import product
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from geometry.base import MeshError, MeshWarning, UserError, check_settings
from geometry.blade import METRES, Blade, Frame, Interface, Material
from geometry.cad import StepFile
from geometry.facets import normals
from geometry.file_mesh import FileMaterial, FileMesh, Physics
from geometry.frame import rotation
from geometry.mesh import ENOUGH, MeshSummary, build_mesh
from geometry.readers import read_mesh_file
from geometry.tetrahedra import exterior, patches
from workflow.figures.style import (
    BLUE,
    SINGLE,
    VERMILLION,
    note,
    save,
    styled,
    subplots,
)

END = 0.8  # least cosine between the radius and the normal of a facet of root or tip
LONGEST_IN_M = 2.0  # of a file in m; in mm a blade is longer
MARGIN = 0.01  # of the span, of the radii of CAD: the middle of a plane face is farther in
ROUNDER = 0.1  # of how far the tip is off a circle about z: about another axis
COARSE = 1 / 25  # of a blade's length: elements to try CAD with
PATCHES = Interface().patches
# of no matter for the mesh
MATERIAL, SLOW = {"young_modulus_GPa": 100, "poisson_ratio": 0.3, "density_kg_m3": 5000}, 1.0

type Faces = list[tuple[str, NDArray[np.float64]]]  # names, and corners (n, 3) as in the file


class Look(NamedTuple):
    """What was found of a blade that can be meshed."""

    source: dict[str, Any]  # unit, frame, root and tip
    patches: int  # of the interface, as many as the mesh of the tip allows
    summary: MeshSummary
    mesh: FileMesh  # in the blade's frame, m
    material: dict[str, float] | None = None  # the one of a deck, by the keys of a blade's

    @property
    def size(self) -> float:
        """Elements (mm) of which one goes through the mean thickness."""
        return 1e3 * self.summary.edge * self.summary.through / ENOUGH

    @property
    def footprint(self) -> str:
        """The tip, in the units of a scene."""
        facets, points = self.mesh.face_groups["tip"], self.mesh.points
        area = np.linalg.norm(normals(facets, points), axis=1).sum() / 2
        leading, trailing = _edges(points[np.unique(facets)])
        return (
            f"tip: radius {1e3 * self.summary.tip_radius:.5g} mm, chord "
            f"{1e3 * np.linalg.norm(trailing - leading):.3g} mm, along the rotation "
            f"{1e3 * area / (trailing - leading)[2]:.2g} mm wide"
        )


def look(file: Path, read: StepFile | FileMesh) -> Look:
    """Find unit, axes, root and tip of a ``file``, which has been ``read``.

    The first axes are taken that a compressor's blade can have: its leading edge is upstream and
    ahead, its concave side ahead in rotation.

    Raises
    ------
    UserError
        When no axes fit: the fault of the likeliest ones.
    """
    kind, physics = "mesh_file", Physics()
    if isinstance(read, StepFile):
        kind, faces, unit = "cad", read.faces(), next(iter(read.units), "mm")
        points, names = np.concatenate([corners for _, corners in faces]), [n for n, _ in faces]
    else:
        mesh = read.without_unused()
        physics, points = mesh.physics, mesh.points
        physics.require_plain()
        faces, names = _pieces(mesh), _groups(mesh)
        likely = "m" if np.ptp(points, axis=0).max() < LONGEST_IN_M else "mm"
        unit = next((u for u in (likely, *METRES) if _material(physics, u)), likely)
    faults = []
    for frame in _frames(faces, points):
        ends = _root_and_tip(faces, names, frame, 1e3 * METRES[unit], MARGIN * (kind == "cad"))
        source = {"unit": unit, "frame": frame.model_dump()} | ends
        size = COARSE * 1e3 * METRES[unit] * float(np.ptp(points, axis=0).max())
        found = _meshed(file, kind, source, {"element_size_mm": size} if kind == "cad" else None)
        if isinstance(found, Look):
            return found._replace(material=_material(physics, unit))
        faults.append(found)
    raise faults[0]


def _material(physics: Physics, unit: str) -> dict[str, float]:
    """The first material of a deck, if its values in a ``unit`` of length can be those of one."""
    first = next(iter(physics.materials), FileMaterial(""))
    values = {key: float(f"{x:.6g}") for key, x in first.taken_in(unit).items()}
    with suppress(UserError):
        check_settings(Material, values, "")
        return values
    return {}


def _pieces(mesh: FileMesh) -> Faces:
    """Each piece of the surface of a mesh that lies across the radius, as a face of CAD.

    Raises
    ------
    MeshError
        When there is none on one side: no axes are found.
    """
    surface, points = exterior(mesh.cells), mesh.points
    normal = normals(surface, points) / np.linalg.norm(normals(surface, points), axis=1)[:, None]
    across = normal[:, _radial(points)]
    sides = surface[across < -END], surface[across > END]
    if not all(map(len, sides)):
        raise MeshError("no surface across the axis that is farthest from the origin")
    return [
        ("", points[np.unique(facets[patches(facets) == piece])])
        for facets in sides
        for piece in range(patches(facets).max() + 1)
    ]


def _groups(mesh: FileMesh) -> list[str]:
    """Names of the groups that hold a facet of the surface."""
    surface = exterior(mesh.cells)
    return [name for name, of in mesh.face_groups.items() if len(of)] + [
        name
        for name, nodes in mesh.node_groups.items()
        if np.isin(surface, nodes).all(axis=1).any()
    ]


def _radial(points: NDArray) -> int:
    """The axis on which points (n, 3) are farthest from the origin."""
    return int(abs(points.min(axis=0) + points.max(axis=0)).argmax())


def _frames(faces: Faces, points: NDArray) -> Iterator[Frame]:
    """Axes that a blade can have, first those about whose engine axis the tip lies on a circle."""
    radial = _radial(points)
    sign = "-" if points[:, radial].mean() < 0 else ""
    tip = max((points for _, points in faces), key=lambda points: abs(points[:, radial]).min())
    others = [axis for axis in (2, 0, 1) if axis != radial]
    off = [np.ptp(np.hypot(*np.delete(tip, axis, axis=1).T)) for axis in others]
    if off[1] < ROUNDER * off[0]:
        others.reverse()
    for axis, hand, way in product(others, ("right-handed", "left-handed"), ("", "-")):
        yield Frame(
            downstream=f"{way}{'xyz'[axis]}", radial=f"{sign}{'xyz'[radial]}", rotation=hand
        )


def _root_and_tip(
    faces: Faces, names: list[str], frame: Frame, scale: float, margin: float
) -> dict[str, Any]:
    """Root and tip by names that say so, else by the radius of the innermost and outermost face.

    ``scale``: mm of a unit of the file; ``margin``: share of the span that radii leave.
    """
    radii = [scale * np.hypot(*(points @ rotation(frame).T)[:, :2].T) for _, points in faces]
    inner, outer = min(map(np.max, radii)), max(map(np.min, radii))
    leave = margin * (outer - inner)
    radius = {"root": inner + leave, "tip": outer - leave}
    named = {name.lower(): {"group": name} for name in names}
    return {end: named.get(end, {"radius_mm": float(f"{r:.6g}")}) for end, r in radius.items()}


def _meshed(
    file: Path,
    kind: str,
    source: dict[str, Any],
    size: dict[str, float] | None,
    patches: int = PATCHES,
) -> Look | UserError:
    """The blade with this ``source``, or why it cannot be."""
    given = {kind: {"file": file.name} | source, "mesh": size, "interface": {"patches": patches}}
    blade = check_settings(Blade, given | {"material": MATERIAL, "max_speed_rpm": SLOW}, file.name)
    with TemporaryDirectory() as folder, redirect_stdout(StringIO()), warnings.catch_warnings():
        warnings.simplefilter("ignore", MeshWarning)
        mesh = Path(folder, "blade.msh")
        try:
            return Look(source, patches, build_mesh(blade, mesh, file), read_mesh_file(mesh))
        except UserError as error:
            fewer = error.allowed["le"] if error.key == "interface.patches" else 0
            return _meshed(file, kind, source, size, fewer) if fewer else error


def _edges(tip: NDArray) -> NDArray[np.float64]:
    """The most upstream and the most downstream point (2, 3) of the tip's."""
    return tip[[tip[:, 2].argmin(), tip[:, 2].argmax()]]


@styled
def draw(found: Look, path: Path) -> None:
    """Draw what is taken for root and tip, along the axis, and for the edges, from outside."""
    drawn, (side, above) = subplots(SINGLE, 2.2, columns=2)
    points = 1e3 * found.mesh.points
    surface = exterior(found.mesh.cells)[:, :3]
    ends = found.mesh.face_groups
    radius = np.hypot(points[:, 0], points[:, 1])
    side.triplot(points[:, 2], radius, surface, color="0.75", linewidth=0.4)
    for end, colour, up in (("root", BLUE, -9), ("tip", VERMILLION, 3)):
        side.triplot(points[:, 2], radius, ends[end], color=colour, linewidth=0.4)
        x, y, z = points[np.unique(ends[end])].mean(axis=0)
        note(side, (z, np.hypot(x, y)), end, (0, up), ha="center", fontsize=8, color=colour)
    above.triplot(points[:, 2], points[:, 1], ends["tip"], color=VERMILLION, linewidth=0.3)
    for name, (_, y, z) in zip(("LE", "TE"), _edges(points[np.unique(ends["tip"])]), strict=True):
        note(above, (z, y), name, (0, 4), ha="center", fontsize=8)
    side.set(xlabel="downstream (mm)", ylabel="radius (mm)", title="blade")
    above.set(xlabel="downstream (mm)", ylabel="in rotation (mm)", title="tip, from outside")
    for axes in (side, above):
        axes.margins(0.12)
        axes.set_aspect("equal", adjustable="datalim")
    save(drawn, path)
