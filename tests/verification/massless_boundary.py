"""The massless boundary of Monjaraz Tec, Gross and Krack beside ``piecewise-exact``.

Both on the same reduced models and casings: numbers of converged runs, and errors of steps. Errors
over CPU time: ``massless_study.py``.
"""

from collections.abc import Iterable, Iterator

import numpy as np
import peer
from cases import Case, Row
from closing import closing
from massless import Run
from massless_runs import (
    FIXED,
    LAST,
    LAWS,
    MASSLESS,
    MEASURED,
    OWN,
    PEAK,
    RICH,
    SAMPLES,
    STATIC,
    assembled,
    error,
    exact,
    massless,
    model,
    reduced,
    rub,
)

from geometry.base import read_json
from geometry.hats import middles
from geometry.tip import EDGES
from rom.model import Rom
from simulate.signals import spectrum
from workflow.markdown import table

FINE, SHORT = 32768, 2048  # steps per revolution: converged, and the product's for 1 %
FEW, ALL = 24, RICH  # dynamic modes with a massless boundary: most natural modes, all
DESIGN = 1800.0  # rad/s
FAST = "rotor37-fast", 4.0  # mm
FIRST, COARSE = 3, 512  # revolutions and steps in each, by the program in NumPy
NUMBERS = (
    "amplitude of EO 2, m",
    "amplitude of EO 4, m",
    "largest displacement, m",
    "mean contact force, N",
    "mean worn depth, m",
)


def on_reference() -> Iterator[Row]:
    """Converged runs of both, and errors of a usual step, with each law of the liner."""
    rom = model("reference", 5.0, RICH)
    for casing, law in LAWS.items():
        of = rub(rom, law, PEAK)
        converged = exact(of, FINE)
        yield from beside(f"{casing}, ", massless(ALL, of, FINE), converged)
        name, theirs = f"{casing}: error, {SHORT} steps", massless(FEW, of, SHORT)
        yield off(f"{name}, `piecewise-exact`", exact(of, SHORT), converged, 0.01)
        yield off(f"{name}, massless boundary, {FEW} modes", theirs, converged, 0.05)
    yield by_numpy(rom)


def by_numpy(rom: Rom) -> Row:
    """Mean worn depth after some revolutions by the independent program, and ours.

    Its casing has no scale.
    """
    of = rub(rom, LAWS["plastic liner"], PEAK)
    changed = {"rounds": FIRST, "record__spectrum_rounds": 1, "casing__scale": 1.0}
    of = of._replace(scene=of.scene.but(**changed))
    theirs = peer.piecewise_exact(rom, of.scene, of.Omega, COARSE, COARSE * FIRST).wear.mean()
    name = f"plastic liner, mean worn depth after {FIRST} revolutions, by the program in NumPy, m"
    return Row(name, float(theirs), float(exact(of, COARSE).wear.mean()), 1e-9)


def on_rotor_37() -> Iterator[Row]:
    """Converged runs of both at the design speed, on an oval casing."""
    (rom, T), (_, fom, facets) = reduced(*FAST, RICH), assembled(*FAST)
    oval = [{"order": 2, "amplitude_gaps": 1.0}]
    changed = {"casing__harmonics": oval, "casing__scale": 1.5}
    of = rub(rom, LAWS["rigid casing"], DESIGN / rom.omega1, **changed)
    rows = closing(facets, fom, T, np.array([*middles(of.scene.liner.m), *EDGES]))
    dynamic = ALL + 2 * len(rom.xi)  # radial and axial DoFs
    ours, theirs = exact(of, FINE), massless(dynamic, of, FINE, rows)
    yield from beside("", theirs, ours)
    along = exact(of._replace(scene=of.scene.but(casing__slope=0.0)), FINE)
    for name, one in zip(NUMBERS, numbers(along), strict=True):
        if one > 0:
            yield Row(f"{name}, by contact along the radius", None, one, 2e-3)


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
    of_orders = amplitudes[[2 * LAST, 4 * LAST]]
    return [float(of) for of in (*of_orders, abs(run.u_r).max(), force, run.wear.mean())]


def off(quantity: str, run: Run, converged: Run, tolerance: float) -> Row:
    """Row of an error."""
    return Row(quantity, 0.0, error(run, converged), tolerance, scale=1.0)


def conclusion() -> str:
    """What the study of errors over CPU time says."""
    found = read_json(MEASURED)
    return CONCLUSION.format(
        picture=PICTURE,
        table=table(HEAD, found["levels"]),
        basis=percent(found["basis"].values()),
        usual=at_the_peak(OWN, 24, 8192),
        long=at_the_peak(OWN, 24, 512),
        dynamic=at_the_peak(MASSLESS, 24, 8192),
        fixed=at_the_peak(FIXED, 24, 8192),
        static=at_the_peak(STATIC, 24, 2048),
        half=at_the_peak(STATIC, 24, 4096),
        elsewhere=elsewhere(OWN, 24, 512),
        fewest="6 run with {} steps per revolution, 24 with {}, 60 with {}".format(
            *(fewest(modes) for modes in (6, 24, 60))
        ),
    ).rstrip()


def at_the_peak(*tried: str | float) -> str:
    """Errors of a method with its modes and setting on each casing."""
    points = read_json(MEASURED)["points"]
    return percent(errors[-1] for _, *of, errors, _ in points if of == [*tried])


def elsewhere(*tried: str | float) -> str:
    """Least and largest error at the other speeds, %."""
    points = read_json(MEASURED)["points"]
    errors = [of for _, *at, errors, _ in points if at == [*tried] for of in errors[:-1]]
    return f"{100 * min(errors):.1f} to {100 * max(errors):.1f}"


def fewest(modes: int) -> int:
    """Fewest steps per revolution of so many dynamic modes on a rigid casing."""
    points = read_json(MEASURED)["points"]
    return min(of[3] for of in points if of[:3] == ["rigid casing", MASSLESS, modes])


def percent(shares: Iterable[float]) -> str:
    """Shares on the three casings."""
    return "{:.2g}, {:.2g} and {:.2g} %".format(*(100 * share for share in shares))


SOURCE = (
    "[test code](simulate/massless.py) after Monjaraz Tec, Gross, Krack, Comput. Struct. 260 "
    "(2022) 106698; no digits of the paper"
)
HEAD = [
    "casing",
    "error",
    "piecewise-exact, ms",
    "massless boundary, over it",
    "at each speed",
    "central differences, over it",
]
SHARED = "same reduced model, contact and liner code: checks time integration and reduction alone"
PICTURE = "![Error over CPU time on three casings](verification/massless_study.png)"
CONCLUSION = """{picture}

Measured by `./run python tests/verification/massless_study.py`: runs of 20 revolutions at 0.30,
0.34 and 0.38 f₁(0). Error: the larger of displacement, over all revolutions, and worn depth, at the
worst of the speeds, against `piecewise-exact` with 65,536 steps per revolution on a basis of 60
natural modes; so the errors of the reduced models are in it. A basis of 90 changes these converged
runs at 0.38 f₁(0) by {basis} (rigid, elastic, plastic); the usual one of 24 errs
there by {usual}, and smaller errors are not compared. CPU times are those of the
cheapest setting within an error, of the compiled kernel alone, to one digit, as they scatter by
30 %: of three runs, and as ratios at each speed with the settings for that speed. In brackets the
modes: of `piecewise-exact` the natural modes of the basis (24 or 60), of the massless boundary the
dynamic ones (6 to 60; the others of the basis of 60 are static). Central differences are on the
usual basis.

{table}

- The massless boundary is faster on a rigid casing for errors of 10 and 3 %, and as fast there for
  smaller ones and on an elastic liner for 10 and 3 %. With settings for each speed alone it is
  faster by more than the scatter in one case: 3 % on a rigid casing at 0.30 f₁(0).
- On a plastic liner, and for 1 % and less on an elastic one, `piecewise-exact` is 2 to 3 times as
  fast. Its free motion is exact, its force a mean over the way in the step.
- The speed 0.38 f₁(0), at the peak, decides most: with 512 steps per revolution `piecewise-exact`
  errs there by {long} (rigid, elastic, plastic), at the other two by {elsewhere} %.
  Energies and status of such runs are in order; with `verify: every` they are `inaccurate`
  ([test](verification/test_massless_study.py), on a coarser blade).
- The error of a massless boundary ends at the inertia of the static modes: with 24 dynamic ones
  at {dynamic} at 0.38 f₁(0). More dynamic modes need shorter steps: on a rigid casing
  {fewest}, the fewest of those tried. The
  reduction of Craig and Bampton in the paper ends at {fixed}, with 24 modes as well.
- Central differences, with mass at the interface and none scaled, take 7 to 30 times as long as the
  massless boundary, about one order (the paper: one to two). On a rigid casing they have no stable
  step. A step with a massless boundary takes nearly as long as one of `piecewise-exact`: contact is
  most of it.
- To take: a third scheme, near 110 statements, 70 as in the test code, the others for ledger,
  starts, refusals and settings; for drafts on rigid casings alone. Static modes within
  `piecewise-exact` are not worth it: their error is first order in the step, with 24 dynamic modes
  {static} at 2048 steps per revolution, {half} at 4096.
"""
BY = "massless boundary, NumPy or limit"
CASE = Case(
    title="The massless boundary on the same blade",
    source=SOURCE,
    compared="The reference blade (elements of 5 mm, 60 natural modes) rubs for 20 revolutions at "
    "the peak of EO 4, 0.38 f1(0), in the paper's casing, E = 10. Theirs: MacNeal's reduction, "
    "leapfrog of the lowest free modes, contact static at the interface. Converged: "
    f"{FINE} steps per revolution, {ALL} dynamic modes; errors are against `piecewise-exact` on "
    "the same basis. Amplitudes (xi = 1/16) and force: last ten revolutions. Theirs is the "
    f"{SHARED}. The last row is the independent program [in plain NumPy](simulate/peer.py), with "
    f"its own liner and integration: {FIRST} revolutions of {COARSE} steps, casing of scale 1.",
    reason="the inertia of the modes that are static in theirs; 2048 steps are those of the "
    "product's level of 1 %, at which the massless boundary errs by up to 4 %; the "
    "program in NumPy solves the same equations.",
    rows=on_reference,
    conclusion=conclusion(),
    by=BY,
    study=True,
    nightly=True,
)
ROTOR_37 = Case(
    title="Rub of rotor 37 on a rigid casing",
    source=SOURCE,
    compared="NASA rotor 37 (elements of 4 mm, 60 natural modes) at 1800 rad/s in an oval rigid "
    f"casing, largest 1.5 gaps inward; 20 revolutions from rest, {FINE} steps per revolution, "
    f"{ALL} dynamic modes in theirs, and as many more as interface DoFs ({SHARED}). Contact is "
    "along the normal of the casing; the motion towards it is in theirs that of the tip's facets, "
    "by the places of their nodes. Along the radius, as up to 0.3.0, the axial motion is left out.",
    reason="the inertia of the modes that are static in theirs.",
    rows=on_rotor_37,
    by=BY,
    study=True,
    nightly=True,
)
