"""What the page shows of a sweep: facts as plain values, and arrays over the speeds."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from simulate.observables import leading_gap, lobe_count
from simulate.peak import along_order
from workflow.figures.response import Response

ORDERS = (2, 3, 4, 5, 6, 7, 8, 10, 12, 14)  # engine orders of the critical-speed diagram
HIGHEST = 2.5  # f / f1(0) of spectra
FLOOR = 1e-6  # gaps, least amplitude on a logarithmic scale
ANGLES, COARSE = 720, 180  # around the casing: of profiles, and of the liner's surface
WINDOWS = 16  # of the history in each round, with the least and the largest displacement

type Arrays = dict[str, NDArray[np.float64]]


def arrays(response: Response) -> Arrays:
    """Arrays by name, speeds first; lengths over the gap, amplitudes as their log10.

    along (speeds, orders); spectrum (speeds, bins); worn (speeds, angles) of the leading eighth;
    liner (speeds, strips, coarse angles); history (speeds, windows, 2), where it was recorded;
    inward (angles), the casing's distortion.
    """
    sweep, gap = response.sweep, leading_gap(response.sweep)
    theta = np.arange(ANGLES) * 2 * np.pi / ANGLES
    found = {"inward": response.scene.casing.inward(theta, gap) / gap}
    if "wear" in sweep:
        found["worn"] = around(response.wear, ANGLES)
        found["liner"] = around(sweep["wear"].values / gap, COARSE)
    if "spectrum" in sweep:
        found["along"] = log10(np.stack([along_order(sweep, k) for k in ORDERS], axis=1))
        found["spectrum"] = log10(response.spectrum[:, : shown_bins(response)])
    if "history" in sweep:
        found["history"] = envelope(response)
    return found


def log10(amplitude: NDArray[np.float64]) -> NDArray[np.float64]:
    """Logarithm of an amplitude, at least that of ``FLOOR``; nan stays."""
    return np.log10(np.maximum(amplitude, FLOOR))


def around(depth: NDArray[np.float64], angles: int) -> NDArray[np.float64]:
    """Profiles (..., nu), rods at 2 pi j / nu, at as many ``angles`` (..., angles)."""
    nu = depth.shape[-1]
    nearest = np.rint(np.arange(angles) * nu / angles).astype(int) % nu
    return depth[..., nearest].astype(float)


def shown_bins(response: Response) -> int:
    """Bins of the spectra up to ``HIGHEST`` at the slowest speed."""
    return int(HIGHEST / response.speeds[0] * response.scene.record.spectrum_rounds) + 2


def envelope(response: Response) -> NDArray[np.float64]:
    """Least and largest displacement (speeds, windows, 2) at xi = 1/16 in each window."""
    u_r = response.u_r
    windows = WINDOWS * response.scene.rounds
    parts = u_r[:, : u_r.shape[1] // windows * windows].reshape(len(u_r), windows, -1)
    return np.stack([parts.min(axis=-1), parts.max(axis=-1)], axis=-1)


def facts(response: Response, blade: str, scene: str) -> dict[str, Any]:
    """Names, units, and values of each speed, as plain values."""
    sweep, rom = response.sweep, response.rom
    return {
        "blade": blade,
        "scene": scene,
        "label": response.label.replace("$", "").replace("\\sigma_Y", "σ_Y").replace("\n", " "),
        "f1_Hz": rom.f1,
        "gap_um": 1e6 * leading_gap(sweep),
        "rounds": response.scene.rounds,
        "spectrum_rounds": response.scene.record.spectrum_rounds,
        "orders": list(ORDERS),
        "code": sweep.attrs["code"],
        "speeds": response.speeds.tolist(),
        "f1": sweep["f1"].values.tolist(),
        "status": response.status.tolist(),
        "lobes": [lobe_count(wear) for wear in response.wear] if "wear" in sweep else [],
        "peaks": [
            {"k": peak.k, "index": peak.index, "crossing": peak.crossing, "at_end": peak.at_end}
            for peak in response.peaks
        ],
        "energies": {
            str(name): of.tolist()
            for name, of in zip(sweep["energy"].values, sweep["ledger"].values.T, strict=True)
        },
        "doubts": doubts(response),
    }


def doubts(response: Response) -> dict[str, list[float | None]]:
    """By name: relative departures from twins and errors, by speed; None where not known."""
    known = {}
    for name, says in (("departure", "twin"), ("error", "error")):
        for observable in response.observables if name in response.sweep else []:
            values = response.sweep[name].sel(observable=observable).values
            known[f"{says}, {observable}"] = [
                float(value) if np.isfinite(value) else None for value in values
            ]
    return known
