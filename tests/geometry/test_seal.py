import re

import numpy as np
import pytest
from refused import refused

from geometry.base import AROUND, ROOT, ProvenanceError, intact, seal

BYTES = bytes(np.random.default_rng(3).integers(256, size=300, dtype=np.uint8))


@pytest.fixture(params=AROUND)
def sealed(request, tmp_path):
    path = tmp_path / f"file{request.param}"
    path.write_bytes(BYTES)
    seal(path)
    return path


def test_a_sealed_file_starts_with_its_bytes_and_is_intact(sealed):
    assert intact(sealed) == sealed
    assert sealed.read_bytes().startswith(BYTES)


def test_any_changed_byte_and_any_shorter_file_is_refused(sealed):
    whole = sealed.read_bytes()
    broken = [whole[:i] + bytes([whole[i] ^ 1]) + whole[i + 1 :] for i in range(len(whole))]
    for data in [*broken, *(whole[:i] for i in range(len(whole))), whole + b"\n"]:
        sealed.write_bytes(data)
        assert refused(ProvenanceError, intact, sealed).file == str(sealed)


def test_files_without_a_seal_are_left_alone_and_not_read(tmp_path):
    path = tmp_path / "table.csv"
    path.write_bytes(BYTES)
    seal(path)
    assert path.read_bytes() == BYTES
    assert refused(ProvenanceError, intact, path).file == str(path)


def test_the_remedy_is_a_target_of_the_project():
    """Named from its root, from where ``./run`` starts Snakemake, also by its full path."""
    for path in (ROOT / "results/none/rom-r.nc", "results/none/rom-r.nc"):
        error = refused(ProvenanceError, intact, path)
        assert re.search(r"run snakemake -f (\S+)`$", str(error))[1] == ("results/none/rom-r.nc")
    refused(ProvenanceError, intact, "missing.nc", "look elsewhere", match="; look elsewhere$")
