"""The interface on one mesh: errors of S and the reduced model, compliances, largest stress.

Rows are those of workflow/experiments/interface-models.yaml.
"""

from dataclasses import replace

import numpy as np
import xarray as xr

from fem.fields import away, on_solid
from fem.interface_operator import interface_of
from fem.matrices import Matrices
from fem.solid import Solid, read_solid
from geometry.blade import Blade
from geometry.hats import middles
from geometry.interface import tip_of
from rom.check import RomCheck
from rom.full_model import compliance_of_strips
from rom.modes import ShiftInvert
from rom.reconstruct import Basis
from rom.reduce import reduce
from simulate.marching import largest_state
from simulate.scene import Scene
from workflow.study.trade import Row

WIDTHS = 2.48e-3, 3.75e-3  # m, a row of elements and a patch, the same on all meshes


def of_patches(scene: Scene, blade: Blade, mesh: str, matrices: str, check: str) -> Row:
    """Errors of an interface of as many patches as the scene has strips, on the blade's mesh.

    `constant`, `linear`: of the coefficients of S for the fields u_r = 1 and u_r = xi; `ST`: of
    S T = [I 0]; `compliance_of_model`: relative, at rest at the strips, where the full model has
    `compliance_m_per_N`; `frequencies`: relative, of the model that the blade has by itself.
    """
    solid, fom = read_solid(mesh, blade.material), Matrices.load(matrices)
    interface = interface_of(solid, blade.but(interface__patches=scene.liner.strips))
    fom = replace(fom, S=interface.S, xi=interface.xi)
    rom, T = reduce(fom, blade.basis, "r")
    S = fom.rows("r")
    full = compliance_of_strips(S @ ShiftInvert(fom.K[0], fom.M).solve(S.T.toarray()), fom.across)
    n = len(full)
    P = rom.rows(middles(n))
    reduced = np.diag(P @ np.linalg.inv(rom.stiffness(0.0)) @ P.T)
    return _kept(fom, solid) | {
        "patches": n,
        "n": rom.n,
        "ST": float(np.abs(S @ T - np.eye(n, rom.n)).max()),
        "compliance_of_model": float(np.abs(reduced / full - 1).max()),
        "compliance_m_per_N": full.tolist(),
        "frequencies": float(np.abs(RomCheck.load(check).error).max()),
    }


def _kept(fom: Matrices, solid: Solid) -> dict[str, float]:
    """Largest errors of the coefficients of S for the fields u_r = 1 and u_r = xi."""
    tip = tip_of(solid.tip, solid.V.tabulate_dof_coordinates())
    x, y, _ = fom.coordinates.T
    radial = np.column_stack([x, y, 0 * x]) / np.hypot(x, y)[:, None]
    S = fom.rows("r")
    errors = {
        "constant": S @ radial.ravel() - 1,
        "linear": S @ (radial * tip.xi(fom.coordinates)[:, None]).ravel() - fom.xi,
    }
    return {name: float(np.abs(error).max()) for name, error in errors.items()}


def largest_stress(runs: xr.Dataset, blade: Blade, mesh: str, basis: str) -> Row:
    """Stresses of the largest state of a sweep, which records states.

    The liner has at least as many strips as the model has patches. Largest von Mises stress, Pa, of
    the means at nodes: away from clamp and tip, and anywhere.
    """
    solid, of = read_solid(mesh, blade.material), Basis.load(basis)
    Omega, u_r, u = largest_state(runs)
    shown = on_solid(solid, of.static(Omega), of.reconstruct(u), blade.prestress)
    von_mises, inside = shown.total.von_mises, away(solid, *WIDTHS)
    return {
        "away_Pa": float(von_mises[inside].max()),
        "away_at_m": shown.points[inside][von_mises[inside].argmax()].tolist(),
        "largest_Pa": float(von_mises.max()),
        "u_r_m": u_r,
    }
