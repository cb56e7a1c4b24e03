"""Patches pressed on a half-plane (Flamant 1892) and on a block, in closed form.

In plane strain a pressure p over |z| < a of a half-plane moves its surface inward by

    u(z) = -2 (1 - nu^2) / (pi E) int p(s) ln|z - s| ds + constant

(Johnson, Contact Mechanics, 1985, section 2.3). The constant is that of a far support, which no
difference between two places has. With patches p is a sum of hats, and c the projection of u on
them. On |z|, |s| < a = 1, -ln|z - s| = ln 2 + sum_n 2/n T_n(z) T_n(s), Chebyshev polynomials.
"""

import numpy as np
import pytest
from blades import given
from numpy.polynomial.chebyshev import chebvander
from numpy.polynomial.legendre import leggauss
from scipy.optimize import brentq
from scipy.sparse.linalg import splu

from fem.interface_operator import interface_of
from fem.prestress import linear_states
from geometry.hats import hat_nodes, hats, middles

E, NU = 113.8e9, 0.342  # TITANIUM of the box
FAR = 30.0  # m, to the clamped sides and bottom; half of the tip is 1 m
THICKNESS = 0.4  # m
HUB = 1e4  # m, so that the tip is plane
PATCHES = 8


def graded(first, inner, end):
    """Map of [0, 1] onto [0, ``end``]: slope ``first`` up to ``inner``, exponential beyond."""

    def mapped(q, k):
        beyond = np.maximum(q - inner, 0)
        return first * (np.minimum(q, inner) + np.expm1(k * beyond) / k)

    k = brentq(lambda k: mapped(1.0, k) - end, 1e-3, 100)
    return lambda q: mapped(q, k)


def half_plane(box, level):
    """A block of 2 FAR x FAR around a tip of 2 m, 8 ``level`` cells along half of it."""
    within, around, deep = 8 * level, 8 * level, 12 * level
    cell = 1 / within
    share = within / (within + around)
    along = graded(1 / share, share, FAR)
    down = graded(deep * cell, 0.0, FAR)

    def moved(X):
        x, y, z = X.T
        depth = down(1 - (x - HUB) / FAR)
        return np.column_stack([HUB + FAR - depth, y, np.sign(z) * along(abs(z) / FAR)])

    cells, size = [deep, 1, 2 * (within + around)], [FAR, THICKNESS, 2 * FAR]
    return box(cells, size, clamped="nowhere", hub=HUB, half_tip=1.0, moved=moved)


def compliance(solid, interface, held):
    """C (n, n), m/N, of radial forces on the patches; DoFs where ``held`` is true are fixed."""
    (state,) = linear_states(solid, np.array([0.0]))
    free = np.flatnonzero(~held(solid.free_coordinates()).ravel())
    S = interface.S[0::3][:, free].toarray()
    return S @ splu(state.K[free][:, free].tocsc()).solve(S.T)


def plane_strain(X):
    """No motion across the thickness, none at all at the sides and the bottom."""
    x, _, z = X.T
    around = (x < HUB + 1e-6) | (abs(z) > FAR - 1e-6)
    return np.column_stack([around, np.ones_like(around), around])


def flamant(n, terms=120):
    """C (n, n) of a half-plane, m/N, but for a constant: hats on |z| < 1 loaded and projected."""
    nodes = 2 * hat_nodes(n) - 1
    x, w = leggauss(80)
    half = (nodes[1] - nodes[0]) / 2
    z = ((nodes[:-1] + half)[:, None] + half * x).ravel()  # kinks are between them
    weights = np.tile(half * w, n - 1)
    phi = hats(z, nodes)
    G = phi.T @ (weights[:, None] * phi)
    moments = phi.T @ (weights[:, None] * chebvander(z, terms)[:, 1:])
    L = (moments * (2 / np.arange(1, terms + 1))) @ moments.T
    inverse = np.linalg.inv(G)
    return 2 * (1 - NU**2) / (np.pi * E * THICKNESS) * inverse @ L @ inverse


@pytest.fixture(scope="module")
def found(box, coarse_blade):
    """C of two meshes, the second one of half the size."""
    blade = given(coarse_blade, interface={"patches": PATCHES, "across": 1})
    solids = [half_plane(box, level) for level in (1, 2)]
    return [compliance(s, interface_of(s, blade), plane_strain) for s in solids]


def relative(C, strips):
    """Displacement at ``strips`` under a force on one of them, minus that of the loaded one.

    Shape (strips, strips).

    The unknown constant of the half-plane cancels.
    """
    P = hats(middles(strips), hat_nodes(PATCHES))
    U = P @ C @ P.T
    return U - np.diag(U)


@pytest.mark.parametrize(("strips", "errors"), [(8, (0.02, 0.004)), (16, (0.045, 0.009))])
def test_pressed_patch_moves_against_its_neighbours_as_on_flamants_half_plane(
    found, strips, errors
):
    """Every strip pressed, every other looked at; over the largest difference.

    Limited by the cells, 2.3 and 4.6 between two nodes of the hats: measured 1.5 and 0.31 % of 8
    strips, 3.5 and 0.71 % of 16 (the dual traction of a strip off the hats' nodes is steeper). The
    support is 30 half tips off, which bends the surface by its square, 0.1 %.
    """
    exact = relative(flamant(PATCHES), strips)
    off = [abs(relative(C, strips) - exact).max() / abs(exact).max() for C in found]
    assert off[0] < errors[0] and off[1] < errors[1]
    assert off[0] > 3 * off[1]  # it converges, as no point load does


def test_rigid_flat_punch_presses_with_its_edges(found):
    """c = 1 everywhere: F_i = int phi_i / (pi sqrt(1 - z^2)) dz of a force of 1 (Sadowsky 1928).

    The root at the edges is not a sum of eight hats: measured 6.0 %; the reactions of the mesh are
    within 0.5 % of those of these hats on a half-plane.
    """
    angle = (np.arange(20_000) + 0.5) / 20_000 * np.pi
    punch = hats(np.cos(angle), 2 * hat_nodes(PATCHES) - 1).mean(axis=0)
    far = 10 * np.log(FAR) * 2 * (1 - NU**2) / (np.pi * E * THICKNESS)  # any: F is scaled
    of_hats, of_mesh = (
        reactions / reactions.sum()
        for reactions in (
            np.linalg.solve(C, np.ones(PATCHES)) for C in (flamant(PATCHES) + far, found[1])
        )
    )
    np.testing.assert_allclose(of_hats, punch, rtol=0.065)
    np.testing.assert_allclose(of_mesh, of_hats, rtol=6e-3)


def test_block_pressed_evenly_shortens_everywhere_alike(box, coarse_blade):
    """Held all around but along the pressure: p H / (lambda + 2 mu), which P2 holds.

    Kinks of the hats are between facets here; amid them the quadrature misses 6e-5 (14 cells).
    """
    n, height, width, length = 6, 0.3, 0.1, 0.8
    solid = box([3, 2, 15], [height, width, length], hub=HUB)

    def sideways(X):
        return np.broadcast_to([False, True, True], X.shape)

    blade = given(coarse_blade, interface={"patches": n, "across": 1})
    interface = interface_of(solid, blade)
    p = 1e6  # Pa
    spacing = length / (n - 1)
    forces = p * width * spacing * np.r_[0.5, np.ones(n - 2), 0.5]  # int phi_i p dA
    lame, mu = solid.lame()
    c = compliance(solid, interface, sideways) @ forces
    # e_r is not quite x at this radius: width^2 / 8 / HUB^2
    np.testing.assert_allclose(c, p * height / (lame + 2 * mu), rtol=1e-8)
