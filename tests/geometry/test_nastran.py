"""Bulk data decks as programs write them: the same mesh and groups, or one line."""

import exports
import pytest

GROUPS = {"root": "nastran:ref=2", "tip": "nastran:ref=3"}


@pytest.fixture
def cards(parts, tmp_path):
    """Fields of each card of our mesh, its keyword first, without marks of continuations."""
    exports.write_bdf(tmp_path / "own.bdf", *parts)
    cards = []
    for line in (tmp_path / "own.bdf").read_text().splitlines():
        width = 16 if "*" in line[:8] else 8
        fields = [line[i : i + width].strip("+* ") for i in range(8, 72, width)]
        if line[0] in "+*":
            cards[-1] += fields
        else:
            cards.append([line[:8].strip("* "), *fields])
    return [card if card[0][0] in "GC" else [" ".join(card[:2]).strip()] for card in cards]


def small(card, mark, large=("GRID",)):
    """In fields of 8 characters, with ``mark`` at the end of a line and the begin of the next."""
    if card[0] in large:
        return wide(card, mark.replace("+", "*"))
    rows = [card[i : i + 8] for i in range(1, len(card), 8)]
    lines = ["".join(f"{cell:8}" for cell in row) for row in rows if any(row)] or [""]
    return f"{card[0]:8}" + f"{mark}\n{mark:8}".join(lines)


def wide(card, mark="*"):
    rows = [card[i : i + 4] for i in range(1, len(card), 4)]
    lines = ["".join(f"{cell:16}" for cell in row) for row in rows if any(row)] or [""]
    begin = mark if mark.strip() else " "
    star = "*" if len(card) > 1 else ""
    return f"{card[0] + star:8}" + f"{mark}\n{begin:8}".join(lines)


def free(card, mark):
    """Separated by commas."""
    rows = [card[i : i + 8] for i in range(1, len(card), 8)]
    return ",".join([card[0], f"{mark[0]}\n{mark[1]},".join(",".join(r) for r in rows if any(r))])


def tabbed(card):
    return free(card, ("", "")).replace(",", "\t") if card[0] != "GRID" else wide(card)


def exponents(card, letter):
    if card[0] == "GRID":
        card = card[:3] + [f"{float(x):.12e}".replace("e", letter) for x in card[3:6]]
    return free(card, (",+", "+"))


SAME = {
    "blanks": lambda c: small(c, ""),
    "marks with names": lambda c: small(c, "+E12"),
    "all in large fields": wide,
    "large fields and blanks": lambda c: wide(c, ""),
    "commas": lambda c: free(c, (",+", "+")),
    "commas, the next line begins with one": lambda c: free(c, (",", "")),
    "tabs": tabbed,
    "exponents without a letter": lambda c: exponents(c, ""),
    "exponents of Fortran": lambda c: exponents(c, "D"),
    "END BULK": lambda c: small(c, "+").replace("ENDDATA", "END BULK"),
    "without BEGIN BULK": lambda c: "" if c[0] == "BEGIN BULK" else small(c, "+"),
    "small letters": lambda c: small(c, "+").lower(),
    "comments and blank lines": lambda c: f"$ a comment\n\n{small(c, '+')}",
    "angles of shells": lambda c: free([*c[:9], "0.5"] if c[0] == "CTRIA6" else c, (",+", "+")),
    "beams": lambda c: "CBAR,99999,9,1,2,1.,0.,0.\nENDDATA" if c[0] == "ENDDATA" else small(c, "+"),
}


@pytest.mark.parametrize("how", SAME)
def test_same_mesh_and_groups(how, cards, parts, build, coarse_mesh):
    text = "\n".join(map(SAME[how], cards)) + "\n"
    summary, found = build("blade.bdf", lambda path: path.write_text(text), **GROUPS)
    assert (summary.nodes, summary.cells) == (len(parts.points), len(parts.cells))
    assert summary.volume == pytest.approx(coarse_mesh.summary.volume, rel=1e-9)
    assert exports.same_facets(found, parts)


def without(cards, keyword, node):
    """The cards, of which the first ``keyword`` lacks a field."""
    at = next(i for i, card in enumerate(cards) if card[0] == keyword)
    cards[at] = [*cards[at][:node], "", *cards[at][node + 1 :]]


REFUSED = {
    "a middle node": (lambda cards: without(cards, "CTETRA", 12), 1661),
    "a coordinate": (lambda cards: without(cards, "GRID", 5), 2),
    "a node": (lambda cards: cards.pop(1), None),
    "its end": (lambda cards: cards.pop(), None),
    "a file": (lambda cards: cards.insert(1, ["include 'mesh.bdf'"]), 2),
    "another system": (lambda cards: cards.insert(1, ["GRDSET", "", "7"]), 2),
    "another system of a node": (lambda cards: cards[1].__setitem__(2, "7"), 2),
    "a number of its own": (lambda cards: cards[2].__setitem__(1, "1"), 3),
    "other cells": (lambda cards: cards.insert(1, ["CTETP", "9999", "1", "1", "2", "3", "4"]), 2),
}


@pytest.mark.parametrize("lacks", REFUSED)
def test_deck_that_is_not_whole(lacks, cards, refusal):
    change, line = REFUSED[lacks]
    change(cards)
    text = "\n".join(free(card, (",+", "+")) for card in cards) + "\n"
    assert refusal("blade.bdf", lambda path: path.write_text(text), **GROUPS).line == line
