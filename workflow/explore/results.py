"""The sweep on the page: facts as plain values, and arrays over the speeds."""

from collections.abc import Iterable, Mapping
from math import isinf, isnan
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from geometry.base import RPM
from geometry.tip import EDGES
from simulate.contact.places import closing_rows
from simulate.signals import amplitude, leading_gap, lobe_count
from simulate.sweeps.peak import along_order
from workflow.figures.annotations import frequencies_over_speed
from workflow.figures.response import Response, liner_and_tip

HIGHEST = 2.5  # f / f1(0) of spectra, at the slowest speed
FLOOR = 1e-6  # gaps, least amplitude on a logarithmic scale
ANGLES, COARSE = 720, 180  # around the casing: of profiles, and of the liner's surface
DIFFERENCES = {  # of a run from another, by the name in the sweep
    "departure": "relative difference from the twin run",
    "error": "relative error",
}


def arrays(response: Response) -> dict[str, NDArray[np.float64]]:
    """Arrays by name, speeds first; lengths over the gap, amplitudes as their log10.

    along (speeds, orders); spectrum (speeds, bins); worn (speeds, angles) of the leading eighth;
    liner (speeds, strips, coarse angles); history (speeds, windows, 2), its range; inward (angles),
    the casing's distortion, of harmonics that travel at the start; signal (speeds, times), u_r at
    the place of the motion in the last revolution; blade_along (speeds, blades, orders) of a stage.
    Only data that the sweep holds.
    """
    sweep, gap = response.sweep, leading_gap(response.sweep)
    theta = np.arange(ANGLES) * 2 * np.pi / ANGLES
    outputs = {  # the variable of the sweep that each is made of, and how
        "worn": ("wear", lambda: around(response.wear, ANGLES)),
        "liner": ("wear", lambda: around(sweep["wear"].values / gap, COARSE)),
        "along": (
            "spectrum",
            lambda: log10(np.stack([along_order(sweep, k) for k in response.orders], axis=1)),
        ),
        "spectrum": ("spectrum", lambda: log10(_spectrum(response))),
        "history": ("envelope", lambda: sweep["envelope"].values / gap),
        "signal": ("motion", lambda: _signal(response) / gap),
        "blade_along": (
            "blade_along",
            lambda: log10(sweep["blade_along"].sel(order=response.orders).values / gap),
        ),
    }
    return {"inward": response.scene.casing.inward(theta, gap) / gap} | {
        name: make() for name, (needed, make) in outputs.items() if needed in sweep
    }


def _spectrum(response: Response) -> NDArray[np.float64]:
    """Spectra (speeds, bins) up to ``HIGHEST`` at the slowest speed."""
    bins = int(HIGHEST / response.speeds.min() * response.scene.record.spectrum_rounds) + 2
    return response.spectrum[:, :bins]


def _signal(response: Response) -> NDArray[np.float64]:
    """u_r (speeds, times), m, at the place of the motion in the last revolution."""
    sweep = response.sweep
    rows = closing_rows(response.rom, response.scene.casing, np.array(EDGES))
    moves = sweep["place"].values == EDGES[1] if "place" in sweep else False
    of_both = sweep["motion"].values @ rows.T
    return np.where(np.reshape(moves, (-1, 1)), of_both[..., 1], of_both[..., 0])


def log10(amplitude: NDArray[np.float64]) -> NDArray[np.float64]:
    """Logarithm of an amplitude, at least that of ``FLOOR``; nan stays."""
    return np.log10(np.maximum(amplitude, FLOOR))


def around(depth: NDArray[np.float64], angles: int) -> NDArray[np.float64]:
    """Profiles (..., nu), rods at 2 pi j / nu, at as many ``angles`` (..., angles)."""
    nu = depth.shape[-1]
    nearest = np.rint(np.arange(angles) * nu / angles).astype(int) % nu
    return depth[..., nearest].astype(float)


def facts(
    response: Response, blade: str, scene: str, campbell: Mapping[str, Any]
) -> dict[str, Any]:
    """Names, units, natural frequencies, and values of each speed, as plain values.

    ``campbell``: as of ``simulate.sweeps.crossings.critical``.
    """
    sweep, rom = response.sweep, response.rom
    speeds, frequencies = frequencies_over_speed(rom, campbell["modes"])
    energies = zip(sweep["energy"].values, sweep["ledger"].values.T, strict=True)
    return {
        "blade": blade,
        "scene": scene,
        "label": liner_and_tip(response.scene)
        .replace("$", "")
        .replace("\\sigma_Y", "σ_Y")
        .replace("\n", " "),
        "place": response.place.replace("$\\xi$", "ξ"),
        "norms": response.units["speed"][0].scale == 1.0,
        "campbell": {"speeds": speeds.tolist(), "frequencies": frequencies.T.tolist()},
        "crossings": [
            (row["modes"][0], row["k"], row["rpm"] / (RPM * rom.omega1))
            for row in campbell["crossings"]
        ],
        "blades": of_blades(sweep),
        "signal_time": sweep["motion_time"].values.tolist() if "motion" in sweep else [],
        "f1_Hz": sweep.attrs["f1_Hz"],
        "gap_um": 1e6 * leading_gap(sweep),
        "rounds": response.scene.rounds,
        "at_most": "at most " if response.scene.until else "",
        "travels": bool(response.scene.casing.travelling),
        "spectrum_rounds": response.scene.record.spectrum_rounds,
        "orders": response.orders,
        "of_casing": sorted(response.scene.casing.orders),
        "highest": HIGHEST,
        "speeds": response.speeds.tolist(),
        "f1": sweep["f1"].values.tolist(),
        "status": response.status.tolist(),
        "trend": response.trend.tolist(),
        "has_result": response.has_result.tolist(),
        "lobes": [lobe_count(wear) for wear in response.wear] if "wear" in sweep else [],
        "peaks": [
            {
                "k": reported.k,
                "name": reported.name,
                "index": reported.index,
                "says": reported.rises_from,
                "amplitude": reported.amplitude,
                "at_end": reported.at_end,
            }
            for reported in response.peaks
        ],
        "tables": [  # lists by name
            {
                "says": "energy of the run, J",
                "of": {str(name): plain(joules) for name, joules in energies},
            },
            *of_casing(sweep),
            *(
                {
                    "says": says,
                    "of": {
                        one: plain(sweep[name].sel(observable=one).values)
                        for one in response.observables
                    },
                }
                for name, says in DIFFERENCES.items()
                if name in sweep and sweep[name].notnull().any()
            ),
        ],
        "meanings": sweep["energy"].attrs["long_name"],
    }


def of_blades(sweep: xr.Dataset) -> dict[str, Any] | None:
    """Of a stage: the worst blade and those that rub at each speed, and what they differ in."""
    if "blade" not in sweep:
        return None
    return {
        "worst": sweep["worst"].values.tolist(),
        "rubs": (sweep["blade_contact_share"].values > 0).tolist(),
        "longer_um": (1e6 * sweep["longer"].values).tolist(),
        "percent": (1e2 * sweep["frequency"].values).tolist(),
        "displacement_um": [plain(values) for values in 1e6 * sweep["blade_displacement"].values.T],
    }


def of_casing(sweep: xr.Dataset) -> list[dict[str, Any]]:
    """Radial motion of a casing that moves, um, largest and by mode; empty of a rigid one."""
    if "casing_motion" not in sweep:
        return []
    found = {"largest": sweep["casing_motion"].values}
    if "casing_spectrum" in sweep:
        by_mode = amplitude(sweep["casing_spectrum"].values, rounds=1).T
        names = zip(sweep["casing_order"].values, sweep["casing_frequency"].values, strict=True)
        found |= {
            f"{i}: order {n}, {Hz:.6g} Hz": by_mode[i - 1] for i, (n, Hz) in enumerate(names, 1)
        }
    of = {name: plain(1e6 * values) for name, values in found.items()}
    return [{"says": "radial motion of the casing, µm", "of": of}]


def plain(values: Iterable[float]) -> list[float | str | None]:
    """Plain values: None where not known; inf is a run that ended otherwise than its companion."""
    return [
        None if isnan(value) else "ended differently" if isinf(value) else float(value)
        for value in values
    ]
