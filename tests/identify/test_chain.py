"""From the prior to shares of the claims, on a coarse blade with short runs."""

import re
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from refused import refused

from simulate.errors.resolution import check_resolution
from simulate.marching import SceneError, prepare
from simulate.scene import LEADING, Scene
from simulate.scene.design import Design
from simulate.sweeps.design_runs import Engine, march_block, row_table
from workflow.identify import measured, numbers, points, report, shares
from workflow.identify.fits import off_medoid, prior_numbers
from workflow.identify.likelihood import FITS, SHIFTS, WITH_ORDER
from workflow.identify.measured import cases, scenes_at
from workflow.identify.priors import Priors
from workflow.identify.shares import JUDGED, verdicts
from workflow.identify.steps import steps_per_round
from workflow.identify.table import sobol
from workflow.paper import grid

FOLDER = Path(numbers.__file__).parents[1]
SCENES = {
    "e10": "identify-e10", "two_five": "identify-two-five", "grid": "identify-grid",
    "rigid": "identify-rigid",
}  # fmt: skip
PRIORS = Priors.load(FOLDER / "identify/priors.yaml")
TABLES = {"prior": (64, None), "first": (6, SHIFTS), "second": (6, WITH_ORDER)}


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
def chain(coarse_rom, tmp_path_factory):
    """Three tables: their points, their rows and the files of their designs; and their fits."""
    folder, of = tmp_path_factory.mktemp("identify"), SimpleNamespace(points=[], rows=[], tables=[])
    for name, (number, data) in TABLES.items():
        table = points.table(of.points, of.rows, coarse_rom, coarse_rom, PRIORS, number, data)
        of.tables.append(folder / f"{name}.csv")
        of.tables[-1].write_text(points.csv(table))
        design = Design.of(short("identify").but(design=f"{name}.csv"), folder / "scene.yaml")
        engine = Engine.of(design, coarse_rom)
        of.points.append(table)
        of.rows.append(row_table(engine, march_block(engine, folder / "parts")))
    of.fits = numbers.fits(of.points, of.rows, PRIORS)
    return of


def test_how_far_a_scene_is_off_the_medoid():
    """Four points on a line: 0.4 is 0.275 from all in the mean, 0 is 0.475."""
    points, weights = np.array([[0.0], [0.4], [0.5], [1.0]]), [0.25] * 4
    taken = {"medoid": 1, "weights": weights}
    found = {"served": "printed", "fits": {"K = 4.55, printed": {WITH_ORDER: taken}}}
    assert off_medoid(found, points, np.array([0.4])) == pytest.approx(0)
    assert off_medoid(found, points, np.array([0.0])) == pytest.approx(0.475 / 0.275 - 1)
    taken["medoid"] = None
    assert off_medoid(found, points, np.array([0.4])) is None


def test_the_parameters_of_a_scene_are_compared_with_the_medoid():
    """The second of four points in two tables is the medoid; the scene has its values."""
    every = sobol(4, 1)
    tables = [{"points": every[:2].tolist()}, {"points": every[2:].tolist()}]
    fit = {WITH_ORDER: {"medoid": 1, "weights": [0.1, 0.6, 0.1, 0.2]}}
    found = {"served": "k = 4", "fits": {"K = 4.55, k = 4": fit}}
    of_scenes = [{name: float(of[i]) for name, of in PRIORS.values(every).items()} for i in (1, 3)]
    near, far = (numbers.of_scene(tables, found, PRIORS, of)["off_medoid"] for of in of_scenes)
    assert near == pytest.approx(0, abs=1e-9) and far > 0.1


def test_all_fits_weigh_the_points_of_all_tables(chain):
    found = chain.fits
    assert found["served"] in ("printed", "k = 4")
    supported = 0
    for of in FITS:
        shifts = found["fits"][of.name][SHIFTS]
        weights = np.array(shifts["weights"])
        assert len(weights) == 76
        assert weights.sum() == pytest.approx(1) or not weights.any()
        assert shifts["met"] >= found["fits"][of.name][WITH_ORDER]["met"] >= 0
        supported += weights.any()
    assert supported > 0


def test_the_answer_tells_what_meets_the_shifts_and_which_K_they_prefer():
    """Its numbers in their order: settings that meet them, ratios of evidence, factors."""

    def fit(deviations, evidence, both, met, low, high, size):
        ranges = {"unit_Pa": [low, 1.0, high], "casing_gaps": [low, 1.0, high / 2]}
        shifts = {"evidence": evidence, "met": met, "weights": [0.5, 0.5]}
        order = {"evidence": both, "met": met // 2, "ranges": ranges, "effective": size}
        return {SHIFTS: shifts, WITH_ORDER: order, "best": {"deviations": deviations}}

    loose = fit([0.5, -0.2], 0.4, 0.01, 2, 1, 2, 30)
    taken = fit([-1.3, 0.1], 0.2, 0.04, 0, 0.5, 4, 250)
    fits = {of.name: taken if of.K == 4.55 else loose for of in FITS}
    text = report.answer({"fits": fits, "prior": prior_numbers(PRIORS)}).replace("\n", " ")
    told = (
        "Of 2 settings", ", 2 with K = 0.45", "(1 of these", ", 0 with K = 4.55", "is 1.3 half",
        ", and 2 ", "K = 0.45 by 2.0 to 1", "K = 4.55 is preferred by 4.0 to 1", "30 and 250",
        "take 4.55", "factor of 4 (assumed: 3.5)", "by 8 (170)",
    )  # fmt: skip
    assert re.search(".*".join(map(re.escape, told)), text)


def test_the_fits_of_blades_are_listed_for_the_reading_that_was_served(chain):
    found = chain.fits
    of = numbers.blades([found, found], ["one", "other"])
    assert of["one"]["served"] == found["served"]
    served = found["fits"][f"K = 4.55, {found['served']}"][SHIFTS]
    other = of["other"]["fits"]["4.55"]
    assert (other["effective"], other["met"]) == (served["effective"], served["met"])


def test_the_claims_are_judged_at_the_scene_of_each_draw(chain, coarse_rom, monkeypatch, tmp_path):
    """Two draws of the prior, with the real table of coatings cut to its corners and the worst."""
    for module in (measured, grid):
        monkeypatch.setattr(module, "E", (1.0, 10.0, 181.82))
        monkeypatch.setattr(module, "K", (0.45, 4.55, 45.45))
    monkeypatch.chdir(tmp_path)
    coarse_rom.save(Path("results/coarse/rom-r.nc"))
    parts = {part: short(name).model_dump(mode="json") for part, name in SCENES.items()}
    given = [], chain.tables, coarse_rom, short("identify"), parts
    prior = {"draws": "prior", "block": 0, "blocks": 50, "folder": "parts"}
    drawn = numbers.at_draws(*given, **prior)
    assert [draw["point"] for draw in drawn] == [0, 50]
    for draw in drawn:
        assert {"e1 0.45", "e1 4.55", "e10", "two_five"} <= {*draw}
        assert set(verdicts(draw, "4.55")) == set(JUDGED)
    # Of each draw: two K of E = 1, E = 10, the other casing, the table, the bare casing
    assert len(list(Path("parts").iterdir())) == 2 * (2 + 1 + 1 + 9 + 1)


def test_stiff_coatings_have_more_steps_at_draws():
    """In the table, and in sweeps."""
    base = short("identify-grid").but(liner__law__unit_Pa=4e9)
    here = dict.fromkeys(SCENES, base) | {"e10": base.but(liner__law__E=30.0)}
    found = {(of.label, of.scene.liner.law.E): of.scene.integrator for of in cases("0", here, [])}
    stiffest = max(measured.E)
    assert [E for label, E in found if label == "grid"] == [*measured.E]
    assert found["grid", stiffest].steps_per_round == steps_per_round(stiffest * 4e9) == 8192
    assert found["e10", 30.0].steps_per_round == 4096


def test_scenes_at_a_point_have_its_parameters(chain, coarse_rom):
    base = short("identify")
    (point, *_) = numbers._scenes(chain.tables, base)
    here = scenes_at({part: short(name) for part, name in SCENES.items()}, point, coarse_rom.span)
    values = chain.points[0]["settings"]
    assert here["e10"].liner.law.unit_Pa == values["liner.law.unit_Pa"][0]
    assert (here["e10"].liner.law.E, here["e10"].liner.law.K) == (10.0, 4.55)
    assert {scene.damping_ratio for scene in here.values()} == {values["damping_ratio"][0]}
    assert here["rigid"].liner.law.kind == "rigid" and here["grid"].casing == point.casing
    assert [h.order for h in here["two_five"].casing.harmonics] == [0, 2, 5]
    largest = [
        scene.casing.inward(np.linspace(0, 2 * np.pi, 3601), 1.0).max()
        for scene in (here["two_five"], point)
    ]
    assert largest[0] == pytest.approx(largest[1], rel=1e-5)
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
    return {"point": 0, "e1 4.55": peaks(largest=1.0), "e10": stiff}


def test_shares_count_what_holds_and_what_holds_together():
    draws = [draw(2, 2), draw(2, 0.5)], [draw(2, 0.5), draw(0.5, 0.5)], []
    of = shares.numbers(draws, ["prior", "prior", "4.55-with-order"])["prior"]["4.55"]
    assert of["most at once"] == 2
    assert {"C12": 0.75, "C16": 0.25, "C20": 0}.items() <= of["holds"].items()
    assert of["together"]["C16"]["C12"] == 1 and of["together"]["C12"]["C16"] == 1 / 3
    assert np.isnan(of["together"]["C20"]["C12"])
    assert of["not judged"]["C25"] == 1 and of["not judged"]["C12"] == 0
