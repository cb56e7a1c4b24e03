"""Markdown tables, and numbers of two digits in them."""

from collections.abc import Iterable, Sequence


def table(head: Sequence[object], rows: Iterable[Sequence[object]]) -> str:
    """Markdown table of a heading and rows of cells, without a final line break."""
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join(f"| {' | '.join(map(str, cells))} |" for cells in lines)


def two_digits(value: float) -> str:
    """A number with two digits, or more where it is large, without an exponent.

    >>> two_digits(0.092), two_digits(16.8), two_digits(324.0)
    ('0.092', '17', '324')
    """
    return f"{value:.0f}" if value >= 10 else f"{value:.2g}"


def percent(share: float) -> str:
    """``share`` in per cent with two digits; from 100 % on without decimals."""
    return f"{two_digits(100 * share)} %"
