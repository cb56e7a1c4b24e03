"""Inner functions of a kernel are linked into it, and into nothing else.

numba optimises the module of each compiled function, turns it into machine code and makes that
known to the process. Those of a kernel are inlined into it: only its own module, which theirs are
linked into, is ever run. Without the rest a kernel takes two thirds of the time to compile, and is
the same to the bit. This needs private parts of numba; without them it compiles as numba does.
"""

from collections.abc import Iterator
from contextlib import contextmanager

from numba.core.codegen import JITCodeLibrary, JITCPUCodegen
from numba.core.dispatcher import Dispatcher

PRIVATE = (
    (JITCodeLibrary, "_optimize_final_module"),
    (JITCodeLibrary, "_finalize_final_module"),
    (JITCPUCodegen, "_library_class"),
    (JITCPUCodegen, "set_env"),
)


class _LinkOnly(JITCodeLibrary):
    """Module of an inner function: neither optimised nor made known to the process."""

    def _optimize_final_module(self) -> None:
        pass

    def _finalize_final_module(self) -> None:
        self._finalized = True


@contextmanager
def linked_into(kernel: Dispatcher) -> Iterator[None]:
    """Compile all but ``kernel`` itself, in the block, to be linked only."""
    if not all(hasattr(of, name) for of, name in PRIVATE):
        yield
        return
    codegen = kernel.targetctx.codegen()

    def library(of: JITCPUCodegen, name: str) -> JITCodeLibrary:
        return (JITCodeLibrary if name == kernel.py_func.__qualname__ else _LinkOnly)(of, name)

    def set_env(name: str, env: object) -> None:
        if codegen._engine.get_global_value_address(name):  # else of a module that is linked only
            JITCPUCodegen.set_env(codegen, name, env)

    codegen._library_class, codegen.set_env = library, set_env
    try:
        yield
    finally:
        del codegen._library_class, codegen.set_env
