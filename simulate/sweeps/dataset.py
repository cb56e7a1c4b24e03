"""Files ``sweep.nc``: the runs of one scene over its speeds, with their provenance."""

import json
from collections import Counter
from collections.abc import Collection, Hashable, Iterable, Mapping, Sequence, Set
from dataclasses import asdict, fields, replace
from datetime import UTC, datetime
from itertools import chain
from math import ceil
from pathlib import Path
from typing import Annotated, Any, cast

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from geometry.base import (
    Provenance,
    ProvenanceError,
    anew,
    check_settings,
    code_hash,
    known,
    parsed_json,
    require,
    require_format,
    version,
)
from geometry.stored import read, write
from geometry.tip import EDGES, JUDGED
from rom.model import Rom
from rom.polynomial import evaluate
from simulate.contact.gaps import given_gaps
from simulate.contact.places import SHARES, closing_rows
from simulate.errors.accuracy import Choice
from simulate.errors.neighbours import GAP_CHANGE
from simulate.errors.observables import last_spectrum
from simulate.errors.run import Run
from simulate.errors.schema import of_runs
from simulate.loads import torque_of_rounds
from simulate.marching import STATUSES, WITH_RESULT, EndOfStage, FinalState, strip_stiffness
from simulate.marching.friction import growth_rate, mu_crit
from simulate.marching.setup import sliding_modes, with_lean
from simulate.marching.states import every
from simulate.marching.trend import further
from simulate.scene import GROWING, LEADING, OF_LAST_ROUNDS, Scene
from simulate.scene.damping import flutters
from simulate.scene.laws.table import Tabulated
from simulate.scene.own_laws import of_result
from simulate.signals import amplitude, filled, lines, spectrum
from simulate.sweeps.result_types import Course

type Entry = tuple[str | tuple[str, ...], Any, dict[str, Any]]

FORMAT = 3
WINDOWS = 16  # in a revolution, of the range of u_r for pictures
SPEED, SPEED_DIGITS = "speed_over_f1", 12  # dimension of the runs of a sweep, digits of its values
ENERGIES = (
    "casing: work of the casing on the rods; work: of the contact forces on the blade; blade: "
    "kinetic and elastic energy at the end; damping: dissipated in the blade; elastic: energy of "
    "the rods under the tip at the end; plastic: dissipated in wear; released: elastic energy of "
    "rods that left the footprint; blade_before: blade at the start of a run that continues from "
    "another; elastic_before: elastic at that start; numerical: created (> 0) or lost (< 0) by the "
    "scheme = work + elastic - elastic_before + plastic + released - casing"
)
OF_CASING = (
    "; on_casing: of the contact forces on the motion of the casing; casing_kinetic, "
    "casing_elastic: its energy at the end; casing_damping: dissipated in it; casing_before: its "
    "energy at the start"
)
OF_FRICTION = (
    "; friction: of work and on_casing, that of the tangential forces; heat: of friction, from "
    "the shaft"
)
OF_FORCE = "; force: work of the engine orders on the blade"
OF_FLUTTER = "; fed: less in damping, what the modes of a damping below 0 were given"
BY_FRICTION = ("friction", "heat")  # energies of a run with friction alone
BY_CASING = (
    "on_casing",
    *(f"casing_{what}" for what in ("kinetic", "elastic", "damping", "before")),
)
VARIABLES = {  # of each run: dimensions beside the speed, unit, meaning
    "status": ("", "1", "how the run ended"),
    "reason": ("", "1", "why a run is without contact; empty otherwise"),
    "rounds": ("", "1", "revolutions computed"),
    "end_xi": ("", "1", "chord fraction where a run ended early; else nan"),
    "end_theta": ("", "rad", "casing angle where a run ended early; else nan"),
    "f1": ("", "1", "f1(Omega) over f1(0)"),
    "step": ("", "s", "time step h"),
    "step_limit": ("", "s", "stability limit with contact"),
    "steps_per_round": ("", "1", "steps per revolution"),
    "contact_share": ("", "1", "steps with contact over all steps"),
    "trend": ("", "1", "whether the motion is steady at the end of the run"),
    "time_constant": (
        "",
        "1",
        "revolutions in which the mode that responds dies out to 1/e; nan if a run ended early",
    ),
    "orbit": ("", "m", "radius of the orbit of the rotor"),
    "displacement": ("", *of_runs()["displacement"].said),
    "largest_round": ("", "1", "number of the revolution of the displacement"),
    "place": ("", "1", "chord fraction, 1/16 or 15/16, that moves more: of u_r and its numbers"),
    "u_t": ("edge", "m", "half the range of u_t at 1/16 and 15/16 in the last revolution"),
    "extremes": ("round bound", "m", "range of u_r at xi = 1/16 in a revolution"),
    "worn": ("round", "m3", "volume worn off the liner in a revolution"),
    "seconds": ("", "s", "wall time of the run and of its second runs"),
    "ledger": ("energy", "J", "energies of the whole run"),
    "mu_crit": ("", "1", "friction at which engaged strips lock, statics"),
    "growth_rate": (
        "",
        "s-1",
        "rate at which the motion grows with all strips engaged; < 0: it decays",
    ),
    "least_sliding": (
        "",
        "1",
        "least sliding speed of the tip in contact, over Omega r; inf without contact",
    ),
    "curve_share": ("", "1", "deepest plastic strain over that at the end of the law's curve"),
    "wear": ("strip theta", "m", "worn depth at rod angles 2 pi j / nu"),
    "spectrum": (
        "engine_order",
        "m",
        "amplitude of u_r, xi = 1/16, over the last {record.spectrum_rounds} revolutions",
    ),
    "largest": ("", "m", "largest u_r, xi = 1/16, in the revolutions of the spectrum"),
    "along": ("judged order", "m", "amplitude of u_r along engine orders, where it lasts"),
    "beside": ("judged", "m", "largest line on no integer order that lasts; 0 without one"),
    "beside_order": ("judged", "1", "f / Omega of that line; nan without one"),
    "free": ("", "1", "1 where the largest line at xi = 1/16 is a free vibration of the start"),
    "casing_motion": ("", *of_runs()["casing_motion"].said),
    "casing_spectrum": (
        "casing_mode engine_order",
        "m",
        "radial amplitude of a mode of the casing, anywhere around it, in the frame of the casing, "
        "over the revolutions of the spectrum",
    ),
    "wear_by_round": (
        "round share theta",
        "m",
        "worn depth after a revolution, mean over an eighth of the chord",
    ),
    "history": (
        "chord history_time",
        "m",
        "u_r at chord fractions {record.chord}, {record.samples_per_round} samples a revolution",
    ),
    "history_u": (
        "direction chord history_time",
        "m",
        "displacement along the radius, around in the sense of rotation, and along the axis",
    ),
    "history_force": (
        "chord history_time",
        "N",
        "t_N on the eighth of the chord around the place, mean since the sample before",
    ),
    "states": ("time dof", "m", "reduced displacements u"),
    "force_peak": ("round share", "N", "largest t_N on an eighth of the chord"),
    "force_mean": ("round share", "N", "mean t_N on an eighth of the chord"),
    "force_tangential_mean": ("round share", "N", "mean t_T, against the rotation"),
    "torque": ("round", "N m", "mean torque on the rotor in a revolution, against the rotation"),
    "motion": ("motion_time dof", "m", "reduced displacements u in the last revolution"),
    "strained": (
        "strained_place instant dof",
        "m",
        "the same at instants of the revolutions that strain the blade most, two by each of three "
        "measures: range of the strain energy, of mode 1, energy of the ranges of all modes",
    ),
    "strained_round": ("strained_place", "1", "their numbers; 0: it is another one"),
    "gauge_strain": ("gauge gauge_time", "1", "strain of the vibration along a gauge"),
    "gauge_stress": ("gauge gauge_time", "Pa", "stress of the vibration along a gauge"),
    "gauge_strain_static": ("gauge", "1", "strain of rotation along a gauge; total: their sum"),
    "gauge_stress_static": ("gauge", "Pa", "stress of rotation along a gauge; total: their sum"),
    "envelope": ("window bound", "m", f"range of u_r at xi = 1/16 in each 1/{WINDOWS} revolution"),
    "worst": ("", "1", "number of the worst blade, of which are the numbers that name no blade"),
    "blade_status": ("blade", "1", "how a blade came to its end"),
    "blade_rounds": ("blade", "1", "revolutions computed of a blade"),
    "blade_displacement": ("blade", "m", "largest |u_r| of a blade at xi = 1/16"),
    "blade_contact_share": ("blade", "1", "steps with contact of a blade over all steps"),
    "blade_trend": ("blade", "1", "whether the motion of a blade is steady at the end"),
    "blade_extremes": ("blade round bound", "m", "range of u_r of a blade at xi = 1/16"),
    "blade_ledger": (
        "blade energy",
        "J",
        "energies of a blade; those of the casing's own are in `ledger`, of all blades",
    ),
    "blade_along": (
        "blade order",
        "m",
        "amplitude of u_r of a blade at xi = 1/16 along engine orders (largest within 0.25 of "
        "each), over the revolutions of the spectrum",
    ),
    "departure": (
        "observable",
        "1",
        f"relative difference from the run with all gaps changed by {GAP_CHANGE:g}",
    ),
    "error": ("observable", "1", "relative error, estimated from {second_run}"),
}
COORDINATES = {  # dimensions, unit, meaning
    SPEED: (SPEED, "1", "rotational speed Omega over f1(0)"),
    "speed": (SPEED, "rad s-1", "rotational speed Omega"),
    "xi": ("strip", "1", "chord fraction of the strip"),
    "end": ("strip_end", "1", "chord fraction of the strips' ends"),
    "width": ("strip", "m", "axial width of the strip"),
    "gap": ("strip", "m", "initial gap g0"),
    "theta": ("theta", "rad", "angle of the rod"),
    "engine_order": ("engine_order", "1", "frequency over Omega"),
    "judged": ("judged", "1", "chord fraction at which responses are judged"),
    "order": ("order", "1", "engine order"),
    "casing_order": ("casing_mode", "1", "nodal diameters of a mode of the casing"),
    "casing_frequency": ("casing_mode", "Hz", "its natural frequency"),
    "chord": ("chord", "1", "chord fraction of the place"),
    "history_time": ("history_time", "1", "revolutions since the start"),
    "time": ("time", "1", "revolutions since {since}"),
    "edge": ("edge", "1", "chord fraction of the edge"),
    "direction": ("direction", "", "direction of a displacement"),
    "longer": ("blade", "m", "by how much a blade is longer, which its gaps lose"),
    "frequency": ("blade", "1", "relative change of the natural frequencies of a blade"),
    "blade": ("blade", "1", "number of the blade, in the sense of rotation"),
    "recorded": ("recorded", "1", "number of a blade whose records are kept"),
    "P": ("strip dof", "1", "u_r - s u_z = P states, s the slope of the casing"),
    "round": ("round", "1", "number of the revolution"),
    "share": ("share", "1", "middle of the eighth of the chord"),
    "motion_time": ("motion_time", "1", "revolutions since {since}"),
    "gauge": ("gauge", "", "grid of a strain gauge"),
    "gauge_time": ("gauge_time", "1", "revolutions since {since}"),
    "window": ("window", "1", "revolutions since the start, middle of a window"),
    "bound": ("bound", "1", "end of the range"),
    "energy": ("energy", "", ENERGIES + "{terms}{of_casing}{of_friction}{of_force}{of_flutter}"),
    "observable": ("observable", "", ""),
}
OVER_TIME = (  # records of each blade that a scene names
    *("history", "history_u", "history_force", "states", "motion", "strained"),
    *("force_peak", "force_mean", "force_tangential_mean", "gauge_strain", "gauge_stress"),
)
GAP_OF_SPEED = (SPEED, "strip"), "m", "gap at the speed"  # another at each
OF_MOTION = ("motion", "strained")  # what pictures and stresses are made of, most of a file
ALWAYS = ("status", "f1", "step", "contact_share", "ledger", SPEED, "speed", "xi", "width", "gap")
RECORDED = {  # by the key of the scene's record that asks for them
    "wear": ("wear",),
    "spectrum_rounds": ("spectrum", "largest"),
    "history": ("history",),
    "states_rounds": ("states", "P"),
    "gauges": tuple(
        f"gauge_{what}{part}" for what in ("strain", "stress") for part in ("", "_static")
    ),
}
END = "end_"  # of the variables that hold the end of a run
OF_FINAL_STATE = {  # dimensions of each field of ``FinalState`` that is an array
    "omega": ("end_mode",),
    "zeta": ("end_mode",),
    "steady": ("end_motion", "end_mode"),
    "Phi": ("end_dof", "end_mode"),
    "x": ("end_step", "end_padded"),
    "y": ("end_step", "end_padded"),
    "u": ("end_step", "end_row"),
    "moved": ("end_row",),
    "eps_p": ("strip", "theta"),
    "part": ("strip", "end_rod"),
    "stored": ("strip", "end_rod"),
    "under": ("end_strip_field", "strip"),
    "solver": ("end_solver_field", "strip"),
}
OF_STAGE = {  # and of ``EndOfStage``
    "casing_x": ("end_step", "end_column"),
    "casing_y": ("end_step", "end_column"),
    "pulled": ("blade", "end_column"),
}
DIMS = {  # of the variables that every sweep has, or records: numbers in every run with a result
    name: (SPEED, *VARIABLES[name][0].split())
    if name in VARIABLES
    else (*COORDINATES[name][0].split(),)
    for name in (*ALWAYS, *chain(*RECORDED.values()))
}


def attributes(scene: Scene, rom: Rom, choice: Choice | None) -> dict[str, str | float]:
    """Attributes of a sweep: format, scene, provenance of the model, code, accuracy, and the units.

    The units of figures: f1(0), and the gap and the tip's radius at xi = 1/16.
    """
    attrs = {
        "format": FORMAT,
        "scene": scene.model_dump_json(),
        "rom": rom.provenance.dump(),
        "code": code_hash("simulate.sweeps.over_speeds"),  # of the computation
        "gap_m": float(given_gaps(scene.gaps, rom, LEADING)),
        "f1_Hz": rom.f1,
        "tip_radius_m": float(rom.line(np.array([LEADING]))[0, 0]),
        "blade": rom.provenance.blade,
        "Conventions": "CF-1.11",
        "source": f"Tiprub {version()}",
    }
    return attrs | ({"accuracy": json.dumps(choice.plain())} if choice else {})


def merge(blocks: Sequence[xr.Dataset]) -> xr.Dataset:
    """One sweep of all ``blocks``, speeds ascending.

    Raises
    ------
    ProvenanceError
        When they differ in scene, reduced model or version of the code.
    """
    for name in ("scene", "rom", "code"):
        if len({block.attrs.get(name) for block in blocks}) > 1:
            raise ProvenanceError(
                f"blocks of a sweep differ in their {name}: delete them, and make the sweep anew"
            )
    return xr.concat(blocks, dim=SPEED, join="outer").sortby(SPEED)


def save(dataset: xr.Dataset, path: str | Path) -> None:
    """Write a compressed NetCDF file with its date; ``path`` appears only when it is complete.

    Raises
    ------
    geometry.base.errors.WriteError
        When it cannot be written.
    """
    # the width of texts is that of these runs, not of the block that the first ones were read from
    dated = dataset.drop_encoding().assign_attrs(
        date_created=datetime.now(UTC).isoformat(timespec="seconds")
    )
    packed = {
        name: {"zlib": True, "complevel": 1}
        for name, v in dataset.items()
        if v.ndim > 1 and "gauge_time" not in v.dims  # noise, which takes longer than the runs
    }
    write(dated, path, packed)


def load(path: str | Path, leave: Collection[str] = ()) -> xr.Dataset:
    """Read a sweep or a block into memory, but for variables to ``leave``.

    Raises
    ------
    ProvenanceError
        When the file is missing, damaged, no sweep, of another format, or without numbers in a run
        that has a result.
    """
    run_again = f"{anew(path)} where the workflow made it, else run its scene again"
    with read(path, "sweep", run_again) as runs:
        if "scene" not in runs.attrs:
            raise KeyError("no attribute scene")
        require_format(runs.attrs, FORMAT, path, run_again)
        _require_runs(runs := runs.drop_vars(leave, errors="ignore").load())
        return runs


Sweep = Annotated[xr.Dataset, load]  # an argument of a job, read by ``load`` from its path


def _require_runs(runs: xr.Dataset) -> None:
    """Check dimensions, speeds and statuses, and that runs with a result hold numbers.

    Raises
    ------
    KeyError
        When a variable is missing that all sweeps have, or that the scene records.
    ValueError
        When something is not as it is written.
    """
    scene = parsed_json(runs.attrs["scene"])
    dims, must = dict(DIMS), [SPEED, "status"]
    if "gap" in runs and SPEED in runs["gap"].dims:
        dims["gap"] = GAP_OF_SPEED[0]
    if "code" in runs.attrs:  # else made by hand, for its reader
        asked = (names for key, names in RECORDED.items() if scene["record"].get(key))
        must = [*ALWAYS, *chain(*asked)]
    held = {name: axes for name, axes in dims.items() if name in must or name in runs.variables}
    # nan after the end of runs that end where they are steady
    over_time = chain(*(RECORDED.get(key, ()) for key in OF_LAST_ROUNDS if scene.get("until")))
    require_numbers(runs, held, STATUSES, WITH_RESULT, {*held}.difference(over_time))


def require_numbers(
    table: xr.Dataset,
    dims: Mapping[str, tuple[Hashable, ...]],
    statuses: Iterable[Any],
    with_result: Iterable[Any],
    finite: Set[str],
) -> None:
    """Check that a table has the variables of ``dims``, with these dimensions, as numbers.

    All but `status`, which is one of ``statuses``. Those of ``finite`` are so in all runs whose
    status is one of those ``with_result``.

    Raises
    ------
    KeyError, ValueError
        If not; the message says which.
    """
    for name, dimensions in dims.items():
        if name not in table.variables:  # xarray makes up an index that is missing
            raise KeyError(f"no variable {name}")
        given = table[name]
        require(
            (given.dims == dimensions, f"{name}: dimensions {given.dims}, not {dimensions}"),
            (name == "status" or given.dtype.kind in "fi", f"{name}: no numbers"),
            kind=ValueError,
        )
    if "status" in dims:
        status = table["status"]
        where = {status.dims[0]: np.flatnonzero(status.isin([*with_result]))} if finite else {}
        require(
            (status.isin([*statuses]).all(), "status: none that a run can have"),
            *(
                (
                    np.isfinite(table[name].isel(where, missing_dims="ignore")).all(),
                    f"{name}: not finite in a run that has a result",
                )
                for name in finite & dims.keys() - {"status"}
            ),
            kind=ValueError,
        )


def origin(dataset: xr.Dataset) -> Provenance:
    """Provenance of the reduced model that a sweep was run on."""
    return Provenance.parse(dataset.attrs.get("rom"), "sweep.nc")


def require_rom(dataset: xr.Dataset, rom: Rom) -> None:
    """Refuse a sweep that was run on another reduced model than ``rom``.

    Raises
    ------
    ProvenanceError
        If it was; the message names both.
    """
    origin(dataset).require(rom.provenance, "sweep.nc")


def statuses(dataset: xr.Dataset) -> dict[str, int]:
    """Number of the runs of a sweep by status."""
    return dict(Counter(map(str, dataset["status"].values)))


def checks(dataset: xr.Dataset) -> str:
    """At how many speeds the error of a sweep is known, and the largest."""
    errors = dataset["error"].max("observable").dropna(SPEED) if "error" in dataset else []
    largest = f"; largest error {float(max(errors)):.2g}" if len(errors) else ""
    return f"checked at {len(errors)} of {dataset.sizes[SPEED]} speeds{largest}"


def scene_of(dataset: xr.Dataset) -> Scene:
    """The scene that a sweep was run from; its law is ``Unread`` where its code is not here.

    Raises
    ------
    ProvenanceError
        When this version knows no such scene.
    """
    try:
        values = parsed_json(dataset.attrs["scene"])
        values["liner"]["law"] = of_result(values["liner"]["law"])
        return check_settings(Scene, values, "sweep.nc")
    except (KeyError, TypeError, ValueError) as error:
        key = getattr(error, "key", "liner")
        raise ProvenanceError(
            f"its scene is none that this version knows ({key}); run the scene again",
            file="sweep.nc",
        ) from None


def entry(
    dims: tuple[str, ...],
    values: Any,
    units: str,
    meaning: str,
    flags: dict[str, Any] | None = None,
) -> Entry:
    """A variable or coordinate, as xarray takes it; without unit or meaning where it is empty.

    ``flags``: attributes that name the values of a variable of codes.
    """
    attrs = {"units": units, "long_name": meaning}
    return dims, values, {name: text for name, text in attrs.items() if text} | (flags or {})


def of_run(run: Run) -> xr.Dataset:
    """One run as a dataset with a speed axis of length one."""
    scene, values = run.scene, _of_march(run) | _energies(run) | _asked_for(run)
    checks = scene.bounds_the_step
    unknown = dict.fromkeys(scene.record.observables, np.nan) if checks else {}
    for name, by_name in {"departure": run.departures, "error": run.errors}.items():
        if by_observable := by_name or unknown:
            values |= {name: [*by_observable.values()], "observable": [*by_observable]}
    values |= _of_stage(run) if scene.stage else {}
    final = scene.record.end and run.outcome.final
    moves, slides = bool(scene.casing.moves), scene.contact.friction is not None
    said = {
        "record": scene.record,
        "terms": " + on_casing" * moves + " - friction" * slides,
        "of_casing": OF_CASING * moves,
        "of_friction": OF_FRICTION * slides,
        "of_force": OF_FORCE * bool(scene.force),
        "of_flutter": OF_FLUTTER * flutters(scene.damping_ratio),
        "since": "the end of the run" if scene.until else "the start",
        "second_run": "twice to an eighth of the step; nan where it is not checked"
        if checks
        else "a coarser companion run",
    }
    coords = {
        name: entry((*dims.split(),), values[name], units, meaning.format(**said))
        for name, (dims, units, meaning) in COORDINATES.items()
        if name in values
    }
    if scene.gaps.vary:
        coords["gap"] = entry(GAP_OF_SPEED[0], values["gap"][None], *GAP_OF_SPEED[1:])
    variables = {
        name: entry((SPEED, *dims.split()), np.array([values[name]]), units, meaning.format(**said))
        for name, (dims, units, meaning) in VARIABLES.items()
        if name in values
    }
    if listed := scene.record.listed(len(run.outcome.blades)):
        coords["recorded"] = entry(("recorded",), [*listed], *COORDINATES["recorded"][1:])
        variables |= _of_recorded(run, listed, said)
    return xr.Dataset(variables, coords).assign(of_final_state(final) if final else {})


def _of_stage(run: Run) -> dict[str, Any]:
    """Numbers of each blade of a stage."""
    outcome, scene, stage = run.outcome, run.scene, known(run.scene.stage, "stage")
    blades, energies = outcome.blades, _energies(run)["energy"]
    gap = float(given_gaps(scene.gaps, run.rom, LEADING))
    values = {
        "worst": outcome.worst,
        "blade": np.arange(stage.count),
        "longer": stage.longer(gap),
        "frequency": stage.relative,
        "blade_status": [blade.status for blade in blades],
        "blade_rounds": [blade.rounds for blade in blades],
        "blade_displacement": [blade.each.largest[0] for blade in blades],
        "blade_contact_share": [blade.contact_share for blade in blades],
        "blade_trend": [blade.trend for blade in blades],
        "blade_extremes": np.array(
            [filled(blade.each.extremes, scene.rounds) for blade in blades], np.float32
        ),
        "blade_ledger": [
            [getattr(blade.facts.ledger, name) for name in energies] for blade in blades
        ],
    }
    if rounds := scene.record.spectrum_rounds:
        orders = np.arange(1, scene.record.highest_order + 1)
        along = np.full((len(blades), len(orders)), np.nan, np.float32)
        if outcome.status in WITH_RESULT:
            samples = rounds * scene.record.samples_per_round
            spectra = np.array([spectrum(blade.u_r[-samples:, 0]) for blade in blades])
            along = np.array([amplitude(spectra, rounds, float(k)) for k in orders], np.float32).T
        values["blade_along"] = along
    return values


def _of_recorded(run: Run, listed: Sequence[int], said: dict[str, Any]) -> dict[str, Entry]:
    """Records over time of the blades ``listed``, in single precision."""
    each = [_asked_for(replace(run, outcome=run.outcome.blades[j])) for j in listed]
    return {
        f"blade_{name}": entry(
            (SPEED, "recorded", *VARIABLES[name][0].split()),
            np.array([[values[name] for values in each]], np.float32),
            VARIABLES[name][1],
            f"{VARIABLES[name][2]}, of a blade".format(**said),
        )
        for name in OVER_TIME
        if name in each[0]
    }


def of_final_state(final: FinalState | EndOfStage) -> xr.Dataset:
    """Variables of a sweep, of one speed, that hold the end of its run."""
    if isinstance(final, EndOfStage):
        each = [of_final_state(blade) for blade in final.blades]
        of_liner = {f"{END}eps_p": each[0][f"{END}eps_p"]}
        blades = [of.drop_vars([*of_liner, "end_rod"]) for of in each]
        of_casing = {
            f"{END}{name}": ((SPEED, *dims), getattr(final, name)[None])
            for name, dims in OF_STAGE.items()
            if getattr(final, name).size
        }
        return xr.concat(blades, dim="blade").transpose(SPEED, ...).assign(of_liner | of_casing)
    data = {
        f"{END}{name}": ((SPEED, *OF_FINAL_STATE.get(name, ())), np.asarray(value, float)[None])
        for name, value in vars(final).items()
    }
    # numbered, so that windows of different lengths may lie in one file
    return xr.Dataset(data | {"end_rod": ("end_rod", np.arange(final.part.shape[1]))})


def final_state_of(run: xr.Dataset) -> FinalState | EndOfStage:
    """End of one run of a sweep."""
    if "blade" in run[f"{END}x"].dims:
        blades = [final_state_of(run.isel(blade=j)) for j in range(run.sizes["blade"])]
        none = np.zeros((max(2, len(blades)), 0))  # of a casing that stands
        of_casing = {name: run.get(f"{END}{name}", xr.DataArray(none)).values for name in OF_STAGE}
        return EndOfStage(cast(list[FinalState], blades), **of_casing)
    values: dict[str, Any] = {
        field.name: run[f"{END}{field.name}"].values for field in fields(FinalState)
    }
    window = np.isfinite(values["part"]).all(axis=0)
    values |= {name: values[name][:, window] for name in ("part", "stored")} | {
        "Omega": float(values["Omega"]),
        "h": float(values["h"]),
        "rounds": int(values["rounds"]),
    }
    return FinalState(**values)


def course(run: xr.Dataset) -> Course:
    """How one run of a sweep went on to its end; empty for runs made by hand."""
    if "trend" not in run:
        return {}
    if np.isnan(run["time_constant"]):
        return {"trend": run["trend"].item()}
    worn = run["worn"].values[: int(run["rounds"])]
    more: Course = {"place": run["place"].item()} if "place" in run else {}
    scene = scene_of(run)
    # of a run that goes on from another it is not known when its casing still changed
    if not scene.speeds.in_turn and scene.start is None:
        more["rounds"] = run["rounds"].item()
        if run["trend"].item() == GROWING:
            swing = np.diff(run["extremes"].values[: len(worn)], axis=1)[:, 0]
            swing = swing[scene.casing.changes_until :]
            more |= {"grows": further(swing), "grows_in": len(swing)}
    return more | {
        "trend": run["trend"].item(),
        "time_constant": run["time_constant"].item(),
        "largest_round": run["largest_round"].item(),
        "wears": float(worn[-ceil(len(worn) / 4) :].mean()),
    }


def over_f1(Omega: NDArray[np.float64], rom: Rom) -> NDArray[np.float64]:
    """Speeds, rad/s, over f1(0), by which runs of any two sweeps are compared.

    Rounded, so that the same speed of another blade is the same number.
    """
    return np.round(Omega / rom.omega1, SPEED_DIGITS)


def _of_march(run: Run) -> dict[str, Any]:
    """Variables of every run: its set-up, how it ended, and numbers of its revolutions."""
    setup, outcome = run.setup, run.outcome
    speed, nu, rounds = np.array([setup.Omega]), len(setup.strips.d), run.scene.rounds
    largest, number = outcome.each.largest
    timed = {"u_t": outcome.u_t, "edge": [*EDGES]} if outcome.u_t.size else {}
    unbalance = run.scene.unbalance
    more = {"place": outcome.edge, **timed} if len(setup.edges) > 1 else {}
    more |= {"orbit": unbalance.orbit(setup.Omega, run.rom.f1)[0]} if unbalance else {}
    return more | {
        SPEED: over_f1(speed, run.rom),
        "speed": speed,
        "xi": setup.places.xi,
        "end": setup.places.ends,
        "width": setup.places.width,
        "gap": setup.strips.g0,
        "theta": 2 * np.pi * np.arange(nu) / nu,
        "status": outcome.status,
        "reason": outcome.reason,
        "rounds": outcome.rounds,
        "end_xi": outcome.xi,
        "end_theta": outcome.theta,
        "f1": setup.omega[0] / run.rom.omega1,
        "step": setup.h,
        "step_limit": setup.limit,
        "steps_per_round": setup.steps,
        "contact_share": outcome.contact_share,
        "seconds": run.seconds,
        "trend": outcome.trend,
        "time_constant": outcome.time_constant,
        "displacement": largest,
        "largest_round": number,
        "extremes": filled(outcome.each.extremes, rounds).astype(np.float32),
        "worn": filled(outcome.each.worn, rounds),
        "round": np.arange(1, rounds + 1),
        "bound": ["least", "largest"],
    }


def _energies(run: Run) -> dict[str, Any]:
    """The ledger, J; ``ENERGIES`` defines each."""
    ledger, unknown = run.outcome.ledger, () if run.scene.contact.friction else BY_FRICTION
    unknown += () if run.outcome.casing else BY_CASING
    unknown += () if run.scene.force else ("force",)
    unknown += () if flutters(run.scene.damping_ratio) else ("fed",)
    energies = asdict(ledger) | {"numerical": ledger.numerical}
    of_run = {name: value for name, value in energies.items() if name not in unknown}
    return {"energy": [*of_run], "ledger": [*of_run.values()]}


def _of_friction(run: Run) -> dict[str, Any]:
    """Stability of the blade in sliding contact on a rigid casing, and whether it slid."""
    scene, setup = run.scene, run.setup
    slid = {"least_sliding": run.outcome.facts.least_sliding}
    if scene.casing.moves:
        return slid
    modes = sliding_modes(setup.omega, setup.Phi_b, setup.Phi_t, setup.places)
    k, mu = strip_stiffness(scene.liner, setup.places), known(scene.contact.friction, "friction")
    rows, of_rows = with_lean(modes, k, setup.Phi_lean)
    return slid | {
        "mu_crit": mu_crit(modes, k),
        "growth_rate": growth_rate(rows, mu, setup.zeta, of_rows),
    }


def _asked_for(run: Run) -> dict[str, Any]:
    """Outputs that the scene asks for, and those of its friction and law, with coordinates."""
    scene, record = run.scene, run.scene.record
    outputs = (
        (record.wear, lambda run: {"wear": run.outcome.wear.astype(np.float32)}),
        (record.wear_by_round, _of_wear),
        (record.spectrum_rounds, of_spectrum),
        (scene.casing.moves, _of_casing),
        (record.history, _of_history),
        (record.states_rounds, _of_states),
        (record.contact_force, _of_forces),
        (record.motion, _of_motion),
        (record.gauges, _of_gauges),
        (scene.contact.friction, _of_friction),
        (isinstance(scene.liner.law, Tabulated), _of_curve),
    )
    return {
        name: values for wanted, make in outputs if wanted for name, values in make(run).items()
    }


def _of_curve(run: Run) -> dict[str, Any]:
    """How far rods went along the measured curve of the law."""
    liner = run.scene.liner
    deepest = liner.thickness_m * cast(Tabulated, liner.law).farthest
    return {"curve_share": run.outcome.wear.max() / deepest}


def _last(scene: Scene) -> int:
    """Revolution that ends the times of a record of the last ones: 0 where each run has its own."""
    return 0 if scene.until else scene.rounds


def _of_wear(run: Run) -> dict[str, Any]:
    """Worn depth of each eighth of the chord after each revolution; nan where not computed."""
    by_round = filled(run.outcome.wear_by_round, run.scene.rounds)
    return {"wear_by_round": by_round, "share": (np.arange(SHARES) + 0.5) / SHARES}


def _of_history(run: Run) -> dict[str, Any]:
    """Displacements at the places of the history."""
    record, samples = run.scene.record, run.scene.record.samples_per_round
    times = run.scene.rounds * samples
    values = {
        "history": filled(run.outcome.u_r, times)[:, 1:].T,
        "chord": record.chord,
        "history_time": np.arange(1, times + 1) / samples,
    }
    if record.directions:
        values["history_u"] = filled(run.outcome.moved, times).transpose(1, 2, 0)
        values["direction"] = [*record.directions]
    if run.outcome.pushed.size:
        values["history_force"] = filled(run.outcome.pushed, times).T
    return values


def _of_states(run: Run) -> dict[str, Any]:
    """States of the last revolutions, and their displacements over the strips."""
    rounds, samples = run.scene.record.rounds_of_states, run.scene.record.samples_per_round
    return {
        "states": filled(run.outcome.states, rounds * samples, at_end=True),
        "P": closing_rows(run.rom, run.scene.casing, run.setup.places.xi),
        "time": _last(run.scene) - rounds + np.arange(1, rounds * samples + 1) / samples,
    }


def of_spectrum(run: Run) -> dict[str, Any]:
    """Amplitudes and largest value of u_r over the spectrum's revolutions; nan without a result.

    And the lines that last, at the places where responses are judged.
    """
    record, outcome, scene = run.scene.record, run.outcome, run.scene
    rounds = record.rounds_of_spectrum
    samples, orders = rounds * record.samples_per_round, np.arange(1, record.highest_order + 1)
    values, largest = np.full(samples // 2 + 1, np.nan, np.float32), np.nan
    found = dict.fromkeys(("beside", "beside_order"), np.full(len(JUDGED), np.nan)) | {
        "along": np.full((len(JUDGED), len(orders)), np.nan),
        "free": 0,
    }
    if outcome.status in WITH_RESULT:
        values, largest = last_spectrum(run), outcome.u_r[-samples:, 0].max()
        driven = scene.casing.drives(orders, scene.forced)
        found = lines(outcome.judged, rounds, run.setup.damping_at, driven)
    return found | {
        "spectrum": values,
        "largest": largest,
        "engine_order": np.arange(len(values)) / rounds,
        "along": found["along"].astype(np.float32),
        "judged": [*JUDGED],
        "order": orders,
    }


def _of_casing(run: Run) -> dict[str, Any]:
    """Motion of a casing that moves, and its spectrum by mode; nan without a result."""
    motion, record = known(run.outcome.casing, "casing"), run.scene.record
    modes = run.scene.casing.moves
    values: dict[str, Any] = {
        "casing_motion": motion.largest,
        "casing_order": [mode.order for mode in modes],
        "casing_frequency": [mode.frequency_Hz for mode in modes],
    }
    if record.spectrum_rounds:
        bins = record.rounds_of_spectrum * record.samples_per_round // 2 + 1
        whole = run.outcome.status in WITH_RESULT
        spectra = motion.spectrum() if whole else np.full((len(modes), bins), np.nan)
        values["casing_spectrum"] = spectra.astype(np.float32)
    return values


def _of_forces(run: Run) -> dict[str, Any]:
    """Forces, and the torque where there is one, in each revolution; nan where not computed."""
    scene, outcome = run.scene, run.outcome
    values = {
        "force_peak": filled(outcome.force_peak, scene.rounds),
        "force_mean": filled(outcome.force_mean, scene.rounds),
        "share": (np.arange(SHARES) + 0.5) / SHARES,
    }
    if scene.contact.along:
        values["force_tangential_mean"] = filled(outcome.force_tangential_mean, scene.rounds)
    if not scene.no_torque:
        values["torque"] = torque_of_rounds(scene, run.rom, outcome)
    return values


def _of_gauges(run: Run) -> dict[str, Any]:
    """Strain and stress along gauges: of the vibration over time, and of rotation."""
    rounds, samples = run.scene.record.rounds_of_spectrum, run.scene.record.samples_per_round
    times = rounds * samples // (2 - samples % 2)
    read = filled(run.outcome.gauges, times, at_end=True)
    strain, stress = np.split(read.T.astype(np.float32), 2)
    static = evaluate(run.rom.gauge_rows, run.setup.Omega)[..., 0]
    return {
        "gauge": [*run.scene.record.grids],
        "gauge_time": _last(run.scene) - rounds + np.arange(1, times + 1) * rounds / times,
        "gauge_strain": strain,
        "gauge_stress": stress,
        "gauge_strain_static": static[0],
        "gauge_stress_static": static[1],
    }


def _of_motion(run: Run) -> dict[str, Any]:
    """States of the last revolution and of those that strain most; range of u_r over all."""
    scene, outcome, samples = run.scene, run.outcome, run.scene.record.samples_per_round
    mode = known(scene.record.motion, "motion")
    step = every(mode, samples, run.setup.omega, run.setup.Omega)
    edges = np.rint(np.arange(WINDOWS * scene.rounds) * samples / WINDOWS).astype(int)
    u_r = filled(outcome.u_r[:, 0], scene.rounds * samples)
    bounds = [bound.reduceat(u_r, edges) for bound in (np.minimum, np.maximum)]
    return {
        "motion": outcome.states[-samples:][step - 1 :: step].astype(np.float32),
        "motion_time": _last(scene) - 1 + np.arange(step, samples + 1, step) / samples,
        "strained": outcome.strained.astype(np.float32),
        "strained_round": outcome.strained_rounds,
        "envelope": np.stack(bounds, axis=-1).astype(np.float32),
        "window": (np.arange(len(edges)) + 0.5) / WINDOWS,
    }
