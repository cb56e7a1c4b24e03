"""The mesh of a blade."""

from geometry.blade import Blade
from geometry.description import ENOUGH, describe
from geometry.mesh import build_mesh
from geometry.project import WARNING, Say


def build(blade: Blade, mesh: str, now: Say, source: str | None = None) -> None:
    """Mesh a blade, with the geometry in the file ``source`` where its own file names one."""
    summary = build_mesh(blade, mesh, source)
    described = describe(blade, mesh, summary.volume)
    now(("" if described.through >= ENOUGH else WARNING) + described.line())
