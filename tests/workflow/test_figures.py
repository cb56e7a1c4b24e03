"""Contents of the figures for small prescribed data."""

import dataclasses
import re
from pathlib import Path

import matplotlib as mpl
import meshio
import numpy as np
import pytest
import xarray as xr
import yaml
from made_sweeps import ENDS, GAP, PROVENANCE, STIFFENING, attrs_of, by_strip, made_rom
from PIL import Image
from projects import ROOT, make_project
from refused import refused

from geometry.blade import Blade
from geometry.profile import profile_at
from geometry.project import ProvenanceError, read_json, write_json
from rom.check import RomCheck
from simulate.scene import Scene
from simulate.sweeps.dataset import save as save_sweep
from simulate.sweeps.peak import along_order, crossing
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
from workflow.figures.marks import nearest
from workflow.figures.origins import origins
from workflow.figures.response import Response
from workflow.paper.measure import coating

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
    scene = Scene.load(ROOT / "workflow/scenes/hand-e1.yaml")
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


def test_figure_summary_and_claim_name_the_same_peaks(sweep, rom, seen, check):
    marked = [(peak.k, peak.Omega_c, peak.amplitude) for peak in seen.peaks]
    told = summary.summarise(rom, check, {"mine": seen})["scenes"]["mine"]["peaks"]
    judged = coating(sweep, rom)["peaks"]
    assert [(p["k"], p["Omega_c"]) for p in told if p["seen"] == "peak"] == [p[:2] for p in marked]
    for k, Omega_c, amplitude in marked:
        claimed = judged[str(k)]
        assert (claimed["Omega_c"], claimed["amplitude"]) == (Omega_c, amplitude)
        assert claimed["clear"]


def test_campbell_has_crossings_frequencies_and_engine_orders(rom, check):
    """Full model and reduced one, and lines of the orders up to the last mode."""
    first, every = fig03_campbell.draw(rom, check).axes
    expected = [[1, k] / np.sqrt(k**2 - STIFFENING) for k in (4, 5, 6, 8)]
    np.testing.assert_allclose(points(first, "s"), expected, atol=1e-6)
    unit = 2 * np.pi * rom.f1
    np.testing.assert_allclose(points(every, "o")[:, 1], check.full.T.ravel() / unit)
    lines = [line.get_xydata() for line in every.lines if line.get_linestyle() == "-"]
    for line, at_rest in zip(lines, (1, 4, 4), strict=True):
        f = np.sqrt(at_rest**2 + STIFFENING * line[:, 0] ** 2)
        np.testing.assert_allclose(line[:, 1], f)
    last = every.get_xlim()[1]
    ends = {line.get_ydata()[-1] / last for line in every.lines if line.get_linestyle() == "--"}
    assert sorted(ends) == pytest.approx([4, 8, 16, 32])


def test_operating_lines_are_at_their_speed_and_second_axes_in_units_of_engines(rom, check, seen):
    """The scales of rpm, Hz and um are those of the axes that they stand beside."""
    at = crossing(rom, 4) / 1.1
    campbell = fig03_campbell.draw(rom, check, operating={"design": 60 * rom.f1 * at})
    first = campbell.axes[0]
    assert any(line.get_xdata() == pytest.approx([at, at]) for line in first.lines)
    spectra = fig10_spectra.draw(seen)
    beside = {
        "speed (rpm)": (first, "xlim", 60 * rom.f1),
        "frequency (Hz)": (first, "ylim", rom.f1),
        "µm": (spectra.axes[1], "ylim", 1e6 * GAP),
    }
    for drawn in (campbell, spectra):
        drawn.draw_without_rendering()
    for unit, (axes, of, scale) in beside.items():
        (second,) = (a for a in axes.child_axes if unit in a.get_xlabel() + a.get_ylabel())
        limits = np.array(getattr(axes, f"get_{of}")())
        np.testing.assert_allclose(getattr(second, f"get_{of}")(), scale * limits)


def test_loads_are_those_of_the_sweep_and_its_peaks():
    """Two scenes; a panel for what any of them knows, in its unit, and the peaks with their ±."""
    peak = {"k": 4, "Omega_c": 0.33, "numbers": {"force": 40.0}, "errors": {"force": 2.0}}
    lines = {"torque": np.array([0.1, 0.2]), "worn_volume": np.array([1e-8, 3e-8])}
    of = loads.Loads("one", np.array([0.3, 0.35]), lines, [peak], 10.0)
    bare = of._replace(name="two", lines={"torque": np.array([0.3, np.nan])}, peaks=[])
    drawn = loads.draw([of, bare], 100.0, "mine")
    force, torque, volume = drawn.axes
    (bar,) = force.containers
    assert bar.lines[0].get_xydata().tolist() == [[0.33, 40.0]]
    assert [line.get_ydata().tolist()[0] for line in torque.lines] == [0.1, 0.3]
    np.testing.assert_allclose(volume.lines[0].get_ydata(), [10, 30])
    opening = next(axes for axes in volume.child_axes if "opening" in axes.get_ylabel())
    drawn.draw_without_rendering()  # 1 mm3 is 1e-9 m3, over 0.1 m2
    np.testing.assert_allclose(opening.get_ylim(), 0.01 * np.array(volume.get_ylim()))


def test_spectra_mark_peaks_where_they_are(seen):
    top, bottom, _ = fig10_spectra.draw(seen).axes
    rings = points(top, "o")
    np.testing.assert_allclose(rings, [[PEAK_4, 4 * PEAK_4], [PEAK_6, 6 * PEAK_6]])
    np.testing.assert_allclose(points(bottom, ".")[:, 1], [3.02, 2.02])
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


def test_the_nearest_critical_speed_is_told_with_its_distance():
    critical = {4: 0.34, 6: 0.2}
    assert "$k$ = 4, 10.0 % above" in nearest(0.34 / 1.1, critical, "peak")
    assert "$k$ = 6, 20.0 % below" in nearest(0.25, critical, "peak")


def test_a_profile_that_cannot_be_predicted_is_labelled(sweep, rom, twinned):
    """The wear of twins differs at 0.36, the peak is at 0.34."""
    moved = with_twins(sweep, rom, {"wear": twinned.sweep["departure"].values[:, 0]})
    labels = [line.get_label() for line in fig12_profiles.draw(twinned, moved).axes[0].lines[:2]]
    assert ["not predictable" in label for label in labels] == [False, True]


def test_a_sweep_that_ends_on_the_rise_gives_a_bound(sweep, rom):
    kept = sweep.isel(speed_over_f1=SPEEDS <= 0.33).assign(spectrum=10 * sweep["spectrum"])
    assert r"$\geq$ 0.330" in texts(fig10_spectra.draw(Response(kept, rom)).axes[1])[0]


def test_wear_map_marks_crossings_and_peaks(seen):
    top, depth, lobes, _ = fig11_wear.draw(seen).axes
    crossings, peaks = (line for line in top.lines if line.get_marker() == "v")
    assert crossings.get_xdata() == pytest.approx([CROSSING_4, 1 / np.sqrt(36 - 5.6)], abs=1e-5)
    assert list(peaks.get_xdata()) == [PEAK_4, PEAK_6]
    deepest = dict(depth.lines[0].get_xydata())
    assert deepest[PEAK_4] == pytest.approx(3) and np.isnan(deepest[SPEEDS[FAILED]])
    counts = dict(lobes.lines[0].get_xydata())
    assert (counts[PEAK_4], counts[PEAK_6], counts[0.1]) == (4, 6, 2)
    assert SPEEDS[FAILED] not in counts


def test_a_scene_without_spectrum_gets_a_wear_map_without_peaks(sweep, rom):
    bare = Response(sweep.drop_vars("spectrum"), rom)
    assert texts(fig11_wear.draw(bare).axes[0]) == []


def test_profiles_at_the_peak_of_each_scene(sweep, rom, seen):
    softer = Response(sweep.assign(wear=sweep["wear"] / 2), rom)
    (axes,) = fig12_profiles.draw(seen, softer).axes
    first, second = axes.lines
    np.testing.assert_allclose(first.get_ydata(), [*3 * worn(4), 3])
    np.testing.assert_allclose(second.get_ydata(), first.get_ydata() / 2)
    assert first.get_xdata()[[0, -1]] == pytest.approx([0, 360])
    inward = [segment[0, 0] for segment in axes.collections[0].get_segments()]
    assert inward == [0, 180, 360]  # where two diameters come inwards


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
    mesh, _ = bar_of_tetrahedra()
    bending, axial = np.zeros((2, len(mesh), 3))
    bending[:, 2], axial[:, 0] = mesh[:, 0] ** 2, mesh[:, 0]
    shapes = fig09_modes.unit_length(np.array([bending, axial]))
    assert np.linalg.norm(shapes, axis=2).max(axis=1) == pytest.approx([1, 1])


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


def test_the_scale_of_the_stress_ends_at_the_largest_and_the_blade_is_deformed():
    """400 MPa; the picture of a bent blade is not that of a straight one."""
    outlines = []
    for displacement in (bent, lambda mesh: 1e-9 * mesh):
        blade = stressed(displacement, lambda mesh: 400e6 * (mesh[:, 1] == 1))
        pressure, _, bar = stress.draw(*blade).axes
        assert bar.get_xlim() == (0, 400)
        outlines.append(pressure.images[0].get_array()[..., 3] > 0)
    assert not np.array_equal(*outlines)


def test_edges_tip_and_hub_are_where_they_are():
    blade, _ = stressed(bent, lambda mesh: mesh[:, 0])
    x, _, z = blade.points.T
    at = stress.corners(blade.points)
    assert at["LE"][0] == at["TE"][0] == at["tip"][0] == x.max() and at["hub"][0] == x.min()
    assert (at["LE"][2], at["TE"][2]) == (z.min(), z.max())  # upstream, downstream


def test_exaggeration_has_one_digit():
    """9 mm at most on a bar of 3 m, and 8 % of it: 26.7."""
    blade, _ = stressed(bent, lambda mesh: mesh[:, 0])
    assert stress.exaggeration(blade) == pytest.approx(20)


def test_pressure_side_is_the_blades_own():
    blade = Blade.load(ROOT / "workflow/blades/reference.yaml")
    middle = profile_at(blade.sections, 0.49)
    towards_pressure = (middle.bezier(-1) - middle.bezier(+1))[1]
    for side, sign in (("pressure side", 1), ("suction side", -1)):
        assert sign * (towards_pressure @ stress.VIEWS[side]) > 0


def test_the_summary_has_the_values_of_the_figures(tmp_path, rom, check, seen):
    write_json(summary.summarise(rom, check, {"mine": seen}), tmp_path / "s.json")
    read = read_json(tmp_path / "s.json")
    assert read["crossings"]["4"] == pytest.approx(CROSSING_4, abs=1e-4)
    of_check = {"largest_error": -0.0075, "largest_error_mode": 2, "modes": 3, "speeds": 5}
    assert of_check.items() <= read["reduced_model"].items()
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


def test_summary_marks_what_cannot_be_predicted(sweep, rom, check, twinned, responses):
    """Of peaks and of the ends of a sweep; the table says why runs have no contact."""
    last = with_twins(sweep, rom, {"wear": np.where(SPEEDS == 0.4, 1.0, 0.0)})
    given = {"twins": twinned, "last": last, "contact": responses["contact"]}
    numbers = summary.summarise(rom, check, given)
    scene = numbers["scenes"]["twins"]
    assert scene["status"] == {"ok": len(SPEEDS) - 4, "sensitive": 3, "unstable": 1}
    peaks = {peak["k"]: peak for peak in scene["peaks"]}
    assert peaks[4]["not_predictable"] == ["spectrum"] and "not_predictable" not in peaks[6]
    assert all("not_predictable" not in end for end in scene["away"])
    assert numbers["scenes"]["last"]["away"][1]["not_predictable"] == ["wear"]
    assert numbers["scenes"]["contact"]["status"]["no-contact"] == 2
    assert responses["contact"].has_result[3:5].all()
    assert "casing.scale: 0" in summary.table(numbers)


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
    names = ("rom.nc", "same.nc", "a.nc", "b.nc", "code.py")
    model, same, one, two, code = files = [tmp_path / name for name in names]
    rom.save(model)
    rom.save(same)
    save_sweep(sweep, one)
    other = dataclasses.replace(PROVENANCE, blade="rotor37")
    save_sweep(sweep.assign_attrs(name="mine", rom=other.dump()), two)
    code.touch()
    origin = origins(files)
    assert origin.split("; ") == [
        PROVENANCE.summary(),
        f"scene paper-e1, {PROVENANCE.summary()}",
        f"scene mine, {other.summary()}",
    ]
    assert "blade reference" in PROVENANCE.summary() and "blade rotor37" in other.summary()
    pictures = [tmp_path / "x.png", tmp_path / "x.pdf"]
    style.save(fig12_profiles.draw(seen, seen), *pictures, origin=origin)
    assert [described(path) for path in pictures] == [origin, origin]
    # of a sweep of an older version nothing is known
    save_sweep(sweep.drop_attrs(deep=False), two)
    assert refused(ProvenanceError, origins, [two]).file == str(two)


def test_no_cell_covers_what_lies_between_distant_speeds():
    speeds = np.array([0.5, 0.51, 1.0])
    low, high = style.spans(speeds)
    np.testing.assert_allclose([low, high], [[0.495, 0.505, 0.98], [0.505, 0.53, 1.02]])
    edges, values = style.over_speeds(speeds, np.array([[1.0], [2.0], [3.0]]))
    np.testing.assert_allclose(edges, [0.495, 0.505, 0.505, 0.53, 0.98, 1.02])
    assert values[:, 0].tolist() == [1.0, None, 2.0, None, 3.0]


def test_what_lies_left_of_the_axes_is_left_out(sweep, rom):
    """A sweep that begins at 0.335, beyond the crossing of k = 4."""
    of = Response(sweep.isel(speed_over_f1=SPEEDS >= 0.335), rom)
    limits = style.limits(of.speeds)
    assert CROSSING_4 < limits[0] < 0.33
    top = fig11_wear.draw(of).axes[0]
    assert top.get_xlim() == pytest.approx(limits)
    crossings, peaks = (line for line in top.lines if line.get_marker() == "v")
    assert (len(crossings.get_xdata()), list(peaks.get_xdata())) == (0, [PEAK_4])
    top, bottom, *_ = fig10_spectra.draw(of).axes
    assert top.get_xlim() == bottom.get_xlim() == pytest.approx(limits)


@pytest.mark.parametrize(
    ("found", "expected"),
    [
        (style.decades(2.02, 3), (0.01, 10.0)),  # a scale ends at a power of ten
        (style.decades(0.1, 2), (0.001, 0.1)),
        (style.decades(0.0, 2), (0.01, 1.0)),
        # an axis begins at 0 or a quarter of the sweep before it
        (style.limits(np.linspace(0.06, 0.4, 35)), (0.0, 0.405)),
        (style.limits(np.linspace(0.3, 0.4, 11)), (0.2675, 0.405)),
        # cells meet halfway between uneven speeds
        (tuple(style.edges(np.array([1.0, 2.0, 4.0]))), (0.5, 1.5, 3.0, 5.0)),
        (tuple(style.edges(np.array([2.0]))), (1.98, 2.02)),
    ],
)
def test_ends_of_scales_axes_and_cells(found, expected):
    assert found == pytest.approx(expected)


def test_figures_are_those_of_the_configured_scenes_and_blades(tmp_path):
    """With the paper's numbers for its scenes, with names for others; only recorded outputs."""
    project = make_project(tmp_path)
    record = {"spectrum_rounds": None, "states_rounds": 1}
    mine = {"base": "paper-e1", "peaks": None, "record": record}
    (tmp_path / "workflow/scenes/mine.yaml").write_text(yaml.safe_dump(mine))
    config = {"scenes": ["paper-e1", "mine"], "blocks": 2}
    (tmp_path / "workflow/config.yaml").write_text(yaml.safe_dump(config))
    listed = project.run("figures", "--dry-run", "--summary")
    figures = {Path(name).name for name in re.findall(r"^results/figures/\S+", listed, re.M)}
    names = {"fig03", "fig09", "fig10a", "fig11a", "wear-mine", "stress-mine", "loads-reference"}
    drawn = {f"{name}.{suffix}" for name in names for suffix in ("png", "pdf")}
    assert figures == drawn | {"summary.json", "summary.md"}
