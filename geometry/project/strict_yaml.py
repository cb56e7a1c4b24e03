"""Parser of the YAML that users write: with limits, and without what is read as something else.

YAML 1.1 reads 010 as 8, 1:30 as 90 and 2020-01-01 as a date, takes the last of equal keys, and lets
twenty lines with aliases stand for more values than a computer holds.
"""

import re
from collections.abc import Iterator
from typing import Any

import yaml

from geometry.project.errors import SettingsError, shown

MOST_CHARACTERS = 2**19
MOST_VALUES = 20_000  # also where aliases repeat them; parsed in some seconds
DEEPEST = 32  # mappings and lists within one another
LONGEST_KEY = 100  # characters
DECIMAL = re.compile(r"[-+]?(0|[1-9][0-9_]*)")
TIMESTAMP, INT, FLOAT = (f"tag:yaml.org,2002:{name}" for name in ("timestamp", "int", "float"))

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
        raise SettingsError(fault, line=error.problem_mark.line + 1) from None
    except yaml.YAMLError as error:
        fault = " ".join(str(error).replace('in "<unicode string>", ', "").split())
        raise SettingsError(f"is not YAML: {fault}") from None


class _Loader(yaml.SafeLoader):
    """Loader of the values that settings have, nested no deeper than ``DEEPEST``."""

    depth = 0
    values = 0

    def compose_node(self, parent: Any, index: Any) -> yaml.Node:
        event = self.peek_event()
        self.depth, self.values = self.depth + 1, self.values + 1
        if self.depth > DEEPEST:
            raise SettingsError(
                f"is nested deeper than {DEEPEST} levels", line=event.start_mark.line + 1
            )
        if self.values > MOST_VALUES:
            raise SettingsError(
                f"has more than {MOST_VALUES} values", line=event.start_mark.line + 1
            )
        if tag := getattr(event, "tag", None):
            raise SettingsError(
                f"has the tag {shown(tag)}: write the value alone, a text in quotes",
                line=event.start_mark.line + 1,
            )
        node = super().compose_node(parent, index)
        self.depth -= 1
        return node

    def decimal(self, node: yaml.ScalarNode) -> int:
        """A whole number without leading zeros, which would make it octal."""
        try:
            if DECIMAL.fullmatch(node.value):
                return self.construct_yaml_int(node)
        except ValueError:  # Python's limit of digits
            pass
        raise SettingsError(
            f"{shown(node.value)}: is read by YAML as octal, hexadecimal, binary, in sixties, or "
            "is too long: write a whole number in decimals, a text in quotes",
            line=node.start_mark.line + 1,
        )

    def fraction(self, node: yaml.ScalarNode) -> float:
        """A number, not in sixties."""
        if ":" in node.value:
            raise SettingsError(
                f"{shown(node.value)}: is read by YAML in sixties: write a number in decimals, "
                "a text in quotes",
                line=node.start_mark.line + 1,
            )
        return self.construct_yaml_float(node)


_Loader.add_constructor(INT, _Loader.decimal)
_Loader.add_constructor(FLOAT, _Loader.fraction)
_Loader.yaml_implicit_resolvers = {  # without dates: they are texts
    first: [(tag, pattern) for tag, pattern in resolvers if tag != TIMESTAMP]
    for first, resolvers in yaml.SafeLoader.yaml_implicit_resolvers.items()
}


def _lines(root: yaml.Node) -> dict[Keys, int]:
    """Line of each value, counted as often as aliases repeat it."""
    lines: dict[Keys, int] = {}
    for count, (keys, node) in enumerate(_walk(root, ()), 1):
        if count > MOST_VALUES:
            raise SettingsError(
                f"stands for more than {MOST_VALUES} values by its aliases",
                line=root.start_mark.line + 1,
            )
        lines[keys] = node.start_mark.line + 1
    return lines


def _walk(node: yaml.Node, keys: Keys) -> Iterator[tuple[Keys, yaml.Node]]:
    """All nodes below one, with their keys."""
    yield keys, node
    if len(keys) > DEEPEST:
        raise SettingsError(
            f"is nested deeper than {DEEPEST} levels by an alias", line=node.start_mark.line + 1
        )
    if isinstance(node, yaml.SequenceNode):
        for i, item in enumerate(node.value):
            yield from _walk(item, (*keys, str(i)))
    elif isinstance(node, yaml.MappingNode):
        seen = set()
        for key, value in node.value:
            name = _name(key)
            if name in seen:
                raise SettingsError(
                    f"is not YAML: key {name!r} is given twice", line=key.start_mark.line + 1
                )
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
        raise SettingsError(
            f"key {shown(getattr(key, 'value', key.tag))}: is no name: write a text, in quotes if "
            "it is a number, yes, no, on or off",
            line=key.start_mark.line + 1,
        )
    if not key.value.isprintable() or not 0 < len(key.value) <= LONGEST_KEY:
        raise SettingsError(f"key {shown(key.value)}: is no name", line=key.start_mark.line + 1)
    return key.value
