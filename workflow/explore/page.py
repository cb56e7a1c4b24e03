"""The page: facts and arrays of a sweep, and the scripts that draw them, in one HTML file.

Arrays are one compressed block of 16-bit numbers, which a browser reads back.
"""

import base64
import gzip
import json
from collections.abc import Mapping
from html import escape
from importlib.resources import files
from pathlib import Path
from string import Template
from typing import Any

import numpy as np
from numpy.typing import NDArray

HERE = Path(__file__).parent
SCRIPTS = ("page.js", "units.js", "save.js", "stage.js", "blade.js")
MISSING = 65535  # where a number is not finite
LARGEST = 65534


def packed(arrays: Mapping[str, NDArray[np.float64]]) -> dict[str, Any]:
    """Layout of the arrays by name, and their numbers: unsigned 16-bit, compressed, as base64.

    A number is low + step * code, with an error of half a step: 1 / 131068 of the array's range.
    """
    layout: dict[str, Any] = {}
    codes, begin = [], 0
    for name, values in arrays.items():
        is_finite = np.isfinite(values)
        finite = values[is_finite]
        low, high = (float(finite.min()), float(finite.max())) if finite.size else (0.0, 0.0)
        step = (high - low) / LARGEST or 1.0
        code = np.full(values.shape, MISSING, np.uint16)
        code[is_finite] = np.rint((finite - low) / step)
        layout[name] = {"shape": list(values.shape), "low": low, "step": step, "at": begin}
        codes.append(code.ravel())
        begin += code.size
    return {"layout": layout, "codes": compressed(np.concatenate(codes).astype("<u2").tobytes())}


def compressed(data: bytes) -> str:
    """Gzip as base64; the same bytes for the same data."""
    return base64.b64encode(gzip.compress(data, compresslevel=9, mtime=0)).decode()


def html(facts: dict[str, Any], arrays: Mapping[str, NDArray[np.float64]]) -> str:
    """The page of one sweep."""
    plotly = (files("plotly") / "package_data/plotly.min.js").read_bytes()
    data = packed(arrays) | {"facts": facts, "plotly": compressed(plotly)}
    return Template((HERE / "page.html").read_text()).substitute(
        title=escape(f"Rub of {facts['blade']}, {facts['scene']}"),
        style=(HERE / "page.css").read_text(),
        script="\n".join((HERE / name).read_text() for name in SCRIPTS if (HERE / name).exists()),
        data=json.dumps(data, allow_nan=False).replace("<", "\\u003c"),
    )
