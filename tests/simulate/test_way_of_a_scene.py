"""The way of a scene to the march: few functions take all of it, or all of its reduced model."""

import sys
from collections import defaultdict

import pytest
from scenes import scene

from geometry.base.provenance import ROOT
from rom.model import Rom
from simulate.scene import Scene
from simulate.sweeps.over_speeds import at_speeds, check_sweep

PACKAGES = "geometry", "rom", "simulate"
AT_MOST = {Scene: 25, Rom: 38}  # functions; 51 with a scene at aaf5b12, 39 with a model at e16b8f7


class _MarchedError(Exception):
    """The march begins."""


def entered(run):
    """Functions of the project that ``run`` enters with a scene, and with a reduced model."""
    found = defaultdict(set)

    def profile(frame, event, _):
        code = frame.f_code
        own = any(code.co_filename.startswith(f"{ROOT}/{package}/") for package in PACKAGES)
        if event != "call" or not own or code.co_name.startswith("<"):
            return
        for kind in {type(value) for value in frame.f_locals.values()} & AT_MOST.keys():
            found[kind].add((code.co_filename, code.co_qualname))
        if code.co_name == "march" and code.co_filename.endswith("marching/run.py"):
            raise _MarchedError

    sys.setprofile(profile)
    try:
        with pytest.raises(_MarchedError):
            run()
    finally:
        sys.setprofile(None)
    return found


def test_few_functions_take_the_whole_scene_or_model(coarse_rom):
    told = scene().model_dump(mode="json")

    def sweep():
        """As the jobs of a sweep: the check of the scene, and its block."""
        check_sweep(Scene.model_validate(told), coarse_rom)
        of = Scene.model_validate(told)
        at_speeds(of, coarse_rom, of.speeds.omega(coarse_rom.f1))

    for Omega in scene().speeds.omega(coarse_rom.f1):
        coarse_rom.modes(Omega)  # which are kept: else two more functions take it, or none
    found = entered(sweep)
    for kind, most in AT_MOST.items():
        assert 15 < len(found[kind]) <= most, sorted(found[kind])
