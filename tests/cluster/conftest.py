from collections.abc import Iterator
from pathlib import Path

import pytest
from cluster import Cluster, missing


@pytest.fixture(scope="session")
def slurm(tmp_path_factory) -> Iterator[Cluster]:
    """SLURM of one node on this machine, where its packages and the plugin are installed."""
    if lacking := missing():
        pytest.skip(lacking)
    folder: Path = tmp_path_factory.mktemp("slurm")
    with Cluster(folder) as cluster:
        yield cluster
    assert cluster.processes_in() == []
