"""``python -m simulate rom.nc scene.yaml -o out.nc``: run a scene from files alone."""

import argparse
import sys
from pathlib import Path

from geometry.settings import SettingsError, read_settings
from rom.model import Rom, RomError
from simulate.accuracy import basis_error, choose
from simulate.peaks import close_in
from simulate.run import SceneError
from simulate.scene import Scene
from simulate.sweep import save, sweep


def main(arguments: list[str] | None = None) -> int:
    """Run; one line for each fault and exit code 2 when the input cannot be used."""
    parser = argparse.ArgumentParser(prog="python -m simulate", description=__doc__)
    parser.add_argument("rom", help="reduced model, results/<blade>/rom-r.nc")
    parser.add_argument("scene", help="scene, YAML")
    parser.add_argument("-o", "--output", required=True, help="sweep to write, NetCDF")
    options = parser.parse_args(arguments)
    output = Path(options.output)
    if output.is_dir() or not output.parent.is_dir():
        print(f"{output}: no file can be written there", file=sys.stderr)
        return 2
    try:
        scene, rom = read_settings(Scene, options.scene), Rom.load(options.rom)
        choice = choose(scene, rom, basis_error(_check_of(options.rom))) if scene.accuracy else None
        result = sweep(scene, rom, scene.speeds.omega(rom.f1), print, choice)
        result = close_in(scene, rom, result, print, choice)
    except (SettingsError, RomError) as error:
        print(error, file=sys.stderr)
        return 2
    except SceneError as error:
        print(
            "\n".join(f"{options.scene}: {line}" for line in str(error).splitlines()),
            file=sys.stderr,
        )
        return 2
    save(result, options.output)
    return 0


def _check_of(rom: str) -> Path:
    """The check of a reduced model, beside it.

    Raises
    ------
    rom.model.RomError
        When there is none.
    """
    path = Path(rom)
    check = path.with_name(path.name.replace("rom-", "rom-check-", 1))
    if check == path or not check.is_file():
        raise RomError(f"{check}: no such file: accuracy needs the check of the reduced model")
    return check


if __name__ == "__main__":
    sys.exit(main())
