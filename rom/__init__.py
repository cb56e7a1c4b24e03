"""Reduced model of the blade, valid over [0, Omega_m] (Legrand, Batailly and Pierre, section 3.2).

Made from the sparse matrices of ``matrices.h5`` alone. c = S u are the interface DoFs: coefficients
of the tip's patches, or displacements of its points; Phi_R(Omega) are the constraint modes at
Omega.
"""
