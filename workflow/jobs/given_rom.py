"""Reduced models made elsewhere."""

from pathlib import Path

from rom.foreign import UNCHECKED, check_foreign, read_foreign


def take(blade: str, source: str, names: dict[str, str], rom: str) -> None:
    """Take a reduced model, if its checks find no fault."""
    taken = read_foreign(source, Path(blade).stem)
    taken.require_directions(names["directions"])
    print(*check_foreign(taken).shown, "not checked:", *UNCHECKED, sep="\n")
    taken.save(rom)
