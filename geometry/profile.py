"""Parabolic blade sections: camber line, outline, area and centroid in closed form.

A section lies in a plane of constant x. Along the chord, xi runs from 0 (leading edge) to 1
(trailing edge) and w = 4 xi (1 - xi) is the unit parabola: camber y_c = m c w and half thickness
t/2 [e + (1 - e) w], both measured across the chord. Each side is a parabola, which is exactly a
quadratic Bezier curve.
"""

from dataclasses import dataclass
from math import cos, radians, sin

import numpy as np
from numpy.typing import ArrayLike, NDArray

from geometry.blade import Sections


@dataclass(frozen=True)
class Airfoil:
    """One section; lengths in m, angle in rad."""

    x: float  # plane of the section
    chord: float
    thickness: float
    camber: float  # rise of the camber line, m
    edge: float  # thickness of the edges over the largest thickness
    stagger: float
    offset: tuple[float, float]  # centroid off the radial line (y, z)

    @property
    def area(self) -> float:
        """Area of the section, m2."""
        return self.chord * self.thickness * (self.edge + 2 / 3 * (1 - self.edge))

    @property
    def centroid_height(self) -> float:
        """Distance of the centroid from the chord, m."""
        e = self.edge
        return self.camber * (2 / 3 * e + 8 / 15 * (1 - e)) / (e + 2 / 3 * (1 - e))

    def place(self, xi: ArrayLike, height: ArrayLike) -> NDArray:
        """Points (n, 3), m, at chord fraction ``xi`` and ``height`` (m) across the chord.

        The chord runs from the leading edge, ahead in rotation, downstream to the trailing edge;
        the convex (suction) side is behind in rotation.
        """
        along = (np.atleast_1d(xi) - 0.5) * self.chord
        across = np.broadcast_to(height, along.shape) - self.centroid_height
        c, s = cos(self.stagger), sin(self.stagger)
        y = -s * along - c * across + self.offset[0]
        z = c * along - s * across + self.offset[1]
        return np.column_stack([np.full_like(along, self.x), y, z])

    def bezier(self, side: int) -> NDArray:
        """Control points (3, 3), m, of one side: suction (+1) or pressure (-1), from LE to TE."""
        edge = side * self.edge * self.thickness / 2
        rise = self.camber + side * (1 - self.edge) * self.thickness / 2
        return self.place([0, 0.5, 1], [edge, edge + 2 * rise, edge])


def profile_at(s: Sections, x: float) -> Airfoil:
    """Section of the blade in the plane at ``x`` (m), linear in x, also beyond hub and tip."""
    fraction = (x - s.hub_radius) / s.span

    def between(hub: float, tip: float) -> float:
        """Value at ``x`` of a quantity with these values at hub and tip."""
        return hub + fraction * (tip - hub)

    chord = between(s.hub.chord_mm, s.tip.chord_mm) * 1e-3
    return Airfoil(
        x=x,
        chord=chord,
        thickness=between(s.hub.thickness_mm, s.tip.thickness_mm) * 1e-3,
        camber=chord * between(s.hub.camber_percent, s.tip.camber_percent) / 100,
        edge=s.edge_thickness_percent / 100,
        stagger=radians(between(s.hub.stagger_deg, s.tip.stagger_deg)),
        offset=(
            fraction * s.tip_lean_tangential_mm * 1e-3,
            fraction * s.tip_lean_axial_mm * 1e-3,
        ),
    )
