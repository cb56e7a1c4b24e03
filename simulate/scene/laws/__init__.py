"""Liner laws, one per file: a new file here adds a law, under the name in its ``kind``.

A law of one's own is named ``module:class`` (``simulate.scene.own_laws``).
"""

from collections.abc import Callable
from importlib import import_module
from pkgutil import iter_modules
from typing import Annotated, Any, Union

from pydantic import GetPydanticSchema, WrapSerializer, WrapValidator

from geometry.base import one_of
from simulate.scene import own_laws
from simulate.scene.law import Law

_modules = [import_module(f"{__name__}.{module.name}") for module in iter_modules(__path__)]

LAWS: tuple[type[Law], ...] = tuple(
    law
    for module in _modules
    for law in vars(module).values()
    if isinstance(law, type) and issubclass(law, Law) and law.__module__ == module.__name__
)


def _from_elsewhere(value: Any, of_ours: Callable[[Any], Law]) -> Law:
    """``value`` if it is a law, the law that ``module:class`` names, or one of ``LAWS``."""
    if isinstance(value, Law) and not isinstance(value, LAWS):
        return value
    if isinstance(value, type) and issubclass(value, Law):
        numbers = ", ".join(f"{name}=..." for name in value.model_fields if name != "kind")
        raise ValueError(f"a class: give a law with its numbers, {value.__name__}({numbers})")
    if not (isinstance(value, dict) and isinstance(kind := value.get("kind"), str) and ":" in kind):
        return of_ours(value)
    law = own_laws.named(kind, value.get("hash"))
    return law.model_validate({key: of for key, of in value.items() if key not in ("kind", "hash")})


def _with_kind(law: Law, plain: Callable[[Law], Any]) -> Any:
    """Parameters and ``kind`` of a law, as plain values; of one's own with the hash of its code."""
    if isinstance(law, LAWS):
        return plain(law)
    of_code = {"hash": law.code_hash} if law.code_hash else {}
    return {"kind": law.called, **of_code, **law.model_dump()}


AnyLaw = Annotated[
    Law,
    GetPydanticSchema(lambda _, schema_of: schema_of(Union[LAWS])),  # noqa: UP007
    one_of("law", "kind", *LAWS),
    WrapValidator(_from_elsewhere),
    WrapSerializer(_with_kind),
]
