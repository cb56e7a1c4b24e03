from pathlib import Path

import pytest
import yaml
from projects import Project, make_project


@pytest.fixture(scope="session")
def project(tmp_path_factory) -> Project:
    """The whole workflow run once, end to end."""
    project = make_project(tmp_path_factory.mktemp("project"))
    project.run()
    return project


@pytest.fixture(scope="session")
def coarse_yaml(coarse_blade, tmp_path_factory) -> Path:
    """Write the file of the coarse blade."""
    path = tmp_path_factory.mktemp("coarse-yaml") / "coarse.yaml"
    path.write_text(yaml.safe_dump(coarse_blade.model_dump(mode="json", exclude_unset=True)))
    return path
