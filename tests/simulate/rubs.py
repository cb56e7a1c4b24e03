"""Small systems that rub, of which the energies are known."""

import numpy as np
from systems import FLAT, Hooke, Parameters, lively, march, march_exact, strips

from simulate.contact.strips import Tip

SCHEMES = {"central-difference": march, "piecewise-exact": march_exact}


ROUND = Tip(0.03, 0.02 / 0.85**2, -0.03 * 0.85**2 / 0.04, 0.85)  # of half a footprint


LAWS = {"plastic": Parameters(60.0, 25.0, 0.02), "elastic": Hooke(60.0)}


def rub(
    scheme, law, h=1e-2, steps=600, rounds=2, ramp_rounds=0.7, xi=0.02, start=0.02, nu=90,
    length=1.7, tip=FLAT, **more,
):  # fmt: skip
    """Three nodes and eleven modes over a lobed casing, in and out of contact."""
    omega, Phi_b, q, second = lively(3, start)
    d = 0.1 * np.cos(6 * np.pi * np.arange(nu) / nu)
    system = strips(
        LAWS[law], [0.01] * 3, d, length=length, first=[0.1, 1.3, 2.8], advance=nu / steps, tip=tip
    )
    if scheme == "central-difference":
        second = q - h * second
    return SCHEMES[scheme](
        system, omega, Phi_b, xi, h, steps, q, second, ramp_rounds=ramp_rounds, rounds=rounds,
        **more,
    )  # fmt: skip


def lost(scheme, law, steps):
    """Energies, J, that a scheme takes off the rub in the same time in so many steps."""
    return [-rub(scheme, law, h=6 / n, steps=n, rounds=1).ledger.numerical for n in steps]


def pressed():
    """Energies of a blade that cannot move, pressed once into a plastic liner; in closed form.

    At constant depth a rod comes in at psi = sigma^2/2E + plastic work; on its way out it releases
    sigma^2/2E.
    """
    E, K, sigma_Y, depth, nu, steps = 5.0, 2.0, 0.05, 0.1, 40, 400
    system = strips(Parameters(E, K, sigma_Y), -depth, np.zeros(nu), length=2.6, advance=nu / steps)
    found = march(system, [1.0], [[1e-9]], 0.0, 1e-3, steps, [0.0], [0.0]).ledger
    eps_p = (E * depth - sigma_Y) / (E + K)
    stored = (E * (depth - eps_p)) ** 2 / (2 * E)
    expected = {
        "plastic": nu * (sigma_Y * eps_p + K * eps_p**2 / 2),
        "elastic": 2.6 * stored,  # under 2.6 rods at the end
        # from the end of step 1 to that of the last the tip moves on by nu - nu/steps rods
        "released": (nu - nu / steps) * stored,
    }
    return found, expected
