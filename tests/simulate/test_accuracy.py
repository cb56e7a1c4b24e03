"""``accuracy``: its contract on scenes that nobody tuned for, and what it refuses."""

import json
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
from scenes import scene

from geometry.blade import Blade
from geometry.provenance import ProvenanceError
from geometry.settings import check_settings, read_settings
from rom.check import RomCheck
from rom.coarser import coarser
from rom.model import Rom, RomError
from simulate import accuracy, companion
from simulate.accuracy import (
    Choice,
    _draft_rods,
    basis_error,
    choose,
    march_within,
    mesh_error,
)
from simulate.apart import Run, departures
from simulate.companion import (
    Fineness,
    Models,
    beside,
    closer,
    model_apart,
    rods_apart,
    strips_apart,
    unlike,
    with_settings,
)
from simulate.run import SceneError, march, prepare
from simulate.sweep import scene_of, sweep

BLADES = Path(__file__).parents[2] / "workflow/blades"
ASKED, DRAWN, SPEEDS = 0.01, 12, 12
FINER = 4  # times the steps of a run, in its reference
E, K = (0.1, 0.25, 0.5, 1.0, 2.0, 3.0, 5.0, 7.0, 10.0), (0.1, 0.45, 1.0, 4.55, 10.0)  # of Fig. 14
UNIT = {"reference": 8e9, "rotor37-fast": 3.65e10}  # Pa
BY_HAND = np.array([size * 2**k for k in range(8, 18) for size in (2, 3)])  # steps per round
TO_CHOOSE = {"integrator": None, "liner__rods_per_round": None, "liner__strips": None}


class Pair(NamedTuple):
    """A reduced model as blades have it, and a finer one that tells what it errs by."""

    own: Rom  # 16 patches, 24 natural modes
    finer: Rom  # 24 patches, 36 natural modes


def pair_of(name, folder):
    """Both models of a blade on one mesh of 5 mm."""
    from fem.assemble import assemble
    from geometry.mesh import build_mesh
    from rom.reduce import reduce
    from rom.speeds import basis_speeds

    values = read_settings(Blade, BLADES / f"{name}.yaml").model_dump(exclude_unset=True)
    mesh, models = folder / "blade.msh", []
    for patches, modes in ((16, 24), (24, 36)):
        values |= {
            "mesh": {"element_size_mm": 5.0},
            "interface": {"patches": patches},
            "basis": {"natural_modes": modes},
        }
        blade = check_settings(Blade, values, name)
        if not mesh.is_file():
            build_mesh(blade, mesh, BLADES / blade.file if blade.file else None)
        speeds = basis_speeds(blade.basis, blade.max_speed_rad_s)
        models.append(reduce(assemble(blade, "coarse", mesh, speeds), blade.basis, "r")[0])
    return Pair(*models)


@pytest.fixture(scope="session")
def reference(tmp_path_factory) -> Pair:
    return pair_of("reference", tmp_path_factory.mktemp("reference"))


@pytest.fixture(scope="session")
def rotor37(tmp_path_factory) -> Pair:
    """NASA rotor 37, up to where the paper's speeds end."""
    return pair_of("rotor37-fast", tmp_path_factory.mktemp("rotor37-fast"))


def drawn(dice, blade):
    """A scene within the paper's ranges: coating, casing, speeds, rounds."""
    first, last = np.sort(dice.uniform(0.061, 0.4, 2))
    rounds = int(dice.integers(3, 7))
    return scene(
        **TO_CHOOSE, accuracy=ASKED, rounds=rounds,
        speeds={"over_f1": {"first": first, "last": last, "count": SPEEDS}},
        liner__law__E=float(dice.choice(E)), liner__law__K=float(dice.choice(K)),
        liner__law__unit_Pa=UNIT[blade],
        casing__harmonics=[
            {"order": order, "amplitude_gaps": share * float(dice.uniform(1.1, 2.5))}
            for order, share in ((0, 0.375), (2, 0.5), (4, 0.125))
        ],
    )  # fmt: skip


def marched(case, rom, Omega):
    """A run with the settings of its scene."""
    return Run(case.record, march(case, prepare(case, rom, Omega)))


def errors(runs: Iterator[Run], references: list[Run], finer=FINER):
    """Worst error of every run in what it records; references have ``finer`` times the steps.

    Errors go with the step: a run and its reference are 1 - 1/finer of its error apart. What goes
    with rods and strips squared is less so, by no more than that.
    """
    apart = [max(departures(*pair).values()) for pair in zip(runs, references, strict=True)]
    return np.array(apart) / (1 - 1 / np.asarray(finer))


def fewest_by_hand(case, rom, choice, references):
    """Fewest steps per round, of those tried, that meet the accuracy at 95 % of the speeds."""
    for steps in BY_HAND[choice.steps_per_round < 4 * BY_HAND]:
        tried = with_settings(case, replace(choice.fineness, steps=int(steps)))
        runs = (marched(tried, rom, Omega) for Omega in case.speeds.omega(rom.f1))
        finer = FINER * choice.steps_per_round / steps
        if np.mean(errors(runs, references, finer) <= ASKED) >= 0.95:
            return steps
    return np.nan


def test_the_contract_on_scenes_that_nobody_tuned_for(reference, rotor37, monkeypatch):
    """Errors of step, rods, strips and model at once; what is called sensitive; steps marched."""
    taken = []

    def counted(case, setup):
        taken.append(setup.steps * case.rounds)
        return march(case, setup)

    monkeypatch.setattr(companion, "march", counted)
    dice, models = np.random.default_rng(2012), {"reference": reference, "rotor37-fast": rotor37}
    ok = within = sensitive = refused = 0
    cost = []
    for _ in range(DRAWN):
        blade = str(dice.choice([*models]))
        (own, finer), case = models[blade], drawn(dice, blade)
        speeds = case.speeds.omega(own.f1)
        taken.clear()
        import time
        t = time.process_time()
        try:
            choice = choose(case, own, basis_error=0.0, mesh_error=None)
        except SceneError as error:
            assert "patches and natural modes" in str(error)
            print(blade, case.liner.law.E, case.liner.law.K, error)
            refused += 1
            continue
        runs = [march_within(case, own, Omega, choice) for Omega in speeds]
        steps = sum(taken)
        t1 = time.process_time()
        finest = Fineness(
            FINER * choice.steps_per_round, 2 * choice.rods_per_round + 1, 2 * choice.strips
        )
        references = [marched(with_settings(case, finest), finer, Omega) for Omega in speeds]
        record = choice.scene(case).record
        is_ok = np.array([run.outcome.status == "ok" for run in runs])
        good = [run for run, is_good in zip(runs, is_ok, strict=True) if is_good]
        beside_good = [run for run, is_good in zip(references, is_ok, strict=True) if is_good]
        found = errors((Run(record, run.outcome) for run in good), beside_good)
        ok, within = ok + len(good), within + int((found <= ASKED).sum())
        sensitive += sum(run.outcome.status == "sensitive" for run in runs)
        t2 = time.process_time()
        by_hand = fewest_by_hand(case, own, choice, references)
        cost.append(steps / (by_hand * case.rounds * SPEEDS))
        t3 = time.process_time()
        print(blade, case.liner.law.E, case.liner.law.K, choice.fineness, "model %.4f" % choice.model_error,
            "told", np.round([100*r.worst for r in runs], 2), "found", np.round(100*found, 2), [run.setup.steps for run in runs], "byhand", by_hand, "cost", cost[-1], "ok", len(good), "sens", sensitive,
            "times %.0f %.0f %.0f" % (t1-t, t2-t1, t3-t2), flush=True)
    print(ok, sensitive, within, refused, cost)
    assert ok + sensitive == (DRAWN - refused) * SPEEDS
    assert within >= 0.95 * ok
    assert sensitive <= 0.01 * (DRAWN - refused) * SPEEDS
    assert max(cost) <= 2
