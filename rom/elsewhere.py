"""Reduced models made elsewhere: demands on their file, and checks of it.

The contract is that of ``rom.model.Rom`` (rom/README.md), without provenance: the hash of the file
stands for that of the mesh. A file cannot show that its directions and signs are those of the
blade's frame, nor that one basis projected K at all speeds.
"""

from collections.abc import Iterator
from dataclasses import fields, replace
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh

from geometry.base import (
    UNREADABLE,
    Fault,
    Provenance,
    code_hash,
    failed,
    file_hash,
    refuse,
    require,
    sealed,
    shown,
)
from geometry.blade import EnrichedBasis, settings_of_basis
from geometry.elsewhere import OFF_LINE, SYMMETRIC, tip_checks
from geometry.stored import netcdf
from geometry.tip import cartesian
from rom.model import CODE, DIRECTIONS, Rom, RomError

NAMES = tuple(DIRECTIONS.values())
ALLOWED = (NAMES[:1], NAMES[:2], NAMES, NAMES[::2])  # of the interface DoFs
OPTIONAL_ARRAYS = ("points", "growth", "advance", "speeds", "slope", "u_t", "sides", "measured")
OPTIONAL = (*OPTIONAL_ARRAYS, "f1", "across", "gauges", "gauge_rows")
PAGE = "rom/README.md, A reduced model from elsewhere,"
SPEEDS = 33  # over [0, Omega_m], at which K must be positive definite
DEFINITE = 1e-14  # of the largest eigenvalue: round-off
SAME_F1 = 1e-3  # relative
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


def read_elsewhere(path: str | Path, blade: str) -> Rom:
    """The reduced model in a file made elsewhere, as that of ``blade``.

    Raises
    ------
    RomError
        When it cannot be read, or a check fails; a line for each fault.
    """
    variables = _values(path)
    rom = _rom(variables, blade, file_hash(path))
    refuse(
        _shape_faults(rom, variables["power"])
        or _tip_faults(rom)
        or [*islice(_matrix_faults(rom), 1)],
        kind=RomError,
        file=path,
    )
    f1 = float(rom.modes(0.0)[0][0] / (2 * np.pi))
    rom = rom if "f1" in variables else replace(rom, f1=f1)
    refuse(_frequency_faults(rom, f1), kind=RomError, file=path)
    return rom


def load_model(path: str | Path, blade: str) -> Rom:
    """The reduced model in a file of ours, or in one made elsewhere, which has no provenance.

    Raises
    ------
    geometry.base.provenance.ProvenanceError, RomError
        As ``Rom.load`` and ``read_elsewhere``.
    """
    return read_elsewhere(path, blade) if _elsewhere(Path(path)) else Rom.load(path)


def _elsewhere(path: Path) -> bool:
    """Whether a file holds matrices, and neither the seal nor the provenance of ours."""
    if path.suffix != ".nc" or not path.is_file() or sealed(path):
        return False
    try:
        with netcdf(path) as file:
            return "M" in file.variables and not {"provenance", "format"} & set(file.attrs)
    except UNREADABLE:
        return False


def described(rom: Rom) -> list[str]:
    """What a reduced model made elsewhere says of itself, a line each."""
    frequencies = [rom.modes(Omega)[0][:SHOWN] / (2 * np.pi) for Omega in (0.0, rom.Omega_m)]
    return [
        f"{rom.n} DoFs, {len(rom.xi)} {'points' if rom.of_points else 'patches'} with "
        f"{', '.join(rom.directions)} DoFs",
        f"M, K symmetric; M positive definite; K(Omega) positive definite at {SPEEDS} speeds up to "
        f"Omega_m = {rom.Omega_m:.6g} rad/s",
        *(
            f"frequencies {where} (Hz): {' '.join(f'{f:.2f}' for f in values)}"
            for where, values in zip(("at rest", "at Omega_m"), frequencies, strict=True)
        ),
        *(
            f"{name} compliance of the tip at rest: {values.min():.3g} to {values.max():.3g} m/N"
            for name, values in zip(rom.directions, rom.compliance(0.0).T, strict=True)  # of places
        ),
        f"tip: radius {rom.camber[:, 0].mean():.6g} m, axial length "
        f"{np.ptp(rom.camber[:, 2]):.4g} m; span {rom.span:.6g} m",
        _growth(rom),
    ]


def _values(path: str | Path) -> dict[str, Any]:
    dims = {f.name: f.metadata["dims"] for f in fields(Rom) if f.metadata} | {"power": ("power",)}
    try:
        with netcdf(path) as file:
            variables = {name: file[name].values for name in dims if name in file.variables}
    except UNREADABLE as error:
        raise RomError(f"cannot be read as NetCDF 4 ({shown(str(error))})", file=path) from None
    if missing := [name for name in dims if name not in (*variables, *OPTIONAL)]:
        raise RomError(f"lacks {', '.join(missing)}: {PAGE} says what each is", file=path)
    require(
        *(
            (
                values.ndim == len(dims[name]) and values.dtype.kind in "iuf",
                Fault(
                    f"{values.ndim} dimensions of type {values.dtype}, needs {len(dims[name])} of "
                    f"real numbers; see {PAGE[:-1]}",
                    name,
                ),
            )
            for name, values in variables.items()
            if name not in ("directions", "power")
        ),
        kind=RomError,
        file=path,
    )
    return variables


def _rom(variables: dict[str, Any], blade: str, mesh: str) -> Rom:
    """The model of the values in a file, with the settings by which a coarser one is made."""
    values: dict[str, Any] = {
        "points": np.empty((0, 3)),
        **{
            name: np.asarray(variables[name], float)
            for name in ("M", "K", "xi", "camber", *OPTIONAL_ARRAYS)
            if name in variables
        },
        **{name: float(variables.get(name, np.nan)) for name in ("Omega_m", "span", "f1")},
        "across": int(across) if (across := variables.get("across", 1)) in (1, 2) else 0,
    }
    directions = tuple(map(str, np.atleast_1d(variables["directions"])))
    # DoFs besides those of the interface
    fixed_modes = len(values["M"]) - values["across"] * len(directions) * len(values["xi"])
    basis = EnrichedBasis(
        natural_modes=min(max(fixed_modes, 1), 100), speeds=min(max(len(values["K"]), 3), 9)
    )
    settings = {"reduced_model": mesh, "basis": settings_of_basis(basis)}
    return Rom(
        **values,
        directions=directions,
        provenance=Provenance(blade, mesh, settings, code_hash(*CODE)),
    )


def _shape_faults(rom: Rom, power: NDArray) -> list[str]:
    n, n_c = len(rom.M), rom.across * len(rom.xi)
    held = (
        *(rom.M, rom.K, rom.xi, rom.points, rom.camber, rom.sides, rom.growth, rom.Omega_m),
        rom.span,
    )
    faults = failed(
        (
            rom.M.shape == (n, n) and rom.K.shape[1:] == (n, n) and rom.K.size > 0,
            f"M {rom.M.shape}, K {rom.K.shape}: need (n, n) and (powers, n, n), none 0",
        ),
        (
            list(np.atleast_1d(power)) == [2 * p for p in range(len(rom.K))],
            f"power: {shown(power.tolist())}: needs 0, 2, 4, ..., one for each K",
        ),
        (
            rom.directions in ALLOWED,
            f"directions: {shown(rom.directions)}: need {NAMES}, the first or more, or radial and "
            "axial",
        ),
        (
            len(rom.xi) > 1 and 0 < n_c * len(rom.directions) <= n,
            f"xi: {len(rom.xi)} places with {len(rom.directions)} directions: needs two places or "
            f"more, 1 to {n} DoFs",
        ),
        (
            not rom.of_points or rom.points.shape == (len(rom.xi), 3),
            f"points {rom.points.shape}: need r, theta, z of each of {len(rom.xi)} xi",
        ),
        (
            rom.camber.shape[1:] == (3,) and len(rom.camber) >= 2,
            f"camber {rom.camber.shape}: needs r, theta, z of two places or more",
        ),
        (
            rom.slope.shape in ((0,), (len(rom.camber),)),
            f"slope {rom.slope.shape}: needs one for each place of camber",
        ),
        (
            rom.across == 1 or (rom.across == 2 and rom.sides.size > 0 and not rom.of_points),
            "across: needs 1, or 2 for patches whose sides are given",
        ),
        (
            rom.sides.shape in ((2, 0), (2, len(rom.camber))),
            f"sides {rom.sides.shape}: need the angle of both at each place of camber",
        ),
        (
            all(not of.size or of.shape[1:] == (n_c,) for of in (rom.growth, rom.advance)),
            f"growth {rom.growth.shape}, advance {rom.advance.shape}: need (powers, {n_c})",
        ),
        (rom.u_t.size in (0, 2 * n), f"u_t {rom.u_t.shape}: needs (2, {n})"),
        (
            all(np.isfinite(values).all() for values in held),
            "holds values that are not finite",
        ),
    )
    return [f"{fault}; see {PAGE[:-1]}" for fault in faults]


def _matrix_faults(rom: Rom) -> Iterator[str]:
    """Faults of M and K; only the first can be relied on."""
    for name, A in (("M", rom.M), *((f"K, power {2 * p}", K) for p, K in enumerate(rom.K))):
        if (asymmetry := abs(A - A.T).max()) > SYMMETRIC * abs(A).max():
            yield f"{name}: not symmetric, by {asymmetry / abs(A).max():.2g} of its largest entry"
    least, *_, largest = np.linalg.eigvalsh(rom.M)
    if not least > DEFINITE * largest:
        yield (
            f"M: not positive definite, its lowest eigenvalue is {least:.3g} kg; must be above "
            f"{DEFINITE:g} of its largest, {largest:.3g} kg"
        )
    for Omega in np.linspace(0, rom.Omega_m, SPEEDS):
        lowest = eigh(rom.stiffness(Omega), rom.M, eigvals_only=True, subset_by_index=[0, 0])[0]
        if not lowest > 0:
            yield (
                f"K: not positive definite at {Omega:.6g} rad/s (lowest omega^2 {lowest:.3g}); "
                f"clamped, and over 0 to Omega_m = {rom.Omega_m:.6g} rad/s, it must be"
            )


def _frequency_faults(rom: Rom, f1: float) -> list[str]:
    """Faults against the first frequency at rest of the matrices, ``f1`` (Hz)."""
    faults = failed(
        (
            abs(rom.f1 / f1 - 1) <= SAME_F1,
            f"f1: {rom.f1:.6g} Hz: the matrices at rest have {f1:.6g} Hz",
        ),
        (
            PACE[0] <= f1 * rom.span <= PACE[1],
            f"M, K: first frequency at rest {f1:.4g} Hz, times the span {f1 * rom.span:.3g} m/s, "
            f"allowed {PACE[0]:g} to {PACE[1]:g}",
        ),
    )
    return [f"{fault}: check the units of M (kg) and K (N/m)" for fault in faults]


def _tip_faults(rom: Rom) -> list[str]:
    xi, chord = rom.xi, np.linalg.norm(np.diff(cartesian(rom.camber[[0, -1]]), axis=0))
    points = rom.points if rom.of_points else rom.line(xi)
    off = np.linalg.norm(cartesian(points) - cartesian(rom.line(xi)), axis=1)
    i = int(off.argmax())
    return failed(
        (
            np.all(np.diff(xi) > 0) and xi[0] >= 0 and xi[-1] <= 1,
            "xi: must ascend within 0 (leading edge) to 1 (trailing edge)",
        ),
        (
            rom.of_points or (xi[0], xi[-1]) == (0, 1),
            f"xi: {xi[0]:g} to {xi[-1]:g}: nodes of hat functions begin at 0 and end at 1",
        ),
        (
            not rom.sides.size or _about(rom.sides, rom.camber, chord),
            "sides: need angles (rad) behind and ahead of those of camber, by half the chord at "
            "most",
        ),
        (
            off[i] <= OFF_LINE * chord,
            f"points: point {i + 1} lies {1e3 * off[i]:.3g} mm from the camber line at its xi = "
            f"{xi[i]:.4g}; allowed {1e3 * OFF_LINE * chord:.3g} mm, a tenth of the chord",
        ),
        *tip_checks(rom.camber, rom.span, rom.Omega_m),
    )


def _about(sides: NDArray[np.float64], camber: NDArray[np.float64], chord: float) -> np.bool:
    """Whether ``sides`` lie behind and ahead of the ``camber`` line, near it."""
    behind, ahead = (sides - camber[:, 1]) * camber[:, 0]
    return np.all(behind < ahead) and max(-behind.min(), ahead.max()) < chord / 2


def _growth(rom: Rom) -> str:
    if not rom.growth.size:
        return "no growth with speed: scenes with `clearance: {at: rest}` are refused"
    growth = 1e3 * rom.growth_at(rom.xi, rom.Omega_m)
    return f"growth of the tip at Omega_m: {growth.min():.4g} to {growth.max():.4g} mm"
