"""Measured law of the liner: a compression curve, with unloading along one modulus.

The curve (strain, stress) of a first compression gives the yield stress over the plastic strain,

    alpha_k = eps_k - sigma_k / E,    sigma_Y(alpha) linear between the points (alpha_k, sigma_k)

and beyond the last point with its last slope. The return mapping is that of Eqs. (9)-(16) on each
piece: with f = E (eps - eps_p) - sigma_Y(eps_p) > 0 the plastic strain moves to where
E (eps - alpha) = sigma_Y(alpha). Two pieces are the law `plastic`. Reference: Simo and Hughes 1998,
chapter 1.
"""

from typing import Annotated, Any, Literal

import numpy as np
from pydantic import Field

from geometry.base import Fault, SettingsError, checked, require, shifted
from simulate.scene.law import Unloading, numbers_of
from simulate.scene.tables import Points, from_csv

# Columns of the file: the key that each stands for, and its factor to its unit
STRAIN = {"strain": ("strain", 1.0), "strain_percent": ("strain", 1e-2)}
STRESS = {
    f"stress_{unit}": ("stress_MPa", mpa)
    for unit, mpa in (("Pa", 1e-6), ("kPa", 1e-3), ("MPa", 1.0))
}
ROUND_OFF = 1e-9  # relative, of a slope that is the modulus


class Curve(Points):
    """First compression of the liner."""

    strain: tuple[float, ...] = Field(
        min_length=2,
        description="Strains, ascending from 0; or `curve: FILE.csv`, with columns strain or "
        "strain_percent, and stress_MPa, stress_kPa or stress_Pa",
    )
    stress_MPa: tuple[float, ...] = Field(
        min_length=2, description="Stress at these strains (MPa), from 0"
    )

    @property
    def stress_Pa(self) -> list[float]:
        """Stress, Pa."""
        return [shifted(stress, 6) for stress in self.stress_MPa]

    @checked
    def _monotone(self) -> None:
        strain, stress = np.array(self.strain), np.array(self.stress_Pa)
        falls = (
            ("strain", np.diff(strain) <= 0, "ascend"),
            ("stress", np.diff(stress) < 0, "not fall"),
        )
        require(
            (
                strain[0] == 0.0 and stress[0] == 0.0,
                f"begins at strain {strain[0]:g}, stress {stress[0]:g} Pa: should begin at 0, 0",
            ),
            *(
                (
                    not step.any(),
                    f"{what} at point {step.argmax() + 2} (strain {strain[step.argmax() + 1]:g}): "
                    f"should {rule}",
                )
                for what, step, rule in falls
            ),
            (
                strain[-1] <= 1.0,
                Fault(
                    "a rod would be compressed by more than its length: allowed up to 1; of "
                    "strains in per cent the column is strain_percent",
                    "strain",
                    float(strain[-1]),
                    {"le": 1.0},
                ),
            ),
            (stress[-1] != 0.0, "stress is 0 throughout"),
            kind=SettingsError,
        )


class Tabulated(Unloading):
    """Law of a measured compression curve, with wear."""

    kind: Literal["table"] = Field(
        description="a measured compression curve, with wear; unloads along E"
    )
    curve: Annotated[Curve, from_csv(Curve, STRAIN, STRESS)] = Field(
        description="Compression curve as a CSV file: strain, and stress in Pa, kPa or MPa"
    )

    @checked
    def _no_steeper_than_the_modulus(self) -> None:
        slopes = np.diff(self.curve.stress_Pa) / np.diff(self.curve.strain)
        steep = slopes > self.modulus * (1 + ROUND_OFF)
        i, after = int(steep.argmax()), slopes[np.argmax(slopes < self.modulus * (1 - ROUND_OFF)) :]
        require(
            (
                not steep.any(),
                f"curve: rises by {slopes[i]:.4g} Pa from strain {self.curve.strain[i]:g} to "
                f"{self.curve.strain[i + 1]:g}, steeper than it unloads: allowed up to E = "
                f"{self.modulus:.4g} Pa",
            ),
            (
                np.all(after < self.modulus * (1 - ROUND_OFF)),
                f"curve: never yields, or rises along E = {self.modulus:.4g} Pa after it has "
                f"yielded: raise E above the slopes of the curve",
            ),
            kind=SettingsError,
        )

    @property
    def parameters(self) -> Any:
        """Young's modulus E, Pa, and the yield curve at its points, from plastic strain 0.

        alpha (points,), plastic strains, ascending from 0; sigma (points,), Pa, yield stress there;
        H (points,), Pa, slope to the next point; the last one goes on.
        """
        strain, stress_Pa = np.array(self.curve.strain), np.array(self.curve.stress_Pa)
        slopes = np.diff(stress_Pa) / np.diff(strain)
        first = int(np.argmax(slopes < self.modulus * (1 - ROUND_OFF)))  # where it yields
        strain, sigma, slopes = strain[first:], stress_Pa[first:], slopes[first:]
        H = slopes / (1 - slopes / self.modulus)  # d sigma / d alpha, where it is E H / (E + H)
        alpha = np.concatenate([[0.0], np.cumsum(np.diff(strain) * (1 - slopes / self.modulus))])
        return numbers_of("E", "alpha", "sigma", "H")(
            self.modulus, alpha, sigma, np.append(H, H[-1])
        )

    @property
    def farthest(self) -> float:
        """Plastic strain at the end of the curve: beyond it the law is not measured."""
        return float(self.parameters.alpha[-1])

    @staticmethod
    def stress(law, eps, eps_p):
        """Return mapping, as in the law `plastic`, on the piece of the curve where it ends."""
        sigma = law.E * (eps - eps_p)  # trial, Eq. (13)
        if sigma <= 0.0:  # no tension
            return 0.0, eps_p, 0.0
        k = law.alpha.size - 1
        while k > 0 and law.alpha[k] > eps_p:
            k -= 1
        f = sigma - (law.sigma[k] + law.H[k] * (eps_p - law.alpha[k]))  # Eq. (10), of the trial
        if f <= 0.0:
            return sigma, eps_p, law.E
        while k + 1 < law.alpha.size and law.E * (eps - law.alpha[k + 1]) > law.sigma[k + 1]:
            k += 1
        # E (eps - alpha) = sigma_k + H_k (alpha - alpha_k)
        ahead = (law.E * (eps - law.alpha[k]) - law.sigma[k]) / (law.E + law.H[k])
        after = max(law.alpha[k] + ahead, eps_p)
        sigma = law.sigma[k] + law.H[k] * (after - law.alpha[k])
        return sigma, after, law.E * law.H[k] / (law.E + law.H[k])

    @staticmethod
    def plastic_work(law, before, after):
        """Dissipated work: integral of the yield stress over the plastic strain, J/m3.

        Piece by piece from ``before``: differences of sums from 0 would lose the digits of short
        ways.
        """
        k = law.alpha.size - 1
        while k > 0 and law.alpha[k] > before:
            k -= 1
        work, start = 0.0, before
        while start < after:
            end = min(after, law.alpha[k + 1]) if k + 1 < law.alpha.size else after
            middle = (start + end) / 2 - law.alpha[k]
            work += (end - start) * (law.sigma[k] + law.H[k] * middle)
            start, k = end, k + 1
        return work
