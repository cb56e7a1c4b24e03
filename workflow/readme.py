"""Write the generated parts of README.md: results, and the tables of settings.

./run python workflow/readme.py
"""

import json
import re
import shutil
import types
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any, Literal, NamedTuple, get_args, get_origin

from pydantic import BaseModel
from pydantic.fields import FieldInfo
from pydantic_core import PydanticUndefined

from geometry.blade import Blade
from geometry.files import whole
from simulate.scene import Scene
from workflow.markdown import table
from workflow.paper import report
from workflow.study import bases, interface_table, mesh, rotor37, trade_table
from workflow.study.stability import report as stability

README = Path("README.md")


def from_json(table: Callable[[Any], str]) -> Callable[[str], str]:
    """The table of a JSON file's text."""
    return lambda text: table(json.loads(text))


# block, file that holds its numbers, how they are written
COMPUTED = (
    ("summary", "results/figures/summary.md", str),
    ("claims", "results/paper/claims.json", from_json(report.short)),
    ("mesh", "results/figures/mesh-convergence.json", from_json(mesh.table)),
    ("bases", "results/reference/bases.json", from_json(bases.table)),
    ("rotor37", "results/rotor37/frequencies.json", from_json(rotor37.prestress_table)),
    ("levels", "results/trade/trade.json", from_json(trade_table.levels)),
    ("converges", "results/interface/interface.json", from_json(interface_table.results)),
    ("nodes", "results/interface/interface.json", from_json(interface_table.all_nodes)),
    ("interfaces", "results/trade/trade.json", from_json(trade_table.interfaces)),
    ("requirements", "results/trade/features.json", from_json(trade_table.requirements)),
    ("rounds", "results/trade/smaller.json", from_json(trade_table.fewer_rounds)),
    ("speeds", "results/trade/smaller.json", from_json(trade_table.fewer_speeds)),
    ("schemes", "results/trade/trade.json", from_json(trade_table.schemes)),
    ("limits", "results/figures/stability-map.json", from_json(stability.limits)),
    ("extremes", "results/figures/stability-matrix.json", from_json(stability.extremes)),
    ("cuts", "results/rotor37/edge-cuts.json", from_json(rotor37.edge_cuts_table)),
)
# kept beside the captions, for the README
PICTURES = ("figures/fig10b.png",)
REQUIRED = "required"
BOUNDS = {"gt": "> {}", "ge": ">= {}", "lt": "< {}", "le": "<= {}"}


class Row(NamedTuple):
    """One key of a settings model, as the tables show it."""

    key: str
    meaning: str
    allowed: str
    default: str


def settings_table(model: type[BaseModel]) -> str:
    """Markdown table of every key of a settings model, nested keys with dots."""
    rows = [[f"`{key}`", *cells] for key, *cells in _rows(model, "")]
    return table(["key", "meaning", "allowed", "default"], rows)


def replace_block(text: str, name: str, body: str) -> str:
    """Put ``body`` between the markers of block ``name``."""
    pattern = rf"(<!-- {name}: [^\n]*-->\n).*?(<!-- /{name} -->)"
    replaced, count = re.subn(pattern, rf"\g<1>{_escaped(body)}\n\g<2>", text, flags=re.DOTALL)
    if count != 1:
        raise ValueError(f"README.md has {count} blocks named {name}")
    return replaced


def generated(text: str, folder: Path = Path()) -> str:
    """README text with its tables of settings, and what ``folder`` holds of its results."""
    text = replace_block(text, "blade", settings_table(Blade))
    text = replace_block(text, "scene", settings_table(Scene))
    for name, file, written in COMPUTED:
        if (folder / file).exists():
            text = replace_block(text, name, written((folder / file).read_text()).strip())
    return text


def _escaped(body: str) -> str:
    return body.replace("\\", r"\\")


def _rows(model: type[BaseModel], prefix: str) -> list[Row]:
    return [
        row
        for name, field in model.model_fields.items()
        for row in _field_rows(f"{prefix}{name}", field)
    ]


def _field_rows(key: str, field: FieldInfo) -> list[Row]:
    """Row of a value, or those of the keys below."""
    nested = _nested(field.annotation)
    if not nested or _is_alternative(field):
        return [Row(key, field.description, _allowed(field), _default(field))]
    below = f"{key}[]." if list in _parts(field.annotation) else f"{key}."
    return _rows(nested[0], below) if len(nested) == 1 else _branch_rows(nested, below)


def _branch_rows(models: list[type[BaseModel]], prefix: str) -> list[Row]:
    """Rows of a union: the key that tells its models apart, then each key with who has it."""
    name = next(name for name, field in models[0].model_fields.items() if _is_literal(field))
    fields = {get_args(m.model_fields[name].annotation)[0]: m.model_fields[name] for m in models}
    meaning = "; ".join(f"`{tag}`: {field.description}" for tag, field in fields.items())
    defaults = [_default(field) for field in fields.values()]
    default = next((known for known in defaults if known != REQUIRED), REQUIRED)
    owners: dict[Row, list[str]] = {}
    for tag, model in zip(fields, models, strict=True):
        for row in _rows(model, prefix):
            owners.setdefault(row, []).append(f"`{tag}`")
    told_apart = Row(f"{prefix}{name}", meaning, _choices(fields), default)
    others = [row for row in owners if row.key != told_apart.key]
    keys = [row.key for row in others]
    others.sort(key=lambda row: keys.index(row.key))  # the same key of two models, side by side
    return [told_apart, *(_of_owners(row, owners[row], len(models)) for row in others)]


def _of_owners(row: Row, owners: list[str], of: int) -> Row:
    """The row, led by who has it unless all have."""
    return row if len(owners) == of else row._replace(meaning=f"{', '.join(owners)}: {row.meaning}")


def _is_literal(field: FieldInfo) -> bool:
    return get_origin(field.annotation) is Literal


def _choices(tags: Iterable[str]) -> str:
    return ", ".join(f"`{tag}`" for tag in tags)


def _is_alternative(field: FieldInfo) -> bool:
    """A quantity that also takes plain values, like speeds: a list or a range."""
    return float in _leaves(field.annotation)


def _allowed(field: FieldInfo) -> str:
    if _is_literal(field):
        return _choices(get_args(field.annotation))
    if _nested(field.annotation):
        return "list, or `first`, `last`, `count`"
    limits = [*field.metadata, *_metadata(field.annotation)]
    return ", ".join(
        pattern.format(getattr(limit, name))
        for limit in limits
        for name, pattern in BOUNDS.items()
        if hasattr(limit, name)
    )


def _default(field: FieldInfo) -> str:
    if field.default is PydanticUndefined:
        return REQUIRED
    return "" if field.default is None else f"`{field.default}`"


def _parts(annotation: Any) -> list[Any]:
    """The annotation's own origin and those of its alternatives."""
    alternatives = get_args(annotation) if isinstance(annotation, types.UnionType) else [annotation]
    return [get_origin(part) or part for part in alternatives]


def _leaves(annotation: Any) -> list[Any]:
    parts = [leaf for part in get_args(annotation) for leaf in _leaves(part)]
    return parts or [annotation]


def _nested(annotation: Any) -> list[type[BaseModel]]:
    return [a for a in _leaves(annotation) if isinstance(a, type) and issubclass(a, BaseModel)]


def _metadata(annotation: Any) -> list[Any]:
    """Bounds inside optionals and lists: Annotated[float, Field(gt=0)] | None."""
    own = [m for m in getattr(annotation, "__metadata__", ())]
    inner = [limit for m in own for limit in getattr(m, "metadata", [m])]
    return inner + [m for part in get_args(annotation) for m in _metadata(part)]


def main() -> None:
    """Rewrite README.md, and refresh its picture where it has been drawn."""
    text = generated(README.read_text())
    with whole(README) as temporary:
        temporary.write_text(text)
    for name in PICTURES:
        drawn = Path("results") / name
        if drawn.exists():
            shutil.copyfile(drawn, Path("workflow/report") / drawn.name)


if __name__ == "__main__":
    main()
