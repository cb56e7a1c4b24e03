"""Outputs of a scene, and the peaks around which speeds are added."""

from collections.abc import Sequence
from typing import Annotated, ClassVar, Literal

from pydantic import Field

from geometry.base import Settings, SettingsError, checked
from simulate.scene.casing import HIGHEST_ORDER

STEADY, GROWING, DYING_OUT, TOO_SHORT = "steady", "growing", "dying out", "too short to say"
TRENDS = (STEADY, GROWING, DYING_OUT, TOO_SHORT)  # of a run, at its end (``marching.trend``)
ROSETTE = (0, 45, 90)  # deg, of its grids from the first, anticlockwise seen from outside


class History(Settings):
    """Displacement and force over time, at every sample."""

    replaced: ClassVar = {"nodes": "give chord, places as chord fractions: node 1 of 8 was 0.0625"}

    chord: list[Annotated[float, Field(ge=0, le=1)]] = Field(
        min_length=1, description="Places as chord fractions, 0 at the leading edge"
    )
    directions: Literal["rt", "rtz"] | None = Field(
        default=None,
        description="Displacements along the radius, around (in the sense of rotation) and along "
        "the axis (downstream), each of its own; by default what closes the gap alone",
    )
    force: bool = Field(
        default=False,
        description="Contact force on the eighth of the chord around each place, mean from sample "
        "to sample",
    )


class Gauge(Settings):
    """A strain gauge on the surface of the blade, of one grid or three."""

    name: str = Field(pattern=r"^[a-z0-9][a-z0-9-]*$", description="Name in results")
    at: tuple[float, float, float] = Field(
        description="Its middle, in axes and unit of the blade's file; of a blade from `sections` "
        "in the blade's frame (mm)"
    )
    direction: tuple[float, float, float] = Field(
        description="Along its grid, in the same axes; its part along the surface counts"
    )
    rosette: bool = Field(
        default=False,
        description="Three grids, NAME-0 along the direction, NAME-45 and NAME-90 anticlockwise "
        "from there (deg, seen from outside)",
    )
    length_mm: float = Field(
        default=2.0, gt=0, le=50, description="Length over which strain is averaged (mm)"
    )


class Record(Settings):
    """Outputs of a run."""

    samples_per_round: int = Field(
        default=2048,
        ge=64,
        le=1_000_000,
        description="Samples per revolution, for spectrum, history and states",
    )
    spectrum_rounds: int | None = Field(
        default=None,
        ge=1,
        description="Spectrum of u_r at xi = 1/16, over this number of last revolutions",
    )
    states_rounds: int | None = Field(
        default=None,
        ge=1,
        description="Reduced displacements of all DoFs, over this number of last revolutions",
    )
    wear: bool = Field(default=True, description="Worn depth of every rod at the end")
    wear_by_round: bool = Field(
        default=False, description="Worn depth of each eighth of the chord after every revolution"
    )
    history: History | None = Field(default=None, description="Displacement over time")
    contact_force: bool = Field(
        default=False,
        description="Peak and mean contact force on each eighth of the chord in every revolution",
    )
    end: bool = Field(default=False, description="Final state, for other scenes to `start` from")
    motion: int | None = Field(
        default=None,
        ge=1,
        le=10,
        description="For animations and stresses: states of the last revolution, eight in each "
        "period of this natural mode, and at instants of those that strain the blade most; and the "
        "range of u_r at xi = 1/16 in sixteenths of each revolution",
    )
    blades: list[Annotated[int, Field(ge=0)]] | Literal["worst", "all"] = Field(
        default="worst",
        description="Of a stage: blades whose records over time and forces are kept beside those "
        "of the worst, by their numbers from 0, or `all`",
    )
    gauges: list[Gauge] | None = Field(
        default=None,
        min_length=1,
        description="Strain gauges: strain and stress over the revolutions of the spectrum, else "
        "over the last",
    )

    def listed(self, count: int) -> Sequence[int]:
        """Blades of ``count`` whose records are kept beside those of the worst."""
        if isinstance(self.blades, str):
            return range(count) if self.blades == "all" else ()
        return self.blades

    def rounds_of_u_r(self, rounds: int) -> int:
        """Last revolutions, of all ``rounds``, whose displacements are kept."""
        return rounds if self.history or self.motion else self.spectrum_rounds or 0

    @property
    def rounds_of_spectrum(self) -> int:
        """Last revolutions of the spectrum; without one the last, of which gauges are read."""
        return self.spectrum_rounds or 1

    @property
    def highest_order(self) -> int:
        """Highest of the engine orders along which responses are sought."""
        return min(HIGHEST_ORDER, self.samples_per_round // 2 - 1)

    @property
    def rounds_of_states(self) -> int:
        """Last revolutions whose reduced displacements are kept."""
        return self.states_rounds or (1 if self.motion else 0)

    @property
    def chord(self) -> list[float]:
        """Chord fractions of the history; empty without it."""
        return self.history.chord if self.history else []

    @property
    def forces(self) -> bool:
        """Whether forces on eighths of the chord are kept."""
        return self.contact_force or bool(self.history and self.history.force)

    @property
    def directions(self) -> str:
        """Directions of the history; empty where what closes the gap is kept alone."""
        return (self.history.directions or "") if self.history else ""

    @property
    def grids(self) -> dict[str, tuple[Gauge, int]]:
        """Gauge of each grid, and its angle there, deg, by its name in results."""
        return {
            f"{gauge.name}-{angle}" if gauge.rosette else gauge.name: (gauge, angle)
            for gauge in self.gauges or []
            for angle in (ROSETTE if gauge.rosette else ROSETTE[:1])
        }

    @property
    def observables(self) -> list[str]:
        """Names of the recorded outputs."""
        asked = {
            "spectrum": self.spectrum_rounds,
            "wear": self.wear,
            "history": self.history,
            "force_peak": self.contact_force,
            "states": self.states_rounds,
        }
        return [name for name, wanted in asked.items() if wanted]

    @checked
    def _grid_names_differ(self) -> None:
        if len(self.grids) < sum(
            len(ROSETTE) if gauge.rosette else 1 for gauge in self.gauges or []
        ):
            raise SettingsError(
                "two have the same name in results, where that of a rosette ends in -0, -45, -90",
                key="gauges",
                value=", ".join(gauge.name for gauge in self.gauges or []),
            )


class Peaks(Settings):
    """Responses that stand out, around which the sweep adds speeds."""

    hints: ClassVar = {"within_over_f1": "over f1(0), like speeds.over_f1: 4.0e-4 is usual"}

    orders: list[Annotated[int, Field(ge=1, le=HIGHEST_ORDER)]] | None = Field(
        default=None,
        min_length=1,
        description="Engine orders around whose peaks of mode 1 speeds are added; without them "
        "around every response that stands out",
    )
    within_over_f1: float = Field(
        ge=1e-6, le=1, description="Largest spacing of the speeds around each peak, over f1(0)"
    )
    most: int = Field(
        default=60, ge=1, le=10_000, description="Most speeds that are added without `orders`"
    )
