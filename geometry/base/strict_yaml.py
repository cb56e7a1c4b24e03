"""Parser of the YAML that users write: with limits, and without ambiguous values.

YAML 1.1 reads 010 as 8, 1:30 as 90 and 2020-01-01 as a date, takes the last of equal keys, and lets
twenty lines with aliases stand for more values than a computer holds.
"""

import re
from collections.abc import Iterator
from contextlib import suppress
from typing import Any

import yaml

from geometry.base.errors import SettingsError, shown

MOST_CHARACTERS = 2**19
MOST_VALUES = 20_000  # also where aliases repeat them; parsed in some seconds
DEEPEST = 32  # mappings and lists within one another
LONGEST_KEY = 100  # characters
TIMESTAMP, INT, FLOAT = (f"tag:yaml.org,2002:{name}" for name in ("timestamp", "int", "float"))
# numbers without leading zeros, which make them octal, and none in sixties, as 1:30
IN_DECIMALS = {INT: re.compile(r"[-+]?(0|[1-9][0-9_]*)"), FLOAT: re.compile(r"[^:]*")}

type Keys = tuple[str, ...]  # from the root, items of lists by their numbers


def parse(text: str) -> tuple[Any, dict[Keys, int]]:
    r"""Value of a YAML text, and the number of the line of each value in it.

    >>> parse("rounds: 20\nspeeds: {over_f1: [0.3]}")[0]
    {'rounds': 20, 'speeds': {'over_f1': [0.3]}}
    >>> parse("rounds: 20\nspeeds: {over_f1: [0.3]}")[1]["speeds", "over_f1", "0"]
    2

    Raises
    ------
    SettingsError
        When it is no YAML, exceeds a limit, has tags, equal keys or keys that are no names, or
        whole numbers that are not decimal.
    """
    if len(text) > MOST_CHARACTERS:
        raise SettingsError(f"has {len(text)} characters: allowed up to {MOST_CHARACTERS}")
    try:
        loader = _Loader(text)
        node = loader.get_single_node()
        if node is None:
            return None, {}
        lines = _lines(node)
        return loader.construct_document(node), lines
    except yaml.MarkedYAMLError as error:
        words = " ".join(filter(None, (error.context, error.problem)))
        fault = f"is not YAML: {' '.join(words.split())}"
        raise _refused(fault, error.problem_mark) from None
    except yaml.YAMLError as error:
        fault = " ".join(str(error).replace('in "<unicode string>", ', "").split())
        raise SettingsError(f"is not YAML: {fault}") from None


def _refused(fault: str, mark: yaml.Mark) -> SettingsError:
    """The error of a fault at a place of the text."""
    return SettingsError(fault, line=mark.line + 1)


def _require_small(depth: int, values: int, mark: yaml.Mark) -> None:
    """Refuse a text with too many ``values``, or one too deep within others."""
    if depth > DEEPEST:
        raise _refused(f"is nested deeper than {DEEPEST} levels, with its aliases", mark)
    if values > MOST_VALUES:
        raise _refused(f"has more than {MOST_VALUES} values, with its aliases", mark)


class _Loader(yaml.SafeLoader):
    """Loader of the values that settings have, nested no deeper than ``DEEPEST``."""

    depth = 0
    values = 0

    def compose_node(self, parent: Any, index: Any) -> yaml.Node:
        """The next node, unless it is too deep, one too many, or has a tag."""
        event = self.peek_event()
        self.depth, self.values = self.depth + 1, self.values + 1
        _require_small(self.depth, self.values, event.start_mark)
        if tag := getattr(event, "tag", None):
            fault = f"has the tag {shown(tag)}: write the value alone, a text in quotes"
            raise _refused(fault, event.start_mark)
        node = super().compose_node(parent, index)
        self.depth -= 1
        return node

    def number(self, node: yaml.ScalarNode) -> float:
        """A number that is given in decimals."""
        with suppress(ValueError):  # Python's limit of digits
            if IN_DECIMALS[node.tag].fullmatch(node.value):
                return yaml.SafeLoader.yaml_constructors[node.tag](self, node)
        raise _refused(
            f"{shown(node.value)}: is read by YAML as octal, hexadecimal, binary, in sixties, or "
            "is too long: write a number in decimals, a text in quotes",
            node.start_mark,
        )


_Loader.yaml_constructors = yaml.SafeLoader.yaml_constructors | dict.fromkeys(
    IN_DECIMALS, _Loader.number
)
_Loader.yaml_implicit_resolvers = {  # without dates: they are texts
    first: [(tag, pattern) for tag, pattern in resolvers if tag != TIMESTAMP]
    for first, resolvers in yaml.SafeLoader.yaml_implicit_resolvers.items()
}


def _lines(root: yaml.Node) -> dict[Keys, int]:
    """Line of each value, counted as often as aliases repeat it."""
    lines: dict[Keys, int] = {}
    for keys, node in _walk(root, ()):
        lines[keys] = node.start_mark.line + 1
        _require_small(len(keys), len(lines), node.start_mark)
    return lines


def _walk(node: yaml.Node, keys: Keys) -> Iterator[tuple[Keys, yaml.Node]]:
    """All nodes below one, with their keys."""
    yield keys, node
    if isinstance(node, yaml.SequenceNode):
        for i, item in enumerate(node.value):
            yield from _walk(item, (*keys, str(i)))
    elif isinstance(node, yaml.MappingNode):
        seen = set()
        for key, value in node.value:
            name = _name(key)
            if name in seen:
                raise _refused(f"is not YAML: key {name!r} is given twice", key.start_mark)
            seen.add(name)
            yield from _walk(value, (*keys, name))


def _name(key: yaml.Node) -> str:
    """Text of a key.

    Raises
    ------
    SettingsError
        When it is no text, or none for a line of a message.
    """
    merge = key.tag.endswith(":merge")
    if not isinstance(key, yaml.ScalarNode) or not (key.tag.endswith(":str") or merge):
        raise _refused(
            f"key {shown(getattr(key, 'value', key.tag))}: is no name: write a text, in quotes if "
            "it is a number, yes, no, on or off",
            key.start_mark,
        )
    if not key.value.isprintable() or not 0 < len(key.value) <= LONGEST_KEY:
        raise _refused(f"key {shown(key.value)}: is no name", key.start_mark)
    return key.value
