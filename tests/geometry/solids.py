"""Solids as CAD programs make them, with round edges: lofts through splines, in mm, as STEP."""

from collections.abc import Callable
from pathlib import Path

import gmsh
import numpy as np

from geometry.shape import session

HUB, TIP = 70.0, 150.0  # mm


def write(path: Path, make: Callable[[], object]) -> Path:
    """STEP file (mm) of what ``make`` adds to gmsh's model."""
    with session("test"):
        gmsh.option.setString("Geometry.OCCTargetUnit", "MM")  # which gmsh keeps between sessions
        make()
        gmsh.model.occ.synchronize()
        gmsh.write(str(path))
    return path


def placed(r: float, stagger: float, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Points (n, 3) of a section at radius r; x along the chord from its middle, y across."""
    c, s = np.cos(np.radians(stagger)), np.sin(np.radians(stagger))
    return np.column_stack([np.full_like(x, r), -x * s + y * c, x * c + y * s])


_spline = gmsh.model.occ.addSpline


def _points(at: np.ndarray) -> list[int]:
    return [gmsh.model.occ.addPoint(*point) for point in at]


def loft(wires: list[int]) -> list[tuple[int, int]]:
    """Solid through the ``wires``."""
    made = gmsh.model.occ.addThruSections(wires, makeSolid=True, makeRuled=False)
    return [entity for entity in made if entity[0] == 3]


def elliptic() -> list[tuple[int, int]]:
    """Blade of elliptic thickness on a parabolic camber line: edges of 0.26 to 0.01 mm radius.

    Its area is pi/4 c t at each radius, also sheared by camber: in sum 12225.0 mm3.
    """

    def section(f: float) -> int:
        chord, t, a = 58 - 4 * f, 5.5 - 4.1 * f, np.linspace(0, np.pi, 41)
        x = -np.cos(a) / 2
        camber, half = -0.05 * (1 - 4 * x**2) * chord, t / 2 * np.sin(a)
        r, stagger = HUB + (TIP - HUB) * f, 20 + 30 * f
        one, other = (_points(placed(r, stagger, x * chord, camber + s * half)) for s in (1, -1))
        return gmsh.model.occ.addWire([_spline(one), _spline([one[0], *other[1:-1], one[-1]])])

    return loft([section(f) for f in (0, 1 / 3, 2 / 3, 1)])


ELLIPTIC = np.pi / 4 * 80 * (58 * 5.5 - (58 * 4.1 + 4 * 5.5) / 2 + 4 * 4.1 / 3)  # mm3


def half_thickness(f: float, leading: float, trailing: float, x: np.ndarray) -> np.ndarray:
    """Of the blade ``rounded``, at chord fractions x."""
    edges = leading + (trailing - leading) * x
    return edges + ((5.5 - 3.5 * f) - leading - trailing) / 2 * 4 * x * (1 - x)


def rounded(leading: float, trailing: float, hub: float = HUB) -> list[tuple[int, int]]:
    """Blade whose edges are parabolas as high as half of their width, mm, a face each."""

    def section(f: float) -> int:
        chord, x = 60 - 6 * f, (1 - np.cos(np.linspace(0, np.pi, 25))) / 2
        half = half_thickness(f, leading, trailing, x)
        camber = -(0.06 - 0.03 * f) * chord * 4 * x * (1 - x)

        def at(x: np.ndarray, y: np.ndarray) -> list[int]:
            return _points(placed(hub + (TIP - hub) * f, 20 + 30 * f, x - chord / 2, y))

        one, other = (at(x * chord, camber + side * half) for side in (1, -1))
        (first,), (last,) = (
            at(np.array([end]), np.zeros(1)) for end in (-leading, chord + trailing)
        )
        curves = [one, [one[-1], last, other[-1]], other[::-1], [other[0], first, one[0]]]
        return gmsh.model.occ.addWire([_spline(points) for points in curves])

    return loft([section(f) for f in (0, 0.25, 0.5, 0.75, 1)])


def rounded_volume(leading: float, trailing: float) -> float:
    """Volume of ``rounded``, mm3, by Simpson's rule over the span."""
    x, w = np.polynomial.legendre.leggauss(20)

    def area(f: float) -> float:
        sides = (60 - 6 * f) * half_thickness(f, leading, trailing, (x + 1) / 2) @ w
        return sides + 4 / 3 * (leading**2 + trailing**2)

    return (TIP - HUB) / 6 * (area(0) + 4 * area(0.5) + area(1))


def core(low: float, high: float, width: float) -> list[tuple[int, int]]:
    """Solid within ``rounded``, between two radii: a pocket or a cavity to be cut out."""

    def section(r: float) -> int:
        f = (r - HUB) / (TIP - HUB)
        chord, x = 60 - 6 * f, np.linspace(0.1, 0.9, 15)
        half = width * half_thickness(f, 0.3, 0.15, x)
        camber = -(0.06 - 0.03 * f) * chord * 4 * x * (1 - x)
        one, other = (
            _points(placed(r, 20 + 30 * f, (x - 0.5) * chord, camber + side * half))
            for side in (1, -1)
        )
        line = gmsh.model.occ.addLine
        curves = [_spline(one), line(one[-1], other[-1]), _spline(other[::-1])]
        return gmsh.model.occ.addWire([*curves, line(other[0], one[0])])

    return loft([section(r) for r in np.linspace(low, high, 3)])


def pocketed(low: float, high: float, width: float) -> None:
    """Pocket, open at the tip or at the root."""
    gmsh.model.occ.cut(rounded(0.3, 0.15), core(low, high, width))


def shrouded() -> None:
    """Platform at the tip."""
    gmsh.model.occ.fuse(rounded(0.3, 0.15), [(3, gmsh.model.occ.addBox(149, -22, -22, 3, 44, 44))])


def filleted() -> None:
    """Fillet of 0.5 mm between the blade and a platform at its root."""
    occ = gmsh.model.occ
    ((_, solid),), _ = occ.fuse(
        rounded(0.8, 0.6, hub=68), [(3, occ.addBox(64, -25, -35, 6, 50, 70))]
    )
    occ.synchronize()
    around = []
    for _, edge in gmsh.model.getEntities(1):
        low, high = np.reshape(gmsh.model.getBoundingBox(1, edge), (2, 3))
        if abs(low[0] - HUB) < 1e-3 > abs(high[0] - HUB) and max(abs(low[1]), abs(high[1])) < 24.9:
            around.append(edge)
    occ.fillet([solid], around, [0.5])
