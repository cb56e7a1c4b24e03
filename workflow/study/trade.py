"""What accuracy costs in time: every setting on one scene against what is taken as true."""

from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

from geometry.blade import Blade
from geometry.settings import read_settings
from rom.model import Rom
from simulate.scene import Scene
from workflow.study.trade_errors import OBSERVABLES, Read, errors
from workflow.study.trade_models import Model
from workflow.study.trade_plan import (
    SAME,
    SCENES,
    Compared,
    coarser,
    compared,
    finest,
    other_scheme,
)
from workflow.study.trade_runs import TURNS, Run, Setting, run

TOLD = {"modes": "{modes} modes", "mesh": "{mesh_mm:g} mm"}  # labels of studies of one number

type Report = Callable[[str], None]


def study_scene(name: str, scene: Scene, report: Report = print) -> dict[str, Any]:
    """One scene's part of the study: its reference with its uncertainty, and all runs."""
    timed = cache(lambda setting: _march(name, scene, setting, TURNS))
    read = cache(lambda setting: _march(name, scene, setting, 0).read)
    rows = []
    for item in compared(name):
        done = timed(item.setting)
        rows.append(_row(name, item, done, errors(done.read, read(item.against))))
        report(f"{item.study}, {item.label}: {rows[-1]['cpu_s'][1]} s, {rows[-1]['errors']}")
    return {"scene": _about(name, read, rows), "runs": rows}


@cache
def rom_of(model: Model) -> Rom:
    """Its reduced model, read once."""
    return Rom.load(model.file)


def _march(name: str, scene: Scene, setting: Setting, turns: int) -> Run:
    speed = SCENES[name][1]
    return run(scene, rom_of(setting.model), speed, setting, turns, swept=name == "resonance")


def _row(name: str, item: Compared, done: Run, found: dict[str, Any]) -> dict[str, Any]:
    ok, settings = done.status == "ok", _settings(item.setting, done.steps)
    return {
        "study": item.study,
        "scene": name,
        "label": TOLD.get(item.study, item.label).format(**settings),
        "against": item.of,
        "status": done.status,
        **settings,
        "cpu_s": done.cpu_s,
        "errors": rounded(found) if ok else dict.fromkeys(OBSERVABLES),
    }


def _settings(setting: Setting, steps: int) -> dict[str, Any]:
    """A setting as the tables tell it."""
    model, exact = setting.model, setting.scheme == "piecewise-exact"
    return {
        "scheme": setting.scheme,
        "mass_scaling_hz": setting.mass_scaling_hz,
        "fraction_of_limit": None if exact else setting.step,
        "steps": steps,
        "rods": setting.rods,
        "blade": model.blade,
        "directions": model.directions,
        "modes": _modes(rom_of(model)),
        "n": rom_of(model).n,
        "patches": len(rom_of(model).xi),
        "strips": setting.strips,
        "mesh_mm": _mesh_mm(model.blade),
    }


def _modes(rom: Rom) -> int:
    """Natural modes at each speed of its basis; fixed-interface modes of the paper's."""
    basis = rom.provenance.settings["basis"]
    return basis.get("natural_modes") or basis["fixed_interface_modes"]


@cache
def _mesh_mm(blade: str) -> float:
    return read_settings(Blade, Path(f"workflow/blades/{blade}.yaml")).mesh.element_size_mm


def _about(
    name: str, read: Callable[[Setting], Read], rows: list[dict[str, Any]]
) -> dict[str, Any]:
    """What the scene is, its reference, and how far that is known."""
    file, speed = SCENES[name]
    true = finest(name)
    level = rounded(errors(read(coarser(name)), read(true)))
    scheme = next(
        r["errors"] for r in rows if r["against"] == SAME and r["label"] == other_scheme(name)
    )
    return {
        "scene": file,
        "speed_over_f1": speed,
        "reference": _settings(true, int(true.step)),
        "uncertainty": {key: _larger(level[key], scheme[key]) for key in OBSERVABLES},
        "one_level_coarser": level,
        "another_scheme": scheme,
    }


def _larger(*values: float | None) -> float | None:
    return max((value for value in values if value is not None), default=None)


def rounded(found: dict[str, float | None]) -> dict[str, float | None]:
    """Four digits; None stays."""
    return {key: value if value is None else float(f"{value:.4g}") for key, value in found.items()}
