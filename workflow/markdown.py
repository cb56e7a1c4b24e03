"""Numbers in text, with their uncertainty, and Markdown tables of them."""

import re
from collections.abc import Iterable, Mapping, Sequence
from math import floor, isfinite, isnan, log10
from typing import NamedTuple

from geometry.base import printable

TAG = re.compile(r"<(?=[A-Za-z/!?])")
LEAST = 1e-4  # smaller uncertainties and changes, relative, count as equal
NOT_KNOWN = "(no ±)"  # without any uncertainty
DIGITS = 3  # of a value without an uncertainty
MOST = 5  # of one with it: to ``LEAST`` of itself
WIDTH = 124  # of the lines of a page


def table(head: Sequence[object], rows: Iterable[Iterable[object]]) -> str:
    """Markdown table of a heading and rows of cells, without a final line break.

    What a cell says is text: no tags of HTML, and no further cells.

    >>> print(table(["<i>", "<= 1 %"], []))
    | &lt;i> | <= 1 % |
    | --- | --- |
    """
    lines = (
        [TAG.sub("&lt;", printable(str(cell))).replace("|", r"\|") for cell in cells]
        for cells in [head, ["---"] * len(head), *rows]
    )
    return "\n".join(f"| {' | '.join(cells)} |" for cells in lines)


def cell(value: object, unknown: str = "-") -> str:
    """A value in a cell: three digits of a float, and of None or nan the text ``unknown``.

    >>> cell(1.2345), cell(3), cell(None), cell("ok")
    ('1.23', '3', '-', 'ok')
    """
    if value is None or (isinstance(value, float) and isnan(value)):
        return unknown
    return str(Number(value)) if isinstance(value, float) else str(value)


def records(rows: Sequence[Mapping[str, object]]) -> str:
    """Markdown table of rows, at least one, that have their cells by the same headings.

    >>> print(records([{"k": 4, "speed": 0.35}]))
    | k | speed |
    | --- | --- |
    | 4 | 0.35 |
    """
    return table([*rows[0]], [row.values() for row in rows])


class Number(NamedTuple):
    """A value, and its uncertainty in the same unit if there is one.

    ``least``: the uncertainty may be larger, since some of its parts are not known.

    >>> print(Number(1.2345, 0.031), Number(17.12, 3.4), Number(1234.5))
    1.23 ± 0.03 17 ± 3 1234
    >>> Number(0.5, 0.031).share, Number(0.5, 0.031, least=True).share
    ('±6.2%', '≥6.2%')
    """

    value: float
    error: float | None = None
    least: bool = False

    def __str__(self) -> str:
        """The digits of the value that its uncertainty allows, and one of that."""
        if self.error is None:
            return self.shown
        return f"{self.shown} ± {two_digits(rounded(self.error, 1))}"

    @property
    def shown(self) -> str:
        """The value alone, to the first digit of its uncertainty, ``MOST`` digits at most.

        Without an uncertainty ``DIGITS``, or all of those before the point.
        """
        value, digits = self.value, DIGITS
        if self.error and value and isfinite(self.error):
            first, last = (floor(log10(abs(x))) for x in (value, rounded(self.error, 1)))
            digits = min(max(first - last + 1, 1), MOST)
        if self.error or abs(value) < 1000:
            value = rounded(value, digits)
        return f"{value:.{MOST}g}" if abs(value) < 1000 else f"{value:.0f}"

    @property
    def share(self) -> str:
        """The uncertainty in per cent of the value, ``NOT_KNOWN`` without one; empty for 0."""
        if self.error is None or not isfinite(self.error):
            return NOT_KNOWN
        if self.value == 0:
            return ""
        sign = "≥" if self.least else "±"
        return f"{sign}{two_digits(100 * max(self.error / abs(self.value), LEAST))}%"


def rounded(value: float, digits: int) -> float:
    """A number with so many significant digits.

    >>> rounded(0.012345, 3)
    0.0123
    """
    return float(f"{value:.{digits}g}")


def two_digits(value: float) -> str:
    """A number with two digits, or more where it is large; from 1e-4 on without an exponent.

    >>> two_digits(0.092), two_digits(16.8), two_digits(324.0)
    ('0.092', '17', '324')
    """
    return f"{value:.0f}" if value >= 10 else f"{value:.2g}"


def percent(share: float | None) -> str:
    """``share`` in per cent with two digits, from 100 % on without decimals; a dash for None, nan.

    >>> percent(0.0567), percent(None)
    ('5.7 %', '-')
    """
    if share is None or isnan(share):
        return "-"
    return f"{two_digits(100 * share)} %"


def change(share: float) -> str:
    """A relative change in per cent with its sign and two digits; 0 below ``LEAST``.

    >>> change(1.5), change(-0.0567), change(-1e-6)
    ('+150%', '-5.7%', '-0%')
    """
    shown = two_digits(100 * abs(share)) if abs(share) >= LEAST else "0"
    return f"{'-' if share < 0 else '+'}{shown}%"
