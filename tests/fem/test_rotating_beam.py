"""A rotating cantilever of solid elements against the table of the rotating Euler-Bernoulli beam.

Wright, Smith, Thresher and Wang (1982), Vibration modes of centrifugally stiffened beams, and
Hodges and Rutkowski (1981), Free-vibration analysis of rotating beams by a variable-order finite
element method. In their numbers, per plane of bending with its own stiffness E I:

    eta = Omega sqrt(rho A L^4 / (E I)),  mu = omega sqrt(rho A L^4 / (E I)),  hub = R / L
"""

import numpy as np
import pytest
from numpy.polynomial import Legendre, Polynomial
from numpy.polynomial.legendre import leggauss
from scipy.integrate import quad
from scipy.linalg import eigh
from scipy.sparse.linalg import eigsh

from fem.prestress import linear_states, mass, nonlinear_states
from geometry.blade import Material

HUBS = (0.0, 1.0, 2.0)
ETAS = np.arange(0.0, 7.0)
MODES = 3


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


@pytest.mark.parametrize(
    ("hub", "eta", "published"),
    [
        (0, 0, [3.5160, 22.0345, 61.6972]),
        (0, 2, [4.1373]),
        (0, 6, [7.3604]),
        (0, 10, [11.2023]),
        (1, 2, [4.8337]),
        (1, 6, [10.4439]),
    ],
)
def test_the_table_has_its_published_numbers(hub, eta, published):
    # all four printed digits; two terms fewer move none of them
    assert flap(hub, eta)[: len(published)] == pytest.approx(published, abs=6e-5)
    assert flap(hub, eta, terms=12) == pytest.approx(flap(hub, eta), rel=1e-8)


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


def errors(box, states, hub):
    """Frequency over the table's, less 1: (speeds, modes) by plane."""
    size = [LENGTH, LAG_THICKNESS, FLAP_THICKNESS]
    beam = box([60, 1, 1], size, SLENDER, hub=hub * LENGTH)
    M = mass(beam)
    found = {plane: [] for plane in PLANES}
    for state in states(beam, ETAS * unit_speed(FLAP_THICKNESS)):
        omega = bending(state, M)
        for plane, (_, thickness, mu) in PLANES.items():
            unit = unit_speed(thickness)
            found[plane].append(omega[plane] / unit / mu(hub, state.speed / unit) - 1)
    return {plane: np.array(rows) for plane, rows in found.items()}


@pytest.mark.parametrize("states", [linear_states, nonlinear_states])
@pytest.mark.parametrize("hub", HUBS)
def test_solid_beam_has_the_frequencies_of_the_table(box, states, hub):
    """Flap and lag modes 1 to 3 at eta = 0 ... 6 (lag 0 ... 7.5), in both prestress variants."""
    both = np.abs(list(errors(box, states, hub).values()))
    # goals of the project: 0.1 % on mode 1, 0.5 % on all. Measured: 0.014 % on mode 1 (stretch at
    # hub 2), 0.06 % on mode 3 (shear and rotary inertia, 60 cells along the beam)
    assert both[..., 0].max() < 3e-4
    assert both.max() < 1e-3


def southwell():
    """d omega^2 / d Omega^2 of a clamped-free beam on the axis, bending along it: 1.193."""
    b = 1.875104068711961  # first root of cos b cosh b = -1
    ratio = (np.cosh(b) + np.cos(b)) / (np.sinh(b) + np.sin(b))

    def mode(x):
        return np.cosh(b * x) - np.cos(b * x) - ratio * (np.sinh(b * x) - np.sin(b * x))

    def slope(x):
        return b * (np.sinh(b * x) + np.sin(b * x) - ratio * (np.cosh(b * x) - np.cos(b * x)))

    work = quad(lambda x: (1 - x**2) / 2 * slope(x) ** 2, 0, 1)[0]
    return work / quad(lambda x: mode(x) ** 2, 0, 1)[0]


@pytest.mark.parametrize("states", [linear_states, nonlinear_states])
def test_beam_stiffens_by_the_published_coefficients(box, states):
    """Out of the plane of rotation omega^2 rises by 1.193 Omega^2, in it by 0.193 Omega^2."""
    assert southwell() == pytest.approx(1.193, abs=5e-4)  # Southwell and Gough, 1921
    beam = box([20, 1, 1], [1.0, 0.02, 0.03], SLENDER)
    Omega = 20.0
    rest, spun = states(beam, np.array([0.0, Omega]))
    M = mass(beam)
    _, modes = eigsh(rest.K, 2, M, sigma=0)
    for component, expected in [(1, southwell() - 1), (2, southwell())]:  # y in plane, z out of it
        mode = modes[:, np.argmax(np.linalg.norm(modes[component::3], axis=0))]
        rise = mode @ ((spun.K - rest.K) @ mode) / Omega**2 / (mode @ (M @ mode))
        # shear, rotary inertia and the initial strain are of the order (b/L)^2 = 9e-4
        assert rise == pytest.approx(expected, abs=1e-3)
