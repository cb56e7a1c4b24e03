"""Files that the chain wrote, damaged in many ways: each is refused in one line, or reads right."""

import re
import shutil
from collections import Counter
from collections.abc import Callable
from dataclasses import fields
from functools import partial
from pathlib import Path
from time import process_time
from typing import Any

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from projects import Project
from scenes import scene

from fem import solid
from fem.matrices import Matrices
from fem.solid import read_solid
from geometry import stored
from geometry.base import UserError, files, read_json, require_writable, seal, write_json
from geometry.stored import CSR, Stored, write
from rom.check import RomCheck
from rom.full_model import FullModel
from rom.model import Rom
from rom.reconstruct import Basis
from simulate.errors.accuracy import Choice, require_model
from simulate.errors.model_errors import ModelErrors
from simulate.sweeps import dataset
from workflow.figures import rendering
from workflow.jobs.figure import origins
from workflow.many import design_rows, design_tables
from workflow.many.design import Design
from workflow.many.engine import march_block

SEED = 20
DAMAGES = 32  # of each file
BLADE = "results/paper"
REMEDY = re.compile(r"make it anew: `\./run snakemake -f \S+`|delete it, and run the design again")


@pytest.fixture(scope="module")
def project(project, tmp_path_factory) -> Project:
    """The finished project, to be damaged."""
    folder = tmp_path_factory.mktemp("damaged") / "project"
    shutil.copytree(project.folder, folder, symlinks=True)
    return Project(folder)


@pytest.fixture(scope="module")
def readers(project, coarse_blade) -> dict[Path, Callable[[Path], Any]]:
    """What reads each file, as the jobs of the workflow do."""
    blade = project.folder / BLADE
    rom, peak = Rom.load(blade / "rom-r.nc"), blade / "peak-e1"
    _write_choice_and_mesh_error(blade, rom)
    _write_tables(blade, rom)

    def tip(path):
        blade = read_solid(str(path), coarse_blade.material)
        return blade.free_coordinates(), blade.tip

    def fields_of_peak(path):
        grid = rendering.read_fields(path)
        return grid.points, grid["away from clamp and contact"]

    def check(path):
        found = RomCheck.load(path)
        found.require(0.1)
        require_model(0.1, ModelErrors.of(path, None, rom).largest)
        return found

    def sweep(path):
        origins([path])
        return dataset.load(path)

    return {
        blade / "blade.msh": tip,
        blade / "matrices.h5": Matrices.load,
        blade / "full-model.nc": FullModel.load,
        blade / "rom-r.nc": Rom.load,
        blade / "basis-r.h5": Basis.load,
        blade / "rom-check-r.nc": check,
        blade / "mesh-error.json": partial(ModelErrors.of, blade / "rom-check-r.nc", rom=rom),
        blade / "settings.json": Choice.load,
        blade / "paper-e1/block-0.nc": sweep,
        blade / "paper-e1/sweep.nc": sweep,
        peak / "sweep.nc": sweep,
        peak / "stress.vtu": fields_of_peak,
        peak / "stress.json": read_json,
        blade / "runs.nc": design_tables.load,
        blade / "rows.nc": design_tables.load,
    }


def _write_choice_and_mesh_error(blade: Path, rom: Rom) -> None:
    """What the pilot and the study of the mesh write."""
    errors = {"accuracy": 0.1, "basis_error": 0.01, "mesh_error": 0.02, "expected": 0.03}
    choice = Choice(2048, 2047, 8, **errors, speeds=[400.0, 500.5], observed={"wear": 0.04})
    write_json(choice.plain(), blade / "settings.json")
    write_json({"mesh": rom.provenance.mesh, "error": 0.02}, blade / "mesh-error.json")


def _write_tables(blade: Path, rom: Rom) -> None:
    """The tables of a design of two rows."""
    (blade / "mine.csv").write_text("liner.law.K\n0.3\n0.45\n")
    base = scene(blade="paper", rounds=1, design="mine.csv", speeds={"over_f1": [0.3, 0.32]})
    design = Design.of(base, blade / "mine.yaml")
    entries = march_block(design.rows(), blade / "rows", 2, models={"paper": rom})
    for name, table in zip(
        ("runs", "rows"), design_tables.tables(design, rom, [entries], blade / "rows"), strict=True
    ):
        design_tables.save(table, blade / f"{name}.nc")


def same(a: Any, b: Any) -> bool:
    """Whether two results of a reader are alike to the last bit."""
    if isinstance(a, xr.Dataset):
        return a.identical(b)
    if hasattr(a, "nnz"):
        return a.shape == b.shape and (a != b).nnz == 0
    if hasattr(a, "__dataclass_fields__"):
        return all(same(getattr(a, f.name), getattr(b, f.name)) for f in fields(a))
    if isinstance(a, tuple | list):
        return len(a) == len(b) and all(map(same, a, b))
    numbers = isinstance(a, np.ndarray | float)
    return np.array_equal(a, b, equal_nan=True) if numbers else a == b


def outcome(read: Callable[[Path], Any], path: Path, right: Any) -> str:
    """Whether a damaged file is refused, or read with the ``right`` result."""
    try:
        found = read(path)
    except UserError as error:
        message = str(error)
        assert "\n" not in message and path.name in message, message
        assert REMEDY.search(message) or "tolerance_percent" in message, message
        return "refused"
    return "right" if same(found, right) else "silent"


def damaged(data: bytes, rng: np.random.Generator) -> tuple[str, bytes]:
    """One of the ways in which disks, copies and editors damage files."""
    at, to = sorted(rng.integers(len(data), size=2).tolist())
    changed = bytearray(data)
    match kind := str(rng.choice(["bit", "bytes", "cut", "zeros", "lost", "longer", "swapped"])):
        case "bit":
            changed[at] ^= 1 << int(rng.integers(8))
        case "bytes":
            for i in rng.integers(len(data), size=8):
                changed[i] = int(rng.integers(256))
        case "cut":
            del changed[at:]
        case "zeros":
            changed[at : at + 4096] = bytes(len(changed[at : at + 4096]))
        case "lost":
            del changed[at : at + 512]
        case "longer":
            changed += data[at : at + 512]
        case "swapped":
            n = min(512, to - at, len(data) - to)
            changed[at : at + n], changed[to : to + n] = data[to : to + n], data[at : at + n]
    return kind, bytes(changed)


@pytest.mark.nightly
def test_damaged_files_are_refused_or_read_right(readers, record_property):
    """Bytes changed, lost or swapped anywhere: no library reads them."""
    rng, counts = np.random.default_rng(SEED), Counter()
    for path, read in readers.items():
        data, right = path.read_bytes(), read(path)
        for _ in range(DAMAGES):
            kind, changed = damaged(data, rng)
            path.write_bytes(changed)
            found = "unchanged" if changed == data else outcome(read, path, right)
            assert found != "silent", f"{path.name}: {kind}"
            counts[found] += 1
        path.write_bytes(data)
        assert same(read(path), right)
    record_property("damaged files", f"{counts.total()} of {len(readers)} kinds: {dict(counts)}")
    assert counts["refused"] + counts["right"] > 0.95 * counts.total() >= 0.95 * 450


def numbers_of(path: Path, right: Any) -> list[str]:
    """Names of the arrays of a file that must be numbers."""
    if isinstance(right, Stored):
        held = [f for f in fields(right) if f.metadata and np.size(getattr(right, f.name))]
        must = [f.name for f in held if not (f.metadata["may_be_nan"] or f.metadata["sparse"])]
        sparse = [f"{f.name}_{part}" for f in held if f.metadata["sparse"] for part in CSR]
        return [*sparse, *(name for name in must if name != "directions")]
    if path.name == "rows.nc":
        return [*design_rows.ROW_COLUMNS]
    must = design_rows.ALWAYS if path.name == "runs.nc" else {*dataset.DIMS} - {"status"}
    return sorted(must & {*right.variables})


def forged(path: Path, name: str, kind: str) -> None:
    """Give an array ``name`` another content or shape, and seal the file as if it were right."""
    found = xr.load_dataset(path, engine="h5netcdf")
    values = _changed(found[name].values, kind)
    if values is None:
        found = found.drop_vars(name)
    else:
        dims = found[name].dims if values.shape == found[name].shape else "flat"
        found = found.drop_vars(name).assign({name: (dims, values)})
    write(found, path)


def _changed(values: np.ndarray, kind: str) -> np.ndarray | None:
    """None if missing."""
    values = np.array(values)
    last = tuple(n - 1 for n in values.shape)
    match kind:
        case "missing":
            return None
        case "1-D":
            return np.append(values.ravel(), 1.0).astype(values.dtype)
        case "zero":
            return np.zeros_like(values)
        case "nan":
            values = values.astype(float) if values.dtype.kind == "i" else values
            values[last] = np.nan
        case "unsymmetric":
            values[(*last[:-1], 0)] += 1e-6 * abs(values).max()
    return values


KINDS = ("nan", "missing", "1-D", "zero", "unsymmetric")
MATRICES = ("M", "K", "compliance")


@pytest.mark.nightly
def test_arrays_that_cannot_be_are_refused_though_the_file_is_sealed(readers, record_property):
    """As if a program other than ours had written them: what they are is checked as well."""
    rng, counts = np.random.default_rng(SEED), Counter()
    for path, read in readers.items():
        if path.suffix not in (".h5", ".nc") or path.parent.name == "paper-e1":
            continue  # as peak-e1
        data, right = path.read_bytes(), read(path)
        for name in numbers_of(path, right):
            some = KINDS[1:3] if path.name == "rows.nc" else KINDS[:3]  # nan: without a peak
            for kind in KINDS if name in MATRICES else [str(rng.choice(some))]:
                forged(path, name, kind)
                found = outcome(read, path, right)
                assert found == "refused", f"{path.name}: {name} {kind}: {found}"
                counts[kind] += 1
                path.write_bytes(data)
    record_property("arrays", f"{counts.total()}: {dict(counts)}")
    assert counts.total() >= 60 and counts["unsymmetric"] == 3


@pytest.mark.nightly
def test_a_job_refuses_a_damaged_file_and_the_remedy_that_it_names_works(project):
    """The check of a reduced model, whose full model was damaged, and made anew as it says."""
    full, target = project.folder / BLADE / "full-model.nc", f"{BLADE}/rom-check-r.nc"
    data, right = full.read_bytes(), RomCheck.load(project.folder / target)
    full.write_bytes(data[:5000] + bytes([data[5000] ^ 1]) + data[5001:])
    output = project.run(target, expect=1)
    words = rf"check_rom: {BLADE}/full-model.nc: damaged or changed since it was written; make it"
    assert words in output and "Traceback" not in output
    project.run(*re.search(r"make it anew: `\./run snakemake (.+?)`", output)[1].split())
    assert same(FullModel.load(full).omega, np.array(right.full))
    project.run(target)
    assert same(RomCheck.load(project.folder / target), right)


@pytest.mark.nightly
def test_checks_take_at_most_two_percent_of_a_run(readers, project, monkeypatch, record_property):
    """Every file sealed once and read by three jobs; on the reference blade it is 0.7 %.

    The run is that of the coarse blade, of which the jobs with a benchmark are counted.
    """
    spent = Counter()

    def timed(module, name):
        function = getattr(module, name)

        def run(*arguments):
            start = process_time()
            try:
                return function(*arguments)
            finally:
                spent[name] += process_time() - start

        monkeypatch.setattr(module, name, run)

    checks = {stored: "require_symmetric", Rom: "require_possible"}
    checks |= {dataset: "_require_runs", design_tables: "_require_columns"}
    sealing = (files, solid, rendering)
    others = (stored, "tril"), *((module, "intact") for module in sealing)
    for module, name in (*checks.items(), *others):
        timed(module, name)
    for path, read in readers.items():
        for _ in range(3):
            read(path)
        start = process_time()
        seal(shutil.copy(path, path.with_name(f"copy{path.suffix}")))
        require_writable(path)
        spent["seal and trial"] += process_time() - start
    assert spent.keys() >= {"intact", "tril", "require_symmetric", "_require_runs"}
    jobs = (project.folder / "results").rglob("benchmarks/*.tsv")
    whole = sum(pd.read_csv(job, sep="\t")["cpu_time"].item() for job in jobs)
    record_property("checks", f"{spent.total():.2f} s of {whole:.1f} s of the processor")
    assert spent.total() <= 0.02 * whole
