"""Write the generated parts of README.md: results, and the tables of settings.

./run python workflow/readme.py
"""

import json
import re
import shutil
import types
from collections.abc import Callable
from pathlib import Path
from typing import Any, Literal, get_args, get_origin

from pydantic import BaseModel
from pydantic.fields import FieldInfo
from pydantic_core import PydanticUndefined

from geometry.blade import Blade
from geometry.files import whole
from simulate.scene import Scene
from workflow.study import bases_table, frequencies_table, mesh_convergence

README = Path("README.md")


def from_json(table: Callable[[Any], str]) -> Callable[[str], str]:
    """The table of a JSON file's text."""
    return lambda text: table(json.loads(text))


# block, file that holds its numbers, how they are written
COMPUTED = (
    ("summary", "results/figures/summary.md", str),
    ("mesh", "results/figures/mesh-convergence.json", from_json(mesh_convergence.markdown)),
    ("bases", "results/reference/bases.json", from_json(bases_table.markdown)),
    ("rotor37", "results/rotor37/frequencies.json", from_json(frequencies_table.markdown)),
    ("cuts", "results/rotor37/edge-cuts.json", from_json(frequencies_table.edge_cuts)),
)
PICTURE = Path("results/figures/fig10b.png"), Path("workflow/report/fig10b.png")
BOUNDS = {"gt": "> {}", "ge": ">= {}", "lt": "< {}", "le": "<= {}"}


def settings_table(model: type[BaseModel]) -> str:
    """Markdown table of every key of a settings model, nested keys with dots."""
    rows = ["| key | meaning | allowed | default |", "|---|---|---|---|", *_rows(model, "")]
    return "\n".join(rows)


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


def _rows(model: type[BaseModel], prefix: str) -> list[str]:
    rows = []
    for name, field in model.model_fields.items():
        key = f"{prefix}{name}"
        nested = _nested(field.annotation)
        repeats = "[]" if list in _parts(field.annotation) else ""
        if not nested or _is_alternative(field):
            rows.append(_row(key, field))
        for alternative in nested if not _is_alternative(field) else []:
            rows += _rows(alternative, f"{key}{repeats}.")
    return rows


def _is_alternative(field: FieldInfo) -> bool:
    """A quantity that also takes plain values, like speeds: a list or a range."""
    return float in _leaves(field.annotation)


def _row(key: str, field: FieldInfo) -> str:
    return f"| `{key}` | {field.description} | {_allowed(field)} | {_default(field)} |"


def _allowed(field: FieldInfo) -> str:
    if get_origin(field.annotation) is Literal:
        return ", ".join(f"`{choice}`" for choice in get_args(field.annotation))
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
        return "required"
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
    drawn, kept = PICTURE
    if drawn.exists():
        shutil.copyfile(drawn, kept)


if __name__ == "__main__":
    main()
