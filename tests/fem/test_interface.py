"""The operator S of the tip's interface: fields for which it is exact, and its nodal loads."""

import numpy as np
import pytest
from blades import given

import ufl
from dolfinx import fem
from dolfinx.mesh import locate_entities_boundary, meshtags

from fem.interface_operator import interface_of
from geometry.hats import hat_nodes, hats, middles
from geometry.interface import tip_of
from geometry.profile import profile_at

R = 0.5624


@pytest.fixture(scope="module")
def interface(solid, coarse_blade):
    return interface_of(solid, coarse_blade)


@pytest.fixture(scope="module")
def tip(solid):
    return tip_of(solid.tip, solid.V.tabulate_dof_coordinates())


def outward(points):
    """e_r (n, 3)."""
    x, y, z = points.T
    return np.column_stack([x, y, 0 * z]) / np.hypot(x, y)[:, None]


def ahead(points):
    """e_theta (n, 3)."""
    return outward(points)[:, [1, 0, 2]] * [-1, 1, 1]


def axial(points):
    return np.broadcast_to([0.0, 0.0, 1.0], points.shape)


DIRECTIONS = [outward, ahead, axial]


CONSTANT = 5e-8  # measured 2.2e-8, of e_r and e_theta; e_z is exact
LINEAR = 3e-7  # measured 1.5e-7


@pytest.mark.parametrize("direction", range(3))
@pytest.mark.parametrize(("slope", "error"), [(0, CONSTANT), (2, LINEAR)])
def test_constant_and_linear_fields_along_the_chord_are_kept(
    solid, interface, tip, direction, slope, error
):
    """To the error of their interpolation: P2 holds neither e_r nor xi over a curved facet."""
    X = solid.free_coordinates()
    u = (3 + slope * tip.xi(X))[:, None] * DIRECTIONS[direction](X)
    expected = np.zeros((len(interface.xi), 3))
    expected[:, direction] = 3 + slope * interface.xi
    c = (interface.S @ u.ravel()).reshape(-1, 3)
    np.testing.assert_allclose(c, expected, rtol=0, atol=3 * error)


def test_turn_about_the_axis_is_tangential_and_the_radius(solid, interface):
    """u = e_z x X is in the space of curved cells; they sag off the cylinder by 1.1e-8 m."""
    x, y, _ = solid.free_coordinates().T
    c = interface.S @ np.column_stack([-y, x, 0 * x]).ravel()
    expected = np.zeros((len(interface.xi), 3))
    expected[:, 1] = R
    np.testing.assert_allclose(c.reshape(-1, 3), expected, rtol=0, atol=2e-8)


def test_rigid_displacement_along_x_is_radial_by_the_cosine_of_the_angle(
    solid, interface, coarse_blade
):
    """Amid strips, against the camber line; hats cut the bend of its angle, rise / R / (n - 1)^2.

    Measured 3.0e-5 of these 6.5e-5.
    """
    u = np.zeros((len(solid.free) // 3, 3))
    u[:, 0] = 1.0
    c = (interface.S @ u.ravel()).reshape(-1, 3)
    xi, line = middles(16), interface.camber
    theta = np.interp(xi, np.linspace(0, 1, len(line)), line[:, 1])
    expected = np.column_stack([np.cos(theta), -np.sin(theta), 0 * theta])
    profile = profile_at(coarse_blade.sections, R)
    bend = profile.camber / R / (len(interface.xi) - 1) ** 2
    np.testing.assert_allclose(hats(xi, interface.xi) @ c, expected, rtol=0, atol=0.6 * bend)


def test_operator_is_that_of_the_forms_of_dolfinx(solid, interface, tip):
    """B and G by UFL on the facets at the tip's radius; hats and directions written anew."""
    x = ufl.SpatialCoordinate(solid.mesh)
    r = ufl.sqrt(x[0] ** 2 + x[1] ** 2)
    s = tip.radius * (ufl.atan2(x[1], x[0]) - tip.theta)
    xi = (s * tip.chord[0] + x[2] * tip.chord[1] - tip.low) / (tip.high - tip.low)
    n = len(interface.xi)
    phi = [ufl.max_value(0, 1 - abs((n - 1) * xi - i)) for i in range(n)]
    facets = locate_entities_boundary(solid.mesh, 2, lambda x: np.hypot(x[0], x[1]) > R - 1e-6)
    tags = meshtags(solid.mesh, 2, np.sort(facets), np.ones(len(facets), dtype=np.int32))
    ds = ufl.ds(1, domain=solid.mesh, subdomain_data=tags, metadata={"quadrature_degree": 24})
    v = ufl.TestFunction(solid.V)
    e = [
        ufl.as_vector([x[0] / r, x[1] / r, 0]),
        ufl.as_vector([-x[1] / r, x[0] / r, 0]),
        ufl.as_vector([0, 0, 1.0]),
    ]

    def assembled(form):
        return fem.assemble_vector(fem.form(form)).array[solid.free]

    G = np.array([[fem.assemble_scalar(fem.form(a * b * ds)) for b in phi] for a in phi])
    for d, direction in enumerate(e):
        B = np.array([assembled(a * ufl.inner(direction, v) * ds) for a in phi])
        S = np.linalg.solve(G, B)
        found = interface.S[d::3].toarray()
        # the same quadrature: round-off, measured 8e-15
        np.testing.assert_allclose(found, S, rtol=0, atol=1e-12 * abs(S).max())


def test_work_of_forces_and_their_resultants_are_those_of_the_nodal_loads(solid, interface, tip):
    """Virtual work; as S keeps constants and linear fields, force and moment along the chord."""
    rng = np.random.default_rng(5)
    F = rng.normal(size=(len(interface.xi), 3))
    loads = interface.S.T @ F.ravel()
    u = rng.normal(size=len(loads))
    assert loads @ u == pytest.approx(F.ravel() @ (interface.S @ u), rel=1e-12)
    X, of_node = solid.free_coordinates(), loads.reshape(-1, 3)
    whole = abs(F).sum()
    for d, direction in enumerate(DIRECTIONS):
        along = (of_node * direction(X)).sum(axis=1)  # e of the node
        assert along.sum() == pytest.approx(F[:, d].sum(), abs=CONSTANT * whole)
        assert along @ tip.xi(X) == pytest.approx(F[:, d] @ interface.xi, abs=LINEAR * whole)


def test_loads_are_on_the_tip_alone(solid, interface):
    nodes = np.unique(interface.S.nonzero()[1] // 3)
    X = solid.free_coordinates()[nodes]
    np.testing.assert_allclose(np.hypot(X[:, 0], X[:, 1]), R, atol=1e-8)
    assert len(nodes) == len(np.unique(solid.tip))


def test_patches_have_their_places(interface, tip):
    np.testing.assert_array_equal(interface.xi, hat_nodes(8))
    assert interface.points.shape == (0, 3)
    np.testing.assert_array_equal(interface.camber, tip.camber_line())


def of_points(blade, points):
    rule = {"points_mm": (1e3 * np.array(points)).tolist()}
    return given(blade, interface=rule, basis={"kind": "paper"})


@pytest.mark.parametrize("picked", [[0, 5], [11, 30, 2]])
def test_point_on_a_node_is_a_selection_of_it_turned(solid, coarse_blade, picked):
    """Corners and middles of edges; points are told in mm, whose digits are those of a float."""
    nodes = np.unique(solid.tip)[picked]
    X = solid.V.tabulate_dof_coordinates()[nodes]
    order = np.argsort(X[:, 2])
    nodes, X = nodes[order], X[order]
    found = interface_of(solid, of_points(coarse_blade, X))
    u = np.random.default_rng(2).normal(size=(solid.V.dofmap.index_map.size_local, 3))
    expected = np.einsum("dpc,pc->pd", [e(X) for e in DIRECTIONS], u[nodes])
    c = (found.S @ u.ravel()[solid.free]).reshape(-1, 3)
    np.testing.assert_allclose(c, expected, rtol=0, atol=1e-9)
    np.testing.assert_allclose(found.points[:, 0], R, atol=1e-8)
    np.testing.assert_allclose(found.points[:, 2], X[:, 2], atol=1e-12)


def test_points_keep_quadratic_fields(box, coarse_blade):
    """On plane facets, where P2 holds them: one point in the midst of a facet, one on its side."""
    solid = box([1, 2, 3], [0.1, 0.2, 0.4], hub=0.5)
    at = np.array([[0.6, 0.013, -0.11], [0.6, -0.1, 0.05], [0.6, 0.071, 0.17]])

    def field(X):
        x, y, z = X.T
        return np.column_stack([1 + y * z - z**2, 2 * y - y**2, x * z + 3])

    found = interface_of(solid, of_points(coarse_blade, at))
    r, theta, z = found.points.T
    np.testing.assert_allclose(found.points[:, 2], at[:, 2], atol=1e-12)
    # a place is looked for in the developed tip, which is not plane: measured 0.04 mm of 200
    here = np.column_stack([r * np.cos(theta), r * np.sin(theta), z])
    np.testing.assert_allclose(here, at, atol=5e-5)
    expected = np.einsum("dpc,pc->pd", [e(here) for e in DIRECTIONS], field(here))
    c = (found.S @ field(solid.free_coordinates()).ravel()).reshape(-1, 3)
    np.testing.assert_allclose(c, expected, rtol=0, atol=1e-12)


@pytest.mark.parametrize("direction", range(3))
def test_two_rows_are_the_displacements_of_both_edges(solid, coarse_blade, tip, direction):
    """A field linear in the angle; each edge errs by 2 % of the thickness, as hats cut its bend."""
    of = interface_of(solid, coarse_blade.but(interface={"patches": 8, "across": 2}))
    X = solid.free_coordinates()
    constant = (of.S @ DIRECTIONS[direction](X).ravel()).reshape(2, 8, 3)
    expected = np.zeros((2, 8, 3))
    expected[..., direction] = 1
    np.testing.assert_allclose(constant, expected, rtol=0, atol=4 * CONSTANT)
    theta = np.arctan2(X[:, 1], X[:, 0])
    c = of.S @ (theta[:, None] * DIRECTIONS[direction](X)).ravel()
    xi = np.linspace(0.1, 0.9, 17)
    edges = c.reshape(2, 8, 3)[..., direction] @ hats(xi, of.xi).T
    sides = tip.at_z(np.interp(xi, np.linspace(0, 1, len(of.camber)), of.camber[:, 2]))
    thickest = np.diff(sides, axis=0).max()
    np.testing.assert_allclose(edges, sides, rtol=0, atol=0.02 * thickest)
    np.testing.assert_allclose(of.sides, tip.at_z(of.camber[:, 2]), rtol=0, atol=0)
