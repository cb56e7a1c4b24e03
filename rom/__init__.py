"""Reduced model of the blade, valid over [0, Omega_m] (Legrand, Batailly and Pierre, section 3.2).

Works on the sparse matrices of ``matrices.h5`` alone. b marks interface (boundary) DoFs, i the
others; Phi_R(Omega) are the constraint modes, Phi_L(Omega) the eta fixed-interface modes at Omega.
"""
