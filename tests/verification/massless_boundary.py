"""The massless boundary of Monjaraz Tec, Gross and Krack beside ``piecewise-exact``.

Both on the same reduced models and casings: numbers of converged runs, and errors of steps. Errors
over CPU time: ``massless_study.py``.
"""

from collections.abc import Callable, Iterator, Mapping
from functools import cache
from math import ceil
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple

import numpy as np
from cases import Case, Row
from massless import Run, exact_but_static, macneal, massless_run, own_run, step_limit
from numpy.typing import NDArray

from geometry.blade import Blade
from geometry.project import ROOT, check_settings, read_json
from rom.model import Rom
from simulate.errors.signals import spectrum
from simulate.marching import central_difference, prepare, strip_stiffness
from simulate.marching.setup import Setup
from simulate.scene import Scene
from workflow.markdown import table

BLADES, SCENES = ROOT / "workflow/blades", ROOT / "workflow/scenes"
MEASURED = Path(__file__).with_name("massless_study.json")
UNIT = 1.64e9  # Pa
LAWS = {
    "rigid casing": {"kind": "rigid"},
    "elastic liner": {"kind": "elastic", "E": 10.0, "unit_Pa": UNIT},
    "plastic liner": {"kind": "plastic", "E": 10.0, "K": 4.55, "sigma_Y": 1e-8, "unit_Pa": UNIT},
}
PEAK = 0.38  # over f1(0), speed of the peak of EO 4 with these liners
ROUNDS, SAMPLES, LAST = 20, 128, 10  # revolutions, samples in each, revolutions of a spectrum
FINE, USUAL = 32768, 2048  # steps per revolution: converged, and the product's for 1 %
FEW, MANY, MOST = 24, 30, 50  # modes that move with a massless boundary
DESIGN = 1800.0  # rad/s
NUMBERS = (
    "amplitude, m",
    "amplitude of EO 2, m",
    "largest displacement, m",
    "mean contact force, N",
    "mean worn depth, m",
)
OWN = "piecewise-exact"
OTHERS = "massless boundary", "central differences", "piecewise-exact with static modes"


class Rub(NamedTuple):
    """A scene on a blade at a speed, for any step."""

    scene: Scene
    rom: Rom
    Omega: float  # rad/s

    def at(self, steps: int) -> Setup:
        """Set up with ``steps`` per revolution."""
        return prepare(self.scene, self.rom, self.Omega, steps)


@cache
def model(name: str, size: float) -> Rom:
    """Reduced model of a blade on elements of ``size``, mm, with radial interface DoFs."""
    from fem.assemble import assemble
    from geometry.mesh import build_mesh
    from rom.reduce import reduce
    from rom.speeds import basis_speeds

    values = Blade.load(BLADES / f"{name}.yaml").model_dump(exclude_unset=True)
    blade = check_settings(Blade, values | {"mesh": {"element_size_mm": size}}, name)
    with TemporaryDirectory() as folder:
        mesh = Path(folder) / "blade.msh"
        build_mesh(blade, mesh, BLADES / blade.file if blade.file else None)
        speeds = basis_speeds(blade.basis, blade.max_speed_rad_s)
        return reduce(assemble(blade, name, mesh, speeds), blade.basis, "r")[0]


def rub(rom: Rom, law: Mapping[str, Any], over_f1: float, rounds: int = ROUNDS, **more: Any) -> Rub:
    """The paper's scene with a law of the liner, from rest; ``more`` changes of it."""
    scene = Scene.load(SCENES / "paper-e10.yaml").but(
        rounds=rounds,
        speeds={"over_f1": [over_f1]},
        liner__law=law,
        record={"samples_per_round": SAMPLES, "spectrum_rounds": LAST, "contact_force": True},
        twin=False,
        peaks=None,
        **more,
    )
    return Rub(scene, rom, over_f1 * rom.omega1)


# The methods: a run, or None where its step is too long


def exact(of: Rub, steps: int) -> Run:
    """By ``piecewise-exact``."""
    return own_run(of.scene, of.at(steps))


def exact_with_static(modes: int, of: Rub, steps: int) -> Run:
    """By ``piecewise-exact``, where only so many ``modes`` move."""
    setup = of.at(steps)
    return own_run(of.scene, setup, exact_but_static(setup, of.scene.damping_ratio, modes))


def massless(modes: int, of: Rub, steps: int) -> Run | None:
    """By the massless boundary, with so many ``modes`` that move."""
    setup = of.at(steps)
    reduced = macneal(setup, modes)
    stable = step_limit(reduced, strip_stiffness(of.scene.liner, setup.places))
    return massless_run(of.scene, setup, reduced) if setup.h < stable else None


def central(of: Rub, fraction: float) -> Run | None:
    """By central differences at a ``fraction`` of their limit, which a rigid casing has not."""
    limit = of.at(USUAL).limit
    if limit == 0:
        return None
    steps = SAMPLES * ceil(2 * np.pi / of.Omega / limit / fraction / SAMPLES)
    explicit = {"scheme": "central-difference", "steps_per_round": steps}
    scene = of.scene.but(integrator=explicit)
    setup = prepare(scene, of.rom, of.Omega)
    modes = setup.omega, setup.Phi_b, scene.damping_ratio, setup.h
    return own_run(scene, setup, central_difference.coefficients(*modes))


type Method = Callable[[Rub, Any], Run | None]


def apart(one: NDArray[np.float64], other: NDArray[np.float64]) -> float:
    """Relative difference, of root mean squares."""
    return float(np.linalg.norm(one - other) / np.linalg.norm(other))


def error(run: Run, converged: Run) -> float:
    """The larger error of displacement, over all revolutions, and worn depth, over all rods."""
    seen = [(run.u_r, converged.u_r), (run.wear, converged.wear)]
    return max(apart(*pair) for pair in seen if pair[1].any())


# Rows of the page


def on_reference() -> Iterator[Row]:
    """Converged runs of both, and errors of a usual step, with each law of the liner."""
    rom = model("reference", 5.0)
    for casing, law in LAWS.items():
        of = rub(rom, law, PEAK)
        converged = exact(of, FINE)
        yield from beside(f"{casing}, ", massless(MANY, of, FINE), converged)
        name, theirs = f"{casing}: error, {USUAL} steps", massless(FEW, of, USUAL)
        yield off(f"{name}, `piecewise-exact`", exact(of, USUAL), converged, 0.01)
        yield off(f"{name}, massless boundary, {FEW} modes", theirs, converged, 0.05)


def on_rotor_37() -> Iterator[Row]:
    """Converged runs of both at the design speed, on an oval casing."""
    rom = model("rotor37-fast", 4.0)
    oval = [{"order": 2, "amplitude_gaps": 1.0}]
    changed = {"casing__harmonics": oval, "casing__scale": 1.5}
    of = rub(rom, LAWS["rigid casing"], DESIGN / rom.omega1, **changed)
    yield from beside("", massless(MOST, of, FINE), exact(of, FINE))


def beside(at: str, theirs: Run, ours: Run) -> Iterator[Row]:
    """Numbers of converged runs, and the difference of their displacements and wear."""
    for name, one, other in zip(NUMBERS, numbers(theirs), numbers(ours), strict=True):
        if one > 0:
            yield Row(at + name, one, other, 2e-3)
    yield off(f"{at}difference of displacement or wear", theirs, ours, 3e-3)


def numbers(run: Run) -> list[float]:
    """``NUMBERS`` of a run."""
    amplitudes = spectrum(run.u_r[-LAST * SAMPLES :, 0])
    force = run.mean_force[-LAST:].mean(axis=0).sum()
    found = amplitudes[1:].max(), amplitudes[2 * LAST], abs(run.u_r).max(), force, run.wear.mean()
    return [float(number) for number in found]


def off(quantity: str, run: Run, converged: Run, tolerance: float) -> Row:
    """Row of an error."""
    return Row(quantity, 0.0, error(run, converged), tolerance, scale=1.0)


def conclusion() -> str:
    """What the study of errors over CPU time says."""
    head = ["casing", "error", f"{OWN}, ms", *(f"{name}, over it" for name in OTHERS)]
    levels = table(head, read_json(MEASURED)["levels"])
    return CONCLUSION.format(picture=PICTURE, table=levels).rstrip()


SOURCE = "Monjaraz Tec, Gross, Krack, Comput. Struct. 260 (2022) 106698; test code after the paper"
PICTURE = "![Error over CPU time on three casings](verification/massless_study.png)"
CONCLUSION = """{picture}

Measured by `./run python tests/verification/massless_study.py`: runs of 20 revolutions at 0.30,
0.34 and 0.38 f₁(0). Error: the larger of displacement, over all revolutions, and worn depth, at the
worst of the speeds. The table has the CPU time of the cheapest setting within an error: of three
runs, the compiled kernel alone; in brackets the modes that move.

{table}

- The massless boundary wins where errors of some per cent will do: on a rigid casing at 3 and 10 %,
  on an elastic liner at 10 %. With 512 steps per revolution `piecewise-exact` errs by a quarter
  there at 0.38 f₁(0), though its energies and its status are in order (with `halving` these runs
  are `inaccurate`); the massless boundary with ten modes errs by 6 to 9 %.
- For smaller errors, and on a plastic liner, `piecewise-exact` is 1.4 to 2.7 times as fast, or
  alone within the error. Its free motion is exact, its force a mean over the way in the step. The
  error of a massless boundary ends at the inertia of the modes left out; with more modes its steps
  get shorter (30 on a rigid casing: over 10,000 per revolution).
- Central differences, with mass at the interface and none scaled, take some twenty times as long:
  against them the paper's claim of one to two orders holds. A step with a massless boundary takes
  nearly as long as one of `piecewise-exact`: contact is most of it.
- To take: a third scheme, near 110 statements, 70 as in the test code, the others for ledger,
  starts, refusals and settings; for drafts on rigid casings alone. Static modes within
  `piecewise-exact` are not worth it: their error is of order one.
"""
CASE = Case(
    title="The massless boundary on the same blade",
    source=SOURCE,
    compared="The reference blade (elements of 5 mm) rubs for 20 revolutions at the peak of EO 4, "
    "0.38 f1(0), in the paper's casing, E = 10. Theirs: MacNeal's reduction, leapfrog of the "
    "lowest free modes, contact static at the interface ([test code](simulate/massless.py)). "
    f"Converged: {FINE} steps per revolution, {MANY} modes. Amplitudes (xi = 1/16) and force: "
    "last ten revolutions.",
    reason="the inertia of the modes that do not move: with 24 modes both differ by up to 1 %, "
    "with 30 by 0.2 %. 2048 steps are those of the product's level of 1 %; at these the massless "
    "boundary errs by up to 4 %.",
    rows=on_reference,
    conclusion=conclusion(),
)
ROTOR_37 = Case(
    title="Rub of rotor 37 on a rigid casing",
    source=f"the massless boundary: {SOURCE}",
    compared="NASA rotor 37 (elements of 4 mm) at 1800 rad/s in an oval rigid casing, largest 1.5 "
    f"gaps inward; 20 revolutions from rest, {FINE} steps per revolution, {MOST} modes move in "
    "theirs.",
    reason="the inertia of the modes that do not move: the difference of displacement falls from "
    "0.9 % with 24 modes to 0.5 % with 30 and 0.1 % with 50.",
    rows=on_rotor_37,
    nightly=True,
)
