"""Strain gauges: closed forms, the fields of the whole blade, axes of files, places refused."""

from types import SimpleNamespace as Made

import numpy as np
import pytest
from refused import refused

from fem.fields import TENSOR, gauge_rows, grid, linearised, stress
from geometry.base import SettingsError
from geometry.blade import Frame, SourceFile
from geometry.frame import axes
from rom.polynomial import evaluate, interpolate
from rom.reconstruct import Basis

OURS = np.eye(3)  # axes of a file in the frame of the blade, m
SIZE = np.array([1.0, 0.05, 0.1])  # of the bar


@pytest.fixture(scope="module")
def bar(box):
    return box([20, 2, 2], SIZE)


def gauge(at, direction=(1.0, 0.0, 0.0), length_mm=2.0):
    return Made(name="mid", at=at, direction=direction, length_mm=length_mm)


def read(solid, displaced, of, angle=0.0, A=OURS):
    """Strain and stress that a grid reads of displacements (nodes, 3), small ones."""
    weights, components = grid(solid, A, of, angle)
    found = stress(solid, displaced.ravel()[solid.free], "linear")
    return [weights @ of[:, *TENSOR] @ components for of in (found.strain, found.stress)]


def test_a_bar_in_tension_is_read_along_and_across(bar):
    """Clamped without its Poisson's contraction: away from the clamp u = eps (x, 0, 0) is exact."""
    points, eps, material = bar.V.tabulate_dof_coordinates(), 1e-4, bar.material
    stretched = eps * points * [1, 0, 0]
    lam, mu = bar.lame()
    along, across = (read(bar, stretched, gauge((0.5, 0.025, 0.01)), of) for of in (0, 90))
    assert along == pytest.approx([eps, (lam + 2 * mu) * eps], rel=1e-10)
    assert across == pytest.approx([0, lam * eps], rel=1e-10, abs=1e-14)
    assert material.young_modulus < along[1] / eps  # no free contraction


def test_a_cantilever_in_pure_bending_is_read_by_its_height(bar):
    """u = kappa (x y, -x^2 / 2, 0): eps_xx = kappa y, linear between the faces."""
    x, y, _ = bar.V.tabulate_dof_coordinates().T
    bent = 0.02 * np.column_stack([x * y, -(x**2) / 2, 0 * x])
    for height in (0.025, -0.025):
        strain, _ = read(bar, bent, gauge((0.4, height, 0.02)))
        assert strain == pytest.approx(0.02 * height, rel=1e-10)
    on_the_side, _ = read(bar, bent, gauge((0.4, 0.0123, 0.05), length_mm=10.0))
    assert on_the_side == pytest.approx(0.02 * 0.0123, rel=1e-9)


def test_a_grid_averages_over_its_length(bar):
    """u_x = a x^2: eps_xx = 2 a x, whose mean along a slanted grid is that in its middle.

    The mean of x^2, exact on quadratic facets, has L^2 / 12 more, less the 25th part of that for
    five places.
    """
    x = bar.V.tabulate_dof_coordinates()[:, 0]
    of_x = np.column_stack([0.1 * x**2, 0 * x, 0 * x])
    strain, _ = read(bar, of_x, gauge((0.433, 0.025, 0.011), (1.0, 0.0, 0.5), 20.0))
    assert strain == pytest.approx(0.2 * 0.433 * 1 / 1.25, rel=1e-10)
    for length in (1e-3, 0.05):
        weights, _ = grid(bar, OURS, gauge((0.5, 0.025, 0.02), length_mm=1e3 * length), 0.0)
        assert weights.sum() == pytest.approx(1, rel=1e-13)
        assert weights @ x**2 - 0.25 == pytest.approx(length**2 / 12 * 24 / 25, rel=1e-9)


@pytest.mark.parametrize("angle", [0, 45, 90, 30])
def test_a_rosette_reads_the_tensor(bar, angle):
    """Any homogeneous strain on the face z = h/2, seen from outside: x right, y up."""
    H = np.array([[3.0, 1.0, 0.4], [-0.2, -2.0, 0.7], [0.1, 0.3, 1.0]]) * 1e-4
    moved = bar.V.tabulate_dof_coordinates() @ H.T
    moved[np.setdiff1d(np.arange(len(moved)), bar.free[::3] // 3)] = 0
    e = np.array([np.cos(np.radians(angle)), np.sin(np.radians(angle)), 0])
    eps = (H + H.T) / 2
    lam, mu = bar.lame()
    sigma = lam * np.trace(eps) * np.eye(3) + 2 * mu * eps
    found = read(bar, moved, gauge((0.5, 0.003, 0.05), (1, 0, 0.3)), angle)
    assert found == pytest.approx([e @ eps @ e, e @ sigma @ e], rel=1e-9)


@pytest.mark.parametrize(
    ("frame", "unit"),
    [
        (Frame(downstream="x", radial="z"), "mm"),
        (Frame(downstream="-y", radial="x", rotation="left-handed"), "in"),
    ],
)
def test_a_place_is_given_in_the_axes_of_the_file(bar, frame, unit):
    """The same gauge in both; in a file that is mirrored 45 deg are on the other side for us."""
    A = axes(SourceFile(file="mesh.inp", unit=unit, frame=frame))
    at, direction = np.array([0.4, 0.025, 0.02]), np.array([1.0, 0.2, 0.5])
    there = gauge(np.linalg.solve(A, at), np.linalg.solve(A, direction))
    mirrored = frame.rotation == "left-handed"
    for angle in (0, 45):
        own = grid(bar, OURS, gauge(at, direction), -angle if mirrored else angle)
        for found, expected in zip(grid(bar, A, there, angle), own, strict=True):
            np.testing.assert_allclose(found, expected, rtol=0, atol=1e-12)


@pytest.mark.parametrize(
    ("at", "direction", "why"),
    [
        ((0.5, 0.0265, 0.0), (1, 0, 0), "1.5 mm from the surface; allowed 1 mm"),
        ((0.5, 0.025, 0.0), (0.1, 1, 0), "across the surface"),
        ((0.5, 0.025, 0.0), (0, 0, 0), "across the surface"),
        ((0.04, 0.025, 0.0), (1, 0, 0), "nearer to clamp or tip than 5% of the blade's length"),
        ((0.9505, 0.025, 0.0), (1, 0, 0), "nearer to clamp or tip"),  # by half of its length
        ((1.0, 0.0, 0.0), (0, 1, 0), "nearer to clamp or tip"),
    ],
)
def test_places_and_directions_that_cannot_be_are_refused(bar, at, direction, why):
    error = refused(SettingsError, grid, bar, OURS, gauge(at, direction), 0.0)
    assert error.key == "record.gauges" and "'mid'" in str(error) and why in str(error)


@pytest.mark.parametrize(("z", "inside"), [(0.048, True), (0.0498, False)])
def test_a_grid_that_hangs_over_an_edge_is_refused(bar, z, inside):
    """Of 2 mm, across the edge at z = 50 mm."""
    given = gauge((0.5, 0.025, z), (0, 0, 1))
    if inside:
        assert grid(bar, OURS, given, 0.0)[0].sum() == pytest.approx(1, rel=1e-12)
    else:
        error = refused(SettingsError, grid, bar, OURS, given, 0.0)
        assert "length_mm 2: its grid leaves the surface" in str(error)


@pytest.fixture(scope="module")
def on_blade(coarse_blade, coarse_mesh, coarse_matrices, coarse_reduced, solid):
    """Rows of three gauges on the coarse blade, and what they are made of."""
    rom, T = coarse_reduced
    basis = Basis.of(coarse_matrices, T, rom.provenance)
    points = solid.V.tabulate_dof_coordinates()
    grids = []
    for radius in (0.45, 0.49, 0.53):
        near = points[(abs(np.hypot(*points.T[:2]) - radius) < 0.01) & (abs(points[:, 2]) < 0.01)]
        at = near[near[:, 1].argmax()]
        grids.append((gauge(1e3 * at, (1.0, 0.1, 0.2)), 45.0 * len(grids)))
    statics = [basis.static(Omega) for Omega in rom.speeds]
    made = coarse_blade, coarse_mesh.mesh, basis.coordinates, grids
    return Made(
        grids=grids,
        basis=basis,
        rows=interpolate(gauge_rows(*made, statics, basis.T), rom.speeds),
        placed=[grid(solid, 1e-3 * OURS, *of) for of in grids],
    )


def of_fields(placed, field):
    """Readings (..., grids) of a field (..., nodes, 6)."""
    return np.stack([field @ components @ weights for weights, components in placed], axis=-1)


@pytest.mark.parametrize("Omega", [0.0, 431.0, 640.0])
def test_rows_are_derivatives_of_the_fields_about_the_deflection(on_blade, solid, Omega):
    """Between the speeds of the basis, by fields of all nodes. Measured, of the largest: 1.5e-9.

    The static part, of higher degree in Omega than its polynomial: 7.8e-5.
    """
    static = on_blade.basis.static(Omega)
    whole = stress(solid, static, "nonlinear")
    moving = linearised(solid, static, on_blade.basis.T.T, "nonlinear")
    rows = evaluate(on_blade.rows, Omega)
    for found, own, of in zip(rows, (whole.strain, whole.stress), moving, strict=True):
        at_rest = of_fields(on_blade.placed, own[:, *TENSOR])
        np.testing.assert_allclose(found[:, 0], at_rest, rtol=0, atol=1e-4 * abs(at_rest).max())
        expected = of_fields(on_blade.placed, of[1:]).T
        error = abs(found[:, 1:] - expected).max()
        assert error <= 1e-6 * abs(expected).max() and abs(expected).max() > 0


def test_departure_of_the_nonlinear_field_in_a_rub(on_blade, coarse_rom, solid):
    """Mode 1 with 0.3 mm at the tip, as in a hard rub: fem/README.md has the numbers.

    Over the largest of the vibration, of three grids: it grows with the amplitude, by half of the
    square of the slopes, which bending without its shortening strains.
    """
    u = coarse_rom.modes(600.0)[1][:, 0]
    u *= 0.3e-3 / abs(on_blade.basis.T @ u).max()
    static, rows = on_blade.basis.static(600.0), evaluate(on_blade.rows, 600.0)

    def departures(u):
        whole = stress(solid, static + on_blade.basis.T @ u, "nonlinear")
        fields = [of_fields(on_blade.placed, of[:, *TENSOR]) for of in (whole.strain, whole.stress)]
        moving = rows[..., 1:] @ u
        off = abs(np.array(fields) - rows[..., 0] - moving)
        return off.max(axis=1) / abs(moving).max(axis=1)

    assert departures(u) == pytest.approx([0.039, 0.148], rel=0.05)
    assert departures(u / 2) == pytest.approx(departures(u) / 2, rel=0.05)
