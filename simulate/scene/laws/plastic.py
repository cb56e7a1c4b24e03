"""Plastic law of the liner with linear isotropic hardening: Eqs. (9)-(16).

Loading past the elastic limit follows the modulus E K / (E + K); unloading follows E. The return
mapping at constant strain has the closed form of Eq. (15). K = 0 is perfect plasticity. Reference:
Simo and Hughes 1998, chapter 1.
"""

from typing import Literal

from pydantic import Field

from simulate.scene.law import Unloading


class Plastic(Unloading):
    """Plastic law with linear isotropic hardening, the paper's."""

    kind: Literal["plastic"] = Field(
        description="the paper's, with linear hardening and wear, Eqs. (9)-(16)"
    )
    K: float = Field(ge=0, le=1e9, description="Plastic modulus (in unit_MPa)")
    sigma_Y: float = Field(ge=0, le=1e9, description="Elastic limit (in unit_MPa)")

    @staticmethod
    def stress(law, eps, eps_p):
        """Return mapping: sigma = E (eps - eps_p) is Eq. (13) summed; alpha = eps_p, Eq. (11).

        Eq. (16) returns the stress to the yield surface, f = 0, where it is sigma_Y + K alpha. This
        is computed instead of sigma - E gamma, whose round-off could be tensile for small sigma_Y
        and K.
        """
        sigma = law.E * (eps - eps_p)  # trial, Eq. (13)
        if sigma <= 0.0:  # Eq. (8): the gap to the worn surface is open; no tension
            return 0.0, eps_p, 0.0
        f = sigma - (law.sigma_Y + law.K * eps_p)  # Eq. (10), of the trial
        if f > 0.0:  # not admissible, Eqs. (9), (12)
            after = eps_p + f / (law.E + law.K)  # gamma of Eq. (15), where Eq. (14) is 0
            sigma = law.sigma_Y + law.K * after  # Eq. (16), from f = 0
            return sigma, after, law.E * law.K / (law.E + law.K)
        return sigma, eps_p, law.E

    @staticmethod
    def plastic_work(law, before, after):
        """Dissipated work: integral of sigma_Y + K alpha over alpha, J/m3."""
        return (after - before) * (law.sigma_Y + law.K * (before + after) / 2)
