"""Parser of the YAML that users write: with limits, and without ambiguous values.

YAML 1.1 reads 010 as 8, 1:30 as 90 and 2020-01-01 as a date, takes the last of equal keys, and lets
twenty lines with aliases stand for more values than a computer holds.
"""

import re
from typing import Any

import yaml

from geometry.base.errors import SettingsError, shown

MOST_CHARACTERS = 2**19
MOST_VALUES = 20_000  # also where aliases repeat them; parsed in some seconds
DEEPEST = 32  # mappings and lists within one another
LONGEST_KEY = 100  # characters
TIMESTAMP, INT, FLOAT, *OF_KEYS = (
    f"tag:yaml.org,2002:{name}" for name in ("timestamp", "int", "float", "str", "merge")
)
# A number without leading zeros, which make it octal, and not in sixties, as 1:30. Whole ones have
# as many digits as Python reads; others have a point.
IN_DECIMALS = re.compile(r"[-+]?(0|[1-9](_*[0-9]){0,4299}_*)|[^:]*\.[^:]*")
WHOLE = re.compile(r"0|[1-9][0-9]{0,9}")  # a number that may be a key

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
        lines: dict[Keys, int] = {}
        _locate(node, (), lines)
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


_Loader.yaml_implicit_resolvers = {  # without dates: they are texts
    first: [(tag, pattern) for tag, pattern in resolvers if tag != TIMESTAMP]
    for first, resolvers in yaml.SafeLoader.yaml_implicit_resolvers.items()
}


def _locate(node: yaml.Node, keys: Keys, lines: dict[Keys, int]) -> None:
    """Add the lines of a node and of all below it, as often as aliases repeat them.

    Raises
    ------
    SettingsError
        When they are too many or too deep, a key is no name or given twice, or a number is not
        decimal.
    """
    lines[keys] = node.start_mark.line + 1
    _require_small(len(keys), len(lines), node.start_mark)
    if node.tag in (INT, FLOAT) and not IN_DECIMALS.fullmatch(node.value):
        raise _refused(
            f"{shown(node.value)}: is read by YAML as octal, hexadecimal, binary, in sixties, or "
            "is too long: write a number in decimals, a text in quotes",
            node.start_mark,
        )
    if isinstance(node, yaml.SequenceNode):
        for i, item in enumerate(node.value):
            _locate(item, (*keys, str(i)), lines)
    elif isinstance(node, yaml.MappingNode):
        for key, value in node.value:
            below = (*keys, _name(key))
            if below in lines:
                raise _refused(f"is not YAML: key {below[-1]!r} is given twice", key.start_mark)
            _locate(value, below, lines)


def _name(key: yaml.Node) -> str:
    """Text of a key; a whole number is its digits.

    Raises
    ------
    SettingsError
        When it is no text, or none for a line of a message.
    """
    if key.tag == INT and WHOLE.fullmatch(key.value):
        key.tag = OF_KEYS[0]
    if key.tag not in OF_KEYS:
        raise _refused(
            f"key {shown(key.value)}: is no name: write a text, in quotes if it is yes, no, on, "
            "off, or a number that is not whole",
            key.start_mark,
        )
    if not key.value.isprintable() or not 0 < len(key.value) <= LONGEST_KEY:
        raise _refused(f"key {shown(key.value)}: is no name", key.start_mark)
    return key.value
