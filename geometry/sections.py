"""Solid lofted from the parameters of hub and tip sections, or through the sections of a table.

From parameters, planar sections from slightly below the hub to slightly above the tip are lofted,
and the loft is cut with the annulus between the hub and tip cylinders: root and tip are exact
cylinder faces. The sections of a table need not be planar, for which a loft has no end caps: the
four sides are lofted as open faces, and the outlines of the first and last section are filled.
"""

import gmsh
import numpy as np

from geometry.base import require
from geometry.blade import Sections
from geometry.profile import profile_at
from geometry.section_table import CutSection
from geometry.shape import Shape, by_radius, faces_of, wire

PLANES = 9  # number of sections of the loft
OVERHANG = 0.03  # of the span, by which the loft extends beyond hub and tip


def loft_parameters(sections: Sections) -> Shape:
    """Blade between the hub and tip cylinders.

    Raises
    ------
    MeshError
        When the loft is not a single solid, or the area of root or tip is not that of its section.
    """
    solid = _loft(sections)
    root, tip = _cut_faces(sections, solid)
    return Shape(solid, (root,), (tip,))


def _loft(sections: Sections) -> int:
    """Solid between the hub and tip cylinders; returns its tag."""
    occ = gmsh.model.occ
    margin = OVERHANG * sections.span
    planes = np.linspace(sections.hub_radius - margin, sections.tip_radius + margin, PLANES)
    profiles = [profile_at(sections, x) for x in planes]
    wires = [wire(p.bezier(+1), p.bezier(-1), occ.addBezier) for p in profiles]
    loft = occ.addThruSections(wires, makeSolid=True, makeRuled=False)
    reach = 2 * max(sections.hub.chord_mm, sections.tip.chord_mm) * 1e-3
    outer = occ.addCylinder(0, 0, -reach, 0, 0, 2 * reach, sections.tip_radius)
    inner = occ.addCylinder(0, 0, -reach, 0, 0, 2 * reach, sections.hub_radius)
    # rotate the seam of the cylinders, at theta = 0, away from the blade
    occ.rotate([(3, outer), (3, inner)], 0, 0, 0, 0, 0, 1, np.pi)
    annulus, _ = occ.cut([(3, outer)], [(3, inner)])
    solids, _ = occ.intersect([tag for tag in loft if tag[0] == 3], annulus)
    occ.remove(occ.getEntities(2) + occ.getEntities(1) + occ.getEntities(0), recursive=False)
    occ.synchronize()
    require(
        (
            len(solids) == 1,
            f"the sections loft to {len(solids)} solids, not one; check the sections",
        )
    )
    return solids[0][1]


def _cut_faces(sections: Sections, solid: int) -> tuple[int, int]:
    """Faces on the hub and the tip cylinder, found by the radius of their centre of mass."""
    root, *_, tip = by_radius(faces_of(solid), 2)
    for tag, profile, name in (
        (root, profile_at(sections, sections.hub_radius), "root"),
        (tip, profile_at(sections, sections.tip_radius), "tip"),
    ):
        area = gmsh.model.occ.getMass(2, tag)
        require(
            (
                abs(area / profile.area - 1) <= 0.02,  # the cylinder is oblique to the section
                f"{name} face of {area:.3e} m2 where the section has {profile.area:.3e}; "
                f"check its thickness, and chord and lean against the radius",
            )
        )
    return root, tip


def loft_table(sections: list[CutSection]) -> Shape:
    """Blade from the first section, its root, to the last, its tip.

    Raises
    ------
    MeshError
        When the loft does not have four sides.
    """
    occ = gmsh.model.occ
    sides = occ.addThruSections(
        [wire(s.suction, s.pressure, occ.addSpline) for s in sections],
        makeSolid=False,
        makeRuled=False,
    )
    occ.synchronize()
    ends = [
        occ.addBSplineFilling(occ.addCurveLoop(curves), type="Stretch") for curves in _ends(sides)
    ]
    shell = occ.addSurfaceLoop([*(tag for _, tag in sides), *ends], sewing=True)
    solid = occ.addVolume([shell])
    occ.remove(occ.getEntities(2) + occ.getEntities(1) + occ.getEntities(0), recursive=False)
    occ.synchronize()
    faces = by_radius(faces_of(solid), 2)
    return Shape(solid, root=(faces[0],), tip=(faces[-1],))


def _ends(sides: list[tuple[int, int]]) -> tuple[list[int], list[int]]:
    """Curves of the first and of the last section, in the order of the sides, which form a loop."""
    around = [
        by_radius((tag for _, tag in gmsh.model.getBoundary([side], oriented=False)), 1)
        for side in sides
    ]
    require(
        (
            [len(curves) for curves in around] == [4, 4, 4, 4],
            "the sections do not loft to four sides; check them",
        )
    )
    return [curves[0] for curves in around], [curves[-1] for curves in around]
