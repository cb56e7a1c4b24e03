from collections.abc import Iterator

import pytest
from cluster import Cluster, missing


@pytest.fixture(scope="session")
def slurm(tmp_path_factory) -> Iterator[Cluster]:
    """SLURM of one node on this machine, where its packages and the plugin are installed."""
    if lacking := missing():
        pytest.skip(lacking)
    with Cluster(tmp_path_factory.mktemp("slurm")) as cluster:
        yield cluster
    assert cluster.processes_in() == []
