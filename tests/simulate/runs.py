"""Scenes set up and marched at one speed, alone and beside the peer."""

from types import SimpleNamespace

import numpy as np
from scenes import RUBBING

from geometry.base import ROOT
from simulate.errors.run import Run
from simulate.marching import check_scene, march, prepare
from simulate.scene import Scene
from simulate.sweeps.over_speeds import as_sweep, at_speeds


def rad_s(rom, over_f1):
    """Speeds given over f1(0), rad/s."""
    return 2 * np.pi * rom.f1 * over_f1


def set_up(case, rom, over_f1=0.3):
    """The scene set up at a speed over f1(0)."""
    return prepare(case, rom, rad_s(rom, over_f1))


def made(record, outcome, **of_scene):
    """A run that was not marched, of which the record is known."""
    return Run(SimpleNamespace(record=record, **of_scene), None, None, outcome=outcome)


def marched(case, rom, over_f1=0.3):
    """The outcome of the scene at a speed over f1(0)."""
    return march(case, set_up(case, rom, over_f1))


def swept(case, rom):
    """The scene's sweep, checked, without speeds added around peaks."""
    check_scene(case, rom)
    return as_sweep(at_speeds(case, rom, case.speeds.omega(rom.f1)))


def of_paper(rom, over_f1, rounds, predictable=False, **more):
    """Runs of the coarse blade over speeds, of the paper's E = 10; ``more``: of the record."""
    record = {"spectrum_rounds": 4, "samples_per_round": 256, "motion": 2} | more
    case = Scene.load(ROOT / "workflow/scenes/paper-e10.yaml").but(
        blade="coarse",
        speeds={"over_f1": over_f1},
        rounds=rounds,
        peaks=None,
        record=record,
        liner__strips=8,
        verify={"predictable": predictable},
        **RUBBING,
    )
    return as_sweep(at_speeds(case, rom, rad_s(rom, np.array(over_f1))))


def assert_is_that_of_the_peer(of_peer, case, rom, over_f1, most):
    """Displacements over all strips and every rod's wear, to ``most`` of the largest.

    Returns the steps with contact, as many in both.
    """
    setup = set_up(case, rom, over_f1)
    outcome, steps = march(case, setup), case.rounds * setup.steps
    own = of_peer(rom, case, setup.Omega, setup.steps, steps)
    assert outcome.contact_share == own.contacts / steps
    for found, expected in ((outcome.u_r[-1, 1:], own.u_r), (outcome.wear, own.wear)):
        np.testing.assert_allclose(found, expected, rtol=0, atol=most * abs(expected).max())
    return own.contacts
