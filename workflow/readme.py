"""Fill the generated blocks of all README files: results, and the tables of settings.

./run python workflow/readme.py

A block begins with ``<!-- name: ... -->`` and ends with ``<!-- /name -->``. It is filled on the
page that has it. Where its numbers have not been computed it stays as it is.
"""

import csv
import re
import shutil
import sys
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from pydantic import BaseModel

from geometry.base import UserError, command, read_json, write_whole
from geometry.blade import Blade
from geometry.elsewhere import MatricesElsewhere
from simulate.scene import Scene, verify
from simulate.sweeps.result_types import numbers_of
from workflow.markdown import change, table, two_digits
from workflow.paper import conclusions
from workflow.study import blades, interface, mesh_convergence, trade_table
from workflow.study.stability import told as stability
from workflow.summary import (
    OVER_F1,
    OVER_GAP,
    about,
    crossings_and_ends,
    over_gap,
    peaks,
    terminal,
)

FOLDERS = ("geometry", "fem", "rom", "simulate", "workflow", "profiles", "tests")
PAGES = (
    "README.md",
    *(f"{folder}/README.md" for folder in FOLDERS),
    *("workflow/how-do-i.md", "workflow/paper.md", "fem/matrices.md", "fem/dolfinx.md"),
    *("tests/OTHERS.md", "tests/VERIFICATION.md", "CONTRIBUTING.md"),
)


def scenes(summary: Mapping[str, Any]) -> str:
    """All peaks of the scenes over f1(0) and the gap, and facts that no machine changes."""
    facts = [
        " ".join([f"- {scene['scene']}: {about(scene)}.", *crossings_and_ends(scene)])
        for scene in summary["scenes"]
    ]
    peaks_told = table(
        ["scene", "k", "mode", *OVER_F1, *OVER_GAP, "lobes", "second runs"],
        [
            [
                scene["scene"],
                row["k"],
                numbers_of(row["modes"]),
                *over_gap(row),
                row["lobes"],
                row["word"],
            ]
            for scene, row in peaks(summary)
        ],
    )
    return "\n".join([peaks_told, "", *facts])


def printed(summary: Mapping[str, Any]) -> str:
    """Lines that the terminal prints of the first scene."""
    return f"```\n{terminal({'scenes': summary['scenes'][:1], 'others': []}).strip()}\n```"


def inputs(counts: Mapping[str, Any]) -> str:
    """Inputs of the tester by kind, and how many were refused or read as they say."""
    counted = [
        (kind, sum(by_result.values()), by_result.get("refused", 0), by_result.get("right", 0))
        for kind, by_result in counts["kinds"].items()
    ]
    rows = [
        [kind, total, refused, right, total - refused - right]
        for kind, total, refused, right in counted
    ]
    totals = ["all", *(sum(column) for column in zip(*(row[1:] for row in rows), strict=True))]
    return table(
        ["what is written", "inputs", "refused in a line", "read as it says", "anything else"],
        [*rows, totals],
    )


def bricks(solved: Mapping[str, Any]) -> str:
    """Frequencies by kind of cell and program, and the largest difference from their limit."""
    limit = solved["limit_Hz"]
    rows = [
        [
            f"{row['cells']:,} {row['kind']}",
            row["program"],
            # of the file, and where they are others those that were solved for
            " → ".join(f"{n:,}" for n in dict.fromkeys([row["nodes"], row["solved"]])),
            *_few(row["frequencies_Hz"]),
            *map(_farthest, row["frequencies_Hz"], limit),
            two_digits(row["cpu_s"]),
        ]
        for row in solved["rows"]
    ]
    at_speed = f"at {solved['speed_rad_s']:g} rad/s"
    return table(
        [
            *("cells", "program", "nodes", "f₁, Hz", "f₂", "f₁₀", f"f₁ {at_speed}"),
            *("largest of ten differences", at_speed, "CPU, s"),
        ],
        [["limit of tetrahedra", "", "", *_few(limit), "", "", ""], *rows],
    )


def _few(frequencies: Sequence[Sequence[float]]) -> list[str]:
    """The first, second and tenth frequency at rest, and the first at speed."""
    rest, running = frequencies
    return [f"{f:.2f}" for f in (rest[0], rest[1], rest[9], running[0])]


def _farthest(frequencies: Sequence[float], limit: Sequence[float]) -> str:
    """The largest relative difference."""
    return change(
        max((f / f_limit - 1 for f, f_limit in zip(frequencies, limit, strict=True)), key=abs)
    )


def kept(text: str) -> str:
    """A table of CSV, below the line that names the commit and the command that made it."""
    head, *rows = csv.reader(text.splitlines()[1:])
    return table(head, rows)


# block, file that holds its numbers, function that writes them
TRADE = "results/experiments/trade/table.json"
KEPT = "workflow/study/kept"  # last tables of studies that have left the project
COMPUTED = (
    *conclusions.COMPUTED,
    ("printed", "results/summary.json", printed),
    ("summary", "results/summary.json", scenes),
    ("mesh", "results/experiments/mesh/table.json", mesh_convergence.table),
    ("bases", f"{KEPT}/bases.csv", kept),
    ("rotor37", f"{KEPT}/rotor37.csv", kept),
    ("levels", TRADE, trade_table.by_level),
    ("converges", "results/experiments/interface/table.json", interface.results),
    ("nodes", f"{KEPT}/nodes.csv", kept),
    ("blades", "results/experiments/blades/table.json", blades.table),
    ("casings", f"{KEPT}/casings.csv", kept),
    ("large", f"{KEPT}/large.csv", kept),
    ("solvers", f"{KEPT}/solvers.csv", kept),
    ("requirements", TRADE, trade_table.requirements),
    ("rounds", TRADE, trade_table.fewer_rounds),
    ("speeds", TRADE, trade_table.fewer_speeds),
    ("stages", f"{KEPT}/stages.csv", kept),
    ("bars", f"{KEPT}/bars.csv", kept),
    ("limits", "results/experiments/stability/table.json", stability.limits),
    ("extremes", "results/experiments/extremes/table.json", stability.extremes),
    ("sweeps", "results/experiments/extreme-sweeps/table.json", stability.sweeps),
    ("cuts", f"{KEPT}/cuts.csv", kept),
    ("inputs", "tests/inputs/counts.json", inputs),
    ("bricks", "tests/fem/bricks.json", bricks),
    ("growth", f"{KEPT}/scaling.csv", kept),
)
SETTINGS = {"blade": Blade, "given": MatricesElsewhere, "scene": Scene}  # block: model of the file
PICTURE = Path("results/paper/paper-e1/rub-0.345.png")  # kept beside the captions, for the pages
BLOCK = re.compile(
    r"(?P<begin><!-- (?P<name>\w+): [^\n]*-->\n).*?(?P<end><!-- /(?P=name) -->)", re.DOTALL
)
REQUIRED = "required"
BOUNDS = {"exclusiveMinimum": ">", "minimum": ">=", "exclusiveMaximum": "<", "maximum": "<="}

type Schema = dict[str, Any]  # JSON schema
type KeyRow = tuple[str, str, str, str]  # a key, its meaning, what is allowed, its default


class BlockError(UserError):
    """A generated block that is on no page or on two, that nothing fills, or without an end."""


def settings_table(model: type[BaseModel]) -> str:
    """Markdown table of every key of a settings model, nested keys with dots."""
    schema = model.model_json_schema()
    rows = [[f"`{key}`", *cells] for key, *cells in _rows(schema, schema["$defs"], "")]
    return table(["key", "meaning", "allowed", "default"], rows)


def read_pages(root: Path = Path()) -> dict[str, str]:
    """Text of all README files of the project in ``root``, by path."""
    return {page: (root / page).read_text() for page in PAGES}


def require_blocks(pages: Mapping[str, str]) -> None:
    """Refuse pages whose blocks are not those that are filled, each on one page.

    Raises
    ------
    BlockError
        With a line for each block that is at fault.
    """
    filled = [*SETTINGS, *(name for name, *_ in COMPUTED)]
    begun = [
        (name, page) for page, text in pages.items() for name in re.findall(r"<!-- (\w+): ", text)
    ]
    holders = {
        name: [page for other, page in begun if other == name]
        for name in dict.fromkeys([*filled, *(name for name, _ in begun)])
    }
    whole = {block["name"] for text in pages.values() for block in BLOCK.finditer(text)}
    wrong = {name: _fault(name, on, name in filled, name in whole) for name, on in holders.items()}
    if faults := [f"block {name}: {text}" for name, text in wrong.items() if text]:
        raise BlockError("\n".join(faults))


def _fault(name: str, pages: Sequence[str], filled: bool, whole: bool) -> str:
    """Fault of a block on these pages; empty for a block that is right."""
    named, end = " and ".join(pages), f"`<!-- /{name} -->`"
    if not pages:
        return f"on no page; add `<!-- {name}: -->` and {end} to one of {', '.join(PAGES)}"
    if len(pages) > 1:
        return f"should be once on one page, is in {named}"
    if not filled:
        return f"{named} has it, but nothing fills it"
    return "" if whole else f"has no end {end}"


def generated(pages: Mapping[str, str], folder: Path = Path()) -> dict[str, str]:
    """Pages with their tables of settings, and the results that ``folder`` holds.

    Raises
    ------
    BlockError
        When a block is not on exactly one page, or has no end.
    """
    require_blocks(pages)
    bodies = {name: settings_table(model) for name, model in SETTINGS.items()}
    for name, file, markdown_of in COMPUTED:
        path = folder / file
        if path.exists():
            numbers = read_json(path) if path.suffix == ".json" else path.read_text()
            bodies[name] = markdown_of(numbers).strip()

    def filled(block: re.Match) -> str:
        """The block with its new body, or as it is where nothing fills it."""
        body = bodies.get(block["name"])
        return block[0] if body is None else f"{block['begin']}{body}\n{block['end']}"

    return {page: BLOCK.sub(filled, text) for page, text in pages.items()}


def _rows(schema: Schema, models: Schema, prefix: str) -> list[KeyRow]:
    """Rows of the keys of a model's ``schema``; ``models`` are those it refers to, by name."""
    return [
        row
        for name, key in schema["properties"].items()
        for row in _key_rows(f"{prefix}{name}", key, models)
    ]


def _key_rows(name: str, key: Schema, models: Schema) -> list[KeyRow]:
    """Row of a value, or those of the keys below."""
    values = _values(key, models)
    items = [item for value in values for item in _values(value.get("items", {}), models)]
    for nested, below in ((values, f"{name}."), (items, f"{name}[].")):
        if nested and all("properties" in value for value in nested):
            if len(nested) == 1:
                return _rows(nested[0], models, below)
            return _branch_rows(nested, models, below)
    below = [
        row
        for value in values
        if "properties" in value and any("enum" in other for other in values)
        for row in _rows(value, models, f"{name}.")
    ]
    return [(name, key["description"], _allowed(values + items), _default(key)), *below]


def _values(schema: Schema, models: Schema) -> list[Schema]:
    """Schemas of the values that the one of a key allows, but for null; an empty one: none."""
    if "$ref" in schema:
        return [models[schema["$ref"].rpartition("/")[2]]]
    alternatives = schema.get("anyOf", []) + schema.get("oneOf", [])
    if alternatives:
        return [value for part in alternatives for value in _values(part, models)]
    return [] if schema.get("type", "null") == "null" else [schema]


def _branch_rows(branches: list[Schema], models: Schema, prefix: str) -> list[KeyRow]:
    """Rows of a union: the key that chooses the model, then each key with its models."""
    name = next(name for name, key in branches[0]["properties"].items() if "const" in key)
    tags = {branch["properties"][name]["const"]: branch["properties"][name] for branch in branches}
    meaning = "; ".join(f"`{tag}`: {key['description']}" for tag, key in tags.items())
    default = next((_default(key) for key in tags.values() if "default" in key), REQUIRED)
    owners: dict[KeyRow, list[str]] = {}
    for tag, branch in zip(tags, branches, strict=True):
        for row in _rows(branch, models, prefix):
            owners.setdefault(row, []).append(f"`{tag}`")
    rows = [(f"{prefix}{name}", meaning, _choices(tags), default)]
    keys = [key for key, *_ in owners]
    # the same key of two models side by side
    for row in sorted(owners, key=lambda row: keys.index(row[0])):
        key, meaning, *values = row
        if len(owners[row]) < len(branches):
            meaning = f"{', '.join(owners[row])}: {meaning}"
        if key != f"{prefix}{name}":
            rows.append((key, meaning, *values))
    return rows


def _choices(names: Iterable[str]) -> str:
    return ", ".join(f"`{name}`" for name in names)


def _allowed(values: list[Schema]) -> str:
    """Choices, keys or bounds of a value and of its items."""
    choices = [
        *(name for value in values for name in value.get("enum", [])),
        *(value["const"] for value in values if "const" in value),
    ]
    plain = "list" if any(value.get("type") == "array" for value in values) else "number"
    keys = [_choices(value["properties"]) for value in values if "properties" in value]
    if keys:
        return ", or ".join([_choices(choices) or plain, *keys])
    bounds = [
        f"{sign} {value[bound]}"
        for value in values
        for bound, sign in BOUNDS.items()
        if bound in value
    ]
    if any(value.get("type") == "number" for value in values) and choices:
        return f"number, or {_choices(choices)}"
    return _choices(choices) or ", ".join(bounds)


def _default(key: Schema) -> str:
    if "default" not in key:
        return REQUIRED
    default = key["default"]
    shown = verify.shown(default) if isinstance(default, dict) else default
    return "" if default is None else f"`{shown}`"


@command
def main() -> None:
    """Rewrite the pages that change, and refresh their picture where it has been drawn."""
    pages = read_pages()
    for page, text in generated(pages).items():
        if text != pages[page]:
            write_whole(text, page)
    if PICTURE.exists():
        shutil.copyfile(PICTURE, Path("workflow/report") / PICTURE.name)


if __name__ == "__main__":
    sys.exit(main())
