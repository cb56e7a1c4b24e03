"""Mean and alternating stress of a sweep, and their margin to the strength of the material."""

from typing import Any

import numpy as np

from fem.fields import away, grid_of, save_vtu
from fem.solid import read_solid
from geometry.blade import RPM, Blade
from rom.model import Rom
from rom.reconstruct import Basis
from simulate.scene import GROWING
from simulate.sweeps.dataset import Sweep, origin
from simulate.sweeps.peak_results import asked
from workflow.stress import Stresses, cycles, motion, numbers, worst

SHAPES = 12  # of the motion at all speeds
LABELS = {
    "mean_stress": "mean stress (Pa)",
    "alternating": "alternating stress (Pa)",
    "margin": "margin",
}


def write(
    blade: Blade, mesh: str, rom: Rom, basis: str, sweep: Sweep, names: dict[str, str], vtu: str
) -> dict[str, Any]:
    """Write the fields at the reported peaks; return the worst node at every speed.

    A motion that still grows has no mean and no amplitude yet: of that nothing is told.
    """
    of_basis = Basis.load(basis)
    of_basis.provenance.require(origin(sweep), basis)
    solid, fatigue = read_solid(mesh, blade.material), blade.fatigue
    moved = motion(sweep, rom.stiffness(rom.Omega_m / 2), SHAPES)
    stresses = Stresses.of(solid, of_basis, moved.shapes, blade.prestress)
    settled, (cells, points) = away(solid), grid_of(solid)
    nodes, fields = np.flatnonzero(settled), {"away from clamp and contact": settled.astype(float)}
    away_from, peaks, rows = stresses.on(nodes), {of.index for of in asked(sweep, rom)}, []
    told = (sweep[name].values.tolist() for name in ("speed", "speed_over_f1", "trend"))
    for speed, (Omega, over_f1, trend) in enumerate(zip(*told, strict=True)):
        rows.append({"speed_over_f1": over_f1, "trend": trend})
        part, a = Omega / of_basis.Omega_m, moved.at(speed)
        if trend == GROWING or len(a) == 0:
            continue
        node, found = worst(*away_from.at(part), a, fatigue)
        at = {"at_m": points[nodes[node]].tolist()}
        rows[-1] |= {name: float(of) for name, of in found.items()} | at
        if speed in peaks:
            of_all = numbers(*cycles(*stresses.at(part), a), fatigue)
            fields |= {f"{LABELS[of]}, {RPM * Omega:.0f} rpm": of_all[of] for of in of_all}
    save_vtu(points, cells, fields, vtu)
    strength = fatigue and fatigue.model_dump(mode="json")
    return {**names, "fatigue": strength, "speeds": rows}
