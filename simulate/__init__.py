"""Simulation of blade-tip rub with liner wear. Needs files only, no FEniCSx.

Conventions: SI, rad/s. Frame attached to the blade; theta about the engine axis in the sense of
rotation; xi the fraction of the tip's chord, 0 at the leading edge; u_r outward. The tip meets m
strips of liner, strip i at xi_i, r_i, theta_i on the camber line; its displacement there is that of
the blade's patches, u_r,i = P_i c, and forces go back by P^T. The casing frame angle of that place
is theta_b = Omega t + theta_i. The casing is rigid and distorts inward by a(t) d(theta), a from 0
to 1 over a ramp. Positive penetration means contact.

    s = r_i (theta_j - theta_b)                            arc from the camber line to rod j, m
    delta_ij = u_r,i - p(s) + a d(theta_j) - g0_i          penetration, Eq. (7): -g, unworn
    eps_ij = max(0, delta_ij) / l                          rod strain
    sigma_ij by the liner's law (``laws``)                 Eqs. (13)-(16) or another; no tension
    t_N,i = sum over the footprint of A_ij sigma_ij        Eq. (17), N, pushing the blade inward
    t_T,i = sum of A_ij sigma_ij p'(s)                     N, against the rotation for s > 0
    M u'' + D u' + K(Omega) u + F^c = 0                    Eq. (1), F^c = P^T of the t_N and t_T

On a casing of slope dr/dz = tan g the normal is (cos g, -sin g) in (r, z). Lengths are radial (gap,
distortion, thickness, worn depth, the displacement u_r - (dr/dz) u_z, called u_r here) and widths
axial: strain, wear and the generalised force P^T (sum of A sigma) are then those of the normal, for
the cosine of the shorter length cancels that of the longer width. Of all outputs t_N alone, and
with it mu t_N, is along the normal: sum of A sigma / cos g. A thickness that is measured along the
normal is to be divided by cos g.

p is the profile of the tip over its footprint, 0 where it is flat. Where the tangential motion is
modelled theta_b gains u_t,i / r_i, and F^c the t_T on the tangential DoFs; else it is radial. With
friction t_T,i = mu t_N,i instead (``friction``).

References: Legrand, Batailly and Pierre (equation numbers); Carpenter, Taylor and Katona 1991 for
the prediction/correction.
"""

from importlib import import_module
from typing import Any

FACE = {  # names that `from simulate import ...` gives, each loaded on first use
    "Rom": "rom.model",
    "Scene": "simulate.scene.scene",
    "Law": "simulate.scene.law",
    "Runs": "simulate.runs",
    "sweep": "simulate.runs",
    "march": "simulate.runs",
    "peaks": "simulate.runs",
}
__all__ = [*FACE]


def __getattr__(name: str) -> Any:
    if name == "__version__":
        return import_module("geometry.base.provenance").version()
    if name not in FACE:
        raise AttributeError(f"module 'simulate' has no attribute {name!r}")
    return getattr(import_module(FACE[name]), name)
