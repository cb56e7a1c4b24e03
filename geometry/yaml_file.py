"""YAML files as mappings, with the values of the file that each names as its base."""

from pathlib import Path
from typing import Any

import yaml

from geometry.errors import SettingsError

BASE = "base"
VARIANTS = "variants.yaml"  # holds the contents of further files, by name
DISCRIMINATORS = ("kind", "scheme")  # a mapping with another value of these replaces the base's


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
    return _on_base(Path(path), [])


def names(folder: str | Path) -> list[str]:
    """Names that ``read_mapping`` can read in a folder: files and variants, without `.yaml`.

    Raises
    ------
    SettingsError
        When variants.yaml is no YAML mapping.
    """
    files = {path.stem for path in Path(folder).glob("*.yaml") if path.name != VARIANTS}
    return sorted(files | _variants(Path(folder)).keys())


def _on_base(path: Path, above: list[Path]) -> dict[str, Any]:
    if path in above:
        raise SettingsError(f"{above[0]}: base: {path.stem!r}: comes back to itself")
    values = _values(path)
    if BASE not in values:
        return values
    name = values.pop(BASE)
    base = path.with_name(f"{name}.yaml")
    if name not in names(path.parent):
        raise SettingsError(f"{path}: base: {name!r}: needs the name of a file, no {base}")
    return merged(_on_base(base, [*above, path]), values)


def merged(base: Any, values: Any) -> Any:
    """``base`` updated by ``values``, recursively, without the keys that are null."""
    if not (isinstance(base, dict) and isinstance(values, dict)):
        return values
    if any(key in base and values.get(key, base[key]) != base[key] for key in DISCRIMINATORS):
        return values
    both = base | {key: merged(base.get(key), value) for key, value in values.items()}
    return {key: value for key, value in both.items() if value is not None}


class _UniqueKeys(yaml.SafeLoader):
    """Loader that refuses duplicate keys, as YAML requires; PyYAML would keep the last one."""

    def construct_mapping(self, node: yaml.MappingNode, deep: bool = False) -> dict[Any, Any]:
        seen = set()
        for key in (key for key, _ in node.value if isinstance(key, yaml.ScalarNode)):
            if key.value in seen:
                raise yaml.constructor.ConstructorError(
                    problem=f"key '{key.value}' is given twice", problem_mark=key.start_mark
                )
            seen.add(key.value)
        return super().construct_mapping(node, deep)


def _variants(folder: Path) -> dict[str, Any]:
    file = folder / VARIANTS
    return _load(file) if file.is_file() else {}


def _values(path: Path) -> dict[str, Any]:
    variants = {} if path.is_file() else _variants(path.parent)
    if path.stem in variants:
        return _mapping(variants[path.stem], path)
    return _load(path)


def _mapping(values: Any, path: Path) -> dict[str, Any]:
    if not isinstance(values, dict):
        raise SettingsError(f"{path}: holds no 'key: value' lines")
    return values


def parsed(text: str, path: Path) -> dict[str, Any]:
    """Keys and values of the text of a file, without those of a base.

    Raises
    ------
    SettingsError
        When it is no YAML mapping; the message names ``path``.
    """
    try:
        values = yaml.load(text, _UniqueKeys)
    except yaml.YAMLError as error:
        raise SettingsError(f"{path}: is not YAML: {' '.join(str(error).split())}") from None
    return _mapping(values, path)


def _load(path: Path) -> dict[str, Any]:
    try:
        text = path.read_text(encoding="utf-8")
    except OSError as error:
        raise SettingsError(f"{path}: cannot be read ({error.strerror})") from None
    except UnicodeDecodeError:
        raise SettingsError(f"{path}: is not YAML: no UTF-8 text") from None
    return parsed(text, path)
