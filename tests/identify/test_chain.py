"""From the prior to shares of the claims, on a coarse blade with short runs."""

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from refused import refused

from simulate.errors.resolution import check_resolution
from simulate.marching import SceneError, prepare
from simulate.scene import LEADING, Scene
from workflow.identify import measured, numbers, report, shares
from workflow.identify.fits import K_TAKEN
from workflow.identify.likelihood import FITS, SHIFTS, WITH_ORDER, Fit
from workflow.identify.measured import cases, scenes_at
from workflow.identify.points import Blades, parameters_at
from workflow.identify.priors import SHAPE, sobol
from workflow.identify.shares import JUDGED, verdicts
from workflow.identify.steps import steps_per_round
from workflow.identify.table import march, tables
from workflow.paper import grid

FOLDER = Path(numbers.__file__).parents[1]
SCENES = {
    "e10": "identify-e10", "two_five": "identify-two-five", "grid": "identify-grid",
    "rigid": "identify-rigid",
}  # fmt: skip
TABLES = {"prior": (128, None), "first": (6, SHIFTS), "second": (6, WITH_ORDER)}
NAMES, BLADES = {"prior": "narrow"}, 16


def short(name):
    """A scene of the workflow with few speeds, rounds and steps."""
    scene = Scene.load(FOLDER / f"scenes/{name}.yaml")
    orders = scene.peaks.orders
    return scene.but(
        blade="coarse",
        rounds=4,
        casing__ramp_rounds=1,
        speeds={"over_f1": [0.19, 0.2, 0.21, 0.3, 0.34, 0.36, 0.38]},
        peaks={"orders": orders, "within_over_f1": 0.05},
        integrator={"scheme": "piecewise-exact", "steps_per_round": 640},
        liner={"rods_per_round": 384, "strips": 8},
        record__samples_per_round=128,
        record__spectrum_rounds=2,
    )


@pytest.fixture(scope="module", autouse=True)
def _few_candidates():
    """For draws of six points."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("workflow.identify.proposal.CANDIDATES", 2**12)
        yield


@pytest.fixture(scope="module")
def chain(coarse_rom, narrow, tmp_path_factory):
    """Three tables on blades that are alike: their points, their rows; and their fits."""
    folder, of = tmp_path_factory.mktemp("identify"), SimpleNamespace(points=[], rows=[])
    shapes = sobol(BLADES, len(SHAPE), 1).tolist()
    of.roms = [str(folder / f"results/narrow-{i}/rom-r.nc") for i in range(BLADES)]
    for i, rom in enumerate(of.roms):
        origin = replace(coarse_rom.provenance, blade=f"narrow-{i}")
        replace(coarse_rom, provenance=origin).save(rom)
    of.blades = [
        {"places": shape, "softness": 1e-6, "others": 1 + shape[0], "leading": shape[1]}
        for shape in shapes
    ]
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        for name, (number, data) in TABLES.items():
            table = numbers.table(of.rows, of.blades, narrow, number, data)
            of.rows += [
                march(
                    table, of.blades, of.roms, narrow, short("identify"), "parts",
                    {"prior": "narrow", "sample": name, "block": str(block)}, 2,
                )
                for block in range(2)
            ]  # fmt: skip
            of.points.append(table)
    of.fits = numbers.fits(of.rows, of.blades, narrow)
    of.folder = folder
    return of


def test_the_points_of_a_table_are_marched_once_on_their_blade(chain, narrow):
    """In two blocks, each of every second blade."""
    marched = tables(chain.rows, Blades.of(chain.blades, narrow))
    for table, points in zip(marched, chain.points, strict=True):
        cube = np.array(points["cube"])
        assert sorted(map(tuple, table["cube"].values)) == sorted(map(tuple, cube))
        assert table.attrs["data"] == points["data"]
    blades = [{*np.floor(BLADES * np.array(rows["cube"])[:, 0])} for rows in chain.rows[:2]]
    assert [len(of) for of in blades] == [BLADES // 2] * 2 and not blades[0] & blades[1]


def test_all_fits_weigh_the_points_of_all_tables(chain):
    found = chain.fits
    assert found["served"] in ("printed", "k = 4")
    supported = 0
    for of in FITS:
        shifts = found["fits"][of.name][SHIFTS]
        weights = np.array(shifts["weights"])
        assert len(weights) == len(found["blade"]) == 140
        assert weights.sum() == pytest.approx(1) or not weights.any()
        assert shifts["met"] >= found["fits"][of.name][WITH_ORDER]["met"] >= 0
        supported += weights.any()
        assert 0 <= shifts["blades"] <= BLADES and bool(shifts["blades"]) == bool(weights.any())
    assert supported > 0


def test_the_claims_are_judged_at_the_scene_of_each_draw(chain, monkeypatch):
    """Two draws, with the real table of coatings cut to its corners and the worst."""
    for module in (measured, grid):
        monkeypatch.setattr(module, "E", (1.0, 10.0, 181.82))
        monkeypatch.setattr(module, "K", (0.45, 4.55, 45.45))
    monkeypatch.chdir(chain.folder)
    parts = {part: short(name).model_dump(mode="json") for part, name in SCENES.items()}
    taken = {WITH_ORDER: {"medoid": 50, "draws": [7, 0, 50]}}
    fits = chain.fits | {"fits": {of.name: taken for of in FITS}}
    drawn = numbers.at_draws(fits, parts, NAMES | {"block": "0"}, 2, "measured")
    assert [*drawn] == ["50", "0"]
    for draw in drawn.values():
        assert {"e1", "e10", "two_five"} <= {*draw}
        assert set(verdicts(draw)) == set(JUDGED)
    # Of each draw: E = 1, E = 10, the other casing, the table, the bare casing
    assert len(list(Path("measured").iterdir())) == 2 * (1 + 1 + 1 + 9 + 1)


def test_stiff_coatings_have_more_steps_at_draws():
    """In the table, and in sweeps."""
    base = short("identify-grid").but(liner__law__unit_Pa=4e9)
    here = dict.fromkeys(SCENES, base) | {"e10": base.but(liner__law__E=30.0)}
    found = {(of.label, of.scene.liner.law.E): of.scene.integrator for of in cases("0", here, 4.55)}
    stiffest = max(measured.E)
    assert [E for label, E in found if label == "grid"] == [*measured.E]
    assert found["grid", stiffest].steps_per_round == steps_per_round(stiffest * 4e9) == 4096
    assert found["e10", 30.0].steps_per_round == 4096


def test_scenes_at_a_point_have_its_parameters(chain):
    values, base = parameters_at(chain.fits["values"], 0), short("identify")
    here = scenes_at({part: short(name) for part, name in SCENES.items()}, values, "narrow-1")
    assert here["e10"].liner.law.unit_Pa == values["unit_Pa"]
    assert (here["e10"].liner.law.E, here["e10"].liner.law.K) == (10.0, 4.55)
    assert {scene.damping_ratio for scene in here.values()} == {values["damping_ratio"]}
    assert {scene.blade for scene in here.values()} == {"narrow-1"}
    assert here["rigid"].liner.law.kind == "rigid" and here["grid"].casing == here["e10"].casing
    constant, second, fifth = here["two_five"].casing.harmonics
    assert (constant.order, second.order, fifth.order) == (0, 2, 5)
    ratio = fifth.amplitude_gaps / second.amplitude_gaps
    assert ratio == pytest.approx(values["fifth_over_second"])
    largest = [
        scene.casing.inward(np.linspace(0, 2 * np.pi, 7201), 1.0).max()
        for scene in (here["two_five"], here["e10"])
    ]
    assert largest == pytest.approx([values["casing_gaps"]] * 2, rel=1e-6)
    assert here["e10"].clearance.gaps(LEADING, 1.0) == base.clearance.gaps(LEADING, 1.0)


@pytest.mark.parametrize("name", SCENES.values())
def test_the_steps_of_all_scenes_resolve_their_slowest_speed(name, coarse_rom):
    scene = Scene.load(FOLDER / f"scenes/{name}.yaml")
    slowest = float(scene.speeds.omega(coarse_rom.f1).min())
    here = scene.but(blade="coarse", liner__strips=8, casing__scale=2.0)
    check_resolution(here, prepare(here, coarse_rom, slowest))
    few = prepare(here, coarse_rom, slowest, 256)
    assert refused(SceneError, check_resolution, here, few).key == "integrator.steps_per_round"


def peaks(**of):
    """Both coatings with one peak, k = 4."""
    even = {"amplitude": 1.0, "deepest_wear": 0.5, "Omega_c": 0.35}
    return {"peaks": {"4": even | of}}


def draw(ratio, deeper):
    """A draw: E = 10 over E = 1 in the peak and in the wear at k = 4; nothing else is known."""
    stiff = peaks(amplitude=ratio, deepest_wear=0.5 * deeper, largest=1.0)
    return {"e1": peaks(largest=1.0), "e10": stiff}


def test_shares_count_what_holds_and_what_holds_together():
    """Of the medoid, and of four draws of three points."""
    taken = {"medoid": 2, "draws": [6, 5, 6, 7], "effective": 3.0}
    fits = {"served": "printed", "fits": {Fit(K_TAKEN, "printed").name: {WITH_ORDER: taken}}}
    fits["values"] = {"span_mm": [10.0 * point for point in range(8)]}
    measured = [{"2": draw(2, 2), "5": draw(2, 2)}, {"6": draw(2, 0.5), "7": draw(0.5, 0.5)}]
    of = shares.numbers(fits, measured)
    assert of["draws"] == 4 and of["effective"] == 3
    assert of["best"] == 1 and of["values"] == {"span_mm": 50}  # both hold at the second, 5
    assert {*JUDGED} - {*of["missed"]} == {"C12", "C16"}
    assert (of["medoid"]["C16"], of["medoid"]["C25"]) == ("calibrated", "not judged")
    assert {"C12": 0.75, "C16": 0.25, "C20": 0}.items() <= of["holds"].items()
    assert of["together"]["C16"]["C12"] == 1 and of["together"]["C12"]["C16"] == 1 / 3
    assert np.isnan(of["together"]["C20"]["C12"])
    assert of["not judged"]["C25"] == 1 and of["not judged"]["C12"] == 0
    said = report.shares(of)
    assert "| C16 |" in said and "25 %" in said
    assert "Effective size of what is drawn from: 3." in said and "C26: `span_mm` 50." in said
