"""The way of a scene from its settings to the march: few functions take all of it."""

import sys

import pytest
from scenes import scene

from geometry.base.provenance import ROOT
from simulate.scene import Scene
from simulate.sweeps.over_speeds import at_speeds, check_sweep

BEFORE, AFTER = 51, 30  # functions at aaf5b12, and 60 % of them


class _MarchedError(Exception):
    """The march begins."""


def entered(run):
    """Functions of the project that ``run`` enters with a scene among their arguments."""
    found = set()

    def profile(frame, event, _):
        code = frame.f_code
        own = code.co_filename.startswith(f"{ROOT}/") and "/tests/" not in code.co_filename
        if event != "call" or not own or code.co_name.startswith("<"):
            return
        if any(isinstance(value, Scene) for value in frame.f_locals.values()):
            found.add((code.co_filename, code.co_qualname))
            if code.co_name == "march":
                raise _MarchedError

    sys.setprofile(profile)
    try:
        with pytest.raises(_MarchedError):
            run()
    finally:
        sys.setprofile(None)
    return found


def test_few_functions_take_the_whole_scene(coarse_rom):
    told = scene().model_dump(mode="json")

    def sweep():
        """As the jobs of a sweep: the check of the scene, and its block."""
        check_sweep(Scene.model_validate(told), coarse_rom)
        of = Scene.model_validate(told)
        at_speeds(of, coarse_rom, of.speeds.omega(coarse_rom.f1))

    found = entered(sweep)
    assert 15 < len(found) <= AFTER <= 0.6 * BEFORE, sorted(found)
