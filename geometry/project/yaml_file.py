"""YAML files as mappings, with the values of the file that each names as its base."""

import os
import re
from pathlib import Path
from typing import Any, NamedTuple

from geometry.project.errors import Fault, SettingsError
from geometry.project.strict_yaml import Keys, parse
from geometry.project.text_file import read_text

BASE = "base"
VARIANTS = "variants.yaml"  # holds the contents of further files, by name
DISCRIMINATORS = ("kind", "scheme")  # a mapping with another value of these replaces the base's
NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9_-]{0,99}", re.ASCII)  # of a blade, scene or base
A_NAME = "a name has letters, digits, - and _, 100 at most, and no folder"
MOST_BASES = 20  # below one another
MOST_BYTES = 2**22


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
    chain, texts = [Path(path)], [_text(Path(path))]
    while base := _base(chain, texts[-1]):
        chain.append(base)
        texts.append(_text(base))
    layers: list[Layer] = []
    for text in reversed(texts):
        below = layers[-1].values if layers else {}
        layers.append(text._replace(values=merged(below, text.values) if layers else text.values))
    return layers[::-1]


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
    """``base`` updated by ``values``, recursively, without the keys that are null."""
    if not (isinstance(base, dict) and isinstance(values, dict)):
        return values
    if any(key in base and values.get(key, base[key]) != base[key] for key in DISCRIMINATORS):
        return values
    both = base | {key: merged(base.get(key), value) for key, value in values.items()}
    return {key: value for key, value in both.items() if value is not None}


def _base(chain: list[Path], text: Layer) -> Path | None:
    """The file that the last of ``chain`` is based on, and which its values no longer name."""
    if BASE not in text.values:
        return None
    name = text.values.pop(BASE)
    fault = Fault("", BASE, name, file=text.source, line=text.lines.get((BASE,)))
    if not isinstance(name, str) or not NAME.fullmatch(name):
        raise SettingsError(fault, text=f"needs the name of a file; {A_NAME}")
    base = chain[-1].with_name(f"{name}.yaml")
    if base in chain:
        raise SettingsError(fault, text="comes back to itself")
    if not os.path.exists(base) and name not in _variants(base.parent).values:
        raise SettingsError(fault, text=f"needs the name of a file, no {base}")
    if len(chain) > MOST_BASES:
        raise SettingsError(fault, text=f"is one of more than {MOST_BASES} bases")
    return base


def _variants(folder: Path) -> Layer:
    file = folder / VARIANTS
    return _load(file) if os.path.exists(file) else Layer(str(file), {}, {})


def _text(path: Path) -> Layer:
    """A file, or its variant, without its bases."""
    if not os.path.exists(path):
        variants = _variants(path.parent)
        if path.stem in variants.values:
            return _variant(variants, path.stem)
    return _load(path)


def _variant(variants: Layer, name: str) -> Layer:
    lines = {keys[1:]: line for keys, line in variants.lines.items() if keys[:1] == (name,)}
    source = f"{variants.source}: {name}"
    return Layer(source, _mapping(variants.values[name], source, lines), lines)


def _mapping(values: Any, source: str, lines: dict[Keys, int]) -> dict[str, Any]:
    if not isinstance(values, dict):
        raise SettingsError("holds no 'key: value' lines", file=source, line=lines.get(()))
    return values


def _load(path: Path) -> Layer:
    try:
        values, lines = parse(read_text(path, MOST_BYTES))
    except SettingsError as error:
        raise error.within(path) from None
    return Layer(str(path), _mapping(values, str(path), lines), lines)
