"""Force, torque and worn volume of a rigid blade, which meets the liner where the casing is."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from made_sweeps import made_rom
from scenes import of_steps, scene

from simulate.errors.observables import numbers
from simulate.errors.run import Case
from simulate.loads import (
    mean_force,
    mean_opening,
    tangential_moment,
    torque,
    torque_of_rounds,
    worn_per_pass,
    worn_volume,
)
from simulate.marching import march, prepare
from simulate.scene import LEADING
from simulate.sweeps import over_speeds
from simulate.sweeps.over_speeds import as_sweep, at_speeds

E, K, UNIT = 1.0, 0.45, 2e7  # of the liner
THICKNESS, FOOTPRINT, GAP = 5e-3, 5e-3, 2e-5
ROUNDS = 3
STEPS, NU = 4096, 4001
# steps and rods per revolution: six rods in a footprint; half of one; steps that pass the footprint
# and half as much again, of many rods; all of the one and a half that a footprint has; three of it
STEPS_AND_RODS = [(STEPS, NU), (1024, 511), (512, 8157), (1024, 1021), (256, 1021)]
EXACT = {
    "blade": "reference",
    "rounds": ROUNDS,
    "integrator": of_steps(STEPS),
    "clearance": {"leading_edge_m": GAP, "trailing_edge_m": 2 * GAP},
    "casing": {
        "ramp_rounds": 0,
        "harmonics": [
            {"order": 2, "amplitude_m": 3 * GAP},
            {"order": 5, "amplitude_m": GAP, "phase_deg": 30},
        ],
    },
    "liner__rods_per_round": NU,
}
LAWS = {
    "elastic": {"kind": "elastic", "E": E, "unit_Pa": UNIT},
    "plastic": {"kind": "plastic", "E": E, "K": K, "sigma_Y": 0.0, "unit_Pa": UNIT},
}


@pytest.fixture(scope="module")
def rigid():
    """A blade a million times too stiff for the liner: rods move it by some 1e-14 m."""
    return replace(made_rom(), K=np.array([1e16 * np.eye(3), np.zeros((3, 3)), np.zeros((3, 3))]))


def rubbed(rom, law, **more):
    """The run, its set-up, mean penetration and mean of its square over each strip, m and m2."""
    case = scene(**EXACT | {"liner__law": LAWS[law]} | more)
    setup = prepare(case, rom, 100.0)
    theta = np.linspace(0, 2 * np.pi, 100_000, endpoint=False)
    d = case.casing.inward(theta, GAP)
    p = np.maximum(d[None] - case.clearance.gaps(setup.places.xi, rom.span)[:, None], 0)
    return march(case, setup), setup, p.mean(axis=1), (p**2).mean(axis=1), p.max(axis=1)


def of(steps, rods):
    """Settings with as many steps and rods per revolution."""
    return {"integrator": of_steps(steps), "liner__rods_per_round": rods}


@pytest.mark.parametrize(("steps", "rods"), STEPS_AND_RODS)
def test_force_and_torque_of_a_rigid_blade_on_an_elastic_liner(rigid, steps, rods):
    """Force E w L <p> / l; torque r w E <p^2> / (2 l): each rod is loaded once a round, and lost.

    <> is the mean around the casing, p the penetration. So it is at any step and density: rods that
    come and go within a step do so at the cost of the rotor, too.
    """
    run, setup, p, p2, deepest = rubbed(rigid, "elastic", **of(steps, rods))
    width, radius = setup.places.width, setup.places.radius
    stiffness = E * UNIT * width * FOOTPRINT / THICKNESS
    against = (E * UNIT * width * radius / (2 * THICKNESS)) @ p2
    assert mean_force(run.force_mean) == pytest.approx(stiffness @ p, rel=2e-4)
    # the first round begins with rods under the tip that none has left
    assert torque(run.casing_work)[1:] == pytest.approx([against] * 2, rel=1e-4)
    assert torque(run.ledger.casing, ROUNDS) == pytest.approx(torque(run.casing_work).mean())
    assert worn_volume(run.wear, width, radius) == 0
    # of each strip, one an eighth
    np.testing.assert_allclose(run.force_peak.max(axis=0), stiffness * deepest, rtol=2e-3)


@pytest.mark.parametrize(("steps", "rods"), STEPS_AND_RODS)
def test_torque_that_wears_a_groove_and_that_runs_in_it(rigid, steps, rods):
    """E K/(E + K) loads first, then E alone up to the same stress; depth and work of the wear."""
    run, setup, p, p2, _ = rubbed(rigid, "plastic", **of(steps, rods))
    width, radius = setup.places.width, setup.places.radius
    first = E * K / (E + K) * UNIT
    then = first**2 / (E * UNIT)
    expected = np.array([(s * width * radius / (2 * THICKNESS)) @ p2 for s in (first, then, then)])
    np.testing.assert_allclose(torque(run.casing_work)[1:], expected[1:], rtol=1e-3)
    start = torque(run.ledger.elastic)  # in the rods under the tip at the start
    rel = max(5e-3, 4 / steps)  # the tip takes a footprint, or a step, to leave them
    assert torque(run.casing_work)[0] - start == pytest.approx(expected[0], rel=rel)
    worked = torque(run.ledger.plastic) / expected[0]
    assert worked == pytest.approx(E / (E + K), rel=max(1e-3, 4 / steps))
    depth = E / (E + K) * p
    volume = 2 * np.pi * (width * radius) @ depth
    assert worn_volume(run.wear, width, radius) == pytest.approx(volume, rel=1e-3)
    swept = 2 * np.pi * (width @ radius)
    assert mean_opening(run.wear, width, radius) == pytest.approx(volume / swept, rel=1e-3)
    per_pass = volume / swept / EXACT["rounds"]  # all is worn in the first, over all of them
    assert worn_per_pass(run.each.worn, width, radius) == pytest.approx(per_pass, rel=1e-3)


def test_the_tip_speed_is_the_speed_times_the_radius_of_the_tip(rigid):
    """In a row of other numbers, at 100 rad/s."""
    case = scene(**EXACT | {"liner__law": LAWS["plastic"]})
    run = Case(case, rigid, prepare(case, rigid, 100.0)).march()
    places = run.setup.places
    radius = np.interp(LEADING, places.xi, places.radius)
    found = numbers(run)
    assert found["tip_speed"] == pytest.approx(100.0 * radius, rel=1e-3)
    assert found["worn_per_pass"] * EXACT["rounds"] == pytest.approx(found["opening"], rel=1e-6)


def test_torque_of_a_tilted_tip_is_the_moment_of_its_tangential_force(rigid):
    """r w E <p^2> / (2 l) less what enters at a depth, none here; the ledger converges to it.

    A rod leaves with the energy of its last step: the ledger's error goes with the step.
    """
    K = np.array([1e16 * np.eye(5), np.zeros((5, 5)), np.zeros((5, 5))])
    rom = replace(rigid, M=np.eye(5), K=K, directions=("radial", "tangential"))
    tilted = {"contact": {"profile": {"tilt": 0.015}, "tangential": True}, "rounds": 2}
    errors = []
    for steps in (8192, 32768):
        more = {"liner__rods_per_round": 80_021, "integrator": of_steps(steps)}
        run, setup, _, p2, _ = rubbed(rom, "elastic", **tilted, **more)
        against = (E * UNIT * setup.places.width * setup.places.radius / (2 * THICKNESS)) @ p2
        moment = tangential_moment(run.force_tangential_mean, rom)
        assert moment == pytest.approx([against] * 2, rel=3e-3)
        errors.append(abs(torque(run.casing_work)[1] / against - 1))
    assert errors[1] < errors[0] / 3


@pytest.mark.parametrize(
    ("contact", "expected"),
    [
        ({"friction": 0.1}, [3.0, 5.0]),
        ({"profile": {"tilt": 0.01}, "tangential": True}, [2.0, 3.0]),
        ({}, [1.0, 2.0]),
    ],
    ids=["friction", "tangential", "flat"],
)
def test_torque_of_a_run_that_ended_before_is_known_as_far_as_it_went(rigid, contact, expected):
    """As of one that shorter steps mend in a sweep until steady.

    1 and 2 N m by work, 2 and 3 by the tangential force.
    """
    case = scene(**EXACT | {"rounds": 5, "contact": contact})
    forces = np.zeros((2, 8))
    forces[:, 3] = np.array([2.0, 3.0]) / rigid.line(np.array([3.5 / 8]))[0, 0]
    work = 2 * np.pi * np.array([1.0, 2.0])
    blade = SimpleNamespace(casing_work=work, force_tangential_mean=forces)
    found = torque_of_rounds(case, rigid, SimpleNamespace(each_blade=[blade]))
    np.testing.assert_allclose(found, [*expected, *[np.nan] * 3], rtol=1e-12)


def test_torque_is_recorded_with_the_forces_and_alone_costs_no_variable(rigid, monkeypatch):
    # a rigid blade has no first mode that steps could resolve
    monkeypatch.setattr(over_speeds, "check_resolution", lambda *_: None)
    case = scene(**EXACT | {"liner__law": LAWS["elastic"], "rounds": 2})
    runs = as_sweep(at_speeds(case, rigid, [100.0]))
    assert runs["torque"].dims == ("speed_over_f1", "round")
    assert runs["torque"].attrs["units"] == "N m"
    casing = runs["ledger"].sel(energy="casing").item()
    assert runs["torque"].sum().item() == pytest.approx(casing / (2 * np.pi), rel=1e-12)
    lean = case.but(record__contact_force=False)
    assert "torque" not in as_sweep(at_speeds(lean, rigid, [100.0]))
