"""Settings of a scene file: everything that a run depends on; keys end in their unit."""

from collections.abc import Sequence
from itertools import product
from math import nan
from typing import Annotated, Any, ClassVar, Literal, Self

from pydantic import Field, model_validator

from geometry.base import (
    Fault,
    Settings,
    SettingsError,
    SettingsFile,
    checked,
    known,
    one_of,
    require,
)
from geometry.elsewhere import AnyBlade
from simulate.scene import damping
from simulate.scene.casing import MOST_ROUNDS, Casing, Clearance, Gaps
from simulate.scene.damping import AnyDamping
from simulate.scene.force import FORCE, Force
from simulate.scene.liner import Contact, Liner
from simulate.scene.record import Peaks, Record
from simulate.scene.speeds import Positive, Speeds
from simulate.scene.stage import Stage
from simulate.scene.unbalance import WORST, Unbalance
from simulate.scene.verify import EVERY, PEAKS, Share, Verify, in_place_of_old

StepsPerRound = Annotated[int, Field(ge=64, le=10**9)]
NO_SCALING = {"mass_scaling_hz": "take it out: `piecewise-exact` is stable for any step"}


class CentralDifference(Settings):
    """Central differences with prediction and correction, Eqs. (18)-(20)."""

    either: ClassVar = [("steps_per_round", "fraction_of_limit")]
    replaced: ClassVar = NO_SCALING

    scheme: Literal["central-difference"] = Field(description="the paper's, Eqs. (18)-(20)")
    steps_per_round: StepsPerRound | None = Field(default=None, description="Steps per revolution")
    fraction_of_limit: float | None = Field(
        default=None, gt=0, le=1, description="Step over the stability limit with contact"
    )


class PiecewiseExact(Settings):
    """Exact modes under a force constant over each step, that force implicit: always stable."""

    replaced: ClassVar = NO_SCALING

    scheme: Literal["piecewise-exact"] = Field(
        description="exact for a contact force constant over the step, stable for any step"
    )
    steps_per_round: StepsPerRound = Field(description="Steps per revolution")

    @model_validator(mode="before")
    @classmethod
    def _no_limit(cls, values: Any) -> Any:
        if isinstance(values, dict) and "fraction_of_limit" in values:
            raise SettingsError(
                "piecewise-exact has no stability limit; give steps_per_round instead",
                key="fraction_of_limit",
            )
        return values


Integrator = Annotated[
    PiecewiseExact | CentralDifference,
    one_of("integrator", "scheme", PiecewiseExact, CentralDifference),
]


class Start(Settings):
    """Start of each run from the end of a run of another scene, instead of rest and no wear."""

    scene: str = Field(
        pattern=r"^[a-z0-9][a-z0-9-]*$", description="Scene to continue from, with `record.end`"
    )
    speed_over_f1: Positive | None = Field(
        default=None, description="Its speed over f1(0); by default the speed of each run"
    )
    liner_only: bool = Field(default=False, description="Start at rest, over the worn liner")


AT_REST = (
    "gaps that change with the speed (`clearance: {at: rest}`, casing.line, a table of "
    "casing.axial_shift_um): they would jump from one speed to the next under the tip"
)
TRAVELLING = "casing.harmonics[].speed_rpm: from speed to speed a harmonic that travels would jump"
ORBIT = "unbalance, whose orbit would jump from one speed to the next under the tip"
OF_EACH_BLADE = (
    "stage, whose blades are each where they are on the orbit: give the angle of blade 0"
)
NOT_ESTIMATED = (
    "accuracy, whose errors are not estimated with it (give integrator, liner.rods_per_round and "
    "liner.strips instead)"
)
RODS_OF_START = "start: a run with half the step has other rods than the worn liner there"
GOES_ON = (
    "speeds.in_turn: a run with half the step has other rods than the run that it goes on from"
)
AT_PEAKS = (
    "verify: peaks, for which each row would be run twice (`every` checks all its speeds at once, "
    "`{share: 0.1}` those at risk)"
)
OF_LAST_ROUNDS = ("history", "states_rounds", "motion", "gauges")  # of the record, over time
EXCLUDED = [  # keys of which a scene has one at most, named by the first
    ("start", "accuracy"),
    ("start", "design"),
    ("speeds.in_turn", "accuracy"),
    ("speeds.in_turn", "design"),
    ("speeds.in_turn", "peaks"),  # a run goes on from the one before, not from one added between
    *product(("speeds.in_turn", "start.speed_over_f1"), (AT_REST, TRAVELLING, ORBIT)),
    ("unbalance.beta_deg: worst", OF_EACH_BLADE),
    ("contact.friction", NOT_ESTIMATED),
    ("until", "accuracy"),
    ("verify", RODS_OF_START),
    ("verify", GOES_ON),
    ("design", AT_PEAKS),
]


class Scene(SettingsFile):
    """One scene: blade, speeds, casing, liner and contact, integrator, and outputs.

    >>> scene = Scene.load("scene.yaml")
    >>> scene.rounds, scene.liner.law.E, scene.liner.law.K
    (20, 1.0, 0.45)
    """

    hints: ClassVar = damping.HINTS

    blade: str = Field(pattern=r"^[a-z0-9][a-z0-9-]*$", description="Name of the blade file")
    speeds: Speeds = Field(description="Rotational speeds")
    rounds: int = Field(ge=1, le=MOST_ROUNDS, description="Revolutions of the blade at each speed")
    until: Literal["steady"] | None = Field(
        default=None, description="Stop before `rounds` where the motion is steady"
    )
    integrator: Integrator | None = Field(
        default=None, description="Scheme and time step; required without accuracy"
    )
    accuracy: float | None = Field(
        default=None,
        ge=0.005,  # below, the error of wear is no longer of second order in the width of rods
        le=0.1,  # above, a step would pass more than the footprint
        description="Relative error allowed in the recorded outputs; replaces integrator, "
        "liner.rods_per_round and liner.strips, which are then chosen; costs 3 to 4 times the best "
        "fixed setting",
    )
    damping_ratio: AnyDamping = Field(
        description="xi of every mode of K(Omega); or of the first families of modes and the "
        "rest, or a table over the frequency. Below 0, from -0.1 on: flutter"
    )
    clearance: Clearance | None = Field(
        default=None,
        description="Gaps in operation, before the casing distorts; required without `casing.line`",
    )
    casing: Casing = Field(description="Casing distortion")
    liner: Liner = Field(description="Abradable liner")
    contact: Contact = Field(default=Contact(), description="Tip profile and tangential force")
    stage: Stage | None = Field(
        default=None, description="Several blades over the liner; by default one"
    )
    force: Force | None = Field(
        default=None, description="Engine orders that excite the blade beside the rub"
    )
    unbalance: Unbalance | None = Field(
        default=None, description="Orbit of an unbalanced rotor, which brings the blade nearer"
    )
    record: Record = Field(default=Record(), description="Outputs")
    peaks: Peaks | None = Field(default=None, description="Peaks around which speeds are added")
    start: Start | None = Field(
        default=None, description="Start from the end of another scene; by default at rest"
    )
    verify: Verify = Field(
        default=Share(),
        description="Second runs, which tell what a run is worth: at risky speeds, at the `peaks` "
        "alone, or at `every` speed",
    )
    design: str | None = Field(
        default=None,
        min_length=1,
        description="Many runs: a CSV file beside the scene file, with keys as columns and a scene "
        "with other values in each row; or a YAML file, a Sobol design",
    )

    @model_validator(mode="before")
    @classmethod
    def _one_key_for_second_runs(cls, values: Any) -> Any:
        return in_place_of_old(values) if isinstance(values, dict) else values

    def but(self, **changes: Any) -> Self:
        """The scene with other values, checked again; a mapping changes the keys it names.

        ``casing`` may be a function d(theta), rad to m, inward. See ``Settings.but``.

        >>> stiffer = scene.but(liner={"law": {"E": 10.0}}, damping_ratio=0.01)
        >>> stiffer.liner.law.E, stiffer.liner.law.K, stiffer.damping_ratio
        (10.0, 0.45, 0.01)
        >>> import numpy as np
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
    def stepping(self) -> Integrator:
        """Scheme and step, given or chosen by ``accuracy``."""
        return known(self.integrator, "integrator")

    @property
    def allowed_error(self) -> float:
        """Relative error allowed, of a scene whose settings it chooses."""
        return known(self.accuracy, "accuracy")

    @property
    def no_torque(self) -> str | None:
        """Keys for which the model has no torque (``loads``); None where it has one."""
        if self.contact.profile is not None and not self.contact.tangential:
            return "contact.profile without contact.tangential"
        return "casing.harmonics that travel" if self.casing.travelling else None

    @property
    def checked_share(self) -> float:
        """Share of the steps for checks; 0 with others, and where these need the same start."""
        share = self.verify.share if isinstance(self.verify, Share) else 0.0
        others = self.accuracy or self.start or self.speeds.in_turn
        return share if self.record.observables and not others else 0.0

    @property
    def twins(self) -> bool:
        """Whether each speed has a twin, which tells whether its motion can be predicted."""
        return self.verify.predictable if isinstance(self.verify, Share) else self.verify == EVERY

    @property
    def halves(self) -> bool:
        """Whether half the step bounds its error at each speed; ``accuracy`` does so itself."""
        return self.verify == EVERY and self.accuracy is None

    @property
    def bounds_the_step(self) -> bool:
        """Whether second runs with other steps bound the error of the step of some runs."""
        at_peaks = self.verify == PEAKS and self.accuracy is None
        return self.checked_share > 0 or self.halves or at_peaks

    @property
    def directions(self) -> str:
        """Interface directions that the reduced model must have: r, r and t, or all.

        A model of a blade whose tip tapers has axial ones as well.
        """
        own, asked = self.casing.slope or self.casing.line, self.record.directions
        return "rtz" if own else asked or ("rt" if self.contact.along else "r")

    @property
    def gaps(self) -> Gaps:
        """What the gaps depend on."""
        return Gaps(self.clearance, self.casing)

    @property
    def forced(self) -> Sequence[int]:
        """Engine orders that excite the blade beside the rub."""
        return self.force.numbers if self.force else ()

    @property
    def excites(self) -> dict[int, str]:
        """What excites each engine order: a force, a harmonic, or else a side band of one."""
        return self.casing.excites | dict.fromkeys(self.forced, FORCE)

    @property
    def assumes(self) -> list[str]:
        """What its keys leave out that an engine has, in sentences."""
        told = []
        if self.stage and damping.flutters(self.damping_ratio):
            told.append(
                f"Damping below 0: each of the {self.stage.count} blades flutters alone; in a "
                "rotor each nodal diameter has a damping of its own"
            )
        if self.unbalance:
            told.append("The orbit of the rotor is prescribed: contact does not act on it")
            told += [
                "At each speed the blade is where the orbit brings it nearest: the results are an "
                "envelope over the speeds, and no blade's"
            ] * (self.unbalance.beta_deg == WORST)
        return told

    @checked
    def _settings_or_accuracy(self) -> None:
        values = {
            "integrator": self.integrator,
            "liner.rods_per_round": self.liner.rods_per_round,
            "liner.strips": self.liner.strips,
        }
        given = [key for key, value in values.items() if value is not None]
        missing = [key for key in ("integrator", "liner.rods_per_round") if key not in given]
        require(
            (
                self.accuracy is None or not given,
                Fault(
                    f"chooses integrator, liner.rods_per_round and liner.strips, but "
                    f"{' and '.join(given)} is set: take out accuracy, or set these to null",
                    "accuracy",
                ),
            ),
            (
                self.accuracy is not None or not missing,
                Fault(
                    f"give {' and '.join(missing)}, or `accuracy: 0.01` for a relative error of "
                    "1 %",
                    allowed=[*missing, "accuracy"],
                ),
            ),
            kind=SettingsError,
        )

    @checked
    def _scheme_and_friction_press_on_rods_that_they_know(self) -> None:
        liner, friction = self.liner, self.contact.friction is not None
        exact = self.integrator is None or self.integrator.scheme != "central-difference"
        stiff = liner.rigid_key or f"law.kind: {liner.law.called}"
        needs = "needs `integrator: {scheme: piecewise-exact, steps_per_round: ...}`: "
        key, _, value = stiff.partition(": ")
        moves = f"casing.{'ring' if self.casing.ring else 'modes'}" if self.casing.moves else ""
        require(
            (
                exact or not moves,
                Fault(
                    f"{needs}central differences keep steps in which the casing stands elsewhere",
                    moves,
                ),
            ),
            (
                not (moves and liner.rigid_key),
                Fault(
                    f"does not go with liner.{stiff}: a rigid casing is met at the end of a step, "
                    "one that moves in its middle: take one of them out",
                    moves,
                ),
            ),
            (
                exact or not liner.rigid_key,
                Fault(
                    f"{needs}central differences cannot find the reaction of a rigid casing",
                    f"liner.{key}",
                    value,
                ),
            ),
            (
                exact or not damping.flutters(self.damping_ratio),
                Fault(
                    f"{needs}central differences do not tell what damping below 0 gives the blade",
                    "damping_ratio",
                    min(damping.given(self.damping_ratio)),
                ),
            ),
            (
                exact or not self.force,
                Fault(f"{needs}central differences march no forced response", "force"),
            ),
            (
                exact or not friction,
                Fault(
                    f"{needs}the stability limit of central differences is that without friction",
                    "contact.friction",
                ),
            ),
            (
                not friction or (liner.law.touches and not liner.rigid_key),
                Fault(
                    f"does not go with liner.{stiff}: it needs rods that deform (against a rigid "
                    "casing there may be several reactions, or none): take one of them out",
                    "contact.friction",
                ),
            ),
            kind=SettingsError,
        )

    @checked
    def _what_is_asked_is_recorded(self) -> None:
        said = "applies to recorded outputs: set record.wear or another of record"
        samples = self.record.samples_per_round
        highest = max((self.peaks and self.peaks.orders) or [0])
        allowed = self.record.highest_order
        require(
            *(
                (self.record.observables or not asked, Fault(said, key))
                for key, asked in (
                    ("accuracy", self.accuracy),
                    ("verify", self.twins or self.verify == PEAKS),
                )
            ),
            (
                self.record.spectrum_rounds or not self.peaks,
                Fault("are found in the spectrum: set record.spectrum_rounds", "peaks"),
            ),
            (
                highest <= allowed,
                Fault(
                    f"allowed up to {allowed}, less than half of record.samples_per_round = "
                    f"{samples}, which the spectrum holds",
                    "peaks.orders",
                    highest,
                    {"le": allowed},
                ),
            ),
            kind=SettingsError,
        )

    @checked
    def _keys_go_together(self) -> None:
        found, start = "none" if self.clearance is None else "both", self.start
        asked = {
            "start": start,
            "start.speed_over_f1": start and start.speed_over_f1 and not start.liner_only,
            "speeds.in_turn": self.speeds.in_turn,
            "contact.friction": self.contact.friction,
            "until": self.until,
            "accuracy": self.accuracy,
            NOT_ESTIMATED: self.accuracy,
            "verify": not isinstance(self.verify, Share),
            RODS_OF_START: start,
            GOES_ON: self.speeds.in_turn,
            AT_PEAKS: self.verify == PEAKS,
            "design": self.design,
            "peaks": self.peaks,
            AT_REST: self.gaps.vary,
            TRAVELLING: self.casing.travelling,
            ORBIT: self.unbalance,
            "unbalance.beta_deg: worst": self.unbalance and self.unbalance.beta_deg == WORST,
            OF_EACH_BLADE: self.stage,
        }
        require(
            (
                (self.clearance is None) != (self.casing.line is None),
                Fault(
                    f"give exactly one of clearance, casing.line; found {found} (`clearance: null` "
                    "takes out that of the base)",
                    "clearance",
                ),
            ),
            *(
                (
                    not (asked[key] and asked[other]),
                    Fault(f"does not go with {other}: take one of them out", key),
                )
                for key, other in EXCLUDED
            ),
            kind=SettingsError,
        )

    @checked
    def _record_fits_steps_rounds_and_blades(self) -> None:
        samples = self.record.samples_per_round
        steps = self.integrator.steps_per_round if self.integrator else None
        blades, count = self.record.blades, self.stage.count if self.stage else 1
        last = max(self.record.listed(count), default=0)
        rounds = {
            key: getattr(self.record, key) or 0 for key in ("spectrum_rounds", "states_rounds")
        }
        require(
            (
                steps is None or steps % samples == 0,
                Fault(
                    f"allowed multiples of record.samples_per_round = {samples}",
                    "integrator.steps_per_round",
                    steps,
                    {"multiple_of": samples},
                ),
            ),
            *(
                (
                    asked <= self.rounds,
                    Fault(
                        f"allowed up to rounds = {self.rounds}",
                        f"record.{key}",
                        asked,
                        {"le": self.rounds},
                    ),
                )
                for key, asked in rounds.items()
            ),
            (
                self.stage or blades == "worst",
                Fault("names blades of a stage: give stage, or take it out", "record.blades"),
            ),
            (
                last < count,
                Fault(
                    f"names blade {last} of {count}, which are numbered from 0",
                    "record.blades",
                    blades,
                    {"le": count - 1},
                ),
            ),
            kind=SettingsError,
        )


def fault_of_blade(scene: Scene, blade: AnyBlade) -> Fault | None:
    """Setting that the blade alone does not allow, without any model; None if it allows all.

    Speeds over f1(0) are checked once the model is there.
    """
    speeds, top = scene.speeds, blade.top_speed
    highest, unit = float(speeds.given.max()), speeds.in_rad_s(f1=nan)
    if speeds.over_f1 is not None or top is None or highest * unit <= top * (1 + 1e-12):
        return None
    return Fault(
        f"allowed up to {top / unit:.6g}, the highest speed of blade {scene.blade}",
        f"speeds.{speeds.unit}",
        highest,
        {"le": top / unit},
    )
