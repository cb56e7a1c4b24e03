"""Numbers of the claims from sweeps and tables, on prescribed results."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from geometry.base import write_json
from simulate.scene import Scene
from simulate.signals import LOBE_BLUR
from simulate.sweeps.sweep import sweep
from tests.simulate.scenes import scene
from workflow.many.plan import cases
from workflow.paper import grid, measure, numbers
from workflow.paper.cost import cost
from workflow.paper.grid import worn_at
from workflow.paper.laws import slopes_over_closed_form
from workflow.paper.published import E, K

WORKFLOW = Path(measure.__file__).parents[1]
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
    found = measure.long_run(peak_at(1.2, 0.37), [run])
    assert found["growth"] == {"one": 1.5} and found["rigid"]["amplitude"] == 1.2
    ended = run | {"amplitude": [1.0, None, None, None]}
    assert measure.long_run(None, [ended])["growth"] == {"one": None}


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


def test_a_coating_of_the_table_has_its_peaks_with_their_twins(coarse_rom):
    speeds = {"over_f1": [0.31, 0.34, 0.37]}
    peaks = {"orders": [4], "within_over_f1": 0.015}
    of = scene(speeds=speeds, record__spectrum_rounds=1, peaks=peaks, liner__law__E=10.0)
    runs = sweep(of, coarse_rom)
    found = grid.of_coating(runs, coarse_rom, of)
    assert (found["E"], found["K"]) == (10.0, of.liner.law.K)
    assert 3 < found["runs"] <= 5 and sum(found["statuses"].values()) == found["runs"]
    assert found["peaks"]["4"]["departure"] < 1  # its twin was marched


@pytest.fixture(scope="module")
def of_paper():
    """Cases of the experiments of the paper, by name."""
    names = ("grid", "repeats", "rotor37", "causes")
    return {name: cases(WORKFLOW / f"experiments/{name}.yaml") for name in names}


def test_the_table_has_every_coating_and_soft_ones_half_the_steps(of_paper):
    laws = {
        (case.scene.liner.law.E, case.scene.liner.law.K): case.scene.integrator.steps_per_round
        for case in of_paper["grid"]
        if case.label == "grid"
    }
    assert [*laws] == [(e, k) for e in E for k in K]
    assert {e for (e, _), steps in laws.items() if steps == 2048} == {1.0, 1.82, 4.55}
    assert {*laws.values()} == {2048, 4096}


def test_causes_named_after_a_factor_change_the_value_of_the_scene_by_it(of_paper):
    units = {
        case.row: case.scene.liner.law.unit_Pa
        for case in of_paper["causes"]
        if case.label != "rigid"
    }
    factors = {"halved": 0.5, "doubled": 2, "four times": 4}
    expected = {f"unit of E {name}": factor for name, factor in factors.items()}
    expected |= {"tilt 0.15, unit of E of the flat tip": 1, "tilt 0.15, unit of E a quarter": 16}
    found = {name: units[name] / units["as it is"] for name in expected}
    assert found == pytest.approx(expected)
    assert units["tilt 0.15, as it is"] / units["as it is"] == pytest.approx(64)


SO_FAR = {"three quarters as far": 0.75, "half as far again": 1.5}


def test_causes_of_the_casing_are_as_far_inward_as_they_say(of_paper):
    """As the scene where their name says nothing else: 2.08 gaps."""
    theta = np.linspace(0, 2 * np.pi, 3601)
    of_casing = [c for c in of_paper["causes"] if c.label == "two_five" or "casing" in c.row]
    for case in of_casing:
        (share,) = [part for name, part in SO_FAR.items() if name in case.row] or [1]
        largest = case.scene.casing.inward(theta, 1.0).max()
        assert largest == pytest.approx(2.08 * share, rel=0.01), case.row
    assert len(of_casing) == 13


def test_causes_of_K_and_of_what_was_chosen_by_hand_are_of_each_coating(of_paper):
    of = {(case.row, case.label): case.scene for case in of_paper["causes"]}
    stiff = [of["K/E = 2", label].liner.law for label in ("e1", "e10")]
    assert [law.K / law.E for law in stiff] == [2.0, 2.0] and stiff[1].E == 10.0
    hand = Scene.load(WORKFLOW / "scenes/hand-e1.yaml").but(
        blade="paper", verify={"predictable": False}
    )
    assert of["chosen by hand, K = 0.45 for E = 1", "e1"] == hand
    assert of["chosen by hand, K = 0.45 for E = 1", "e10"].liner.law.K == 4.55


def test_causes_change_the_model_where_they_say(of_paper):
    models = {case.row: (case.scene.blade, case.directions) for case in of_paper["causes"]}
    changed = {row: model for row, model in models.items() if model not in ALIKE}
    tables = [case.row for case in of_paper["causes"] if case.label in ("grid", "rigid")]
    assert changed == {
        "full interface": ("paper", "rtz"),
        "nonlinear prestress": ("paper-nonlinear", "r"),
        "two rows across the thickness": ("paper-edges", "r"),
        "tilt 0.15, blade without lean": ("paper-upright", "rt"),
        "tilt 0.15, blade leaned the other way": ("paper-forward", "rt"),
        **dict.fromkeys(tables, ("paper-wide", "r")),
    }


ALIKE = ("paper", "r"), ("paper", "rt")


def test_repeats_change_the_setting_in_their_name(of_paper):
    base = {
        case.label: case.scene for case in of_paper["repeats"] if case.names[0] == "half the step"
    }
    for case in of_paper["repeats"]:
        if case.label != "grid":
            of, half = case.scene, base[case.label]
            same = of.but(
                integrator=half.integrator,
                blade="paper",
                liner__rods_per_round=half.liner.rods_per_round,
            )
            assert same == half
    of = {(case.names[0], case.label): case.scene for case in of_paper["repeats"]}
    assert of["half the step", "e1"].integrator.steps_per_round == 8192
    assert of["half the step", "grid"].integrator.steps_per_round == 8192  # of the stiffest
    assert of["twice the density", "tilted"].liner.rods_per_round == 2 * 153911
    assert of["richer basis", "rigid"].blade == "paper-rich"


def test_the_other_blade_has_the_scenes_of_its_name(of_paper):
    """Those that may be run alone, too."""
    of = {case.label: case.scene for case in of_paper["rotor37"]}
    for label in ("e1", "e10"):
        assert of[label] == Scene.load(WORKFLOW / f"scenes/rotor37-{label}.yaml")
    assert {scene.blade for scene in of.values()} == {"rotor37-fast"}


def test_editions_are_read_from_the_rows_of_a_table(tmp_path, table):
    """Parts by the label of their scene; of the coatings their table, and their long runs."""
    long = [{"name": "worst found", "status": "ok", "amplitude": [1.0, 2.0, 3.0]}]
    rows = [
        {"names": ["half", f"E {i}"], "scene": "grid", "numbers": case}
        for i, case in enumerate(table["cases"])
    ]
    rows += [
        {"names": ["half"], "scene": "rigid", "numbers": peak_at(1.2, 0.37)},
        {"names": ["half"], "scene": "e1", "numbers": {"lobes": 2}},
        {"names": ["other"], "scene": "e1", "numbers": {"lobes": 4}},
    ]
    files = {"table": rows, "growth": {"half": long}, "model": {"model": {"n": 85}}}
    for name, values in files.items():
        write_json(values, tmp_path / f"{name}.json")
    found = numbers.editions(**{name: tmp_path / f"{name}.json" for name in files})
    assert found["half"]["grid"]["worst"]["E"] == 10
    assert found["half"]["long"]["growth"] == {"worst found": 1.5}
    assert found["half"]["e1"] == {"lobes": 2} and found["half"]["model"] == {"n": 85}
    assert found["other"] == {"e1": {"lobes": 4}, "model": {"n": 85}}
    assert numbers.editions(tmp_path / "table.json")["half"]["long"]["growth"] == {}


def test_without_peaks_an_edition_has_neither_table_nor_growth(table):
    """Where the paper's worst coating alone has none, it has the table."""
    rows = [{"names": ["one"], "scene": "grid", "numbers": case} for case in table["cases"]]
    rows.append({"names": ["one"], "scene": "rigid", "numbers": peak_at(1.2, 0.37)})
    (of_paper,) = [case for case in table["cases"] if (case["E"], case["K"]) == (10.0, 4.55)]
    of_paper["peaks"]["4"] = None
    assert numbers.numbers_of(rows, numbers.growth_of(rows))["one"].keys() == {"grid"}
    for case in table["cases"]:
        case["peaks"]["4"] = None
    assert numbers.numbers_of(rows, numbers.growth_of(rows)) == {"one": {}}


def test_costs_are_summed_over_the_jobs_in_the_folders_of_a_target(tmp_path):
    for folder in ("benchmarks", "logs"):
        (tmp_path / "one" / folder).mkdir(parents=True)
    for name, s, cpu in (("a", "10.4", "8.0"), ("b", "20.0", "15.0")):
        file = tmp_path / f"one/benchmarks/{name}.tsv"
        file.write_text(f"s\tcpu_time\n{s}\t1.0\n")  # sampled for a while
        used = f"used {cpu} s of CPU, 90 MB at most\n"
        (tmp_path / f"one/logs/{name}.log").write_text(used)
    folders = {"paper": [tmp_path / "one", tmp_path / "none"], "other": []}
    text = cost(folders)
    assert "| paper | 2 | 30 | 23 | 20 |" in text
    assert "| other | not run |  |  |  |" in text


def test_an_order_is_in_the_wear_where_its_harmonic_exceeds_those_beside_it(coarse_rom):
    speeds = np.array([0.1, 0.19, 0.26, 0.34, 0.4])
    wear = np.array([1 + np.cos(2 * THETA) + 0.1 * np.cos(k * THETA) for k in (4, 6, 8, 4, 6)])
    wear[3] += 0.05 * np.cos(6 * THETA) - np.cos(2 * THETA)
    found = measure._orders_in_harmonics(coarse_rom, speeds, wear)
    assert found == [4, 6]  # 8 and the last 6 are far from their crossings
    wear[3] += np.cos(2 * THETA)  # 4 is on the slope of 2
    assert measure._orders_in_harmonics(coarse_rom, speeds, wear) == [6]


def test_the_stress_is_in_MPa():
    told = {"speeds": [{"alternating": 2e7}, {"alternating": 5e7}, {"trend": "growing"}]}
    assert measure.stress(told) == pytest.approx({"alternating_MPa": 50})
