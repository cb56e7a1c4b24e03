"""``python -m simulate rom.nc scene.yaml -o out.nc``: run a scene from files alone."""

import argparse
import sys
from contextlib import suppress
from functools import partial
from pathlib import Path

from geometry.base import (
    SettingsError,
    WriteError,
    command,
    require_writable,
    sealed,
    version,
    write_or_keep,
)
from geometry.elsewhere import read_blade
from rom.elsewhere import load_model
from rom.model import Rom
from simulate.errors.accuracy import Choice, pilot
from simulate.marching import SceneError
from simulate.scene import Scene, own_laws
from simulate.sweeps.dataset import load, save
from simulate.sweeps.sweep import sweep


@command
def main(arguments: list[str] | None = None) -> None:
    """Run the command line."""
    parser = argparse.ArgumentParser(prog="python -m simulate", description=__doc__)
    parser.add_argument(
        "rom", help="reduced model, results/<blade>/rom-r.nc, or one made elsewhere"
    )
    parser.add_argument("scene", help="scene, YAML")
    parser.add_argument("--version", action="version", version=f"Tiprub {version()}")
    parser.add_argument("-o", "--output", required=True, help="sweep to write, NetCDF")
    parser.add_argument(
        "--law",
        action="append",
        default=[],
        metavar="FILE.py",
        help="file with a law of your own that the scene names, outside of workflow/laws",
    )
    parser.add_argument(
        "--start",
        help="sweep to continue from, of the scene in `start`, run with `record: {end: true}`",
    )
    options = parser.parse_args(arguments)
    try:
        _run(options)
    except SceneError as error:
        raise error.within(options.scene) from None


def _run(options: argparse.Namespace) -> None:
    """Write the sweep of a scene."""
    output = Path(options.output)
    if (output.exists() and not output.is_file()) or not output.parent.is_dir():
        raise WriteError("cannot be written: not a file in an existing folder", file=output)
    if output.suffix != ".nc":
        raise WriteError("cannot be written: its name must end in .nc", file=output)
    require_writable(output)
    for file in options.law:
        own_laws.take(file)
    scene = Scene.load(options.scene)
    rom = load_model(options.rom, scene.blade)
    _require_current(rom, Path(options.rom), scene, Path(options.scene))
    choice = _choice(scene, rom, Path(options.rom)) if scene.accuracy else None
    start = load(options.start) if options.start else None
    result = sweep(scene, rom, print, choice, start)
    named = result.assign_attrs(name=Path(options.scene).stem)
    write_or_keep(partial(save, named), output)


def _require_current(rom: Rom, path: Path, scene: Scene, scene_path: Path) -> None:
    """Refuse a model made before its blade's files, or the mesh in its folder, were changed.

    Raises
    ------
    geometry.base.provenance.ProvenanceError
        If it was; the message names the difference.
    """
    if rom.elsewhere and not sealed(path):
        return
    blade = scene_path.resolve().parent.parent / "blades" / f"{scene.blade}.yaml"
    if rom.provenance.blade == scene.blade and blade.is_file():
        present = read_blade(blade)
        rom.provenance.require_settings(present.settings_of_model(), path)
        with suppress(SettingsError):  # of a file that is not here
            rom.provenance.require_files(present.hash_of_files(blade.parent), path)
    rom.provenance.require_mesh(path.with_name("blade.msh"), path)


def _choice(scene: Scene, rom: Rom, path: Path) -> Choice:
    """Settings that meet ``scene.accuracy``; the checks of model and mesh lie in their folder."""
    check = path.with_name("rom-check-" + path.name.removeprefix("rom-"))
    return pilot(scene, rom, check, path.with_name("mesh-error.json"))


if __name__ == "__main__":
    sys.exit(main())
