"""One small scene on the coarse blade, and its variants."""

import yaml

from geometry.base import check_settings
from geometry.base.units import OTHER
from geometry.hats import middles
from simulate.contact.ledger import Ledger
from simulate.scene import Scene

SCENE = """
blade: coarse
speeds: {over_f1: [0.3]}
rounds: 2
verify: {share: 0}
integrator: {scheme: central-difference, fraction_of_limit: 0.8}
damping_ratio: 0.005
clearance: {leading_edge_over_span: 1.5e-4, trailing_edge_over_span: 4.3e-4}
casing: {ramp_rounds: 0.1, harmonics: [{order: 2, amplitude_gaps: 2.0}]}
liner:
  {law: {kind: plastic, E: 1.0, K: 0.45, sigma_Y: 1.0e-8, unit_MPa: 2000}, thickness_mm: 5,
   strips: 8, footprint_mm: 5, rods_per_round: 512}
record:
  {samples_per_round: 64, spectrum_rounds: 1, contact_force: true,
   history: {chord: [0.0625, 0.9375]}}
"""
SCHEMES = {
    "central-difference": {"scheme": "central-difference", "fraction_of_limit": 0.8},
    "piecewise-exact": {"scheme": "piecewise-exact", "steps_per_round": 640},
}
EXACT = SCHEMES["piecewise-exact"]
# Damping and casing, and a unit of E, with which the tip of blade `reference` rubs at all speeds
TWO_LOBES = {
    "damping_ratio": 0.0029,
    "casing__scale": 1.27,
    "casing__harmonics": [
        {"order": 0, "amplitude_gaps": 0.633},
        {"order": 2, "amplitude_gaps": 1.0},
        {"order": 4, "amplitude_gaps": 0.381, "phase_deg": 180},
    ],
}
UNIT = 1.64e9  # Pa
RUBBING = TWO_LOBES | {"liner__law__unit_MPa": UNIT / 1e6}
EXPLICIT_TO_EXACT = (  # in the lines above
    "{scheme: central-difference, fraction_of_limit: 0.8}",
    "{scheme: piecewise-exact, steps_per_round: 640}",
)


def of_steps(per_round, scheme="piecewise-exact"):
    """Integrator of a scene with as many steps."""
    return {"scheme": scheme, "steps_per_round": per_round}


def over_strips(m=8):
    """The middles of ``m`` strips, for a history there."""
    return [float(xi) for xi in middles(m)]


def softened(case: Scene, unit_MPa: float) -> Scene:
    """The scene with a softer liner than settings allow: too soft to move the blade."""
    law = case.liner.law.model_copy(update={"unit_MPa": unit_MPa})
    return case.model_copy(update={"liner": case.liner.model_copy(update={"law": law})})


def blade_balance(ledger: Ledger) -> float:
    """Error of the blade's own balance, J: round-off."""
    return ledger.blade - ledger.blade_before + ledger.damping - ledger.work - ledger.force


def scene(**changes) -> Scene:
    """The scene above with nested keys, written a__b, changed (None removes)."""
    values = yaml.safe_load(SCENE)
    for path, value in changes.items():
        *parents, key = path.split("__")
        place = values
        for parent in parents:
            place = place.setdefault(parent, {})
        if value is None:
            del place[key]
        else:
            place.pop(OTHER.get(key), None)  # the same in another unit
            place[key] = value
    return check_settings(Scene, values, "scene.yaml")
