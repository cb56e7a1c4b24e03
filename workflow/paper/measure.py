"""Numbers that the claims compare, computed from results, as plain values.

Speeds are over f1(0), displacements and wear over the gap at xi = 1/16. Displacements are those at
xi = 1/16, wear is the mean over the leading eighth of the chord.
"""

from collections.abc import Mapping, Sequence
from itertools import pairwise
from time import process_time
from timeit import repeat
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr
from numpy.typing import NDArray
from scipy.stats import entropy, spearmanr

from rom.check import RomCheck
from rom.crossings import crossing
from rom.model import Rom
from rom.polynomial import evaluate
from simulate.errors.observables import error
from simulate.marching import WITH_RESULT, march, prepare
from simulate.scene import LEADING, Scene
from simulate.signals import leading_gap, leading_wear, lobe_count, spectrum
from simulate.sweeps.dataset import over_f1, scene_of, statuses
from simulate.sweeps.peak import peak_of
from workflow.paper.grid import Numbers, peak, worst
from workflow.paper.published import ENGINE_ORDER, WORST

ORDERS = range(3, 15)  # engine orders along which the paper sees peaks, or could
EVEN = np.arange(4, 15, 2)  # those of which it sees patterns in the wear
NEAR = (0.97, 1.25)  # speeds over the crossing of k at which k lobes belong to that resonance
HIGHEST, SPECTRUM_ROUNDS = 20, 10  # highest frequency of a spectrum over f1(0); its revolutions
RESONANT = 0.05  # half-width of a peak over Omega_c


def model(rom: Rom, check: RomCheck, paper: Rom, paper_check: RomCheck, nonlinear: Rom) -> Numbers:
    """Reduced models: size and error of the paper's, error of ours, K2, frequencies, crossings.

    And u_t over u_r at xi = 1/16 in mode 1 at Omega_m. ``nonlinear``: one whose K2 is not zero, as
    it is with linear prestress.
    """
    mode = paper.modes(paper.Omega_m)[1][:, 0]  # the first, at Omega_m
    tangential, radial = (paper.rows([LEADING], letter) @ mode for letter in "tr")
    return {
        "model": {
            "n": paper.n,
            "error": float(abs(paper_check.error[:, :7]).max()),
            "error_default": float(abs(check.error[:, :7]).max()),
            "speeds": len(check.speeds),
            # Eq. (3) as printed has 3/4
            "K2": {"printed": _residual(nonlinear, 3 / 4), "4/3": _residual(nonlinear, 4 / 3)},
            "frequencies": (check.full[0, :5] / check.full[0, 0]).tolist(),
            "crossings": {str(k): crossing(rom, k) for k in (4, 5, 6)},
            "tangential_over_radial": float(tangential[0] / radial[0]),
        }
    }


def _residual(rom: Rom, factor: float) -> float:
    """Largest relative residual of Eq. (3) at its three speeds.

    ``factor``: before K2, over Omega_m^4.
    """
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


def coating(runs: xr.Dataset, rom: Rom) -> Numbers:
    """One sweep: peaks of all orders, lobes at and away from them, statuses."""
    speeds, wear, lobes = _worn(runs)
    return {
        "peaks": {str(k): p for k in ORDERS if (p := peak(runs, rom, k))},
        "lobes": {"slowest": int(lobes[0]), "fastest": int(lobes[-1])},
        "orders_in_wear": _orders_seen(rom, speeds, lobes[:, None] == EVEN),
        "orders_in_harmonics": _orders_in_harmonics(rom, speeds, wear),
        "statuses": statuses(runs),
    }


def _worn(
    runs: xr.Dataset,
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.int64]]:
    """Speeds (runs,) with a result, worn depth (runs, nu), and number of worn lobes (runs,)."""
    ended = runs.isel(speed_over_f1=np.isin(runs["status"].values, WITH_RESULT))
    wear = leading_wear(ended)
    return ended["speed_over_f1"].values, wear, np.array([lobe_count(depth) for depth in wear], int)


def _orders_seen(rom: Rom, speeds: NDArray[np.float64], seen: NDArray[np.bool_]) -> list[int]:
    """Even engine orders that are ``seen`` (speeds, ``EVEN``) at a speed near their crossing."""
    low, high = np.outer(NEAR, [crossing(rom, k) for k in EVEN])
    near = (speeds[:, None] >= low) & (speeds[:, None] <= high)
    return EVEN[(seen & near).any(axis=0)].tolist()


def _orders_in_harmonics(
    rom: Rom, speeds: NDArray[np.float64], wear: NDArray[np.float64]
) -> list[int]:
    """Even engine orders k whose harmonic of the worn profile exceeds those of k - 2 and k + 2.

    Where marks of successive revolutions overlap, and lobes cannot be counted, a pattern of k still
    has that harmonic.
    """
    harmonics = np.abs(np.fft.rfft(wear, axis=1))
    beside = np.maximum(harmonics[:, EVEN - 2], harmonics[:, EVEN + 2])
    return _orders_seen(rom, speeds, harmonics[:, EVEN] > beside)


def two_five(runs: xr.Dataset, rom: Rom) -> Numbers:
    """Casing of two and five diameters: lobes at and away from the peaks of EO 4, 5, 6.

    Also the range of the angle of the lobes near the peak of EO 5.
    """
    peaks = {str(k): peak(runs, rom, k) for k in (4, 5, 6)}
    speeds, _, lobes = _worn(runs)
    swept = np.isin(speeds, over_f1(scene_of(runs).speeds.omega(rom.f1), rom))
    at_peaks = [np.abs(speeds / p["Omega_c"] - 1) <= RESONANT for p in peaks.values() if p]
    off = swept & ~np.any(at_peaks, axis=0)
    return {
        "peaks": peaks,
        "most_frequent_off_resonance": int(np.bincount(lobes[off]).argmax()) if off.any() else None,
        "five_off_resonance": float(np.mean(lobes[off] == 5)) if off.any() else None,
        "turn_deg": peaks["5"] and _turn(runs, peaks["5"]["Omega_c"], 5),
    }


def _turn(runs: xr.Dataset, Omega_c: float, k: int) -> float:
    """Range of the angle, deg, of the k-th harmonic of the wear at speeds near ``Omega_c``."""
    speeds = runs["speed_over_f1"].values
    wear = leading_wear(runs.isel(speed_over_f1=np.abs(speeds / Omega_c - 1) <= RESONANT))
    phase = np.unwrap(np.angle(np.fft.rfft(wear, axis=1)[:, k]))
    return float(np.degrees(np.ptp(phase)) / k)


def tip_force(runs: xr.Dataset, rom: Rom) -> Numbers | None:
    """A sweep with a tilted tip: peaks, force ratio, mode share and entropy at the EO 4 peak.

    None if no run near that peak has a result.
    """
    if (main := peak_of(runs, rom, 4)) is None:
        return None
    samples = scene_of(runs).record.samples_per_round
    last = runs["history"].values[main.index, 0, -SPECTRUM_ROUNDS * samples :] / leading_gap(runs)
    return {
        "peaks": {str(k): peak(runs, rom, k) for k in (4, 6)},
        "statuses": statuses(runs),
        "ratio": _ratio(runs),
        "mode_share": share_of_mode_1(last, samples),
        "disorder": disorder(last, main.Omega_c),
    }


def share_of_mode_1(u_r: NDArray[np.float64], samples_per_round: int) -> float:
    """Share of the energy of ``u_r`` within half an engine order of 4 at the peak of EO 4.

    There mode 1 vibrates at 4 Omega_c in contact. ``u_r`` spans a whole number of revolutions;
    energy is amplitude squared, without the mean. nan without any vibration.
    """
    energy = spectrum(u_r)[1:] ** 2
    orders = np.arange(1, len(energy) + 1) * samples_per_round / len(u_r)
    near, total = np.abs(orders - ENGINE_ORDER) <= 0.5, energy.sum()
    return float(energy[near].sum() / total) if total > 0 else float("nan")


def disorder(u_r: NDArray[np.float64], speed_over_f1: float) -> float:
    """Entropy of the amplitudes of ``u_r``, of the last ten revolutions, up to ``HIGHEST`` f1(0).

    Of amplitudes instead of energies, since harmonics other than mode 1 have hardly any energy; and
    without a threshold, above which lines would have to be counted.
    """
    bins = round(HIGHEST / speed_over_f1 * SPECTRUM_ROUNDS)
    return spectral_entropy(np.sqrt(spectrum(u_r)[1 : bins + 1]))


def spectral_entropy(amplitudes: NDArray[np.float64]) -> float:
    """Shannon entropy of the energy (amplitude squared) of all bins, over that of equal energies.

    0: all energy in one bin; 1: the same energy in every bin. White noise of random phase has
    1 - (1 - gamma) / ln(bins), gamma = 0.577 (Euler's constant). nan where there is no energy.
    Source: Shannon 1948; normalised as in Inouye et al. 1991.

    >>> spectral_entropy(np.array([0.0, 2.0, 0.0, 0.0])), spectral_entropy(np.ones(4))
    (0.0, 1.0)
    """
    energy = np.square(amplitudes)
    return float(entropy(energy, base=len(energy))) if energy.any() else float("nan")


def _ratio(runs: xr.Dataset) -> float:
    """Mean tangential over mean radial force, all runs with a result; 0 for radial contact."""
    if "force_tangential_mean" not in runs:
        return 0.0
    ok = runs.where(runs["status"].isin(WITH_RESULT), drop=True)
    return float(ok["force_tangential_mean"].sum() / ok["force_mean"].sum())


def table(grid: Mapping[str, Any]) -> Numbers:
    """The grid of E and K: worst case, corners, and rank correlations of Omega_c with E and K.

    Those of the peaks of EO 4; nan without a peak.
    """
    most = worst(grid)
    peaks = pd.DataFrame({**of, **(of["peaks"]["4"] or {})} for of in grid["cases"])
    by_coating = peaks.pivot(index="E", columns="K", values=["amplitude", "Omega_c"])
    amplitude, speed = by_coating["amplitude"], by_coating["Omega_c"]
    return {
        "worst": {"E": most["E"], "K": most["K"], **most["peaks"]["4"]},
        "paper_worst": amplitude.at[WORST],
        "interior_over_ends": {
            "E": _interior(amplitude[WORST[1]].values),
            "K": _interior(amplitude.loc[WORST[0]].values),
        },
        "softest": amplitude.iloc[0, 0],
        "stiffest": amplitude.iloc[-1, -1],
        "rank": {
            "E": _ranks(speed.index, speed.values.T),
            "K": _ranks(speed.columns, speed.values),
        },
        "predictable": int((peaks["status"] == "ok").sum()),
    }


def _interior(along: NDArray[np.float64]) -> float:
    """Largest inner value over the larger end value: above 1 for a maximum inside."""
    return float(along[1:-1].max() / max(along[0], along[-1]))


def _ranks(modulus: Sequence[float], lines: NDArray[np.float64]) -> list[float]:
    """Spearman's rank correlation of each line with the modulus; 0 of one that is constant."""
    return [
        float(spearmanr(modulus, line).statistic) if np.ptp(line) != 0 else 0.0 for line in lines
    ]


def main_peak(runs: xr.Dataset, rom: Rom) -> Numbers | None:
    """The EO 4 peak of a sweep: of the bare casing, of a tilted tip."""
    return peak(runs, rom, 4)


def long_run(bare: Numbers | None, cases: Sequence[Mapping[str, Any]]) -> Numbers:
    """The peak of the bare casing, and the growth of coatings over ten times the revolutions."""
    return {
        "rigid": bare,
        "growth": {run["name"]: _growth(run["amplitude"]) for run in cases},
        "status": {run["name"]: run["status"] for run in cases},
    }


def _growth(amplitude: list[float | None]) -> float | None:
    """Amplitude of the last window over that after twenty revolutions.

    The last is that of 200 revolutions, or before the end of a run that wore through; None where it
    did so within the first twenty.
    """
    marched = [value for value in amplitude if value is not None]
    return marched[-1] / marched[1] if len(marched) > 1 else None


def densities(coarse: xr.Dataset, fine: xr.Dataset) -> Numbers:
    """Change with four times the density: wear at the peak, the last speed, and away from it."""
    pairs = [(coarse.isel(speed_over_f1=[i]), fine.isel(speed_over_f1=[i])) for i in (-1, 0)]
    return {
        "wear": [_wear_change(*pair) for pair in pairs],
        "displacement": _history_change(*pairs[0]),
    }


def steps(sweeps: list[xr.Dataset]) -> Numbers:
    """Change of the displacement with each halving of the step, coarse to fine."""
    return {"changes": [_history_change(a, b) for a, b in pairwise(sweeps)]}


def _wear_change(coarse: xr.Dataset, fine: xr.Dataset) -> float:
    """Relative difference in L2 of the profiles, at the angles of the coarse one."""
    (profile,), (reference,) = leading_wear(coarse), leading_wear(fine)
    return error(profile, reference.reshape(len(profile), -1)[:, 0])


def _history_change(one: xr.Dataset, other: xr.Dataset) -> float:
    return error(one["history"].values[0, 0], other["history"].values[0, 0])


def density_cost(scene: Scene, rom: Rom) -> Numbers:
    """CPU time of one run over a 16-fold range of densities, least of three: claim C08."""
    rods = [scene.liner.rods_per_round // 2 * 4**i for i in range(3)]
    seconds = [_cpu_time(scene.but(liner__rods_per_round=nu), rom) for nu in rods]
    return {"rods": rods, "seconds": seconds, "ratio": seconds[-1] / seconds[0]}


def _cpu_time(scene: Scene, rom: Rom) -> float:
    setup = prepare(scene, rom, scene.speeds.omega(rom.f1)[0])
    march(scene, setup)  # compiled before it is timed
    return min(repeat(lambda: march(scene, setup), timer=process_time, number=1, repeat=3))


def stress(stresses: Mapping[str, Any]) -> Numbers:
    """Largest alternating stress of all speeds of ``stress.json``, MPa."""
    return {
        "alternating_MPa": 1e-6 * max(row.get("alternating", 0.0) for row in stresses["speeds"])
    }
