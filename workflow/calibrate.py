"""Calibrate the unit of E and the casing amplitude on the paper's two peak shifts for E = 1.

Claim C11: Omega_c over the blade's own linear crossing is 1.129 for k = 4 and 1.059 for k = 6. The
grid is searched whole, so that the table also shows what other choices would give. All else is then
prediction.

    ./run python workflow/calibrate.py results/reference/rom-r.nc -o results/calibration.csv
"""

import argparse
import csv
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from itertools import product
from math import hypot

import numpy as np

from geometry.files import whole
from geometry.settings import read_settings
from rom.model import Rom
from simulate.observables import linear_crossing, order_amplitude, peak_along_order, spectrum
from simulate.run import march, prepare
from simulate.scene import Scene

TARGETS = {4: 1.129, 6: 1.059}  # Omega_c over the linear crossing
RATIOS = np.arange(1.0, 1.2, 0.01)  # speeds searched, over the linear crossing
UNITS_PA = (1e9, 2e9, 4e9, 8e9, 1.6e10)
AMPLITUDES_GAPS = (1.25, 1.5, 1.75, 2.0, 2.5, 3.0)  # the sum of the harmonics, at the bumps
SCENE = "workflow/scenes/paper-e1.yaml"


def crossings(rom: Rom) -> dict[int, float]:
    """Linear crossing f1(Omega) = k Omega of each target, over f1(0)."""
    speeds = np.linspace(0.05, rom.Omega_m / (2 * np.pi * rom.f1), 200)
    f1 = [rom.modes(2 * np.pi * rom.f1 * s)[0][0] / (2 * np.pi * rom.f1) for s in speeds]
    return {k: linear_crossing(np.array(f1), speeds, k) for k in TARGETS}


def variant(scene: Scene, unit_Pa: float, amplitude_gaps: float) -> Scene:
    """The scene with another unit of E and the casing's harmonics scaled to another amplitude."""
    scale = amplitude_gaps / sum(h.amplitude_gaps for h in scene.casing.harmonics)
    harmonics = [
        h.model_copy(update={"amplitude_gaps": scale * h.amplitude_gaps})
        for h in scene.casing.harmonics
    ]
    law = scene.liner.law.model_copy(update={"unit_Pa": unit_Pa})
    return scene.model_copy(
        update={
            "liner": scene.liner.model_copy(update={"law": law}),
            "casing": scene.casing.model_copy(update={"harmonics": harmonics}),
        }
    )


def shift(scene: Scene, rom: Rom, k: int, crossing: float) -> tuple[float, float]:
    """Omega_c over the crossing, and the peak over the gap of node 1, along engine order ``k``."""
    ratios = RATIOS[RATIOS * crossing * 2 * np.pi * rom.f1 <= rom.Omega_m]
    kept = scene.record.spectrum_rounds * scene.record.samples_per_round
    spectra = []
    for speed in ratios * crossing:
        outcome = march(scene, prepare(scene, rom, 2 * np.pi * rom.f1 * speed))
        u = outcome.u_r[-kept:, 0] if outcome.status == "ok" else np.full(kept, np.nan)
        spectra.append(spectrum(u))  # nan where a run failed: no peak there
    orders = np.arange(len(spectra[0])) / scene.record.spectrum_rounds
    amplitude = order_amplitude(np.array(spectra), orders, k)
    peak = peak_along_order(ratios, amplitude, k, 1.0)
    return peak.Omega_c, peak.amplitude / scene.clearance.gaps(len(rom.points), rom.span)[0]


def row(rom_path: str, choice: tuple[float, float]) -> dict[str, float]:
    """One grid point: both shifts and how far they are from the targets."""
    rom = Rom.load(rom_path)
    scene = variant(read_settings(Scene, SCENE), *choice)
    found = {k: shift(scene, rom, k, crossing) for k, crossing in crossings(rom).items()}
    miss = hypot(*(found[k][0] - target for k, target in TARGETS.items()))
    result = {"unit_Pa": choice[0], "amplitude_gaps": choice[1]}
    for k, (ratio, amplitude) in found.items():
        result |= {f"shift_k{k}": round(ratio, 4), f"peak_gaps_k{k}": round(float(amplitude), 4)}
    return result | {"miss": round(miss, 4)}


def main() -> None:
    """Search the grid, write the table, print the best choice."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("rom")
    parser.add_argument("-o", "--output", default="results/calibration.csv")
    parser.add_argument("--cores", type=int, default=2)
    options = parser.parse_args()
    choices = list(product(UNITS_PA, AMPLITUDES_GAPS))
    with ProcessPoolExecutor(options.cores) as pool:
        rows = []
        for result in pool.map(partial(row, options.rom), choices):
            print(result, flush=True)
            rows.append(result)
    rows.sort(key=lambda r: r["miss"])
    with whole(options.output) as temporary, open(temporary, "w", newline="") as file:
        writer = csv.DictWriter(file, rows[0])
        writer.writeheader()
        writer.writerows(rows)
    print("best:", rows[0])


if __name__ == "__main__":
    main()
