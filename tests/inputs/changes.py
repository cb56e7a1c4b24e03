"""Changes of any file, as people and accidents make them: what was done, and the content then."""

import re
from collections.abc import Sequence

from case import Content
from hypothesis import strategies as st

type Changed = st.SearchStrategy[tuple[str, str]]

TEXT = st.text(max_size=8)
MANY = 131_000  # below what csv allows a cell, 131072
LONG = {  # what takes time where a pattern goes back, or a stack, or has digits that nothing holds
    **{f"only {c}": c * MANY for c in "1 \t\n,[('#$*-x"},
    "digits, then none": "1" * MANY + "x",
    "digits of a fraction": "1." + "1" * MANY + "e",
    "digits of an exponent": "1e" + "9" * MANY,
    "too large": "1e400",
    "blanks, then no number": "1" + " " * MANY + "x",
    "open quotes": '"' * (MANY + 1),
    "braces": '{"a":' * 100_000,
    "a long line": "x " * 2**22,
}
SIZES = ("1000000000000", "99999999", "4294967296", str(2**63), "9" * 400, "-1", "0")


@st.composite
def line(draw: st.DrawFn, text: str, rows: Sequence[int], *hows: str) -> tuple[str, str]:
    """One of the lines ``rows`` lost, written twice, cut, indented otherwise or exchanged."""
    lines, how, n = text.split("\n"), draw(st.sampled_from(hows)), draw(st.integers(0, 60))
    i, j = draw(st.sampled_from(rows)), draw(st.sampled_from(rows))
    one, other = lines[i], lines[j]
    new = {
        "lost": [],
        "twice": [one, one],
        "cut": [one[:n]],
        "indented": [" " * (n % 7) + one.lstrip()],
        "exchanged": [other],
    }
    lines[j] = one if how == "exchanged" else other
    lines[i : i + 1] = new[how]
    return f"line {how}", "\n".join(lines)


@st.composite
def lines_lost(draw: st.DrawFn, text: str, rows: Sequence[int], *counts: int) -> tuple[str, str]:
    """Several lines lost, from one of ``rows`` on."""
    lines, first = text.split("\n"), draw(st.sampled_from(rows))
    del lines[first : first + draw(st.sampled_from(counts))]
    return "lines lost", "\n".join(lines)


@st.composite
def other_line(
    draw: st.DrawFn, text: str, rows: Sequence[int], odd: Sequence[str]
) -> tuple[str, str]:
    """One of the lines ``rows`` replaced by an odd one, or by random text."""
    lines = text.split("\n")
    lines[draw(st.sampled_from(rows))] = draw(st.sampled_from(odd) | TEXT)
    return "line changed", "\n".join(lines)


@st.composite
def cell(
    draw: st.DrawFn,
    text: str,
    rows: Sequence[int],
    odd: Sequence[str],
    random: st.SearchStrategy[str] = TEXT,
) -> tuple[str, str]:
    """A cell of one of the lines ``rows`` replaced as ``other_line``."""
    lines, i = text.split("\n"), draw(st.sampled_from(rows))
    cells = lines[i].split(",")
    cells[draw(st.integers(0, len(cells) - 1))] = draw(st.sampled_from(odd) | random)
    lines[i] = ",".join(cells)
    return "cell changed", "\n".join(lines)


@st.composite
def long(draw: st.DrawFn, text: str, rows: Sequence[int]) -> tuple[str, str]:
    """A cell, or what is between two, of one of the lines ``rows`` replaced by very much."""
    lines, i = text.split("\n"), draw(st.sampled_from(rows))
    name, cells = draw(st.sampled_from(sorted(LONG))), re.split(r"([,\s]+)", lines[i])
    cells[draw(st.integers(0, len(cells) - 1))] = LONG[name]
    lines[i] = "".join(cells)
    return f"long: {name}", "\n".join(lines)


@st.composite
def size(draw: st.DrawFn, text: str, *patterns: str) -> tuple[str, str]:
    """A number in one of the groups of ``patterns`` replaced by one far above what is there."""
    found = list(re.finditer(draw(st.sampled_from(patterns)), text, re.MULTILINE))
    place = draw(st.sampled_from(found))
    begin, end = place.span(draw(st.integers(1, len(place.groups()))))
    new = draw(st.sampled_from((*SIZES, "9" * (end - begin))))
    return "size", text[:begin] + new.rjust(end - begin) + text[end:]


@st.composite
def binary(draw: st.DrawFn, data: bytes) -> tuple[str, bytes]:
    """Bytes changed, lost, or replaced by the largest numbers."""
    how, at = draw(st.sampled_from(("flipped", "lost", "cut", "zero", "ones"))), 0
    for _ in range(draw(st.integers(1, 3))):
        at = draw(st.integers(0, len(data) - 1))
        n = draw(st.sampled_from((1, 8, 512)))
        new = {"lost": b"", "zero": bytes(n), "ones": b"\xff" * n}
        flipped = bytes([data[at] ^ 1 << draw(st.integers(0, 7))])
        data = data[:at] + new.get(how, flipped) + data[at + (1 if how == "flipped" else n) :]
    return f"bytes {how}", data[:at] if how == "cut" else data


def cut(text: str) -> Changed:
    """A text of which the end, or all, is lost."""
    return st.integers(0, len(text) - 1).map(lambda n: ("cut short", text[:n]))


def contents(text: str) -> dict[str, tuple[Content, str]]:
    """The text in files of any kind, and whether it must be read from them."""
    return {
        "byte-order mark": (text.encode("utf-8-sig"), "accept"),
        "ends of line of Windows": (text.replace("\n", "\r\n").encode(), "accept"),
        "UTF-16": (text.encode("utf-16"), "refuse"),
        "binary": (bytes(range(256)), "refuse"),
        "empty": (b"", "refuse"),
        "a folder": ("folder", "refuse"),
        "a pipe": ("pipe", "refuse"),
    }
