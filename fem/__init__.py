"""Finite elements: equilibrium under rotation, M and K(Omega), sparse, clamped DoFs eliminated.

Equations, in the frame of the blade (z the engine axis, P = diag(1, 1, 0)):

(a) S(u) : dE(u; v) dX - rho Omega^2 P (X + u) . v dX = 0     equilibrium, total Lagrangian
(b) S = lambda tr(E) I + 2 mu E, E = (F^T F - I)/2            St Venant-Kirchhoff
(c) K(Omega) = d(a)/du at u_static(Omega)                     prestress `nonlinear`
(d) K(Omega) = K0 + Omega^2 (Kg - Mspin)                      prestress `linear`,
    Kg from the stress C : eps(u1), K0 u1 = rho P X
(e) sigma = F S F^T / det F of u_static + u                   stress; C : eps with `linear`

(c) and (d) hold the geometric stiffness and the spin softening -Omega^2 Mspin. Gyroscopic terms
are left out, as in the paper.
"""

import h5py  # noqa: F401  loads its HDF5 before PETSc's of another version
