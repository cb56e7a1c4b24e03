"""The kernel compiled before there is a model is the one that the model's runs call."""

import pytest
from scenes import EXACT, of_steps, scene

from simulate.contact.compiled import layout
from simulate.marching import make_kernel, prepare, run
from simulate.marching.ahead import compile_ahead

TILTED = {"tangential": True, "profile": {"edge_drop_um": 20}}
CASES = {
    "plain": {},
    "piecewise-exact": {"integrator": EXACT},
    "friction": {"integrator": of_steps(1024), "contact": {"friction": 0.1}, "rounds": 3},
    "tangential": {"integrator": EXACT, "contact": TILTED},
    "elastic": {"liner__law": {"kind": "elastic", "E": 1.0, "unit_MPa": 2000}},
    "no records": {"record": {"contact_force": False, "history": None, "spectrum_rounds": None}},
}


@pytest.fixture
def asked(monkeypatch):
    """Types of the arguments for which a kernel is asked, in place of compiling it."""
    asked = []
    monkeypatch.setattr(
        run, "for_types_of", lambda function, *arguments: asked.append(layout(arguments))
    )
    return asked


@pytest.mark.parametrize("name", CASES)
def test_a_blade_that_stands_for_another_has_its_types(asked, coarse_rom, name):
    case = scene(**CASES[name])
    compile_ahead(case)
    make_kernel(case, prepare(case, coarse_rom, 300.0))
    assert asked[0] == asked[1]


def test_rows_across_the_thickness_count(asked):
    case = scene(integrator=EXACT)
    for across in (1, 2):
        compile_ahead(case, across)
    assert asked[0] != asked[1]
