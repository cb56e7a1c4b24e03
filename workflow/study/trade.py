"""Study of accuracy and time, one scene: errors of every setting against a reference, CPU times."""

from collections.abc import Callable
from functools import cache
from typing import Any

from geometry.blade import Blade
from rom.model import Rom
from simulate.scene import Scene
from workflow.study.trade_plan import (
    OTHER_SCHEME,
    SAME,
    SCENES,
    Compared,
    Setting,
    coarser,
    compared,
    finest,
)
from workflow.study.trade_runs import OBSERVABLES, TURNS, Row, Run, changes, recording, rom_of, run


def numbers(files: Any, name: str, scene: Row) -> Row:
    """One scene's part of the study: its reference with its uncertainty, and all runs.

    ``scene``: its settings; the reduced models are read from their own files.
    """
    made, studied = Scene(**scene), SCENES[name]

    @cache
    def march(setting: Setting, turns: int = 0) -> Run:
        rom = rom_of(setting.model)
        return run(case_of(made, rom, setting), rom, studied, turns)

    rows = []
    for item in compared(studied):
        done = march(item.setting, TURNS)
        row = {"study": item.study, "scene": name} | _row(item, done, march(item.against))
        rows.append(row)
        print(f"{row['study']}, {row['label']}: {row['cpu_s'][1]} s, {row['errors']}")
    return {"scene": _about(name, march, rows), "runs": rows}


def case_of(scene: Scene, rom: Rom, setting: Setting) -> Scene:
    """The scene with the rods, strips and integrator of ``setting``, on its reduced model."""
    return recording(scene, rom, setting.rods, setting.strips, **setting.integrator)


def _row(item: Compared, done: Run, true: Run) -> Row:
    settings = _settings(item.setting, done.steps)
    return {
        "label": item.label.format(**settings),
        "against": item.of,
        "status": done.status,
        **settings,
        "cpu_s": done.cpu_s,
        "errors": changes(done, true),
    }


def _settings(setting: Setting, steps: int) -> Row:
    """A setting as plain values.

    Modes are the natural ones at each speed of the basis, the fixed-interface modes of the paper's.
    """
    model, rom = setting.model, rom_of(setting.model)
    blade = Blade.load(f"workflow/blades/{model.blade}.yaml")
    basis = rom.provenance.settings["basis"]
    return {
        "scheme": setting.scheme,
        "mass_scaling_hz": setting.mass_scaling_hz,
        "fraction_of_limit": setting.integrator.get("fraction_of_limit"),
        "steps": steps,
        "rods": setting.rods,
        "blade": model.blade,
        "directions": model.directions,
        "modes": basis.get("natural_modes") or basis["fixed_interface_modes"],
        "n": rom.n,
        "patches": len(rom.xi),
        "strips": setting.strips,
        "mesh_mm": blade.mesh.element_size_mm,
    }


def _about(name: str, march: Callable[[Setting], Run], rows: list[Row]) -> Row:
    """The scene and speed, the settings of the reference, and its uncertainty."""
    studied = SCENES[name]
    true = finest(studied)
    level = changes(march(coarser(studied)), march(true))
    scheme = next(r["errors"] for r in rows if (r["against"], r["label"]) == (SAME, OTHER_SCHEME))
    return {
        "scene": studied.file,
        "speed_over_f1": studied.speed,
        "reference": _settings(true, true.step),
        "uncertainty": {key: _larger(level[key], scheme[key]) for key in OBSERVABLES},
        "one_level_coarser": level,
        "another_scheme": scheme,
    }


def _larger(*values: float | None) -> float | None:
    return max((value for value in values if value is not None), default=None)
