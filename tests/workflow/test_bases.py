"""The study of reduction bases: its rows are the reduced models of the bases."""

from pathlib import Path

import pytest

from fem.assemble import assemble
from geometry.blade import EnrichedBasis
from geometry.project import write_json
from rom.full_model import solve
from workflow import readme
from workflow.study import bases


def full(fom):
    return solve(fom, fom.states())


@pytest.fixture(scope="module")
def rows(coarse_matrices, paper_blade, coarse_mesh):
    """Against full models, of the default at its own speeds, of the paper's at one more."""
    of_paper = assemble(paper_blade, "coarse-paper", coarse_mesh.mesh, [0, 160, 325, 650])
    return [
        *bases.compare(of_paper, full(of_paper), bases.ON_POINTS[:1]),
        *bases.compare(coarse_matrices, full(coarse_matrices), [(EnrichedBasis(), "r")]),
    ]


def test_rows_are_those_of_the_bases(rows, paper_reduced):
    paper, radial = rows
    assert paper["n"] == paper_reduced[0].n == 86 and radial["n"] < 65
    assert paper["basis"]["kind"] == "paper" and radial["basis"]["kind"] == "enriched"
    assert list(radial["compliance_error_percent"]) == radial["directions"] == ["radial"]
    # the paper's K(Omega) interpolates at three of the four speeds, its modes stop at eta = 6
    assert paper["frequency_error_percent"] > 100 * radial["frequency_error_percent"]
    assert paper["frequency_error_percent"] >= paper["frequency_error_7_percent"]
    assert paper["compliance_error_percent"]["radial"] > 1e-3
    assert radial["highest_MHz"] < paper["highest_MHz"]


def test_table_has_a_row_for_each_basis_and_stands_in_the_readme(rows, tmp_path):
    lines = bases.table(rows).splitlines()
    assert len(lines) == 2 + len(rows)
    write_json(rows, tmp_path / "results/reference/bases.json")
    pages = readme.generated(readme.read_pages(Path(__file__).parents[2]), tmp_path)
    assert lines[2] in pages["rom/README.md"].splitlines()
