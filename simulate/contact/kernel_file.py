"""Compiled kernels stored on disk for all processes: compiling takes some 16 s.

numba's own cache identifies functions passed as arguments, as those of the scheme and the law, by
their address in memory, and never finds them in another process. Here the key of a kernel is a hash
of all that its machine code depends on: the bytecode of every function that it calls and the values
that they read, the types of its arguments, the processor, and the versions of Python, numba,
llvmlite and NumPy.

Inner functions of a kernel are linked into it, and into nothing else. numba optimises the module of
each compiled function, turns it into machine code and makes that known to the process. Those of a
kernel are inlined into it: only its own module, which theirs are linked into, is ever run. Without
the rest a kernel takes two thirds of the time to compile, and is the same to the bit. This needs
private parts of numba; without them it compiles as numba does.
"""

import hashlib
import inspect
import os
import pickle
import re
import stat
import sys
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager, suppress
from copy import copy
from functools import cache
from itertools import accumulate
from pathlib import Path
from types import BuiltinFunctionType, CodeType, FunctionType, ModuleType
from typing import Any

import llvmlite
import numba
import numpy as np
from numba.core.codegen import JITCodeLibrary, JITCPUCodegen
from numba.core.compiler import CompileResult
from numba.core.dispatcher import Dispatcher
from numba.core.serialize import dumps
from numba.core.types import BaseTuple, Dispatcher as DispatcherType, Type
from platformdirs import user_cache_path

from geometry.base import alone, intact, write_whole

FOLDER = user_cache_path("tiprub") / "kernels"
MOST_BYTES = 1 << 28  # of all kernels, some 150: those used last are kept
VERSIONS = sys.version, numba.__version__, llvmlite.__version__, np.__version__
PLAIN = bool, int, float, complex, str, type(None)
MODULES = "math", "numpy"  # modules whose functions depend on their versions only
PRIVATE = (  # parts of numba
    (JITCodeLibrary, "_optimize_final_module"),
    (JITCodeLibrary, "_finalize_final_module"),
    (JITCPUCodegen, "_library_class"),
    (JITCPUCodegen, "set_env"),
)


class UnknownError(Exception):
    """A function reads a value that cannot be compared between processes."""


@cache
def kernel(function: Dispatcher, types: tuple[Type, ...]) -> Callable:
    """Return ``function`` compiled for arguments of ``types``, read from its file or written to it.

    A process waits while another one compiles it. If the file cannot be read or written, also with
    another version of numba, the function is compiled. The file is run as code: it must be one's
    own, in a folder where nobody else writes.
    """
    try:
        path = FOLDER / f"{function.py_func.__name__}-{key(function, types)}.kernel"
    except UnknownError:
        return _compiled(function, types)
    with suppress(OSError):  # of a place where nothing can be written
        path.parent.mkdir(parents=True, exist_ok=True)
        path.parent.chmod(0o700)
    if not _is_own(path.parent.resolve()):
        return _compiled(function, types)
    if (ready := _loaded(function, path)) is not None:
        return ready
    with alone(path):
        return _loaded(function, path) or _written(function, types, path)


def key(function: Dispatcher, types: tuple[Type, ...]) -> str:
    """Hash of all that the machine code of ``function`` for arguments of ``types`` depends on.

    Raises
    ------
    UnknownError
        When one of the functions reads a value other than numbers, strings, arrays, tuples,
        functions.
    """
    seen: set[FunctionType] = set()
    text = "\n".join(
        [
            *map(str, VERSIONS + function.targetctx.codegen().magic_tuple()),  # pyright: ignore[reportAttributeAccessIssue]
            *(_type_text(of, seen) for of in types),
            _value_text(function, seen),
        ]
    )
    return hashlib.sha256(text.encode()).hexdigest()[:32]


def _type_text(numba_type: Type, seen: set[FunctionType]) -> str:
    """Text of a type, without the addresses in memory in its name."""
    if isinstance(numba_type, DispatcherType):
        return _value_text(numba_type.dispatcher, seen)
    if isinstance(numba_type, BaseTuple) and isinstance(numba_type, Iterable):
        items = ", ".join(_type_text(item, seen) for item in numba_type)
        return f"({', '.join(getattr(numba_type, 'fields', ()))}: {items})"
    return re.sub(" at 0x[0-9a-f]+", "", str(numba_type))


def _value_text(value: Any, seen: set[FunctionType]) -> str:
    """Text of a value that a function reads: number, string, array, tuple, module or function."""
    if isinstance(value, Dispatcher):
        options = tuple(sorted(value.targetoptions.items()))
        return f"{_value_text(options, seen)} {_value_text(value.py_func, seen)}"
    if isinstance(value, FunctionType):
        return "\n".join(_of_function(value, seen))
    if isinstance(value, set):
        value = tuple(sorted(value))
    if isinstance(value, tuple):
        return f"({', '.join(_value_text(item, seen) for item in value)})"
    if isinstance(value, np.ndarray | np.generic):
        array = np.asarray(value)
        return f"{array.dtype.descr} {array.shape} {array.tobytes().hex()}"
    if isinstance(value, ModuleType) and value.__name__ in MODULES:
        return value.__name__
    if isinstance(value, BuiltinFunctionType | np.ufunc):
        return f"{value.__name__} {type(value).__name__}"
    if isinstance(value, type) and issubclass(value, tuple) and hasattr(value, "_fields"):
        return f"{value.__name__}{vars(value)['_fields']}"
    if isinstance(value, PLAIN):
        return repr(value)
    raise UnknownError(repr(value))


def _of_function(function: FunctionType, seen: set[FunctionType]) -> Iterator[str]:
    """Bytecode of a function, and the values of its names; only the name if it was ``seen``."""
    yield function.__qualname__
    if function in seen:
        return
    seen.add(function)
    code = function.__code__
    if any(isinstance(constant, CodeType) for constant in code.co_consts):
        raise UnknownError(f"{function.__qualname__} defines a function")
    yield repr((code.co_code, code.co_consts, code.co_names, code.co_varnames))
    names = inspect.getclosurevars(function)
    for name, value in sorted({**names.globals, **names.nonlocals}.items()):
        yield f"{name} = {_value_text(value, seen)}"
    yield _value_text(function.__defaults__, seen)


def _is_own(path: Path) -> bool:
    """Whether a file or folder is of this user, no link, and closed to the writing of others."""
    try:
        of = path.lstat()
    except OSError:
        return False
    return of.st_uid == os.geteuid() and not (stat.S_ISLNK(of.st_mode) or of.st_mode & 0o022)


def _loaded(function: Dispatcher, path: Path) -> Callable | None:
    """The kernel in the file; None without a file that can be read."""
    with suppress(Exception):  # of the file or of numba: the kernel is then compiled
        if not _is_own(path):
            return None
        dumped = pickle.loads(intact(path).read_bytes())
        os.utime(path)  # it is used
        function.targetctx.refresh()
        return CompileResult._rebuild(function.targetctx, *dumped).entry_point
    return None


def _written(function: Dispatcher, types: tuple[Type, ...], path: Path) -> Callable:
    """Compile, and write to the file if possible."""
    compiled = _compiled(function, types)
    with suppress(Exception):  # of the file or of numba: the next process compiles again
        write_whole(_dumped(function.overloads[types]), path)
        path.chmod(0o600)
        _remove_unused(path.parent)
    return compiled


def _remove_unused(folder: Path) -> None:
    """Remove the kernels that were used longest ago, of more than ``MOST_BYTES``."""
    states = [(path, path.stat()) for path in folder.glob("*.kernel")]
    states.sort(key=lambda entry: entry[1].st_mtime, reverse=True)
    sizes = accumulate(state.st_size for _, state in states)
    for (path, _), size in zip(states, sizes, strict=True):
        if size > MOST_BYTES:
            path.unlink(missing_ok=True)


def _compiled(function: Dispatcher, types: tuple[Type, ...]) -> Callable:
    with linked_into(function):
        function.compile(types)
    return function.get_overload(types)


def _dumped(result: CompileResult) -> bytes:
    """Machine code and its entry point, without the types of the arguments, which the key has."""
    library, description, environment, _, *others = result._reduce()
    description = copy(description)
    description.argtypes, description.restype, description.global_dict = (), None, None
    return dumps((library, description, environment, None, *others))


class _LinkOnly(JITCodeLibrary):
    """Module of an inner function: neither optimised nor made known to the process."""

    def _optimize_final_module(self) -> None:
        pass

    def _finalize_final_module(self) -> None:
        self._finalized = True


@contextmanager
def linked_into(kernel: Dispatcher) -> Iterator[None]:
    """Compile all but ``kernel`` itself, in the block, to be linked only."""
    if not all(hasattr(owner, name) for owner, name in PRIVATE):
        yield
        return
    codegen = kernel.targetctx.codegen()  # pyright: ignore[reportAttributeAccessIssue]  of a CPU

    def library(cpu: JITCPUCodegen, name: str) -> JITCodeLibrary:
        """Library of a function: whole for the kernel alone."""
        return (JITCodeLibrary if name == kernel.py_func.__qualname__ else _LinkOnly)(cpu, name)

    def set_env(name: str, env: object) -> None:
        """Set the environment of a function whose module the process has."""
        if codegen._engine.get_global_value_address(name):  # else of a module that is linked only
            JITCPUCodegen.set_env(codegen, name, env)

    codegen._library_class, codegen.set_env = library, set_env
    try:
        yield
    finally:
        del codegen._library_class, codegen.set_env
