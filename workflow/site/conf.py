"""Settings of Sphinx for the site: the pages of the project, and the interface of its packages.

./run site
"""

import re

from pydantic import BaseModel
from sphinx.application import Sphinx

from geometry.base import ROOT, version as version_of_project
from workflow.readme import PAGES

project = "Tiprub"
release = version_of_project()
copyright = "the Tiprub developers, BSD-3-Clause"
root_doc = "README"
include_patterns = [
    *PAGES,
    *("workflow/own-blade.md", "workflow/sure.md", "workflow/safe.md"),
    *("tests/fem/CATALOGUE.md", "CHANGELOG.md"),
    "workflow/site/*.md",
]
extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "sphinx.ext.viewcode"]

myst_heading_anchors = 3
default_role = "code"
highlight_language = "text"
add_module_names = False
autodoc_member_order = "bysource"
nitpicky = True
nitpick_ignore_regex = [(r"py:.*", r".*")]  # types, most of them of other libraries
suppress_warnings = ["ref.python"]  # types in signatures by their short names

html_theme = "furo"
html_title = f"Tiprub {release}"
html_show_sourcelink = html_copy_source = False
html_static_path = ["style.css"]
html_css_files = ["style.css"]
html_additional_pages = {"index": "start.html"}  # to the first page
templates_path = ["."]

CONTENTS = (ROOT / "workflow/site/contents.txt").read_text()
MODULE = """
## {0}

```{{eval-rst}}
.. automodule:: {0}
   :members:
   :exclude-members: model_config
```
"""


def add_to_page(app: Sphinx, page: str, source: list[str]) -> None:
    """Add the contents to the first page, and to that of a package its modules."""
    if page == root_doc:
        source[0] += CONTENTS
    elif page.startswith("workflow/site/"):
        package = page.removeprefix("workflow/site/")
        for file in sorted((ROOT / package.replace(".", "/")).glob("[!_]*.py")):
            source[0] += MODULE.format(f"{package}.{file.stem}")


def keep_lines(app: Sphinx, kind: str, name: str, of, options, lines: list[str]) -> None:
    """Show indented lines of a docstring, equations and tables, as they are written."""
    lines[:] = re.sub(r"(?m)^(\S.*\n)\n(?= {4}\S)", r"\1\n::\n\n", "\n".join(lines)).split("\n")


def hide_keys(app: Sphinx, kind: str, name: str, of: type, *_: object) -> tuple[str, str] | None:
    """Leave out the signature of settings: their keys are on the pages, with meaning and range."""
    return ("", "") if kind == "class" and issubclass(of, BaseModel) else None


def setup(app: Sphinx) -> None:
    """Of an extension of Sphinx."""
    app.connect("source-read", add_to_page)
    app.connect("autodoc-process-signature", hide_keys)
    app.connect("autodoc-process-docstring", keep_lines, priority=400)  # before napoleon
