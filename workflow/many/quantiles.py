"""Quantiles of the numbers of rows that differ by their seeds, with their intervals."""

from collections.abc import Iterable, Sequence
from math import ceil, log
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike

from workflow.many.sobol import LEVEL

SHARES = (0.1, 0.5, 0.9, 0.95, 0.99)


class Quantile(NamedTuple):
    """A quantile of a number, with the ends of its interval."""

    value: float
    low: float
    high: float
    draws: int  # with the number
    draws_needed: int  # as of ``needed``


def needed(share: float) -> int:
    """Draws of which, at 95 %, one at least lies beyond the quantile of a ``share`` (Wilks 1941).

    With fewer the interval ends at the largest draw, and the quantile may lie beyond.

    >>> [needed(share) for share in (0.5, 0.9, 0.95, 0.99)]
    [5, 29, 59, 299]
    """
    return ceil(log(1 - LEVEL) / log(max(share, 1 - share)))


def quantile(values: ArrayLike, share: float) -> Quantile:
    """Quantile of draws, with the interval of their order statistics, of any distribution.

    Ends are draws whose ranks bound a binomial number of 95 % (Hahn and Meeker 1991, 5.2): with too
    few draws the interval ends at the last of them.
    """
    from scipy.stats import binom  # a slow import, which many jobs do not need

    draws = np.sort(np.asarray(values, float))
    n, tails = len(draws), [(1 - LEVEL) / 2, (1 + LEVEL) / 2]
    low, high = (int(rank) for rank in binom.ppf(tails, n, share))
    ends = float(draws[max(low - 1, 0)]), float(draws[min(high, n - 1)])
    return Quantile(float(np.quantile(draws, share)), *ends, n, needed(share))


def table(rows: pd.DataFrame, by: Sequence[str], numbers: Iterable[str]) -> pd.DataFrame:
    """A line for each share of each of the ``numbers``, columns of ``rows``.

    Draws are the rows that have the number. ``by``: columns other than seeds in which the rows
    differ; each of their values is told apart.
    """
    return pd.DataFrame(
        values
        | {"number": name, "quantile": share, "rows": len(group)}
        | quantile(draws, share)._asdict()
        for values, group in apart(rows, by)
        for name, draws in ((name, group[name].dropna()) for name in numbers)
        for share in (SHARES if len(draws) else ())
    )


def apart(rows: pd.DataFrame, by: Sequence[str]) -> list[tuple[dict[str, Any], pd.DataFrame]]:
    """Rows by their values of the columns ``by``; all together without any."""
    if not by:
        return [({}, rows)]
    groups = rows.groupby([*by], sort=False, dropna=False)
    return [(dict(zip(by, values, strict=True)), group) for values, group in groups]
