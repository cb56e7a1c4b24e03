"""Settings of a scene file: everything that a run depends on; keys end in their unit."""

from itertools import product
from math import radians
from typing import Annotated, Any, ClassVar, Literal, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray
from pydantic import Discriminator, Field, Tag, model_validator

from geometry.given import AnyBlade
from geometry.project import Fault, Settings, SettingsError, SettingsFile, checked, one_of
from simulate.scene.laws import AnyLaw
from simulate.scene.tables import LARGEST_DEPTH, AnyTable, AnyThermal, RampTable

LEADING, TRAILING = 1 / 16, 15 / 16  # chord fractions at which gaps and outputs are given
BESIDE = 2  # engine orders beside that of a peak, with which it is compared
MOST_ROUNDS = 100_000
STRIPS = 16  # along the chord, where the scene does not say

Positive = Annotated[float, Field(gt=0)]
NonNegative = Annotated[float, Field(ge=0)]
# the ranges below detect wrong units; ``hints`` name the likely slip
Gap = Annotated[float, Field(ge=0, le=0.05)]
Amplitude = Annotated[float, Field(ge=0, le=LARGEST_DEPTH)]
Factor = Annotated[float, Field(ge=0, le=1e4)]
GapOverSpan = Annotated[float, Field(ge=0, le=0.5)]
ChordFraction = Annotated[float, Field(ge=0, le=1)]
Rods = Annotated[int, Field(ge=1, le=10_000_000)]
StepsPerRound = Annotated[int, Field(ge=64, le=10**9)]
MassScaling = Annotated[
    Annotated[float, Field(gt=0)] | None,
    Field(
        description="Modes above this frequency (Hz) get the mass that lowers them to it; K stays"
    ),
]


class _Alternatives(Settings):
    """A quantity that may be given in one of several units, each with its own key."""

    def _exactly_one(self, *keys: str) -> str:
        given = [key for key in keys if getattr(self, key) is not None]
        if len(given) != 1:
            raise SettingsError(
                f"give exactly one of {', '.join(keys)}; found {len(given)}", allowed=keys
            )
        return given[0]


class Range(Settings):
    """Equally spaced values, both ends included."""

    first: Positive = Field(description="First value")
    last: Positive = Field(description="Last value")
    count: int = Field(ge=1, le=100_000, description="Number of values")

    def values(self) -> NDArray[np.float64]:
        """The values (count,), rounded to 12 digits so that 0.31 is 0.31."""
        values = np.linspace(self.first, self.last, self.count)
        return np.array([float(f"{value:.12g}") for value in values])


def _kind(value: object) -> str:
    return "range" if isinstance(value, dict | Range) else "list"


# chosen by the kind of value, so that an error is reported for the form that was meant
SpeedValues = Annotated[
    Annotated[Range, Tag("range")] | Annotated[list[Positive], Field(min_length=1), Tag("list")],
    Discriminator(_kind),
]


OVER_F1, RAD_S = (1e-4, 20.0), (1.0, 1e5)  # slowest and fastest speed


class Speeds(_Alternatives):
    """Rotational speeds of the sweep."""

    over_f1: SpeedValues | None = Field(
        default=None, description="Speeds over f1(0), revolutions per second over Hz"
    )
    rad_s: SpeedValues | None = Field(default=None, description="Speeds (rad/s)")

    @checked
    def _one_unit(self) -> None:
        self._exactly_one("over_f1", "rad_s")

    @checked
    def _of_their_unit(self) -> None:
        """Refuse speeds that are of another unit."""
        if self.over_f1 is not None:
            self._within("over_f1", OVER_F1, "0.3 is usual; rad/s are given as speeds.rad_s")
        if self.rad_s is not None:
            slips = "1 rpm is 0.1047 rad/s, 1 Hz is 6.283 rad/s; over f1(0) they are speeds.over_f1"
            self._within("rad_s", RAD_S, slips)

    def _within(self, key: str, allowed: tuple[float, float], slips: str) -> None:
        for speed in _values(getattr(self, key)):
            if not allowed[0] <= speed <= allowed[1]:
                raise SettingsError(
                    f"allowed from {allowed[0]:g} to {allowed[1]:g}; {slips}",
                    key=key,
                    value=float(speed),
                    allowed=allowed,
                )

    in_turn: bool = Field(
        default=False,
        description="Each run goes on from what the one before left, in the order of the list",
    )

    @property
    def count(self) -> int:
        """Number of speeds."""
        given = self.over_f1 if self.over_f1 is not None else self.rad_s
        return len(_values(given))

    def omega(self, f1: float) -> NDArray[np.float64]:
        """Omega (speeds,), rad/s; ``f1`` in Hz."""
        if self.over_f1 is not None:
            return 2 * np.pi * f1 * _values(self.over_f1)
        return _values(self.rad_s)

    @property
    def highest_rad_s(self) -> float | None:
        """The highest speed, rad/s, where it is known without f1(0)."""
        return None if self.rad_s is None else float(_values(self.rad_s).max())


class CentralDifference(_Alternatives):
    """Central differences with prediction and correction, Eqs. (18)-(20)."""

    scheme: Literal["central-difference"] = Field(description="the paper's, Eqs. (18)-(20)")
    steps_per_round: StepsPerRound | None = Field(default=None, description="Steps per round")
    fraction_of_limit: float | None = Field(
        default=None, gt=0, le=1, description="Step over the stability limit with contact"
    )
    mass_scaling_hz: MassScaling = None

    @checked
    def _one_step(self) -> None:
        self._exactly_one("steps_per_round", "fraction_of_limit")


class PiecewiseExact(Settings):
    """Exact modes under a force constant over each step, that force implicit: always stable."""

    scheme: Literal["piecewise-exact"] = Field(
        description="exact for a contact force constant over the step, stable for any step"
    )
    steps_per_round: StepsPerRound = Field(description="Steps per round")
    mass_scaling_hz: MassScaling = None

    @model_validator(mode="before")
    @classmethod
    def _no_limit(cls, values: Any) -> Any:
        if isinstance(values, dict) and "fraction_of_limit" in values:
            raise SettingsError(
                "piecewise-exact has no stability limit; give steps_per_round instead",
                key="fraction_of_limit",
            )
        return values


Integrator = one_of("integrator", "scheme", PiecewiseExact, CentralDifference)


IN_M = "in m: 0.1 mm is 1.0e-4"
OVER_SPAN = "over the span: 0.02 % of it is 2.0e-4"


class Clearance(_Alternatives):
    """Gap between tip and liner, linear along the chord, given at two places of it."""

    hints: ClassVar = {
        "leading_edge_m": IN_M,
        "trailing_edge_m": IN_M,
        "leading_edge_over_span": OVER_SPAN,
        "trailing_edge_over_span": OVER_SPAN,
    }

    leading_edge_m: Gap | None = Field(
        default=None, description="Gap at xi = 1/16 of the chord (m)"
    )
    trailing_edge_m: Gap | None = Field(
        default=None, description="Gap at xi = 15/16 of the chord (m)"
    )
    leading_edge_over_span: GapOverSpan | None = Field(
        default=None, description="Gap at xi = 1/16 of the chord over the blade length"
    )
    trailing_edge_over_span: GapOverSpan | None = Field(
        default=None, description="Gap at xi = 15/16 of the chord over the blade length"
    )
    at: Literal["running", "rest"] = Field(
        default="running",
        description="Where the gaps are these: at each speed of the sweep, or at rest; then each "
        "speed has them less the static growth of the tip",
    )
    thermal_growth: AnyThermal | None = Field(
        default=None,
        description="With `at: rest`: further growth of the tip over the speed, as a CSV file",
    )

    @checked
    def _one_unit_each(self) -> None:
        self._exactly_one("leading_edge_m", "leading_edge_over_span")
        self._exactly_one("trailing_edge_m", "trailing_edge_over_span")

    @checked
    def _growth_is_from_rest(self) -> None:
        if self.thermal_growth is not None and not self.at_rest:
            raise SettingsError(
                "only with `at: rest`: running gaps hold it already", key="thermal_growth"
            )

    @property
    def at_rest(self) -> bool:
        """Whether the gaps are those at rest, from which the growth of the tip takes."""
        return self.at == "rest"

    def gaps(self, xi: ArrayLike, span: float) -> NDArray[np.float64]:
        """Gaps as given, m, of the shape of the chord fractions ``xi``; ``span``: length, m."""
        in_m = (self.leading_edge_m, self.trailing_edge_m)
        of_span = (self.leading_edge_over_span, self.trailing_edge_over_span)
        first, last = (
            m if m is not None else share * span for m, share in zip(in_m, of_span, strict=True)
        )
        return first + (last - first) * (np.asarray(xi) - LEADING) / (TRAILING - LEADING)


class Harmonic(_Alternatives):
    """One harmonic of the casing, amplitude cos(order (theta - speed t) + phase), inward."""

    hints: ClassVar = {
        "amplitude_m": IN_M,
        "amplitude_gaps": "over the gap: 150 % of it is 1.5",
        "phase_deg": "in degrees",
    }

    order: int = Field(ge=0, le=200, description="Nodal diameters")
    amplitude_m: Amplitude | None = Field(default=None, description="Amplitude (m)")
    amplitude_gaps: Factor | None = Field(
        default=None, description="Amplitude over the gap at xi = 1/16"
    )
    phase_deg: float = Field(default=0, ge=-360, le=360, description="Phase (deg)")
    speed_rad_s: float = Field(
        default=0,
        ge=-1e5,
        le=1e5,
        description="Speed at which it travels around the casing, in the sense of rotation (rad/s)",
    )

    @checked
    def _one_unit(self) -> None:
        self._exactly_one("amplitude_m", "amplitude_gaps")

    @checked
    def _what_travels_has_lobes(self) -> None:
        if self.speed_rad_s != 0 and self.order == 0:
            raise SettingsError(
                "order 0 is the same all around; allowed 0, or order from 1",
                key="speed_rad_s",
                value=self.speed_rad_s,
            )

    def size(self, gap: float) -> float:
        """Amplitude, m; ``gap`` at xi = 1/16 in m."""
        given_m = self.amplitude_m is not None
        return self.amplitude_m if given_m else self.amplitude_gaps * gap

    def turn(self, time: float) -> float:
        """Phase, rad, that passes in ``time``, s."""
        return self.order * self.speed_rad_s * time

    def inward(
        self, theta: NDArray[np.float64], gap: float, time: float = 0.0
    ) -> NDArray[np.float64]:
        """Distortion (m), inward, at ``theta`` (rad); ``gap`` at xi = 1/16 in m, time in s."""
        angle = self.order * theta - self.turn(time) + radians(self.phase_deg)
        return self.size(gap) * np.cos(angle)


class Casing(_Alternatives):
    """Rigid casing, whose distortion grows over a ramp or follows a table, and may travel."""

    hints: ClassVar = {
        "scale": "a factor: 127 % is 1.27",
        "ramp_rounds": "in rounds of the blade",
    }

    harmonics: list[Harmonic] | None = Field(
        default=None, description="Distortion at the end of the ramp, or where its factor is 1"
    )
    table: AnyTable | None = Field(
        default=None,
        description="The same as a CSV file: angle in degrees, inward depth in m, mm or um",
    )
    scale: Factor = Field(default=1.0, description="Factor on the distortion")
    ramp_rounds: float | None = Field(
        default=None, ge=0, le=MOST_ROUNDS, description="Rounds over which the distortion grows"
    )
    ramp: RampTable | None = Field(
        default=None, description="Instead of ramp_rounds: the distortion over the rounds"
    )

    @checked
    def _one_form(self) -> None:
        self._exactly_one("harmonics", "table")
        self._exactly_one("ramp_rounds", "ramp")

    @property
    def at_start(self) -> float:
        """Share of the distortion at the start."""
        return self.ramp.factor[0] if self.ramp else float(self.ramp_rounds == 0)

    @property
    def travelling(self) -> list[Harmonic]:
        """Harmonics that travel."""
        return [of for of in self.harmonics or () if of.speed_rad_s != 0]

    def inward(
        self, theta: NDArray[np.float64], gap: float, time: float = 0.0
    ) -> NDArray[np.float64]:
        """d(theta) (m), inward, at ``theta`` (rad); ``gap`` at xi = 1/16 in m, ``time`` in s."""
        if self.table is not None:
            return self.scale * self.table.inward(theta)
        return self.scale * sum((h.inward(theta, gap, time) for h in self.harmonics), 0 * theta)

    def fixed(self, theta: NDArray[np.float64], gap: float) -> NDArray[np.float64]:
        """The part of d(theta), m, that does not travel."""
        stands = [of for of in self.harmonics or () if of.speed_rad_s == 0]
        return self.scale * sum((of.inward(theta, gap) for of in stands), 0 * theta)


# Pa. Stiffer than ten times diamond, a liner is the law `rigid`: its rods ask for steps that no
# scene has, and central differences agree with half their step where both are wrong.
RANGES = {"E": (1e5, 1e13), "K": (0.0, 1e16), "sigma_Y": (0.0, 1e16)}


class Liner(Settings):
    """Abradable liner: strips of independent rods, each over an equal part of the tip's chord."""

    replaced: ClassVar = {
        "strip_width_m": "strips have their widths from the tip: give liner.strips, their number"
    }

    hints: ClassVar = {
        "thickness_m": "in m: 5 mm is 5.0e-3",
        "footprint_m": "in m: 5 mm is 5.0e-3; the arc over which one strip of the tip rubs",
    }

    law: AnyLaw = Field(description="Law of the rods")
    thickness_m: float = Field(ge=1e-7, le=0.1, description="Thickness l (m)")
    strips: Annotated[int, Field(ge=1, le=256)] | None = Field(
        default=None,
        description=f"Number of strips along the chord, of equal length; {STRIPS} without "
        "accuracy, which chooses it",
    )
    footprint_m: float = Field(
        ge=1e-5, le=0.3, description="Arc length of a strip that the tip covers (m)"
    )
    rods_per_round: Rods | None = Field(
        default=None, description="Density nu, rods per round; required without accuracy"
    )
    worn_through: Literal["stop", "casing"] = Field(
        default="stop",
        description="When the tip has worn through the liner, the run stops, or goes on against "
        "the rigid casing",
    )

    law_in_march: bool = Field(
        default=False,
        description="A law of one's own is compiled into the march, in some 12 s; else one march "
        "calls all of them, at some 1.6 times the time",
    )

    @checked
    def _law_in_pascals(self) -> None:
        """Refuse moduli that are of another unit than ``unit_Pa``."""
        unit = getattr(self.law, "unit_Pa", None)
        given = {name: getattr(self.law, name, None) for name in RANGES if unit}
        for name, value in given.items():
            least, largest = RANGES[name]
            if value is not None and not least <= value * unit <= largest:
                stiffer = "; a stiffer liner is `kind: rigid`" if name == "E" else ""
                raise SettingsError(
                    f"is {value * unit:.3g} Pa with unit_Pa: {unit:g}; allowed from {least:g} to "
                    f"{largest:g} Pa: liners have 1e7 to 1e11 Pa; {name} is given in unit_Pa, "
                    f"which is 1.0e+9 for GPa{stiffer}",
                    key=f"law.{name}",
                    value=value,
                    allowed=(least / unit, largest / unit),
                )

    @property
    def m(self) -> int:
        """Number of strips."""
        return self.strips or STRIPS

    @property
    def rigid_key(self) -> str | None:
        """Key that makes the casing rigid for the tip; None where the rods always deform."""
        if self.law.rigid_from is not None:
            return f"law.kind: {self.law.kind}"
        through = self.law.touches and self.worn_through == "casing"
        return "worn_through: casing" if through else None


class Profile(Settings):
    """Profile of the tip over the footprint, Fig. 4, closest to the casing at p = 0.

    p(s) = tilt s + edge_drop (2 s / footprint)^2 + constant, s from the camber line in the sense of
    rotation.
    """

    hints: ClassVar = {
        "edge_drop_m": "in m: 5 um is 5.0e-6",
        "tilt": "a slope: 1 deg is 0.01745",
    }

    edge_drop_m: float = Field(
        default=0.0,
        ge=0,
        le=0.02,
        description="Rounding: how far both ends lie below the middle (m)",
    )
    tilt: float = Field(
        default=0.0, ge=-1, le=1, description="Slope of the tip; its trailing side rubs if > 0"
    )

    @checked
    def _not_flat(self) -> None:
        if self.edge_drop_m == 0 and self.tilt == 0:
            raise ValueError("give edge_drop_m or tilt: without either the tip is flat")


class Contact(Settings):
    """Contact model: profile of the tip and tangential force."""

    profile: Profile | None = Field(default=None, description="Rounded tip; flat without it")
    tangential: bool = Field(
        default=False,
        description="Tangential force: the force of each rod acts along the profile's normal",
    )
    friction: float | None = Field(
        default=None,
        gt=0,
        le=1,
        description="Coefficient of the friction of the sliding tip, against the rotation",
    )

    @property
    def along(self) -> bool:
        """Whether there is a tangential force."""
        return self.tangential or self.friction is not None

    @checked
    def _profile_gives_the_normal(self) -> None:
        if self.tangential and self.profile is None:
            raise SettingsError(
                "needs `profile: {edge_drop_m: ...}`: on a flat tip the force is radial",
                key="tangential",
                value=True,
            )

    @checked
    def _one_tangential_force(self) -> None:
        if self.tangential and self.friction is not None:
            raise SettingsError(
                "does not go with `tangential: true`, the tangential force of the profile: take "
                "one of them out",
                key="friction",
            )


class History(Settings):
    """Radial displacement over time, at every sample."""

    replaced: ClassVar = {"nodes": "give chord, places as chord fractions: node 1 of 8 was 0.0625"}

    chord: list[ChordFraction] = Field(
        min_length=1, description="Places as chord fractions, 0 at the leading edge"
    )


class Record(Settings):
    """Outputs of a run."""

    samples_per_round: int = Field(
        default=2048,
        ge=64,
        le=1_000_000,
        description="Samples per round, for spectrum, history and states",
    )
    spectrum_rounds: int | None = Field(
        default=None,
        ge=1,
        description="Spectrum of u_r at xi = 1/16, over the given number of last rounds",
    )
    states_rounds: int | None = Field(
        default=None,
        ge=1,
        description="Reduced displacements of all DoFs, over the given number of last rounds",
    )
    wear: bool = Field(default=True, description="Worn depth of every rod at the end")
    history: History | None = Field(default=None, description="Displacement over time")
    contact_force: bool = Field(
        default=False,
        description="Peak and mean contact force on each eighth of the chord in every round",
    )
    end: bool = Field(default=False, description="What the run leaves, for others to `start` from")
    motion: int | None = Field(
        default=None,
        ge=1,
        le=10,
        description="For pictures, no observable: states of the last round, eight in each period "
        "of this natural mode, and the range of u_r at xi = 1/16 in sixteenths of each round",
    )

    @property
    def chord(self) -> list[float]:
        """Chord fractions of the history; empty without it."""
        return self.history.chord if self.history else []

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


class Peaks(Settings):
    """Response peaks, around which the sweep adds speeds."""

    hints: ClassVar = {"within_over_f1": "over f1(0), like speeds.over_f1: 4.0e-4 is usual"}

    orders: list[Annotated[int, Field(ge=1, le=200)]] = Field(
        min_length=1, description="Engine orders around whose peaks speeds are added"
    )
    within_over_f1: float = Field(
        ge=1e-6, le=1, description="Largest spacing of the speeds around each peak, over f1(0)"
    )


class Start(Settings):
    """Start of each run from what a run of another scene left, in place of rest and no wear."""

    scene: str = Field(
        pattern=r"^[a-z0-9][a-z0-9-]*$", description="Scene before, with `record.end`"
    )
    speed_over_f1: Positive | None = Field(
        default=None, description="Its speed over f1(0); without it that of each run"
    )
    liner_only: bool = Field(
        default=False, description="The blade starts at rest, over the liner that was left"
    )


class Scene(SettingsFile):
    """One scene: blade, speeds, casing, liner and contact, integrator, and outputs.

    >>> scene = Scene.load("scene.yaml")
    >>> scene.rounds, scene.liner.law.E, scene.liner.law.K
    (20, 1.0, 0.45)
    """

    hints: ClassVar = {"damping_ratio": "over critical damping: 0.5 % is 0.005"}

    blade: str = Field(pattern=r"^[a-z0-9][a-z0-9-]*$", description="Name of the blade file")
    speeds: Speeds = Field(description="Rotational speeds")
    rounds: int = Field(ge=1, le=MOST_ROUNDS, description="Revolutions of the blade at each speed")
    integrator: Integrator | None = Field(
        default=None, description="Scheme and time step; required without accuracy"
    )
    accuracy: float | None = Field(
        default=None,
        ge=0.005,  # below, the error of wear is no longer of second order in the width of rods
        le=0.1,  # above, a step would pass more than the footprint
        description="Relative error allowed in the recorded outputs; replaces integrator, "
        "liner.rods_per_round and liner.strips, which are then chosen",
    )
    damping_ratio: float = Field(ge=0, lt=1, description="xi of every mode of K(Omega)")
    clearance: Clearance = Field(description="Gaps in operation, before the casing distorts")
    casing: Casing = Field(description="Casing distortion")
    liner: Liner = Field(description="Abradable liner")
    contact: Contact = Field(default=Contact(), description="Tip profile and tangential force")
    record: Record = Field(default=Record(), description="Outputs")
    peaks: Peaks | None = Field(default=None, description="Peaks around which speeds are added")
    start: Start | None = Field(
        default=None, description="Start from another scene's end; at rest without it"
    )
    twin: bool = Field(
        default=False,
        description="March each speed twice, with gaps that differ by 1e-10, to tell which "
        "outputs can be predicted",
    )
    halving: bool = Field(
        default=False,
        description="March each speed again with half the step, where that leaves a doubt with a "
        "quarter, to bound the error of the step; a run with a bound above 10 % is `inaccurate`",
    )
    design: str | None = Field(
        default=None,
        min_length=1,
        description="Many runs: a CSV file beside the scene's, whose columns are keys, each row a "
        "scene with other values of them; or a YAML file, a Sobol design",
    )

    def but(self, **changes: Any) -> Self:
        """The scene with other values, checked again; a mapping changes the keys it names.

        ``casing`` may be a function d(theta), rad to m, inward. See ``Settings.but``.

        >>> stiffer = scene.but(liner={"law": {"E": 10.0}}, damping_ratio=0.01)
        >>> stiffer.liner.law.E, stiffer.liner.law.K, stiffer.damping_ratio
        (10.0, 0.45, 0.01)
        >>> oval = scene.but(casing=lambda theta: 2e-5 * np.cos(2 * theta))
        >>> oval.casing.inward(np.array([0.0, np.pi / 2]), gap=2e-5).round(9)
        array([ 2.e-05, -2.e-05])

        Raises
        ------
        SettingsError
            When a key is unknown or the whole does not hold together.
        """
        if callable(function := changes.get("casing")):
            changes["casing"] = {"table": function, "harmonics": None}
        return super().but(**changes)

    @property
    def no_torque(self) -> str | None:
        """Keys for which the model has no torque (``errors.loads``); None where it has one."""
        if self.contact.profile is not None and not self.contact.tangential:
            return "contact.profile without contact.tangential"
        return "casing.harmonics that travel" if self.casing.travelling else None

    @property
    def directions(self) -> str:
        """Interface directions that the reduced model must have: r, or r and t."""
        return "rt" if self.contact.along else "r"

    @checked
    def _settings_or_accuracy(self) -> None:
        values = {"integrator": self.integrator, "liner.rods_per_round": self.liner.rods_per_round}
        given = [key for key, value in values.items() if value is not None]
        chosen = given + ["liner.strips"] * (self.liner.strips is not None)
        if self.accuracy is not None and chosen:
            raise SettingsError(
                f"chooses integrator, liner.rods_per_round and liner.strips, but "
                f"{' and '.join(chosen)} is set: take out accuracy, or set these to null",
                key="accuracy",
            )
        if self.accuracy is None and (missing := sorted({*values} - {*given})):
            raise SettingsError(
                f"give {' and '.join(missing)}, or `accuracy: 0.01` for a relative error of 1 %",
                allowed=[*missing, "accuracy"],
            )

    @checked
    def _accuracy_is_of_something(self) -> None:
        if self.accuracy is not None and not self.record.observables:
            raise SettingsError(
                "is that of what is recorded: set record.wear or another", key="accuracy"
            )

    @checked
    def _explicit_scheme_has_no_reactions(self) -> None:
        explicit = self.integrator and self.integrator.scheme == "central-difference"
        if self.liner.rigid_key and explicit:
            raise SettingsError(
                "needs `integrator: {scheme: piecewise-exact, steps_per_round: ...}`: central "
                "differences cannot find the reaction of a rigid casing",
                key=f"liner.{self.liner.rigid_key.split(': ')[0]}",
                value=self.liner.rigid_key.split(": ")[1],
            )

    @checked
    def _a_sliding_tip_presses_on_rods(self) -> None:
        if self.contact.friction is None:
            return
        if self.integrator and self.integrator.scheme == "central-difference":
            raise SettingsError(
                "needs `integrator: {scheme: piecewise-exact, steps_per_round: ...}`: the "
                "stability limit of central differences is that without friction",
                key="contact.friction",
            )
        if self.liner.rigid_key or not self.liner.law.touches:
            key = self.liner.rigid_key or f"law.kind: {self.liner.law.kind}"
            raise SettingsError(
                f"does not go with liner.{key}: it needs rods that deform (against a rigid casing "
                "there may be several reactions, or none): take one of them out",
                key="contact.friction",
            )
        if self.accuracy is not None:
            raise SettingsError(
                "does not go with accuracy: its errors are not estimated: give integrator, "
                "liner.rods_per_round and liner.strips instead",
                key="contact.friction",
            )

    @checked
    def _second_runs_have_something_to_compare(self) -> None:
        for key in (key for key in ("twin", "halving") if getattr(self, key)):
            if not self.record.observables:
                raise SettingsError(
                    "compares what is recorded: set record.wear or another of record", key=key
                )

    @checked
    def _peaks_are_of_the_spectrum(self) -> None:
        if self.peaks and not self.record.spectrum_rounds:
            raise SettingsError(
                "are found in the spectrum: set record.spectrum_rounds", key="peaks"
            )
        samples = self.record.samples_per_round
        highest, allowed = max(self.peaks.orders) if self.peaks else 0, samples // 2 - BESIDE
        if highest > allowed:
            raise SettingsError(
                f"allowed up to {allowed}, half of record.samples_per_round = {samples} less "
                f"{BESIDE}, which the spectrum holds",
                key="peaks.orders",
                value=highest,
                allowed={"le": allowed},
            )

    @checked
    def _what_goes_on_is_marched_alone(self) -> None:
        keys = {"start": self.start, "speeds.in_turn": self.speeds.in_turn}
        others = {"accuracy": self.accuracy, "design": self.design, "peaks": self.peaks}
        wrong = {"accuracy", "design"} | ({"peaks"} if self.speeds.in_turn else set())
        for key in (key for key, asked in keys.items() if asked):
            if given := [name for name in others if others[name] is not None and name in wrong]:
                raise SettingsError(f"does not go with {given[0]}: take one of them out", key=key)

    @checked
    def _what_goes_on_at_another_speed_does_not_jump(self) -> None:
        other_speed = self.start and self.start.speed_over_f1 and not self.start.liner_only
        keys = {"speeds.in_turn": self.speeds.in_turn, "start.speed_over_f1": other_speed}
        gap = "`clearance: {at: rest}`: the gap would jump from one speed to the next under the tip"
        wave = (
            "casing.harmonics[].speed_rad_s: from speed to speed a harmonic that travels would jump"
        )
        jumps = {gap: self.clearance.at_rest, wave: self.casing.travelling}
        for key, why in product(keys, jumps):
            if keys[key] and jumps[why]:
                raise SettingsError(f"does not go with {why}: take one of them out", key=key)

    @checked
    def _samples_are_steps(self) -> None:
        samples = self.record.samples_per_round
        steps = self.integrator.steps_per_round if self.integrator else None
        if steps is not None and steps % samples:
            raise SettingsError(
                f"allowed multiples of record.samples_per_round = {samples}",
                key="integrator.steps_per_round",
                value=steps,
                allowed={"multiple_of": samples},
            )

    @checked
    def _halving_is_of_whole_runs(self) -> None:
        """The second run needs the same start, and with ``accuracy`` others bound the error."""
        keys = {
            "accuracy": self.accuracy,
            "start": self.start,
            "speeds.in_turn": self.speeds.in_turn,
        }
        if self.halving and (given := [key for key, asked in keys.items() if asked]):
            raise SettingsError(f"does not go with {given[0]}: take one of them out", key="halving")

    @checked
    def _last_rounds_exist(self) -> None:
        for key in ("spectrum_rounds", "states_rounds"):
            asked = getattr(self.record, key) or 0
            if asked > self.rounds:
                raise SettingsError(
                    f"allowed up to rounds = {self.rounds}",
                    key=f"record.{key}",
                    value=asked,
                    allowed={"le": self.rounds},
                )


def _values(given: Range | list[float]) -> NDArray[np.float64]:
    return given.values() if isinstance(given, Range) else np.array(given)


def fault_of_blade(scene: Scene, blade: AnyBlade) -> Fault | None:
    """What of the scene its blade alone does not allow, without any model; None if it allows all.

    Speeds over f1(0) are checked once the model is there.
    """
    highest, allowed = scene.speeds.highest_rad_s, blade.top_speed
    if highest is None or allowed is None or highest <= allowed * (1 + 1e-12):
        return None
    rpm = 2 * np.pi / 60
    slip = f"; {highest:g} rpm are {highest * rpm:.4g} rad/s" if highest * rpm <= allowed else ""
    return Fault(
        f"allowed up to {allowed:g}, the highest speed of blade {scene.blade}{slip}",
        "speeds.rad_s",
        highest,
        {"le": allowed},
    )
