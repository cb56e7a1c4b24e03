"""Runs of a blade in the paper's casing by the methods that the massless boundary stands beside."""

from collections.abc import Callable, Mapping
from functools import cache
from math import ceil
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple

import numpy as np
from closing import Facets, tip_facets
from massless import (
    Run,
    craig_bampton,
    exact_but_static,
    macneal,
    massless_run,
    own_run,
    step_limit,
)
from numpy.typing import NDArray
from scenes import TWO_LOBES, UNIT

from fem.matrices import Matrices
from geometry.base import ROOT, check_settings
from geometry.blade import Blade
from rom.model import Rom
from simulate.marching import central_difference, prepare, strip_stiffness
from simulate.marching.setup import Setup
from simulate.scene import LEADING, Scene

BLADES, SCENES = ROOT / "workflow/blades", ROOT / "workflow/scenes"
MEASURED = Path(__file__).with_name("massless_study.json")
OWN, MASSLESS, CENTRAL = "piecewise-exact", "massless boundary", "central differences"
FIXED, STATIC = "massless boundary, Craig-Bampton", "piecewise-exact with static modes"
LAWS = {
    "rigid casing": {"kind": "rigid"},
    "elastic liner": {"kind": "elastic", "E": 10.0, "unit_Pa": UNIT},
    "plastic liner": {"kind": "plastic", "E": 10.0, "K": 4.55, "sigma_Y": 1e-8, "unit_Pa": UNIT},
}
PEAK = 0.38  # over f1(0), speed of the peak of EO 4 with these liners
ROUNDS, SAMPLES, LAST = 20, 128, 10  # revolutions, samples in each, revolutions of a spectrum
USUAL, RICH = 24, 60  # natural modes of a basis: what users have, and that of converged runs


class Rub(NamedTuple):
    """A scene on a blade at a speed, for any step."""

    scene: Scene
    rom: Rom
    Omega: float  # rad/s

    def at(self, steps: int) -> Setup:
        """Set up with ``steps`` per revolution."""
        return prepare(self.scene, self.rom, self.Omega, steps)


@cache
def assembled(name: str, size: float) -> tuple[Blade, Matrices, Facets]:
    """A blade on elements of ``size``, mm, its matrices, and the facets of its tip."""
    from fem.assemble import assemble
    from geometry.mesh import build_mesh
    from rom.polynomial import basis_speeds

    values = Blade.load(BLADES / f"{name}.yaml").model_dump(exclude_unset=True)
    blade = check_settings(Blade, values | {"mesh": {"element_size_mm": size}}, name)
    with TemporaryDirectory() as folder:
        mesh = Path(folder) / "blade.msh"
        build_mesh(blade, mesh, BLADES / blade.file if blade.file else None)
        speeds = basis_speeds(blade.basis, blade.top_speed)
        return blade, assemble(blade, name, mesh, speeds), tip_facets(mesh)


@cache
def reduced(name: str, size: float, natural_modes: int) -> tuple[Rom, NDArray[np.float64]]:
    """Its reduced model with radial interface DoFs, of so many modes at each speed, and its basis.

    Modes of a reduced model beyond the natural ones of its basis are no modes of the blade.
    """
    from rom.reduce import reduce

    blade, matrices, _ = assembled(name, size)
    basis = blade.basis.model_copy(update={"natural_modes": natural_modes})
    return reduce(matrices, basis, "r")


def model(name: str, size: float, natural_modes: int) -> Rom:
    """The model of ``reduced`` alone."""
    return reduced(name, size, natural_modes)[0]


def rub(rom: Rom, law: Mapping[str, Any], over_f1: float, **more: Any) -> Rub:
    """The paper's scene in two lobes, with a law of the liner, from rest; ``more`` changes."""
    scene = Scene.load(SCENES / "paper-e10.yaml").but(
        rounds=ROUNDS,
        speeds={"over_f1": [over_f1]},
        liner__law=law,
        record={"samples_per_round": SAMPLES, "spectrum_rounds": LAST, "contact_force": True},
        verify={"predictable": False},
        peaks=None,
        **(TWO_LOBES | more),
    )
    return Rub(scene, rom, over_f1 * rom.omega1)


type Method = Callable[[Rub, Any], Run | None]  # a run, or None where its step is too long


def exact(of: Rub, steps: int) -> Run:
    """By ``piecewise-exact``."""
    return own_run(of.scene, of.at(steps))


def exact_with_static(modes: int, of: Rub, steps: int) -> Run:
    """By ``piecewise-exact`` with so many dynamic ``modes``, the others static."""
    setup = of.at(steps)
    return own_run(of.scene, setup, exact_but_static(setup, of.scene.damping_ratio, modes))


def massless(
    modes: int,
    of: Rub,
    steps: int,
    rows: NDArray[np.float64] | None = None,
    *,
    fixed: bool = False,
) -> Run | None:
    """By the massless boundary with so many dynamic ``modes``: MacNeal's, or of fixed interface.

    ``rows``: as of ``macneal``.
    """
    setup, leading = of.at(steps), np.array([LEADING])
    boundary = (
        craig_bampton(setup, of.rom, leading, modes) if fixed else macneal(setup, modes, rows)
    )
    stable = step_limit(boundary, strip_stiffness(of.scene.liner, setup.places))
    return massless_run(of.scene, setup, boundary) if setup.h < stable else None


def central(of: Rub, fraction: float) -> Run | None:
    """By central differences at a ``fraction`` of their limit, which a rigid casing has not."""
    limit = of.at(SAMPLES).limit
    if limit == 0:
        return None
    steps = SAMPLES * ceil(2 * np.pi / of.Omega / limit / fraction / SAMPLES)
    explicit = {"scheme": "central-difference", "steps_per_round": steps}
    scene = of.scene.but(integrator=explicit)
    setup = prepare(scene, of.rom, of.Omega)
    modes = setup.omega, setup.Phi_b, scene.damping_ratio, setup.h
    return own_run(scene, setup, central_difference.coefficients(*modes))


def apart(one: NDArray[np.float64], other: NDArray[np.float64]) -> float:
    """Relative difference, of root mean squares."""
    return float(np.linalg.norm(one - other) / np.linalg.norm(other))


def error(run: Run, converged: Run) -> float:
    """The larger error of displacement, over all revolutions, and worn depth, over all rods."""
    seen = [(run.u_r, converged.u_r), (run.wear, converged.wear)]
    return max(apart(*pair) for pair in seen if pair[1].any())
