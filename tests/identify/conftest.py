from pathlib import Path

import pytest

from workflow.identify import priors
from workflow.identify.priors import Priors


@pytest.fixture(scope="session")
def narrow() -> Priors:
    """Return the ranges whose medoid the scenes of the paper take."""
    return Priors.load(Path(priors.__file__).with_name("narrow.yaml"))
