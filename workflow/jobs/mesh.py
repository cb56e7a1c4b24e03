"""The mesh of a blade."""

from geometry.blade import Blade
from geometry.mesh import ENOUGH, MeshSummary, build_mesh
from geometry.project import WARNING, Say


def build(blade: Blade, mesh: str, now: Say, source: str | None = None) -> None:
    """Mesh a blade, with the geometry in the file ``source`` where its own file names one."""
    tell_of(build_mesh(blade, mesh, source), now)


def tell_of(summary: MeshSummary, now: Say) -> None:
    """Report the mesh; a warning where the elements are too few."""
    now(("" if summary.through >= ENOUGH else WARNING) + summary.blade_line())
