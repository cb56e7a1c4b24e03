"""The coarse reference blade, meshed, assembled and reduced once for all tests that want it."""

from pathlib import Path
from typing import Any, NamedTuple

import pytest

from geometry.base import ROOT, check_settings, provenance, sources
from geometry.blade import Blade

CORE = "simulate"  # folder
BEYOND = {  # its files of more than one run: sweeps, second runs, what shows them
    *("test_peak_results", "test_cli", "test_cost", "test_dataset", "test_examples"),
    *("test_checked", "test_extremes", "test_face", "test_kernel_file", "test_neighbours"),
    *("test_plausible", "test_results_page", "test_start"),
}


@pytest.hookimpl(tryfirst=True)  # ahead of the selection by -m
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Mark what is neither slow nor nightly in the folder ``CORE``, but for ``BEYOND``."""
    for item in items:
        beyond = item.path.stem in BEYOND or {"slow", "nightly"} & {*item.keywords}
        if item.path.parent.name == CORE and not beyond:
            item.add_marker("core")


def pytest_terminal_summary(terminalreporter: Any) -> None:
    """Print the counts that tests recorded by ``record_property``."""
    for report in terminalreporter.getreports("passed"):
        for name, value in report.user_properties:
            if report.when == "call":
                terminalreporter.write_line(f"{name}: {value}")


@pytest.fixture
def project_at(monkeypatch):
    """Read the packages in another folder than the project's; what was read before is forgotten.

    They must have other names than the modules of this process.
    """
    kept = sources.sources_of, sources._graph, provenance.code_hash

    def forget():
        for function in kept:
            function.cache_clear()

    def project_at(folder):
        for module in (sources, provenance):
            monkeypatch.setattr(module, "ROOT", folder)
        packages = [init.parent.name for init in folder.glob("*/__init__.py")]
        monkeypatch.setattr(sources, "PACKAGES", packages)
        monkeypatch.setattr(sources, "FACES", {})
        monkeypatch.syspath_prepend(folder)
        forget()

    yield project_at
    forget()


class MeshFiles(NamedTuple):
    """What the geometry wrote and measured."""

    mesh: Path
    summary: Any  # geometry.mesh.MeshSummary, whose module needs gmsh


class BladeFiles(NamedTuple):
    """What geometry and finite elements wrote."""

    mesh: Path
    matrices: Path  # at the speeds of the basis


@pytest.fixture(scope="session")
def coarse_blade() -> Blade:
    """Return the reference blade on 800 cells: seconds, and f1 within 0.5 % of a fine mesh.

    Its tip holds some twelve nodes along the chord, enough for eight patches.
    """
    blade = Blade.load(ROOT / "workflow/blades/reference.yaml")
    values = blade.model_dump(exclude_unset=True)
    values |= {"mesh": {"element_size_mm": 10.0}, "interface": {"patches": 8, "across": 1}}
    return check_settings(Blade, values, "the coarse blade")


@pytest.fixture(scope="session")
def coarse_mesh(coarse_blade, tmp_path_factory) -> MeshFiles:
    """Mesh the coarse blade."""
    from geometry.mesh import build_mesh

    mesh = tmp_path_factory.mktemp("coarse-blade") / "blade.msh"
    return MeshFiles(mesh, build_mesh(coarse_blade, mesh))


@pytest.fixture(scope="session")
def coarse_files(coarse_blade, coarse_mesh) -> BladeFiles:
    """Assemble the coarse blade."""
    from fem.assemble import assemble
    from rom.polynomial import basis_speeds

    matrices = coarse_mesh.mesh.with_name("matrices.h5")
    speeds = basis_speeds(coarse_blade.basis, coarse_blade.top_speed)
    assemble(coarse_blade, "coarse", coarse_mesh.mesh, speeds).save(matrices)
    return BladeFiles(coarse_mesh.mesh, matrices)


@pytest.fixture(scope="session")
def coarse_matrices(coarse_files):
    """Load the full model at the four speeds of the basis."""
    from fem.matrices import Matrices

    return Matrices.load(coarse_files.matrices)


@pytest.fixture(scope="session")
def coarse_reduced(coarse_blade, coarse_matrices):
    """Reduce the coarse blade as its settings ask: the model and its basis T."""
    from rom.reduce import reduce

    return reduce(coarse_matrices, coarse_blade.basis)


@pytest.fixture(scope="session")
def coarse_rom(coarse_reduced):
    """Return the reduced model alone."""
    return coarse_reduced[0]


@pytest.fixture(scope="session")
def paper_blade(coarse_blade) -> Blade:
    """Return the coarse blade as the paper reduces its own: eight points, Eqs. (4)-(5)."""
    values = coarse_blade.model_dump(exclude_unset=True)
    values |= {"interface": {"nodes": 8}, "basis": {"kind": "paper"}}
    return check_settings(Blade, values, "the paper's coarse blade")


@pytest.fixture(scope="session")
def paper_matrices(paper_blade, coarse_mesh):
    """Assemble it at the three speeds of the paper's basis."""
    from fem.assemble import assemble
    from rom.polynomial import basis_speeds

    speeds = basis_speeds(paper_blade.basis, paper_blade.top_speed)
    return assemble(paper_blade, "coarse-paper", coarse_mesh.mesh, speeds)


@pytest.fixture(scope="session")
def paper_reduced(paper_blade, paper_matrices):
    """Reduce it: the model and its basis T."""
    from rom.reduce import reduce

    return reduce(paper_matrices, paper_blade.basis)
