"""All of UFL is Any for pyright, which finds that its operators return None."""

from typing import Any

def __getattr__(name: str) -> Any: ...
