"""Figures of the set-up: blade, footprint, laws and casing (Figs. 2, 4, 5, 6)."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr
from made_sweeps import CAMBER, GAP, ROOT, attrs_of, made_rom
from matplotlib.quiver import Quiver
from refused import refused
from scipy.spatial import cKDTree

from geometry.hats import hat_nodes
from geometry.interface import tip_of
from geometry.readers import read_mesh_file
from geometry.tip import cartesian
from simulate.scene import Contact, Harmonic, Profile, Scene
from simulate.sweeps.dataset import save as save_sweep
from workflow.figures import rendering
from workflow.jobs.figure import read
from workflow.paper.figures import blade as blade_and_patches, compared, footprint
from workflow.paper.figures.footprint import FootprintError, at_deepest, into_fresh

PATCHES = 8


@pytest.fixture(scope="module")
def paper():
    return Scene.load(ROOT / "workflow/scenes/hand-e1.yaml")


@pytest.fixture(scope="module")
def blade_files(coarse_mesh):
    """A mesh, and a reduced model with as many DoFs as patches."""
    M = np.eye(PATCHES)
    K = (2 * np.pi * made_rom().f1) ** 2 * M[None]
    rom = replace(made_rom(), xi=hat_nodes(PATCHES), M=M, K=K)
    return rendering.read_mesh(coarse_mesh.mesh), rom


@pytest.fixture(scope="module")
def tip(blade_files):
    mesh, _ = blade_files
    return tip_of(blade_and_patches.facets_of(mesh), mesh.points)


@pytest.fixture(scope="module")
def blade_panels(blade_files):
    return blade_and_patches.draw(*blade_files).axes


def test_pixels_of_points_agree_with_the_picture(blade_files):
    """The outermost points of the surface bound the picture, up to the outline 4 pixels wide."""
    look = blade_and_patches.PAINT, (0, 1), blade_and_patches.LIGHT
    solid = rendering.solid(blade_files[0])
    zeros = np.zeros(solid.n_points)
    image = rendering.picture(solid, 0, zeros, blade_and_patches.VIEW, *look)
    rows, columns = rendering.window([image])
    pixels = rendering.pixels(solid, blade_and_patches.VIEW, solid.points)
    low, high = pixels.min(axis=0), pixels.max(axis=0)
    np.testing.assert_allclose(low, [columns.start, rows.start], atol=3)
    np.testing.assert_allclose(high, [columns.stop - 1, rows.stop - 1], atol=3)


def chord_fractions(tip, z, arc):
    """Chord fractions of points of the unrolled tip, mm."""
    radius = np.full_like(z, tip.radius)
    return tip.xi(cartesian(np.column_stack([radius, 1e-3 * arc / radius, 1e-3 * z])))


def test_the_tip_is_drawn_by_its_facets(coarse_mesh, blade_files, tip):
    """All of the mesh's group, on the tip's cylinder with the middles of their edges."""
    mesh, _ = blade_files
    drawn, group = blade_and_patches.facets_of(mesh), read_mesh_file(coarse_mesh.mesh).face_groups
    facets = {tuple(sorted(facet[:3])) for facet in drawn.tolist()}
    assert facets == {tuple(sorted(face)) for face in group["tip"].tolist()}
    radii = np.hypot(*mesh.points[drawn, :2].reshape(-1, 2).T)
    np.testing.assert_allclose(radii, tip.radius, rtol=1e-4)


def test_nodes_of_the_patches_lie_on_the_camber_line(tip, blade_panels):
    """As many as the reduced model has; leading edge upstream and ahead in rotation, upwards."""
    nodes = next(line for line in blade_panels[1].lines if line.get_marker() == ".")
    z, arc = nodes.get_data()
    np.testing.assert_allclose(chord_fractions(tip, z, arc), hat_nodes(PATCHES), atol=2e-3)
    line = tip.camber_line()
    np.testing.assert_allclose(arc[[0, -1]], 1e3 * tip.radius * line[[0, -1], 1])
    assert z[0] < z[-1] and arc[0] > arc[-1]


def test_the_leading_eighth_and_the_place_of_displacement_are_marked(tip, blade_panels):
    """The eighth between the sides of the tip, the place in its middle on the camber line."""
    _, unrolled, over_chord = blade_panels
    eighth = unrolled.patches[0].get_xy()[:-1]
    xi = chord_fractions(tip, *eighth.T)
    assert [xi.min(), xi.max()] == pytest.approx([blade_and_patches.SLIVER, 1 / 8], abs=1e-3)
    _, theta, z = tip.outline.T
    outline = 1e3 * np.column_stack([z, tip.radius * theta])  # mm
    sides = np.linspace(outline, np.roll(outline, -1, axis=0), 500).reshape(-1, 2)
    assert cKDTree(sides).query(eighth)[0].max() < 0.02
    place = next(line for line in unrolled.lines if line.get_marker() == "o")
    assert chord_fractions(tip, *place.get_data()) == pytest.approx(1 / 16, abs=1e-3)
    (band,) = over_chord.patches
    assert (band.get_x(), band.get_width()) == (0, 1 / 8)


SPEEDS = np.array([0.3, 0.32, 0.34, 0.36, 0.38])
PEAK, DEEPEST, WORN = 2, 1949, 0.8  # of SPEEDS; rod; gaps
RADIUS, RODS = CAMBER[0, 0], 2039
STRIPS = 16  # of hand-e1
PITCH = 2 * np.pi * RADIUS / RODS
HARDENING, E, K = 0.45 / 1.45, 8e9, 3.6e9  # of hand-e1: K / (E + K), Pa, Pa


@pytest.fixture(scope="module")
def footprint_files(paper, tmp_path_factory):
    """The leading strip is worn deepest at one rod, others deeper; f1 crosses eo(4) at 0.31."""
    folder = tmp_path_factory.mktemp("footprint")
    made_rom().save(folder / "rom.nc")
    spectrum = np.full((len(SPEEDS), 201), 1e-3 * GAP)
    spectrum[PEAK, 40] = GAP
    lobe = np.cos((np.arange(RODS) - DEEPEST) * np.pi / RODS) ** 16
    wear = 5 * GAP * np.ones((len(SPEEDS), STRIPS, RODS))
    wear[PEAK, 0] = WORN * GAP * lobe
    swept = xr.Dataset(
        {
            "status": ("speed_over_f1", ["ok"] * len(SPEEDS)),
            "spectrum": (("speed_over_f1", "engine_order"), spectrum),
            "wear": (("speed_over_f1", "strip", "theta"), wear),
        },
        coords={
            "speed": ("speed_over_f1", SPEEDS * 2 * np.pi * 100),
            "speed_over_f1": ("speed_over_f1", SPEEDS),
            "end": ("strip_end", np.linspace(0, 1, STRIPS + 1)),
        },
    )
    tilt = Contact(profile=Profile(tilt=0.01), tangential=True)
    tilted = paper.model_copy(update={"contact": tilt})
    for name, scene in {"sweep": paper, "tilted": tilted}.items():
        save_sweep(swept.assign_attrs(attrs_of(scene)), folder / f"{name}.nc")
    return SimpleNamespace(**{name: folder / f"{name}.nc" for name in ("rom", "sweep", "tilted")})


@pytest.fixture(scope="module")
def footprints(footprint_files):
    sweep, tilted = read(footprint, footprint_files)
    return at_deepest(sweep), into_fresh(tilted)


@pytest.fixture(scope="module")
def footprint_panels(footprint_files):
    return footprint.draw(*read(footprint, footprint_files)).axes


def pushes(axes):
    """Forces of the rods, as drawn: (n, 2)."""
    (arrows,) = (of for of in axes.collections if isinstance(of, Quiver))
    return np.column_stack([arrows.U, arrows.V])


def test_the_tip_is_at_the_penetration_of_the_law_over_the_deepest_rod(paper, footprints):
    """A new rod at strain eps: eps_p = eps E / (E + K), sigma = K eps_p, and sigma_Y's strain."""
    flat, _ = footprints
    depth = WORN * np.cos(flat.rods.s / RADIUS / 2) ** 16
    np.testing.assert_allclose(flat.rods.worn - flat.rods.unworn, depth, rtol=1e-6)
    d = paper.casing.inward(np.array([2 * np.pi * DEEPEST / RODS]), GAP)[0] / GAP
    (deepest,) = flat.rods[flat.rods.s == 0].itertuples()
    assert deepest.unworn == pytest.approx(-d)
    assert np.interp(0, *flat.tip) == pytest.approx(-d + 1.45 * WORN + 1e-8 * 5e-3 / GAP, rel=1e-7)
    # gaps 1.5 at xi = 1/16 and 4.3 at 15/16, linear: amid the foremost strip less than g
    assert flat.rest == pytest.approx(-(1 - (4.3 / 1.5 - 1) / 28))
    sigma = K * WORN * GAP / paper.liner.thickness_m
    assert deepest.sigma == pytest.approx(sigma, rel=1e-4)


def test_rods_at_the_ends_are_loaded_over_their_covered_part(footprints, footprint_panels):
    """Three rods and what is left of 5 mm, alike at both ends; to scale, in mm."""
    hatched = [bar for bar in footprint_panels[0].patches if bar.get_hatch() == "/////"]
    left, bottom, right, _ = np.array(sorted(tuple(bar.get_bbox().extents) for bar in hatched)).T
    end = (5 - 3e3 * PITCH) / 2
    np.testing.assert_allclose(right - left, [end, *[1e3 * PITCH] * 3, end])
    np.testing.assert_allclose(left[1:], right[:-1])
    np.testing.assert_allclose(bottom, np.interp(0, *footprints[0].tip))  # pressed to the flat tip


def test_forces_of_rods_are_along_the_normal_of_the_drawn_profile(footprint_panels):
    """Inward; flat: radially; tilted, its trailing side ahead: also against the rotation.

    Flat, all five rods bear; tilted by 2.4 gaps and pressed by one, those of its trailing side.
    """
    for axes, leans, rods in zip(footprint_panels, (False, True), (5, 2), strict=True):
        to_mm, force = np.array([1, axes.get_aspect()]), pushes(axes)  # as drawn
        assert len(force) == rods and np.all(force[:, 1] < 0)
        assert np.all(force[:, 0] < 0) if leans else np.all(force[:, 0] == 0)
        edge = np.array([axes.patches[-1].get_xy()[i] for i in (150, 50)])
        along = (edge[0] - edge[1]) * to_mm if leans else np.array([1, 0])
        cosine = force @ along / np.linalg.norm(force, axis=1) / np.linalg.norm(along)
        np.testing.assert_allclose(cosine, 0, atol=1e-12)


def test_the_profiled_tip_has_the_scenes_profile(footprints, footprint_panels):
    """p falls by 0.01 per arc; p'(s) is the ratio of tangential to normal force."""
    _, tilted = footprints
    inner = slice(20, -20)
    np.testing.assert_allclose(np.gradient(tilted.tip[1, inner], tilted.tip[0, inner]), -0.01 / GAP)
    np.testing.assert_allclose(tilted.rods.slope, 0.01)
    rods = tilted.rods
    delta = np.where(rods.part > 0, rods.end * GAP, 0)
    np.testing.assert_allclose(rods.sigma, E * HARDENING * delta / 5e-3, rtol=1e-3)
    force = rods.part * rods.sigma
    lengths = np.hypot(*pushes(footprint_panels[1]).T)
    np.testing.assert_allclose(lengths / lengths.max(), force[force > 0] / force.max())


def test_sweeps_without_a_footprint_are_refused_with_the_remedy(footprint_files):
    flat, _ = read(footprint, footprint_files)
    fresh = replace(flat, sweep=flat.sweep.assign(wear=0 * flat.sweep["wear"]))
    refused(FootprintError, at_deepest, fresh, match="no worn liner")
    refused(FootprintError, into_fresh, flat, match="its tip is flat")


@pytest.fixture(scope="module")
def shapes(paper, tmp_path_factory):
    """Two diameters, and with a fifth harmonic of half a gap."""
    fifth = Harmonic(order=5, amplitude_m=GAP / 2 / paper.casing.scale)
    casing = paper.casing.model_copy(update={"harmonics": [*paper.casing.harmonics, fifth]})
    scenes = {"two": paper, "two_five": paper.model_copy(update={"casing": casing})}
    folder = tmp_path_factory.mktemp("casing")
    for name, scene in scenes.items():
        status = {"status": ("speed_over_f1", ["ok"])}
        run = xr.Dataset(status, {"speed_over_f1": [0.3]}, attrs_of(scene))
        save_sweep(run, folder / f"{name}.nc")
    files = SimpleNamespace(**{name: folder / f"{name}.nc" for name in scenes})
    return read(compared, files, "shapes")
