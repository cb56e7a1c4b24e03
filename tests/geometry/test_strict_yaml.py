"""YAML that is read, and what is refused: beyond limits, tags, numbers that are not decimal."""

import time

import pytest

from geometry.strict_yaml import MOST_CHARACTERS, MOST_VALUES, StrictError, parse

BOMB = "a: &a [x,x,x,x,x,x,x,x,x]\n" + "".join(
    f"{name}: &{name} [{','.join([f'*{below}'] * 9)}]\n"
    for below, name in zip("abcdefgh", "bcdefghi", strict=True)
)


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
    ("text", "words"),
    [
        (
            "a: 1\nb: 010",
            "'010': is read by YAML as octal, .* write a whole number .* \\(line 2\\)",
        ),
        ("a: 0x_", "'0x_': is read by YAML as octal"),
        ("a: 1:30", "'1:30': is read by YAML as octal, hexadecimal, binary, in sixties"),
        ("a: 1:30.5", "'1:30.5': is read by YAML in sixties: write a number"),
        ("a: " + "1" * 5000, "'1111.*1...: is read by YAML as .* or is too long"),
        ("a: !!int abc", "has the tag 'tag:yaml.org,2002:int': write the value alone"),
        ("a: !!null 5", "has the tag"),
        ("a: [1,\nb: 2", r"is not YAML: while parsing a flow sequence .* \(line 2\)"),
        ("a: 1\nb: {c: 1,\n c: 2}", r"key 'c' is given twice \(line 3\)"),
        ("7: a", "key '7': is no name: write a text, in quotes if it is a number"),
        ("on: a", "key 'on': is no name"),
        ("[a]: 1", "key .*: is no name"),
        ('"a\\nb": 1', r"key 'a\\nb': is no name"),
        ("k" * 101 + ": 1", "is no name"),
        ("[" * 3000, "is nested deeper than 32 levels"),
        ("&a [*a]", "is nested deeper than 32 levels by an alias"),
        ("a: &a {b: *a}", "is nested deeper than 32 levels by an alias"),
        (BOMB, f"stands for more than {MOST_VALUES} values by its aliases"),
        ("a: [" + "1," * (MOST_VALUES + 1) + "]", f"has more than {MOST_VALUES} values"),
        ("#" * (MOST_CHARACTERS + 1), f"has {MOST_CHARACTERS + 1} characters: allowed up to"),
        ("--- a\n--- b", "expected a single document"),
        ("a: \x07", "is not YAML: unacceptable character #x0007"),
    ],
)
def test_text_that_is_refused_in_one_line(text, words):
    start = time.process_time()
    with pytest.raises(StrictError, match=words) as caught:
        parse(text)
    assert "\n" not in str(caught.value)
    assert len(str(caught.value)) < 300
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
