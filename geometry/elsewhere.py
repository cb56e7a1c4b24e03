"""Blades whose matrices or reduced model were made elsewhere: their files take the mesh's place."""

from math import pi
from pathlib import Path, PurePath
from typing import Annotated, Any, ClassVar

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from geometry.base import (
    RPM,
    Check,
    Settings,
    SettingsError,
    SettingsFile,
    checked,
    file_hash,
    fingerprint,
    read_mapping,
    require,
)
from geometry.blade import (
    MOST_TIP_SPEED,
    Blade,
    EnrichedBasis,
    Margins,
    Measured,
    MeshFile,
    given_frequencies,
    settings_of_basis,
)
from geometry.frame import LENGTHS

SYMMETRIC = 1e-9  # of the largest entry: difference of symmetric ones
OFF_LINE = 0.1  # of the chord: distance of an interface point from the camber line at its xi
MOST_ARC = pi / 2  # rad, of the tip; those of blades take up to 0.7

File = Annotated[str, Field(min_length=1)]


class ModelElsewhere(SettingsFile):
    """A blade of which only a reduced model is known."""

    key: ClassVar[str] = "reduced_model"

    reduced_model: File = Field(
        description="File of the reduced model, from the folder of the blade's YAML"
    )
    frequencies_Hz: Measured

    top_speed: ClassVar[None] = None  # Omega_m is in the file
    operating_rpm: ClassVar[dict[str, float]] = {}
    margins: ClassVar[Margins] = Margins()

    @property
    def files(self) -> list[PurePath]:
        """The model's file, from the folder of the blade's YAML."""
        return [PurePath(self.reduced_model)]

    def settings_of_model(self) -> dict[str, Any]:
        """Settings on which the reduced model depends, besides its file."""
        return given_frequencies(self.frequencies_Hz)

    def hash_of_files(self, folder: Path) -> str:
        """Hash of the model's file, which is in ``folder``."""
        return file_hash(folder / self.reduced_model)


class FullMatrices(Settings):
    """Files of the matrices of a blade; paths as `reduced_model`.

    With ``mesh_file`` they are in its axes and unit, as the program wrote them. Without it they are
    of the clamped blade in its frame, SI: DoF 3 p + c, from 0, is component c (x, y, z) of row p of
    ``nodes``.
    """

    M: File = Field(
        description="Mass matrix: .mtx of Matrix Market or Abaqus, .npz of SciPy, .mas of "
        "CalculiX, .pch of Nastran, .full of Ansys"
    )
    K: dict[Annotated[float, Field(ge=0)], File] = Field(
        min_length=1,
        description="Stiffness matrix by speed (rad/s), the prestressed tangent; 0 is rest. As "
        "`M`, of CalculiX .sti",
    )
    mesh_file: MeshFile | None = Field(
        default=None, description="The mesh that the matrices are of (.inp, .cdb or .bdf)"
    )
    nodes: File | None = Field(
        default=None,
        description="Instead of `mesh_file`: nodes that are not clamped (CSV: x, y, z, m), one a "
        "row",
    )
    tip: File | None = Field(
        default=None,
        description="Facets of the tip (CSV), each three corners and the middles of the edges "
        "after them, by the rows of `nodes`, from 1",
    )
    S: File | None = Field(
        default=None,
        description="Instead of `tip`: interface operator (.mtx or .npz), rows radial, tangential "
        "and axial of each patch",
    )
    camber: File | None = Field(
        default=None,
        description="With `S`: camber line of the tip (CSV: x, y, z, m), evenly spaced in xi",
    )
    hub_radius_mm: float | None = Field(
        default=None, gt=0, description="With `nodes`: mean radius of the clamped nodes (mm)"
    )

    @checked
    def _from_rest_with_mesh_facets_or_operator(self) -> None:
        given = self.model_fields_set - {"M", "K"}
        table = {"nodes", "hub_radius_mm"}
        if given not in ({"mesh_file"}, table | {"tip"}, table | {"S", "camber"}):
            raise ValueError(
                "needs either mesh_file alone, or nodes and hub_radius_mm, and with them either "
                "tip, or S and camber"
            )
        require(
            (0.0 in self.K, 'needs the matrix at rest, `"0": FILE`, among its speeds'),
            kind=SettingsError,
            key="K",
        )


class MatricesElsewhere(SettingsFile):
    """A blade of which the full matrices are known; they are reduced here."""

    key: ClassVar[str] = "full_matrices"
    operating_rpm: ClassVar[dict[str, float]] = {}
    margins: ClassVar[Margins] = Margins()

    full_matrices: FullMatrices = Field(description="Matrices made elsewhere")
    patches: int = Field(default=16, ge=2, le=64, description="Patches of the tip")
    across: int | None = Field(
        default=None, ge=1, le=2, description="Rows across the thickness: 2, or 1 where S is given"
    )
    max_speed_rpm: float | None = Field(
        default=None, gt=0, description="Omega_m (rpm), where K is given at rest alone"
    )
    basis: EnrichedBasis = Field(default=EnrichedBasis(), description="Reduction basis")
    frequencies_Hz: Measured

    @checked
    def _one_row_of_S(self) -> None:
        require(
            ((self.across or 1) <= self._most_across, "S has one row across the thickness"),
            kind=SettingsError,
            key="across",
            value=self.across,
            allowed=1,
        )

    @property
    def _most_across(self) -> int:
        return 1 if self.full_matrices.S else 2

    @checked
    def _one_highest_speed(self) -> None:
        require(
            (
                (self.max_speed_rpm is not None) == (len(self.full_matrices.K) == 1),
                "give it where K is given at rest alone, and only there; "
                "else it is the last speed of K",
            ),
            kind=SettingsError,
            key="max_speed_rpm",
            value=self.max_speed_rpm,
        )

    @property
    def files(self) -> list[PurePath]:
        """All files, from the folder of the blade's YAML; ``K`` by ascending speed."""
        given = self.full_matrices
        matrices = [
            PurePath(file) for file in (given.M, *(given.K[speed] for speed in self.speeds))
        ]
        # of CalculiX the names of the rows are in a file beside
        rows = [f.with_suffix(".dof") for f in matrices if f.suffix.lower() in (".sti", ".mas")]
        others = (
            given.mesh_file and given.mesh_file.file,
            given.nodes,
            given.tip,
            given.S,
            given.camber,
        )
        return list(dict.fromkeys([*matrices, *rows, *(PurePath(file) for file in others if file)]))

    def hash_of_files(self, folder: Path) -> str:
        """Hash of the bytes of all files, which are in ``folder``."""
        return fingerprint([file_hash(folder / file) for file in self.files])

    @property
    def speeds(self) -> list[float]:
        """Speeds of K, rad/s, ascending from rest."""
        return sorted(self.full_matrices.K)

    @property
    def top_speed(self) -> float:
        """Omega_m, rad/s."""
        return (self.max_speed_rpm or 0.0) / RPM or self.speeds[-1]

    def settings_of_matrices(self) -> dict[str, Any]:
        """Settings on which the matrices depend, besides their files."""
        return {
            "full_matrices": self.speeds,
            "interface": {"patches": self.patches, "across": self.across or self._most_across},
            "max_speed_rad_s": self.top_speed,
            "mesh": self.full_matrices.model_dump(mode="json", include={"mesh_file"}),
        }

    def settings_of_model(self) -> dict[str, Any]:
        """Settings on which the reduced model depends, besides the files and its directions."""
        of_basis = {"basis": settings_of_basis(self.basis)}
        return self.settings_of_matrices() | of_basis | given_frequencies(self.frequencies_Hz)


type AnyBlade = Blade | ModelElsewhere | MatricesElsewhere
ELSEWHERE = (ModelElsewhere, MatricesElsewhere)


def read_blade(path: str | Path) -> AnyBlade:
    """Read a blade's file, of whichever kind.

    Raises
    ------
    geometry.base.errors.SettingsError
        When it is not valid; the message has a line for each fault.
    """
    values = read_mapping(path)
    return next((kind for kind in ELSEWHERE if kind.key in values), Blade).load(path)


def tip_checks(camber: NDArray[np.float64], span: float, top_speed: float) -> list[Check]:
    """Check the camber line, lengths and highest speed, which each blade has.

    Parameters
    ----------
    camber : (places, 3), r, theta, z in m, rad, from the leading to the trailing edge
    span : m
    top_speed : rad/s
    """
    radius, theta, z = camber.T
    speed = top_speed * radius.max()
    return [
        (
            z[-1] > z[0],
            f"camber: z falls from {z[0]:.6g} to {z[-1]:.6g} m; z must grow from the leading to "
            f"the trailing edge, downstream",
        ),
        (
            np.ptp(theta) <= MOST_ARC,
            f"camber: theta goes over {np.ptp(theta):.4g} rad, allowed up to {MOST_ARC:.4g}: check "
            f"the unit (rad, not degrees)",
        ),
        (
            LENGTHS[0] <= span < radius.min() <= radius.max() <= LENGTHS[1],
            f"span: {span:.6g} m, radius of the tip {radius.max():.6g} m: allowed {LENGTHS[0]:g} "
            f"to {LENGTHS[1]:g}, the span less than the radius: check the unit (m), and that z is "
            f"the engine axis",
        ),
        (
            0 < speed <= MOST_TIP_SPEED,
            f"Omega_m: {top_speed:.6g} rad/s: the tip runs at {speed:.4g} m/s, allowed above 0 "
            f"up to {MOST_TIP_SPEED:g}: check the unit (max_speed_rpm in rpm, "
            "Omega_m and the speeds of K in rad/s; m)",
        ),
    ]
