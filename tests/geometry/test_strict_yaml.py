"""YAML that is read, and what is refused: beyond limits, tags, numbers that are not decimal."""

import time

import pytest
from refused import refused

from geometry.base import MOST_CHARACTERS, MOST_VALUES, SettingsError, parse

BOMB = "a: &a [x,x,x,x,x,x,x,x,x]\n" + "".join(
    f"{name}: &{name} [{','.join([f'*{below}'] * 9)}]\n"
    for below, name in zip("abcdefgh", "bcdefghi", strict=True)
)


def test_whole_number_as_a_key_is_its_digits():
    """As of modes, where a mapping has one for each."""
    assert parse("{1: 612, 12: x}")[0] == {"1": 612, "12": "x"}


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("a: 2020-01-01", "2020-01-01"),  # YAML's date
        ("a: 1_000", 1000),
        ("a: -0", 0),
        ("a: 1.5e+3", 1500.0),
        ("a: '010'", "010"),
        ("a: &b [1, 2]\nc: *b", [1, 2]),
        ("\ufeffa: 1", 1),
    ],
)
def test_value_that_is_read(text, value):
    assert parse(text)[0]["a"] == value


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("a: 1\nb: 010", 2),  # octal
        ("a: 0x_", 1),
        ("a: 1:30", 1),  # in sixties
        ("a: 1:30.5", 1),
        ("a: " + "1" * 5000, 1),
        ("a: !!int abc", 1),
        ("a: !!null 5", 1),
        ("a: [1,\nb: 2", 2),
        ("a: 1\nb: {c: 1,\n c: 2}", 3),
        ("7.5: a", 1),
        ("07: a", 1),
        ('7: a\n"7": b', 2),
        ("on: a", 1),
        ("[a]: 1", 1),
        ('"a\\nb": 1', 1),
        ("k" * 101 + ": 1", 1),
        ("[" * 3000, 1),
        ("&a [*a]", 1),
        ("a: &a {b: *a}", 1),
        (BOMB, 1),
        ("a: [" + "1," * (MOST_VALUES + 1) + "]", 1),
        ("#" * (MOST_CHARACTERS + 1), None),
        ("--- a\n--- b", 2),
        ("a: \x07", None),
    ],
)
def test_text_that_is_refused_in_one_line(text, line):
    start = time.process_time()
    error = refused(SettingsError, parse, text)
    assert error.line == line
    assert len(str(error)) < 300
    assert time.process_time() - start < 10


def test_lines_are_those_of_the_values():
    text = "# one\na: 1\nb:\n  c: [3,\n    4]\n  d: {e: x}\n"
    assert parse(text)[1] == {
        (): 2,
        ("a",): 2,
        ("b",): 4,
        ("b", "c"): 4,
        ("b", "c", "0"): 4,
        ("b", "c", "1"): 5,
        ("b", "d"): 6,
        ("b", "d", "e"): 6,
    }
