"""Profile of SLURM: it names rules that exist, and its lock is that of its dependency group."""

import re
import tomllib

import yaml
from packaging.requirements import Requirement
from projects import ROOT

PROFILE = yaml.safe_load((ROOT / "profiles/slurm/config.yaml").read_text())


def test_the_rules_of_the_profile_exist():
    rules = {
        name
        for file in (ROOT / "workflow/rules").glob("*.smk")
        for name in re.findall(r"^rule (\w+):", file.read_text(), re.MULTILINE)
    }
    arrays = {name.strip() for name in PROFILE["slurm-array-jobs"].split(",")}
    assert arrays | PROFILE["set-resources"].keys() <= rules


def test_no_limit_cuts_an_array():
    """Of an array that is cut the plugin loses jobs: profiles/README.md."""
    at_once = int(PROFILE["max-jobs-per-timespan"].partition("/")[0])
    assert min(PROFILE["jobs"], at_once) > PROFILE["slurm-array-limit"]
    assert PROFILE["keep-incomplete"]


def test_the_lock_has_the_packages_of_the_group_and_their_hashes_alone():
    groups = tomllib.loads((ROOT / "pyproject.toml").read_text())["dependency-groups"]
    wanted = {of.name: of.specifier for of in map(Requirement, groups["slurm"])}
    locked = dict(
        re.findall(
            r"^([\w-]+)==(\S+) \\(?:\n    --hash=sha256:[0-9a-f]{64}(?: \\)?)+\n",
            (lock := (ROOT / "profiles/slurm/requirements.lock").read_text()),
            re.MULTILINE,
        )
    )
    assert locked.keys() == wanted.keys()
    assert all(version in wanted[name] for name, version in locked.items())
    assert "://" not in lock
    plain = (ROOT / "requirements.lock").read_text()
    assert not any(re.search(rf"^{name}==", plain, re.MULTILINE) for name in locked)
