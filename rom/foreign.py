"""Reduced models made elsewhere: what their file must hold, and what can be checked in it.

The contract is that of ``rom.model.Rom`` (rom/README.md), without provenance: the hash of the file
stands for that of the mesh. A file cannot show that its directions and signs are those of the
blade's frame, nor that one basis projected K at all speeds.
"""

from collections.abc import Iterator
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray
from scipy.linalg import eigh

from geometry.blade import EnrichedBasis, settings_of_basis
from geometry.given import tip_faults
from geometry.hats import middles
from geometry.provenance import Provenance, code_hash, file_hash
from geometry.seal import sealed
from geometry.tip import cartesian
from rom.compliance import of_places
from rom.model import CODE, DIRECTIONS, Rom, RomError

OPTIONAL = ("points", "f1", "growth")
PAGE = "rom/README.md, A reduced model from elsewhere,"
SPEEDS = 33  # over [0, Omega_m], at which K must be positive definite
SYMMETRIC = 1e-9  # of the largest entry
DEFINITE = 1e-14  # of the largest eigenvalue: round-off
SAME_F1 = 1e-3  # relative
OFF_LINE = 0.1  # of the chord: distance of a point from the camber line at its xi
# m/s, first frequency times span: that of bending is a sixth of the speed of waves, times thickness
# over span; blades of this project have 35 to 57
PACE = 2.0, 500.0
SHOWN = 5  # frequencies
UNCHECKED = (
    "directions and signs: u_r outward, u_t in the sense of rotation, u_z downstream",
    "that one basis T projected K at all speeds: superelements exported speed by speed have "
    "coordinates of their own each, and no K(Omega) goes through them",
    "that interface DoFs are the coefficients of the hat functions, or the points at their xi",
    "the error against the full model, and that of its mesh",
)


@dataclass(frozen=True)
class Report:
    """What a check of a foreign model found, a line each."""

    shown: tuple[str, ...]
    faults: tuple[str, ...]


def read_foreign(path: str | Path, blade: str) -> Rom:
    """The reduced model in a file made elsewhere, as that of ``blade``.

    Raises
    ------
    RomError
        When it cannot be read, or a check fails; a line for each fault.
    """
    rom = _read(path, blade)
    if faults := check_foreign(rom).faults:
        raise RomError("\n".join(f"{path}: {fault}" for fault in faults))
    return rom


def load_model(path: str | Path, blade: str) -> Rom:
    """The reduced model in a file of ours, or in one made elsewhere, which has no provenance.

    Raises
    ------
    geometry.provenance.ProvenanceError, RomError
        As ``Rom.load`` and ``read_foreign``.
    """
    return read_foreign(path, blade) if _elsewhere(Path(path)) else Rom.load(path)


def _elsewhere(path: Path) -> bool:
    """Whether a file holds matrices, and neither the seal nor the provenance of ours."""
    if path.suffix != ".nc" or not path.is_file() or sealed(path):
        return False
    try:
        with xr.open_dataset(path, engine="h5netcdf") as file:
            return "M" in file.variables and not {"provenance", "format"} & set(file.attrs)
    except (OSError, KeyError, TypeError, ValueError):
        return False


def report(path: str | Path) -> Report:
    """What can be seen from the file at ``path``.

    Raises
    ------
    RomError
        When it cannot be read, or fields are missing or do not fit each other.
    """
    return check_foreign(_read(path, ""))


def check_foreign(rom: Rom) -> Report:
    """Check what a reduced model shows by itself."""
    faults = [*_tip_faults(rom)] or [*_matrix_faults(rom)]
    if faults:
        return Report((), tuple(faults))
    frequencies = [rom.modes(Omega)[0][:SHOWN] / (2 * np.pi) for Omega in (0.0, rom.Omega_m)]
    if not abs(rom.f1 / frequencies[0][0] - 1) <= SAME_F1:
        faults.append(
            f"f1: {rom.f1:.6g} Hz: the matrices at rest have {frequencies[0][0]:.6g} Hz; check the "
            f"units of M (kg) and K (N/m)"
        )
    pace = frequencies[0][0] * rom.span
    if not PACE[0] <= pace <= PACE[1]:
        faults.append(
            f"M, K: first frequency at rest {frequencies[0][0]:.4g} Hz, times the span {pace:.3g} "
            f"m/s, allowed {PACE[0]:g} to {PACE[1]:g}: check the units of M (kg) and K (N/m)"
        )
    shown = [
        f"{rom.n} DoFs, {len(rom.xi)} {'points' if rom.of_points else 'patches'} with "
        f"{', '.join(rom.directions)} DoFs",
        f"M, K symmetric; M positive definite; K(Omega) positive definite at {SPEEDS} speeds up to "
        f"Omega_m = {rom.Omega_m:.6g} rad/s",
        *(
            f"frequencies {where} (Hz): {' '.join(f'{f:.2f}' for f in values)}"
            for where, values in zip(("at rest", "at Omega_m"), frequencies, strict=True)
        ),
        *_compliances(rom),
        f"tip: radius {rom.camber[:, 0].mean():.6g} m, axial length "
        f"{np.ptp(rom.camber[:, 2]):.4g} m; span {rom.span:.6g} m",
        _growth(rom),
    ]
    return Report(tuple(shown), tuple(faults))


def _read(path: str | Path, blade: str) -> Rom:
    found = _values(path)
    rom = _rom(found, Provenance(blade, file_hash(path), {}, code_hash(*CODE)))
    if faults := [*_shape_faults(rom, found["power"])]:
        raise RomError("\n".join(f"{path}: {fault}; see {PAGE[:-1]}" for fault in faults))
    return rom if "f1" in found else replace(rom, f1=_first_frequency(rom))


def _values(path: str | Path) -> dict[str, Any]:
    try:
        with xr.open_dataset(path, engine="h5netcdf") as file:
            names = [*(f.name for f in fields(Rom) if f.metadata), "power"]
            found = {name: file[name].values for name in names if name in file.variables}
    except (OSError, ValueError) as error:
        reason = str(error).splitlines()[0]
        raise RomError(f"{path}: cannot be read as NetCDF 4 ({reason})") from None
    needed = [f.name for f in fields(Rom) if f.metadata and f.name not in OPTIONAL]
    if missing := [name for name in (*needed, "power") if name not in found]:
        raise RomError(f"{path}: lacks {', '.join(missing)}: {PAGE} says what each is")
    for f in (f for f in fields(Rom) if f.name in found and f.name != "directions"):
        values, dimensions = found[f.name], len(f.metadata["dims"])
        if values.ndim != dimensions or values.dtype.kind not in "iuf":
            raise RomError(
                f"{path}: {f.name}: {values.ndim} dimensions of type {values.dtype}, needs "
                f"{dimensions} of real numbers; see {PAGE[:-1]}"
            )
    return found


def _rom(found: dict[str, Any], provenance: Provenance) -> Rom:
    """The model of the values in a file, with the settings by which a coarser one is made."""
    arrays = ("M", "K", "xi", "points", "camber", "growth")
    values = {name: np.asarray(found[name], float) for name in arrays if name in found}
    values.setdefault("points", np.empty((0, 3)))
    scalars = {name: float(found.get(name, np.nan)) for name in ("Omega_m", "span", "f1")}
    directions = tuple(map(str, np.atleast_1d(found["directions"])))
    own = len(values["M"]) - len(directions) * len(values["xi"])  # besides those of the interface
    basis = EnrichedBasis(
        natural_modes=min(max(own, 1), 100), speeds=min(max(len(values["K"]), 3), 9)
    )
    settings = {"reduced_model": provenance.mesh, "basis": settings_of_basis(basis)}
    provenance = replace(provenance, settings=settings)
    return Rom(**values, **scalars, directions=directions, provenance=provenance)


def _first_frequency(rom: Rom) -> float:
    """f1 at rest, Hz; nan where the matrices have none."""
    try:
        return float(rom.modes(0.0)[0][0] / (2 * np.pi))
    except (RomError, np.linalg.LinAlgError):
        return np.nan


def _shape_faults(rom: Rom, power: NDArray) -> Iterator[str]:
    n, n_c = len(rom.M), len(rom.xi) * len(rom.directions)
    if rom.M.shape != (n, n) or rom.K.shape[1:] != (n, n) or not rom.K.size:
        yield f"M {rom.M.shape}, K {rom.K.shape}: need (n, n) and (powers, n, n), none 0"
    if list(np.atleast_1d(power)) != [2 * p for p in range(len(rom.K))]:
        yield f"power: {power}: needs 0, 2, 4, ..., one for each K"
    if rom.directions != tuple(DIRECTIONS.values())[: len(rom.directions)]:
        yield f"directions: {rom.directions}: need {tuple(DIRECTIONS.values())}, the first or more"
    if not 0 < n_c <= n:
        yield f"xi: {len(rom.xi)} places with {len(rom.directions)} directions: needs 1 to {n} DoFs"
    if rom.of_points and rom.points.shape != (len(rom.xi), 3):
        yield f"points {rom.points.shape}: need r, theta, z of each of {len(rom.xi)} xi"
    if rom.camber.shape[1:] != (3,) or len(rom.camber) < 2:
        yield f"camber {rom.camber.shape}: needs r, theta, z of two places or more"
    if rom.growth.size and rom.growth.shape[1:] != rom.xi.shape:
        yield f"growth {rom.growth.shape}: needs (powers, {len(rom.xi)})"
    held = (rom.M, rom.K, rom.xi, rom.points, rom.camber, rom.growth, rom.Omega_m, rom.span)
    if not all(np.isfinite(values).all() for values in held):
        yield "holds values that are not finite"


def _matrix_faults(rom: Rom) -> Iterator[str]:
    for name, A in (("M", rom.M), *((f"K, power {2 * p}", K) for p, K in enumerate(rom.K))):
        if (apart := abs(A - A.T).max()) > SYMMETRIC * abs(A).max():
            yield f"{name}: not symmetric, by {apart / abs(A).max():.2g} of its largest entry"
            return
    least, *_, largest = np.linalg.eigvalsh(rom.M)
    if not least > DEFINITE * largest:
        yield (
            f"M: not positive definite, its lowest eigenvalue is {least:.3g} kg; must be above "
            f"{DEFINITE:g} of its largest, {largest:.3g} kg"
        )
        return
    for Omega in np.linspace(0, rom.Omega_m, SPEEDS):
        lowest = eigh(rom.stiffness(Omega), rom.M, eigvals_only=True, subset_by_index=[0, 0])[0]
        if not lowest > 0:
            yield (
                f"K: not positive definite at {Omega:.6g} rad/s (lowest omega^2 {lowest:.3g}); "
                f"clamped, and over 0 to Omega_m = {rom.Omega_m:.6g} rad/s, it must be"
            )
            return


def _tip_faults(rom: Rom) -> Iterator[str]:
    ends = (0.0, 1.0)
    if np.any(np.diff(rom.xi) <= 0) or rom.xi[0] < 0 or rom.xi[-1] > 1:
        yield "xi: must ascend within 0 (leading edge) to 1 (trailing edge)"
    elif not rom.of_points and (len(rom.xi) < 2 or (rom.xi[0], rom.xi[-1]) != ends):
        yield f"xi: {rom.xi[0]:g} to {rom.xi[-1]:g}: nodes of hat functions begin at 0 and end at 1"
    yield from tip_faults(rom.camber, rom.span, rom.Omega_m)
    if rom.of_points:
        yield from _points_faults(rom)


def _points_faults(rom: Rom) -> Iterator[str]:
    """Points that are not on the tip of the camber line."""
    chord = np.linalg.norm(np.diff(cartesian(rom.camber[[0, -1]]), axis=0))
    off = np.linalg.norm(cartesian(rom.points) - cartesian(rom.line(rom.xi)), axis=1)
    if off.max() > OFF_LINE * chord:
        i = int(off.argmax())
        yield (
            f"points: point {i + 1} lies {1e3 * off[i]:.3g} mm from the camber line at its xi = "
            f"{rom.xi[i]:.4g}; allowed {1e3 * OFF_LINE * chord:.3g} mm, a tenth of the chord"
        )


def _compliances(rom: Rom) -> Iterator[str]:
    """Static compliance of the tip at rest in each direction, smallest and largest place."""
    flexibility = np.linalg.inv(rom.stiffness(0.0))
    xi = rom.xi if rom.of_points else middles(len(rom.xi))
    for letter, name in zip("rtz", rom.directions, strict=False):
        values = of_places(rom.rows(xi, letter), flexibility)
        yield f"{name} compliance of the tip at rest: {values.min():.3g} to {values.max():.3g} m/N"


def _growth(rom: Rom) -> str:
    if not rom.growth.size:
        return "no growth with speed: scenes with `clearance: {at: rest}` are refused"
    at = 1e3 * rom.growth_at(rom.xi, rom.Omega_m)
    return f"growth of the tip at Omega_m: {at.min():.4g} to {at.max():.4g} mm"
