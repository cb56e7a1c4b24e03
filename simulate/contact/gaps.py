"""Gaps between tip and liner at a speed: as given, or those at rest less the growth of the tip."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from geometry.project import Fault
from rom.model import Rom
from simulate.scene import Clearance

KNOWN = 1e-9  # relative, by which a speed may lie outside the table of thermal growth


def gaps_at(clearance: Clearance, rom: Rom, xi: ArrayLike, Omega: float) -> NDArray[np.float64]:
    """Gaps g0 (m), of the shape of the chord fractions ``xi``, at ``Omega`` (rad/s).

    With `clearance.at: rest` the tip has grown by its static equilibrium and with its temperature.
    """
    given, xi = clearance.gaps(xi, rom.span), np.asarray(xi, dtype=float)
    if not clearance.at_rest:
        return given
    thermal, grown = clearance.thermal_growth, rom.growth_at(xi.ravel(), Omega).reshape(xi.shape)
    return given - (grown + (thermal.growth(Omega, rom.f1) if thermal else 0.0))


def growth_fault(
    clearance: Clearance, rom: Rom, xi: NDArray[np.float64], speeds: NDArray[np.float64]
) -> list[Fault]:
    """The fault of a gap at rest that the tip outgrows at one of ``speeds`` (rad/s); or none.

    ``xi``: chord fractions at which the tip meets the strips.
    """
    if not clearance.at_rest or not speeds.size:
        return []
    if not rom.growth.size:
        return [
            Fault(
                "the reduced model does not know the growth of its tip with speed; allowed is "
                "running, with the gaps in operation",
                "clearance.at",
                "rest",
                ["running"],
            )
        ]
    if thermal := clearance.thermal_growth:
        first, last = thermal.range(rom.f1)
        for Omega in speeds:
            if not first * (1 - KNOWN) <= Omega <= last * (1 + KNOWN):
                return [
                    Fault(
                        f"covers {first:.6g} to {last:.6g} rad/s, not the {Omega:.6g} rad/s of "
                        "speeds: add rows",
                        "clearance.thermal_growth",
                        allowed=(first, last),
                    )
                ]
    gaps = np.array([gaps_at(clearance, rom, xi, Omega) for Omega in speeds])
    at, i = np.unravel_index(gaps.argmin(), gaps.shape)
    if gaps[at, i] >= 0:
        return []
    Omega, given = speeds[at], float(clearance.gaps(xi[i], rom.span))
    return [
        Fault(
            f"the gap at rest is {given:.4g} m at xi = {xi[i]:.3g}, and the tip grows there by "
            f"{given - gaps[at, i]:.4g} m at {Omega:.6g} rad/s "
            f"({Omega / rom.omega1:.4g} f1(0)): contact before the casing distorts; "
            "allowed from that growth, or lower speeds",
            "clearance",
            allowed={"ge": given - gaps[at, i]},
        )
    ]
