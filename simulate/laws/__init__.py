"""Liner laws, one to a file: a new file here is a new law, under the name in its ``kind``."""

from importlib import import_module
from pkgutil import iter_modules

from geometry.settings import one_of
from simulate.law import Law

for _module in iter_modules(__path__):
    import_module(f"{__name__}.{_module.name}")

LAWS: tuple[type[Law], ...] = tuple(sorted(Law.__subclasses__(), key=lambda law: law.__name__))
AnyLaw = one_of("law", "kind", *LAWS)
