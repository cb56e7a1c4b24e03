"""Unit of E and casing amplitude: the calibration on C11 for E = 1, and where C12 and C16 hold.

Claim C11: with E = 1, Omega_c over the blade's own linear crossing is 1.129 for k = 4 and 1.059
for k = 6. Only these two calibrate; the coating with E = 10 is marched beside, to see what would
follow.
"""

from collections.abc import Iterable, Sequence
from math import hypot
from typing import Any

from rom.model import Rom
from simulate.scene import Scene
from workflow.paper.cases import COATINGS, SCALES, UNITS_PA, of_coating
from workflow.paper.peaks import case

# Omega_c over the linear crossing, E = 1, and what half a digit of the paper's speeds makes of it
TARGETS = {"4": (1.129, 0.005 / 0.31), "6": (1.059, 0.005 / 0.17)}


def row(scene: Scene, rom: Rom, unit_Pa: float) -> list[dict[str, Any]]:
    """All casing amplitudes at one unit of E, both coatings."""
    return [_choice(scene, rom, unit_Pa, scale) for scale in SCALES]


def _choice(scene: Scene, rom: Rom, unit_Pa: float, scale: float) -> dict[str, Any]:
    here = scene.changed(liner__law__unit_Pa=unit_Pa, casing__scale=scale)
    orders = tuple(scene.peaks.orders)
    found = {name: case(of_coating(here, *of), rom, orders) for name, of in COATINGS.items()}
    return {
        "unit_Pa": unit_Pa,
        "scale": scale,
        "runs": sum(one["runs"] for one in found.values()),
        **{name: one["peaks"] for name, one in found.items()},
    }


def miss(peaks: dict[str, Any]) -> float | None:
    """Distance of both shifts from the paper's, in half digits; None where a peak is missing."""
    if not all(peaks[k] for k in TARGETS):
        return None
    return hypot(*((peaks[k]["over_crossing"] - t) / digit for k, (t, digit) in TARGETS.items()))


def contact_map(rows: Iterable[Sequence[dict[str, Any]]]) -> dict[str, Any]:
    """The whole map, and the choice that misses by least."""
    cases = [case | {"miss": miss(case["e1"])} for row in rows for case in row]
    best = min((c for c in cases if c["miss"] is not None), key=lambda c: c["miss"])
    return {
        "unit_Pa": list(UNITS_PA),
        "scale": list(SCALES),
        "cases": cases,
        "best": {key: best[key] for key in ("unit_Pa", "scale", "miss")},
    }
