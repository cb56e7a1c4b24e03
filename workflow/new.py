"""``./run new KIND NAME``: a short commented file to start from, with its editor's schema.

./run new blade NAME [FILE]     FILE: STEP, BREP, a mesh, or CSV of sections
./run new scene NAME [BLADE]
./run new experiment NAME [SCENE]
"""

import json
import re
import shutil
import sys
from pathlib import Path
from string import Template
from typing import Any

from pydantic import BaseModel

from geometry.base import (
    RPM,
    SettingsError,
    UserError,
    about,
    check_settings,
    command,
    parse,
    write_whole,
    yaml_file,
)
from geometry.blade import Blade, Interface
from geometry.elsewhere import read_blade
from simulate.scene import Scene
from workflow.many.plan import Experiment

TEMPLATES = Path(__file__).parent / "templates"
FOLDERS = {kind: f"workflow/{kind}s" for kind in ("blade", "scene", "experiment")}
MODELS: dict[str, type[BaseModel]] = {"blade": Blade, "scene": Scene, "experiment": Experiment}
SCHEMAS = "workflow/schemas"
SOURCES = {  # template of a blade by the suffix of its file
    **dict.fromkeys((".step", ".stp", ".brep"), "cad"),
    **dict.fromkeys((".inp", ".cdb", ".bdf", ".nas", ".fem", ".msh", ".vtu"), "mesh_file"),
    ".csv": "section_table",
    "": "sections",
}
SHOWN = SOURCES.keys() - {".brep", ".csv", ""}  # their contents
PATCHES = Interface().patches
NOT_READ = {  # values of a template of what a file does not say
    "unit": "mm",
    "frame": "downstream: z, radial: x, rotation: right-handed",
    "root": "radius_mm: 100.0",
    "tip": "radius_mm: 200.0",
    "size": "3.0",
    "material": "young_modulus_GPa: 113.8, poisson_ratio: 0.342, density_kg_m3: 4430",
    "whence": "<-- here Ti-6Al-4V",
    "mark": " <--",
    "guess": " <--",  # of the unit, which a mesh without a material leaves open
    "patches": "",
    "looked": "",
}
PLAIN = re.compile(r'^"(-?[xyz]|[a-z]+-handed)"$')  # needs no quotes
SHARES = (0.4, 0.95)  # of the blade's highest speed: of the sweep


def new(kind: str, name: str, about: str | None = None, folder: Path = Path()) -> Path:
    """Write the file of a new blade, scene or experiment.

    ``about``: file of a blade, blade of a scene, or scene of an experiment. A blade's file is
    copied beside it. ``folder``: where a relative ``about`` begins.

    Raises
    ------
    geometry.base.errors.SettingsError
        When there is a file of that name, none of that in ``about``, or the name is not allowed.
    """
    if not yaml_file.NAME.fullmatch(name):
        raise SettingsError(f"{name!r}: {yaml_file.A_NAME}")
    path = Path(FOLDERS[kind], f"{name}.yaml")
    if path.exists():
        raise SettingsError("choose another name", file=path, key="exists")
    if kind == "blade":
        text = _blade(path, about, folder)
    elif kind == "scene":
        text = _scene(name, about or "reference")
    else:
        text = _experiment(name, about or "paper-e1")
    values, _ = parse(text)
    check_settings(MODELS[kind], values, str(path))
    editor_schema = json.dumps(schema(MODELS[kind]), indent=1) + "\n"
    write_whole(editor_schema, Path(SCHEMAS, f"{kind}.json"))
    write_whole(text, path)
    return path


def _blade(path: Path, file: str | None, folder: Path) -> str:
    """The file of a blade, with the geometry ``file`` copied beside it."""
    source = folder / file if file else None
    if source and not source.is_file():
        raise SettingsError("no such file", file=file)
    suffix = source.suffix.lower() if source else ""
    if suffix not in SOURCES:
        raise SettingsError(
            f"unknown kind of file: allowed {', '.join(filter(None, SOURCES))}", file=file
        )
    values = NOT_READ | (_looked_at(source, path.stem) if suffix in SHOWN and source else {})
    if source and source.resolve().parent != path.parent.resolve():
        shutil.copy(source, path.parent)
    return _filled(
        f"blade-{SOURCES[suffix]}", name=path.stem, file=source and source.name, **values
    )


def _looked_at(source: Path, name: str) -> dict[str, str]:
    """What a mesh or a STEP file says of a blade, drawn; says why where that is nothing.

    Its contents are shown.
    """
    from geometry.cad import StepFile  # slow imports, which other kinds do without
    from geometry.readers import read_mesh_file
    from workflow.first_look import draw, look

    kind = SOURCES[source.suffix.lower()]
    with about(source):
        read = StepFile(source) if kind == "cad" else read_mesh_file(source)
        print(read.described.replace("; ", "\n"))
    try:
        with about(source):
            found = look(source, read)
    except UserError as error:
        print(f"not read: {error}")
        return {}
    picture = Path("results", name, "look.png")
    draw(found, picture)
    values = {key: _inline(found.source[key]) for key in ("frame", "root", "tip")}
    patches = f"interface: {{patches: {found.patches}}} # the tip's mesh allows\n"
    material = (
        {"material": _inline(found.material), "whence": "as in the file"} if found.material else {}
    )
    return {
        **values,
        **material,
        "patches": patches if found.patches != PATCHES else "",
        "unit": found.source["unit"],
        "size": f"{found.size:.2g}",
        "mark": "",
        "guess": "" if found.material or kind == "cad" else " <--",
        "looked": f"# As read from the file, and drawn in {picture}; {found.footprint}\n",
    }


def _inline(values: dict[str, Any]) -> str:
    """Values of a mapping between the braces of YAML."""
    texts = ((key, json.dumps(value)) for key, value in values.items())
    return ", ".join(f"{key}: {PLAIN.sub(r'\1', text)}" for key, text in texts)


def _scene(name: str, blade: str) -> str:
    """The file of a scene of a ``blade``, at speeds that its model allows."""
    if blade not in yaml_file.names(FOLDERS["blade"]):
        raise SettingsError(f"{blade}: no {FOLDERS['blade']}/{blade}.yaml: ./run new blade {blade}")
    highest = read_blade(Path(FOLDERS["blade"], f"{blade}.yaml")).top_speed
    if highest is None:
        raise SettingsError(f"{blade}: a reduced model from elsewhere: copy the scene `foreign`")
    first, last = (float(f"{share * highest * RPM:.3g}") for share in SHARES)
    return _filled("scene", name=name, blade=blade, first=f"{first:g}", last=f"{last:g}")


def _experiment(name: str, scene: str) -> str:
    """The file of an experiment on a ``scene``."""
    if scene not in yaml_file.names(FOLDERS["scene"]):
        raise SettingsError(f"{scene}: no {FOLDERS['scene']}/{scene}.yaml: ./run new scene {scene}")
    return _filled("experiment", name=name, scene=scene)


def _filled(template: str, **values: Any) -> str:
    return Template((TEMPLATES / f"{template}.yaml").read_text()).substitute(values)


def schema(model: type[BaseModel]) -> dict[str, Any]:
    """JSON schema of a settings model, by which editors complete and check its files.

    A file with a `base` has only the differences: there no key is required.
    """
    whole = model.model_json_schema()
    required = whole.pop("required", [])
    for nested in whole["$defs"].values():
        nested.pop("required", None)
    whole["properties"]["base"] = {"type": "string", "description": "File that this one changes"}
    whole["anyOf"] = [{"required": ["base"]}, {"required": required}]
    return whole


@command
def main(arguments: list[str], folder: Path = Path()) -> None:
    """Run the command line."""
    if not 2 <= len(arguments) <= 3 or arguments[0] not in FOLDERS:
        raise UserError(__doc__)
    path = new(*arguments, folder=folder)
    first = "set the lines marked with <--, then: " if "<--" in path.read_text() else ""
    print(f"{path}: {first}{_next(*arguments)}")


def _next(kind: str, name: str, about: str = "reference") -> str:
    """The command that runs a new file."""
    if kind == "blade":
        return f"./run snakemake results/{name}/rom-r.nc results/{name}/rom-check-r.nc"
    if kind == "experiment":
        return f"./run snakemake results/experiments/{name}/picture.png"
    meshed = isinstance(read_blade(Path(FOLDERS["blade"], f"{about}.yaml")), Blade)
    return f"./run snakemake --config 'scenes=[{name}]'" + f" 'explore=[{name}]'" * meshed


if __name__ == "__main__":
    sys.exit(main(sys.argv[2:], Path(sys.argv[1])))
