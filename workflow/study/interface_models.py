"""The interface on one mesh: what S keeps, what the reduced model keeps of it, compliances."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fem.interface import interface_of
from fem.matrices import Matrices
from fem.solid import read_solid
from geometry.blade import Blade
from geometry.hats import middles
from geometry.interface import tip_of
from geometry.settings import read_settings
from rom.compliance import of_strips
from rom.model import Rom
from rom.modes import ShiftInvert
from rom.reduce import reduce
from simulate.scene import Scene
from workflow.study.interface_plan import REDUCTIONS, STRESSED, Reduction
from workflow.study.interface_stress import at_peak

type Row = dict[str, Any]


def numbers(files: Any, blade: str, scene: Row) -> list[Row]:
    """A row for each number of patches of a blade, ``blade`` its file; writes its reduced models.

    ``files.matrices`` and ``files.mesh`` are its own; ``scene`` has the peak at which stresses are
    compared.
    """
    fom = Matrices.load(files.matrices)
    return on_mesh(read_settings(Blade, blade), fom, files.mesh, Scene(**scene))


def on_mesh(blade: Blade, fom: Matrices, mesh: str | Path, scene: Scene) -> list[Row]:
    """A row for each number of patches of a blade."""
    reductions = [r for r in REDUCTIONS if r.blade == fom.provenance.blade]
    rows = []
    for patches in sorted({r.patches for r in reductions}):
        own = with_patches(fom, blade, mesh, patches)
        of_patches = [r for r in reductions if r.patches == patches]
        models = [_reduced(own, blade, reduction) for reduction in of_patches]
        row = _row(own, mesh, blade, *models[0])
        if of_patches[0] in STRESSED:
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


def _reduced(fom: Matrices, blade: Blade, reduction: Reduction) -> tuple[Rom, NDArray]:
    """A reduced model, written to its file, and its basis."""
    basis = blade.changed(basis__natural_modes=reduction.modes).basis
    rom, T = reduce(fom, basis, reduction.directions)
    rom.save(reduction.file)
    return rom, T


def _row(fom: Matrices, mesh: str | Path, blade: Blade, rom: Rom, T: NDArray) -> Row:
    constant, linear = _kept(fom, mesh, blade)
    S = fom.rows(1)
    full = of_strips(S @ ShiftInvert(fom.K[0], fom.M).solve(S.T.toarray()))
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
