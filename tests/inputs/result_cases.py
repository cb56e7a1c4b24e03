"""Models and results in NetCDF, and JSON: of ours, with a seal, and of other programs."""

import json
import tempfile
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import h5netcdf
import h5py
import numpy as np
import xarray as xr
from case import Case
from changes import LONG, binary, cut, line, long
from hypothesis import strategies as st
from made_sweeps import made_rom, save_runs
from yaml_cases import Cases

from geometry.base import read_json, seal, write_json
from rom.elsewhere import load_model, read_elsewhere
from simulate.errors.accuracy import Choice
from simulate.runs import Runs
from workflow.many import design_tables
from workflow.many.table import whole

FEW = (1000, 80_000, 2_000_000)  # sizes of dimensions: of two, matrices of 8 MB to 32 TB
ODD = ["", "{}", "[]", "null", '"x"', "7", "NaN", "[[]]", "[1]", '{"record": 1}', *LONG.values()]


def _elsewhere(path: Path) -> None:
    """A reduced model as rom/README.md asks for it."""
    made_rom().save(path)
    rom = xr.load_dataset(path, engine="h5netcdf").drop_attrs(deep=False)
    rom.assign(power=2 * np.arange(rom.sizes["power"])).to_netcdf(path, engine="h5netcdf")


def _table(path: Path) -> None:
    runs = {"row": ("run", [1, 1]), "status": ("run", [0, 0]), "speed": ("run", [1.0, 2.0])}
    design_tables.save(xr.Dataset(runs, attrs={"format": design_tables.FORMAT}), path)


def _sweep(path: Path) -> None:
    save_runs(path, [0.2, 0.3], np.zeros((2, 8)), np.zeros((2, 64)), spectrum=np.ones((2, 4)))


class Seed(NamedTuple):
    """A valid file: what writes it, and what reads it."""

    file: str
    write: Callable[[Path], None]
    read: Callable[[Path], Any]

    @property
    def sealed(self) -> bool:
        return self.write is not _elsewhere

    def written(self, write: Callable[[Path], Any]) -> bytes:
        """What ``write`` makes, with a seal where ours has one."""
        with tempfile.TemporaryDirectory() as folder:
            write(path := Path(folder, self.file))
            if self.sealed:
                seal(path)
            return path.read_bytes()


SEEDS = [
    Seed("rom-r.nc", lambda path: made_rom().save(path), lambda path: load_model(path, "b")),
    Seed("mine.nc", _elsewhere, lambda path: read_elsewhere(path, "b")),
    Seed("mine.nc", _elsewhere, lambda path: load_model(path, "b")),
    Seed("sweep.nc", _sweep, lambda path: Runs.load(path, made_rom())),
    Seed("runs.nc", _table, design_tables.load),
]


@cache
def files() -> list[tuple[Seed, bytes, xr.Dataset]]:
    """Bytes and dataset of each seed, which its reader takes."""
    found = []
    with tempfile.TemporaryDirectory() as folder:
        for seed in SEEDS:
            seed.write(path := Path(folder, seed.file))
            seed.read(path)
            dataset = xr.load_dataset(path, engine="h5netcdf", decode_cf=False)
            found.append((seed, path.read_bytes(), dataset))
    return found


def _longer(path: Path, found: xr.Dataset, sizes: dict[str, int], packed: bool) -> None:
    """The dataset with other sizes of dimensions, along which no value is written."""
    with h5netcdf.File(path, "w") as file:
        file.dimensions = sizes
        file.attrs.update(found.attrs)
        for name, of in found.variables.items():
            shape = tuple(sizes[dim] for dim in of.dims)
            chunks = {"chunks": tuple(min(n, 512) for n in shape), "compression": "gzip"}
            kind = h5py.string_dtype() if of.dtype.kind in "OU" else of.dtype
            how = chunks if packed and shape and all(shape) else {}
            new = file.create_variable(name, of.dims, kind, **how)
            if shape == of.shape and of.size:
                new[...] = of.values


@st.composite
def results(draw: st.DrawFn) -> Case:
    """Sizes far above those of the file, odd attributes, damaged bytes; also with a right seal."""
    seed, data, found = draw(st.sampled_from(files()))
    how, must = draw(st.sampled_from(("size", "size", "attribute", "bytes", "sealed"))), "either"
    if how == "size":
        dims = [dim for name in sorted(found.variables) for dim in found[name].dims]
        dim, size = draw(st.sampled_from(dims)), draw(st.sampled_from(FEW))
        sizes = {d: size if d.strip("_") == dim.strip("_") else n for d, n in found.sizes.items()}
        how, packed = f"{dim} of {size}", draw(st.booleans())
        data = seed.written(lambda path: _longer(path, found, sizes, packed))
    elif how == "attribute":
        name = draw(st.sampled_from(sorted({*found.attrs, "provenance"})))
        other = found.assign_attrs({name: draw(st.sampled_from([*ODD, 7, [0.0, 0.0]]))})
        data = seed.written(lambda path: other.to_netcdf(path, engine="h5netcdf"))
    else:
        _, changed = draw(binary(data))
        must = "refuse" if how == "bytes" and seed.sealed and changed != data else "either"
        data = seed.written(lambda path: path.write_bytes(changed)) if how == "sealed" else changed
    kind = "result" if seed.file in ("sweep.nc", "runs.nc") else "reduced model"
    return Case(kind, how, {seed.file: data}, lambda f: seed.read(f / seed.file), must)


ERRORS = {"accuracy": 0.1, "basis_error": 0.01, "mesh_error": 0.02, "expected": 0.03}
CHOICE = Choice(2048, 2047, 8, **ERRORS, speeds=[400.0, 500.5], observed={"wear": 0.04}).plain()
READERS = {  # of values, and what is held of those that are accepted
    "stress.json": ({"scene": "a", "largest": [1.0, None, 2.5e8]}, read_json),
    "settings.json": (CHOICE, lambda path: Choice.load(path).plain()),
    "table.json": ([{"row": "1", "scene": "a", "numbers": {"wear": 1.5}}], whole),
}


@st.composite
def jsons(draw: st.DrawFn) -> Case:
    """JSON with other numbers or lines, without its hash, or deep; a list has no hash."""
    file = draw(st.sampled_from(sorted(READERS)))
    values, read = READERS[file]
    with tempfile.TemporaryDirectory() as folder:
        write_json(values, path := Path(folder, file))
        text = path.read_text()
    rows, hashed = range(text.count("\n")), isinstance(values, dict)
    changed = line(text, rows, "lost", "twice", "cut", "exchanged") | long(text, rows) | cut(text)
    others = st.sampled_from(["[" * 100_000, json.dumps(values), *ODD])
    changed |= others.map(lambda other: ("other", other))
    change, text = draw(changed)
    must = "refuse" if hashed and change == "other" else "either"

    def fault(found: Any) -> str:
        return "other values" if hashed and found != values else ""

    return Case("json", change, {file: text.encode()}, lambda f: read(f / file), must, fault)


def result_cases() -> Cases:
    """All of these."""
    return st.one_of(results(), results(), results(), jsons())
