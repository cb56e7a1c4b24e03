"""The interface on one mesh: errors of S and the reduced model, compliances, largest stress."""

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fem.fields import away, on_solid
from fem.interface_operator import interface_of
from fem.matrices import Matrices
from fem.solid import Solid, read_solid
from geometry.blade import Blade
from geometry.hats import middles
from geometry.interface import tip_of
from rom.full_model import compliance_of_strips
from rom.model import Rom
from rom.modes import ShiftInvert
from rom.reconstruct import Basis
from rom.reduce import reduce
from simulate.marching import largest_state
from simulate.scene import Scene
from simulate.sweeps.sweep import sweep
from workflow.study.trade import Row

PATCHES = {  # numbers of patches whose operators are checked, by blade
    "reference-coarse": (8, 16),
    "reference": (8, 16, 32),
    "reference-fine": (8, 16),
    "rotor37": (8, 16),
    "rotor37-fine": (8, 16),
}
# Blades and patches whose stress is compared: the first with each of the others.
STRESSED = (("reference", 16), ("reference-fine", 16), ("reference", 32))
WIDTHS = 2.48e-3, 3.75e-3  # m, a row of elements and a patch, the same on all meshes


def numbers(files: Any, blade: str, scene: Row) -> list[Row]:
    """A row for each number of patches of the blade in the file ``blade``.

    ``files.matrices`` and ``files.mesh`` are the blade's; stresses are compared at the peak of
    ``scene``.
    """
    settings, fom = Blade.load(blade), Matrices.load(files.matrices)
    solid = read_solid(str(files.mesh), settings.material)
    name, rows = fom.provenance.blade, []
    for patches in PATCHES[name]:
        interface = interface_of(solid, settings.but(interface__patches=patches))
        matrices = replace(fom, S=interface.S, xi=interface.xi)
        model = reduce(matrices, settings.basis, "r")
        rows.append(_row(matrices, solid, *model))
        if (name, patches) in STRESSED:
            rows[-1]["stress"] = at_peak(
                Scene(**scene), settings.prestress, solid, matrices, *model
            )
    return rows


def _row(fom: Matrices, solid: Solid, rom: Rom, T: NDArray) -> Row:
    constant, linear = _kept(fom, solid)
    S = fom.rows("r")
    full = compliance_of_strips(S @ ShiftInvert(fom.K[0], fom.M).solve(S.T.toarray()), fom.across)
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


def _kept(fom: Matrices, solid: Solid) -> tuple[float, float]:
    """Largest errors of the coefficients of S for the fields u_r = 1 and u_r = xi."""
    tip = tip_of(solid.tip, solid.V.tabulate_dof_coordinates())
    x, y, _ = fom.coordinates.T
    radial = np.column_stack([x, y, 0 * x]) / np.hypot(x, y)[:, None]
    S = fom.rows("r")
    constant = S @ radial.ravel() - 1
    linear = S @ (radial * tip.xi(fom.coordinates)[:, None]).ravel() - fom.xi
    return float(np.abs(constant).max()), float(np.abs(linear).max())


def at_peak(scene: Scene, prestress: str, solid: Solid, fom: Matrices, rom: Rom, T: NDArray) -> Row:
    """March the scene, which records states, at its only speed; stresses of its largest state.

    The liner has at least as many strips as the model has patches. Largest von Mises stress, Pa, of
    the means at nodes: away from clamp and tip, and anywhere.
    """
    strips = max(scene.liner.m, len(rom.xi))
    case = scene.but(blade=rom.provenance.blade, liner__strips=strips)
    Omega, u_r, u = largest_state(sweep(case, rom))
    basis = Basis.of(fom, T, rom.provenance)
    shown = on_solid(solid, basis.static(Omega), basis.reconstruct(u), prestress)
    von_mises, inside = shown.total.von_mises, away(solid, *WIDTHS)
    return {
        "away_Pa": float(von_mises[inside].max()),
        "away_at_m": shown.points[inside][von_mises[inside].argmax()].tolist(),
        "largest_Pa": float(von_mises.max()),
        "u_r_m": u_r,
    }
