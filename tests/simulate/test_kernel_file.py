"""Kernels on disk: known by what their machine code depends on, and never needed."""

import os
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

import numba
import numpy as np
import pytest
from numba.core.codegen import JITCodeLibrary

from simulate.contact import kernel_file
from simulate.contact.compiled import compiled, compiled_kernel
from simulate.contact.kernel_file import UnknownError, kernel, key

STIFFNESS = 2.0
TABLE = np.array([1.0, 2.0])
PROCESS = """
import sys
from pathlib import Path
sys.path.insert(0, sys.argv[1])
from test_kernel_file import Law, Spring, apply, key_of, kernel_file, twice
from simulate.contact.compiled import for_types_of
kernel_file.FOLDER = Path(sys.argv[2])
arguments = Law(twice, Spring(3.0)), 5.0
print(key_of(), for_types_of(apply, *arguments)(*arguments), len(apply.overloads))
"""


class Spring(NamedTuple):
    k: float


class Damper(NamedTuple):
    c: float


class Law(NamedTuple):
    stress: object
    parameters: object


@compiled
def twice(law, eps):
    return STIFFNESS * law.k * eps


@compiled
def tabulated(law, eps):
    return TABLE[1] * law.k * eps


@compiled
def thrice(law, eps):
    return 3.0 * law.k * eps


@pytest.mark.parametrize("most", [0, 10, 25, 100])
def test_kernels_used_longest_ago_are_removed(tmp_path, monkeypatch, most):
    monkeypatch.setattr(kernel_file, "MOST_BYTES", most)
    for age, name in enumerate(["new", "older", "oldest"]):
        (tmp_path / f"{name}.kernel").write_bytes(bytes(10))
        os.utime(tmp_path / f"{name}.kernel", (1e9 - age, 1e9 - age))
    kernel_file._remove_unused(tmp_path)
    kept = ["new", "older", "oldest"][: most // 10]
    assert {path.stem for path in tmp_path.iterdir()} == {*kept}


@compiled
def inner_and_outer(law, eps):
    return law.k * eps + 1.0


@compiled
def four_times(law, eps):
    return 4.0 * law.k * eps


@compiled_kernel
def apply(law, eps):
    return law.stress(law.parameters, eps)


HERE, CODEGEN = sys.modules[__name__], type(apply.targetctx.codegen())


def types_of(*arguments):
    return tuple(map(numba.typeof, arguments))


def key_of(stress=twice, parameters=None, eps=5.0):
    return key(apply, types_of(Law(stress, parameters or Spring(3.0)), eps))


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.setattr(kernel_file, "FOLDER", tmp_path / "kernels")
    monkeypatch.setattr(kernel_file, "kernel", kernel.__wrapped__)
    return kernel_file.FOLDER


def test_a_kernel_is_known_by_formula_values_names_and_types():
    keys = [
        key_of(),
        key_of(thrice),
        key_of(tabulated),
        key_of(parameters=Damper(3.0)),
        key_of(parameters=Spring(3)),
        key_of(eps=np.float32(5.0)),
        key(twice, types_of(Spring(3.0), 5.0)),
    ]
    assert len({*keys, key_of()}) == len(keys)


@pytest.mark.parametrize(
    ("of", "name", "value"),
    [
        (kernel_file, "VERSIONS", ("another",)),
        (CODEGEN, "magic_tuple", lambda self: ("x86_64", "another", "")),
        (HERE, "STIFFNESS", 2.5),
        (HERE, "TABLE", np.array([1.0, 2.5])),
    ],
)
def test_what_a_formula_reads_the_processor_and_the_compiler_are_part_of_it(
    monkeypatch, of, name, value
):
    before = key_of(), key_of(tabulated)
    monkeypatch.setattr(of, name, value)
    changed = key_of() != before[0], key_of(tabulated) != before[1]
    assert changed == (name != "TABLE", name != "STIFFNESS")


def test_what_cannot_be_told_is_compiled_and_not_kept(folder, monkeypatch):
    monkeypatch.setattr(HERE, "STIFFNESS", np.random.default_rng(0))
    with pytest.raises(UnknownError):
        key_of()
    monkeypatch.setattr(kernel_file, "key", lambda *_: (_ for _ in ()).throw(UnknownError))
    arguments = Spring(3.0), 5.0
    assert kernel_file.kernel(thrice.outer, types_of(*arguments))(*arguments) == 45.0
    assert not folder.exists()


def processes(folder, number):
    command = [sys.executable, "-c", PROCESS, Path(__file__).parent, folder]
    started = [subprocess.Popen(command, stdout=subprocess.PIPE, text=True) for _ in range(number)]
    return [process.communicate(timeout=300)[0].split() for process in started]


def test_of_processes_that_start_at_once_one_compiles_the_file_which_all_read(tmp_path):
    folder = tmp_path / "kernels"
    at_once = processes(folder, 3)
    assert {(told[0], told[1]) for told in at_once} == {(at_once[0][0], "30.0")}
    assert sorted(told[2] for told in at_once) == ["0", "0", "1"]  # two wait for the one's file
    assert [path.name for path in folder.glob("*.kernel")] == [f"apply-{at_once[0][0]}.kernel"]
    assert processes(folder, 1) == [[at_once[0][0], "30.0", "0"]]  # nothing compiled


@pytest.mark.parametrize("content", [b"", b"half", None])
def test_a_file_that_cannot_be_read_is_made_anew(folder, content):
    arguments = Law(thrice, Spring(3.0)), 5.0
    types = types_of(*arguments)
    kernel_file.kernel(apply, types)
    (file,) = folder.glob("*.kernel")
    whole = file.read_bytes()
    flipped = whole[:99] + bytes([whole[99] ^ 1]) + whole[100:]
    file.write_bytes(flipped if content is None else content)
    assert kernel_file._loaded(apply, file) is None
    assert kernel_file.kernel(apply, types)(*arguments) == 45.0
    assert kernel_file._loaded(apply, file)(*arguments) == 45.0


def test_a_folder_that_cannot_be_written_costs_nothing_but_time(folder):
    folder.parent.mkdir(exist_ok=True)
    folder.write_text("a file in its place")
    arguments = Law(twice, Spring(3.0)), 5.0
    assert kernel_file.kernel(apply, types_of(*arguments))(*arguments) == 30.0


@pytest.mark.parametrize(
    ("parts", "law", "stress"),
    [
        (kernel_file.PRIVATE, inner_and_outer, 16.0),
        (((JITCodeLibrary, "no such part"),), four_times, 60.0),  # as numba does it
    ],
)
def test_an_inner_function_is_linked_into_its_kernel_alone(monkeypatch, parts, law, stress):
    """Guards the private parts of numba: without them kernels take twice as long to compile."""
    monkeypatch.setattr(kernel_file, "PRIVATE", parts)
    arguments = Law(law, Spring(3.0)), 5.0
    kernel_file._compiled(apply, types_of(*arguments))
    (inner,) = law.overloads.values()
    engine, whole = apply.targetctx.codegen()._engine, all(hasattr(*part) for part in parts)
    assert whole == (law is inner_and_outer)
    assert engine.is_symbol_defined(inner.fndesc.llvm_func_name) != whole
    assert apply(*arguments) == law(*arguments[0][1:], 5.0) == stress
