"""The examples of docstrings run, on a small model and scene, and give what they say."""

import doctest
from importlib import import_module
from pathlib import Path

import pytest
from scenes import EXPLICIT_TO_EXACT, SCENE

import simulate
from simulate import Scene

MODULES = {
    *("simulate.contact.compiled", "simulate.errors.observables", "simulate.signals"),
    *("simulate.scene.tables", "simulate.sweeps.result_types"),
    *("workflow.many.columns", "workflow.many.design", "workflow.many.plan", "workflow.many.table"),
    *("simulate.marching.states", "simulate.marching.trend", "rom.crossings"),
    *("simulate.scene.damping", "simulate.scene.unbalance"),
    *simulate.FACE.values(),
}
MORE_SPEEDS = ("over_f1: [0.3]", "over_f1: {first: 0.28, last: 0.39, count: 12}")


@pytest.fixture
def names(coarse_rom, tmp_path, monkeypatch):
    """What examples take as given: `rom` and `scene`, also as files in the folder."""
    monkeypatch.chdir(tmp_path)
    coarse_rom.save("rom-r.nc")
    text = (
        SCENE.replace(*EXPLICIT_TO_EXACT).replace(*MORE_SPEEDS).replace("rounds: 2", "rounds: 20")
    )
    Path("scene.yaml").write_text(text)
    return {"rom": coarse_rom, "scene": Scene.load("scene.yaml")}


@pytest.mark.parametrize("module", sorted(MODULES))
def test_examples_give_what_they_say(module, names):
    ran = doctest.testmod(import_module(module), extraglobs=names)
    assert ran.attempted > 0
    assert ran.failed == 0


@pytest.mark.parametrize("name", simulate.__all__)
def test_all_of_the_face_has_an_example(name):
    assert ">>> " in getattr(simulate, name).__doc__
