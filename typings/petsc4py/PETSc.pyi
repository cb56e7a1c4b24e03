"""All of PETSc is Any for pyright: its own stubs know neither arrays nor the types of constants."""

from typing import Any

def __getattr__(name: str) -> Any: ...
