"""Modes of a casing that moves: given one by one or in a CSV file, or those of a thin ring.

A mode of n nodal diameters is a pair, a quarter of its period apart around the casing,

    radial      phi_r cos(n theta),  outward
    tangential  phi_t sin(n theta),  in the sense of rotation; that of a wall that does not stretch
                is phi_t = -phi_r / n
    axial       phi_z cos(n theta),  downstream

with phi^T M phi = 1 of the whole casing, so that its modal mass is 1/phi_r^2. Order 0 is one mode.
"""

from collections.abc import Sequence
from math import pi, sqrt
from typing import Annotated, ClassVar

from pydantic import Field

from geometry.base import Settings, SettingsError, check_settings, checked, known
from simulate.scene.tables import rows_from_csv

HIGHEST_DIAMETERS = 60  # of a mode of the casing
IN_HZ = "in Hz: 400 rad/s are 63.7 Hz"
DAMPING = "over critical damping: 0.5 % is 0.005"
Ratio = Annotated[float, Field(ge=0, lt=1)]


class CasingMode(Settings):
    """Mode of the casing, of cos and sin of its order around the circumference."""

    either: ClassVar = [("modal_mass_kg", "radial")]
    hints: ClassVar = {"frequency_Hz": IN_HZ, "damping_ratio": DAMPING}

    order: int = Field(ge=0, le=HIGHEST_DIAMETERS, description="Nodal diameters")
    frequency_Hz: float = Field(ge=0.1, le=1e6, description="Natural frequency (Hz)")
    damping_ratio: Ratio = Field(description="Its damping over the critical")
    modal_mass_kg: float | None = Field(
        default=None,
        ge=1e-6,
        le=1e18,  # as good as rigid
        description="Modal mass of a radial cos(order theta) of amplitude 1 at the tip's plane "
        "(kg), of a wall that does not stretch: tangential -1/order, axial 0",
    )
    radial: float | None = Field(
        default=None,
        gt=0,
        le=1e3,
        description="Instead: radial value of the mass-normalised mode at the tip's plane "
        "(kg^-1/2), of which the sign is free",
    )
    tangential: float | None = Field(
        default=None,
        ge=-1e3,
        le=1e3,
        description="With `radial`: its tangential value, of sin(order theta), in the sense of "
        "rotation (kg^-1/2); by default -radial/order",
    )
    axial: float | None = Field(
        default=None,
        ge=-1e3,
        le=1e3,
        description="With `radial`: its axial value, of cos(order theta), downstream (kg^-1/2), by "
        "default 0: it counts on a casing that tapers",
    )

    @checked
    def _values_of_one_mode(self) -> None:
        given = [key for key in ("tangential", "axial") if getattr(self, key) is not None]
        if given and self.radial is None:
            raise SettingsError(
                "goes with radial, a value of the same mode; found modal_mass_kg", key=given[0]
            )
        if self.order == 0 and self.tangential:
            raise SettingsError(
                "order 0 has no sin(order theta); allowed 0",
                key="tangential",
                value=self.tangential,
            )

    @property
    def phi(self) -> tuple[float, float, float]:
        """Radial, tangential and axial value of the mass-normalised mode, kg^-1/2."""
        radial = self.radial or known(self.modal_mass_kg, "modal_mass_kg") ** -0.5
        along = -radial / self.order if self.order else 0.0
        return radial, along if self.tangential is None else self.tangential, self.axial or 0.0


class Ring(Settings):
    """Casing as a free thin ring of rectangular section, which bends in its plane.

    With A, I of the section and R the radius of its middle, order n from 2 and order 0 have

        w_n^2 = E I n^2 (n^2 - 1)^2 / (rho A R^4 (n^2 + 1)),    m_n = pi rho A R (1 + 1/n^2)
        w_0^2 = E / (rho R^2),                                  m_0 = 2 pi rho A R

    (Hoppe 1871). A ring is the textbook's casing: an engine's has flanges and other frequencies.

    >>> ring = Ring(young_modulus_GPa=70, density_kg_m3=2700, radius_mm=250, thickness_mm=4,
    ...     width_mm=50, orders=[2, 3], damping_ratio=0.001)
    >>> [round(mode.frequency_Hz, 4) for mode in ring.modes]
    [40.1738, 113.6287]
    """

    hints: ClassVar = {"damping_ratio": DAMPING}

    young_modulus_GPa: float = Field(ge=0.1, le=1000, description="Young's modulus (GPa)")
    density_kg_m3: float = Field(ge=100, le=25000, description="Density (kg/m3)")
    poisson_ratio: float = Field(
        default=0.0,
        ge=0,
        lt=0.5,
        description="Poisson's ratio of a band that is wide against its thickness, which bends "
        "with E/(1 - nu^2)",
    )
    radius_mm: float = Field(gt=0, le=1e4, description="Radius of the middle of its wall (mm)")
    thickness_mm: float = Field(gt=0, le=1e3, description="Thickness of its wall (mm)")
    width_mm: float = Field(gt=0, le=1e4, description="Axial width (mm)")
    orders: list[int] = Field(min_length=1, max_length=16, description="Nodal diameters: 0, 2, ...")
    damping_ratio: Ratio = Field(description="Damping of its modes over the critical")

    @checked
    def _orders_of_a_free_ring(self) -> None:
        for n in self.orders:
            if n == 1 or not 0 <= n <= HIGHEST_DIAMETERS:
                raise SettingsError(
                    f"allowed 0 and 2 to {HIGHEST_DIAMETERS}: order 1 moves a free ring as a whole "
                    "(give casing.modes instead, with the frequency of its mount)",
                    key="orders",
                    value=n,
                )
        if len({*self.orders}) < len(self.orders):
            raise SettingsError("names an order twice", key="orders", value=self.orders)

    @checked
    def _thin_with_modes(self) -> None:
        if self.thickness_mm > self.radius_mm / 3:
            raise SettingsError(
                "no thin ring: allowed up to a third of radius_mm",
                key="thickness_mm",
                value=self.thickness_mm,
            )
        try:
            self.modes  # noqa: B018
        except SettingsError as error:
            raise SettingsError(f"of these sizes it has a mode that is refused: {error}") from None

    @property
    def modes(self) -> list[CasingMode]:
        """Its modes, one for each of the ``orders``."""
        R, b, A = (
            length / 1e3
            for length in (
                self.radius_mm,
                self.thickness_mm,
                self.thickness_mm * self.width_mm / 1e3,
            )
        )
        c = sqrt(self.young_modulus_GPa * 1e9 / self.density_kg_m3)  # of sound along the wall, m/s
        mass, bends = 2 * pi * self.density_kg_m3 * A * R, 12 * (1 - self.poisson_ratio**2)
        found = []
        for n in self.orders:
            omega, m = c / R, mass
            if n:
                omega *= b / R * n * (n**2 - 1) / sqrt(bends * (n**2 + 1))
                m = mass / 2 * (1 + 1 / n**2)
            of_order = {"order": n, "frequency_Hz": omega / (2 * pi), "modal_mass_kg": m}
            of_order |= {"damping_ratio": self.damping_ratio}
            found.append(check_settings(CasingMode, of_order, f"order {n}"))
        return found


AnyModes = Annotated[Sequence[CasingMode], rows_from_csv(CasingMode)]
