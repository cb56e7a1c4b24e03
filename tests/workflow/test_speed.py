"""Studies of speed and stability: what they say of runs, and what they draw."""

import numpy as np
import pytest
from scenes import scene

from workflow.figures import speed as speed_figure
from workflow.figures import stability as stability_figure
from workflow.study import speed, speed_table, stability_map


def run(scheme, cpu_s, error, scaled=None):
    return {
        "scheme": scheme,
        "mass_scaling_hz": scaled,
        "steps_per_round": 1024,
        "cpu_s": cpu_s,
        "contact_share": 0.2,
        "error": dict.fromkeys(speed.OBSERVABLES, error),
    }


@pytest.fixture
def study():
    runs = [
        run("piecewise-exact", 0.005, 0.02),
        run("piecewise-exact", 0.04, 0.004),
        run("piecewise-exact", 0.02, 0.008),
        run("central-difference", 0.1, 0.009),
        run("central-difference", 0.01, 0.06, scaled=25e3),
    ]
    same = dict.fromkeys(speed.OBSERVABLES, 1e-4)
    calm = {"speed_over_f1": 0.38, "n": 38, "spread": same, "twin": same, "runs": runs}
    return {"default": {"calm": calm}, "paper": {"calm": calm | {"n": 86}}}


def test_the_cheapest_run_that_meets_a_level_is_found(study):
    calm = study["default"]["calm"]
    assert speed.cheapest(calm, "wear", 0.01, "piecewise-exact")["cpu_s"] == 0.02
    assert speed.cheapest(calm, "wear", 0.03, "piecewise-exact")["cpu_s"] == 0.005
    assert speed.cheapest(calm, "wear", 0.1, "central-difference")["cpu_s"] == 0.1
    assert speed.cheapest(calm, "wear", 0.1, "central-difference", scaled=True)["cpu_s"] == 0.01
    assert speed.cheapest(calm, "wear", 0.001, "piecewise-exact") is None


def test_the_table_has_a_line_for_each_model_scene_and_observable(study):
    lines = speed_table.markdown(study).splitlines()
    assert lines[2].startswith(
        "| scenes', 38 | calm | peak amplitude | 5 | 100 | 10 | 5 | 100 | - |"
    )
    assert lines[2].endswith("| 20 | 100 | - | 0.01 % |")
    assert sum(line.startswith("| paper's, 86") for line in lines) == 3


def test_errors_are_relative_and_in_l2():
    wear, history = np.array([[3.0, 4.0]]), np.array([0.0, 2.0])
    one = speed.Observed(2.0, wear, history)
    other = speed.Observed(2.2, np.array([[3.0, 4.5]]), history * 1.5)
    assert speed.errors(other, one) == pytest.approx(
        {"peak amplitude": 0.1, "wear": 0.1, "first rounds": 0.5}
    )


def test_both_figures_are_drawn_with_units(study):
    drawn = speed_figure.draw(study)
    assert "CPU time of 20 rounds, ms" in {axes.get_xlabel() for axes in drawn.axes}
    engaged = [
        {"E": E, "alone": 6e-7, "limit": 5e-7 / E, "predicted": 6e-7 / E, "failed": 6e-7 / E}
        for E in (1.0, 3.0, 10.0, 30.0)
    ]
    met = {"wear": {"0.01": 1e-7, "0.1": None}}
    contact = [
        {"E": E, "limit": 5e-7, "central-difference": met, "piecewise-exact": met} for E in (1, 10)
    ]
    axes = stability_figure.draw({"engaged": engaged, "intermittent": contact}).axes
    assert axes[0].get_ylabel() == "time step $h$, µs"
    assert len(axes[1].get_legend().get_texts()) == 3  # what no run passes is not drawn


def test_a_step_between_two_runs_passes_the_level():
    h, error = np.array([4e-6, 1e-6, 2e-6]), np.array([0.16, 0.01, 0.04])
    assert stability_map.passes(h, error, 0.02) == pytest.approx(np.sqrt(2) * 1e-6)
    assert stability_map.passes(h, error, 0.2) is None
    assert stability_map.passes(h, error, 0.001) is None


@pytest.mark.parametrize("E", [0.5, 20.0])
def test_runs_fail_where_the_spectral_radius_says(coarse_rom, E):
    """Engaged, elastic: predicted and found within 2 %, and the limit allowed is below."""
    found = stability_map.engaged(scene(), coarse_rom, 2 * np.pi * 0.33 * coarse_rom.f1, E)
    assert found["failed"] == pytest.approx(found["predicted"], rel=0.02)
    assert 0.8 * found["failed"] < found["limit"] < found["failed"]
