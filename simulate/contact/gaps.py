"""Gaps between tip and liner at a speed: as given, or those at rest less the growth of the tip."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from geometry.base import RPM, Fault, known
from rom.model import Rom
from simulate.contact.places import slope_at
from simulate.scene import Gaps
from simulate.scene.tables import OverSpeed, Shift

KNOWN = 1e-9  # relative, by which a speed may lie outside a table over the speed


def given_gaps(of: Gaps, rom: Rom, xi: ArrayLike) -> NDArray[np.float64]:
    """Gaps as given, m, of the shape of the chord fractions ``xi``: `casing.line` less the tip."""
    line, xi = of.casing.line, np.asarray(xi, dtype=float)
    if line is None:
        return known(of.clearance, "clearance").gaps(xi, rom.span)
    r, _, z = rom.line(xi.ravel()).T
    return (line.radius(z) - r).reshape(xi.shape)


def gaps_at(of: Gaps, rom: Rom, xi: ArrayLike, Omega: float) -> NDArray[np.float64]:
    """Gaps g0 (m), of the shape of the chord fractions ``xi``, at ``Omega`` (rad/s).

    Given at rest, the tip has grown by its static equilibrium and with its temperature. On a casing
    that tapers the tip's axial displacement changes them too: its static one, and the shift of the
    rotor.
    """
    xi = np.asarray(xi, dtype=float)
    gaps, along = given_gaps(of, rom, xi), xi.ravel()
    moved = of.casing.shift(Omega, rom.f1) + (rom.advance_at(along, Omega) if of.at_rest else 0.0)
    if np.any(moved):
        gaps = gaps + _opened(of, rom, along, moved).reshape(xi.shape)
    if not of.at_rest:
        return gaps
    thermal = of.clearance.thermal_growth if of.clearance else None
    grown = rom.growth_at(along, Omega).reshape(xi.shape)
    return gaps - (grown + (thermal.at(Omega, rom.f1) / 1e6 if thermal else 0.0))


def lean_of_gaps(of: Gaps, rom: Rom, xi: NDArray[np.float64], Omega: float) -> NDArray[np.float64]:
    """Gap at the edge ahead less that at the edge behind (k,), m; 0 for gaps in operation.

    Given at rest, they lose the growth of each edge, and what its axial displacement opens.
    """
    if not of.at_rest:
        return np.zeros(len(xi))
    opened = slope_at(rom, of.casing, xi) * rom.advance_at(xi, Omega, leans=True)
    return opened - rom.growth_at(xi, Omega, leans=True)


def _opened(
    of: Gaps, rom: Rom, xi: NDArray[np.float64], moved: NDArray[np.float64] | float
) -> NDArray[np.float64]:
    """Radius (k,), m, that the casing has more where the tip is after it ``moved`` downstream, m.

    s times it on a casing of slope s.
    """
    if (line := of.casing.line) is None:
        return slope_at(rom, of.casing, xi) * moved
    z = rom.line(xi)[:, 2]
    return line.radius(z + moved) - line.radius(z)


def missing_rows(
    table: OverSpeed | None, key: str, f1: float, speeds: NDArray[np.float64]
) -> list[Fault]:
    """The fault of a ``table`` that does not cover one of the ``speeds``, rad/s; or none."""
    first, last = table.range(f1) if table else (0.0, np.inf)
    return [
        Fault(
            f"covers {RPM * first:.6g} to {RPM * last:.6g} rpm, not the {RPM * Omega:.6g} rpm of "
            "speeds: add rows",
            key,
            allowed=(RPM * first, RPM * last),
        )
        for Omega in speeds
        if not first * (1 - KNOWN) <= Omega <= last * (1 + KNOWN)
    ][:1]


def growth_fault(
    of: Gaps, rom: Rom, xi: NDArray[np.float64], speeds: NDArray[np.float64]
) -> list[Fault]:
    """The fault of a gap that growth or shift close at one of ``speeds`` (rad/s); or none.

    ``xi``: chord fractions at which the tip meets the strips.
    """
    clearance, shift = of.clearance, of.casing.axial_shift_um
    if not (of.at_rest or shift) or not speeds.size:
        return []
    key = "clearance" if of.casing.line is None else "casing.line"
    if of.at_rest and not rom.growth.size:
        return [
            Fault(
                "the reduced model does not know the growth of its tip with speed; allowed is "
                "running, with the gaps in operation",
                "clearance.at" if key == "clearance" else key,
                "rest",
                ["running"],
            )
        ]
    tables = {
        "clearance.thermal_growth": clearance and clearance.thermal_growth,
        "casing.axial_shift_um": shift if isinstance(shift, Shift) else None,
    }
    for name, table in tables.items():
        if missing := missing_rows(table, name, rom.f1, speeds):
            return missing
    gaps = np.array(
        [
            gaps_at(of, rom, xi, Omega) - abs(lean_of_gaps(of, rom, xi, Omega)) / 2
            for Omega in speeds
        ]
    )
    at, i = np.unravel_index(gaps.argmin(), gaps.shape)
    Omega, given = speeds[at], float(given_gaps(of, rom, xi[i]))
    if not gaps[at, i] < 0 <= given:
        return []
    closes = "the tip grows" if of.at_rest else "the shift of the rotor closes it"
    return [
        Fault(
            f"the gap {'at rest ' if of.at_rest else ''}is {1e6 * given:.4g} um at "
            f"xi = {xi[i]:.3g}, and {closes} there by {1e6 * (given - gaps[at, i]):.4g} um at "
            f"{RPM * Omega:.6g} rpm ({Omega / rom.omega1:.4g} f1(0)): contact before the casing "
            "distorts; allowed from that, or lower speeds",
            key,
            allowed={"ge": 1e6 * (given - gaps[at, i])},
        )
    ]
