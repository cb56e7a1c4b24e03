"""The blade file: everything that says what the blade is, and how it is reduced."""

from math import radians
from typing import Annotated, Literal

from pydantic import Field

from geometry.settings import Settings

Length = Annotated[float, Field(gt=0, le=1e4)]


class Section(Settings):
    """Parabolic profile at one end of the blade; between hub and tip all values vary linearly."""

    chord_mm: Length = Field(description="Chord (mm)")
    thickness_mm: Length = Field(description="Largest thickness (mm)")
    camber_percent: float = Field(ge=0, le=30, description="Rise of the camber line (% of chord)")
    stagger_deg: float = Field(gt=-90, lt=90, description="Chord from the engine axis (deg)")


class Sections(Settings):
    """Blade given by the parameters of its hub and tip sections, stacked on their centroids."""

    hub_radius_mm: Length = Field(description="Radius of the clamped hub (mm)")
    span_mm: Length = Field(description="Hub to tip, along the radius (mm)")
    edge_thickness_percent: float = Field(
        gt=0, le=100, description="Thickness of both edges (% of the largest thickness)"
    )
    tip_lean_tangential_mm: float = Field(
        default=0, description="Tip centroid off the radial line, in the sense of rotation (mm)"
    )
    tip_lean_axial_mm: float = Field(
        default=0, description="Tip centroid off the radial line, downstream (mm)"
    )
    hub: Section = Field(description="Section at the hub")
    tip: Section = Field(description="Section at the tip")


class MeshSize(Settings):
    """The one knob of the mesh."""

    element_size_mm: Length = Field(description="Edge length of the tetrahedra (mm)")


class Material(Settings):
    """Isotropic blade material."""

    young_modulus_GPa: float = Field(gt=0, description="Young's modulus (GPa)")
    poisson_ratio: float = Field(ge=0, lt=0.5, description="Poisson's ratio")
    density_kg_m3: float = Field(gt=0, description="Density (kg/m3)")

    @property
    def young_modulus(self) -> float:
        """Young's modulus, Pa."""
        return self.young_modulus_GPa * 1e9


class Interface(Settings):
    """Where the blade may touch the casing."""

    nodes: int = Field(
        default=8,
        ge=2,
        le=64,
        description="Interface nodes on the tip's camber line, each amid an equal chord share",
    )


class Basis(Settings):
    """Reduction basis of Eqs. (4)-(5)."""

    fixed_interface_modes: int = Field(
        default=9,
        ge=1,
        le=100,
        description="eta, fixed-interface modes at each of the three speeds",
    )
    rank_tolerance: float = Field(
        default=1e-4,
        gt=0,
        lt=1,
        description="Singular values below this share of the largest leave the basis",
    )


class Blade(Settings):
    """One blade: geometry, mesh, material, clamp at the hub, interface, speed range, reduction."""

    sections: Sections = Field(description="Geometry from section parameters")
    mesh: MeshSize = Field(description="Mesh")
    material: Material = Field(description="Material")
    interface: Interface = Field(default=Interface(), description="Interface nodes")
    max_speed_rad_s: float = Field(
        gt=0, description="Omega_m, the highest speed of the reduced model (rad/s)"
    )
    prestress: Literal["nonlinear", "linear"] = Field(
        default="nonlinear",
        description="Tangent at the nonlinear equilibrium, or stress of one linear static solve",
    )
    basis: Basis = Field(default=Basis(), description="Reduction basis")

    @property
    def hub_radius(self) -> float:
        """Hub radius, m."""
        return self.sections.hub_radius_mm * 1e-3

    @property
    def span(self) -> float:
        """Blade length, m."""
        return self.sections.span_mm * 1e-3

    @property
    def tip_radius(self) -> float:
        """Tip radius, m."""
        return self.hub_radius + self.span

    def stagger(self, fraction: float) -> float:
        """Stagger at a span fraction (0 hub, 1 tip), rad."""
        hub, tip = self.sections.hub.stagger_deg, self.sections.tip.stagger_deg
        return radians(hub + fraction * (tip - hub))
