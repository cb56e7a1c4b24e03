"""The default scheme on whole runs, against the peer in plain NumPy."""

import peer
import pytest
from runs import assert_is_that_of_the_peer, rad_s
from scenes import of_steps, over_strips, scene

from simulate.marching import check_scene

CALM = {"E": 1.0, "strips": 8, "over_f1": 0.38, "rounds": 6, "rods": 512, "steps": 1024}
RESONANT = {"strips": 16, "over_f1": 0.34, "rounds": 3}
CASES = {
    "calm": CALM,
    "stiff": CALM | {"E": 10.0, "rounds": 3},
    "stiffer, w_end to 0.27": CALM | {"E": 100.0, "rounds": 3},
    "near resonance, more strips than patches": CALM | RESONANT,
    "slow, one strip": CALM | {"strips": 1, "over_f1": 0.12, "rounds": 2},
    "2.5 rods a step": CALM | {"E": 10.0, "over_f1": 0.34, "rounds": 3, "rods": 2560},
    "3.9 rods a step, of 5.7": CALM | {"rounds": 3, "rods": 1001, "steps": 256, "footprint_mm": 20},
    "3.9 rods a step, of 4": CALM | {"rounds": 3, "rods": 1001, "steps": 256},
    "friction": CALM | {"friction": 0.1, "rounds": 4},
    "friction, stiff": CALM | {"friction": 0.05, "E": 10.0, "rounds": 3},
    "friction near locking, one strip": CALM
    | {"friction": 0.2, "strips": 1, "over_f1": 0.3, "rounds": 3},
    "friction, more strips than patches": CALM | RESONANT | {"friction": 0.1},
    "an orbit": CALM | {"travels": 0.25, "rounds": 3},
    "an orbit with the blade": CALM | {"travels": 1.0, "rounds": 3},
    "an orbit against the blade, friction": CALM | {"travels": -0.6, "friction": 0.1, "rounds": 3},
}


def travelling(Omega):
    """A casing whose first harmonic travels at ``Omega``."""
    return [
        {"order": 1, "amplitude_gaps": 1.0, "speed_rad_s": Omega},
        {"order": 2, "amplitude_gaps": 1.2, "phase_deg": 20},
    ]


@pytest.mark.parametrize("case", CASES)
def test_a_run_is_that_of_the_peer(coarse_rom, case):
    """Displacement and every rod's wear, over rounds in which round-off stays small.

    ``travels``: speed of a harmonic of the casing over that of the blade.
    """
    numbers = CASES[case]
    E, plain = numbers["E"], not {"friction", "travels"} & {*numbers}
    more = {}
    if "travels" in numbers:
        Omega = numbers["travels"] * rad_s(coarse_rom, numbers["over_f1"])
        more["casing__harmonics"] = travelling(Omega)
    of = scene(
        rounds=numbers["rounds"],
        casing__ramp_rounds=1,
        contact={"friction": numbers.get("friction")},
        liner__law__E=E,
        liner__law__K=0.45 * E,
        liner__strips=numbers["strips"],
        liner__rods_per_round=numbers["rods"],
        liner__footprint_m=numbers.get("footprint_m", 5e-3),
        record__history__chord=over_strips(numbers["strips"]),
        integrator=of_steps(numbers["steps"]),
        **more,
    )
    check_scene(of, coarse_rom)
    # measured without friction and travelling 2e-13 and 7e-12
    most = 1e-10 if plain else 1e-9
    contacts = assert_is_that_of_the_peer(
        peer.piecewise_exact, of, coarse_rom, numbers["over_f1"], most
    )
    assert contacts > 0.01 * numbers["steps"] * numbers["rounds"]
