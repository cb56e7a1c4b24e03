"""Blades of a prior: shapes from its ranges, each with the hub radius of the paper's crossing.

Chords, camber, edges and material are those of a blade that the rule gives.
"""

from collections.abc import Mapping
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TypedDict

import numpy as np

from fem.assemble import assemble
from geometry.blade import Blade
from geometry.mesh import build_mesh
from geometry.project import MeshError, SettingsError, known
from rom.model import Rom
from rom.modes import ModesError
from rom.reduce import reduce
from rom.speeds import basis_speeds
from simulate.scene import LEADING
from workflow.identify.priors import SHAPE, Priors, sobol
from workflow.paper.printed import CROSSING, ENGINE_ORDER

SHAPES, SEED = 2**10, 4  # tried at most, of all blades; their Sobol sequence
RADII = (100.0, 2000.0)  # mm, of hubs
SLENDER = 3.0  # hub radius over span, the first that is tried
STIFFENING = 1.6  # of a bar: dB / d(radius / span) in f1^2 = f1(0)^2 + B Omega^2 (Southwell 1921)
WANTED = ENGINE_ORDER**2 - CROSSING[ENGINE_ORDER] ** -2  # B of the paper's crossing
CLOSE = 0.01  # of B: 5e-4 of the crossing
TRIALS = 8  # hub radii; three do
XI = np.linspace(LEADING, 1 - LEADING, 15)  # places of the tip
TOP = 0.402  # highest speed of a model over f1(0): above the paper's 0.4


class BladeNumbers(TypedDict):
    """A blade of a prior, as its file has it."""

    places: list[float]  # of its shape, in the unit cube
    shape: dict[str, float]
    hub_radius_mm: float
    max_speed_rad_s: float
    softness: float  # of mode 1 at the tip, m/N
    others: float  # that of all other modes over it
    leading: float  # motion of mode 1 at the leading edge over its root mean square along the chord
    rejected: int  # shapes before it that cannot be: no valid section or mesh, no such hub


def of_prior(
    priors: Priors, base: Blade, names: Mapping[str, str], blades: int, rom: str
) -> BladeNumbers:
    """One of the ``blades`` of a prior; its reduced model is written to ``rom``.

    It is the first shape that can be of every ``blades``-th one of the sequence.

    Raises
    ------
    geometry.project.errors.SettingsError
        When none can be; it says why not the last.
    """
    name, refused = f"{names['prior']}-{names['number']}", ""
    for rejected, places in enumerate(
        sobol(SHAPES, len(SHAPE), SEED)[int(names["number"]) :: blades]
    ):
        shape = {key: float(value[0]) for key, value in priors.values(places[None], SHAPE).items()}
        try:
            blade, model = at_crossing(of_shape(base, shape), name)
        except (SettingsError, MeshError) as error:
            refused = str(error)
            continue
        model.save(rom)
        return {
            "places": places.tolist(),
            "shape": shape,
            "hub_radius_mm": known(blade.sections, "sections").hub_radius_mm,
            "max_speed_rad_s": blade.max_speed_rad_s,
            "rejected": rejected,
            **tip(model),
        }
    raise SettingsError(f"no shape of the prior can be; the last: {refused}", key=name)


def of_shape(base: Blade, shape: Mapping[str, float]) -> Blade:
    """The blade with another shape, and the hub radius that is tried first."""
    sections = {f"sections__{SHAPE[name]}": value for name, value in shape.items()}
    return base.but(**sections, sections__hub_radius_mm=SLENDER * shape["span_mm"])


def at_crossing(blade: Blade, name: str) -> tuple[Blade, Rom]:
    """The blade, and its reduced model, with the hub radius of the paper's crossing of EO 4.

    By secants: B is nearly linear in the radius. The highest speed follows from f1(0).

    Raises
    ------
    geometry.project.errors.SettingsError, geometry.project.errors.MeshError
        When the shape cannot be, or has no such hub in ``RADII``.
    """
    sections = known(blade.sections, "sections")
    radius, slope = sections.hub_radius_mm, STIFFENING / sections.span_mm
    before: tuple[float, float] | None = None  # radius and B
    for _ in range(TRIALS):
        if not RADII[0] < radius < RADII[1]:
            break
        blade = blade.but(sections__hub_radius_mm=radius)
        try:
            model = reduced(blade, name)
        except ModesError:  # unstable at the highest speed of another blade, far above its own
            blade = blade.but(max_speed_rad_s=blade.max_speed_rad_s / 2)
            continue
        B = stiffening(model)
        if before and abs(B - WANTED) < CLOSE:
            return blade, model
        if before:
            slope = (B - before[1]) / (radius - before[0])
        before, radius = (radius, B), radius + (WANTED - B) / slope
        blade = blade.but(max_speed_rad_s=TOP * model.omega1)
    raise SettingsError("no hub with the crossing of EO 4", key="sections.hub_radius_mm")


def reduced(blade: Blade, name: str) -> Rom:
    """Reduced model of a blade, radial interface; its mesh is not kept."""
    with TemporaryDirectory() as folder:
        mesh = Path(folder) / "blade.msh"
        build_mesh(blade, mesh)
        speeds = basis_speeds(blade.basis, blade.max_speed_rad_s)
        return reduce(assemble(blade, name, mesh, speeds), blade.basis, "r")[0]


def stiffening(rom: Rom) -> float:
    """B in f1^2 = f1(0)^2 + B Omega^2 at the paper's crossing, or the model's highest speed."""
    Omega = min(CROSSING[ENGINE_ORDER] * rom.omega1, rom.Omega_m)
    return float((rom.modes(Omega)[0][0] ** 2 - rom.omega1**2) / Omega**2)


def tip(rom: Rom) -> dict[str, float]:
    """What contact sees of a blade: `softness`, `others`, `leading` of ``BladeNumbers``.

    Mean over the chord of the radial displacement under a unit force at the same place, by modes at
    the paper's crossing; the motion at the leading edge is negative where it opposes the mean.
    """
    omega, Phi = rom.modes(CROSSING[ENGINE_ORDER] * rom.omega1)
    u = rom.rows(XI, "r") @ Phi / omega
    first, *others = (u**2).mean(axis=0)
    leading = u[0, 0] * np.sign(u[:, 0].mean()) / np.sqrt(first)
    return {
        "softness": float(first),
        "others": float(sum(others) / first),
        "leading": float(leading),
    }
