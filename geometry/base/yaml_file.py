"""YAML files as mappings, with the values of the file that each names as its base."""

import os
import re
from copy import deepcopy
from functools import lru_cache
from pathlib import Path
from typing import Any, NamedTuple

from geometry.base.errors import SettingsError, require
from geometry.base.strict_yaml import Keys, parse
from geometry.base.text_file import read_text
from geometry.base.units import as_in

BASE = "base"
VARIANTS = "variants.yaml"  # holds the contents of further files, by name
DISCRIMINATORS = ("kind", "scheme")  # a mapping with another value of these replaces the base's
NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9_-]{0,99}", re.ASCII)  # of a blade, scene or base
A_NAME = "a name has letters, digits, - and _, 100 at most, and no folder"
MOST_BASES = 20  # below one another
MOST_BYTES = 2**22


_parsed = lru_cache(64)(parse)  # a file of variants is read for each of them


class Layer(NamedTuple):
    """A file with the values of its bases."""

    source: str  # the file, and the name of a variant, for messages
    values: dict[str, Any]
    lines: dict[Keys, int]  # of its own text


def read_mapping(path: str | Path) -> dict[str, Any]:
    """Keys and values of a YAML file; if it does not exist, of its name in variants.yaml.

    With `base: NAME` the file has only the differences from NAME.yaml in the same folder: its own
    keys, in all nested mappings, and for all others those of the base. A list, or a mapping of
    another `kind` or `scheme`, replaces that of the base entirely; a key set to null is removed.

    Raises
    ------
    SettingsError
        When a file is missing, is no YAML mapping, or is its own base.
    """
    return read_layers(path)[0].values


def read_layers(path: str | Path) -> list[Layer]:
    """A YAML file, its base, the base of that one, and so on, each with the values of its bases.

    Raises
    ------
    SettingsError
        As ``read_mapping``.
    """
    return _layers([Path(path)])


def names(folder: str | Path) -> list[str]:
    """Names that ``read_mapping`` can read in a folder: files and variants, without `.yaml`.

    Those that are no ``NAME`` are left out: they could be no part of a path or pattern.

    Raises
    ------
    SettingsError
        When variants.yaml is no YAML mapping.
    """
    files = {path.stem for path in Path(folder).glob("*.yaml") if path.name != VARIANTS}
    return sorted(filter(NAME.fullmatch, files | _variants(Path(folder)).values.keys()))


def merged(base: Any, values: Any) -> Any:
    """``base`` updated by ``values``, recursively, without the keys that are null.

    A key of ``values`` stands for the same quantity in another unit, too.
    """
    if not (isinstance(base, dict) and isinstance(values, dict)):
        return values
    if any(key in base and values.get(key, base[key]) != base[key] for key in DISCRIMINATORS):
        return values
    base = as_in(base, values)
    both = base | {key: merged(base.get(key), value) for key, value in values.items()}
    return {key: value for key, value in both.items() if value is not None}


def _layers(chain: list[Path]) -> list[Layer]:
    """Layers of the last of ``chain``, each of which is based on the next."""
    text = _text(chain[-1])
    base = _base(chain, text)
    if base is None:
        return [text]
    below = _layers([*chain, base])
    return [text._replace(values=merged(below[0].values, text.values)), *below]


def _base(chain: list[Path], text: Layer) -> Path | None:
    """The file that the last of ``chain`` is based on, and which its values no longer name."""
    if BASE not in text.values:
        return None
    name = text.values.pop(BASE)
    about = {"key": BASE, "value": name, "file": text.source, "line": text.lines.get((BASE,))}
    named = isinstance(name, str) and NAME.fullmatch(name)
    require((named, f"needs the name of a file; {A_NAME}"), kind=SettingsError, **about)
    base = chain[-1].with_name(f"{name}.yaml")
    require(
        (base not in chain, "comes back to itself"),
        (
            os.path.exists(base) or name in _variants(base.parent).values,
            f"needs the name of a file, no {base}",
        ),
        (len(chain) <= MOST_BASES, f"is one of more than {MOST_BASES} bases"),
        kind=SettingsError,
        **about,
    )
    return base


def _variants(folder: Path) -> Layer:
    file = folder / VARIANTS
    return _load(file) if os.path.exists(file) else Layer(str(file), {}, {})


def _text(path: Path) -> Layer:
    """A file, or where there is none the variant of its name, without its bases."""
    name = path.stem
    if os.path.exists(path) or name not in (variants := _variants(path.parent)).values:
        return _load(path)
    lines = {keys[1:]: line for keys, line in variants.lines.items() if keys[:1] == (name,)}
    return _layer(f"{variants.source}: {name}", variants.values[name], lines)


def _layer(source: str, values: Any, lines: dict[Keys, int]) -> Layer:
    """The mapping of a file or variant; other values are refused."""
    require(
        (isinstance(values, dict), "holds no 'key: value' lines"),
        kind=SettingsError,
        file=source,
        line=lines.get(()),
    )
    return Layer(source, values, lines)


def _load(path: Path) -> Layer:
    try:
        values, lines = _parsed(read_text(path, MOST_BYTES))
    except SettingsError as error:
        raise error.within(path) from None
    return _layer(str(path), deepcopy(values), lines)
