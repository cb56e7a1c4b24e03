"""Settings of a blade file: geometry, mesh, material, interface and reduction of a blade."""

from math import inf
from pathlib import Path, PurePath
from typing import Annotated, Any, ClassVar, Literal

from pydantic import Discriminator, Field, Tag

from geometry.base import (
    RPM,
    Fault,
    Settings,
    SettingsError,
    SettingsFile,
    checked,
    file_hash,
    one_of,
    require,
)

RPM_PER_HZ = 60.0
Length = Annotated[float, Field(gt=0, le=1e4)]
MOST_THICKNESS = 0.4  # of the chord; blades of compressors have up to 0.15, of turbines 0.3
MOST_TIP_SPEED = 1000.0  # m/s of the tip; the fastest titanium blades reach about 600


class Section(Settings):
    """Parabolic profile at one end of the blade; values vary linearly between hub and tip."""

    chord_mm: Length = Field(description="Chord (mm)")
    thickness_mm: Length = Field(description="Largest thickness (mm)")
    camber_percent: float = Field(ge=0, le=30, description="Rise of the camber line (% of chord)")
    stagger_deg: float = Field(gt=-90, lt=90, description="Chord from the engine axis (deg)")

    @checked
    def _is_thin(self) -> None:
        share = self.thickness_mm / self.chord_mm
        require(
            (
                share <= MOST_THICKNESS,
                f"{100 * share:.0f} % of the chord of {self.chord_mm:g} mm; allowed up to "
                f"{100 * MOST_THICKNESS:.0f} %: is one of them in another unit, or ten times what "
                "was meant?",
            ),
            kind=SettingsError,
            key="thickness_mm",
            value=self.thickness_mm,
            allowed={"le": MOST_THICKNESS * self.chord_mm},
        )


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

    @property
    def hub_radius(self) -> float:
        """Hub radius, m."""
        return self.hub_radius_mm * 1e-3

    @property
    def span(self) -> float:
        """Blade length, m."""
        return self.span_mm * 1e-3

    @property
    def tip_radius(self) -> float:
        """Tip radius, m."""
        return self.hub_radius + self.span


Axis = Literal["x", "-x", "y", "-y", "z", "-z"]
METRES = {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "in": 25.4e-3}


class Frame(Settings):
    """Axes of a file in the frame of the blade; the defaults are those of the blade."""

    downstream: Axis = Field(default="z", description="The engine axis, from inlet to outlet")
    radial: Axis = Field(default="x", description="Outward through the blade")
    rotation: Literal["right-handed", "left-handed"] = Field(
        default="right-handed", description="Sense of rotation about `downstream`"
    )

    @checked
    def _perpendicular(self) -> None:
        if self.downstream[-1] == self.radial[-1]:
            raise ValueError("downstream and radial must be different axes")


class SourceFile(Settings):
    """A file with the blade's geometry."""

    file: str = Field(description="Path, from the folder of the blade's YAML")
    unit: Literal["m", "cm", "mm", "in"] = Field(description="Unit of its coordinates")
    frame: Frame = Field(default=Frame(), description="Axes of its coordinates")

    @property
    def metres(self) -> float:
        """One unit of the file, m."""
        return METRES[self.unit]


class SectionTable(SourceFile):
    """Blade lofted through sections given by their coordinates (CSV), from hub to tip."""

    edge_cut_percent: float = Field(
        gt=0,
        le=10,
        description="Distance from the ends of the chord at which both edges are cut (% of chord)",
    )


Name = Annotated[str, Field(min_length=1)]
# chosen by the kind of value, so that an error is reported for the form that was meant
Groups = Annotated[
    Annotated[Name, Tag("name")] | Annotated[tuple[Name, ...], Field(min_length=1), Tag("names")],
    Discriminator(lambda value: "names" if isinstance(value, list | tuple) else "name"),
]


class Face(Settings):
    """Faces of a CAD file or mesh, by group name or by radius."""

    either: ClassVar = [("group", "radius_mm")]

    group: Groups | None = Field(
        default=None, description="Name of the group, or a list of several names"
    )
    radius_mm: Length | None = Field(
        default=None, description="Faces entirely inside (root) or outside (tip) this radius (mm)"
    )

    @property
    def groups(self) -> tuple[str, ...]:
        """Names of the groups."""
        return (self.group,) if isinstance(self.group, str) else self.group or ()


class SolidFile(SourceFile):
    """A file with the whole solid; root and tip are given by group or radius."""

    root: Face = Field(description="Clamped faces")
    tip: Face = Field(description="Faces that may touch the casing")


class Cad(SolidFile):
    """Blade from a CAD file, STEP or BREP; a STEP file must declare the same unit."""


class MeshFile(SolidFile):
    """Blade from a mesh of another program: Abaqus/CalculiX, Ansys, Nastran, Gmsh or VTK."""


class MeshGeometry(MeshFile):
    """Mesh of another program whose tetrahedra are integrated here."""

    straighten: bool = Field(
        default=False,
        description="Move middle nodes to the middle of their edge, where cells would be refused "
        "for them: at thin curved edges, or at a quarter of an edge. What it costs is told",
    )


class MeshSize(Settings):
    """Size of the elements of the mesh."""

    element_size_mm: Length = Field(description="Edge length of the tetrahedra (mm)")


class Material(Settings):
    """Isotropic blade material."""

    hints: ClassVar = {
        "young_modulus_GPa": "1 MPa, or N/mm2, is 1e-3 GPa, 1 Pa is 1e-9 GPa",
        "density_kg_m3": "1 g/cm3 is 1000 kg/m3, 1 t/mm3 is 1e12 kg/m3",
    }

    young_modulus_GPa: float = Field(
        ge=1, le=1000, description="Young's modulus (GPa); the range detects wrong units"
    )
    poisson_ratio: float = Field(ge=0, lt=0.5, description="Poisson's ratio")
    density_kg_m3: float = Field(
        ge=1000, le=25000, description="Density (kg/m3); the range of metals detects wrong units"
    )

    @property
    def young_modulus(self) -> float:
        """Young's modulus, Pa."""
        return self.young_modulus_GPa * 1e9


OF_POINTS = ("nodes", "points_mm")  # keys of an interface of points


class Interface(Settings):
    """Interface with the casing: patches of the tip, or points with the basis `paper`."""

    replaced: ClassVar = {
        "along": "points are on the camber line: give others, as on the pressure side, as points_mm"
    }

    patches: int = Field(
        default=16,
        ge=2,
        le=64,
        description="Patches of the tip: hat functions along the chord, for its displacement",
    )
    across: int = Field(
        default=2,
        ge=1,
        le=2,
        description="Rows across the thickness: 2, the edges behind and ahead in rotation, linear "
        "between; 1, their mean, without lean and torsion of the tip",
    )
    nodes: int = Field(
        default=8,
        ge=2,
        le=64,
        description="Basis `paper` only: number of points, in the middles of equal chord lengths",
    )
    points_mm: tuple[tuple[float, float, float], ...] | None = Field(
        default=None,
        min_length=2,
        max_length=64,
        description="Basis `paper` only, instead of nodes: coordinates of the points in "
        "the blade's frame, leading edge first",
    )

    @checked
    def _rule_or_points(self) -> None:
        if self.points_mm and "nodes" in self.model_fields_set:
            raise ValueError("needs either points_mm or nodes")


ModeCount = Annotated[int, Field(ge=1, le=100)]


class EnrichedBasis(Settings):
    """Reduction basis of constraint and natural modes at several speeds; the default."""

    replaced: ClassVar = {"fixed_interface_modes": "natural modes stand for them: natural_modes"}

    kind: Literal["enriched"] = Field(
        default="enriched", description="constraint modes on patches, natural modes"
    )
    natural_modes: ModeCount = Field(default=24, description="Natural modes at each speed")
    speeds: int = Field(
        default=4,
        ge=3,
        le=9,
        description="Fewest speeds of the basis and of the polynomial K(Omega); more are added "
        "until it meets tolerance_percent",
    )
    rank_tolerance: float = Field(
        default=3e-3,
        ge=1e-5,  # close to the round-off of the energies
        lt=1,
        description="Directions with singular values (energy norm) below this share of the largest "
        "are left out",
    )
    tolerance_percent: float = Field(
        default=0.1,
        gt=0,
        le=100,
        description="Largest error of the first ten frequencies that the check allows (%)",
    )


class PaperBasis(Settings):
    """Reduction basis of Eqs. (4)-(5), exactly as in the paper, at three speeds.

    Its check reports the error and never fails.
    """

    tolerance_percent: ClassVar[float] = inf

    kind: Literal["paper"] = Field(description="Eqs. (4)-(5) exactly, on points, at three speeds")
    fixed_interface_modes: ModeCount = Field(
        default=6, description="eta, fixed-interface modes at each speed"
    )
    rank_tolerance: float = Field(
        default=1e-6,
        gt=0,
        lt=1,
        description="Directions with singular values below this share of the largest are left out",
    )


Basis = Annotated[
    EnrichedBasis | PaperBasis,
    one_of("basis", "kind", EnrichedBasis, PaperBasis, default="enriched"),
]


def settings_of_basis(basis: EnrichedBasis | PaperBasis) -> dict[str, Any]:
    """Settings that determine the basis: all but the tolerance of its check."""
    return basis.model_dump(mode="json", exclude={"tolerance_percent"})


def given_frequencies(measured: dict[int, float]) -> dict[str, Any]:
    """Settings on which a reduced model of ``measured`` frequencies depends; none without."""
    by_mode = {str(mode): measured[mode] for mode in sorted(measured)}
    return {"frequencies_Hz": by_mode} if measured else {}


MODES, ORDERS = 4, range(1, 17)  # whose linear crossings are told


class Margins(Settings):
    """Linear crossings that are told, with their margins from the operating speeds."""

    modes: int = Field(
        default=MODES,
        ge=1,
        le=10,
        description="Modes, from the first, whose crossings with engine orders are told; the model "
        "is checked for ten",
    )
    orders: list[Annotated[int, Field(ge=1, le=200)]] = Field(
        default=[*ORDERS],
        min_length=1,
        description="Their engine orders; those of casings are added",
    )


Measured = Annotated[
    dict[Annotated[int, Field(ge=1, le=100)], Annotated[float, Field(gt=0, le=1e6)]],
    Field(
        default={},
        description="Natural frequencies measured at rest (Hz), by mode, from 1, in place of those "
        "of the clamped blade; within 10 % of them",
    ),
]

MPa = Annotated[float, Field(gt=0, le=1e4)]


class Fatigue(Settings):
    """Strength of the material under stresses that alternate about a mean."""

    endurance_MPa: MPa = Field(
        description="Alternating stress that the material endures at zero mean stress (MPa)"
    )
    yield_MPa: MPa = Field(description="Yield stress (MPa)")
    ultimate_MPa: MPa = Field(description="Ultimate tensile strength (MPa)")
    line: Literal["goodman", "gerber", "soderberg"] = Field(
        default="goodman", description="How a tensile mean stress lowers the endurance"
    )
    slope_k: float | None = Field(
        default=None,
        ge=1,
        le=30,
        description="Slope k of the S-N line, N ~ S^-k, through the endurance at 1e7 cycles: adds "
        "Miner's damage of the runs at the peaks",
    )

    @checked
    def _in_order(self) -> None:
        require(
            (
                self.endurance_MPa <= self.yield_MPa <= self.ultimate_MPa,
                f"allowed from endurance_MPa = {self.endurance_MPa:g} to ultimate_MPa = "
                f"{self.ultimate_MPa:g}",
            ),
            kind=SettingsError,
            key="yield_MPa",
            value=self.yield_MPa,
            allowed={"ge": self.endurance_MPa, "le": self.ultimate_MPa},
        )


class Stress(Settings):
    """Where the stress of a rub is read, away from the clamp."""

    root: Literal["sharp", "fillet"] = Field(
        default="sharp",
        description="sharp: the nominal stress of the airfoil, for at a sharp clamp the local one "
        "has no limit; fillet: the local stress of a mesh with its fillet",
    )
    away_mm: Length | None = Field(
        default=None,
        description="Least distance from the clamp (mm); without it one thickness of the airfoil "
        "at the clamp, or with `fillet` beyond the elements that touch the clamp",
    )


SOURCES = ("sections", "section_table", "cad", "mesh_file")


class Blade(SettingsFile):
    """One blade: geometry, mesh, material, clamp at the hub, interface, speed range, reduction."""

    either: ClassVar = [SOURCES]

    sections: Sections | None = Field(default=None, description="Geometry from parameters")
    section_table: SectionTable | None = Field(
        default=None, description="Geometry from a table of section coordinates"
    )
    cad: Cad | None = Field(default=None, description="Geometry from a CAD file")
    mesh_file: MeshGeometry | None = Field(default=None, description="Geometry from a mesh")
    mesh: MeshSize | None = Field(default=None, description="Mesh; required without mesh_file")
    material: Material = Field(description="Material")
    fatigue: Fatigue | None = Field(
        default=None, description="Strength against which the stresses of a rub are compared"
    )
    stress: Stress = Field(default=Stress(), description="Where the stress of a rub is read")
    interface: Interface = Field(default=Interface(), description="Interface with the casing")
    max_speed_rpm: float = Field(
        gt=0, description="Omega_m, the highest speed of the reduced model (rpm)"
    )
    design_rpm: Annotated[float, Field(gt=0)] | None = Field(
        default=None, description="Design speed, marked in figures and summary (rpm)"
    )
    idle_rpm: Annotated[float, Field(gt=0)] | None = Field(
        default=None, description="Idle speed, marked in figures and summary (rpm)"
    )
    margins: Margins = Field(
        default=Margins(), description="Crossings whose margins from these speeds are told"
    )
    geometry_at_rpm: Annotated[float, Field(gt=0)] | None = Field(
        default=None,
        description="Speed at which the blade has the geometry given, as of a running blade (rpm); "
        "its shape at rest is computed. Without it the geometry is that at rest",
    )
    prestress: Literal["nonlinear", "linear"] = Field(
        default="nonlinear",
        description="Tangent at the nonlinear equilibrium, or geometric stiffness of one linear "
        "static solve",
    )
    basis: Basis = Field(default=EnrichedBasis(), description="Reduction basis")
    frequencies_Hz: Measured

    @checked
    def _mesh_of_its_source(self) -> None:
        require(
            (
                self.mesh or self.mesh_file,
                f"missing; {self.source_key} needs it: `mesh: {{element_size_mm: ...}}`",
            ),
            (
                not (self.mesh and self.mesh_file),
                "not allowed with mesh_file, whose file is the mesh; remove it",
            ),
            kind=SettingsError,
            key="mesh",
        )

    @checked
    def _speed_of_tip(self) -> None:
        if self.sections is not None:
            self.require_speed(self.sections.tip_radius, "the lengths")

    @checked
    def _operates_within_its_speeds(self) -> None:
        given = {"geometry_at": self.geometry_at_rpm or 0.0}
        above = (
            f"above the highest speed, {self.top_speed * RPM:.6g} rpm (max_speed_rpm): raise that"
        )
        require(
            *(
                (rpm / RPM <= self.top_speed, Fault(above, f"{name}_rpm", rpm))
                for name, rpm in (self.operating_rpm | given).items()
            ),
            kind=SettingsError,
            allowed={"le": self.top_speed * RPM},
        )

    @checked
    def _patches_or_points(self) -> None:
        given = self.interface.model_fields_set
        if self.of_points and (keys := [key for key in ("patches", "across") if key in given]):
            raise SettingsError(
                "basis paper has points: give nodes, or points_mm; null takes out what "
                "the base has",
                key=f"interface.{keys[0]}",
            )
        if not self.of_points and (points := [key for key in OF_POINTS if key in given]):
            raise SettingsError(
                "only with `basis: {kind: paper}`, whose interface is of points; all others have "
                "interface.patches",
                key=f"interface.{points[0]}",
            )

    @property
    def top_speed(self) -> float:
        """Omega_m, rad/s."""
        return self.max_speed_rpm / RPM

    def require_speed(self, radius: float, lengths: str) -> None:
        """Refuse a tip at ``radius`` (m) above ``MOST_TIP_SPEED``; ``lengths``: where it is given.

        Raises
        ------
        SettingsError
            The unit of length or of speed is wrong.
        """
        speed = self.top_speed * radius
        if speed > MOST_TIP_SPEED:
            raise SettingsError(
                f"the tip, at radius {radius:.4g} m, runs at {speed:.4g} m/s (allowed up to "
                f"{MOST_TIP_SPEED:g}); check this speed (rpm) and {lengths}",
                key="max_speed_rpm",
                value=self.max_speed_rpm,
                allowed={"le": self.max_speed_rpm * MOST_TIP_SPEED / speed},
            )

    def settings_of_matrices(self) -> dict[str, Any]:
        """Settings on which the matrices depend, besides the mesh."""
        values = self.model_dump(mode="json", exclude_none=True)
        return {
            "material": values["material"],
            "prestress": values["prestress"],
            "max_speed_rad_s": self.top_speed,
            "interface": {
                k: v for k, v in values["interface"].items() if (k in OF_POINTS) == self.of_points
            },
        }

    def settings_of_model(self) -> dict[str, Any]:
        """Settings on which the reduced model depends, besides the mesh and its directions."""
        of_basis = {"basis": settings_of_basis(self.basis)}
        return self.settings_of_matrices() | of_basis | given_frequencies(self.frequencies_Hz)

    @property
    def operating_rpm(self) -> dict[str, float]:
        """Speeds of operating lines by name, rpm; those that are given."""
        lines = {"design": self.design_rpm, "idle": self.idle_rpm}
        return {name: rpm for name, rpm in lines.items() if rpm is not None}

    @property
    def of_points(self) -> bool:
        """Whether the interface has points, as in the paper, instead of patches."""
        return isinstance(self.basis, PaperBasis)

    @property
    def source_key(self) -> str:
        """Key of the source of geometry."""
        return next(name for name in SOURCES if getattr(self, name) is not None)

    @property
    def source(self) -> Sections | SectionTable | Cad | MeshGeometry:
        """Settings of the source of geometry."""
        return getattr(self, self.source_key)

    @property
    def drawn(self) -> SourceFile:
        """Axes and unit of the geometry's file; without one those of `sections`: ours, in mm."""
        return self.source if self.file else SourceFile(file="", unit="mm")

    def hash_of_files(self, folder: Path) -> str:
        """Hash of the geometry file, which is in ``folder``; empty for `sections`."""
        return file_hash(folder / self.file) if self.file else ""

    @property
    def file(self) -> PurePath | None:
        """Geometry file, from the folder of the blade's YAML; None for `sections`."""
        return PurePath(self.source.file) if isinstance(self.source, SourceFile) else None
