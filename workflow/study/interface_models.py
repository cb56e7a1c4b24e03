"""The interface on one mesh: what S keeps, what the reduced model keeps of it, compliances."""

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from fem.interface import interface_of
from fem.matrices import Matrices
from fem.solid import read_solid
from geometry.blade import Blade
from geometry.hats import hats, middles
from geometry.interface import tip_of
from rom.model import Rom
from rom.modes import ShiftInvert
from rom.reduce import reduce
from simulate.scene import Scene
from workflow.study.interface_stress import at_peak

type Row = dict[str, Any]


class Reduction(NamedTuple):
    """A reduced model of the study: patches, natural modes, interface directions."""

    patches: int
    modes: int
    directions: str = "r"

    @property
    def name(self) -> str:
        """As its file is called."""
        return f"{self.patches}-{self.modes}-{self.directions}"


MODES, RICH = 24, 36  # natural modes: the default, and half as many more
DEFAULT = Reduction(16, MODES)
OF_MESH = {  # the models of each blade
    "reference-coarse": (Reduction(8, MODES), DEFAULT, Reduction(16, MODES, "rt")),
    "reference": (
        Reduction(8, MODES),
        DEFAULT,
        Reduction(32, MODES),
        Reduction(16, RICH),
        Reduction(16, MODES, "rt"),
        Reduction(32, MODES, "rt"),
        Reduction(16, RICH, "rt"),
    ),
    "reference-fine": (Reduction(8, MODES), DEFAULT, Reduction(16, MODES, "rt")),
    "rotor37": (Reduction(8, MODES), DEFAULT),
    "rotor37-fine": (Reduction(8, MODES), DEFAULT),
}


STRESSED = ("reference", "reference-fine")  # blades whose stress is compared, from 16 patches


def on_mesh(
    blade: Blade, fom: Matrices, mesh: str | Path, scene: Scene, folder: str | Path
) -> list[Row]:
    """A row for each number of patches of a blade; its reduced models go into ``folder``.

    ``scene`` has the peak at which stresses are compared.
    """
    reductions = OF_MESH[fom.provenance.blade]
    rows = []
    for patches in sorted({r.patches for r in reductions}):
        own = with_patches(fom, blade, mesh, patches)
        models = list(_models(own, blade, [r for r in reductions if r.patches == patches], folder))
        row = _row(own, mesh, blade, *models[0])
        if fom.provenance.blade in STRESSED and patches >= DEFAULT.patches:
            row["stress"] = at_peak(scene, blade, own, mesh, *models[0])
        rows.append(row)
    return rows


def with_patches(fom: Matrices, blade: Blade, mesh: str | Path, patches: int) -> Matrices:
    """The matrices with the interface operator of so many patches."""
    variant = blade.changed(interface={"patches": patches})
    interface = interface_of(read_solid(str(mesh), blade.material), variant)
    told = replace(
        fom.provenance, settings=fom.provenance.settings | {"interface": {"patches": patches}}
    )
    return replace(fom, S=interface.S, xi=interface.xi, provenance=told)


def _models(
    fom: Matrices, blade: Blade, reductions: list[Reduction], folder: str | Path
) -> Iterator[tuple[Rom, NDArray]]:
    for reduction in reductions:
        basis = blade.changed(basis__natural_modes=reduction.modes).basis
        rom, T = reduce(fom, basis, reduction.directions)
        rom.save(Path(folder, f"{reduction.name}.nc"))
        yield rom, T


def _row(fom: Matrices, mesh: str | Path, blade: Blade, rom: Rom, T: NDArray) -> Row:
    constant, linear = _kept(fom, mesh, blade)
    S = fom.rows(1)
    full = _of_strips(S @ ShiftInvert(fom.K[0], fom.M).solve(S.T.toarray()))
    n = len(full)
    P = rom.rows(middles(n))
    reduced = np.diag(P @ np.linalg.inv(rom.stiffness(0.0)) @ P.T)
    return {
        "blade": fom.provenance.blade,
        "patches": n,
        "n": rom.n,
        "constant": constant,
        "linear": linear,
        "ST": float(np.abs(S @ T - np.eye(n, rom.n)).max()),
        "compliance_of_model": float(np.abs(reduced / full - 1).max()),
        "compliance_m_per_N": full.tolist(),
    }


def _kept(fom: Matrices, mesh: str | Path, blade: Blade) -> tuple[float, float]:
    """Errors of the coefficients of u_r = 1 and u_r = xi, of the largest of which is one."""
    solid = read_solid(str(mesh), blade.material)
    tip = tip_of(solid.tip, solid.V.tabulate_dof_coordinates())
    x, y, _ = fom.coordinates.T
    radial = np.column_stack([x, y, 0 * x]) / np.hypot(x, y)[:, None]
    S = fom.rows(1)
    constant = S @ radial.ravel() - 1
    linear = S @ (radial * tip.xi(fom.coordinates)[:, None]).ravel() - fom.xi
    return float(np.abs(constant).max()), float(np.abs(linear).max())


def _of_strips(C: NDArray) -> NDArray:
    """Compliance, m/N, amid as many strips as there are patches, each under its own load."""
    n = len(C)
    P = hats(middles(n), np.linspace(0, 1, n))
    return np.diag(P @ C @ P.T)
