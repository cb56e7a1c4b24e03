"""Numbers of the claims from sweeps and tables, on prescribed results."""

import os
from dataclasses import dataclass
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr

from geometry.project import write_json
from simulate.errors.signals import LOBE_BLUR
from simulate.scene import Scene
from tests.simulate.scenes import scene
from workflow.paper import cases, causes, grid, measure, pages
from workflow.paper.cases import COATINGS, REPEATS, ROWS, E, K, of_coating
from workflow.paper.choices import BY_HAND, CAUSES, OF_SCENE, TIPS
from workflow.paper.laws import slopes_over_closed_form
from workflow.paper.peaks import case, worn_at

SCENES = Path(cases.__file__).parents[1] / "scenes"
RODS, GAP = 360, 2e-5
THETA = 2 * np.pi * np.arange(RODS) / RODS


def made(wear, speeds=(0.3,), **variables):
    """A sweep with the worn profile (speeds, rods) of the first of eight strips, and what is given.

    The other strips are worn to twice the gap.
    """
    profiles = np.atleast_2d(wear)[:, None]
    others = np.full((len(profiles), 7, profiles.shape[-1]), 2.0)
    worn = GAP * np.concatenate([profiles, others], axis=1)
    return xr.Dataset(
        {"wear": (("speed_over_f1", "strip", "theta"), worn), **variables},
        coords={
            "speed_over_f1": ("speed_over_f1", list(speeds)),
            "end": ("strip_end", np.linspace(0, 1, 9)),
        },
        attrs={"gap_m": GAP},
    )


def test_worn_lobes_are_counted_and_uniform_wear_has_none():
    lobes = worn_at(made(np.maximum(0, np.cos(4 * THETA))), 0)
    assert (lobes["lobes"], lobes["deepest_wear"]) == (4, 1.0)
    assert lobes["between_lobes"] == pytest.approx(0, abs=1e-3)
    half = worn_at(made(1 + np.cos(2 * THETA) / 3), 0)
    blurred = np.exp(-2 * LOBE_BLUR**2)  # of a wave of order 2 by a Gaussian
    assert half["between_lobes"] == pytest.approx((3 - blurred) / (3 + blurred), rel=1e-4)


def test_the_turn_of_a_pattern_is_the_angle_it_is_rotated_by():
    turned = np.radians([0, 3, 5, 12])
    wear = [1 + np.cos(4 * (THETA - angle)) for angle in turned]
    found = made(wear, speeds=(0.30, 0.303, 0.306, 0.309))
    assert measure._turn(found, 0.304, 4) == pytest.approx(12.0)
    assert measure._turn(found, 0.29, 4) == pytest.approx(3.0)  # of speeds within 5 % of it


@dataclass
class Polynomial:
    """K(Omega) of a single DoF with a term in Omega^4."""

    Omega_m: float = 600.0

    def stiffness(self, Omega):
        x = Omega / self.Omega_m
        return np.array([[2.0 + 3 * x**2 + 0.5 * x**4]])


def test_the_printed_K2_misses_by_seven_twelfths_of_the_second_difference():
    rom = Polynomial()
    assert measure._residual(rom, 4 / 3) < 1e-15
    # at Omega_m: (4/3 - 3/4) (K(Omega_m) - 4 K(Omega_m/2) + 3 K(0)) over K(Omega_m) - K(0)
    difference = 5.5 - 4 * (2 + 3 / 4 + 0.5 / 16) + 6
    assert measure._residual(rom, 3 / 4) == pytest.approx(7 / 12 * difference / 3.5)


def peak_at(amplitude, Omega_c, status="ok"):
    return {"amplitude": amplitude, "Omega_c": Omega_c, "status": status}


@pytest.fixture
def table():
    """A table whose amplitude is 3 at (10, 4.55) and below elsewhere, stiffening with E and K."""
    cases = [
        {
            "E": e,
            "K": k,
            "peaks": {
                "4": peak_at(3 - abs(i - 3) / 3 - abs(j - 2) / 4, 0.3 + 0.005 * i + 0.001 * j)
            },
        }
        for i, e in enumerate(E)
        for j, k in enumerate(K)
    ]
    return {"E": list(E), "K": list(K), "cases": cases}


def test_numbers_of_the_table(table):
    """Also with a case without a peak and one that is sensitive."""
    found = measure.table(table)
    assert found["worst"].items() >= {"E": 10, "K": 4.55, "amplitude": 3}.items()
    assert found["interior_over_ends"] == pytest.approx({"E": 3 / 2, "K": 3 / 2.5})
    at_corners = [found[name] for name in ("paper_worst", "softest", "stiffest")]
    assert at_corners == pytest.approx([3, 3 - 1 - 0.5, 3 - 5 / 3 - 0.5])
    assert found["rank"]["E"] == pytest.approx([1] * 5)
    assert found["rank"]["K"] == pytest.approx([1] * 9)
    assert found["predictable"] == 45
    table["cases"][0]["peaks"]["4"] = None
    table["cases"][7]["peaks"]["4"]["status"] = "sensitive"
    found = measure.table(table)
    assert found["predictable"] == 43 and np.isnan(found["softest"])


def test_growth_is_the_last_window_marched_over_that_after_twenty_rounds():
    run = {"name": "one", "status": "ok", "amplitude": [1.0, 2.0, 3.0, None]}
    found = measure.long_run({"cases": [run], "rigid": peak_at(1.2, 0.37)})
    assert found["growth"] == {"one": 1.5} and found["rigid"]["amplitude"] == 1.2
    ended = run | {"amplitude": [1.0, None, None, None]}
    assert measure.long_run({"cases": [ended], "rigid": None})["growth"] == {"one": None}


def test_profiles_of_two_densities_are_compared_at_the_rods_they_share():
    fine, coarse = np.tile(1 + np.cos(THETA), (2, 1)), np.tile(1 + np.cos(THETA[::4]), (2, 1))
    history = ("speed_over_f1", "chord", "history_time"), np.ones((2, 1, 8))
    changed = np.ones((2, 1, 8))
    changed[-1] = 1.1
    one = made(1.2 * coarse, (0.3, 0.35), history=history)
    other = made(fine, (0.3, 0.35), history=(history[0], changed))
    found = measure.densities(one, other)
    assert found["wear"] == pytest.approx([0.2, 0.2], abs=0.02)
    assert found["displacement"] == pytest.approx(0.1 / 1.1)


def test_disorder_depends_on_amplitudes_and_not_on_a_threshold():
    """0 for a tone; ln n / ln bins for n equal lines, also with weak bins between."""
    t = np.arange(10 * 512) / 512
    tone = np.cos(2 * np.pi * 4 * t)
    bins = round(20 / 0.3 * 10)
    assert measure.disorder(tone, 0.3) == pytest.approx(0, abs=1e-6)
    lines = sum(np.cos(2 * np.pi * k * t) for k in (4, 5, 6, 7))
    assert measure.disorder(lines, 0.3) == pytest.approx(np.log(4) / np.log(bins), abs=1e-6)
    above = np.cos(2 * np.pi * 100 * t)  # beyond 20 f1
    assert measure.disorder(tone + above, 0.3) == pytest.approx(0, abs=1e-6)


def test_the_mean_ratio_is_of_the_runs_with_a_result():
    dims = ("speed_over_f1", "round", "share")
    forces = {
        "force_mean": (dims, np.array([2.0, 4.0, 100.0])[:, None, None]),
        "force_tangential_mean": (dims, np.array([0.2, 0.7, 100.0])[:, None, None]),
    }
    found = made(np.ones((3, RODS)), (0.1, 0.2, 0.3), **forces)
    for second in ("ok", "sensitive"):
        status = {"status": ("speed_over_f1", ["ok", second, "diverged"])}
        assert measure._ratio(found.assign(status)) == pytest.approx(0.9 / 6)
    assert measure._ratio(found.drop_vars("force_tangential_mean")) == 0


def test_laws_load_and_unload_as_in_closed_form():
    slopes = slopes_over_closed_form()
    assert len(slopes) == 6
    assert list(slopes.values()) == pytest.approx([1] * 6, rel=1e-9)


def test_a_row_of_the_table_sweeps_each_K_and_refines_around_peaks(coarse_rom):
    speeds = {"over_f1": [0.31, 0.34, 0.37]}
    base = scene(
        speeds=speeds, record__spectrum_rounds=1, peaks={"orders": [4], "within_over_f1": 0.015}
    )
    row = grid.row(base, coarse_rom, E[0])
    assert [c["K"] for c in row] == list(K) and {c["E"] for c in row} == {E[0]}
    assert all(3 < c["runs"] <= 5 and sum(c["statuses"].values()) == c["runs"] for c in row)
    alone = case(of_coating(base, E[0], K[1]), coarse_rom, (4,))
    assert alone["peaks"] == row[1]["peaks"]
    assert row[0]["peaks"]["4"]["departure"] < 1  # its twin was marched
    assert grid.worst(grid.grid([row])) == max(row, key=lambda c: c["peaks"]["4"]["amplitude"])


def test_stiff_coatings_have_twice_the_steps():
    base = scene(integrator={"scheme": "piecewise-exact", "steps_per_round": 512})
    steps = {young: of_coating(base, young, K[0]).integrator.steps_per_round for young in E}
    assert {young for young, of in steps.items() if of == 1024} == {100.0, 181.82}
    assert set(steps.values()) == {512, 1024}


def test_the_choices_by_hand_are_those_of_their_scene():
    paper, hand = (Scene.load(SCENES / f"{name}.yaml") for name in ("paper", "hand"))
    assert paper.but(**BY_HAND, liner__law__K=0.45) == hand


def test_causes_named_after_a_factor_change_the_value_of_the_scene_by_it():
    of = {"paper": CAUSES, "paper-tangential": TIPS}
    scenes = {name: Scene.load(SCENES / f"{name}.yaml") for name in of}
    units = {c.name: c.scene(scenes[name]).liner.law.unit_Pa for name in of for c in of[name]}
    law = scenes["paper"].liner.law
    factors = {"halved": 0.5, "doubled": 2, "four times": 4}
    expected = {f"unit of E {name}": factor for name, factor in factors.items()}
    expected |= {"tilt 0.15, unit of E doubled": 2, "tilt 0.15, unit of E five times": 5}
    assert {name: units[name] / law.unit_Pa for name in expected} == pytest.approx(expected)


def _largest(name):
    """Gaps by which the casing of a cause is inward, by its name; None where it tells nothing."""
    words = name.split()
    if name.startswith("casing amplitude"):
        return float(words[2])
    return float(words[-2]) if name.endswith("gaps") else None


@pytest.mark.parametrize(("name", "otherwise"), [("paper", None), ("paper-two-five", 1.7)])
def test_causes_named_after_a_casing_have_its_largest_distortion(name, otherwise):
    """Those with two and five diameters are all as far inward as the scene says."""
    of = Scene.load(SCENES / f"{name}.yaml")
    theta = np.linspace(0, 2 * np.pi, 3601)
    for cause in CAUSES if name == "paper" else OF_SCENE[name]:
        if asked := _largest(cause.name) or otherwise:
            largest = cause.scene(of).casing.inward(theta, 1.0).max()
            assert largest == pytest.approx(asked, rel=0.01), cause.name


def test_the_file_of_a_cause_has_its_name():
    every = [cause for causes in OF_SCENE.values() for cause in causes]
    files = {cause.name: cause.file for cause in every}
    assert files["damping 1 %"] == "damping-1-percent" and files["K/E = 2"] == "K-over-E-2"
    assert len(set(files.values())) == len(every)


@pytest.mark.parametrize("name", OF_SCENE)
def test_every_scene_of_causes_has_a_study_and_takes_their_changes(name):
    """And on it every coating."""
    assert causes.BY_SCENE.keys() == OF_SCENE.keys()
    of = Scene.load(SCENES / f"{name}.yaml")
    for cause in OF_SCENE[name]:
        changed = cause.scene(of)
        for young, plastic in COATINGS.values():
            assert young == of_coating(changed, young, plastic).liner.law.E


def test_a_cause_with_another_blade_uses_that_blade(monkeypatch):
    marched = []
    monkeypatch.setattr(causes, "sweep", lambda scene, rom: marched.append(scene.blade))
    for part in COATINGS:
        monkeypatch.setitem(causes.measure.PARTS, part, lambda found, rom: {})
    for cause in CAUSES:
        causes.BY_SCENE["paper"](scene(), None, cause)
    assert marched[::2] == marched[1::2]
    assert {c.name: b for c, b in zip(CAUSES, marched[::2], strict=True) if b != "coarse"} == {
        "linear prestress": "reference-linear"
    }


def test_a_cause_of_K_has_that_of_each_coating():
    (cause,) = (cause for cause in CAUSES if cause.name == "K/E = 2")
    coated = [cause.scene(of_coating(scene(), *of)) for of in COATINGS.values()]
    assert [of.liner.law.K / of.liner.law.E for of in coated] == [2.0, 2.0]


def test_repeats_change_the_setting_in_their_name():
    base = scene(integrator={"scheme": "piecewise-exact", "steps_per_round": 512})
    assert REPEATS["half-step"].scene(base).integrator.steps_per_round == 1024
    assert REPEATS["twice-density"].scene(base).liner.rods_per_round == 1024
    assert REPEATS["richer-basis"].scene(base) == base.but(blade="reference-rich")


def test_costs_are_summed_over_the_jobs_in_the_folders_of_a_target(tmp_path):
    for folder in ("benchmarks", "logs"):
        (tmp_path / "one" / folder).mkdir(parents=True)
    for name, end, s, cpu in (("a", 1000, "10.5", "8.0"), ("b", 1012, "20.0", "15.0")):
        file = tmp_path / f"one/benchmarks/{name}.tsv"
        file.write_text(f"s\tcpu_time\n{s}\t1.0\n")  # sampled for a while
        os.utime(file, (end, end))
        used = f"used {cpu} s of CPU, 90 MB at most\n"
        (tmp_path / f"one/logs/{name}.log").write_text(used)
    folders = {"paper": [tmp_path / "one", tmp_path / "none"], "other": []}
    text = pages.cost_text(None, folders)
    assert "| paper | 2 | 22 | 23 | 20 |" in text  # from 989.5 to 1012
    assert "| other | not run |  |  |  |" in text


def as_given(monkeypatch, module):
    """Scenes and models of a module's jobs are what the rule gives."""
    same = SimpleNamespace(model_validate=lambda scene: scene, load=lambda rom: rom)
    monkeypatch.setattr(module, "Scene", same)
    monkeypatch.setattr(module, "Rom", same)


def test_the_rows_of_a_table_are_marched_by_name_and_read_back(monkeypatch, tmp_path):
    """E = 1.82, with what the rule gives."""
    as_given(monkeypatch, grid)
    monkeypatch.setattr(grid, "row", lambda *given: [*given])
    assert [*ROWS.values()] == [*E]
    assert grid.of_row(SimpleNamespace(rom="rom"), {}, "E-1.82") == [{}, "rom", 1.82]
    rows = [[{"E": e, "peaks": {"4": None}}] for e in (1.0, 1.82)]
    files = [tmp_path / f"{i}.json" for i in range(2)]
    for file, row in zip(files, rows, strict=True):
        write_json(row, file)
    assert grid.of_rows(SimpleNamespace(rows=files))["cases"] == [*rows[0], *rows[1]]


def test_a_cause_is_studied_by_the_name_of_its_file(monkeypatch):
    as_given(monkeypatch, causes)
    assert causes.STUDIES["damping-1-percent"] == (causes.BY_SCENE["paper"], CAUSES[10])
    assert causes.STUDIES["tilt-0.02"][0] is causes.tips
    monkeypatch.setitem(causes.STUDIES, "one", (lambda *given: given, "cause"))
    assert causes.of_cause(SimpleNamespace(rom="rom"), {}, "one") == ({}, "rom", "cause")


def test_lobes_away_from_the_resonances_and_at_them(coarse_rom):
    """Lobes at the ends and in between, and orders with k lobes near their crossing."""
    speeds = np.array([0.1, 0.19, 0.26, 0.34, 0.4])
    lobes = np.array([2, 6, 2, 4, 2])
    assert measure._orders_seen(coarse_rom, speeds, lambda k: lobes == k) == [4, 6]
    assert measure._orders_seen(coarse_rom, speeds, lambda k: np.zeros(5) == k) == []


def test_an_order_is_in_the_wear_where_its_harmonic_exceeds_those_beside_it(coarse_rom):
    speeds = np.array([0.1, 0.19, 0.26, 0.34, 0.4])
    wear = np.array([1 + np.cos(2 * THETA) + 0.1 * np.cos(k * THETA) for k in (4, 6, 8, 4, 6)])
    wear[3] += 0.05 * np.cos(6 * THETA) - np.cos(2 * THETA)
    found = measure._orders_in_harmonics(coarse_rom, speeds, wear)
    assert found == [4, 6]  # 8 and the last 6 are far from their crossings
    wear[3] += np.cos(2 * THETA)  # 4 is on the slope of 2
    assert measure._orders_in_harmonics(coarse_rom, speeds, wear) == [6]


def test_the_stress_is_in_MPa():
    peak = SimpleNamespace(largest={"largest_Pa": 2e8}, static={"largest_Pa": 1.5e8})
    found = measure.stress({"von_mises": peak.largest, "von_mises_of_prestress": peak.static})
    assert found == pytest.approx({"largest_MPa": 200, "of_rotation_MPa": 150})
