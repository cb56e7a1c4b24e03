"""CSV files of a user with two columns of numbers, one over the other, in units of their names."""

import csv
from collections.abc import Mapping
from pathlib import Path

import numpy as np

type Units = Mapping[str, float]  # factor to SI by the name of the column


def read_curve(path: str | Path, x: Units, y: Units) -> tuple[list[float], list[float], str]:
    r"""Both columns of a CSV file, in SI, and the first one's name.

    The header names one of ``x`` and one of ``y``.

    >>> _ = Path("curve.csv").write_text("strain,stress_MPa\n0,0\n0.01,2\n")
    >>> read_curve("curve.csv", {"strain": 1.0}, {"stress_Pa": 1.0, "stress_MPa": 1e6})
    ([0.0, 0.01], [0.0, 2000000.0], 'strain')

    Raises
    ------
    ValueError
        When it cannot be read or has other columns.
    """
    try:
        with Path(path).open(newline="", encoding="utf-8-sig") as file:
            lines = [row for row in csv.reader(file, skipinitialspace=True) if row]
    except (OSError, ValueError) as error:
        raise ValueError(f"{path}: cannot be read ({error})") from None
    header, *rows = [[cell.strip() for cell in row] for row in lines] or [[]]
    if len(header) != 2 or header[0] not in x or header[1] not in y:
        raise ValueError(
            f"{path}: columns {', '.join(header) or 'missing'}: should be {' or '.join(x)}, and "
            f"{' or '.join(y)}"
        )
    try:
        first, second = np.array(rows, float).reshape(-1, 2).T
    except ValueError as error:
        raise ValueError(f"{path}: every row should hold two numbers ({error})") from None
    if not np.isfinite([first, second]).all():
        raise ValueError(f"{path}: every number should be finite")
    return (first * x[header[0]]).tolist(), (second * y[header[1]]).tolist(), header[0]
