"""Refusals of a scene that does not fit its reduced model; those of its step are in ``setup``."""

from collections.abc import Iterator, Sequence
from math import ceil

import numpy as np
from numpy.typing import NDArray

from geometry.base import RPM, Fault
from geometry.hats import middles
from rom.model import DIRECTIONS, Rom
from simulate.contact.gaps import given_gaps, growth_fault, missing_rows
from simulate.contact.law_check import fault
from simulate.contact.places import Places, mean_footprint, rods_in_footprint, strip_places
from simulate.marching.forced import force_faults
from simulate.marching.moving_casing import LONGEST_FOOTPRINT
from simulate.marching.setup import SceneError, edge_slope, least_gap, longer_fault
from simulate.scene import (
    LEADING,
    Casing,
    Contact,
    Gaps,
    Liner,
    Profile,
    Record,
    Scene,
    Speeds,
    Stage,
)
from simulate.scene.laws import LAWS
from simulate.scene.own_laws import Unread
from simulate.scene.unbalance import Unbalance

NEAR = 3.0  # times Omega_m: a speed above is taken to be in another unit
ROUND_OFF = 1e-12  # relative, of a speed


def check_scene(scene: Scene, rom: Rom) -> None:
    """Check a scene against a reduced model, except for its step, which ``prepare`` checks.

    Raises
    ------
    SceneError
        One line for each fault.
    """
    require_sweep(scene.blade, scene.design, scene.accuracy)
    liner, casing, directions = scene.liner, scene.casing, scene.directions
    force, orbit = scene.force, scene.unbalance
    places = strip_places(rom, liner, casing)
    speeds = scene.speeds.omega(rom.f1)
    too_fast = [*_speeds(scene.speeds, rom, scene.blade)]
    allowed = speeds[speeds <= rom.Omega_m * (1 + ROUND_OFF)]  # others are a fault of their own
    outgrown = growth_fault(scene.gaps, rom, places.xi, allowed)
    has_gaps = not (scene.gaps.vary and (too_fast or outgrown))
    faults = [  # in the order of their lines
        *_model(scene.blade, scene.contact, scene.record, directions, rom),
        *too_fast,
        *_slope(casing, rom, places.slope),
        *_liner(liner, rom.camber[:, 0], mean_footprint(liner, rom)),
        *_strips(liner, rom),
        *_gaps(scene.gaps, rom),
        *outgrown,
        *(_longer(scene.stage, scene.gaps, rom, liner.m, allowed) if has_gaps else ()),
        *(_edge(scene.gaps, liner, scene.contact.profile, rom, speeds) if has_gaps else ()),
        *_moving(casing, places, rom.across, speeds.max()),
        *(force_faults(force, rom, scene.damping_ratio, allowed) if force else ()),
        *(_orbit(orbit, scene.gaps, liner, rom, allowed) if orbit and has_gaps else ()),
    ]
    if faults:
        raise SceneError(*faults)


def require_sweep(blade: str, design: str | None, accuracy: float | None) -> None:
    """Refuse the ``design`` or ``accuracy`` of a scene of which others make sweeps.

    Raises
    ------
    SceneError
        For a design, and for an accuracy whose settings are not chosen yet.
    """
    if design is not None:
        raise SceneError(
            "a table of scenes, no single sweep: run it with ./run snakemake "
            f"results/{blade}/SCENE/design.csv, or workflow.many in Python",
            key="design",
            value=design,
        )
    if accuracy is not None:
        raise SceneError(
            "no settings chosen yet: call simulate.errors.accuracy.choose first", key="accuracy"
        )


def _model(
    blade: str, contact: Contact, record: Record, directions: str, rom: Rom
) -> Iterator[Fault]:
    """A reduced model of another blade, or without the directions of a key, or gauges."""
    gauges = [*record.grids]
    if rom.provenance.blade != blade:
        yield Fault(
            f"the reduced model is of blade {rom.provenance.blade!r}; take "
            f"rom-{directions}.nc of this one: `./run snakemake results/{blade}/"
            f"rom-{directions}.nc`",
            "blade",
            blade,
            rom.provenance.blade,
        )
    if contact.along and DIRECTIONS["t"] not in rom.directions:
        friction = contact.friction
        yield Fault(
            f"the reduced model has no tangential interface DoFs; take rom-{directions}.nc: "
            f"`./run snakemake results/{rom.provenance.blade}/rom-{directions}.nc`",
            f"contact.{'tangential' if friction is None else 'friction'}",
            True if friction is None else friction,
        )
    if missing := [
        DIRECTIONS[to] for to in record.directions if DIRECTIONS[to] not in rom.directions
    ]:
        yield Fault(
            f"the reduced model has no {' and '.join(missing)} interface DoFs; take "
            f"rom-{directions}.nc: `./run snakemake results/{rom.provenance.blade}/"
            f"rom-{directions}.nc`",
            "record.history.directions",
            record.directions,
        )
    if gauges and gauges != [*rom.gauges]:
        yield Fault(
            f"the reduced model has {', '.join(rom.gauges) or 'no gauges'}; take gauges.nc of this "
            f"scene: `./run snakemake results/{blade}/<scene>/gauges.nc`",
            "record.gauges",
            ", ".join(gauges),
        )


def _slope(casing: Casing, rom: Rom, slope: NDArray[np.float64]) -> Iterator[Fault]:
    """A casing that tapers under the strips, by ``slope`` (m,), on a model without axial DoFs."""
    if not slope.any() or DIRECTIONS["z"] in rom.directions:
        return
    blade = rom.provenance.blade
    if casing.slope is None and casing.line is None:
        yield Fault(
            f"the tip of blade {blade} tapers (dr/dz from {slope.min():.3g} to "
            f"{slope.max():.3g}), and the reduced model has no axial interface DoFs: give one that "
            "has them, or `casing: {slope: 0}` for contact along the radius",
            "casing.slope",
        )
    else:
        yield Fault(
            "the reduced model has no axial interface DoFs; take rom-rtz.nc: `./run snakemake "
            f"results/{blade}/rom-rtz.nc`, or slope: 0",
            f"casing.{'line' if casing.line else 'slope'}",
            casing.slope,
        )


def _speeds(speeds: Speeds, rom: Rom, blade: str) -> Iterator[Fault]:
    highest = speeds.omega(rom.f1).max()
    if highest > rom.Omega_m * (1 + ROUND_OFF):
        allowed = rom.Omega_m / speeds.in_rad_s(rom.f1)
        yield Fault(
            f"allowed up to {allowed:.6g} (Omega_m = {RPM * rom.Omega_m:.6g} rpm)"
            f"{_remedy_of_speed(speeds, rom, blade, highest)}",
            f"speeds.{speeds.unit}",
            float(speeds.given.max()),
            {"le": allowed},
        )


def _remedy_of_speed(speeds: Speeds, rom: Rom, blade: str, highest: float) -> str:
    """Remedy for a speed above Omega_m; f1(0), the unit of the speed, is that of the mesh."""
    if speeds.over_f1 is None:
        return ""
    if highest > NEAR * rom.Omega_m:
        return "; speeds.over_f1 are over f1(0): speeds in rpm are speeds.rpm"
    return (
        f": f1(0) = {rom.f1:.5g} Hz is that of this mesh, higher on a coarser one; raise "
        f"max_speed_rpm of blade {blade} to {ceil(RPM * highest)}, or lower the speed"
    )


def _liner(liner: Liner, radius: NDArray[np.float64], footprint: float) -> Iterator[Fault]:
    """A law from outside this project, and rods and footprint that do not go with the radius."""
    law, nu = liner.law, liner.nu
    if isinstance(law, Unread):
        yield Fault(law.why, "liner.law")
    elif not isinstance(law, LAWS) and (message := fault(law)):  # pyright: ignore[reportArgumentType]
        yield Fault(
            f"{type(law).__name__}: {message}; see simulate/README.md, From Python", "liner.law"
        )
    if rods_in_footprint(footprint, radius.min(), nu) < 0.5:
        least = int(np.ceil(np.pi * radius.max() / footprint))
        yield Fault(
            f"the footprint is shorter than half a rod; allowed from {least}",
            "liner.rods_per_round",
            nu,
            {"ge": least},
        )
    around = 2 * np.pi * radius.min()
    if footprint > around:
        yield Fault(
            f"longer than the circumference; allowed up to {1e3 * around:.6g}",
            "liner.footprint_mm",
            1e3 * footprint,
            {"le": 1e3 * around},
        )


def _strips(liner: Liner, rom: Rom) -> Iterator[Fault]:
    """Numbers of strips that do not go with the points or patches of the interface.

    A strip meets the blade at its middle. With 32 patches on 16 strips that is at every other hat:
    amplitudes change by 14 %, worn volumes by 21 %. One strip is the whole chord, by choice.
    """
    n = len(rom.xi)
    if liner.rigid_key and rom.across == 2:
        yield Fault(
            f"a rigid casing ({liner.rigid_key}) is met by one row across the thickness: give the "
            "blade interface: {across: 1}",
            "liner",
        )
    if rom.of_points and liner.m != n:
        yield Fault(
            f"the interface of the reduced model has {n} points, with a strip each; allowed {n}",
            "liner.strips",
            liner.m,
            n,
        )
    elif liner.rigid_key and liner.m not in (1, n):
        yield Fault(
            f"against a rigid casing ({liner.rigid_key}) the reactions of more strips than "
            f"the {n} patches of the reduced model are not unique, and fewer strips miss some of "
            f"the patches; allowed {n} or 1, or change interface.patches of the blade",
            "liner.strips",
            liner.m,
            n,
        )
    elif liner.law.touches and 1 < liner.m < n:
        yield Fault(
            f"fewer strips than the {n} patches of the reduced model meet some of them at their "
            f"middles and miss others; allowed from {n}, or 1, or lower interface.patches of the "
            "blade",
            "liner.strips",
            liner.m,
            {"ge": n},
        )


def _gaps(of: Gaps, rom: Rom) -> Iterator[Fault]:
    """Gaps below 0 at the edges, and a line that ends above the tip or crosses it."""
    if line := of.casing.line:
        z, gaps = rom.camber[:, 2], given_gaps(of, rom, middles(len(rom.camber)))
        if not (line.z_mm[0] <= 1e3 * z.min() and 1e3 * z.max() <= line.z_mm[-1]):
            yield Fault(
                f"z_mm from {line.z_mm[0]:g} to {line.z_mm[-1]:g}: should cover the tip, from "
                f"{1e3 * z.min():.4g} to {1e3 * z.max():.4g}",
                "casing.line",
            )
        elif gaps.min() < 0:
            yield Fault(
                f"is {-1e3 * gaps.min():.4g} mm inside the tip at rest: its radius is "
                f"{1e3 * rom.camber[:, 0].min():.5g} to {1e3 * rom.camber[:, 0].max():.5g} mm",
                "casing.line",
            )
        return
    gaps = given_gaps(of, rom, [0, 1])
    if gaps.min() < 0:
        yield Fault(
            f"the gap, linear along the chord, is {1e6 * gaps.min():.3g} um at the "
            f"{'leading' if gaps[0] < 0 else 'trailing'} edge; allowed from 0: the gaps at "
            f"xi = 1/16 and 15/16 may differ by a factor of 15 at most",
            "clearance",
        )


def _longer(
    stage: Stage | None, of: Gaps, rom: Rom, strips: int, speeds: NDArray[np.float64]
) -> Sequence[Fault]:
    """A blade of a stage that is longer than its gap at one of the ``speeds``, rad/s."""
    if stage is None:
        return ()
    longer = stage.longer(float(given_gaps(of, rom, LEADING)))
    return longer_fault(longer, least_gap(of, rom, strips, speeds))


def _moving(casing: Casing, places: Places, across: int, highest: float) -> Iterator[Fault]:
    """Modes of the casing that bend under a row of the tip, or run away for want of damping.

    ``across``: rows across the thickness; ``highest``: speed, rad/s.
    """
    half = float((places.footprint / places.radius).max()) / 2 / across
    for i, mode in enumerate(casing.moves):
        order, key = ("orders", "ring") if casing.ring else ("order", f"modes.{i}")
        if mode.order * half > LONGEST_FOOTPRINT:
            most = int(LONGEST_FOOTPRINT / half)
            yield Fault(
                f"half of the arc of the tip that has one displacement is {half:.3g} rad, over "
                f"which this mode turns by {mode.order * half:.2g}; allowed up to "
                f"{LONGEST_FOOTPRINT}: orders up to {most}",
                f"casing.{key}.{order}",
                mode.order,
                {"le": most},
            )
        whirls = 2 * np.pi * mode.frequency_Hz / max(mode.order, 1)
        if mode.order and not mode.damping_ratio and highest >= whirls:
            yield Fault(
                f"without damping the mode runs away above its frequency over its order, "
                f"{RPM * whirls:.6g} rpm; the speeds go up to {RPM * highest:.6g}: give its "
                "damping, above 0",
                f"casing.{key}.damping_ratio",
                0.0,
                {"gt": 0},
            )


def _orbit(
    unbalance: Unbalance, of: Gaps, liner: Liner, rom: Rom, speeds: NDArray[np.float64]
) -> Sequence[Fault]:
    """An orbit that is not known at one of the ``speeds``, rad/s, or beyond the liner there."""
    key = "unbalance.whirl" if unbalance.whirl else "unbalance.jeffcott"
    if missing := missing_rows(unbalance.whirl, key, rom.f1, speeds):
        return missing
    for Omega in speeds:
        radius, _ = unbalance.orbit(Omega, rom.f1)
        room = liner.thickness_m + least_gap(of, rom, liner.m, [Omega])
        if radius > room:
            return [
                Fault(
                    f"its radius is {1e6 * radius:.4g} um at {RPM * Omega:.6g} rpm, gap "
                    f"and liner together have {1e6 * room:.4g} um: allowed up to that, or other "
                    "speeds",
                    key,
                    allowed={"le": 1e6 * room},
                )
            ]
    return ()


def _edge(
    of: Gaps, liner: Liner, profile: Profile | None, rom: Rom, speeds: NDArray[np.float64]
) -> Iterator[Fault]:
    """Rods that are too wide for the slope of the tip at its rubbing edge."""
    gap = least_gap(of, rom, liner.m, speeds)
    slope = edge_slope(profile, mean_footprint(liner, rom))
    fall = 2 * np.pi * rom.camber[:, 0].max() * slope
    least = fall / gap if gap > 0 else 0.0
    if liner.nu < least:
        yield Fault(
            f"at its rubbing edge the tip falls by more than the gap over one rod; allowed from "
            f"{np.ceil(least):.0f}",
            "liner.rods_per_round",
            liner.nu,
            {"ge": int(np.ceil(least))},
        )
