"""Every figure, drawn from made data: its numbers, labels and units, nothing cut off or hidden."""

import csv
import dataclasses
import re
from types import SimpleNamespace

import matplotlib as mpl
import numpy as np
import pytest
import pyvista as pv
import xarray as xr
from made_sweeps import (
    ENDS,
    F1,
    GAP,
    PROVENANCE,
    ROUNDS,
    SAMPLES,
    SPAN,
    STIFFENING,
    attrs_of,
    by_strip,
    made_rom,
    save_runs,
)
from PIL import Image
from projects import ROOT
from refused import refused
from runs import swept
from scenes import EXACT, scene as of_march
from test_blade_studies import OWN, SLOPE, of_meshes  # noqa: F401
from test_figures_setup import PATCHES, blade_files, footprint_files, paper, shapes  # noqa: F401
from test_long_times import (
    cases,  # noqa: F401
    files as long_files,  # noqa: F401
)
from test_paper_signals import files as spectrogram_files  # noqa: F401
from test_stability_studies import ENGAGED, INTERMITTENT
from tidy import faults

from geometry.base import ProvenanceError
from geometry.blade import Blade
from geometry.hats import hat_nodes
from geometry.profile import profile_at
from rom.check import RomCheck
from rom.crossings import crossing
from rom.full_model import FullModel
from simulate.scene import Scene
from simulate.signals import leading_gap
from simulate.sweeps.dataset import save as save_sweep
from simulate.sweeps.peak import Peak, along_order
from simulate.sweeps.peak_results import asked, ends
from workflow.figures import (
    blades,
    campbell,
    designs,
    forced,
    loads,
    modes as modes_at_rest,
    spectra,
    stress,
    style,
    wear,
)
from workflow.figures.annotations import speed_text
from workflow.figures.response import Response
from workflow.jobs.figure import origins, read
from workflow.many.design_tables import FORMAT, save as save_table
from workflow.many.sobol import Sobol, indices
from workflow.paper.figures import (
    blade as blade_and_patches,
    coatings,
    compared,
    footprint,
    laws,
    marked,
)
from workflow.paper.measure import coating
from workflow.study import mesh_convergence
from workflow.study.stability import told as stability

CROSSING_4 = 1 / np.sqrt(16 - STIFFENING)  # f1^2 = 1 + 5.6 Omega^2 meets k^2 Omega^2
SPEEDS = np.round(np.arange(0.02, 0.401, 0.01), 12)
FAILED = 25  # of SPEEDS: 0.27
SENSITIVE = [31, 32, 34]  # of SPEEDS: 0.33, 0.34 (the peak of eo(4)) and 0.36
PEAK_4, PEAK_6 = 0.34, 0.2
RODS = 512
APART = np.array([0.5, 0.51, 1.0])


@pytest.fixture(scope="module")
def rom():
    return made_rom()


def resonance(speeds, at):
    return 1 / (1 + ((speeds - at) / 0.004) ** 2)


def worn(k, rods=RODS):
    return np.maximum(0, np.cos(k * 2 * np.pi * np.arange(rods) / rods))


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
            "speed": ("speed_over_f1", SPEEDS * 2 * np.pi * F1),
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
def of_user(sweep, rom):
    """The same from a scene that gives its speeds in rad/s."""
    speeds = {"over_f1": None, "rad_s": sweep["speed"].values.tolist()}
    scene = Scene.load(ROOT / "workflow/scenes/hand-e1.yaml").but(speeds=speeds)
    return Response(sweep.assign_attrs(attrs_of(scene, "mine")), rom)


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


def apart(model):
    """The model with its third mode above the second, whose names would meet."""
    K = model.K.copy()
    K[0, 2, 2] *= 2
    return dataclasses.replace(model, K=K)


def named(response, name):
    """The response of a scene of another name."""
    return Response(response.sweep.assign_attrs(name=name), response.rom)


@pytest.fixture
def densities(tmp_path):
    """At the first speed the finer liner wears a tenth less, at the second the same."""
    coarse, fine = (1 + np.cos(2 * np.pi * 4 * np.arange(nu) / nu) for nu in (128, RODS))
    return SimpleNamespace(
        coarse=save_runs(tmp_path / "coarse.nc", [0.35, 0.2], [coarse] * 2),
        fine=save_runs(tmp_path / "fine.nc", [0.35, 0.2], [0.9 * fine, fine]),
    )


TIME = np.arange(1, ROUNDS * SAMPLES + 1) / SAMPLES
CYCLES = np.sin(2 * np.pi * 4 * TIME)


@pytest.fixture
def histories(tmp_path):
    """Errors of 20 % and 10 % in the last round, none before."""

    def with_error(error, step):
        u_r = np.where(TIME > ROUNDS - 1, (1 - error) * CYCLES, CYCLES)
        path, chord = tmp_path / f"{error}-{step}.nc", (0.5, 1 / 16)
        return save_runs(path, [0.35], [worn(4, 128)], [u_r], step=step, chord=chord)

    return SimpleNamespace(
        coarse=with_error(0.1, 0.5),
        fine=with_error(0, 0.5),
        steps=[with_error(error, step) for error, step in ((0.2, 0.84), (0.1, 0.44), (0.0, 0.22))],
    )


@pytest.fixture
def rest(rom):
    """Gaps given at rest that shrink by 10 and 30 um, along the chord twice as much at its end."""
    taken = {"leading_edge_over_span": None, "trailing_edge_over_span": None}
    at_rest = {"leading_edge_um": 80, "trailing_edge_um": 120, "at": "rest"}
    scene = Scene.load(ROOT / "workflow/scenes/paper-e1.yaml").but(clearance=taken | at_rest)
    speeds, xi = np.array([0.2, 0.3]), np.array([1, 5, 11, 15]) / 16
    shrunk = np.array([[1e-5], [3e-5]]) * (1 + (xi - 1 / 16) * 16 / 14)
    coords = {
        "speed_over_f1": speeds,
        "speed": ("speed_over_f1", 2 * np.pi * F1 * speeds),
        "xi": ("strip", xi),
        "gap": (("speed_over_f1", "strip"), scene.clearance.gaps(xi, SPAN) - shrunk),
    }
    status = {"status": ("speed_over_f1", ["ok", "ok"])}
    return Response(xr.Dataset(status, coords, attrs_of(scene)), rom)


@pytest.fixture(scope="module")
def strained():
    """100 µε of EO 4 on -20 µε at the first gauge, half of it of EO 6 at the second; 10 MPa."""
    rounds, speeds = 2, np.linspace(0.1, 0.4, 7)
    gauge = {"name": "root", "at": [440, 1.8, 0], "direction": [1, 0, 0]}
    scene = Scene.load(ROOT / "workflow/scenes/paper-e1.yaml").but(
        record={"spectrum_rounds": rounds, "gauges": [gauge, gauge | {"name": "tip"}]}
    )
    time = 18 + np.arange(1, rounds * SAMPLES + 1) / SAMPLES
    wave = np.stack([np.cos(8 * np.pi * time), 0.5 * np.cos(12 * np.pi * time)])
    grown = speeds[:, None, None] / speeds[-1] * wave
    dims = ("speed_over_f1", "gauge", "gauge_time")
    runs = xr.Dataset(
        {
            "gauge_strain": (dims, 1e-4 * grown),
            "gauge_stress": (dims, 1e7 * grown),
            "gauge_strain_static": (dims[:2], np.full((7, 2), -2e-5)),
            "gauge_stress_static": (dims[:2], np.full((7, 2), 5e6)),
            "status": ("speed_over_f1", ["ok"] * 7),
        },
        {
            "speed_over_f1": speeds,
            "speed": ("speed_over_f1", speeds * 2 * np.pi * 100),
            "gauge": ["root", "tip"],
            "gauge_time": time,
        },
        attrs_of(scene) | {"f1_Hz": 100.0},
    )
    return Response(runs, made_rom())


def grid_peak(amplitude, Omega_c=0.36, departure=1e-9, status="ok", at_end=False):
    of_peak = {"Omega_c": Omega_c, "over_crossing": Omega_c / 0.3, "amplitude": amplitude}
    return of_peak | {"status": status, "departure": departure, "at_end": at_end}


@pytest.fixture
def grid():
    """k = 4 is largest at (10, 4.55), k = 6 at (1, 0.45)."""
    found = {
        (1, 0.45): ({"ok": 9, "sensitive": 1}, grid_peak(1.0), grid_peak(0.9, 0.2)),
        (10, 0.45): (
            {"ok": 10},
            grid_peak(0.5, departure=0.02, status="sensitive"),
            grid_peak(0.3, 0.19, departure=None, status="sensitive"),  # the twin ended otherwise
        ),
        (100, 0.45): ({"ok": 10}, grid_peak(0.7, at_end=True), grid_peak(0.2, departure=None)),
        (1, 4.55): (
            {"ok": 7, "inaccurate": 3},
            grid_peak(1.2),
            grid_peak(0.4, departure=1e-6, status="sensitive"),  # the wear parts, not the response
        ),
        (10, 4.55): ({"ok": 10}, grid_peak(2.0, 0.38), None),
        (100, 4.55): ({"inaccurate": 10}, None, None),
    }
    of_grid = [
        {"E": e, "K": k, "runs": 10, "statuses": ends, "peaks": {"4": four, "6": six}}
        for (e, k), (ends, four, six) in found.items()
    ]
    return {"E": [1, 10, 100], "K": [0.45, 4.55], "orders": [4, 6], "cases": of_grid}


STRESSES = (  # of three speeds, and the answers at two; of the third the motion grows
    {
        "scene": "mine",
        "blade": "thin",
        "fatigue": {"endurance_MPa": 500.0, "yield_MPa": 900.0, "ultimate_MPa": 1000.0},
        "root": "fillet",
        "away_m": 0.0,
        "speeds": [
            {"speed_over_f1": 0.3, "trend": "steady", "mean_stress": 3e8, "alternating": 2e7}
            | {"margin": 17.5},
            {"speed_over_f1": 0.35, "trend": "steady", "mean_stress": -4e7, "alternating": 3e7}
            | {"margin": 16.7},
            {"speed_over_f1": 0.4, "trend": "growing", "mean_stress": 2e7, "alternating": 1e7}
            | {"margin": 49.0},
            {"speed_over_f1": 0.45, "trend": "steady"},
        ],
    },
    {"peaks": [{"k": 4, "index": 1, "Omega_c": 0.35}, {"k": 5, "index": 4, "Omega_c": 0.45}]},
)


@pytest.fixture
def two_loads():
    """Two scenes; of the second no volume is known, and torque at one speed."""
    peak = Peak(4, 0, 0.33, numbers={"force": 40.0}, errors={"force": 2.0})
    lines = {"torque": np.array([0.1, 0.2]), "worn_volume": np.array([1e-8, 3e-8])}
    of = loads.Loads("one", np.array([0.3, 0.35]), lines, [peak], 10.0)
    return [of, of._replace(name="two", lines={"torque": np.array([0.3, np.nan])}, peaks=[])]


@pytest.fixture
def sobol_rows(tmp_path):
    """A table of 128 rows, one with a run that is not ok."""
    factors = {name: {"keys": [name], "between": [0.5, 2.0]} for name in ("gap", "K")}
    design = Sobol(samples=32, factors=factors)
    drawn = design.points()
    rows = {
        "factors": (("row", "factor"), drawn),
        "largest_amplitude": ("row", drawn @ [1.0, 2.0]),
        "largest_wear": ("row", drawn @ [3.0, 0.0]),
        "not_ok": ("row", np.eye(1, len(drawn), dtype=int)[0]),
    }
    attrs = {"format": FORMAT, "sobol": design.model_dump_json()}
    save_table(xr.Dataset(rows, attrs=attrs), tmp_path / "rows.nc")
    return SimpleNamespace(rows=tmp_path / "rows.nc")


@pytest.fixture
def design_rows():
    """Three rows of a design: in two the peak of k = 4 is reported, in one it is not."""
    of_peak = {"critical_speed": 0.34, "peak": 2.0, "wear": 3e-6, "force_peak": 50.0, "trend": 1}
    at_peak = {name: (("row", "order"), [[of, of]] * 3) for name, of in of_peak.items()}
    at_peak["reported"] = ("row", "order"), [[1, 0], [1, 0], [0, 0]]
    of_row = {"gap": [GAP] * 3, "largest_amplitude": [4e-5, 2e-5, 1e-6], "runs": [9] * 3}
    of_row |= {"largest_wear": [5e-6, 4e-6, 0.0], "not_ok": [0, 1, 0]}
    of_row |= {"f1_Hz": [F1] * 3, "why": ["", "1 sensitive", ""]}
    given = {"liner.law.K": [0.3, 0.6, 1.2], "liner.law.kind": ["plastic"] * 3}
    variables = {name: ("row", of, {"long_name": "given"}) for name, of in given.items()}
    variables |= {name: ("row", of) for name, of in of_row.items()} | at_peak
    return xr.Dataset(variables, {"row": [1, 2, 3], "order": [4, 6]})


@pytest.fixture
def over_seeds(design_rows):
    """Thirty draws of lengths with each of two standard deviations: amplitudes of 1 to 30 um."""
    many = xr.concat([design_rows.isel(row=[0])] * 60, "row").drop_vars("liner.law.kind")
    given = {"stage.longer_um.std_um": np.repeat([1.0, 3.0], 30), "stage.longer_um.seed": DRAWS}
    many = many.assign({name: ("row", of, {"long_name": "given"}) for name, of in given.items()})
    return many.assign(
        {"largest_amplitude": ("row", 1e-6 * (1 + DRAWS % 30)), "row": 1 + DRAWS}
    ).drop_vars("liner.law.K")


DRAWS = np.arange(60)


@pytest.fixture
def of_blades(sweep, rom):
    """Three blades, the second of which has half of the amplitudes, the third a quarter."""
    scene = Scene.load(ROOT / "workflow/scenes/hand-e1.yaml").but(stage={"count": 3})
    along = np.linspace(2.0, 0.5, len(SPEEDS))[:, None, None] * [[[1.0], [0.5], [0.25]]]
    along[~Response(sweep, rom).has_result] = np.nan
    variables = {
        "blade_along": (("speed_over_f1", "blade", "order"), GAP * along),
        "worst": ("speed_over_f1", np.arange(len(SPEEDS)) % 3),
    }
    staged = sweep.assign(variables).assign_coords(blade=range(3))
    return Response(staged.assign_attrs(attrs_of(scene, "mine")), rom)


def forced_by(rom, amplitude_um):
    """Forced response about the crossing with EO 4, 21 um before the liner."""
    met = crossing(rom, 4)
    orders = [{"order": 4, "amplitude_um": amplitude_um}, {"order": 9, "modal_force": [0.0, 1.0]}]
    case = of_march(
        speeds={"over_f1": (met * np.linspace(0.95, 1.05, 11)).tolist()},
        rounds=8,
        integrator=EXACT,
        damping_ratio=0.005,
        casing={"harmonics": [], "ramp_rounds": 0},
        force={"orders": orders, "from": "steady"},
        record={"spectrum_rounds": 4, "samples_per_round": 64},
    )
    return Response(swept(case, rom), rom)


@pytest.fixture(scope="module")
def of_force(coarse_rom):
    """That of which the largest reach the liner."""
    return forced_by(coarse_rom, 60.0)


def stressed(worst=None, at=(0, 0, 0), **fields):
    """A bar of one by one by three, x the long side, its tip the contact, with ``stress.vtu``'s."""
    bar = pv.ImageData(dimensions=(4, 2, 2)).cast_to_unstructured_grid()
    for rpm, of in fields.items():
        bar[f"alternating stress (Pa), {rpm.removeprefix('at_')} rpm"] = of(bar.points)
    row = {"speed_over_f1": 0.3, "rpm": worst, "trend": "steady", "at_m": at}
    row |= {"alternating": 4.1e8, "mesh": {"alternating": 0.01}}
    edges = {"LE": [3, 0, 0], "TE": [3, 1, 1]}
    told = {"worst": 0.3 if worst else None, "speeds": [row], "edges": edges}
    return bar, {"scene": "mine", "blade": "thin", **told}


@pytest.fixture(scope="module")
def modes(blade_files):  # noqa: F811
    """Five modes on the nodes of a mesh, at 100, 250, 400, ... Hz: bending, rotation of the tip."""
    points = blade_files[0].points
    turned = np.cross([1.0, 0.0, 0.0], points - points.mean(axis=0))
    across = np.tile([0.0, 1.0, 0.0], (len(points), 1))
    omega = 2 * np.pi * (100.0 + 150.0 * np.arange(5))[None]
    of = {"residuals": omega, "compliance": omega, "shapes": np.array([across] + 4 * [turned])}
    at = {"speeds": np.zeros(1), "coordinates": points, "provenance": PROVENANCE}
    return blade_files[0], FullModel(omega=omega, **of, **at)


def at_the_tip(points):
    return 9e8 * (points[:, 0] == 3)


def at_one_side(points):
    return 4e8 * (points[:, 1] == 1)


AT_ONE_SIDE = stressed(3133, (1, 1, 1), at_3133=at_one_side, at_5400=at_the_tip)
FIGURES = {
    "fig02": lambda get: blade_and_patches.draw(*get("blade_files")),
    "fig03": lambda get: marked.crossings(apart(get("rom")), get("check")),
    "fig04": lambda get: footprint.draw(*read(footprint, get("footprint_files"))),
    "fig05": lambda get: laws.draw(),
    "fig06": lambda get: compared.shapes(*get("shapes")),
    "fig07": lambda get: compared.wear(*read(compared, get("densities"), "wear")),
    "fig08": lambda get: compared.displacement(*read(compared, get("histories"), "displacement")),
    "fig10": lambda get: spectra.over_speeds(get("seen")),
    "fig10 with twins": lambda get: spectra.over_speeds(get("twinned")),
    "spectra in rpm": lambda get: spectra.over_speeds(get("of_user")),
    "wear in rpm": lambda get: wear.over_speeds(get("of_user")),
    "gauge": lambda get: spectra.of_gauge(get("strained")),
    "fig11": lambda get: wear.over_speeds(get("seen")),
    "fig11 with twins": lambda get: wear.over_speeds(get("twinned")),
    "fig12": lambda get: compared.profiles([get("seen"), named(get("twinned"), "paper-e10")]),
    "fig13": lambda get: coatings.peaks(get("grid")),
    "fig13-k6": lambda get: coatings.peaks(get("grid"), order=6),
    "fig16": lambda get: compared.spectrograms(
        *read(compared, get("spectrogram_files"), "spectrograms")
    ),
    "modes": lambda get: modes_at_rest.draw(*get("modes")),
    "gap": lambda get: loads.gap(get("rest")),
    "haigh": lambda get: stress.haigh(*STRESSES),
    "loads": lambda get: loads.panels(get("two_loads"), F1, "mine"),
    "long times": lambda get: coatings.through_peak(
        *read(coatings, get("long_files"), "through_peak")
    ),
    "design": lambda get: designs.draw(get("design_rows")),
    "sensitivity": lambda get: designs.sensitivity(*read(designs, get("sobol_rows"))),
    "distribution": lambda get: designs.distribution(get("over_seeds")),
    "blades": lambda get: blades.draw(get("of_blades")),
    "forced": lambda get: forced.draw(get("of_force")),
    "stress": lambda get: stress.draw(*AT_ONE_SIDE),
    "mesh": lambda get: mesh_convergence.draw(get("of_meshes")),
    "stability": lambda get: stability.draw([*ENGAGED, *INTERMITTENT]),
    "worst": lambda get: coatings.growth(*read(coatings, get("cases"), "growth")),
}


@pytest.fixture
def figure(request):
    """Return a function of a name in ``FIGURES``: the figure, drawn once."""

    def figure(name):
        if name not in DRAWN:
            DRAWN[name] = FIGURES[name](request.getfixturevalue)
        return DRAWN[name]

    return figure


DRAWN = {}


@pytest.mark.parametrize("name", FIGURES)
def test_a_figure_has_its_labels_and_nothing_is_cut_or_hidden(name, figure):
    assert faults(figure(name)) == []


def test_faults_of_a_figure_are_found():
    drawn, axes = style.subplots(style.SINGLE, 2.0)
    axes.text(0.5, 0.5, "one")
    axes.text(0.5, 0.5, "another")
    axes.text(0.9, 0.9, "far beyond the edge of the figure").set_in_layout(False)
    axes.set_xlabel("speed")
    found = [fault.split(":")[0] for fault in faults(drawn)]
    assert found == ["cut off", "over one another", "no unit", "no label"]


def points(axes, marker):
    """Where ``axes`` shows ``marker``, (n, 2)."""
    lines = [line for line in axes.lines if line.get_marker() == marker]
    return np.concatenate([np.reshape(line.get_xydata(), (-1, 2)) for line in lines])


def heights(axes, number=None):
    """Values of the first lines."""
    return [line.get_ydata() for line in axes.lines[:number]]


def at_speeds(line, *speeds):
    """Values of a line there."""
    values = dict(line.get_xydata())
    return [values[speed] for speed in speeds]


def cell_of_order_4(axes):
    """Middle of the cell of the map at the peak of k = 4, and its value."""
    (mapped,) = axes.collections
    cell = 2 * list(SPEEDS).index(PEAK_4)  # the empty ones between speeds count
    corners = mapped.get_coordinates()[cell : cell + 2, 40:42].mean(axis=(0, 1))
    return [*corners, mapped.get_array().reshape(2 * len(SPEEDS) - 1, -1)[cell, 40]]


def colours_of(mapped, speed, angle):
    """Colours of a map at a speed and angle, and where there is no run."""
    corners = mapped.get_coordinates()
    column = np.searchsorted(corners[0, :, 0], speed) - 1
    row = np.searchsorted(corners[:, 0, 1], angle) - 1
    value = mapped.get_array().reshape(len(corners) - 1, -1)[row, column]
    return [mapped.to_rgba(value)[:3], mpl.colors.to_rgb(mapped.axes.get_facecolor())]


def at_own_size(axes):
    """Errors of the blade's own mesh."""
    return np.array([line.get_ydata()[OWN] for line in axes.lines[:11]])


def scale_beside(axes, unit):
    """Ends of the second axis in a unit, over those of the axis that it stands beside."""
    (name, second) = next(
        (name, second)
        for second in axes.child_axes
        for name in ("x", "y")
        if unit in getattr(second, f"get_{name}label")()
    )
    return np.divide(*(getattr(one, f"get_{name}lim")()[1] for one in (second, axes)))


def hats_of(axes):
    """Hats of the patches along the chord, and where their tops are."""
    hats = [line for line in axes.lines if line.get_marker() != "o"]
    values = np.array([np.interp(np.linspace(0, 1, 23), *line.get_data()) for line in hats])
    return values.sum(axis=0), [line.get_xdata()[line.get_ydata().argmax()] for line in hats]


def loops_of(axes):
    """Stress-strain paths (laws, points, 2) of the compared laws."""
    return np.array([line.get_xydata() for line in axes.lines]).reshape(4, -1, 2)


def distances(axes):
    """From the undistorted casing inwards: of the casing, and of the tip."""
    casing, around, tip = (line.get_ydata() for line in axes.lines[:3])
    return around - casing, around - tip


def band_of(axes):
    """Ends of the angles at which the casing closes the gap."""
    (band,) = axes.collections
    return [[path.vertices[:, 0].min(), path.vertices[:, 0].max()] for path in band.get_paths()]


ALPHA = 0.35 / 1.45  # plastic strain of the explained law: E = 1, K = 0.45, sigma_Y = 0.15 to 0.5
THETA = np.radians(np.linspace(0, 360, 721))
CLOSING = 1.75 * ((1 + np.cos(2 * THETA)) / 2) ** 2  # the casing of two diameters
HALF = np.degrees(np.arccos((1 / 1.75) ** 0.25))  # width at which it closes the gap
FULL = np.sqrt(np.add([[1], [16], [16]], STIFFENING * np.linspace(0, 0.4, 5) ** 2))
FULL[1, 3] /= 1 - 0.0075
OVER_161 = STIFFENING * np.linspace(0, 0.4, 161) ** 2
PROFILE = 1 + np.cos(2 * np.pi * 4 * np.arange(RODS + 1) / RODS)
NUMBERS = {  # by figure and what is shown: the numbers that are drawn, and what they are
    ("fig02", "sum of the hats"): (lambda drawn: hats_of(drawn.axes[2])[0], [1] * 23),
    ("fig02", "tops of the hats"): (lambda drawn: hats_of(drawn.axes[2])[1], hat_nodes(PATCHES)),
    ("fig04", "radial scale that is stated"): (
        lambda drawn: (
            [float(axes.get_title(loc="right").split()[-1]) for axes in drawn.axes]
            / np.array([axes.get_aspect() for axes in drawn.axes])
        ),
        [1 / (GAP * 1e3)] * 2,
    ),
    ("fig05", "strains named"): (lambda drawn: drawn.axes[0].get_xticks(), [0, ALPHA, 0.5]),
    ("fig05", "stresses named"): (
        lambda drawn: drawn.axes[0].get_yticks(),
        [0, 0.15, 0.15 + 0.45 * ALPHA],
    ),
    ("fig05", "largest stress of compared laws"): (
        lambda drawn: loops_of(drawn.axes[1])[:, :, 1].max(axis=1),
        [0.01] * 4,
    ),
    # (sigma - sigma_Y) / K in %, none where elastic
    ("fig05", "strain that remains"): (
        lambda drawn: loops_of(drawn.axes[1])[:, -1, 0],
        [1 / 4.55, 0, 1 / 0.45, 1 / 0.45],
    ),
    ("fig05", "largest strain of plastic laws"): (
        lambda drawn: loops_of(drawn.axes[1])[[0, 2, 3], :, 0].max(axis=1),
        [(E + K) / (E * K) for E, K in ((10, 4.55), (10, 0.45), (1, 0.45))],
    ),
    ("fig06", "two diameters"): (lambda drawn: drawn.axes[2].lines[0].get_ydata(), CLOSING),
    ("fig06", "two and five diameters"): (
        lambda drawn: drawn.axes[3].lines[0].get_ydata(),
        CLOSING + np.cos(5 * THETA) / 2,
    ),
    # around the undistorted casing, one gap outside the tip
    ("fig06", "distortion around the casing"): (
        lambda drawn: np.divide(*(distances(drawn.axes[0]))),
        CLOSING,
    ),
    ("fig06", "angles of a closed gap"): (
        lambda drawn: np.round(np.divide(band_of(drawn.axes[2]), 0.5)) * 0.5,
        np.round(np.divide([[0, HALF], [180 - HALF, 180 + HALF], [360 - HALF, 360]], 0.5)) * 0.5,
    ),
    ("fig03", "crossings of f1"): (
        lambda drawn: points(drawn.axes[0], "s"),
        [[1, k] / np.sqrt(k**2 - STIFFENING) for k in (4, 5, 6, 7)],
    ),
    ("fig03", "frequencies of the full model"): (
        lambda drawn: points(drawn.axes[1], "o")[:, 1],
        FULL.ravel(),
    ),
    ("fig03", "frequencies of the reduced model"): (
        lambda drawn: heights(drawn.axes[1], 3),
        np.sqrt(np.add([[1], [16], [32]], OVER_161)),
    ),
    ("fig03", "rpm of the Campbell diagram"): (
        lambda drawn: scale_beside(drawn.axes[0], "speed (rpm)"),
        60 * F1,
    ),
    ("fig03", "Hz of the Campbell diagram"): (
        lambda drawn: scale_beside(drawn.axes[0], "frequency (Hz)"),
        F1,
    ),
    ("fig07", "worn profile of the finer liner"): (
        lambda drawn: drawn.axes[0].lines[1].get_ydata(),
        0.9 * PROFILE,
    ),
    # a tenth; a cosine over 32 rods, straight between: (2 pi / 32)^2 / 8 sqrt(8/15 / 2 / 1.5) of it
    ("fig07", "differences of two densities in %"): (
        lambda drawn: [float(axes.get_title().split()[-2]) for axes in drawn.axes],
        [9.9, 0.2],
    ),
    ("fig08", "displacements of the first rounds"): (
        lambda drawn: heights(drawn.axes[2]),
        [CYCLES[: 5 * SAMPLES]] * 3,
    ),
    ("fig08", "time of the last round"): (
        lambda drawn: drawn.axes[1].lines[0].get_xdata(),
        TIME[-SAMPLES:],
    ),
    ("fig08", "displacement in the last round"): (
        lambda drawn: drawn.axes[1].lines[0].get_ydata(),
        0.9 * CYCLES[-SAMPLES:],
    ),
    ("fig08", "differences of three steps in %"): (
        lambda drawn: re.findall(r"(\d+) %", drawn.axes[3].get_title()),
        ["20", "10"],
    ),
    ("fig10", "peaks on the map"): (
        lambda drawn: points(drawn.axes[0], "o"),
        [[PEAK_6, 6 * PEAK_6], [PEAK_4, 4 * PEAK_4]],
    ),
    ("fig10", "cell of an engine order"): (
        lambda drawn: cell_of_order_4(drawn.axes[0]),
        [PEAK_4, 4 * PEAK_4, 3.02],
    ),
    ("fig10", "f1 on the map"): (
        lambda drawn: drawn.axes[0].lines[0].get_ydata(),
        np.sqrt(1 + OVER_161),
    ),
    ("fig10", "amplitudes of the peaks"): (
        lambda drawn: points(drawn.axes[1], ".")[:, 1],
        [2.02, 3.02],
    ),
    ("fig10", "µm of the amplitudes"): (
        lambda drawn: scale_beside(drawn.axes[1], "µm"),
        1e6 * GAP,
    ),
    ("spectra in rpm", "round speeds at the ticks"): (
        lambda drawn: [float(tick.get_text()) for tick in drawn.axes[1].get_xticklabels()],
        [0, 500, 1000, 1500, 2000],
    ),
    ("spectra in rpm", "where 1000 rpm are"): (
        lambda drawn: drawn.axes[1].get_xticks()[2],
        1000 / 60 / F1,
    ),
    ("spectra in rpm", "round frequencies at the ticks"): (
        lambda drawn: [float(tick.get_text()) for tick in drawn.axes[0].get_yticklabels()],
        [0, 50, 100, 150, 200, 250],
    ),
    ("spectra in rpm", "amplitudes of the peaks in µm"): (
        lambda drawn: points(drawn.axes[1], ".")[:, 1],
        [1e6 * GAP * 2.02, 1e6 * GAP * 3.02],
    ),
    ("spectra in rpm", "cell of an engine order in µm"): (
        lambda drawn: cell_of_order_4(drawn.axes[0]),
        [PEAK_4, 4 * PEAK_4, 1e6 * GAP * 3.02],
    ),
    ("spectra in rpm", "gaps beside the amplitudes"): (
        lambda drawn: scale_beside(drawn.axes[1], "over gap"),
        1e-6 / GAP,
    ),
    ("gauge", "microstrain along the engine order"): (
        lambda drawn: next(
            line.get_ydata() for line in drawn.axes[1].lines if line.get_label() == "EO 4"
        ),
        100 * np.linspace(0.1, 0.4, 7) / 0.4,
    ),
    ("gauge", "what is measured, and its unit, are named"): (
        lambda drawn: [
            any(name in axes.get_ylabel() for axes in axes_of)
            for name, axes_of in (
                ("(µε)", drawn.axes[1:2]),
                ("strain, gauge root (µε)", drawn.axes),
            )
        ],
        [True, True],
    ),
    ("gauge", "frequencies of the map"): (
        lambda drawn: drawn.axes[0].get_ylim(),
        [0, spectra.SHOWN_STRAIN],
    ),
    ("wear in rpm", "deepest wear in µm"): (
        lambda drawn: at_speeds(drawn.axes[1].lines[0], PEAK_4, SPEEDS[FAILED]),
        [1e6 * GAP * 3, np.nan],
    ),
    ("fig11", "rpm of the wear map"): (
        lambda drawn: scale_beside(drawn.axes[2], "speed (rpm)"),
        60 * F1,
    ),
    ("fig11", "white is without wear, grey without a run"): (
        lambda drawn: colours_of(drawn.axes[0].collections[0], 0.1, 90),
        [[1, 1, 1], [0.88, 0.88, 0.88]],
    ),
    ("fig12", "µm of the profiles"): (lambda drawn: scale_beside(drawn.axes[0], "µm"), 1e6 * GAP),
    ("modes", "frequencies in Hz"): (
        lambda drawn: [axes.get_title().splitlines()[1].split()[0] for axes in drawn.axes[:5]],
        ["100", "250", "400", "550", "700"],
    ),
    ("fig11", "crossings above the wear map"): (
        lambda drawn: points(drawn.axes[0], "v")[:, 0],
        [1 / np.sqrt(36 - STIFFENING), CROSSING_4, PEAK_6, PEAK_4],
    ),
    ("fig11", "deepest wear"): (
        lambda drawn: at_speeds(drawn.axes[1].lines[0], PEAK_4, SPEEDS[FAILED]),
        [3, np.nan],
    ),
    ("fig11", "worn lobes"): (
        lambda drawn: at_speeds(drawn.axes[2].lines[0], PEAK_4, PEAK_6, 0.1),
        [4, 6, 2],
    ),
    ("fig12", "profiles at the peaks"): (
        lambda drawn: heights(drawn.axes[0], 2),
        [[*3 * worn(4), 3]] * 2,
    ),
    ("fig12", "where two diameters come inwards"): (
        lambda drawn: [s[0, 0] for s in drawn.axes[0].collections[0].get_segments()],
        [0, 180, 360],
    ),
    ("fig13", "amplitudes over the coatings"): (
        lambda drawn: drawn.axes[0].images[0].get_array().filled(-1),
        [[1.2, 2, -1], [1, 0.5, 0.7]],
    ),
    ("fig16", "amplitude at the peak"): (
        lambda drawn: drawn.axes[0].collections[0].get_array().max(),
        1.0,
    ),
    ("fig16", "begin of the first window"): (
        lambda drawn: drawn.axes[0].collections[0].get_coordinates()[0, 0, 0],
        1 - 1 / 32,
    ),
    ("fig16", "natural frequencies over the axis"): (
        lambda drawn: [text.xy[1] for text in drawn.axes[0].texts[:2]],
        np.sqrt([1 + STIFFENING * 0.35**2, 16 + STIFFENING * 0.35**2]) / 20,
    ),
    ("fig16", "maps of a peak without a result"): (lambda drawn: len(drawn.axes[1].collections), 0),
    ("mesh", "errors of ten modes and the tip, over those made"): (
        lambda drawn: np.round(at_own_size(drawn.axes[0]) / [*100 * SLOPE, 0.02], 2),
        [1] * 11,
    ),
    ("gap", "gaps running and at rest"): (
        lambda drawn: heights(drawn.axes[0]),
        [[70, 50], [80, 80], [100, 60], [120, 120]],
    ),
    ("loads", "force at a peak"): (
        lambda drawn: drawn.axes[0].containers[0].lines[0].get_xydata(),
        [[0.33, 40.0]],
    ),
    ("loads", "torque of both scenes"): (
        lambda drawn: heights(drawn.axes[1]),
        [[0.1, 0.2], [0.3, np.nan]],
    ),
    ("loads", "worn volume in mm3"): (lambda drawn: heights(drawn.axes[2], 1), [[10, 30]]),
    # 1 mm3 is 1e-9 m3, over 0.1 m2
    ("loads", "opening of the gap"): (
        lambda drawn: scale_beside(drawn.axes[2], "worn depth"),
        0.01,
    ),
    ("haigh", "stresses of every speed that does not grow, MPa"): (
        lambda drawn: drawn.axes[1].lines[0].get_xydata(),
        [[300, 20], [-40, 30]],
    ),
    ("haigh", "those of a motion that grows"): (
        lambda drawn: drawn.axes[1].lines[1].get_xydata(),
        [[20, 10]],
    ),
    ("haigh", "the peak"): (lambda drawn: drawn.axes[1].lines[2].get_xydata(), [[-40, 30]]),
    ("haigh", "endurance, and yield in compression"): (
        lambda drawn: np.interp([-900, -450, -400, 0, 500], *drawn.axes[0].lines[0].get_data()),
        [0, 450, 500, 500, 250],
    ),
    ("design", "amplitude and wear of the rows in µm, over what they change"): (
        # the second has a run that is not ok, and another mark
        lambda drawn: [np.vstack([of.get_xydata() for of in a.lines]).T for a in drawn.axes],
        [[[0.3, 1.2, 0.6], [40, 1, 20]], [[0.3, 1.2, 0.6], [5, 0, 4]]],
    ),
    ("long times", "amplitude after so many rounds"): (
        lambda drawn: drawn.axes[0].lines[1].get_xydata(),
        [[20, 2.0], [200, 2.2], [2000, 2.3]],
    ),
    ("long times", "amplitude and wear of the run-up"): (
        lambda drawn: [axes.lines[1].get_ydata() for axes in drawn.axes[1:]],
        [[0.1, 0.2, 4.0], [0.5, 0.5, 2.0]],
    ),
    ("stress", "scale of the stress in MPa"): (lambda drawn: drawn.axes[2].get_xlim(), (0, 400)),
    ("worst", "growth of the worst cases"): (
        lambda drawn: [line.get_ydata()[:6] for line in drawn.axes[0].lines[:2]],
        [[0.1, 0.2, 0.3, 0.4, 0.5, np.nan], [1.5] * 6],
    ),
    ("worst", "amplitude of the rigid casing"): (
        lambda drawn: drawn.axes[0].lines[2].get_xydata(),
        [[0, 0.8], [200, 0.8]],
    ),
}


@pytest.mark.parametrize(("name", "shown"), NUMBERS)
def test_a_figure_shows_its_numbers(name, shown, figure):
    drawn, expected = NUMBERS[name, shown]
    made = figure(name)
    made.draw_without_rendering()
    np.testing.assert_allclose(
        np.asarray(drawn(made), float), np.asarray(expected, float), 1e-5, 1e-9
    )


def test_bars_are_the_indices(sobol_rows):
    (rows,) = read(designs, sobol_rows)
    found = indices(rows, ["largest_amplitude", "largest_wear"])
    drawn = designs.sensitivity(rows)
    for i, axes in enumerate(drawn.axes):
        bars = [[bar.get_height() for bar in of] for of in axes.containers]
        np.testing.assert_allclose(bars, [found.first[i], found.total[i]])
    assert drawn.legends[0].get_title().get_text().startswith("128 rows, 1 with runs not ok")


def test_the_table_of_a_design_has_its_reported_peaks_in_rpm_and_micrometres(design_rows):
    heads, first, _, third = list(csv.reader(designs.csv(design_rows).splitlines()))
    one, without = (dict(zip(heads, line, strict=True)) for line in (first, third))
    assert (one["row"], one["liner.law.K"], one["liner.law.kind"]) == ("1", "0.3", "plastic")
    assert (one["largest amplitude (µm)"], one["deepest wear (µm)"]) == ("40", "5")
    assert (one["EO 4 critical speed (rpm)"], one["EO 4 motion"]) == ("2040", "growing")
    assert (one["EO 4 amplitude (µm)"], one["EO 4 peak force (N)"]) == ("40", "50")
    assert without["EO 4 critical speed (rpm)"] == without["EO 4 motion"] == ""
    assert not any(head.startswith("EO 6") for head in heads)


def test_the_table_of_gauges_has_static_and_total_values_of_each_grid(strained):
    rows = [*csv.DictReader(spectra.gauges_csv(strained.sweep).splitlines())]
    assert [(row["speed_over_f1"], row["gauge"]) for row in rows[:3]] == [
        ("0.1", "root"), ("0.1", "tip"), ("0.15", "root"),
    ]  # fmt: skip
    last = {name: float(of) for name, of in rows[-2].items() if name not in ("gauge", "status")}
    assert last == pytest.approx(
        {
            "speed_over_f1": 0.4,
            "speed (rpm)": 2400,
            "static strain (µε)": -20,
            "largest strain (µε)": 80,
            "least strain (µε)": -120,
            "vibratory strain (µε)": 100,
            "static stress (MPa)": 5,
            "largest stress (MPa)": 15,
            "least stress (MPa)": -5,
            "vibratory stress (MPa)": 10,
        }
    )


def test_a_design_that_changes_words_alone_is_drawn_over_its_rows(design_rows):
    drawn = designs.draw(design_rows.drop_vars("liner.law.K"))
    ok, not_ok = drawn.axes[0].lines
    assert ok.get_xdata().tolist() == [1, 3] and not_ok.get_xdata().tolist() == [2]
    assert drawn.legends[0].get_title().get_text() == "3 rows, 0 refused" and faults(drawn) == []


def words(axes):
    """Text of each cell by column and row, from the upper left, and which are bold."""
    found = {text.get_position(): text.get_text() for text in axes.texts}
    return found, [
        at for at, text in zip(found, axes.texts, strict=True) if text.get_fontweight() == "bold"
    ]


TEXTS = {  # of the cells of the grid: by rows, and which are bold
    "fig13": (["1.20", "2.00†", "-", "1.00", "(0.50)", "0.70*"], [(1, 0)]),
    "fig13-k6": (["0.40", "-", "-", "0.90", "(0.30)", "0.20"], [(0, 1)]),
}


@pytest.mark.parametrize("name", TEXTS)
def test_cells_of_the_grid_have_their_numbers_and_marks(name, figure):
    found, bold = words(figure(name).axes[0])
    assert ([found[x, y] for y in (0, 1) for x in (0, 1, 2)], bold) == TEXTS[name]


def test_a_grid_without_any_peak_is_drawn(grid):
    grid["cases"] = [case | {"peaks": {"4": None, "6": None}} for case in grid["cases"]]
    found, _ = words(coatings.peaks(grid).axes[0])
    assert {*found.values()} == {"-"}


@pytest.mark.parametrize("status", ["sensitive", "unstable"])
def test_a_run_without_a_valid_result_is_labelled(densities, tmp_path, status):
    path = save_runs(tmp_path / "c.nc", [0.35, 0.2], [worn(4)] * 2, status=status)
    runs = read(compared, SimpleNamespace(coarse=densities.coarse, fine=path), "wear")
    (axes, *_) = compared.wear(*runs).axes
    assert status in axes.get_title()
    assert ("no result" in axes.get_title()) is (status == "unstable")


def test_a_sweep_in_the_figures_units(seen):
    """Moduli in pascals; hand-e1: unit 8 GPa, E = 1, K = 0.45, sigma_Y = 1e-8."""
    label = r"plastic, $E$ = 8 GPa, $K$ = 3.6 GPa, $\sigma_Y$ = 80 Pa"
    assert seen.title == f"scene paper-e1, blade reference: {label}"
    np.testing.assert_allclose(seen.spectrum[0, 20], 0.5)
    np.testing.assert_allclose(seen.wear[SPEEDS == PEAK_4][0], 3 * worn(4), atol=1e-12)
    assert [(p.k, p.Omega_c) for p in seen.peaks] == [(6, PEAK_6), (4, PEAK_4)]
    assert seen.of_f1(4).crossing == pytest.approx(CROSSING_4, abs=1e-8)


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


def test_figure_summary_and_claim_name_the_same_peaks(sweep, rom, seen, of_user):
    marked = [(peak.k, peak.Omega_c, peak.amplitude) for peak in seen.peaks]
    told = asked(sweep, rom)
    judged = coating(sweep, rom)["peaks"]
    rows = [{"rpm": 60 * F1 * peak.Omega_c, "um": 1e6 * GAP * peak.amplitude} for peak in told]
    lengths, _ = of_user.units["length"]
    for row, peak in zip(rows, of_user.peaks, strict=True):
        assert speed_text(of_user, peak) == f"{row['rpm']:.0f} rpm"
        assert lengths.scale * peak.amplitude == pytest.approx(row["um"], rel=1e-12)
    assert seen.units == {name: pair[::-1] for name, pair in of_user.units.items()}
    assert [(peak.k, peak.Omega_c, peak.amplitude) for peak in told] == marked
    assert [peak.lobes for peak in told] == [6, 4]
    away = [(end["over_f1"], end["lobes"], end["status"]) for end in ends(sweep)]
    assert away == [(0.02, 2, "ok"), (0.4, 2, "ok")]
    claimed = [(k, judged[str(k)]["Omega_c"], judged[str(k)]["amplitude"]) for k, *_ in marked]
    assert claimed == marked and all(judged[str(k)]["clear"] for k, *_ in marked)


def test_an_operating_line_is_at_its_speed(seen, rom, check):
    of = {"lines": {"design": 20 * rom.f1}, "modes": 2, "orders": [4], "excited": {}}
    diagram = campbell.draw(rom, check, operating=of)
    for axes in (*diagram.axes[:2], spectra.over_speeds(seen, operating=of).axes[1]):
        assert any(line.get_xdata() == pytest.approx([1 / 3, 1 / 3]) for line in axes.lines)


def test_blades_of_a_stage_are_drawn_by_number_and_speed(of_blades, figure):
    """The map and the lines of most, median and least; none at speeds without a result."""
    top, below, *_ = figure("blades").axes
    has_result = of_blades.has_result
    (mesh,) = top.collections
    cells = np.ma.filled(mesh.get_array(), np.nan)[:, ::2]
    most = np.where(has_result, np.linspace(2.0, 0.5, len(SPEEDS)), np.nan)
    np.testing.assert_allclose(cells, np.outer([1, 0.5, 0.25], most), rtol=1e-12)
    for line, share in zip(below.lines, [1, 0.5, 0.25], strict=True):
        np.testing.assert_allclose(line.get_ydata(), share * most)
    worst = np.where(has_result, np.arange(len(SPEEDS)) % 3, np.nan)
    np.testing.assert_array_equal(points(top, "o")[:, 1], worst)


def test_forced_response_is_drawn_with_and_without_rub(of_force, figure):
    """Without contact the runs lie on the closed form, open; rubs are filled, and below it."""
    axes, *_ = figure("forced").axes
    alone, rubs, free = axes.lines[:3]
    touched = of_force.status != "no-contact"
    assert 2 < touched.sum() < len(touched)
    assert len(rubs.get_xdata()) == touched.sum()
    closed_form = np.interp(of_force.speeds, alone.get_xdata(), alone.get_ydata())
    np.testing.assert_allclose(free.get_ydata(), closed_form[~touched], rtol=1e-5)
    assert (rubs.get_ydata() < 0.9 * closed_form[touched]).any()
    assert closed_form.max() == pytest.approx(60e-6 / leading_gap(of_force.sweep), rel=1e-4)
    assert [text.get_text() for text in axes.get_legend().get_texts()] == [
        *("EO 4", "EO 9", "without contact")
    ]


def test_forced_peak_without_contact_is_a_critical_speed(coarse_rom):
    """Of mode 1 at its crossing, with that amplitude, of runs in which the tip does not touch."""
    without = forced_by(coarse_rom, 15.0)
    assert {*without.status} == {"no-contact"}
    (peak,) = without.peaks
    assert (peak.k, peak.modes) == (4, (1,))
    assert peak.over_crossing == pytest.approx(1, rel=1e-9)
    assert peak.amplitude * leading_gap(without.sweep) == pytest.approx(15e-6, rel=1e-3)


def test_quantiles_over_seeds_are_told_apart_for_other_columns(over_seeds):
    rows = list(csv.DictReader(designs.quantiles(over_seeds).splitlines()))
    of_amplitude = [row for row in rows if row["number"] == designs.LARGEST]
    assert [row["stage.longer_um.std_um"] for row in of_amplitude] == ["1"] * 5 + ["3"] * 5
    shares = [float(row["quantile"]) for row in of_amplitude[:5]]
    exact = np.quantile(np.arange(1, 31), shares)
    np.testing.assert_allclose([float(row["value"]) for row in of_amplitude[5:]], exact, rtol=1e-5)
    assert {(row["draws"], row["draws_needed"]) for row in of_amplitude} == {
        ("30", needed) for needed in ("5", "29", "59", "299")
    }
    assert all(float(row["low"]) <= float(row["value"]) <= float(row["high"]) for row in rows)
    assert {row["number"] for row in rows} == {designs.LARGEST, designs.DEEPEST}


def test_draws_without_a_number_are_counted_and_words_beside_seeds_are_drawn(over_seeds):
    """Of one draw the quantile is itself; where all are refused nothing is drawn."""
    words = over_seeds.isel(row=[0, 1]).assign(
        {"liner.law.kind": ("row", ["plastic", "elastic"], {"long_name": "given"})}
    )
    values = [np.nan, 2e-6]
    lacking = words.assign({"largest_amplitude": ("row", values), "largest_wear": ("row", values)})
    rows = list(csv.DictReader(designs.quantiles(lacking).splitlines()))
    assert {(row["liner.law.kind"], row["rows"], row["draws"]) for row in rows} == {
        ("elastic", "1", "1")
    }
    drawn = designs.distribution(lacking)
    labels = [text.get_text() for text in drawn.legends[0].get_texts()]
    assert len(labels) == 1 and "liner.law.kind elastic, 1 draws" in labels[0]


def test_every_marked_peak_stands_on_a_curve(sweep, rom):
    """Also those of engine orders that are not drawn over all speeds."""
    spectrum = sweep["spectrum"].copy()
    spectrum[list(SPEEDS).index(0.17), 70] = 1.5 * GAP
    response = Response(sweep.assign(spectrum=spectrum), rom)
    assert 7 in [peak.k for peak in response.peaks]
    _, bottom, *_ = spectra.over_speeds(response).axes
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
        (spectra, "nothing", []),
        (wear, "nothing", []),
        (spectra, "twins", [(0.325, 0.345), (0.355, 0.365)]),
        (wear, "twins", [(0.355, 0.365)]),
        (spectra, "no twins", []),
        (spectra, "contact", [(0.045, 0.065)]),
        (wear, "contact", [(0.045, 0.065)]),
    ],
)
def test_speeds_without_a_sure_result_are_hatched(responses, module, lacks, bands):
    """Neighbours in one band, in each figure for its observable; the line goes on."""
    drawn = module.over_speeds(responses[lacks])
    for axes in (axes for axes in drawn.axes if axes.get_label() != "<colorbar>"):
        hatched = [patch for patch in axes.patches if patch.get_hatch()]
        spans = sorted((p.get_x(), p.get_x() + p.get_width()) for p in hatched)
        np.testing.assert_allclose(spans, sorted([*bands, (0.265, 0.275)]), atol=1e-9)
    of = responses[lacks]
    shown = along_order(of.sweep, 4) if module is spectra else of.wear.max(axis=1)
    curves = [
        line.get_ydata() for line in drawn.axes[1].lines if len(line.get_xdata()) == len(SPEEDS)
    ]
    assert any(np.array_equal(curve[SENSITIVE], shown[SENSITIVE]) for curve in curves)


def test_a_profile_that_cannot_be_predicted_is_labelled(sweep, rom, twinned):
    """The wear of twins differs at 0.36, the peak is at 0.34."""
    moved = with_twins(sweep, rom, {"wear": twinned.sweep["departure"].values[:, 0]})
    labels = [line.get_label() for line in compared.profiles([twinned, moved]).axes[0].lines[:2]]
    assert ["not predictable" in label for label in labels] == [False, True]


def test_a_sweep_that_ends_on_the_rise_gives_a_bound(sweep, rom):
    kept = sweep.isel(speed_over_f1=SPEEDS <= 0.33).assign(spectrum=10 * sweep["spectrum"])
    texts = [text.get_text() for text in spectra.over_speeds(Response(kept, rom)).axes[1].texts]
    assert any(text.startswith(r"EO 4:  $\geq$ 0.330") for text in texts)


def test_a_scene_without_spectrum_gets_a_wear_map_without_peaks(sweep, rom):
    bare = Response(sweep.drop_vars("spectrum"), rom)
    assert not wear.over_speeds(bare).axes[0].texts


def test_clamped_nodes_do_not_move_and_mode_shapes_have_one_scale():
    mesh = np.array([[0, 0, 0], [1, 0, 0], [2, 0, 0]], dtype=float)
    moved = np.array([[[2.0] * 3, [1.0] * 3]])
    spread = modes_at_rest.spread(mesh, mesh[[2, 1]], moved)
    np.testing.assert_array_equal(spread[0, :, 0], [0, 1, 2])
    np.testing.assert_allclose(
        modes_at_rest.unit_length(spread)[0, :, 0], spread[0, :, 0] / 12**0.5
    )
    refused(ValueError, modes_at_rest.spread, mesh, mesh[[2, 1]] + 0.1, moved, match="another mesh")


def test_tip_rotation_is_one_for_rotation_and_zero_for_translation():
    square = np.array([[3, y, z] for y in (0, 1) for z in (0, 1)], dtype=float)
    turn = np.cross([1.0, 0, 0], square - square.mean(axis=0))
    assert modes_at_rest.rotation_share(square, turn) == pytest.approx(1)
    assert modes_at_rest.rotation_share(square, np.ones((4, 3))) == pytest.approx(0)


def test_the_stress_is_that_of_the_worst_speed_with_the_summarys_number_at_its_place():
    """Not of the run with the largest under the contact; on the side from which it is seen."""
    fields, names = AT_ONE_SIDE
    drawn = stress.draw(fields, names)
    assert "3133 rpm, worst of the speeds: 410 MPa\n(anywhere 400 MPa)" in drawn.get_suptitle()
    marked = [axes for axes in drawn.axes if "410 MPa" in [text.get_text() for text in axes.texts]]
    assert [axes.get_title() for axes in marked] == ["pressure side"]
    (ring,) = marked[0].lines
    names_of = {text.get_text(): text.xy for text in marked[0].texts}
    np.testing.assert_allclose(names_of["410 MPa"], ring.get_xydata()[0])
    assert names_of["TE"][1] < ring.get_ydata()[0] < names_of["hub"][1]  # rows count downwards
    assert stress.seen_from(fields, np.array([1.0, 0.0, 0.5])) == "suction side"
    assert "no motion with a result" in stress.draw(*stressed()).get_suptitle()
    at = stress.corners(fields.points, names["edges"])
    assert [round(at[name][0], 1) for name in ("LE", "TE", "tip", "hub")] == [3, 3, 3, 0]
    assert (at["LE"][2], at["TE"][2]) == (0, 1)  # upstream, downstream


def test_the_least_margin_names_what_it_is_of():
    heading = stress.haigh(*STRESSES).get_suptitle()
    assert "least margin of 3 of 4 speeds 16.7 at most\nlocal, with the fillet" in heading
    steady = [row for row in STRESSES[0]["speeds"] if row["trend"] == "steady"]
    assert "16.7\n" in stress.haigh(STRESSES[0] | {"speeds": steady}, STRESSES[1]).get_suptitle()


def test_pressure_side_is_the_blades_own():
    sections = Blade.load(ROOT / "workflow/blades/reference.yaml").sections
    middle = profile_at(sections, 0.49)
    towards_pressure = (middle.bezier(-1) - middle.bezier(+1))[1]
    for side, sign in (("pressure side", 1), ("suction side", -1)):
        assert sign * (towards_pressure @ stress.VIEWS[side]) > 0


def test_the_summary_has_the_gap_at_both_ends_of_the_sweep(rest):
    told = [(end["over_f1"], end["lobes"], *end["gaps_m"]) for end in ends(rest.sweep)]
    expected = [(0.2, None, 70e-6, 100e-6), (0.3, None, 50e-6, 60e-6)]
    assert told == [pytest.approx(end) for end in expected]
    # running gaps have none
    scene = rest.scene.but(clearance={"at": "running"}).model_dump_json()
    running = rest.sweep.assign_attrs(scene=scene)
    assert [end["gaps_m"] for end in ends(running)] == [[], []]


def test_saved_figures_are_sharp_reproducible_and_restore_the_settings(tmp_path, seen):
    files = [tmp_path / "a.png", tmp_path / "a.pdf", tmp_path / "b.pdf"]
    with mpl.rc_context({"font.size": 31, "savefig.dpi": 20}):
        before = dict(mpl.rcParams)
        for pdf in files[1:]:
            style.save(wear.over_speeds(seen), files[0], pdf, origin="of a scene")
        assert dict(mpl.rcParams) == before
    picture = Image.open(files[0])
    assert (picture.size[0], picture.text["Description"]) == (300 * style.DOUBLE, "of a scene")
    assert files[1].read_bytes() == files[2].read_bytes()
    assert b"/Subject (of a scene)" in files[1].read_bytes()
    assert sorted(tmp_path.iterdir()) == sorted(files)


def test_origins_are_the_blades_and_scenes_of_the_files(tmp_path, rom, sweep):
    """Each once, also of two models with the same numbers; other inputs have none."""
    names = ("rom.nc", "same.nc", "a.nc", "b.nc", "code.py")
    model, same, one, two, code = files = [tmp_path / name for name in names]
    for path in (model, same):
        rom.save(path)
    save_sweep(sweep, one)
    other = dataclasses.replace(PROVENANCE, blade="rotor37")
    save_sweep(sweep.assign_attrs(name="mine", rom=other.dump()), two)
    code.touch()
    assert origins(files).split("; ") == [
        PROVENANCE.summary(),
        f"scene paper-e1, {PROVENANCE.summary()}",
        f"scene mine, {other.summary()}",
    ]
    assert "blade reference" in PROVENANCE.summary() and "blade rotor37" in other.summary()
    # of a sweep of an older version nothing is known
    save_sweep(sweep.drop_attrs(deep=False), two)
    assert refused(ProvenanceError, origins, [two]).file == str(two)


def test_what_lies_left_of_the_axes_is_left_out(sweep, rom):
    """A sweep that begins at 0.335, beyond the crossing of k = 4."""
    of = Response(sweep.isel(speed_over_f1=SPEEDS >= 0.335), rom)
    limits = style.limits(of.speeds)
    assert CROSSING_4 < limits[0] < 0.33
    axes = [wear.over_speeds(of).axes[0], *spectra.over_speeds(of).axes[:2]]
    assert [one.get_xlim() for one in axes] == [pytest.approx(limits)] * 3
    np.testing.assert_allclose(points(axes[0], "v")[:, 0], PEAK_4)


def test_units_change_no_limits(seen, of_user):
    """Ticks at round numbers of rpm and Hz stand within them, in all panels."""
    for draw in (spectra.over_speeds, wear.over_speeds):
        norms, engines = ([axes.get_xlim() for axes in draw(of).axes[:2]] for of in (seen, of_user))
        np.testing.assert_allclose(engines, norms)
    assert spectra.over_speeds(of_user).axes[0].get_ylim() == (0, spectra.SHOWN)


@pytest.mark.parametrize(
    ("found", "expected"),
    [
        (style.decades(2.02, 3), (0.01, 10.0)),  # a scale ends at a power of ten
        (style.decades(0.1, 2), (0.001, 0.1)),
        (style.decades(0.0, 2), (0.01, 1.0)),
        # an axis begins at 0 or a quarter of the sweep before it
        (style.limits(np.linspace(0.06, 0.4, 35)), (0.0, 0.405)),
        (style.limits(np.linspace(0.3, 0.4, 11)), (0.2675, 0.405)),
        # cells meet halfway between uneven speeds; none covers what lies between distant ones
        (style.edges(np.array([1.0, 2.0, 4.0])), (0.5, 1.5, 3.0, 5.0)),
        (style.edges(np.array([2.0])), (1.98, 2.02)),
        (style.spans(APART), ([0.495, 0.505, 0.98], [0.505, 0.53, 1.02])),
        (style.over_speeds(APART, APART)[0], (0.495, 0.505, 0.505, 0.53, 0.98, 1.02)),
        (style.over_speeds(APART, APART)[1].filled(-1), (0.5, -1, 0.51, -1, 1)),
    ],
)
def test_ends_of_scales_axes_and_cells(found, expected):
    np.testing.assert_allclose(found, expected)
