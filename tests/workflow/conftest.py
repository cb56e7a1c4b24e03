import pytest
from projects import Project, make_project


@pytest.fixture(scope="session")
def project(tmp_path_factory) -> Project:
    """The whole workflow run once, end to end."""
    project = make_project(tmp_path_factory.mktemp("project"))
    project.run()
    return project
