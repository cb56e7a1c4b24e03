"""Quantiles of the numbers of rows that differ by their seeds, with bootstrap intervals."""

from collections.abc import Iterable, Sequence
from math import ceil, log
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike

from workflow.many.sobol import LEVEL, RESAMPLES

SHARES = (0.1, 0.5, 0.9, 0.95, 0.99)


class Quantile(NamedTuple):
    """A quantile of a number, with the ends of its interval."""

    value: float
    low: float
    high: float
    draws: int
    draws_needed: int  # as of ``needed``


def needed(share: float) -> int:
    """Draws of which, at 95 %, one at least lies beyond the quantile of a ``share`` (Wilks 1941).

    With fewer the interval ends at the largest draw, and the quantile may lie beyond.

    >>> [needed(share) for share in (0.5, 0.9, 0.95, 0.99)]
    [5, 29, 59, 299]
    """
    return ceil(log(1 - LEVEL) / log(max(share, 1 - share)))


def quantile(values: ArrayLike, share: float) -> Quantile:
    """Quantile of draws, at least two, with its percentile bootstrap interval (Efron 1979)."""
    from scipy.stats import bootstrap  # a slow import, which many jobs do not need

    draws = np.asarray(values, float)
    found = bootstrap(
        (draws,),
        lambda drawn, axis: np.quantile(drawn, share, axis=axis),
        n_resamples=RESAMPLES,
        confidence_level=LEVEL,
        method="percentile",
        rng=np.random.default_rng(1),
    ).confidence_interval
    value = float(np.quantile(draws, share))
    return Quantile(value, float(found.low), float(found.high), len(draws), needed(share))


def table(rows: pd.DataFrame, by: Sequence[str], numbers: Iterable[str]) -> pd.DataFrame:
    """A line for each share of each of the ``numbers``, columns of ``rows``, of at least two draws.

    ``by``: columns other than seeds in which the rows differ; each of their values is told apart.
    """
    return pd.DataFrame(
        values | {"number": name, "quantile": share} | quantile(draws, share)._asdict()
        for values, group in apart(rows, by)
        for name, draws in ((name, group[name].dropna()) for name in numbers)
        for share in (SHARES if len(draws) > 1 else ())
    )


def apart(rows: pd.DataFrame, by: Sequence[str]) -> list[tuple[dict[str, Any], pd.DataFrame]]:
    """Rows by their values of the columns ``by``; all together without any."""
    if not by:
        return [({}, rows)]
    groups = rows.groupby([*by], sort=False, dropna=False)
    return [(dict(zip(by, values, strict=True)), group) for values, group in groups]
