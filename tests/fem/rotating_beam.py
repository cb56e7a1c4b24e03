"""A rotating cantilever of solid elements against the table of the rotating Euler-Bernoulli beam.

Wright, Smith, Thresher and Wang (1982), Vibration modes of centrifugally stiffened beams, and
Hodges and Rutkowski (1981), Free-vibration analysis of rotating beams by a variable-order finite
element method. In their numbers, per plane of bending with its own stiffness E I:

    eta = Omega sqrt(rho A L^4 / (E I)),  mu = omega sqrt(rho A L^4 / (E I)),  hub = R / L
"""

import numpy as np
from boxes import make_box
from numpy.polynomial import Legendre, Polynomial
from numpy.polynomial.legendre import leggauss
from scipy.linalg import eigh
from scipy.sparse.linalg import eigsh

from fem.prestress import mass
from geometry.blade import Material

MODES = 3
# mu of the first flap modes as printed, by hub and eta
PUBLISHED = {
    (0, 0): [3.5160, 22.0345, 61.6972],
    (0, 2): [4.1373],
    (0, 6): [7.3604],
    (0, 10): [11.2023],
    (1, 2): [4.8337],
    (1, 6): [10.4439],
}


def flap(hub, eta, terms=14):
    """mu of the flap modes, by Ritz: x^2 times Legendre polynomials on the beam's energies.

    Strain energy w''^2 / 2, and T w'^2 / 2 of the tension T = eta^2 ((1 - x^2)/2 + hub (1 - x)).
    """
    x, weights = leggauss(2 * terms)
    x, weights = (x + 1) / 2, weights / 2
    shapes = [
        Polynomial([0, 0, 1]) * Legendre.basis(n, [0, 1]).convert(kind=Polynomial)
        for n in range(terms)
    ]
    w, slope, curvature = (np.array([s.deriv(d)(x) for s in shapes]) for d in (0, 1, 2))
    tension = eta**2 * ((1 - x**2) / 2 + hub * (1 - x))
    K = (curvature * weights) @ curvature.T + (slope * weights * tension) @ slope.T
    return np.sqrt(eigh(K, (w * weights) @ w.T, eigvals_only=True)[:MODES])


def lag(hub, eta):
    """mu of the lag modes: the plane of rotation takes Omega^2 off each omega^2."""
    return np.sqrt(flap(hub, eta) ** 2 - eta**2)


# A rectangle, so that no flap frequency is one of lag. Slender, so that the steady strain, at most
# eta^2 (hub + 1/2) (thickness/L)^2 / 12 = 8e-4, shear and rotary inertia stay below the goals.
LENGTH, FLAP_THICKNESS, LAG_THICKNESS = 1.0, 0.01, 0.008
SLENDER = Material(young_modulus_GPa=100, poisson_ratio=0, density_kg_m3=4000)
PLANES = {"lag": (1, LAG_THICKNESS, lag), "flap": (2, FLAP_THICKNESS, flap)}


def unit_speed(thickness):
    """Omega of eta = 1, rad/s: sqrt(E I / (rho A L^4))."""
    wave = np.sqrt(SLENDER.young_modulus / SLENDER.density_kg_m3)
    return wave * thickness / np.sqrt(12) / LENGTH**2


def bending(state, M):
    """omega of the first modes of each plane, by the component they move in."""
    values, modes = eigsh(state.K, 2 * MODES + 2, M, sigma=0)
    order = np.argsort(values)
    omega, modes = np.sqrt(values[order]), modes[:, order]
    moves = np.argmax([np.linalg.norm(modes[c::3], axis=0) for c in range(3)], axis=0)
    return {plane: omega[moves == c][:MODES] for plane, (c, _, _) in PLANES.items()}


def frequencies(states, hub, etas):
    """mu (speeds, modes) by plane; ``etas`` of flap."""
    size = [LENGTH, LAG_THICKNESS, FLAP_THICKNESS]
    beam = make_box([60, 1, 1], size, SLENDER, hub=hub * LENGTH)
    M = mass(beam)
    speeds = np.asarray(etas) * unit_speed(FLAP_THICKNESS)
    omegas = [bending(state, M) for state in states(beam, speeds)]
    return {
        plane: np.array([omega[plane] for omega in omegas]) / unit_speed(thickness)
        for plane, (_, thickness, _) in PLANES.items()
    }


def errors(states, hub, etas):
    """Frequency over the table's, less 1: (speeds, modes) by plane."""
    expected = {
        plane: np.array([mu(hub, eta * FLAP_THICKNESS / thickness) for eta in etas])
        for plane, (_, thickness, mu) in PLANES.items()
    }
    found = frequencies(states, hub, etas)
    return {plane: found[plane] / expected[plane] - 1 for plane in PLANES}
