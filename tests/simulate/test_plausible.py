"""Values that may be meant: a warning each, with the likely slip; none for the project's scenes."""

import warnings

import pytest
import yaml
from scenes import scene

from geometry.base import ROOT
from simulate import march
from simulate.scene import Scene
from simulate.sweeps.sweep import sweep
from simulate.sweeps.unusual import SceneWarning, doubts
from workflow.many.design import Design
from workflow.many.engine import march_block

EXACT = {"integrator": {"scheme": "piecewise-exact", "steps_per_round": 640}}


@pytest.mark.parametrize(
    ("changes", "key", "words"),
    [
        (
            {"damping_ratio": 0.5},
            "damping_ratio",
            ["0.5: 50 % of critical", "0.5 % would be 0.005"],
        ),
        ({"speeds": {"over_f1": [0.002]}}, "speeds", ["0.002 f1(0)", "no engine order up to 200"]),
        (
            {"clearance__trailing_edge_over_span": None, "clearance__trailing_edge_um": 20000},
            "clearance",
            ["21.4 mm, 15 % of the span", "is it in mm, or in %?"],
        ),
        (
            {"casing__harmonics": [{"order": 2, "amplitude_gaps": 150.0}]},
            "casing",
            ["amplitude_gaps: 150", "150 % of the gap would be 1.5"],
        ),
        ({"casing__ramp_rounds": 3}, "casing.ramp_rounds", ["3: longer than the 2 revolutions"]),
        (
            {"liner__footprint_mm": 200},
            "liner.footprint_mm",
            ["longer than the chord", "is it in um?"],
        ),
        (
            {"contact": {"profile": {"tilt": 0.5}}},
            "contact.profile.tilt",
            ["a slope, of 26.6 deg; 0.5 deg would be 0.00873"],
        ),
        ({"liner__law__E": 1e-4}, "liner.law.E", ["2e+05 Pa; rubber has 1e+06"]),
        (
            {"liner__law__K": 0.0, "liner__law__sigma_Y": 0.0},
            "liner.law.sigma_Y",
            ["wears the liner without any force"],
        ),
        ({"liner__law__sigma_Y": 16.0}, "liner.law.sigma_Y", ["not below E = 1", "is it in Pa?"]),
    ],
)
def test_a_doubtful_value_is_one_line_with_the_likely_slip(coarse_rom, changes, key, words):
    found = doubts(scene(**changes), coarse_rom)
    assert [*found] == [key]
    assert all(word in found[key] for word in words), found[key]
    assert found[key].startswith(key.split(".")[0]) and "\n" not in found[key]


SCENES = ROOT / "workflow/scenes"
VARIANTS = yaml.safe_load((SCENES / "variants.yaml").read_text())
NAMES = {path.stem for path in SCENES.glob("*.yaml")} - {"variants"} | {*VARIANTS}


@pytest.mark.parametrize("name", sorted(NAMES))
def test_no_scene_of_the_project_is_doubtful(coarse_rom, name):
    case = Scene.load(SCENES / f"{name}.yaml")
    assert doubts(case, coarse_rom) == {}


def test_sweep_and_march_warn(coarse_rom):
    case = scene(**EXACT, damping_ratio=0.5)
    for run in (lambda: sweep(case, coarse_rom), lambda: march(case, coarse_rom, 488.0)):
        with pytest.warns(SceneWarning, match="50 % of critical damping"):
            run()


def test_a_design_warns_once_with_its_first_row(coarse_rom, tmp_path):
    (tmp_path / "table.csv").write_text("damping_ratio\n0.01\n0.4\n0.5\n")
    of = Design.of(scene(**EXACT).but(design="table.csv"), tmp_path / "scene.yaml")
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        march_block(of.rows(), tmp_path / "rows", 3, models={"coarse": coarse_rom})
    assert [str(one.message)[:25] for one in caught] == ["row 2: damping_ratio: 0.4"]
