"""Cost of sweeps that is told beforehand, against the cost taken, over drawn scenes.

    ./run python -m tests.benchmarks.told                       # 200 scenes, and three extremes
    ./run python -m tests.benchmarks.told --scenes 20 --seed 3  # fewer, others

The reduced models are those of ``./run snakemake results/paper/rom-rt.nc results/paper/rom-r.nc
results/rotor67/rom-rtz.nc``. Each scene is swept in a process of its own, after its code is
compiled; its CPU time and memory are those of that process, with the file of the sweep. Keys that
are added to scenes later join ``drawn``.
"""

import argparse
import multiprocessing as mp
from collections.abc import Iterator
from math import exp, log
from pathlib import Path
from random import Random
from resource import RUSAGE_SELF, getrusage
from tempfile import TemporaryDirectory
from time import process_time
from typing import Any, NamedTuple

from geometry.base import UserError, check_settings
from rom.model import Rom
from simulate.marching import make_kernel, prepare
from simulate.scene import Scene
from simulate.sweeps.cost import cost
from simulate.sweeps.dataset import save
from simulate.sweeps.sweep import sweep

SEED = 89
SHORTEST, LONGEST = 0.1, 20.0  # s, told, of a scene that is run
MODELS = [("paper", "r"), ("paper", "rt"), ("rotor67", "rtz")]
DRAWN = "drawn"
VERIFY = [None, "peaks", "every", {"share": 0.0}, {"share": 0.5, "predictable": True}]


class Taken(NamedTuple):
    """What a sweep took."""

    seconds: float  # CPU time
    memory: float  # bytes, at most
    contact: float  # steps with contact over all steps


class Draw(Random):
    """Random values of keys."""

    def over(self, low: float, high: float) -> float:
        """A value between two, each of its sizes as likely."""
        return float(f"{exp(self.uniform(log(low), log(high))):.4g}")

    def maybe(self, share: float, **values: Any) -> dict[str, Any]:
        """The values, with this probability."""
        return values if self.random() < share else {}


def moving(draw: Draw) -> dict[str, Any]:
    """A mode of a casing, stiff or soft."""
    values = {"frequency_Hz": draw.over(200, 5000), "modal_mass_kg": draw.over(3, 100)}
    return values | {"order": draw.randint(0, 5), "damping_ratio": draw.over(2e-3, 2e-2)}


def of_stage(draw: Draw) -> dict[str, Any]:
    """Blades over one liner, equal or not."""
    scatter = {"longer_um": {"std_gaps": draw.over(1e-3, 0.2), "seed": draw.randint(0, 99)}}
    return {"count": draw.choice([2, 8, 20])} | (scatter if draw.random() < 0.5 else {})


def drawn(draw: Draw) -> tuple[str, dict[str, Any]]:
    """Directions of the model, and a scene as a user writes it."""
    blade, directions = draw.choice(MODELS)
    samples, first = draw.choice([256, 512, 1024]), draw.over(0.03, 0.3)
    steps = {"steps_per_round": samples * draw.choice([1, 2, 4, 8])}
    central = {
        "scheme": "central-difference",
        "fraction_of_limit": round(draw.uniform(0.3, 0.9), 2),
    }
    integrator = central if draw.random() < 0.3 else {"scheme": "piecewise-exact"} | steps
    last = first * draw.over(1.02, 4)
    harmonic = {"order": draw.randint(1, 8), "amplitude_gaps": draw.over(0.5, 4)}
    law = {"kind": "plastic", "K": 2.0, "sigma_Y": 1e-3, "unit_MPa": 354.0}
    return directions, {
        "blade": blade,
        "speeds": {"over_f1": {"first": first, "last": last, "count": draw.randint(1, 8)}},
        "rounds": draw.randint(3, 30),
        "integrator": integrator,
        "damping_ratio": draw.over(5e-4, 1e-2),
        "clearance": {
            "leading_edge_over_span": draw.over(5e-5, 1e-3),
            "trailing_edge_over_span": draw.over(5e-5, 1e-3),
        },
        "casing": {
            "harmonics": [harmonic | draw.maybe(0.2, speed_rpm=draw.over(10, 1e4))],
            "ramp_rounds": draw.choice([0.5, 1, 2, 5]),
            **draw.maybe(0.2, modes=[moving(draw) for _ in range(draw.choice([1, 2, 5]))]),
        },
        "liner": {
            "law": law | {"E": draw.over(0.1, 100)},
            "thickness_mm": 5,
            "strips": round(draw.over(1, 64)),
            "footprint_mm": draw.over(2, 20),
            "rods_per_round": round(draw.over(256, 8192)),
        },
        "record": {
            "samples_per_round": samples,
            "wear": draw.random() < 0.5,
            **draw.maybe(0.7, spectrum_rounds=2),
            **draw.maybe(0.2, states_rounds=1),
        },
        **draw.maybe(0.2, stage=of_stage(draw)),
        **draw.maybe(0.5, verify=draw.choice(VERIFY[1:])),
        **draw.maybe(0.2, peaks={"orders": [draw.randint(2, 8)], "within_over_f1": 0.005}),
        **draw.maybe(0.2, peaks={"within_over_f1": 0.005}),
        **(
            draw.maybe(0.4, contact={"friction": draw.over(0.02, 0.3)}) if "t" in directions else {}
        ),
    }


def extremes() -> Iterator[tuple[str, str, Scene]]:
    """Name, directions and scene of what the cost was once told worst of."""
    usual = Scene.load("workflow/scenes/paper.yaml").but(
        speeds={"over_f1": [0.2, 0.25]},
        peaks=None,
        rounds=4,
        verify={"share": 0},
        record__spectrum_rounds=2,
    )
    yield "usual", "r", usual
    friction = {"contact": {"friction": 0.1}, "liner__strips": 256}
    yield "friction, 256 strips", "rt", usual.but(**friction)
    central = {"scheme": "central-difference", "fraction_of_limit": 0.5}
    far = {"over_f1": [0.0008, 0.01, 0.05, 0.1, 0.2, 0.3, 0.35, 0.4]}
    yield "central differences, 500-fold speeds", "r", usual.but(integrator=central, speeds=far)
    every = {"over_f1": {"first": 0.1, "last": 0.4, "count": 16}}
    yield "every speed verified", "r", usual.but(speeds=every, verify="every", rounds=20)


def taken(scene: Scene, rom: Rom) -> Taken | str:
    """Of the sweep of a scene in a process of its own; or why it is refused."""
    receive, send = mp.Pipe(duplex=False)

    def run() -> None:
        with TemporaryDirectory() as folder:
            try:
                make_kernel(scene, prepare(scene, rom, float(scene.speeds.omega(rom.f1)[0])))
                begun = process_time()
                runs = sweep(scene, rom)
                save(runs, Path(folder, "sweep.nc"))
            except UserError as error:
                send.send(str(error).splitlines()[0])
                return
        seconds, memory = process_time() - begun, getrusage(RUSAGE_SELF).ru_maxrss * 1024
        send.send(Taken(seconds, memory, float(runs["contact_share"].mean())))

    process = mp.get_context("fork").Process(target=run)
    process.start()
    send.close()
    found = receive.recv()
    process.join()
    return found


def cases(seed: int) -> Iterator[tuple[str, str, Scene]]:
    """Name, directions and scene of the extremes, then of drawn ones without an end."""
    yield from extremes()
    draw = Draw(seed)
    while True:
        directions, values = drawn(draw)
        try:
            yield DRAWN, directions, check_settings(Scene, values, DRAWN)
        except UserError:
            continue


class Row(NamedTuple):
    """A scene, told and taken."""

    name: str
    about: str
    told: tuple[float, float]  # s and bytes
    taken: tuple[float, float]

    def off(self, of: int) -> float:
        """By which factor the time (0) or the memory (1) is off."""
        return max(self.told[of] / self.taken[of], self.taken[of] / self.told[of])

    def __str__(self) -> str:
        """Both in s and GB."""
        numbers = (*self.taken, *self.told)
        shown = " ".join(f"{n / unit:8.3g}" for n, unit in zip(numbers, (1, 1e9) * 2, strict=True))
        return f"{shown} {self.off(0):6.2f} {self.off(1):6.2f}  {self.name}: {self.about}"


def rows(scenes: int, seed: int) -> Iterator[Row]:
    """A row of each scene that is not refused."""
    roms = {key: Rom.load(f"results/{key[0]}/rom-{key[1]}.nc") for key in MODELS}
    number = 0
    for name, directions, scene in cases(seed):
        rom = roms[scene.blade, directions]
        try:
            told = cost(scene, rom)
        except UserError:  # refused, as a speed above the highest
            continue
        if name == DRAWN and not SHORTEST <= told.seconds <= LONGEST:
            continue
        found = taken(scene, rom)
        if isinstance(found, str):  # refused
            continue
        number += name == DRAWN
        about = (
            f"{scene.blade}, {scene.stepping.scheme}, {scene.liner.m} strips, friction "
            f"{scene.contact.friction}, {told.speeds} speeds, {told.all_steps:.2g} steps, verify "
            f"{scene.verify}, peaks {scene.peaks}, contact {found.contact:.2f}"
        )
        yield Row(name, about, (told.total, told.memory), (found.seconds, found.memory))
        if number == scenes:
            return


def main() -> None:
    """Print a row of each scene, then how far off the drawn ones are."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--scenes", type=int, default=200)
    parser.add_argument("--seed", type=int, default=SEED)
    given = parser.parse_args()
    print("taken: s, GB; told: s, GB; off by factors")
    drawn_rows = []
    for row in rows(given.scenes, given.seed):
        print(row, flush=True)
        drawn_rows += [row] if row.name == DRAWN else []
    for of, what in enumerate(("time", "memory")):
        off = sorted(row.off(of) for row in drawn_rows)
        middle, most = off[len(off) // 2], off[int(0.9 * len(off))]
        print(f"{what}: median off by {middle:.2f}, nine in ten by up to {most:.2f}")


if __name__ == "__main__":
    main()
