"""What the jobs of a blade's model take, told from its mesh."""

from types import SimpleNamespace

import pytest
import yaml
from refused import refused

from geometry.base import MeshError
from workflow import model_cost
from workflow.model_cost import costs, nodes_of, require_room
from workflow.targets.blades import UNKNOWN, Blades


@pytest.mark.parametrize("prestress", ["linear", "nonlinear"])
def test_more_nodes_speeds_and_columns_take_more(coarse_blade, prestress):
    blade = coarse_blade.but(prestress=prestress)
    few, many = costs(blade, 20_000), costs(blade, 80_000)
    wide = costs(blade.but(interface={"patches": 32}), 20_000)
    fast = costs(blade.but(basis={"speeds": 8}), 20_000)
    assert few.keys() == {"assemble", "modes", "solve_between", "reduce"}
    for job, cost in few.items():
        assert cost.seconds < many[job].seconds < 30 * cost.seconds
        assert cost.memory < many[job].memory < 8 * cost.memory
        assert wide[job].seconds >= cost.seconds and wide[job].memory >= cost.memory
        assert fast[job].seconds >= cost.seconds


def test_nodes_of_a_mesh_are_read_from_its_head(coarse_mesh):
    assert nodes_of(coarse_mesh.mesh) == coarse_mesh.summary.nodes


def test_a_job_declares_the_memory_that_is_told(coarse_blade, coarse_mesh, tmp_path, monkeypatch):
    """Of a blade that is not meshed as of a small one; twice as much at the second attempt."""
    folder = tmp_path / "workflow/blades"
    folder.mkdir(parents=True)
    settings = coarse_blade.model_dump(mode="json", exclude_unset=True)
    (folder / "coarse.yaml").write_text(yaml.safe_dump(settings))
    (folder / "given.yaml").write_text("full_matrices: {}\n")
    monkeypatch.chdir(tmp_path)
    memory, coarse = Blades.read().memory("modes"), SimpleNamespace(blade="coarse")
    planned = memory(coarse, None, 1)  # Snakemake asks again when the mesh is there
    mesh = tmp_path / "results/coarse/blade.msh"
    mesh.parent.mkdir(parents=True)
    mesh.write_bytes(coarse_mesh.mesh.read_bytes())
    told = costs(coarse_blade, coarse_mesh.summary.nodes)["modes"].memory
    assert memory(coarse, None, 2) == pytest.approx(2 * told / 1e6, abs=2)
    assert memory(SimpleNamespace(blade="given"), None, 3) == 3 * UNKNOWN
    mesh.write_text("$Nodes")
    assert memory(coarse, None, 1) == planned < told / 1e6


def test_what_a_machine_cannot_hold_is_refused_with_the_numbers(
    coarse_blade, tmp_path, monkeypatch
):
    monkeypatch.setattr(model_cost, "memory_of_machine", lambda: 4e9)
    said = []
    require_room(coarse_blade, 40_000, said.append)
    match = r"^250000 nodes: .* needs some 14 GB, this machine has 4 GB: .*element_size_mm above"
    refused(MeshError, require_room, coarse_blade, 250_000, said.append, match=match)
