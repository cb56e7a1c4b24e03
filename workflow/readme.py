"""Write the generated parts of README.md: results, and the tables of settings.

./run python workflow/readme.py
"""

import json
import re
import shutil
import types
from pathlib import Path
from typing import Any, Literal, get_args, get_origin

from pydantic import BaseModel
from pydantic.fields import FieldInfo
from pydantic_core import PydanticUndefined

from geometry.blade import Blade
from geometry.files import whole
from simulate.scene import Scene
from workflow.study.mesh_convergence import markdown

README = Path("README.md")
SUMMARY = Path("results/figures/summary.md")
STUDY = Path("results/figures/mesh-convergence.json")
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


def generated(text: str) -> str:
    """README text with its tables of settings, and its results where they have been computed."""
    text = replace_block(text, "blade", settings_table(Blade))
    text = with_study(replace_block(text, "scene", settings_table(Scene)))
    return replace_block(text, "summary", SUMMARY.read_text().strip()) if SUMMARY.exists() else text


def with_study(text: str) -> str:
    """README text with the errors of the reference mesh, where its study has been run."""
    if not STUDY.exists():
        return text
    return replace_block(text, "mesh", markdown(json.loads(STUDY.read_text())))


def _escaped(body: str) -> str:
    return body.replace("\\", r"\\")


def _rows(model: type[BaseModel], prefix: str) -> list[str]:
    rows = []
    for name, field in model.model_fields.items():
        key = f"{prefix}{name}"
        nested = _nested(field.annotation)
        repeats = "[]" if list in _parts(field.annotation) else ""
        if nested and field.is_required():
            rows += _rows(nested, f"{key}{repeats}.")
        elif nested and _is_alternative(field):
            rows.append(_row(key, field))
        elif nested:
            rows += _rows(nested, f"{key}{repeats}.")
        else:
            rows.append(_row(key, field))
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


def _nested(annotation: Any) -> type[BaseModel] | None:
    models = [a for a in _leaves(annotation) if isinstance(a, type) and issubclass(a, BaseModel)]
    return models[0] if models else None


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
