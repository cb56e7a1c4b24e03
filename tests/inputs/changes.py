"""Changes of any text, as people and accidents make them: what was done, and the text then."""

from collections.abc import Sequence

from case import Content
from hypothesis import strategies as st

type Changed = st.SearchStrategy[tuple[str, str]]

TEXT = st.text(max_size=8)


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
