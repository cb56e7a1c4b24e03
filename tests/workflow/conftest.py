import os
import shutil
from collections.abc import Callable
from fcntl import LOCK_EX, flock
from hashlib import sha256
from pathlib import Path
from uuid import uuid4

import pytest
import yaml
from platformdirs import user_cache_path
from projects import ROOT, Project, bring_up_to_date, make_project

from rom.reconstruct import Basis

type Change = Callable[[Project], None]  # of the files of a project


def kept_folder(cache: pytest.Cache) -> Path:
    """Folder in which projects of this checkout stay between calls of pytest.

    pytest's cache in the checkout names it: a fresh clone, or another lock of the dependencies, has
    an empty one. Those of clones that are gone are removed.
    """
    key = cache.get("tiprub/kept", None) or uuid4().hex
    cache.set("tiprub/kept", key)
    lock = sha256((ROOT / "requirements.lock").read_bytes()).hexdigest()[:8]
    folders = user_cache_path("tiprub") / "tests"
    mine = folders / f"{key}-{lock}"
    mine.mkdir(parents=True, exist_ok=True)
    (mine / "checkout").write_text(str(ROOT))
    for folder in folders.iterdir():
        checkout = (folder / "checkout").read_text() if (folder / "checkout").is_file() else ""
        if folder != mine and (checkout == str(ROOT) or not Path(checkout).is_dir()):
            shutil.rmtree(folder)
    return mine


@pytest.fixture(scope="session")
def kept(pytestconfig, tmp_path_factory) -> Callable[..., Project]:
    """Return a function of a name, targets of Snakemake and a ``change``: a copy of a project.

    It has the files of the checkout, changed, and these results. The project itself stays on disk;
    Snakemake reruns what has changed since.
    """
    at_hand = tmp_path_factory.getbasetemp()
    session = at_hand.parent if "PYTEST_XDIST_WORKER" in os.environ else at_hand

    def kept(name: str, *targets: str, change: Change | None = None) -> Project:
        done = session / f"{name}-{sha256(repr(targets).encode()).hexdigest()}.done"
        with (session / "kept.lock").open("w") as lock:
            flock(lock, LOCK_EX)  # of several processes one brings it up to date
            whole = kept_folder(pytestconfig.cache) / name
            if not done.exists():
                fresh = make_project(tmp_path_factory.mktemp(name))
                if change:
                    change(fresh)
                bring_up_to_date(fresh.folder, whole)
                try:
                    Project(whole).run(*targets)
                except AssertionError:
                    shutil.rmtree(whole)  # whatever it was, the next call makes it anew
                    raise
                done.touch()
            copy = tmp_path_factory.mktemp(name) / "copy"
            return Project(shutil.copytree(whole, copy, symlinks=True))

    return kept


@pytest.fixture(scope="session")
def swept(kept) -> Project:
    """Its models and sweeps, likewise."""
    return kept("whole", "rom", "sweeps")


@pytest.fixture(scope="session")
def project(kept) -> Project:
    """The whole workflow run once, end to end; each process of the tests has a copy."""
    return kept("whole")


@pytest.fixture(scope="session")
def coarse_basis(coarse_matrices, coarse_reduced) -> Basis:
    """Displacements of the coarse blade by those of its reduced model."""
    rom, T = coarse_reduced
    return Basis.of(coarse_matrices, T, rom.provenance)


@pytest.fixture(scope="session")
def coarse_yaml(coarse_blade, tmp_path_factory) -> Path:
    """Write the file of the coarse blade."""
    path = tmp_path_factory.mktemp("coarse-yaml") / "coarse.yaml"
    path.write_text(yaml.safe_dump(coarse_blade.model_dump(mode="json", exclude_unset=True)))
    return path
