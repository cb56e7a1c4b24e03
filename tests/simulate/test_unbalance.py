"""Orbit of an unbalanced rotor: where it touches, its closed form, and an order 0 of the casing."""

import numpy as np
import pytest
from refused import refused
from runs import marched, rad_s, swept
from scenes import EXACT, scene

from geometry.base import RPM, SettingsError
from simulate.marching import SceneError, check_scene, march, prepare
from simulate.scene import Scene
from simulate.scene.unbalance import Jeffcott, Unbalance

ECCENTRICITY, GAP = 7.0, 21.0  # um: the gap is 3 e
FINE = 1e-7  # relative, of a speed at which contact begins
EVEN = {"casing__harmonics": [], "casing__ramp_rounds": 0.0, "casing__scale": 1.0}


def on_orbit(rom, beta, **more):
    """Scene of a tip in the middle of a Jeffcott rotor whose critical speed is 0.25 f1(0)."""
    rotor = {"eccentricity_um": ECCENTRICITY, "damping_ratio": 0.05}
    rotor["critical_rpm"] = RPM * rad_s(rom, 0.25)
    gaps = {"leading_edge_um": GAP, "trailing_edge_um": GAP}
    values = {"unbalance": {"beta_deg": beta, "jeffcott": rotor}, "clearance": gaps}
    return scene(integrator=EXACT, **EVEN | {"rounds": 1} | values | more)


def touches(rom, beta, over_critical):
    """Whether it does, on a casing that is even."""
    case = on_orbit(rom, beta)
    setup = prepare(case, rom, over_critical * rad_s(rom, 0.25))
    outcome = march(case, setup)
    assert (outcome.status == "no-contact") == (outcome.contact_share == 0)
    return outcome.contact_share > 0


def test_of_36_blades_one_touches_first(coarse_rom):
    """None at 0.87269 of the critical speed; at 0.87270 that at -20 degrees, whose lag is 20.1."""
    betas = range(-170, 181, 10)
    assert not any(touches(coarse_rom, beta, 0.87269) for beta in betas)
    assert [beta for beta in betas if touches(coarse_rom, beta, 0.87270)] == [-20]


def test_worst_blade_touches_from_the_speed_at_which_the_orbit_reaches_the_gap(coarse_rom):
    """From 0.8726990 to 1.2153791."""
    for first, sign in ((0.8726990, 1), (1.2153791, -1)):
        assert not touches(coarse_rom, "worst", first * (1 - sign * FINE))
        assert touches(coarse_rom, "worst", first * (1 + sign * FINE))


@pytest.mark.parametrize("travels", [0.0, 800.0])
def test_orbit_is_an_order_0_of_the_casing(coarse_rom, travels):
    """To the last bit, under the same ramp, with harmonics that stand or travel."""
    lobes = [{"order": 2, "amplitude_um": 20.0}, {"order": 3, "amplitude_um": 6.0}]
    lobes[1]["speed_rpm"] = travels
    more = EVEN | {"casing__ramp_rounds": 0.5, "rounds": 2, "casing__harmonics": lobes}
    table = {"speed_over_f1": [0.2, 0.3], "radius_um": [8.0, 8.0], "lag_deg": [20.0, 20.0]}
    case = on_orbit(coarse_rom, -20.0, **more, unbalance={"beta_deg": -20.0, "whirl": table})
    more["casing__harmonics"] = [*lobes, {"order": 0, "amplitude_um": 8.0}]
    given = case.clearance.model_dump(exclude_unset=True)
    other = scene(integrator=EXACT, clearance=given, **more)
    one, same = (marched(each, coarse_rom, 0.23) for each in (case, other))
    assert one.contact_share > 0
    assert np.array_equal(one.u_r, same.u_r)
    assert np.array_equal(one.wear, same.wear)
    assert one.ledger == same.ledger


def test_each_blade_of_a_stage_is_where_it_is_on_the_orbit(coarse_rom):
    """As the same blade alone at its own angle; over a liner that does not wear."""
    law = {"liner__law": {"kind": "elastic", "E": 1.0, "unit_MPa": 2000}}
    of_stage = on_orbit(coarse_rom, -25.0, stage={"count": 3}, **law)
    outcome = march(of_stage, prepare(of_stage, coarse_rom, 0.95 * rad_s(coarse_rom, 0.25)))
    alone = []
    for j, blade in enumerate(outcome.blades):
        case = on_orbit(coarse_rom, -25.0 + 120 * j, **law)
        own = march(case, prepare(case, coarse_rom, 0.95 * rad_s(coarse_rom, 0.25)))
        alone.append(own.status)
        assert blade.status == own.status
        assert blade.contact_share == own.contact_share
        assert blade.each.largest[0] == pytest.approx(own.each.largest[0], rel=1e-9)
    assert alone == ["ok", "no-contact", "no-contact"]


def test_orbit_is_that_of_its_table(coarse_rom):
    """Linear in between; a Jeffcott rotor: its closed form, largest 10.0125 e."""
    whirl = {"speed_rpm": [1e3, 2e3], "radius_um": [2.0, 6.0], "lag_deg": [0.0, 90.0]}
    of = Unbalance.model_validate({"beta_deg": 0.0, "whirl": whirl})
    radius, lag = of.orbit(1500 / RPM, 1.0)
    assert (1e6 * radius, lag) == pytest.approx((4.0, np.pi / 4))
    rotor = Jeffcott(eccentricity_um=1.0, critical_rpm=1e3, damping_ratio=0.05)
    speeds = np.linspace(900, 1200, 30001)
    radii = [Unbalance(beta_deg=0.0, jeffcott=rotor).orbit(rpm / RPM, 1.0)[0] for rpm in speeds]
    assert 1e6 * max(radii) == pytest.approx(10.0125235, rel=1e-7)


def test_refuses_an_orbit_that_is_not_known_or_beyond_the_liner(coarse_rom):
    """Before the run, in one line."""
    thin = on_orbit(coarse_rom, 0.0, liner__thickness_mm=0.04, speeds__over_f1=[0.2, 0.25])
    error = refused(SceneError, check_scene, thin, coarse_rom)
    assert error.key == "unbalance.jeffcott"
    assert "70 um" in str(error) and "61 um" in str(error)
    whirl = {"speed_over_f1": [0.1, 0.2], "radius_um": [2.0, 6.0], "lag_deg": [0.0, 90.0]}
    short = on_orbit(coarse_rom, 0.0, unbalance={"beta_deg": 0.0, "whirl": whirl})
    assert refused(SceneError, check_scene, short, coarse_rom).key == "unbalance.whirl"


@pytest.mark.parametrize(
    ("changes", "key"),
    [
        ({"unbalance": {"beta_deg": 0.0}}, "unbalance"),
        ({"unbalance__beta_deg": "most"}, "unbalance.beta_deg"),
        ({"unbalance__beta_deg": "worst", "stage": {"count": 2}}, "unbalance.beta_deg"),
        ({"speeds": {"over_f1": [0.2, 0.3], "in_turn": True}}, "speeds.in_turn"),
    ],
)
def test_refuses_what_does_not_go_with_an_orbit(coarse_rom, changes, key):
    """Its key is named."""
    error = refused(SettingsError, on_orbit, coarse_rom, 0.0, **changes)
    assert error.key.startswith(key)


def test_scene_of_an_orbit_is_read_as_it_was_written(coarse_rom):
    """As results hold it."""
    case = on_orbit(coarse_rom, "worst")
    assert Scene.model_validate_json(case.model_dump_json()) == case


def test_results_say_what_the_orbit_leaves_out(coarse_rom):
    """Its radius is that of each run; the worst blade is named an envelope."""
    case = on_orbit(coarse_rom, "worst", speeds__over_f1=[0.2, 0.23], record__history=None)
    runs = swept(case, coarse_rom)
    expected = [case.unbalance.orbit(Omega, coarse_rom.f1)[0] for Omega in runs["speed"].values]
    assert runs["orbit"].values.tolist() == expected
    prescribed, envelope = case.assumes
    assert "contact does not act on it" in prescribed
    assert "envelope" in envelope
    assert len(on_orbit(coarse_rom, 10.0).assumes) == 1
