"""Solid lofted through the sections of a table.

The sections need not be planar, for which a loft has no end caps: the four sides are lofted as open
faces, and the outlines of the first and last section are filled.
"""

import gmsh

from geometry.errors import MeshError
from geometry.shape import Shape, by_radius, faces_of, wire
from geometry.table import CutSection


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
    if [len(curves) for curves in around] != [4, 4, 4, 4]:
        raise MeshError("the sections do not loft to four sides; check them")
    return [curves[0] for curves in around], [curves[-1] for curves in around]
