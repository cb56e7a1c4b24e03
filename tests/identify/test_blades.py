"""Blades of a prior: the hub radius that gives the paper's crossing, and shapes that cannot be."""

import numpy as np
import pytest
from refused import refused

from geometry.project import SettingsError
from rom.model import Rom
from rom.modes import ModesError
from simulate.sweeps.peak import crossing
from workflow.identify import blades
from workflow.identify.blades import at_crossing, of_prior, of_shape, stiffening, tip
from workflow.identify.priors import SHAPE, Prior

SHAPES = {  # places in the ranges below
    "span_mm": (120.0, 160.0),
    "tip_lean_tangential_mm": (-20.0, 20.0),
    "tip_lean_axial_mm": (-10.0, 10.0),
    "hub_thickness_mm": (5.0, 7.0),
    "tip_thickness_mm": (2.5, 3.5),
    "hub_stagger_deg": (10.0, 40.0),
    "tip_stagger_deg": (45.0, 60.0),
}


@pytest.fixture(scope="module")
def base(coarse_blade):
    return coarse_blade.but(prestress="linear", basis={"natural_modes": 10})


@pytest.fixture(scope="module")
def priors(narrow):
    ranges = {name: Prior(between=list(ends), why="") for name, ends in SHAPES.items()}
    return narrow.model_copy(update=ranges)


@pytest.fixture(scope="module")
def drawn(base, priors, tmp_path_factory):
    """The third of four blades: its file and its model."""
    file = tmp_path_factory.mktemp("blade") / "rom-r.nc"
    names = {"prior": "narrow", "number": "2"}
    return of_prior(priors, base, names, 4, str(file)), Rom.load(file)


def test_a_blade_crosses_engine_order_4_where_the_papers_does(drawn):
    _, model = drawn
    assert crossing(model, 4) == pytest.approx(0.31, abs=2e-4)
    assert crossing(model, 6) == pytest.approx(0.1815, abs=1e-3)  # f1^2 = f1(0)^2 + B Omega^2


def test_its_file_has_its_shape_and_what_follows(drawn, base):
    numbers, model = drawn
    for (name, (low, high)), place in zip(SHAPES.items(), numbers["places"], strict=True):
        assert numbers["shape"][name] == pytest.approx(low + (high - low) * place)
    assert model.Omega_m == pytest.approx(0.402 * model.omega1, rel=1e-3)
    assert numbers["max_speed_rad_s"] == model.Omega_m
    again = of_shape(base, numbers["shape"]).but(
        sections__hub_radius_mm=numbers["hub_radius_mm"], max_speed_rad_s=model.Omega_m
    )
    assert again.sections.hub.stagger_deg == numbers["shape"]["hub_stagger_deg"]
    assert again.sections.tip.chord_mm == base.sections.tip.chord_mm
    assert model.provenance.blade == "narrow-2" and numbers["rejected"] == 0
    assert {**numbers} | tip(model) == numbers


def test_softness_of_all_modes_is_the_static_response_of_the_tip(drawn):
    """At the paper's crossing; mode 1 moves the leading edge by its share of the mean square."""
    numbers, model = drawn
    Omega = 0.31 * model.omega1
    rows = model.rows(blades.XI, "r")
    softness = np.einsum("pn,np->p", rows, np.linalg.solve(model.stiffness(Omega), rows.T))
    assert numbers["softness"] * (1 + numbers["others"]) == pytest.approx(softness.mean())
    mode = rows @ model.modes(Omega)[1][:, 0]
    assert numbers["leading"] ** 2 == pytest.approx(mode[0] ** 2 / (mode**2).mean())
    assert np.sign(numbers["leading"]) == np.sign(mode[0] * mode.mean())


def test_a_shape_that_cannot_be_is_passed_over(base, priors, tmp_path, monkeypatch):
    """The first of the blade's shapes has a tip thicker than a section may be."""
    of_first = base.sections.tip.chord_mm  # as thick as long
    places = np.full((2, len(SHAPE)), 0.5)
    places[0, 4] = (of_first - 2.5) / 1.0
    monkeypatch.setattr(blades, "sobol", lambda *_: places)
    names = {"prior": "narrow", "number": "0"}
    numbers = of_prior(priors, base, names, 1, str(tmp_path / "rom-r.nc"))
    assert numbers["rejected"] == 1 and numbers["places"] == [0.5] * len(SHAPE)
    monkeypatch.setattr(blades, "sobol", lambda *_: places[:1])
    error = refused(SettingsError, of_prior, priors, base, names, 1, str(tmp_path / "rom-r.nc"))
    assert error.key == "narrow-0" and "thickness" in str(error)


def test_a_blade_whose_hub_would_be_out_of_range_is_refused(base, monkeypatch):
    """With a hub up to 200 mm the reference blade, which has 422, stiffens too little."""
    monkeypatch.setattr(blades, "RADII", (100.0, 200.0))
    short = base.but(sections__hub_radius_mm=190.0)
    error = refused(SettingsError, at_crossing, short, "short")
    assert error.key == "sections.hub_radius_mm"
    assert stiffening(blades.reduced(short, "short")) < blades.WANTED - 1


def test_a_soft_shape_is_not_lost_for_the_highest_speed_of_another_blade(base):
    """Long and thin at the hub, it is unstable at 650 rad/s: 0.4 of its f1(0) is 150 rad/s."""
    shape = dict(zip(SHAPE, (216.0, -6.0, -6.0, 2.5, 4.2, 51.0, 38.0), strict=True))
    soft = of_shape(base, shape)
    refused(ModesError, blades.reduced, soft, "soft")
    blade, model = at_crossing(soft, "soft")
    assert crossing(model, 4) == pytest.approx(0.31, abs=2e-4)
    assert blade.max_speed_rad_s == pytest.approx(0.402 * model.omega1, rel=1e-3)


def test_all_shapes_of_the_priors_are_keys_of_sections(narrow, base):
    middle = narrow.values(np.full((1, 13), 0.5))
    blade = of_shape(base, {name: float(middle[name][0]) for name in SHAPE})
    assert blade.sections.hub.thickness_mm == 6.0
