import os
import shutil
from fcntl import LOCK_EX, flock
from pathlib import Path

import pytest
import yaml
from projects import Project, make_project


@pytest.fixture(scope="session")
def project(tmp_path_factory) -> Project:
    """The whole workflow run once, end to end; each process of the tests has a copy."""
    at_hand = tmp_path_factory.getbasetemp()
    whole = (at_hand.parent if "PYTEST_XDIST_WORKER" in os.environ else at_hand) / "whole"
    with whole.with_suffix(".lock").open("w") as lock:
        flock(lock, LOCK_EX)
        if not whole.exists():
            project = make_project(tmp_path_factory.mktemp("project"))
            project.run()
            project.folder.rename(whole)
    copy = tmp_path_factory.mktemp("project") / "copy"
    return Project(shutil.copytree(whole, copy, symlinks=True))


@pytest.fixture(scope="session")
def coarse_yaml(coarse_blade, tmp_path_factory) -> Path:
    """Write the file of the coarse blade."""
    path = tmp_path_factory.mktemp("coarse-yaml") / "coarse.yaml"
    path.write_text(yaml.safe_dump(coarse_blade.model_dump(mode="json", exclude_unset=True)))
    return path
