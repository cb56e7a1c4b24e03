"""Can less do: stress of a linear solve, fewer rounds before the spectrum, fewer speeds."""

from collections.abc import Sequence
from time import process_time
from typing import Any

import xarray as xr

from rom.model import Rom
from simulate.peaks import peak_of
from simulate.scene import Scene
from simulate.sweep import at_speeds, sweep
from workflow.study.trade_errors import SPECTRUM_ROUNDS, errors, rounded
from workflow.study.trade_models import LINEAR, REFERENCE
from workflow.study.trade_plan import SCENES
from workflow.study.trade_runs import TURNS, Run, recording, rom_of, run, run_as_is

ROUNDS, LONGEST = (5, 10, 20, 40), 80  # before those of the spectrum
ORDERS = (4, 6)
SWEEPS = (  # label, of how many speeds every how many-th, closed in to (over f1(0))
    ("114 speeds", 1, None),
    ("114 speeds, closed in", 1, 4e-4),
    ("29 speeds, closed in", 4, 4e-4),
    ("15 speeds, closed in", 8, 4e-4),
)
TRUE_WITHIN = 1e-4

type Row = dict[str, Any]


def numbers(files: Any, scenes: dict[str, Row]) -> dict[str, list[Row]]:
    """All three studies; ``scenes`` by their short name."""
    made = {name: Scene(**values) for name, values in scenes.items()}
    return {
        "prestress": [prestress(name, scene) for name, scene in made.items()],
        "rounds": [row for name, scene in made.items() for row in rounds(name, scene)],
        "sweep": sweeps(made["calm"], rom_of(REFERENCE)),
    }


def prestress(name: str, scene: Scene) -> Row:
    """Stress of one linear static solve against the large deflection's."""
    linear, full = (
        run_as_is(scene, rom_of(model.to(scene.directions)), SCENES[name])
        for model in (LINEAR, REFERENCE)
    )
    found = rounded(errors(linear.read, full.read))
    return {"scene": name, "label": "linear", "errors": found, "cpu_s": linear.cpu_s}


def rounds(name: str, scene: Scene) -> list[Row]:
    """Fewer and more rounds before those of the spectrum, against many."""
    rom, studied = rom_of(REFERENCE.to(scene.directions)), SCENES[name]._replace(swept=False)
    case = recording(scene, rom, studied.tip.own)

    def after(before: int, turns: int) -> Run:
        return run(case.changed(rounds=before + SPECTRUM_ROUNDS), rom, studied, turns)

    true, rows = after(LONGEST, 0), []
    for before in ROUNDS:
        done = after(before, TURNS)
        found = rounded(errors(done.read, true.read))
        rows.append({"scene": name, "rounds_before": before, "errors": found, "cpu_s": done.cpu_s})
    return rows


def sweeps(scene: Scene, rom: Rom) -> list[Row]:
    """Coarse sweeps that close in on their peaks, against a full one closed in far further."""
    true, _ = _swept(scene, rom, 1, TRUE_WITHIN)
    peaks = {k: peak_of(true, rom, k) for k in ORDERS}
    rows = []
    for label, every, within in SWEEPS:
        found, seconds = _swept(scene, rom, every, within)
        rows.append(
            {
                "label": label,
                "marches": found.sizes["speed"],
                "cpu_s": seconds,
                "errors": _of_peaks([(peak_of(found, rom, k), peaks[k]) for k in ORDERS]),
            }
        )
    return rows


def _of_peaks(pairs: Sequence[tuple[Any, Any]]) -> dict[str, float | None]:
    """Largest error over the orders; None where a peak is not found."""
    if any(found is None for found, _ in pairs):
        return {"Omega_c": None, "amplitude": None}
    return {
        name: float(f"{max(abs(getattr(a, name) / getattr(b, name) - 1) for a, b in pairs):.4g}")
        for name in ("Omega_c", "amplitude")
    }


def _swept(scene: Scene, rom: Rom, every: int, within: float | None) -> tuple[xr.Dataset, float]:
    """Every ``every``-th speed, closed in on the peaks where asked; CPU time, s."""
    peaks = {"orders": list(ORDERS), "within_over_f1": within} if within else None
    Omega = scene.speeds.omega(rom.f1)[::-1][::every][::-1]  # with the last, which peaks are near
    case = scene.changed(twin=False, peaks=peaks, speeds={"rad_s": list(Omega)})
    at_speeds(case, rom, Omega[:1])  # compiles
    start = process_time()
    found = sweep(case, rom)
    return found, float(f"{process_time() - start:.4g}")
