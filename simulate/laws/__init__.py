"""Liner laws, one to a file: a new file here is a new law, under the name in its ``kind``."""

from importlib import import_module
from pkgutil import iter_modules

from geometry.settings import one_of
from simulate.law import Law

_modules = [import_module(f"{__name__}.{module.name}") for module in iter_modules(__path__)]

LAWS: tuple[type[Law], ...] = tuple(
    law
    for module in _modules
    for law in vars(module).values()
    if isinstance(law, type) and issubclass(law, Law) and law.__module__ == module.__name__
)
AnyLaw = one_of("law", "kind", *LAWS)
