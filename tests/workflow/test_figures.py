"""Contents of the figures for small prescribed data."""

import dataclasses
import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import matplotlib as mpl
import meshio
import numpy as np
import pytest
import xarray as xr
import yaml
from made_sweeps import ENDS, GAP, PROVENANCE, STIFFENING, attrs_of, by_strip, made_rom
from matplotlib.figure import Figure
from PIL import Image
from refused import refused

from geometry.blade import Blade
from geometry.files import write_json
from geometry.profile import profile_at
from geometry.provenance import ProvenanceError
from geometry.seal import seal
from geometry.settings import read_settings
from rom.check import RomCheck
from rom.full_model import CODE as CODE_OF_FULL
from rom.full_model import FullModel
from simulate.dataset import save as save_sweep
from simulate.peak import along_order, crossing
from simulate.scene import Scene
from workflow.figures import (
    fig03_campbell,
    fig09_modes,
    fig10_spectra,
    fig11_wear,
    fig12_profiles,
    loads,
    stress,
    style,
    summary,
    views,
)
from workflow.figures.marks import engine_order
from workflow.figures.origins import origins
from workflow.figures.response import Response
from workflow.paper.measure import coating

ROOT = Path(__file__).parents[2]
CROSSING_4 = 1 / np.sqrt(16 - STIFFENING)  # f1^2 = 1 + 5.6 Omega^2 meets k^2 Omega^2
SPEEDS = np.round(np.arange(0.02, 0.401, 0.01), 12)
FAILED = 25  # of SPEEDS: 0.27
SENSITIVE = [31, 32, 34]  # of SPEEDS: 0.33, 0.34 (the peak of eo(4)) and 0.36
PEAK_4, PEAK_6 = 0.34, 0.2
RODS = 512


@pytest.fixture(scope="module")
def rom():
    return made_rom()


def resonance(speeds, at):
    return 1 / (1 + ((speeds - at) / 0.004) ** 2)


def worn(k):
    return np.maximum(0, np.cos(k * 2 * np.pi * np.arange(RODS) / RODS))


@pytest.fixture(scope="module")
def sweep():
    """Two resonances, along engine orders 4 and 6, and one failed run."""
    scene = read_settings(Scene, ROOT / "workflow/scenes/hand-e1.yaml")
    spectrum = np.full((len(SPEEDS), 201), 1e-3)
    spectrum[:, 20] = 0.5
    spectrum[:, 40] = 0.02 + 3 * resonance(SPEEDS, PEAK_4)
    spectrum[:, 60] = 0.02 + 2 * resonance(SPEEDS, PEAK_6)
    spectrum[FAILED] = np.nan
    status = np.full(len(SPEEDS), "ok", dtype="<U9")
    status[FAILED] = "unstable"
    wear = np.array([worn(2)] * len(SPEEDS))
    wear[SPEEDS == PEAK_4] = 3 * worn(4)
    wear[SPEEDS == PEAK_6] = 2 * worn(6)
    return xr.Dataset(
        {
            "status": ("speed_over_f1", status),
            "spectrum": (("speed_over_f1", "engine_order"), GAP * spectrum),
            "wear": (("speed_over_f1", "strip", "theta"), GAP * by_strip(wear)),
        },
        coords={
            "speed": ("speed_over_f1", SPEEDS * 2 * np.pi * 100),
            "speed_over_f1": ("speed_over_f1", SPEEDS),
            "end": ("strip_end", ENDS),
        },
        attrs=attrs_of(scene),
    )


@pytest.fixture(scope="module")
def seen(sweep, rom):
    return Response(sweep, rom)


def with_twins(sweep, rom, departure):
    """The sweep with departures (speeds,) of its twins, by observable."""
    apart = np.column_stack(list(departure.values()))
    status = sweep["status"].values.astype("<U20")
    status[(apart > 0.01).any(axis=1) & (status == "ok")] = "sensitive"
    variables = {
        "status": ("speed_over_f1", status),
        "departure": (("speed_over_f1", "observable"), apart),
    }
    return Response(sweep.assign(variables).assign_coords(observable=list(departure)), rom)


@pytest.fixture(scope="module")
def twinned(sweep, rom):
    """With twins that differ at ``SENSITIVE`` in the spectrum, at the last also in wear."""
    spectrum, wear, history = np.full((3, len(SPEEDS)), 1e-9)
    spectrum[SENSITIVE] = np.inf, 0.0101, 0.0101
    wear[SENSITIVE[-1]] = 0.0101
    for departure in (spectrum, wear, history):
        departure[FAILED] = np.inf
    return with_twins(sweep, rom, {"spectrum": spectrum, "wear": wear, "history": history})


@pytest.fixture(scope="module")
def check(rom):
    """The second mode is 0.75 % too low at 0.3."""
    speeds = np.linspace(0, rom.Omega_m, 5)
    reduced = np.array([rom.modes(speed)[0] for speed in speeds])
    error = np.zeros_like(reduced)
    error[3, 1] = -0.0075
    return RomCheck(
        speeds=speeds,
        full=reduced / (1 + error),
        reduced=reduced,
        xi=np.array([0.5]),
        compliance_error=np.zeros((5, 1, 1)),
        highest=1.0,
        between=np.nan,
        provenance=PROVENANCE,
    )


def texts(axes):
    return [text.get_text() for text in axes.texts]


def points(axes, marker):
    """Where ``axes`` shows ``marker``, (n, 2)."""
    lines = [line for line in axes.lines if line.get_marker() == marker]
    return np.concatenate([np.reshape(line.get_xydata(), (-1, 2)) for line in lines])


def marked(axes):
    """Spans of speed that are hatched, in order."""
    patches = [patch for patch in axes.patches if patch.get_hatch()]
    return sorted((patch.get_x(), patch.get_x() + patch.get_width()) for patch in patches)


def panels_of(drawn):
    return [axes for axes in drawn.axes if axes.get_label() != "<colorbar>"]


def legend_texts(drawn):
    legends = [*drawn.legends, *(axes.get_legend() for axes in drawn.axes if axes.get_legend())]
    return [text.get_text() for legend in legends for text in legend.get_texts()]


def test_a_sweep_in_the_figures_units(seen):
    np.testing.assert_allclose(seen.spectrum[0, 20], 0.5)
    np.testing.assert_allclose(seen.wear[SPEEDS == PEAK_4][0], 3 * worn(4), atol=1e-12)
    assert [(p.k, p.Omega_c) for p in seen.peaks] == [(4, PEAK_4), (6, PEAK_6)]
    assert seen.by_order[4].crossing == pytest.approx(CROSSING_4, abs=1e-8)


def test_runs_that_missed_their_accuracy_are_sensitive(sweep, rom):
    """Errors of runs that met it do not count."""
    status = sweep["status"].values.astype("<U20")
    status[3] = "sensitive"
    error = np.zeros((len(SPEEDS), 2))
    error[3:5, 1] = 0.1
    found = Response(
        sweep.assign(
            status=("speed_over_f1", status), error=(("speed_over_f1", "observable"), error)
        ).assign_coords(observable=["spectrum", "wear"]),
        rom,
    )
    assert found.sensitive("wear").nonzero()[0].tolist() == [3]
    assert not found.sensitive("spectrum").any() and not found.sensitive("history").any()


@pytest.mark.parametrize(
    ("law", "label"),
    [
        (
            {"kind": "plastic", "E": 10, "K": 4.55, "sigma_Y": 1e-8, "unit_Pa": 8e9},
            r"plastic, $E$ = 10, $K$ = 4.55, $\sigma_Y$ = 1e-08, unit 8 GPa",
        ),
        ({"kind": "elastic", "E": 10, "unit_Pa": 8e9}, "elastic, $E$ = 10, unit 8 GPa"),
        ({"kind": "none"}, "liner: none"),
    ],
)
def test_the_label_is_the_law_and_its_numbers(sweep, rom, law, label):
    scene = json.loads(sweep.attrs["scene"])
    scene["liner"]["law"] = law
    response = Response(sweep.assign_attrs(scene=json.dumps(scene)), rom)
    assert response.label == label
    assert response.title == f"scene paper-e1, blade reference: {label}"


def test_figure_summary_and_claim_name_the_same_peaks(sweep, rom, seen, check):
    marked = [(peak.k, peak.Omega_c, peak.amplitude) for peak in seen.peaks]
    told = summary.summarise(rom, check, {"mine": seen})["scenes"]["mine"]["peaks"]
    judged = coating(sweep, rom)["peaks"]
    assert [(p["k"], p["Omega_c"]) for p in told if p["seen"] == "peak"] == [p[:2] for p in marked]
    for k, Omega_c, amplitude in marked:
        claimed = judged[str(k)]
        assert (claimed["Omega_c"], claimed["amplitude"]) == (Omega_c, amplitude)
        assert claimed["clear"]


def test_campbell_marks_crossings_and_states_the_error(rom, check):
    first, every = fig03_campbell.draw(rom, check).axes
    crossings = points(first, "s")
    expected = [[1, k] / np.sqrt(k**2 - STIFFENING) for k in (4, 5, 6, 8)]
    np.testing.assert_allclose(crossings, expected, atol=1e-6)
    (error,) = (text for text in texts(every) if "error" in text)
    assert "3 modes, 5 speeds" in error and "-0.75 % (mode 2, " in error and "0.30" in error
    unit = 2 * np.pi * rom.f1
    np.testing.assert_allclose(points(every, "o")[:, 1], check.full.T.ravel() / unit)
    lines = [line.get_xydata() for line in every.lines if line.get_linestyle() == "-"]
    for line, at_rest in zip(lines, (1, 4, 4), strict=True):
        f = np.sqrt(at_rest**2 + STIFFENING * line[:, 0] ** 2)
        np.testing.assert_allclose(line[:, 1], f)


def test_operating_lines_have_the_nearest_critical_speed(rom, check, seen):
    """A line at its speed; its crossing is a tenth above. Second axes are in rpm, Hz and um."""
    at = crossing(rom, 4)
    lines = {"design": 60 * rom.f1 * at / 1.1}
    drawn = fig03_campbell.draw(rom, check, operating=lines)
    first, _ = drawn.axes
    green = [line for line in first.lines if line.get_color() == style.GREEN]
    assert [line.get_xdata()[0] for line in green] == pytest.approx([at / 1.1])
    rpm = f"{lines['design']:.0f} rpm"
    assert f"design {rpm}: nearest crossing, $k$ = 4, 10.0 % above" in legend_texts(drawn)
    speeds = next(axes for axes in first.child_axes if axes.get_xlabel() == "speed (rpm)")
    drawn.draw_without_rendering()
    np.testing.assert_allclose(speeds.get_xlim(), 60 * rom.f1 * np.array(first.get_xlim()))
    hertz = next(axes for axes in first.child_axes if axes.get_ylabel() == "frequency (Hz)")
    np.testing.assert_allclose(hertz.get_ylim(), rom.f1 * np.array(first.get_ylim()))
    of_peak = fig10_spectra.draw(seen, operating={"idle": 60 * rom.f1 * PEAK_6})
    assert any("nearest peak, $k$ = 6, 0.0 %" in text for text in legend_texts(of_peak))
    micro = next(axes for axes in of_peak.axes[1].child_axes if "µm" in axes.get_ylabel())
    of_peak.draw_without_rendering()
    np.testing.assert_allclose(micro.get_ylim(), 1e6 * GAP * np.array(of_peak.axes[1].get_ylim()))


def test_loads_are_those_of_the_sweep_and_its_peaks():
    """Two scenes; a panel for what any of them knows, in its unit, and the peaks with their ±."""
    peak = {"k": 4, "speed_over_f1": 0.33, "numbers": {"force": 40.0}, "errors": {"force": 2.0}}
    speeds = np.array([0.3, 0.35])
    lines = {"torque": np.array([0.1, 0.2]), "worn_volume": np.array([1e-8, 3e-8])}
    of = loads.Loads("one", speeds, lines, [peak], 10.0)
    bare = loads.Loads("two", speeds, {"torque": np.array([0.3, np.nan])}, [], 10.0)
    drawn = loads.draw([of, bare], 100.0, "mine")
    force, torque, volume = drawn.axes
    (bar,) = force.containers
    assert bar.lines[0].get_xydata().tolist() == [[0.33, 40.0]]
    assert [line.get_ydata().tolist()[0] for line in torque.lines] == [0.1, 0.3]
    np.testing.assert_allclose(volume.lines[0].get_ydata(), [10, 30])
    opening = next(axes for axes in volume.child_axes if "opening" in axes.get_ylabel())
    drawn.draw_without_rendering()  # 1 mm3 is 1e-9 m3, over 0.1 m2
    np.testing.assert_allclose(opening.get_ylim(), 0.01 * np.array(volume.get_ylim()))


def test_engine_orders_run_through_all_modes(rom, check):
    _, every = fig03_campbell.draw(rom, check).axes
    last = every.get_xlim()[1]
    ends = {line.get_ydata()[-1] / last for line in every.lines if line.get_linestyle() == "--"}
    assert sorted(ends) == pytest.approx([4, 8, 16, 32])


def test_a_label_stands_where_the_engine_order_leaves_the_axes():
    axes = Figure().subplots()
    axes.set(xlim=(0, 0.4), ylim=(0.5, 1.4))
    assert engine_order(axes, 8, "-").xy == pytest.approx((1.4 / 8, 1.4))
    assert engine_order(axes, 2, "-").xy == pytest.approx((0.4, 0.8))


def test_spectra_mark_peaks_where_they_are(seen):
    top, bottom, _ = fig10_spectra.draw(seen).axes
    rings = points(top, "o")
    np.testing.assert_allclose(rings, [[PEAK_4, 4 * PEAK_4], [PEAK_6, 6 * PEAK_6]])
    np.testing.assert_allclose(points(bottom, ".")[:, 1], [3.02, 2.02])
    assert texts(bottom) == ["$k$ = 4:  0.340", "$k$ = 6:  0.200"]
    f1 = next(line for line in top.lines if line.get_label() == r"$f_1(\Omega)$")
    np.testing.assert_allclose(f1.get_ydata(), np.sqrt(1 + STIFFENING * f1.get_xdata() ** 2))


def test_the_map_puts_an_order_on_its_line(seen):
    (mesh,) = (c for c in fig10_spectra.draw(seen).axes[0].collections)
    speed, bin_ = list(SPEEDS).index(PEAK_4), 40
    cell = 2 * speed  # the empty ones between speeds count
    corners = mesh.get_coordinates()[cell : cell + 2, bin_ : bin_ + 2].mean(axis=(0, 1))
    np.testing.assert_allclose(corners, [PEAK_4, 4 * PEAK_4])
    shown = mesh.get_array().reshape(2 * len(SPEEDS) - 1, -1)
    assert shown[cell, bin_] == pytest.approx(3.02)


def test_every_marked_peak_stands_on_a_curve(sweep, rom):
    """Also those of engine orders that are not drawn over all speeds."""
    spectrum = sweep["spectrum"].copy()
    spectrum[list(SPEEDS).index(0.17), 70] = 1.5 * GAP
    response = Response(sweep.assign(spectrum=spectrum), rom)
    assert 7 in [peak.k for peak in response.peaks]
    _, bottom, *_ = fig10_spectra.draw(response).axes
    curves = [line.get_xydata() for line in bottom.lines if line.get_marker() == "None"]
    for at in points(bottom, "."):
        assert any(np.isclose(curve, at).all(axis=1).any() for curve in curves)


@pytest.fixture(scope="module")
def responses(sweep, rom, seen, twinned):
    """By what some of their runs lack; one failed in all."""
    status = sweep["status"].values.astype("<U10")
    reason = np.full(len(SPEEDS), "", "<U30")
    status[3:5], reason[3:5] = "no-contact", "casing.scale: 0"
    of = {"status": ("speed_over_f1", status), "reason": ("speed_over_f1", reason)}
    agree = with_twins(sweep, rom, {"spectrum": np.full(len(SPEEDS), 0.0099)})
    untouched = Response(sweep.assign(of), rom)
    return {"nothing": seen, "twins": twinned, "no twins": agree, "contact": untouched}


@pytest.mark.parametrize(
    ("module", "lacks", "bands"),
    [
        (fig10_spectra, "nothing", []),
        (fig11_wear, "nothing", []),
        (fig10_spectra, "twins", [(0.325, 0.345), (0.355, 0.365)]),
        (fig11_wear, "twins", [(0.355, 0.365)]),
        (fig10_spectra, "no twins", []),
        (fig10_spectra, "contact", [(0.045, 0.065)]),
        (fig11_wear, "contact", [(0.045, 0.065)]),
    ],
)
def test_speeds_without_a_sure_result_are_marked(responses, module, lacks, bands):
    """Neighbours in one band, in each figure for its observable."""
    for axes in panels_of(module.draw(responses[lacks])):
        np.testing.assert_allclose(marked(axes), sorted([*bands, (0.265, 0.275)]), atol=1e-9)


@pytest.mark.parametrize("module", [fig10_spectra, fig11_wear])
def test_results_that_cannot_be_predicted_are_drawn(twinned, module):
    along, deepest = along_order(twinned.sweep, 4), twinned.wear.max(axis=1)
    shown = along if module is fig10_spectra else deepest
    lines = [line.get_ydata() for axes in module.draw(twinned).axes for line in axes.lines]
    curves = [of[SENSITIVE] for of in lines if len(of) == len(SPEEDS)]
    assert any(np.array_equal(curve, shown[SENSITIVE]) for curve in curves)


def test_a_profile_that_cannot_be_predicted_is_labelled(sweep, rom, twinned):
    """The wear of twins differs at 0.36, the peak is at 0.34."""
    moved = with_twins(sweep, rom, {"wear": twinned.sweep["departure"].values[:, 0]})
    labels = [line.get_label() for line in fig12_profiles.draw(twinned, moved).axes[0].lines[:2]]
    assert [label.endswith("0.340, not predictable") for label in labels] == [False, True]


def test_a_sweep_that_ends_on_the_rise_gives_a_bound(sweep, rom):
    kept = SPEEDS <= 0.33
    cut = Response(sweep.isel(speed_over_f1=kept).assign(spectrum=10 * sweep["spectrum"]), rom)
    assert texts(fig10_spectra.draw(cut).axes[1])[0] == r"$k$ = 4:  $\geq$ 0.330"
    (line, *_) = fig12_profiles.draw(cut, cut).axes[0].lines
    assert line.get_label().endswith(r"$\geq$ 0.330")


def test_wear_map_marks_crossings_and_peaks(seen):
    top, depth, lobes, _ = fig11_wear.draw(seen).axes
    crossings, peaks = (line for line in top.lines if line.get_marker() == "v")
    assert crossings.get_xdata() == pytest.approx([CROSSING_4, 1 / np.sqrt(36 - 5.6)], abs=1e-5)
    assert list(peaks.get_xdata()) == [PEAK_4, PEAK_6]
    assert texts(top).count("4") == texts(top).count("6") == 2
    deepest = dict(depth.lines[0].get_xydata())
    assert deepest[PEAK_4] == pytest.approx(3) and np.isnan(deepest[SPEEDS[FAILED]])
    counts = dict(lobes.lines[0].get_xydata())
    assert (counts[PEAK_4], counts[PEAK_6], counts[0.1]) == (4, 6, 2)
    assert SPEEDS[FAILED] not in counts


def test_a_scene_without_spectrum_gets_a_wear_map_without_peaks(sweep, rom):
    bare = Response(sweep.drop_vars("spectrum"), rom)
    assert texts(fig11_wear.draw(bare).axes[0]) == []


def test_a_legend_says_only_what_tells_scenes_apart():
    labels = ["plastic, $E$ = 1, $K$ = 4.55", "plastic, $E$ = 10, $K$ = 4.55"]
    assert fig12_profiles.apart(labels) == ["$E$ = 1", "$E$ = 10"]
    assert fig12_profiles.apart(labels[:1] * 2) == labels[:1] * 2


def test_profiles_at_the_peak_of_each_scene(sweep, rom, seen):
    softer = Response(sweep.assign(wear=sweep["wear"] / 2), rom)
    (axes,) = fig12_profiles.draw(seen, softer).axes
    first, second = axes.lines
    np.testing.assert_allclose(first.get_ydata(), [*3 * worn(4), 3])
    np.testing.assert_allclose(second.get_ydata(), first.get_ydata() / 2)
    assert first.get_xdata()[[0, -1]] == pytest.approx([0, 360])
    assert first.get_label().endswith("0.340")
    nearest = [segment[0, 0] for segment in axes.collections[0].get_segments()]
    assert nearest == [0, 180, 360]  # where two diameters come inwards


def bar_of_tetrahedra():
    """A bar of one by one by three, x the long side, in ten-node tetrahedra: points and cells."""
    points = [np.array([x, y, z], dtype=float) for x in range(4) for y in (0, 1) for z in (0, 1)]
    split = ((0, 1, 3, 7), (0, 3, 2, 7), (0, 2, 6, 7), (0, 6, 4, 7), (0, 4, 5, 7))
    middle, cells = {}, []
    for corners in ([4 * x + i for i in tetrahedron] for x in range(3) for tetrahedron in split):
        for i, j in ((0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3)):
            edge = tuple(sorted((corners[i], corners[j])))
            if edge not in middle:
                middle[edge] = len(points)
                points.append((points[edge[0]] + points[edge[1]]) / 2)
            corners = [*corners, middle[edge]]
        cells.append(corners)
    return np.array(points), np.array(cells)


def test_clamped_nodes_do_not_move():
    mesh = np.array([[0, 0, 0], [1, 0, 0], [2, 0, 0]], dtype=float)
    shapes = np.ones((1, 2, 3))
    spread = fig09_modes.spread(mesh, mesh[[2, 1]], shapes * [[[2], [1]]])
    np.testing.assert_array_equal(spread[0, :, 0], [0, 1, 2])
    refused(ValueError, fig09_modes.spread, mesh, mesh[[2, 1]] + 0.1, shapes, match="another mesh")


def test_tip_rotation_is_one_for_rotation_and_zero_for_translation():
    square = np.array([[3, y, z] for y in (0, 1) for z in (0, 1)], dtype=float)
    turn = np.cross([1.0, 0, 0], square - square.mean(axis=0))
    assert fig09_modes.rotation_share(square, turn) == pytest.approx(1)
    assert fig09_modes.rotation_share(square, np.ones((4, 3))) == pytest.approx(0)


def test_mode_shapes_are_drawn_to_one_scale():
    mesh, cells = bar_of_tetrahedra()
    bending, axial = np.zeros((2, len(mesh), 3))
    bending[:, 2], axial[:, 0] = mesh[:, 0] ** 2, mesh[:, 0]
    shapes = fig09_modes.unit_length(np.array([bending, axial]))
    assert np.linalg.norm(shapes, axis=2).max(axis=1) == pytest.approx([1, 1])
    blade = views.solid(meshio.Mesh(mesh, [("tetra10", cells)]))
    first, second, _ = fig09_modes.draw(blade, shapes, np.array([1.0, 3.94]), "mine").axes
    pictures = [np.asarray(axes.images[0].get_array()) for axes in (first, second)]
    assert pictures[0].shape == pictures[1].shape
    outlines = [picture[..., 3] > 0 for picture in pictures]
    assert np.any(outlines[0] != outlines[1])  # the shapes themselves, not only their colours


def stressed(displacement, von_mises):
    mesh, cells = bar_of_tetrahedra()
    numbers = {
        "status": "ok",
        "blade": "mine",
        "scene": "peak",
        "speed_over_f1": 0.346,
        "time_rounds": 19.25,
        "von_mises": {"largest_Pa": von_mises(mesh).max(), "largest_of_cells_Pa": 450e6},
        "von_mises_of_prestress": {"largest_Pa": 123e6, "largest_of_cells_Pa": 140e6},
    }
    blade = views.solid(meshio.Mesh(mesh, [("tetra10", cells)]))
    blade["displacement (m)"], blade["von Mises (Pa)"] = displacement(mesh), von_mises(mesh)
    return blade, numbers


def bent(mesh):
    return np.stack([0 * mesh[:, 0], 1e-3 * mesh[:, 0] ** 2, 0 * mesh[:, 0]], 1)


def test_stress_is_visible_on_its_side_of_the_deformed_blade():
    """400 MPa on the face ahead in rotation: dark on the pressure side only."""
    blade = stressed(bent, lambda mesh: 400e6 * (mesh[:, 1] == 1))
    drawn = stress.draw(*blade)
    pressure, suction, bar = drawn.axes
    images = [np.asarray(axes.images[0].get_array()) for axes in (pressure, suction)]
    dark = [(image[..., 3] > 0) & (image[..., :3].sum(-1) < 300) for image in images]
    assert dark[0].sum() > 3 * dark[1].sum()
    assert "MPa" in bar.get_xlabel() and bar.get_xlim() == (0, 400)
    assert "346" in drawn.get_suptitle() and "400 (450) MPa" in drawn.get_suptitle()
    straight = stress.draw(
        *stressed(lambda mesh: 1e-9 * mesh, lambda mesh: 400e6 * (mesh[:, 1] == 1))
    )
    outlines = [np.asarray(d.axes[0].images[0].get_array())[..., 3] > 0 for d in (drawn, straight)]
    assert outlines[0].shape != outlines[1].shape or np.any(outlines[0] != outlines[1])


def test_edges_tip_and_hub_are_named_where_they_are():
    blade, numbers = stressed(bent, lambda mesh: mesh[:, 0])
    x, _, z = blade.points.T
    at = stress.corners(blade.points)
    assert at["LE"][0] == at["TE"][0] == at["tip"][0] == x.max() and at["hub"][0] == x.min()
    assert (at["LE"][2], at["TE"][2]) == (z.min(), z.max())  # upstream, downstream
    pressure, suction, _ = stress.draw(blade, numbers).axes
    for axes, left, right in ((pressure, "LE", "TE"), (suction, "TE", "LE")):
        places = {text.get_text(): text.xy for text in axes.texts}
        assert places[left][0] < places["tip"][0] < places[right][0]
        assert places["tip"][1] < places["hub"][1]  # rows count downwards


def test_exaggeration_has_one_digit_and_is_stated():
    blade, numbers = stressed(bent, lambda mesh: mesh[:, 0])
    # 9 mm at most on a bar of 3 m, and 8 % of it: 26.7
    assert stress.exaggeration(blade) == pytest.approx(20)
    assert "displacement $\\times$ 20" in stress.draw(blade, numbers).axes[2].get_xlabel()


def test_pressure_side_is_the_blades_own():
    blade = read_settings(Blade, ROOT / "workflow/blades/reference.yaml")
    middle = profile_at(blade.sections, 0.49)
    towards_pressure = (middle.bezier(-1) - middle.bezier(+1))[1]
    for side, sign in (("pressure side", 1), ("suction side", -1)):
        assert sign * (towards_pressure @ stress.VIEWS[side]) > 0


def test_modules_read_what_the_workflow_writes(tmp_path, rom, check, sweep, seen):
    mesh, cells = bar_of_tetrahedra()
    free = mesh[:, 0] > 0
    frequencies = rom.modes(0)[0][None]
    full = FullModel(
        speeds=np.zeros(1),
        omega=frequencies,
        residuals=frequencies,
        compliance=np.ones((1, 3, 3)),
        shapes=np.ones((1, free.sum(), 3)),
        coordinates=mesh[free],
        provenance=PROVENANCE.made(CODE_OF_FULL),
    )
    files = SimpleNamespace(
        **{name: tmp_path / f"{name}.nc" for name in ("rom", "check", "full", "sweep")},
        mesh=tmp_path / "blade.msh",
        sweeps=[tmp_path / "sweep.nc"],
    )
    rom.save(files.rom)
    check.save(files.check)
    full.save(files.full)
    save_sweep(sweep, files.sweep)
    meshio.write(files.mesh, meshio.Mesh(mesh, [("tetra10", cells)]), file_format="gmsh")
    seal(files.mesh)
    read_rom, read_check, printed, _ = fig03_campbell.load(files)
    assert read_rom.f1 == rom.f1
    assert not printed
    np.testing.assert_allclose(read_check.error, check.error, atol=1e-15)
    _, shapes, _, name = fig09_modes.load(files)
    assert name == "reference"
    np.testing.assert_array_equal(np.linalg.norm(shapes[0], axis=1) > 0, free)
    for module in (fig10_spectra, fig11_wear, fig12_profiles):
        read, *_ = module.load(files)
        np.testing.assert_allclose(read.wear, seen.wear)
    assert list(summary.numbers(files, ["mine"])["scenes"]) == ["mine"]


def test_the_summary_has_the_values_of_the_figures(tmp_path, rom, check, seen):
    numbers = summary.summarise(rom, check, {"mine": seen})
    write_json(numbers, tmp_path / "s.json")
    read = json.loads((tmp_path / "s.json").read_text())
    assert read["crossings"]["4"] == pytest.approx(CROSSING_4, abs=1e-4)
    assert read["reduced_model"]["largest_error"] == -0.0075
    scene = read["scenes"]["mine"]
    assert scene["status"] == {"ok": len(SPEEDS) - 1, "unstable": 1}
    assert scene["peaks"][0] == {
        "k": 4,
        "Omega_c": PEAK_4,
        "over_crossing": pytest.approx(PEAK_4 / CROSSING_4, abs=1e-4),
        "amplitude": pytest.approx(3.02),
        "seen": "peak",
        "lobes": 4,
        "lobe_width_deg": pytest.approx([30] * 4, abs=0.2),
        "lobe_height": pytest.approx([3] * 4, rel=0.04),  # of the profile, blurred for counting
        "deepest_wear": pytest.approx(3),
    }
    assert [(end["speed"], end["lobes"]) for end in scene["away"]] == [(0.02, 2), (0.4, 2)]
    markdown = summary.table(numbers)
    assert "| mine | 6 | 0.200 | 1.103 | 2.02 | 2.00 | 6 | peak |" in markdown
    assert "38 ok, 1 unstable; lobes away from resonance: 2 at 0.020, 2 at 0.400." in markdown


def test_summary_marks_what_cannot_be_predicted(rom, check, twinned):
    numbers = summary.summarise(rom, check, {"paper-e1": twinned, "paper-e10": twinned})
    scene = numbers["scenes"]["paper-e1"]
    assert scene["status"] == {"ok": len(SPEEDS) - 4, "sensitive": 3, "unstable": 1}
    peaks = {peak["k"]: peak for peak in scene["peaks"]}
    assert peaks[4]["not_predictable"] == ["spectrum"] and "not_predictable" not in peaks[6]
    assert all("not_predictable" not in end for end in scene["away"])
    markdown = summary.table(numbers)
    assert "| 3.02 | 3.00 | 4 | peak; not predictable: spectrum |" in markdown


def test_summary_marks_the_ends_of_a_sweep_too(sweep, rom, check):
    last = with_twins(sweep, rom, {"wear": np.where(SPEEDS == 0.4, 1.0, 0.0)})
    numbers = summary.summarise(rom, check, {"mine": last})
    assert numbers["scenes"]["mine"]["away"][1]["not_predictable"] == ["wear"]
    assert "2 at 0.020, 2 at 0.400 (not predictable: wear)." in summary.table(numbers)


def test_saved_figures_are_sharp_reproducible_and_restore_the_settings(tmp_path, seen):
    files = [tmp_path / "a.png", tmp_path / "a.pdf", tmp_path / "b.pdf"]
    with mpl.rc_context({"font.size": 31, "savefig.dpi": 20}):
        before = dict(mpl.rcParams)
        for pdf in files[1:]:
            style.save(fig11_wear.draw(seen), files[0], pdf)
        assert dict(mpl.rcParams) == before
    width = int.from_bytes(files[0].read_bytes()[16:20])
    assert width == round(300 * style.DOUBLE)
    assert files[1].read_bytes() == files[2].read_bytes()
    assert sorted(tmp_path.iterdir()) == sorted(files)


def described(path):
    """Description of the PNG or subject of the PDF at ``path``."""
    if path.suffix == ".png":
        return Image.open(path).text["Description"]
    return re.search(rb"/Subject \((.*?)\)", path.read_bytes(), re.DOTALL)[1].decode()


def test_a_figure_has_its_blades_and_scenes_in_its_metadata(tmp_path, rom, sweep, seen):
    """Each once, also of two models with the same numbers; other inputs have none."""
    files = {name: tmp_path / name for name in ("rom.nc", "same.nc", "a.nc", "b.nc", "code.py")}
    for name in ("rom.nc", "same.nc"):
        rom.save(files[name])
    save_sweep(sweep, files["a.nc"])
    other = dataclasses.replace(PROVENANCE, blade="rotor37")
    save_sweep(sweep.assign_attrs(name="mine", rom=other.dump()), files["b.nc"])
    files["code.py"].touch()
    origin = origins(files.values())
    assert origin.split("; ") == [
        PROVENANCE.summary(),
        f"scene paper-e1, {PROVENANCE.summary()}",
        f"scene mine, {other.summary()}",
    ]
    assert "blade reference" in PROVENANCE.summary() and "blade rotor37" in other.summary()
    pictures = [tmp_path / "x.png", tmp_path / "x.pdf"]
    style.save(fig12_profiles.draw(seen, seen), *pictures, origin=origin)
    assert [described(path) for path in pictures] == [origin, origin]


def test_a_sweep_of_an_older_version_has_no_origin(tmp_path, sweep):
    save_sweep(sweep.drop_attrs(deep=False), tmp_path / "old.nc")
    refused(ProvenanceError, origins, [tmp_path / "old.nc"], match="an older version made it")


def test_cells_meet_halfway_between_uneven_speeds():
    np.testing.assert_allclose(style.edges(np.array([1.0, 2.0, 4.0])), [0.5, 1.5, 3.0, 5.0])
    np.testing.assert_allclose(style.edges(np.array([2.0])), [1.98, 2.02])


def test_no_cell_covers_what_lies_between_distant_speeds():
    speeds = np.array([0.5, 0.51, 1.0])
    low, high = style.spans(speeds)
    np.testing.assert_allclose(low, [0.495, 0.505, 0.98])
    np.testing.assert_allclose(high, [0.505, 0.53, 1.02])
    edges, values = style.over_speeds(speeds, np.array([[1.0], [2.0], [3.0]]))
    np.testing.assert_allclose(edges, [0.495, 0.505, 0.505, 0.53, 0.98, 1.02])
    assert values[:, 0].tolist() == [1.0, None, 2.0, None, 3.0]


def test_an_axis_begins_at_0_or_a_quarter_of_the_sweep_before_it():
    assert style.limits(np.linspace(0.06, 0.4, 35)) == pytest.approx((0.0, 0.405))
    assert style.limits(np.linspace(0.3, 0.4, 11)) == pytest.approx((0.2675, 0.405))


def test_what_lies_left_of_the_axes_is_left_out(sweep, rom):
    """A sweep that begins at 0.335, beyond the crossing of k = 4 and most engine orders."""
    of = Response(sweep.isel(speed_over_f1=SPEEDS >= 0.335), rom)
    limits = style.limits(of.speeds)
    assert CROSSING_4 < limits[0] < 0.33
    top, _, _, _ = fig11_wear.draw(of).axes
    assert top.get_xlim() == pytest.approx(limits)
    crossings, peaks = (line for line in top.lines if line.get_marker() == "v")
    assert (len(crossings.get_xdata()), list(peaks.get_xdata())) == (0, [PEAK_4])
    top, bottom, *_ = fig10_spectra.draw(of).axes
    assert top.get_xlim() == bottom.get_xlim() == pytest.approx(limits)
    named = [text.get_text() for text in top.texts if text.get_visible()]
    assert "eo(2)" in named and "eo(4)" in named and "eo(14)" not in named


def test_a_scale_ends_at_a_power_of_ten():
    assert style.decades(2.02, 3) == pytest.approx((0.01, 10.0))
    assert style.decades(0.1, 2) == pytest.approx((0.001, 0.1))
    assert style.decades(0.0, 2) == pytest.approx((0.01, 1.0))


def test_figures_are_those_of_the_configured_scenes_and_blades(tmp_path):
    """With the paper's numbers for its scenes, with names for others; only recorded outputs."""
    for name in ("geometry", "fem", "rom", "simulate"):
        (tmp_path / name).symlink_to(ROOT / name)
    shutil.copytree(ROOT / "workflow", tmp_path / "workflow")
    shutil.copy(ROOT / "Snakefile", tmp_path)
    record = {"spectrum_rounds": None, "states_rounds": 1}
    mine = {"base": "paper-e1", "peaks": None, "record": record}
    (tmp_path / "workflow/scenes/mine.yaml").write_text(yaml.safe_dump(mine))
    config = {"scenes": ["paper-e1", "mine"], "blocks": 2}
    (tmp_path / "workflow/config.yaml").write_text(yaml.safe_dump(config))
    listed = subprocess.run(
        [sys.executable, "-m", "snakemake", "figures", "--dry-run", "--cores=1", "--summary"],
        cwd=tmp_path,
        env=os.environ | {"PYTHONPATH": str(tmp_path)},
        capture_output=True,
        text=True,
        check=True,
    ).stdout
    figures = {Path(line.split()[0]).name for line in listed.splitlines() if "/figures/" in line}
    names = {"fig03", "fig09", "fig10a", "fig11a", "wear-mine", "stress-mine", "loads-reference"}
    drawn = {f"{name}.{suffix}" for name in names for suffix in ("png", "pdf")}
    assert figures == drawn | {"summary.json", "summary.md"}


def test_the_summary_says_why_runs_have_no_contact(rom, check, responses):
    response = responses["contact"]
    assert response.has_result[3:5].all()
    table = summary.table(summary.summarise(rom, check, {"mine": response}))
    assert "2 no-contact" in table
    assert "; no contact: casing.scale: 0; lobes" in table
