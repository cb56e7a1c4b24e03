"""||Y|| over both moduli in Pa: units of E at which the paper's worst case is the worst, claim C17.

For sigma_Y near 0 the liner depends on its two moduli in Pa alone: the paper's table at any unit of
E is a rectangle of this map, which the unit shifts along the diagonal.
"""

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import RegularGridInterpolator

from rom.model import Rom
from simulate.scene import Scene
from workflow.markdown import table
from workflow.paper.cases import STIFFNESS_SCALES as SCALES
from workflow.paper.cases import WORST, E, K, of_coating
from workflow.paper.peaks import case

E_PA = np.geomspace(2.5e8, 1.6e12, 10)
K_PA = np.geomspace(1e8, 4e11, 8)
UNIT_PA = 1e9  # of the moduli in the scenes
UNITS_PA = np.geomspace(2.5e8, 8e9, 31)  # for which the paper's table lies within the map
ORDER = 4


def row(scene: Scene, rom: Rom, scale: float) -> list[dict[str, Any]]:
    """All moduli at one casing amplitude."""
    here = scene.but(liner__law__unit_Pa=UNIT_PA, casing__scale=scale)
    return [_case(here, rom, scale, young, plastic) for young in E_PA for plastic in K_PA]


def _case(scene: Scene, rom: Rom, scale: float, young: float, plastic: float) -> dict[str, Any]:
    swept = case(of_coating(scene, young / UNIT_PA, plastic / UNIT_PA), rom, (ORDER,))
    peak = swept["peaks"][str(ORDER)]
    amplitude = peak["amplitude"] if peak else None
    return {"scale": scale, "E_Pa": young, "K_Pa": plastic, "amplitude": amplitude}


def stiffness(rows: Iterable[Sequence[dict[str, Any]]]) -> dict[str, Any]:
    """The whole map, and the worst case within the paper's table for each unit of E."""
    cases = [case for row in rows for case in row]
    maps = {scale: amplitudes(cases, scale) for scale in SCALES}
    return {
        "E_Pa": E_PA.tolist(),
        "K_Pa": K_PA.tolist(),
        "cases": cases,
        "worst": [
            {"scale": scale, "unit_Pa": unit, **_worst(amplitude, unit)}
            for scale, amplitude in maps.items()
            for unit in UNITS_PA.tolist()
        ],
    }


def amplitudes(cases: Iterable[dict[str, Any]], scale: float) -> NDArray[np.float64]:
    """||Y|| over the gap (E, K) at one casing amplitude; nan where no run has a result."""
    values = [case["amplitude"] for case in cases if case["scale"] == scale]
    return np.array(values, float).reshape(len(E_PA), len(K_PA))


def _worst(amplitude: NDArray[np.float64], unit: float) -> dict[str, float]:
    """Worst case of the paper's table at a unit of E, and the paper's worst case over it."""
    at = RegularGridInterpolator((np.log(E_PA), np.log(K_PA)), amplitude)
    table = [(e, k) for e in E for k in K]
    values = at(np.log(unit * np.array(table)))
    young, plastic = table[int(np.nanargmax(values))]
    share = values[table.index(WORST)] / np.nanmax(values)
    return {"E": young, "K": plastic, "share_of_paper_worst": float(share)}


def units(results: dict[str, Any]) -> str:
    """Markdown: units of E at which the paper's worst case is within 5 % of the worst."""
    head = [
        "casing amplitude (gaps)",
        "(10, 4.55) within 5 % of the worst at units of E of (GPa)",
        f"worst at {1e-9 * UNITS_PA[-1]:g} GPa, (E, K)",
    ]
    rows = []
    for scale in SCALES:
        of_scale = [case for case in results["worst"] if case["scale"] == scale]
        near = [1e-9 * case["unit_Pa"] for case in of_scale if case["share_of_paper_worst"] >= 0.95]
        span = f"{min(near):.2g} to {max(near):.2g}" if near else "none"
        last = of_scale[-1]
        rows.append([f"{scale:g}", span, f"({last['E']:g}, {last['K']:g})"])
    return table(head, rows) + "\n"
