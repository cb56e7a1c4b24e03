"""Stages of the study of cost, each run in a process of its own: python -m ... STAGE VALUES.

A stage gets its values as JSON, does its work and tells sizes and the CPU time of what it measures
on the last line of its output. Without a time of its own, all of its work is measured.
"""

import json
import sys
from collections.abc import Mapping
from pathlib import Path
from time import process_time
from typing import Any

import numpy as np

from geometry.project import csv_text, read_json, read_settings
from rom.model import Rom
from simulate.scene import Scene

CHECKED = 3  # speeds of the full model that are solved here; the workflow's check has 17
BINS = 4  # runs that are marched, and of which sweeps of many speeds are made of copies

type Told = dict[str, Any]


def _blade(blade: str, changes: Mapping[str, Any]) -> Any:
    from geometry.blade import Blade

    return read_settings(Blade, blade).but(**changes)


def mesh(folder: str, blade: str, **changes: Any) -> Told:
    """Mesh with gmsh."""
    from geometry.mesh import build_mesh

    summary = build_mesh(_blade(blade, changes), Path(folder, "blade.msh"))
    return {"nodes": summary.nodes}


def assemble(folder: str, blade: str, **changes: Any) -> Told:
    """M and K(Omega) at the speeds of the basis, and S."""
    from fem.assemble import assemble
    from rom.speeds import basis_speeds

    settings = _blade(blade, changes)
    speeds = basis_speeds(settings.basis, settings.max_speed_rad_s)
    fom, path = assemble(settings, "scaling", Path(folder, "blade.msh"), speeds), _matrices(folder)
    fom.save(path)
    return {"dofs": fom.M.shape[0], "entries": fom.M.nnz, "bytes": path.stat().st_size}


def reduce(folder: str, blade: str, **changes: Any) -> Told:
    """Reduced model with radial interface DoFs."""
    from fem.matrices import Matrices
    from rom.reduce import reduce

    rom, _ = reduce(Matrices.load(_matrices(folder)), _blade(blade, changes).basis, "r")
    rom.save(Path(folder, "rom.nc"))
    return {"n": rom.n}


def full_model(folder: str, blade: str, **changes: Any) -> Told:
    """Modes and tip compliance of the full model at a few speeds."""
    from fem.assemble import over_speeds
    from fem.cholesky import Cholesky
    from rom.full_model import solve

    settings, cholesky = _blade(blade, changes), Cholesky()
    speeds = np.linspace(0.0, settings.max_speed_rad_s, CHECKED)
    fom, states = over_speeds(settings, "scaling", Path(folder, "blade.msh"), speeds, cholesky)
    return {"speeds": len(solve(fom, states, cholesky).speeds)}


def march(rom: str, scene: dict[str, Any], **changes: Any) -> Told:
    """One run at the scene's one speed, its result packed; the kernel is loaded before."""
    from simulate.sweeps.dataset import of_run
    from simulate.sweeps.over_speeds import march_one, set_up

    model, asked = Rom.load(rom), Scene.model_validate(scene).but(**changes)
    Omega = float(asked.speeds.omega(model.f1)[0])
    few = asked.but(rounds=2, record__spectrum_rounds=1, casing__ramp_rounds=1)
    march_one(few, model, set_up(few, model, Omega), None)
    begun, setup = process_time(), set_up(asked, model, Omega)
    run = march_one(asked, model, setup, None)
    packed = of_run(asked, model, *run)
    return {
        "seconds": process_time() - begun,
        "status": run.outcome.status,
        "steps": asked.rounds * setup.steps,
        "contact_share": float(run.outcome.contact_share),
        "n": model.n,
        "strips": asked.liner.m,
        "bytes": packed.nbytes,
    }


def blocks(folder: str, rom: str, scene: dict[str, Any], speeds: int, blocks: int) -> Told:
    """Blocks of a sweep of many speeds, of copies of a few runs."""
    from simulate.sweeps import dataset
    from simulate.sweeps.over_speeds import at_speeds

    model, asked = Rom.load(rom), Scene.model_validate(scene)
    Omega = np.linspace(0.34, 0.36, BINS) * 2 * np.pi * model.f1
    runs, over_f1 = at_speeds(asked, model, Omega), np.linspace(0.1, 0.4, speeds)
    for block in range(blocks):
        own = over_f1[block::blocks]
        copies = runs.isel(speed_over_f1=np.arange(len(own)) % BINS)
        copies = copies.assign_coords(speed_over_f1=own)
        dataset.save(copies, Path(folder, f"block-{block}.nc"))
    return {}


def merge(folder: str) -> Told:
    """A sweep of its blocks, as the workflow merges them."""
    from simulate.sweeps import dataset

    runs = dataset.merge([dataset.load(path) for path in sorted(Path(folder).glob("block-*.nc"))])
    dataset.save(runs, Path(folder, "sweep.nc"))
    return {"held": runs.nbytes}


def design(folder: str, rom: str, scene: dict[str, Any], rows: int) -> Told:
    """A block of one row of a design of many: what each block costs beside its own runs."""
    from simulate.scene.design import Design
    from simulate.sweeps.design_runs import Engine, march_block, save

    table = Path(folder, "table.csv")
    values = [[f"{1e-3 + 1e-2 * row / rows:.9f}"] for row in range(rows)]
    table.write_text(csv_text([["damping_ratio"], *values]))
    asked = Scene.model_validate(scene).but(design=table.name)
    engine = Engine.of(Design.of(asked, table.with_name("scene.yaml")), Rom.load(rom))
    runs = march_block(engine, Path(folder, "parts"), 0, rows)
    save(runs, Path(folder, "block.nc"))
    return {"runs": runs.sizes["run"]}


def tables(folder: str, rom: str, scene: dict[str, Any], rows: int) -> Told:
    """The two tables of a design, of copies of the block of one row; beside what is read again."""
    from simulate.scene.design import Design
    from simulate.sweeps.design_runs import Engine, load, merge, row_table, save

    asked = Scene.model_validate(scene).but(design="table.csv")
    engine = Engine.of(Design.of(asked, Path(folder, "scene.yaml")), Rom.load(rom))
    begun, one = process_time(), load(Path(folder, "block.nc"))
    copies = one.isel(run=np.zeros(rows, int)).assign(row=("run", np.arange(1, rows + 1)))
    runs, of_rows = Path(folder, "runs.nc"), Path(folder, "rows.nc")
    merged = merge([copies])
    save(merged, runs)
    save(row_table(engine, merged), of_rows)
    return {
        "seconds": process_time() - begun,
        "bytes": runs.stat().st_size,
        "row_bytes": of_rows.stat().st_size,
    }


def _matrices(folder: str) -> Path:
    return Path(folder, "matrices.h5")


STAGES = (mesh, assemble, reduce, full_model, march, blocks, merge, design, tables)


def main(name: str, values: str) -> None:
    """Run the stage ``name`` with the ``values``, a JSON file, and tell what it measured."""
    stage = {stage.__name__: stage for stage in STAGES}[name]
    begun = process_time()
    told = stage(**read_json(values))
    print(json.dumps({"seconds": process_time() - begun} | told))


if __name__ == "__main__":
    main(*sys.argv[1:])
