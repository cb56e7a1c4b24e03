"""Unit of E and casing amplitude: the calibration on C11 for E = 1, and where C12 and C16 hold.

Claim C11: with E = 1, Omega_c over the blade's linear crossing is 1.129 for k = 4 and 1.059 for
k = 6. Only these two values are used for calibration; the results of the coating with E = 10 are
predictions.
"""

from collections.abc import Iterable, Mapping, Sequence
from math import hypot
from typing import Any

from rom.model import Rom
from simulate.scene import Scene
from workflow.markdown import table
from workflow.paper.cases import COATINGS, SCALES, UNITS_PA, of_coating
from workflow.paper.peaks import case

# Omega_c over the linear crossing, E = 1, and its uncertainty by half a digit of the paper's speeds
TARGETS = {"4": (1.129, 0.005 / 0.31), "6": (1.059, 0.005 / 0.17)}


def row(scene: Scene, rom: Rom, unit_Pa: float) -> list[dict[str, Any]]:
    """All casing amplitudes at one unit of E, both coatings."""
    return [_choice(scene, rom, unit_Pa, scale) for scale in SCALES]


def _choice(scene: Scene, rom: Rom, unit_Pa: float, scale: float) -> dict[str, Any]:
    here = scene.but(liner__law__unit_Pa=unit_Pa, casing__scale=scale)
    orders = tuple(scene.peaks.orders)
    coatings = {name: case(of_coating(here, *of), rom, orders) for name, of in COATINGS.items()}
    return {
        "unit_Pa": unit_Pa,
        "scale": scale,
        "runs": sum(coating["runs"] for coating in coatings.values()),
        **{name: coating["peaks"] for name, coating in coatings.items()},
    }


def miss(peaks: dict[str, Any]) -> float | None:
    """Distance of both shifts from the paper's, in half digits of its speeds, root sum square.

    None where a peak is missing.
    """
    if not all(peaks[k] for k in TARGETS):
        return None
    return hypot(*((peaks[k]["over_crossing"] - t) / digit for k, (t, digit) in TARGETS.items()))


def contact_map(rows: Iterable[Sequence[dict[str, Any]]]) -> dict[str, Any]:
    """The whole map, and the choice closest to the paper's shifts."""
    cases = [case | {"miss": miss(case["e1"])} for row in rows for case in row]
    best = min((c for c in cases if c["miss"] is not None), key=lambda c: c["miss"])
    return {
        "unit_Pa": list(UNITS_PA),
        "scale": list(SCALES),
        "cases": cases,
        "best": {key: best[key] for key in ("unit_Pa", "scale", "miss")},
    }


def ranges(results: dict[str, Any], kept: Mapping[str, dict[str, Any]]) -> str:
    """Markdown: units of E at which C12 and C16 hold, for each casing amplitude.

    ``kept``: peaks of E = 1 with the choice of the scenes, as they are and in the repeats, by name.
    """
    head = [
        "casing amplitude (gaps)",
        "C12 holds at a unit of E of (GPa)",
        "C16",
        "highest peak at E of (GPa)",
    ]
    best, rows = results["best"], []
    for scale in results["scale"]:
        cases = [case for case in results["cases"] if case["scale"] == scale]
        units = [_units(cases, key) for key in ("amplitude", "deepest_wear")]
        rows.append([f"{scale:g}", *units, _stiffest(cases)])
    return (
        f"{table(head, rows)}\n\n"
        f"Calibration on E = 1: a unit of E of {1e-9 * best['unit_Pa']:g} GPa and a casing "
        f"amplitude of {best['scale']:g} gaps are closest to its two shifts, at a distance of "
        f"{best['miss']:.2f} half digits of the paper's speeds (figure: "
        "[calibration](../figures/calibration.png)). The distance of the choice made in the scenes "
        f"is {_misses(kept)}.\n"
    )


def _misses(kept: Mapping[str, dict[str, Any]]) -> str:
    return ", ".join(f"{miss(peaks):.2f} ({name})" for name, peaks in kept.items())


def _units(cases: Sequence[dict[str, Any]], key: str) -> str:
    """Units of E, GPa, at which ``key`` of the k = 4 peak is larger for E = 10 than for E = 1."""
    both = [case for case in cases if case["e1"]["4"] and case["e10"]["4"]]
    more = [case["unit_Pa"] for case in both if case["e10"]["4"][key] > case["e1"]["4"][key]]
    return ", ".join(f"{1e-9 * unit:g}" for unit in more) or "none"


def _stiffest(cases: Sequence[dict[str, Any]]) -> str:
    """E in GPa, of either coating, at which the k = 4 peak is highest; K/E is about the same."""
    peaks = [
        (case[name]["4"]["amplitude"], COATINGS[name][0] * case["unit_Pa"])
        for case in cases
        for name in COATINGS
        if case[name]["4"]
    ]
    return f"{1e-9 * max(peaks)[1]:g}" if peaks else ""
