"""The page: facts and arrays of a sweep, and the scripts that draw them, in one HTML file."""

import json
from html import escape
from importlib.resources import files
from pathlib import Path
from string import Template
from typing import Any

from workflow.explore.pack import compressed, packed
from workflow.explore.results import Arrays

HERE = Path(__file__).parent
SCRIPTS = ("page.js", "blade.js")


def html(facts: dict[str, Any], arrays: Arrays) -> str:
    """The page of one sweep."""
    plotly = (files("plotly") / "package_data/plotly.min.js").read_bytes()
    data = packed(arrays) | {"facts": facts, "plotly": compressed(plotly)}
    return Template((HERE / "page.html").read_text()).substitute(
        title=escape(f"Rub of {facts['blade']}, {facts['scene']}"),
        style=(HERE / "page.css").read_text(),
        script="\n".join((HERE / name).read_text() for name in SCRIPTS if (HERE / name).exists()),
        data=json.dumps(data, allow_nan=False).replace("<", "\\u003c"),
    )
