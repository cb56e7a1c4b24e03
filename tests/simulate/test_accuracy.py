"""``accuracy``: its contract on scenes that nobody tuned for, and what it refuses."""

import json
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scenes import scene

from geometry.blade import Blade
from geometry.settings import read_settings
from rom.check import RomCheck
from simulate import companion
from simulate.accuracy import (
    Choice,
    _draft_rods,
    basis_error,
    choose,
    march_within,
)
from simulate.apart import Run, departures
from simulate.companion import beside, closer, unlike, with_settings
from simulate.run import SceneError, march, prepare
from simulate.sweep import scene_of, sweep

BLADES = Path(__file__).parents[2] / "workflow/blades"
ASKED, SPEEDS = 0.01, 24
FINER = 4  # times the steps of a run, in its reference
E, K = (0.1, 0.25, 0.5, 1.0, 2.0, 3.0, 5.0, 7.0, 10.0), (0.1, 0.45, 1.0, 4.55, 10.0)  # of Fig. 14
UNIT = {"reference": 8e9, "rotor37": 3.65e10}  # Pa
BY_HAND = np.array([size * 2**k for k in range(8, 18) for size in (2, 3)])  # steps per round


@pytest.fixture(scope="session")
def rotor37_rom(tmp_path_factory):
    """NASA rotor 37 on a coarse mesh, up to where the paper's speeds end."""
    from fem.assemble import assemble
    from geometry.mesh import build_mesh
    from rom.reduce import reduce
    from rom.speeds import basis_speeds

    blade = read_settings(Blade, BLADES / "rotor37-fast.yaml")
    mesh = blade.mesh.model_copy(update={"element_size_mm": 8.0})
    blade = blade.model_copy(update={"mesh": mesh})
    folder = tmp_path_factory.mktemp("rotor37-fast")
    files = folder / "blade.msh", folder / "interface.csv"
    build_mesh(blade, *files, BLADES / blade.file)
    speeds = basis_speeds(blade.basis, blade.max_speed_rad_s)
    return reduce(assemble(blade, *files, speeds), blade.basis)[0]


def drawn(dice, blade):
    """A scene within the paper's ranges: coating, casing, speeds, rounds."""
    first, last = np.sort(dice.uniform(0.061, 0.4, 2))
    rounds = int(dice.integers(3, 7))
    return scene(
        integrator=None, liner__rods_per_round=None, accuracy=ASKED, rounds=rounds,
        speeds={"over_f1": {"first": first, "last": last, "count": SPEEDS}},
        liner__law__E=float(dice.choice(E)), liner__law__K=float(dice.choice(K)),
        liner__law__unit_Pa=UNIT[blade],
        casing__harmonics=[
            {"order": order, "amplitude_gaps": share * float(dice.uniform(1.1, 2.5))}
            for order, share in ((0, 0.375), (2, 0.5), (4, 0.125))
        ],
        casing__ramp_rounds=2,
        record={
            "samples_per_round": 256,
            "spectrum_rounds": rounds // 2,
            "history": {"nodes": [1]},
            "contact_force": True,
        },
    )  # fmt: skip


def marched(case, rom, Omega):
    """A run with the settings of its scene."""
    return Run(case.record, march(case, prepare(case, rom, Omega)))


def errors(runs: Iterator[Run], references: list[Run], finer):
    """Worst error of every run in what it records; references have ``finer`` times the steps.

    Errors go with the step: a run and its reference are 1 - 1/finer of its error apart.
    """
    apart = [max(departures(*pair).values()) for pair in zip(runs, references, strict=True)]
    return np.array(apart) / (1 - 1 / np.asarray(finer))


def fewest_by_hand(case, rom, choice, references):
    """Fewest steps per round, of those tried, that meet the accuracy at 95 % of the speeds."""
    for steps in BY_HAND[choice.steps_per_round < 4 * BY_HAND]:
        tried = with_settings(case, int(steps), choice.rods_per_round)
        runs = (marched(tried, rom, Omega) for Omega in case.speeds.omega(rom.f1))
        finer = FINER * choice.steps_per_round / steps
        if np.mean(errors(runs, references, finer) <= ASKED) >= 0.95:
            return steps
    raise AssertionError("no setting by hand meets it")


def test_the_contract_on_scenes_that_nobody_tuned_for(coarse_rom, rotor37_rom, monkeypatch):
    """Twelve of them: errors, what is called sensitive, and steps marched, the pilot's too."""
    taken = []

    def counted(case, setup):
        taken.append(setup.steps * case.rounds)
        return march(case, setup)

    monkeypatch.setattr(companion, "march", counted)
    dice, models = np.random.default_rng(2012), {"reference": coarse_rom, "rotor37": rotor37_rom}
    ok = within = sensitive = 0
    cost = []
    for _ in range(12):
        blade = str(dice.choice([*models]))
        rom, case = models[blade], drawn(dice, blade)
        speeds = case.speeds.omega(rom.f1)
        taken.clear()
        choice = choose(case, rom, basis_error=0.0)
        runs = [march_within(case, rom, Omega, choice) for Omega in speeds]
        steps = sum(taken)
        finest = FINER * choice.steps_per_round, 2 * choice.rods_per_round + 1
        reference = with_settings(case, *finest)
        references = [marched(reference, rom, Omega) for Omega in speeds]
        record = choice.scene(case).record
        is_ok = np.array([run.outcome.status == "ok" for run in runs])
        good = [run for run, is_good in zip(runs, is_ok, strict=True) if is_good]
        beside = [run for run, is_good in zip(references, is_ok, strict=True) if is_good]
        finer = [finest[0] / run.setup.steps for run in good]
        found = errors((Run(record, run.outcome) for run in good), beside, finer)
        ok, within = ok + len(good), within + int((found <= ASKED).sum())
        sensitive += sum(run.outcome.status == "sensitive" for run in runs)
        by_hand = fewest_by_hand(case, rom, choice, references)
        cost.append(steps / (by_hand * case.rounds * SPEEDS))
    assert ok + sensitive == 12 * SPEEDS
    assert within >= 0.95 * ok
    assert sensitive <= 0.01 * 12 * SPEEDS
    assert max(cost) <= 2


@pytest.fixture(scope="module")
def asking(coarse_rom):
    """A small scene with an accuracy, and what its pilot chooses."""
    case = scene(
        integrator=None, liner__rods_per_round=None, accuracy=0.01, speeds={"over_f1": [0.3, 0.33]}
    )
    return case, choose(case, coarse_rom, basis_error=0.001)


def test_a_choice_is_recorded_with_the_errors_of_every_run(asking, coarse_rom, tmp_path):
    case, choice = asking
    (tmp_path / "settings.json").write_text(json.dumps(choice.plain()))
    again = Choice.load(tmp_path / "settings.json")
    assert again.runs == {} and again.plain() == choice.plain()
    assert max(choice.observed.values()) <= 0.01 and choice.expected <= 0.01
    speeds = case.speeds.omega(coarse_rom.f1)
    swept = sweep(case, coarse_rom, speeds, choice=again)
    assert json.loads(swept.attrs["accuracy"]) == choice.plain()
    assert scene_of(swept) == choice.scene(case)
    assert swept["error"].dims == ("speed", "observable") and swept["error"].max() <= 0.01
    assert list(swept["error"]["observable"].values) == case.record.observables
    assert (swept["steps_per_round"] == choice.steps_per_round).all()


def test_what_the_pilot_has_marched_is_not_marched_again(asking, coarse_rom, monkeypatch):
    case, choice = asking
    monkeypatch.setattr(companion, "march", None)
    Omega = case.speeds.omega(coarse_rom.f1)[0]
    assert march_within(case, coarse_rom, Omega, choice) is choice.runs[Omega]


def test_a_run_that_misses_is_marched_at_shorter_steps(asking, coarse_rom):
    """First order: the error falls by as much as was asked."""
    case, choice = asking
    Omega = case.speeds.omega(coarse_rom.f1)[0]
    first = march_within(case, coarse_rom, Omega, replace(choice, runs={}))
    asked = replace(choice, accuracy=0.7 * first.worst, runs={})
    again = march_within(case, coarse_rom, Omega, asked)
    assert 1.4 < again.setup.steps / first.setup.steps < 2.5
    assert again.outcome.status == "ok" and again.worst <= asked.accuracy


def test_a_closer_look_sees_the_rods(asking, coarse_rom):
    """At steps that err by far less than few rods do: half of that error is told, or more."""
    case, _ = asking
    Omega, steps, few = case.speeds.omega(coarse_rom.f1)[0], 32768, 467
    run = beside(case, coarse_rom, Omega, steps, few)
    true = marched(with_settings(case, steps, 8 * few + 1), coarse_rom, Omega)
    found = departures(Run(case.record, run.outcome), true)
    told = closer(case, coarse_rom, run).errors
    assert found["wear"] > 0.01 and told["wear"] > 0.5 * found["wear"]


def test_what_shorter_steps_do_not_settle_is_sensitive(asking, coarse_rom):
    case, choice = asking
    Omega = case.speeds.omega(coarse_rom.f1)[0]
    run = march_within(case, coarse_rom, Omega, replace(choice, accuracy=1e-4, runs={}))
    assert 4 <= run.setup.steps / choice.steps_per_round < 6 and run.worst > 1e-4
    assert run.outcome.status == "sensitive"


def test_a_coarse_model_is_refused_with_its_error_and_the_remedy(asking, coarse_rom, tmp_path):
    full = np.array([[100.0, 200.0], [110.0, 210.0]])
    RomCheck(np.array([0.0, 9.0]), full, full * [1, 1.02], np.full((2, 8, 1), 0.01), 1.0).save(
        tmp_path / "check.nc"
    )
    error = basis_error(tmp_path / "check.nc")
    assert error == pytest.approx(0.02)
    with pytest.raises(SceneError, match=r"accuracy: 0\.01: .* errs by 0\.02; .*natural_modes"):
        choose(asking[0].changed(accuracy=0.01), coarse_rom, error)
    with pytest.raises(SceneError, match="no settings chosen"):
        sweep(asking[0], coarse_rom, [300.0])


@pytest.mark.parametrize(
    ("advance", "alike"), [(0.5, True), (0.25, True), (2 / 3, True), ((5**0.5 - 1) / 2, False)]
)
def test_rods_that_every_few_steps_meet_alike_are_told(advance, alike):
    assert (unlike(advance) < 0.01) == alike


def test_a_tilted_tip_gets_rods_that_see_its_edge(coarse_rom):
    """It falls by less than a tenth of the gap over a rod, where a flat tip needs few."""
    flat = scene(integrator=None, liner__rods_per_round=None, accuracy=0.01)
    tilted = flat.changed(contact__profile={"tilt": 0.15})
    few, many = (_draft_rods(case, coarse_rom) for case in (flat, tilted))
    around = 2 * np.pi * coarse_rom.radius.max()
    assert 1.5 <= few * flat.liner.footprint_m / around < 1.6
    assert 0.15 * around / many <= 0.1 * flat.clearance.gaps(8, coarse_rom.span)[0]
