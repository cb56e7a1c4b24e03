"""From results to the numbers that the claims compare, plain and small enough to be a fixture.

Speeds over f1(0), displacements and wear over the gap of node 1, ratios and shares as they are.
"""

from collections.abc import Mapping
from itertools import pairwise
from time import process_time
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray
from scipy.stats import spearmanr

from rom.check import RomCheck
from rom.model import Rom
from rom.polynomial import evaluate
from simulate.observables import mode_share, spectral_entropy, spectrum
from simulate.peaks import crossing
from simulate.run import march, prepare
from simulate.scene import Scene
from simulate.sweep import scene_of
from workflow.paper.cases import WORST
from workflow.paper.grid import at, worst
from workflow.paper.peaks import at_peak, gap_of, lobes_over_speed, peak, statuses

ORDERS = range(4, 15)  # engine orders looked at
NEAR = (0.97, 1.25)  # speeds over the crossing of k at which k lobes belong to that resonance
HIGHEST, SEEN = 80, 1e-3  # engine orders, and share of the largest amplitude, of a bandwidth
AWAY = 0.26  # a speed between the resonances of k = 4 and k = 6

type Numbers = dict[str, Any]


def model(rom: Rom, check: RomCheck, paper: Rom, paper_check: RomCheck) -> Numbers:
    """Reduced model: size and error of the paper's basis, the default's error, K2, frequencies."""
    return {
        "n": paper.n,
        "error": float(abs(paper_check.error[:, :7]).max()),
        "error_default": float(abs(check.error[:, :7]).max()),
        "speeds": len(check.speeds),
        "K2": {name: _residual(paper, factor) for name, factor in K2_FACTORS.items()},
        "frequencies": (check.full[0, :5] / check.full[0, 0]).tolist(),
        "crossings": {str(k): crossing(rom, k) for k in (4, 5, 6)},
        "tangential_over_radial": _direction(paper),
    }


K2_FACTORS = {"printed": 3 / 4, "4/3": 4 / 3}  # before K2 in Eq. (3), over Omega_m^4


def _residual(rom: Rom, factor: float) -> float:
    """Largest relative miss of Eq. (3) at its own three speeds, with a factor before K2."""
    m = rom.Omega_m
    speeds = (0.0, m / 2, m)
    rest, half, full = (rom.stiffness(Omega) for Omega in speeds)
    K1 = (16 * half - full - 15 * rest) / (3 * m**2)
    K2 = factor / m**4 * (full - 4 * half + 3 * rest)
    misses = (
        np.linalg.norm(evaluate([rest, K1, K2], Omega) - K) / np.linalg.norm(full - rest)
        for Omega, K in zip(speeds, (rest, half, full), strict=True)
    )
    return float(max(misses))


def _direction(rom: Rom) -> float:
    """u_t over u_r of node 1 in mode 1 at Omega_m."""
    mode = rom.modes(rom.Omega_m)[1][:, 0]
    return float(mode[rom.tangential[0]] / mode[rom.radial[0]])


def coating(found: xr.Dataset, rom: Rom) -> Numbers:
    """One sweep: peaks of all orders, lobes on and off them."""
    speeds, lobes = lobes_over_speed(found)
    between = int(np.abs(speeds - AWAY).argmin())
    ends = {"slowest": 0, "fastest": -1, f"at {AWAY}": between}
    return {
        "peaks": {str(k): p for k in ORDERS if (p := peak(found, rom, k))},
        "lobes": {where: int(lobes[i]) for where, i in ends.items()},
        "orders_in_wear": _orders_in_wear(rom, speeds, lobes),
        "statuses": statuses(found),
    }


def _orders_in_wear(rom: Rom, speeds: NDArray[np.float64], lobes: NDArray[np.int64]) -> list[int]:
    """Even engine orders k with k worn lobes somewhere near their crossing."""

    def seen(k: int) -> bool:
        low, high = (share * crossing(rom, k) for share in NEAR)
        return bool((lobes[(speeds >= low) & (speeds <= high)] == k).any())

    return [k for k in ORDERS if k % 2 == 0 and seen(k)]


def two_five(found: xr.Dataset, rom: Rom) -> Numbers:
    """Casing of two and five diameters: lobes, peaks of k = 4, 5, 6, turn of the pattern."""
    _, lobes = lobes_over_speed(found)
    counts = np.bincount(lobes)
    at, _ = at_peak(found, rom, 4)
    return {
        "peaks": {str(k): peak(found, rom, k) for k in (4, 5, 6)},
        "most_frequent_lobes": int(counts.argmax()),
        "share_of_five": float(np.mean(lobes == 5)),
        "turn_deg": _turn(found, at.Omega_c),
    }


def _turn(found: xr.Dataset, Omega_c: float, within: float = 0.05) -> float:
    """Range of the angle of the four-lobe part of the wear near ``Omega_c``, deg of the casing."""
    speeds = found["speed_over_f1"].values
    wear = found["wear"].values[np.abs(speeds / Omega_c - 1) <= within, 0]
    phase = np.unwrap(np.angle(np.fft.rfft(wear, axis=1)[:, 4]))
    return float(np.degrees(np.ptp(phase)) / 4)


def tip_force(found: xr.Dataset, rom: Rom) -> Numbers:
    """A sweep with a tilted tip: peaks, force ratio, order in the response at the k = 4 peak."""
    at, run = at_peak(found, rom, 4)
    u_r = run["history"].values[0] / gap_of(found)
    samples = scene_of(found).record.samples_per_round
    last = u_r[len(u_r) // 2 :]
    return {
        "peaks": {str(k): peak(found, rom, k) for k in (4, 6)},
        "statuses": statuses(found),
        "ratio": _ratio(found),
        "mode_share": mode_share(u_r, samples, at.Omega_c, float(run["f1"])),
        "entropy": spectral_entropy(spectrum(last)[1:]),
        "bandwidth": bandwidth(spectrum(last)[1:]),
    }


def bandwidth(amplitudes: NDArray[np.float64]) -> float:
    """Share of the bins, up to engine order ``HIGHEST``, above ``SEEN`` of the largest amplitude.

    ``amplitudes`` of the last ten rounds, without bin 0: ten bins to an engine order.
    """
    bins = amplitudes[: 10 * HIGHEST]
    return float((bins > SEEN * bins.max()).mean())


def _ratio(found: xr.Dataset) -> float:
    """Mean tangential over mean radial force, all runs with a result; 0 where none is modelled."""
    if "force_tangential_mean" not in found:
        return 0.0
    ok = found.where(found["status"] == "ok", drop=True)
    return float(ok["force_tangential_mean"].sum() / ok["force_mean"].sum())


def table(found: Mapping[str, Any]) -> Numbers:
    """The grid of E and K: where the worst case is, its corners, ranks, predictable cases."""
    cases = [c for c in found["cases"] if c["peaks"]["4"]]
    most = worst(found)
    young, plastic = np.array(found["E"]), np.array(found["K"])
    along_E = [_amplitude(at(found, e, WORST[1])) for e in young]
    ends = max(along_E[0], along_E[-1])
    shift = [c["peaks"]["4"]["Omega_c"] for c in cases]
    return {
        "worst": {"E": most["E"], "K": most["K"], **most["peaks"]["4"]},
        "paper_worst": _amplitude(at(found, *WORST)),
        "interior_over_ends": max(along_E[1:-1]) / ends,
        "softest": _amplitude(at(found, young[0], plastic[0])),
        "stiffest": _amplitude(at(found, young[-1], plastic[-1])),
        "rank": {x: float(spearmanr([c[x] for c in cases], shift).statistic) for x in ("E", "K")},
        "cases": len(found["cases"]),
        "with_peak": len(cases),
        "predictable": sum(c["peaks"]["4"]["status"] == "ok" for c in cases),
    }


def _amplitude(case: Mapping[str, Any]) -> float:
    peak = case["peaks"]["4"]
    return peak["amplitude"] if peak else 0.0


def long_run(found: Mapping[str, Any]) -> Numbers:
    """Ten times the rounds, and the bare casing."""
    return {
        "rigid": found["rigid"],
        "growth": {run["name"]: _growth(run["amplitude"]) for run in found["cases"]},
        "status": {run["name"]: run["status"] for run in found["cases"]},
    }


def _growth(amplitude: list[float | None]) -> float:
    """Amplitude of the last window marched over that after twenty rounds."""
    last = [value for value in amplitude if value is not None][-1]
    return last / amplitude[1]


def densities(coarse: xr.Dataset, fine: xr.Dataset) -> Numbers:
    """Change with four times the density: wear on the peak, the last speed, and off it."""
    pairs = [(coarse.isel(speed=[i]), fine.isel(speed=[i])) for i in (-1, 0)]
    return {
        "wear": [_wear_change(*pair) for pair in pairs],
        "displacement": _history_change(*pairs[0]),
    }


def steps(sweeps: list[xr.Dataset]) -> Numbers:
    """Change of the displacement with each halving of the step, coarse to fine."""
    return {"changes": [_history_change(a, b) for a, b in pairwise(sweeps)]}


def _wear_change(coarse: xr.Dataset, fine: xr.Dataset) -> float:
    """L2, over the fine profile's, on the angles of the coarse one."""
    one, other = coarse["wear"].values[0, 0], fine["wear"].values[0, 0]
    return _change(one, other.reshape(len(one), -1)[:, 0])


def _history_change(one: xr.Dataset, other: xr.Dataset) -> float:
    return _change(one["history"].values[0, 0], other["history"].values[0, 0])


def _change(one: NDArray[np.float64], other: NDArray[np.float64]) -> float:
    return float(np.linalg.norm(one - other) / np.linalg.norm(other))


def density_cost(scene: Scene, rom: Rom) -> Numbers:
    """CPU time of one run over a 16-fold range of densities, best of three: claim C08."""
    rods = [scene.liner.rods_per_round // 2 * 4**i for i in range(3)]
    seconds = [_cpu_time(scene.changed(liner__rods_per_round=nu), rom) for nu in rods]
    return {"rods": rods, "seconds": seconds, "ratio": seconds[-1] / seconds[0]}


def _cpu_time(scene: Scene, rom: Rom) -> float:
    setup, times = prepare(scene, rom, scene.speeds.omega(rom.f1)[0]), []
    march(scene, setup)  # compiled before it is timed
    for _ in range(3):
        start = process_time()
        march(scene, setup)
        times.append(process_time() - start)
    return min(times)


def edition(
    sweeps: Mapping[str, xr.Dataset], rom: Rom, grid: Mapping[str, Any], grown: Mapping[str, Any]
) -> Numbers:
    """All that one set of scenes gives.

    Parameters
    ----------
    sweeps
        e1, e10: the two coatings; two_five: the casing of two and five diameters; tilted,
        tangential: the tilted tip without and with tangential force.
    """
    return {
        **{part: coating(sweeps[part], rom) for part in ("e1", "e10")},
        "two_five": two_five(sweeps["two_five"], rom),
        **{part: tip_force(sweeps[part], rom) for part in ("tilted", "tangential")},
        "grid": table(grid),
        "long": long_run(grown),
    }


def stress(peak: Mapping[str, Any]) -> Numbers:
    """Largest von Mises stress at the displacement farthest beyond the gap, MPa; of rotation."""
    return {
        "largest_MPa": 1e-6 * peak["von_mises"]["largest_Pa"],
        "of_rotation_MPa": 1e-6 * peak["von_mises_of_prestress"]["largest_Pa"],
    }
