"""Blade -> ten-node tetrahedra, with gmsh and OpenCASCADE.

Planar sections from a little below the hub to a little beyond the tip are lofted, and the loft is
cut with the annulus between the hub and tip cylinders: root and tip are then exact cylinder faces.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import gmsh
import numpy as np
from numpy.typing import NDArray

from geometry.blade import Blade, Sections
from geometry.errors import MeshError
from geometry.files import whole
from geometry.import_mesh import import_mesh
from geometry.interface import InterfaceNodes
from geometry.profile import Profile, interface_points, profile_at

SECTIONS = 9  # planes of the loft
OVERHANG = 0.03  # share of the span by which the loft passes hub and tip
ON_CYLINDER = 1e-8  # m, how far a tip node may lie off the tip cylinder
VOLUME_TOLERANCE = 1e-3  # mesh against CAD volume; ten-node tetrahedra keep well below


@dataclass(frozen=True)
class MeshSummary:
    """What the checks of a mesh measured."""

    nodes: int
    cells: int
    volume: float  # m3, of the mesh
    cad_volume: float  # m3, of the lofted solid
    smallest_jacobian: float  # smallest over largest Jacobian determinant in the worst cell


def build_mesh(
    blade: Blade,
    mesh_path: str | Path,
    interface_path: str | Path,
    source: str | Path | None = None,
) -> MeshSummary:
    """Mesh the blade and write ``mesh_path`` (MSH 4.1) and ``interface_path`` (CSV).

    ``source`` is the geometry file that the blade names, if it names one.

    Raises
    ------
    MeshError
        When gmsh fails, or volume, Jacobians, tip radius or interface nodes fail their check.
    """
    with _session():
        if blade.mesh_file is not None:
            nodes = import_mesh(blade.mesh_file, blade.interface, source)
            gmsh.model.addPhysicalGroup(3, [1], name="blade")
            gmsh.model.addPhysicalGroup(2, [1], name="root")
            gmsh.model.addPhysicalGroup(2, [2], name="tip")
            with whole(mesh_path) as temporary:
                gmsh.option.setNumber("Mesh.MshFileVersion", 4.1)
                gmsh.write(str(temporary))
            nodes.save(interface_path)
            return None
        sections = blade.sections
        solid = _loft(sections)
        root, tip = _cut_faces(sections, solid)
        points = interface_points(sections, blade.interface.nodes)
        _embed(points, tip)
        gmsh.model.addPhysicalGroup(3, [solid], name="blade")
        gmsh.model.addPhysicalGroup(2, [root], name="root")
        gmsh.model.addPhysicalGroup(2, [tip], name="tip")
        _generate(blade.mesh.element_size_mm * 1e-3)
        nodes = _interface_on_mesh(points, tip, sections.tip_radius)
        summary = _summary(solid)
        _check(summary, blade)
        with whole(mesh_path) as temporary:
            gmsh.option.setNumber("Mesh.MshFileVersion", 4.1)
            gmsh.write(str(temporary))
        nodes.save(interface_path)
    return summary


@contextmanager
def _session() -> Iterator[None]:
    """One gmsh model, quiet; gmsh's own errors are bare ``Exception``s and become ``MeshError``."""
    gmsh.initialize(interruptible=False)
    gmsh.option.setNumber("General.Terminal", 0)
    try:
        yield
    except Exception as error:
        if type(error) is not Exception:
            raise
        raise MeshError(f"gmsh: {error}; check the sections") from None
    finally:
        gmsh.finalize()


def _wire(profile: Profile) -> int:
    """Closed outline of one section: suction side, trailing edge, pressure side, leading edge."""
    occ = gmsh.model.occ
    suction, pressure = profile.bezier(+1), profile.bezier(-1)
    a, b, c = (occ.addPoint(*point) for point in suction)
    f, e, d = (occ.addPoint(*point) for point in pressure)
    curves = [
        occ.addBezier([a, b, c]),
        occ.addLine(c, d),
        occ.addBezier([d, e, f]),
        occ.addLine(f, a),
    ]
    return occ.addWire(curves)


def _loft(sections: Sections) -> int:
    """Solid between the hub and tip cylinders; returns its tag."""
    occ = gmsh.model.occ
    margin = OVERHANG * sections.span
    planes = np.linspace(sections.hub_radius - margin, sections.tip_radius + margin, SECTIONS)
    wires = [_wire(profile_at(sections, x)) for x in planes]
    loft = occ.addThruSections(wires, makeSolid=True, makeRuled=False)
    reach = 2 * max(sections.hub.chord_mm, sections.tip.chord_mm) * 1e-3
    outer = occ.addCylinder(0, 0, -reach, 0, 0, 2 * reach, sections.tip_radius)
    inner = occ.addCylinder(0, 0, -reach, 0, 0, 2 * reach, sections.hub_radius)
    # half a turn takes the seam of the cylinders, at theta = 0, away from the blade
    occ.rotate([(3, outer), (3, inner)], 0, 0, 0, 0, 0, 1, np.pi)
    annulus, _ = occ.cut([(3, outer)], [(3, inner)])
    solids, _ = occ.intersect([tag for tag in loft if tag[0] == 3], annulus)
    occ.remove(occ.getEntities(2) + occ.getEntities(1) + occ.getEntities(0), recursive=False)
    occ.synchronize()
    if len(solids) != 1:
        raise MeshError(f"the sections loft to {len(solids)} solids, not one; check the sections")
    return solids[0][1]


def _cut_faces(sections: Sections, solid: int) -> tuple[int, int]:
    """Faces on the hub and the tip cylinder, found by the radius of their centre of mass."""
    faces = [tag for _, tag in gmsh.model.getBoundary([(3, solid)], oriented=False)]
    radius = {tag: np.hypot(*gmsh.model.occ.getCenterOfMass(2, tag)[:2]) for tag in faces}
    root, tip = min(radius, key=radius.__getitem__), max(radius, key=radius.__getitem__)
    for tag, profile, name in (
        (root, profile_at(sections, sections.hub_radius), "root"),
        (tip, profile_at(sections, sections.tip_radius), "tip"),
    ):
        area = gmsh.model.occ.getMass(2, tag)
        if abs(area / profile.area - 1) > 0.02:  # a cylinder cuts the section a little obliquely
            raise MeshError(
                f"{name} face of {area:.3e} m2 where the section has {profile.area:.3e}; "
                f"check its thickness, and chord and lean against the radius"
            )
    return root, tip


def _embed(points: NDArray, tip: int) -> None:
    occ = gmsh.model.occ
    tags = [occ.addPoint(*point) for point in points]
    occ.synchronize()
    gmsh.model.mesh.embed(0, tags, 2, tip)


def _generate(size: float) -> None:
    """Second-order tetrahedra of one size, HXT, straightened nowhere: curved faces stay curved."""
    for option, value in {
        "Mesh.MeshSizeMin": size,
        "Mesh.MeshSizeMax": size,
        "Mesh.Algorithm3D": 10,
        "Mesh.ElementOrder": 2,
        "Mesh.HighOrderOptimize": 0,
        "Mesh.RandomSeed": 1,
        "General.NumThreads": 1,
    }.items():
        gmsh.option.setNumber(option, value)
    gmsh.model.mesh.generate(3)


def _interface_on_mesh(points: NDArray, tip: int, tip_radius: float) -> InterfaceNodes:
    """Mesh nodes at the embedded points, checked to lie on the tip cylinder and in order."""
    kind = gmsh.model.mesh.getElementType("triangle", 2)
    _, corners = gmsh.model.mesh.getElementsByType(kind, tip)
    on_tip = np.array([gmsh.model.mesh.getNode(node)[0] for node in np.unique(corners)])
    gap = np.linalg.norm(on_tip[None] - points[:, None], axis=2)
    nodes = InterfaceNodes(points=on_tip[gap.argmin(axis=1)])
    off = np.linalg.norm(nodes.points - points, axis=1).max()
    if off > ON_CYLINDER or np.abs(nodes.radius - tip_radius).max() > ON_CYLINDER:
        raise MeshError(f"an interface node lies {off:.1e} m off its place on the tip")
    if np.any(np.diff(nodes.points[:, 2]) <= 0):
        raise MeshError("interface nodes do not run downstream; check the stagger of the tip")
    return nodes


def _summary(solid: int) -> MeshSummary:
    """Volume and Jacobians over all cells at the points of a degree-4 quadrature."""
    kind = gmsh.model.mesh.getElementType("tetrahedron", 2)
    points, weights = gmsh.model.mesh.getIntegrationPoints(kind, "Gauss4")
    _, determinants, _ = gmsh.model.mesh.getJacobians(kind, points)
    determinants = np.reshape(determinants, (-1, len(weights)))
    tags, _, _ = gmsh.model.mesh.getNodes()
    return MeshSummary(
        nodes=len(tags),
        cells=len(determinants),
        volume=float((determinants @ weights).sum()),
        cad_volume=gmsh.model.occ.getMass(3, solid),
        smallest_jacobian=float((determinants.min(1) / np.abs(determinants).max(1)).min()),
    )


def _check(summary: MeshSummary, blade: Blade) -> None:
    if summary.smallest_jacobian <= 0:
        raise MeshError(
            f"a cell is turned inside out (Jacobian ratio {summary.smallest_jacobian:.2f}); "
            f"choose mesh.element_size_mm below {blade.mesh.element_size_mm}"
        )
    if abs(summary.volume / summary.cad_volume - 1) > VOLUME_TOLERANCE:
        raise MeshError(
            f"mesh volume {summary.volume:.6e} m3 against {summary.cad_volume:.6e} m3 of the CAD; "
            f"choose mesh.element_size_mm below {blade.mesh.element_size_mm}"
        )
