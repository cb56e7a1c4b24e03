"""Files ``sweep.nc``: the runs of one scene over its speeds, with their provenance."""

import json
from collections.abc import Sequence
from dataclasses import asdict
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray
from pydantic import ValidationError

from geometry.project import (
    Provenance,
    ProvenanceError,
    anew,
    code_hash,
    require_format,
    version,
)
from rom.model import Rom
from rom.stored import read, write
from simulate.contact.places import SHARES
from simulate.errors.accuracy import Choice
from simulate.errors.loads import torque_of_rounds
from simulate.errors.neighbours import GAP_CHANGE
from simulate.errors.observables import last_spectrum
from simulate.marching.friction import growth_rate, mu_crit
from simulate.marching.run import Outcome
from simulate.marching.setup import Setup, strip_stiffness
from simulate.marching.states import every
from simulate.marching.status import STATUSES, WITH_RESULT
from simulate.scene import LEADING, Record, Scene
from simulate.scene.laws.table import Table
from simulate.sweeps import before

type Entry = tuple[str | tuple[str, ...], Any, dict[str, str]]

FORMAT = 2
WINDOWS = 16  # in a round, of the range of u_r for pictures
SPEED, SPEED_DIGITS = "speed_over_f1", 12  # dimension of the runs of a sweep, digits of its values
OF_ALL = {  # variables of every sweep, which are numbers in every run with a result
    **{name: (SPEED,) for name in (SPEED, "speed", "status", "f1", "step", "contact_share")},
    **{name: ("strip",) for name in ("xi", "width", "gap")},
    "ledger": (SPEED, "energy"),
}
DIMS = OF_ALL | {  # and of those that record it
    "wear": (SPEED, "strip", "theta"),
    "spectrum": (SPEED, "engine_order"),
    "largest": (SPEED,),
    "history": (SPEED, "chord", "history_time"),
    "states": (SPEED, "time", "dof"),
    "P": ("strip", "dof"),
}
RECORDED = {  # by the key of the scene's record that asks for them
    "wear": ("wear",),
    "spectrum_rounds": ("spectrum", "largest"),
    "history": ("history",),
    "states_rounds": ("states", "P"),
}
ENERGIES = (
    "casing: work of the casing on the rods; work: of the contact forces on the blade; blade: "
    "kinetic and elastic energy at the end; damping: dissipated in the blade; elastic: energy of "
    "the rods under the tip at the end; plastic: dissipated in wear; released: elastic energy of "
    "rods that left the footprint; blade_before: blade at the start, where the run goes on from "
    "another; elastic_before: elastic there; numerical: created (> 0) or lost (< 0) by the scheme "
    "= work + elastic - elastic_before + plastic + released - casing"
)
OF_FRICTION = (
    " - friction; friction: of work, that of the tangential forces; heat: of friction, from the "
    "shaft"
)


def attributes(scene: Scene, rom: Rom, choice: Choice | None) -> dict[str, str | float]:
    """Attributes of a sweep: format, scene, provenance of the model, code, accuracy, and the units.

    The units of figures: f1(0), and the gap and the tip's radius at xi = 1/16.
    """
    attrs = {
        "format": FORMAT,
        "scene": scene.model_dump_json(),
        "rom": rom.provenance.dump(),
        "code": code(),
        "gap_m": float(scene.clearance.gaps(LEADING, rom.span)),
        "f1_Hz": rom.f1,
        "tip_radius_m": float(rom.line(np.array([LEADING]))[0, 0]),
        "blade": rom.provenance.blade,
        "Conventions": "CF-1.11",
        "source": f"Tiprub {version()}",
    }
    return attrs | ({"accuracy": json.dumps(choice.plain())} if choice else {})


def code() -> str:
    """Hash of the code that marches, without docstrings and comments."""
    return code_hash("simulate.sweeps.over_speeds")


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
    geometry.project.errors.WriteError
        When it cannot be written.
    """
    dated = dataset.assign_attrs(date_created=datetime.now(UTC).isoformat(timespec="seconds"))
    packed = {name: {"zlib": True, "complevel": 1} for name, v in dataset.items() if v.ndim > 1}
    write(dated, path, packed)


def load(path: str | Path) -> xr.Dataset:
    """Read a sweep or a block into memory.

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
        _require_runs(runs.load())
        return runs


def _require_runs(runs: xr.Dataset) -> None:
    """Check dimensions, speeds and statuses, and that runs with a result hold numbers.

    Raises
    ------
    KeyError
        When a variable is missing that all sweeps have, or that the scene records.
    ValueError
        When something is not as it is written.
    """
    scene = json.loads(runs.attrs["scene"])
    record, dims = scene["record"], dict(DIMS)
    if scene["clearance"].get("at") == "rest":  # another gap at each speed
        dims["gap"] = (SPEED, "strip")
    recorded = [name for key, names in RECORDED.items() if record.get(key) for name in names]
    simulated = "code" in runs.attrs  # else made by hand, of what its reader needs
    for name in [*OF_ALL, *recorded] if simulated else [SPEED, "status"]:
        if name not in runs.variables:  # xarray makes up an index that is missing
            raise KeyError(f"no variable {name}")
        if runs[name].dims != dims[name]:
            raise ValueError(f"{name}: dimensions {runs[name].dims}, not {dims[name]}")
    if not set(runs["status"].values.tolist()) <= set(STATUSES):
        raise ValueError("status: none that a run can have")
    ended = runs.isel({SPEED: np.flatnonzero(runs["status"].isin(WITH_RESULT))})
    for name in dims.keys() & runs.variables.keys() - {"status"}:
        values = ended[name]
        if values.dims != dims[name] or values.dtype.kind != "f":
            raise ValueError(f"{name}: no numbers in the dimensions {dims[name]}")
        if not np.isfinite(values).all():
            raise ValueError(f"{name}: not finite in a run that has a result")


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


def scene_of(dataset: xr.Dataset) -> Scene:
    """The scene that a sweep was run from.

    Raises
    ------
    ProvenanceError
        When this version knows no such scene.
    """
    try:
        return Scene.model_validate_json(dataset.attrs["scene"])
    except ValidationError as error:
        key = ".".join(map(str, error.errors()[0]["loc"]))
        raise ProvenanceError(
            f"its scene is none that this version knows ({key}); run the scene again",
            file="sweep.nc",
        ) from None


def entry(dims: str | tuple[str, ...], values: Any, units: str, meaning: str) -> Entry:
    """A variable or coordinate, as xarray takes it."""
    return dims, values, {"units": units, "long_name": meaning}


def of_run(
    scene: Scene,
    rom: Rom,
    setup: Setup,
    outcome: Outcome,
    seconds: float,
    departures: dict[str, float],
    errors: dict[str, float],
) -> xr.Dataset:
    """One run as a dataset with a speed axis of length one.

    ``seconds``: wall time; ``departures`` from its twin and relative ``errors``, by observable:
    empty without a twin, and without an accuracy or halving.
    """
    variables = _scalars(rom, setup, outcome, seconds) | _recorded(scene, outcome)
    variables |= _torque(scene, rom, outcome)
    if scene.contact.friction is not None:
        variables |= _of_friction(scene, setup, outcome)
    if isinstance(law := scene.liner.law, Table):
        share = outcome.wear.max() / (scene.liner.thickness_m * law.farthest)
        meaning = "deepest plastic strain over that at the end of the law's curve"
        variables["curve_share"] = scalar(share, "1", meaning)
    energies = _energies(scene, outcome)
    variables["ledger"] = entry(
        (SPEED, "energy"), np.array([list(energies.values())]), "J", "energies of the whole run"
    )
    coords = _of_speed(rom, setup) | _of_strips(scene, setup) | _of_record(scene, outcome)
    meaning = ENERGIES + (OF_FRICTION if scene.contact.friction is not None else "")
    coords["energy"] = ("energy", list(energies), {"long_name": meaning})
    if scene.record.states_rounds:
        coords |= _of_states(scene, rom, setup)
    if scene.record.end and outcome.left:
        variables |= before.variables(outcome.left)
    run = xr.Dataset(variables, coords=coords)
    if scene.record.motion:
        run = run.merge(_of_motion(scene, setup, outcome))
    from_twin = f"relative difference from the run with all gaps changed by {GAP_CHANGE:g}"
    other = "half the step, or a quarter in doubt" if scene.halving else "a coarser companion run"
    of_error = _by_observable("error", errors, f"relative error, estimated from {other}")
    of_twin = _by_observable("departure", departures, from_twin)
    return run.merge(of_twin).merge(of_error, join="outer")


def over_f1(Omega: NDArray[np.float64], rom: Rom) -> NDArray[np.float64]:
    """Speeds, rad/s, over f1(0), by which runs of any two sweeps are compared.

    Rounded, so that the same speed of another blade is the same number.
    """
    return np.round(Omega / rom.omega1, SPEED_DIGITS)


def _of_speed(rom: Rom, setup: Setup) -> dict[str, tuple]:
    here = np.array([setup.Omega])
    return {
        SPEED: entry(SPEED, over_f1(here, rom), "1", "rotational speed Omega over f1(0)"),
        "speed": entry(SPEED, here, "rad s-1", "rotational speed Omega"),
    }


def _of_strips(scene: Scene, setup: Setup) -> dict[str, tuple]:
    places, nu, g0 = setup.places, len(setup.strips.d), setup.strips.g0
    gap = entry("strip", g0, "m", "initial gap g0")
    if scene.clearance.at_rest:  # another at each speed
        gap = entry((SPEED, "strip"), g0[None], "m", "gap at rest less growth of the tip")
    return {
        "xi": entry("strip", places.xi, "1", "chord fraction of the strip"),
        "end": entry("strip_end", places.ends, "1", "chord fraction of the strips' ends"),
        "width": entry("strip", places.width, "m", "axial width of the strip"),
        "gap": gap,
        "theta": entry("theta", 2 * np.pi * np.arange(nu) / nu, "rad", "angle of the rod"),
    }


def _of_record(scene: Scene, outcome: Outcome) -> dict[str, tuple]:
    """Coordinates of the outputs that the scene asks for."""
    record, found = scene.record, {}
    if record.spectrum_rounds:
        bins = record.spectrum_rounds * record.samples_per_round // 2 + 1
        orders = np.arange(bins) / record.spectrum_rounds
        found["engine_order"] = entry("engine_order", orders, "1", "frequency over Omega")
    if record.history:
        time = np.arange(1, len(outcome.u_r) + 1) / record.samples_per_round
        found["chord"] = entry("chord", record.chord, "1", "chord fraction of the place")
        found["history_time"] = entry("history_time", time, "1", "rounds since the start")
    if record.contact_force:
        rounds, middle = np.arange(1, scene.rounds + 1), (np.arange(SHARES) + 0.5) / SHARES
        found["round"] = entry("round", rounds, "1", "number of the round")
        found["share"] = entry("share", middle, "1", "middle of the eighth of the chord")
    return found


def _of_states(scene: Scene, rom: Rom, setup: Setup) -> dict[str, tuple]:
    """Times of the recorded states, and the matrix P of displacements over the strips."""
    rounds, samples = scene.record.states_rounds, scene.record.samples_per_round
    time = scene.rounds - rounds + np.arange(1, rounds * samples + 1) / samples
    return {
        "time": entry("time", time, "1", "rounds since the start"),
        "P": entry(
            ("strip", "dof"), rom.rows(setup.places.xi), "1", "radial displacement = P states"
        ),
    }


def _of_motion(scene: Scene, setup: Setup, outcome: Outcome) -> xr.Dataset:
    """What pictures show: states of the last round, and the range of u_r over all rounds."""
    samples, record = scene.record.samples_per_round, scene.record
    step = every(record.motion, samples, setup.omega, setup.Omega)
    time = scene.rounds - 1 + np.arange(step, samples + 1, step) / samples
    edges = np.rint(np.arange(WINDOWS * scene.rounds) * samples / WINDOWS).astype(int)
    bounds = [of.reduceat(outcome.u_r[:, 0], edges) for of in (np.minimum, np.maximum)]
    window = (np.arange(len(edges)) + 0.5) / WINDOWS
    variables = {
        "motion": entry(
            (SPEED, "motion_time", "dof"),
            outcome.states[None, -samples:][:, step - 1 :: step].astype(np.float32),
            "m",
            "reduced displacements u in the last round",
        ),
        "envelope": entry(
            (SPEED, "window", "bound"),
            np.stack(bounds, axis=-1)[None].astype(np.float32),
            "m",
            f"range of u_r at xi = 1/16 in each 1/{WINDOWS} of a round",
        ),
    }
    coords = {
        "motion_time": entry("motion_time", time, "1", "rounds since the start"),
        "window": entry("window", window, "1", "rounds since the start, middle of a window"),
        "bound": ("bound", ["least", "largest"], {"long_name": "end of the range"}),
    }
    return xr.Dataset(variables, coords)


def scalar(value: object, units: str, meaning: str) -> Entry:
    """One value of a run."""
    return entry((SPEED,), np.array([value]), units, meaning)


def _of_friction(scene: Scene, setup: Setup, outcome: Outcome) -> dict[str, Entry]:
    """Stability of the blade in sliding contact, and whether it slid."""
    modes = setup.omega, setup.Phi_b, setup.Phi_t
    k = strip_stiffness(scene.liner, setup.places)
    return {
        "mu_crit": scalar(mu_crit(modes, k), "1", "friction at which engaged strips lock, statics"),
        "growth_rate": scalar(
            growth_rate(modes, scene.contact.friction, scene.damping_ratio, k),
            "s-1",
            "rate at which the motion grows with all strips engaged; < 0: it decays",
        ),
        "least_sliding": scalar(
            outcome.facts.least_sliding,
            "1",
            "least sliding speed of the tip in contact, over Omega r; inf without contact",
        ),
    }


def _scalars(rom: Rom, setup: Setup, outcome: Outcome, seconds: float) -> dict[str, Entry]:
    return {
        "status": scalar(outcome.status, "1", "how the run ended"),
        "reason": scalar(outcome.reason, "1", "why a run is without contact; empty otherwise"),
        "rounds": scalar(outcome.rounds, "1", "rounds marched"),
        "end_xi": scalar(outcome.xi, "1", "chord fraction where a run ended early; else nan"),
        "end_theta": scalar(outcome.theta, "rad", "angle in the casing there, else nan"),
        "f1": scalar(setup.omega[0] / rom.omega1, "1", "f1(Omega) over f1(0)"),
        "step": scalar(setup.h, "s", "time step h"),
        "step_limit": scalar(setup.limit, "s", "stability limit with contact"),
        "steps_per_round": scalar(setup.steps, "1", "steps per round"),
        "contact_share": scalar(outcome.contact_share, "1", "steps with contact over all steps"),
        "seconds": scalar(seconds, "s", "wall time of the march and of those beside it"),
    }


def _energies(scene: Scene, outcome: Outcome) -> dict[str, float]:
    """The ledger, J; ``ENERGIES`` defines each."""
    energies = asdict(outcome.ledger) | {"numerical": outcome.ledger.numerical}
    of_friction = () if scene.contact.friction is not None else ("friction", "heat")
    return {name: value for name, value in energies.items() if name not in of_friction}


def _by_observable(name: str, values: dict[str, float], meaning: str) -> xr.Dataset:
    """What another run says of each observable of the run; empty without that run."""
    if not values:
        return xr.Dataset()
    variable = entry((SPEED, "observable"), np.array([[*values.values()]]), "1", meaning)
    return xr.Dataset({name: variable}, coords={"observable": [*values]})


def _recorded(scene: Scene, outcome: Outcome) -> dict[str, Entry]:
    """Outputs that the scene asks for; only runs with a result have a spectrum."""
    record, variables = scene.record, {}
    if record.wear:
        variables["wear"] = entry(
            (SPEED, "strip", "theta"),
            outcome.wear[None].astype(np.float32),
            "m",
            "worn depth at rod angles 2 pi j / nu",
        )
    if record.spectrum_rounds:
        variables |= _of_spectrum(record, outcome)
    if record.history:
        variables["history"] = entry(
            (SPEED, "chord", "history_time"),
            outcome.u_r[:, 1:].T[None],
            "m",
            f"u_r at chord fractions {record.chord}, {record.samples_per_round} samples a round",
        )
    if record.states_rounds:
        variables["states"] = entry(
            (SPEED, "time", "dof"), outcome.states[None], "m", "reduced displacements u"
        )
    if record.contact_force:
        dims = (SPEED, "round", "share")
        peak, mean = outcome.force_peak[None], outcome.force_mean[None]
        variables["force_peak"] = entry(dims, peak, "N", "largest t_N on an eighth of the chord")
        variables["force_mean"] = entry(dims, mean, "N", "mean t_N on an eighth of the chord")
        if scene.contact.along:
            mean, meaning = outcome.force_tangential_mean[None], "mean t_T, against the rotation"
            variables["force_tangential_mean"] = entry(dims, mean, "N", meaning)
    return variables


def _torque(scene: Scene, rom: Rom, outcome: Outcome) -> dict[str, Entry]:
    """Torque in each round; nan, as the forces, where it was not marched. None without a torque."""
    if not scene.record.contact_force or scene.no_torque:
        return {}
    of_rounds = torque_of_rounds(scene, rom, outcome)
    meaning = "mean torque on the rotor in a round, against the rotation"
    return {"torque": entry((SPEED, "round"), of_rounds[None], "N m", meaning)}


def _of_spectrum(record: Record, outcome: Outcome) -> dict[str, Entry]:
    """Amplitudes of u_r over the spectrum's rounds, and its largest value; nan without a result."""
    samples = record.spectrum_rounds * record.samples_per_round
    values, largest = np.full(samples // 2 + 1, np.nan, np.float32), np.nan
    if outcome.status in WITH_RESULT:
        values, largest = last_spectrum(record, outcome), outcome.u_r[-samples:, 0].max()
    meaning = f"amplitude of u_r, xi = 1/16, over the last {record.spectrum_rounds} rounds"
    return {
        "spectrum": entry((SPEED, "engine_order"), values[None], "m", meaning),
        "largest": scalar(largest, "m", "largest u_r, xi = 1/16, of the spectrum's rounds"),
    }
