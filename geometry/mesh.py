"""Mesh of a blade, ten-node tetrahedra by gmsh and OpenCASCADE, and its checks."""

import warnings
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

import gmsh
import numpy as np
from numpy.typing import NDArray

from geometry.base import MeshError, MeshWarning, WriteError, about, file_hash, require, whole
from geometry.blade import MOST_THICKNESS, Blade, Cad, MeshGeometry, Sections, SectionTable
from geometry.cad import import_cad
from geometry.facets import normals
from geometry.file_mesh import FileMesh
from geometry.generate import VOLUME_TOLERANCE, generate, volume
from geometry.import_mesh import import_mesh
from geometry.interface import on_facets, places_of, require_patches, tip_of
from geometry.readers import read_mesh_file
from geometry.section_table import describe_cut, read_sections
from geometry.sections import loft_parameters, loft_table
from geometry.shape import (
    CELL,
    SOURCE,
    Shape,
    facets_of,
    jacobian_ratios,
    merge,
    session,
    source_of,
)
from geometry.tetrahedra import edge_lengths, exterior
from geometry.tip import DevelopedTip, cartesian

BEHIND = 0.1  # of the chord: tolerance for a tip with little stagger
MOST_MISSED = 1e-2  # of the volume of the CAD, by the mesh; from VOLUME_TOLERANCE on it is warned
CELLS_IN_CUBE = 8.5  # tetrahedra of equal edges in the cube of the edge
FEWEST_ALONG = 4  # elements along the blade
MOST_CELLS = 5e6
HIGH_ROOT = 0.2  # radial extent of the clamped faces over the blade's, for a warning
ENOUGH = 1.0  # ten-node tetrahedra through the mean thickness: f1 to 0.1 % on the reference blade
HOLLOW = 3e-3  # of the chord: least mean camber of a concave side (an arc that rises 0.5 %)


@dataclass(frozen=True)
class MeshSummary:
    """Numbers of a mesh, some of which the author of the blade knows from elsewhere."""

    nodes: int
    cells: int
    volume: float  # m3, of the mesh
    cad_volume: float | None  # m3, of the solid that was meshed; None for a mesh file
    smallest_jacobian: float  # smallest over largest Jacobian determinant in the worst cell
    span: float  # m, mean radius of the tip less that of the root
    tip_radius: float  # m, largest
    mass: float  # kg
    thickness: float  # m, mean: twice the volume over the area of the sides
    edge: float  # m, mean edge of the elements
    size: float | None = None  # mm, element_size_mm; None for a mesh file

    @property
    def volume_error(self) -> float:
        """Volume of the mesh over that of the CAD, less one; 0 for a mesh file."""
        return self.volume / self.cad_volume - 1 if self.cad_volume else 0.0

    def line(self) -> str:
        """Size and shape of the mesh in one line.

        f1 is proportional to the thickness where that is missing, and grows by half of the part
        missing at the edges: it errs by no more than the volume.
        """
        shown = f"{self.cells} cells, {self.nodes} nodes, {1e9 * self.volume:.6g} mm3"
        if self.cad_volume:
            error = 100 * self.volume_error
            shown += f", {error:+.2g} % off the geometry's (f1 errs by no more for that)"
        return f"{shown}; smallest Jacobian ratio {self.smallest_jacobian:.2f}"

    @property
    def through(self) -> float:
        """Elements through the mean thickness."""
        return self.thickness / self.edge

    def blade_line(self) -> str:
        """The meshed solid, in the units of a drawing, and whether the elements are enough."""
        enough = self.through >= ENOUGH
        if self.size:
            finer = f"take mesh.element_size_mm below {self.size * self.through / ENOUGH:.2g}"
        else:
            finer = f"export elements with edges below {1e3 * self.thickness / ENOUGH:.2g} mm"
        return (
            f"span {1e3 * self.span:.1f} mm, tip radius {1e3 * self.tip_radius:.1f} mm, mass "
            f"{1e3 * self.mass:.4g} g; {self.cells} ten-node tetrahedra, {self.nodes} nodes, "
            f"{self.through:.1f} through the mean thickness of {1e3 * self.thickness:.2g} mm: "
            f"{'enough' if enough else f'too few for bending, {finer}'}"
        )


def build_mesh(
    blade: Blade, mesh_path: str | Path, source: str | Path | None = None
) -> MeshSummary:
    """Mesh the blade and write ``mesh_path`` (MSH 4.1).

    ``source``: the geometry file that the blade names, if any.

    Raises
    ------
    MeshError
        When the geometry is not valid, the tip is oriented against the rotation or too fast, there
        would be more than ``MOST_CELLS`` cells, gmsh fails, volume or Jacobians fail their check,
        or the facets of the tip do not allow the interface.
    geometry.base.errors.WriteError
        When the file cannot be written.
    """
    made_of = file_hash(source) if source and Path(source).is_file() else ""
    with session(f"check {blade.file or 'the sections'}"):
        with about(blade.file):
            shape = _shape(blade, source)
        cad_volume = None
        if blade.mesh:
            _check_count(shape, blade.mesh.element_size_mm)
            cad_volume = generate(shape.solid, blade.mesh.element_size_mm * 1e-3)
        with about(blade.file):
            _check_tip(blade, *facets_of(shape.tip))
        _warn_of_high_root(shape)
        _show_physics(shape, blade)
        groups = {"blade": (3, [shape.solid]), "root": (2, shape.root), "tip": (2, shape.tip)}
        for name, (dimension, tags) in groups.items():
            gmsh.model.addPhysicalGroup(dimension, tags, name=name)
        with whole(mesh_path) as temporary:
            summary = _summary(_written(temporary, mesh_path, made_of), cad_volume, blade)
            print(summary.line())
            _check(summary, blade)
    return summary


def write_moved(mesh_path: Path, moved_path: str | Path, places: NDArray[np.float64]) -> None:
    """Write the mesh in ``mesh_path`` with its nodes at ``places`` (n, 3), m, in the file's order.

    Raises
    ------
    MeshError
        When cells are inside out there.
    geometry.base.errors.WriteError
        When the file cannot be written.
    """
    with session("make the mesh anew"), whole(moved_path) as temporary:
        merge(mesh_path)
        nodes, *_ = gmsh.model.mesh.getNodes()
        for node, place in zip(np.sort(nodes), places, strict=True):
            gmsh.model.mesh.setNode(node, place, [])
        require(
            (
                jacobian_ratios().min() > 0,
                "cells are inside out at rest: make the elements smaller",
            ),
            key="geometry_at_rpm",
        )
        _written(temporary, moved_path, source_of(mesh_path))


def _written(file: Path, mesh_path: str | Path, made_of: str) -> FileMesh:
    """Write the mesh to ``file``, and read it back: gmsh tells of no failure, as of a full disk.

    ``made_of``: what ``source_of`` is to read.
    """
    gmsh.option.setNumber("Mesh.MshFileVersion", 4.1)
    gmsh.write(str(file))
    with file.open("ab") as mesh:
        mesh.write(SOURCE % made_of.encode() if made_of else b"")
    nodes, *_ = gmsh.model.mesh.getNodes()
    cells, _ = gmsh.model.mesh.getElementsByType(CELL)
    with suppress(MeshError):  # cut short
        read = read_mesh_file(file)
        if (len(read.points), len(read.cells)) == (len(nodes), len(cells)):
            return read
    raise WriteError("cannot be written whole; make room there, and run it again", file=mesh_path)


def _shape(blade: Blade, path: str | Path | None) -> Shape:
    match blade.source:
        case Sections() as sections:
            return loft_parameters(sections)
        case SectionTable() as table:
            sections = read_sections(table, path)
            print(describe_cut(sections))
            return loft_table(sections)
        case Cad() as cad:
            return import_cad(cad, path)
        case MeshGeometry() as mesh_file:
            return import_mesh(mesh_file, path)


def _check_tip(blade: Blade, points: NDArray, facets: NDArray) -> None:
    """Check that the tip is oriented as that of a compressor and allows the interface."""
    tip = tip_of(facets, points)
    # that of a profile, not a shroud, which is as wide as it is long
    require(
        (
            tip.width() <= MOST_THICKNESS,
            f"the tip is {100 * tip.width():.0f} % as wide as it is long (allowed "
            f"{100 * MOST_THICKNESS:.0f} %), as a shroud or a platform: only plain tips are "
            f"modelled; choose the faces of one, or take the shroud off",
        )
    )
    line = cartesian(tip.camber_line())
    _check_sense(line, blade)
    _check_camber(tip, blade)
    _check_speed(line, blade)
    if blade.of_points:
        on_facets(points, facets, tip, places_of(blade.interface, tip))
    else:
        require_patches(blade.interface.patches, tip.xi(points))


def _check_sense(line: NDArray, blade: Blade) -> None:
    """Check that the leading edge is upstream and ahead; ``line`` (n, 3), m: the camber line."""
    chord = line[-1] - line[0]
    where = "frame.downstream and frame.rotation" if blade.file else "the stagger of the tip"
    require(
        (
            np.all(np.diff(line[:, 2]) > 0),
            f"the camber line of the tip does not run downstream; check {where}",
        ),
        (
            chord[1] <= BEHIND * np.linalg.norm(chord),
            f"the upstream end of the tip is behind in the sense of rotation; check {where}",
        ),
    )


def _check_camber(tip: DevelopedTip, blade: Blade) -> None:
    """Check that the concave side is ahead in rotation, as the pressure side of a compressor.

    Only this check detects a frame with both downstream and rotation reversed. It is not needed for
    a blade given by parameters, nor if listed points on the tip confirm the frame.
    """
    needed = blade.file and not blade.interface.points_mm
    height = tip.camber_height() if needed else 0.0
    require(
        (
            height >= -HOLLOW,
            f"the hollow side of the tip is behind in the sense of rotation (its camber line is "
            f"{-100 * height:.2g} % of the chord ahead of it), as that of a turbine, which is not "
            f"modelled; if it is a compressor's, frame.downstream and frame.rotation are both "
            f"reversed",
        )
    )


def _check_speed(line: NDArray, blade: Blade) -> None:
    """Check the speed of the tip: if too high, the unit of length or of speed is wrong."""
    radius = float(np.hypot(line[:, 0], line[:, 1]).max())
    length = f"{blade.source_key}.unit: {blade.source.unit}" if blade.file else "the lengths"
    blade.require_speed(radius, length)


def _check_count(shape: Shape, size_mm: float) -> None:
    """Check the size against the blade's length, and the number of cells.

    With a size in another unit gmsh would fail for a reason of its own, or not finish.
    """
    low, high = np.reshape(gmsh.model.getBoundingBox(3, shape.solid), (2, 3))
    length = 1e3 * float(np.max(high - low))
    of_size = {"key": "mesh.element_size_mm", "value": size_mm}
    require(
        (
            size_mm <= length / FEWEST_ALONG,
            f"too large for a blade of {length:.4g} mm: choose {length / FEWEST_ALONG:.2g} or less",
        ),
        allowed={"le": length / FEWEST_ALONG},
        **of_size,
    )
    cells = CELLS_IN_CUBE * gmsh.model.occ.getMass(3, shape.solid) / (size_mm * 1e-3) ** 3
    least = 1.05 * size_mm * (cells / MOST_CELLS) ** (1 / 3)  # allowed also when rounded
    require(
        (
            cells <= MOST_CELLS,
            f"makes some {cells:.1e} cells (allowed {MOST_CELLS:.0e}): choose {least:.2g} or more",
        ),
        allowed={"ge": least},
        **of_size,
    )


def _warn_of_high_root(shape: Shape) -> None:
    """Warn of clamped faces that reach far up the blade, which make it too stiff unnoticed."""
    root, tip = (np.hypot(*facets_of(f)[0][:, :2].T) for f in (shape.root, shape.tip))
    share = np.ptp(root) / (tip.max() - root.min())
    if share > HIGH_ROOT:
        warnings.warn(
            f"the root is clamped from radius {root.min() * 1e3:.4g} to {root.max() * 1e3:.4g} mm, "
            f"{100 * share:.0f} % of the blade's length: check that it holds no skin of the blade",
            MeshWarning,
            stacklevel=3,
        )


def _show_physics(shape: Shape, blade: Blade) -> None:
    """Print what a mesh file has besides its mesh; warn where its material is another."""
    if left_out := shape.physics.described:
        print(f"{blade.file}: read for its mesh and materials, without {left_out}")
    for material in shape.physics.materials:
        shown = f"{blade.file}: {material.described(blade.source.unit)}"
        print(shown)
        if others := material.differs(blade.material, blade.source.unit):
            warnings.warn(
                f"{shown}; taken is `material` of the blade: {', '.join(others)}",
                MeshWarning,
                stacklevel=3,
            )


def _summary(mesh: FileMesh, cad_volume: float | None, blade: Blade) -> MeshSummary:
    """Numbers of the ``mesh`` as it was written, which gmsh still holds."""
    mesh_volume = volume()
    faces = mesh.face_groups
    root_area, tip_area, surface_area = (
        np.linalg.norm(normals(facets, mesh.points), axis=1).sum() / 2
        for facets in (faces["root"], faces["tip"], exterior(mesh.cells))
    )
    radius = np.hypot(mesh.points[:, 0], mesh.points[:, 1])
    return MeshSummary(
        nodes=len(mesh.points),
        cells=len(mesh.cells),
        volume=mesh_volume,
        cad_volume=cad_volume,
        smallest_jacobian=float(jacobian_ratios().min()),
        span=float(radius[faces["tip"]].mean() - radius[faces["root"]].mean()),
        tip_radius=float(radius[faces["tip"]].max()),
        mass=float(blade.material.density_kg_m3 * mesh_volume),
        thickness=float(2 * mesh_volume / (surface_area - root_area - tip_area)),
        edge=float(edge_lengths(mesh.points, mesh.cells).mean()),
        size=blade.mesh and blade.mesh.element_size_mm,
    )


def _check(summary: MeshSummary, blade: Blade) -> None:
    """Check the mesh of a geometry; that of a mesh file is checked where it is read."""
    if blade.mesh is None:
        return
    size = f"mesh.element_size_mm: {blade.mesh.element_size_mm:g}"
    off = (
        f"{size}: the mesh is {100 * summary.volume_error:+.2g} % off the volume of the geometry, "
        f"{summary.cad_volume:.6e} m3"
    )
    require(
        (
            summary.smallest_jacobian > 0,
            f"{size}: cells stay inside out (Jacobian ratio {summary.smallest_jacobian:.2f}) at "
            f"faces that are curved too much for it, also when they are moved: choose less, or "
            f"remove small faces and rounds from the geometry",
        ),
        (
            abs(summary.volume_error) <= MOST_MISSED,
            f"{off} (allowed {100 * MOST_MISSED:g} %): choose less, or remove small faces and "
            f"rounds from the geometry",
        ),
    )
    if abs(summary.volume_error) > VOLUME_TOLERANCE:
        warnings.warn(
            f"{off}, at faces that are curved too much for its cells: f1 errs by some as much; "
            f"choose less for a better shape, or remove small rounds",
            MeshWarning,
            stacklevel=3,
        )
