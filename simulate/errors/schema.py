"""The numbers of a run: what each is, how it is computed, and in which outputs it stands.

One entry brings a number to the results of peaks, with its ±, and to the tables, CSV file and
legend of the summary. Light: Snakemake imports the summary, which has them.
"""

from collections.abc import Callable
from dataclasses import dataclass
from math import nan
from typing import TYPE_CHECKING

import numpy as np

from simulate.loads import mean_force, mean_opening, torque_of_rounds, worn_per_pass, worn_volume
from simulate.scene import LEADING
from simulate.signals import lobe_count

if TYPE_CHECKING:  # it imports the compiler
    from simulate.errors.observables import Readings

# Where a number of a peak is: of every run, of one with contact, or of its stress
MOTION, CONTACT, STRESS = "motion", "contact", "stress"


@dataclass(frozen=True, kw_only=True)
class Quantity:
    """A number of a run, or of a peak of a sweep."""

    name: str
    unit: str  # of its values, SI
    meaning: str  # of variables of files
    # its value, nan where a run has none; without a function it is of a peak, and made elsewhere
    of: Callable[["Readings"], float] | None = None
    record: str = ""  # key of the scene's record without which it is not known
    design: type | None = None  # its type in the rows of a design, if it stands there
    peak: str = ""  # MOTION, CONTACT or STRESS where it is a number of each peak
    at_peak: str = ""  # its name there, if it is another one
    exact: bool = False  # whether second runs leave it as it is: it has no ±
    follows: bool = False  # whether it follows from another one, which has a part in verdicts
    by_blade: bool = False  # whether it is told of each blade of a stage, too
    # In the summary:
    head: str = ""  # of its column, with the unit; without it there is none
    shown: tuple[str, float] = "1", 1.0  # its unit in CSV files, and the scale of that from SI
    loads: bool = False  # whether the column is in the second table
    goes_on: bool = False  # whether it changes further in a run that is not steady
    legend: tuple[str, str] | None = None  # the word to explain, and what it means

    @property
    def told(self) -> str:
        """Its name among the numbers of a peak."""
        return self.at_peak or self.name

    @property
    def said(self) -> tuple[str, str]:
        """Unit and meaning, of a variable of a file."""
        lacks = f"; nan without record.{self.record}" if self.record else ""
        return self.unit, self.meaning + lacks


UM, MM3, MPA, NEWTON = ("um", 1e6), ("mm3", 1e9), ("MPa", 1e-6), ("N", 1.0)
QUANTITIES = (  # in the order of the columns
    Quantity(
        name="amplitude",
        unit="m",
        meaning="amplitude of u_r at xi = 1/16: along an engine order, or largest",
        of=lambda run: run.amplitude,
        record="spectrum_rounds",
        peak=MOTION,
        by_blade=True,
        head="amplitude µm",
        shown=UM,
        goes_on=True,
        legend=(
            "amplitude",
            "of the tip's radial displacement at ξ = 1/16, along the engine order EO, or of a line "
            "on none along f/Ω, over the last revolutions of the run; at another place where it is "
            "near a node there",
        ),
    ),
    Quantity(
        name="displacement",
        unit="m",
        meaning="largest |u_r| at xi = 1/16 of all revolutions",
        of=lambda run: run.outcome.each.largest[0],
        design=np.float32,
        peak=MOTION,
        by_blade=True,
        head="largest µm",
        shown=UM,
        legend=(
            "largest",
            "largest |u_r| there in the whole run, and the revolution of it; last: the same in "
            "the last revolution",
        ),
    ),
    Quantity(
        name="displacement_last",
        unit="m",
        meaning="largest |u_r| at xi = 1/16 in the last revolution",
        of=lambda run: run.outcome.each.last,
        peak=MOTION,
        head="last µm",
        shown=UM,
        goes_on=True,
    ),
    Quantity(
        name="u_t_leading",
        unit="m",
        meaning="half the range of u_t at xi = 1/16 in the last revolution",
        of=lambda run: [*run.outcome.u_t, nan][0],
        peak=MOTION,
        head="u_t at 1/16 µm",
        shown=UM,
        goes_on=True,
        legend=(
            "u_t",
            "half the range of the tangential displacement in the last revolution, at both edges: "
            "what blade tip timing measures",
        ),
    ),
    Quantity(
        name="u_t_trailing",
        unit="m",
        meaning="half the range of u_t at xi = 15/16 in the last revolution",
        of=lambda run: [*run.outcome.u_t, nan, nan][1],
        peak=MOTION,
        head="at 15/16 µm",
        shown=UM,
        goes_on=True,
    ),
    Quantity(
        name="second_order",
        unit="1",
        meaning="change of the tip's radius of second order, over the gap",
        head="second order / gap",
        legend=(
            "second order",
            "change of the tip's radius with the square of the largest displacement (a blade that "
            "bends shortens), the larger of both edges, over the gap; contact does not know it",
        ),
    ),
    Quantity(
        name="wear",
        unit="m",
        meaning="deepest wear of the leading eighth of the chord (its mean)",
        of=lambda run: float(run.profile.max()),
        design=np.float32,
        peak=CONTACT,
        head="wear µm",
        shown=UM,
        goes_on=True,
        legend=("wear", "deepest, mean over the leading eighth of the chord"),
    ),
    Quantity(
        name="wear_mean",
        unit="m",
        meaning="wear there, mean around the casing",
        of=lambda run: float(run.profile.mean()),
        design=np.float32,
    ),
    Quantity(
        name="wear_anywhere",
        unit="m",
        meaning="deepest wear of all rods",
        of=lambda run: float(run.wear.max()),
        design=np.float32,
    ),
    Quantity(
        name="lobes",
        unit="1",
        meaning="worn lobes of the leading eighth",
        of=lambda run: lobe_count(run.profile),
        design=np.int16,
    ),
    Quantity(
        name="worn_volume",
        unit="m3",
        meaning="volume worn off the liner",
        of=lambda run: float(worn_volume(run.wear, *run.strips)),
        peak=CONTACT,
        head="worn mm³",
        shown=MM3,
        goes_on=True,
    ),
    Quantity(
        name="opening",
        unit="m",
        meaning="mean worn depth, over the area that the tip sweeps",
        of=lambda run: float(mean_opening(run.wear, *run.strips)),
        peak=CONTACT,
        head="mean worn depth µm",
        shown=UM,
        loads=True,
        goes_on=True,
        legend=("mean worn depth", "worn volume over the area that the tip sweeps"),
    ),
    Quantity(
        name="worn_per_pass",
        unit="m",
        meaning="mean worn depth over the area that the tip sweeps, per passage of a blade",
        of=lambda run: worn_per_pass(
            run.outcome.wear_share * run.outcome.each.worn,
            *run.strips,
            len(run.outcome.each_blade),
        ),
        peak=CONTACT,
        follows=True,
        by_blade=True,
        head="worn µm per pass",
        shown=("um per pass", 1e6),
        loads=True,
        goes_on=True,
        legend=(
            "worn per pass",
            "incursion rate as rub rigs give it: depth worn off the area that the tip sweeps, over "
            "the passages of the tip (one blade: revolutions) of the whole run; what still wears "
            "in the last quarter is under mm³/rev.",
        ),
    ),
    Quantity(
        name="force_mean",
        unit="N",
        meaning="t_N on the chord, mean over the revolutions",
        of=lambda run: float(mean_force(run.outcome.force_mean)),
        record="contact_force",
        design=np.float32,
        peak=CONTACT,
        at_peak="force",
        by_blade=True,
        head="mean force N, whole chord",
        shown=NEWTON,
        loads=True,
        legend=(
            "mean force",
            "normal force on the whole chord, mean of the revolutions; peak force: the largest on "
            "an eighth of it",
        ),
    ),
    Quantity(
        name="force_peak",
        unit="N",
        meaning="largest t_N on an eighth of the chord",
        of=lambda run: float(np.nanmax(run.outcome.force_peak)),
        record="contact_force",
        design=np.float32,
        peak=CONTACT,
        by_blade=True,
        head="peak force N, an eighth of it",
        shown=NEWTON,
        loads=True,
    ),
    Quantity(
        name="force_tangential_mean",
        unit="N",
        meaning="t_T on the chord, mean over the revolutions",
        of=lambda run: float(mean_force(run.outcome.force_tangential_mean)),
        record="contact_force",
        design=np.float32,
    ),
    Quantity(
        name="torque",
        unit="N m",
        meaning="torque on the rotor, mean over the revolutions",
        of=lambda run: (
            nan
            if run.scene.no_torque is not None
            else float(np.nanmean(torque_of_rounds(run.scene, run.rom, run.outcome)))
        ),
        record="contact_force",
        peak=CONTACT,
        head="torque N m",
        shown=("N m", 1.0),
        loads=True,
        legend=("torque", "mean of the revolutions, against the rotation"),
    ),
    Quantity(
        name="casing_motion",
        unit="m",
        meaning="largest radial motion of the casing, anywhere around it",
        of=lambda run: run.outcome.casing.largest if run.outcome.casing else nan,
        peak=MOTION,
        head="casing µm",
        shown=UM,
        loads=True,
        legend=(
            "casing",
            "largest radial motion of a casing that moves, anywhere around it, in the whole run",
        ),
    ),
    Quantity(
        name="tip_speed",
        unit="m s-1",
        meaning="Omega times the radius of the tip at xi = 1/16",
        of=lambda run: float(run.setup.Omega * run.rom.line(np.array([LEADING]))[0, 0]),
        peak=MOTION,
        exact=True,
        head="tip m/s",
        shown=("m/s", 1.0),
        loads=True,
        legend=(
            "tip m/s",
            "speed of the tip, Ω times its radius at ξ = 1/16; it is known as well as the rpm",
        ),
    ),
    Quantity(
        name="mean_stress",
        unit="Pa",
        meaning="mean stress at the worst node",
        peak=STRESS,
        head="mean stress MPa",
        shown=MPA,
        loads=True,
        legend=(
            "mean stress, alternating",
            "of the largest change of stress between two instants of a revolution, the worst of "
            "the last one and of those that strain the blade most, at the node away from clamp and "
            "contact with the least margin (without `fatigue` of the blade with the largest "
            "alternating stress); of a growing motion the alternating stress is more (>)",
        ),
    ),
    Quantity(
        name="alternating",
        unit="Pa",
        meaning="alternating stress at the worst node",
        peak=STRESS,
        head="alternating MPa",
        shown=MPA,
        loads=True,
    ),
    Quantity(
        name="margin",
        unit="1",
        meaning="factor of the alternating stress to the endurance at 1e7 cycles",
        peak=STRESS,
        head="margin",
        loads=True,
        legend=(
            "margin",
            "factor by which the alternating stress may grow at that mean stress, to the endurance "
            "at 1e7 cycles (strength: `fatigue` of the blade)",
        ),
    ),
    Quantity(
        name="damage",
        unit="1",
        meaning="Miner's damage of the run",
        peak=STRESS,
        head="Miner's damage",
        loads=True,
        legend=(
            "Miner's damage",
            "of the run, by rainflow and one slope of the S-N line (`fatigue.slope_k`)",
        ),
    ),
    Quantity(
        name="cycles",
        unit="1",
        meaning="cycles of the run",
        exact=True,
        head="cycles",
        loads=True,
        legend=("cycles", "of the run; s to 1e7: time to so many at that speed"),
    ),
    Quantity(
        name="endurance_s",
        unit="s",
        meaning="time to 1e7 cycles at that speed",
        exact=True,
        head="s to 1e7",
        shown=("s", 1.0),
        loads=True,
    ),
)


def of_runs() -> dict[str, Quantity]:
    """All by their name among the numbers of a run."""
    return {one.name: one for one in QUANTITIES}


def of_peaks() -> dict[str, Quantity]:
    """All by their name among the numbers of a peak."""
    return {one.told: one for one in QUANTITIES}
