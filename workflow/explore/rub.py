"""An animation of one run: the tip passes the distorted casing, and the liner wears."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
import xarray as xr
from matplotlib.animation import FuncAnimation, writers
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from geometry.base import UserError, whole
from rom.model import Rom
from simulate.contact.gaps import gaps_at, given_gaps
from simulate.contact.places import share_weights
from simulate.errors.accuracy import Choice
from simulate.errors.run import as_long
from simulate.marching import AnyEnd, Outcome, Setup, check_scene, march, prepare
from simulate.scene import LEADING, Record, Scene
from simulate.sweeps.continued import before
from workflow.figures import style

FRAMES, RATE = 16, 16  # in a revolution, in a second
PIXELS = 110  # per inch
WRITERS = {".gif": "pillow", ".png": "pillow", ".mp4": "ffmpeg"}
DRAWN = 0.1  # of the casing's radius, one gap in the drawing
SEEN = 3  # revolutions of the displacement shown at a time
TIP = {"color": style.BLACK, "linewidth": 1.6}
LINER = {"color": style.VERMILLION, "linewidth": 1.4}
NEW = {"color": style.GREY, "linewidth": 0.8, "linestyle": "--"}


@dataclass(frozen=True)
class Rub:
    """One run, with the liner after every revolution; lengths over the gap."""

    speed: float  # over f1(0)
    tip: float  # rad, of xi = 1/16 at the start
    ended: str | None  # status of a run that ended before its last revolution
    # (nu,), the casing's distortion at the end of its ramp, by the time in revolutions
    inward: Callable[[float], NDArray[np.float64]]
    travels: bool  # whether it depends on the time
    share: NDArray[np.float64]  # (revolutions, samples) of it at each time
    wear: NDArray[np.float64]  # (revolutions + 1, nu), leading eighth
    u_r: NDArray[np.float64]  # (revolutions, samples), at xi = 1/16; nan after the end

    def turn(self, sample: int) -> float:
        """Angle of the tip in the casing after a sample of a revolution, in revolutions."""
        return self.tip / (2 * np.pi) + (sample + 1) / self.u_r.shape[1]

    def liner(self, done: int, sample: int) -> NDArray[np.float64]:
        """Wear (nu,): behind the tip of this revolution, ahead of it of the one before."""
        nu, samples = self.wear.shape[1], self.u_r.shape[1]
        since = (np.arange(nu) / nu - self.tip / (2 * np.pi)) % 1  # of the revolution, when passed
        passed = since < (sample + 1) / samples
        return np.where(passed, self.wear[done + 1], self.wear[done])


def by_rounds(
    scene: Scene,
    rom: Rom,
    over_f1: float,
    choice: Choice | None = None,
    start: xr.Dataset | None = None,
) -> Rub:
    """Run the scene at one speed, revolution by revolution, each from the end of the one before.

    ``choice`` and ``start`` are those of the scene, as in ``simulate.sweeps.sweep.sweep``.

    Raises
    ------
    simulate.marching.setup.SceneError
        As a sweep.
    """
    scene = choice.scene(scene) if choice else scene
    scene = scene.but(speeds={"over_f1": [over_f1], "rpm": None, "in_turn": False}, peaks=None)
    (Omega,) = scene.speeds.omega(rom.f1)
    check_scene(scene, rom)
    first = before(scene, rom, start)(Omega)
    if scene.until:  # as long as the run of the sweep
        scene = as_long(scene, march(scene, prepare(scene, rom, Omega), first).rounds)
    one = scene.but(
        rounds=1,
        record=Record(
            samples_per_round=scene.record.samples_per_round,
            end=True,
            blades="all" if scene.stage else "worst",
            history={"chord": [LEADING]},
        ),
    )
    setup = prepare(one, rom, Omega)
    outcomes: list[Outcome] = []
    while len(outcomes) < scene.rounds and (not outcomes or outcomes[-1].final):
        outcomes.append(march(one, setup, outcomes[-1].final if outcomes else first))
    return _rub(scene, rom, setup, outcomes, first)


def _rub(
    scene: Scene, rom: Rom, setup: Setup, outcomes: list[Outcome], first: AnyEnd | None
) -> Rub:
    given, nu = float(given_gaps(scene.gaps, rom, LEADING)), setup.strips.d.size
    gap = float(gaps_at(scene.gaps, rom, LEADING, setup.Omega))
    leading = share_weights(setup.places.ends)[0]
    rods = setup.strips.thickness * first.eps_p if first else 0 * outcomes[0].wear
    blades = len(outcomes[-1].each_blade)
    worst = max(
        range(blades),
        key=lambda j: max(outcome.each_blade[j].each.largest[0] for outcome in outcomes),
    )
    gap -= float(scene.stage.longer(given)[worst]) if scene.stage else 0.0
    u_r = np.array([outcome.each_blade[worst].u_r[:, 1] for outcome in outcomes])
    rounds, samples = u_r.shape
    ramped = first.rounds if first else 0
    times = ramped + (np.arange(rounds * samples) + 1) / samples

    def inward(after: float) -> NDArray[np.float64]:
        """Distortion (nu,) of the casing after so many revolutions, over the gap."""
        theta, time = 2 * np.pi * np.arange(nu) / nu, (ramped + after) * 2 * np.pi / setup.Omega
        return scene.casing.inward(theta, given, time) / gap

    return Rub(
        speed=setup.Omega / rom.omega1,
        tip=float(rom.line(np.array([LEADING]))[0, 1]) + 2 * np.pi * worst / blades,
        ended=None if rounds == scene.rounds and outcomes[-1].final else outcomes[-1].status,
        inward=inward,
        travels=bool(scene.casing.travelling),
        share=setup.ramp.at(times).reshape(u_r.shape),
        wear=np.array([leading @ rods, *(leading @ outcome.wear for outcome in outcomes)]) / gap,
        u_r=u_r / gap,
    )


@style.styled
def animation(rub: Rub, title: str, last: bool = False) -> FuncAnimation:
    """The casing around the blade; beside it the worn profile, and the tip's displacement.

    ``title``: name of the run, above the speed and the revolution; ``last``: the last moment alone.
    """
    drawn = style.figure(style.DOUBLE, 3.4)
    panels = _panels(drawn, rub)
    lines = [line for axes in panels for line in axes.lines]
    rounds, samples = rub.u_r.shape
    each = max(samples // FRAMES, 1)
    moments = [(n, s) for n in range(rounds) for s in range(each - 1, samples, each)]
    moments = moments[-1:] if last else moments

    ended = f", ended {rub.ended}" if rub.ended else ""
    above = rf"{title}, $\Omega/f_1(0)$ = {rub.speed:g}"
    drawn.suptitle(above + "\n ", fontsize=8)
    drawn.draw_without_rendering()
    drawn.set_layout_engine("none")  # of the first frame, for all

    def show(frame: int) -> None:
        """Draw a moment into the panels."""
        n, s = moments[frame]
        drawn.suptitle(f"{above}\nrevolution {n + 1} of {rounds}{ended}", fontsize=8)
        for line, data in zip(lines, _lines(rub, n, s), strict=True):
            line.set_data(*data)
        revolutions = n + (s + 1) / samples
        panels[-1].set_xlim(max(0, revolutions - SEEN), max(SEEN, revolutions))

    return FuncAnimation(drawn, show, frames=len(moments), interval=1000 / RATE)


def _lines(rub: Rub, n: int, s: int) -> list[Any]:
    """Places of all lines after a sample of a revolution, in the order in which they are drawn."""
    samples, turn, end = rub.u_r.shape[1], rub.turn(s), n * rub.u_r.shape[1] + s + 1
    distorted = -rub.share[n, s] * rub.inward(n + (s + 1) / samples)
    liner = rub.liner(n, s)
    reach, degrees = np.array([0.55, 1 + DRAWN * (rub.u_r[n, s] - 1)]), 360 * np.arange(liner.size)
    time, u_r = (np.arange(end) + 1) / samples, rub.u_r.ravel()[:end]
    return [
        _circle(distorted),
        _circle(distorted + liner),
        (reach * np.cos(2 * np.pi * turn), reach * np.sin(2 * np.pi * turn)),
        (degrees / liner.size, liner),
        ([360 * (turn % 1)] * 2, [0, 1]),
        (time, u_r),
        (time[-1:], u_r[-1:]),
    ]


def _circle(depth: NDArray[np.float64]) -> NDArray[np.float64]:
    """Closed line (2, nu + 1) around the casing at ``depth`` (nu,), drawn by DRAWN."""
    theta = 2 * np.pi * np.arange(depth.size + 1) / depth.size
    return (1 + DRAWN * np.append(depth, depth[0])) * np.stack([np.cos(theta), np.sin(theta)])


def save(rub: Rub, title: str, path: str | Path) -> None:
    """Write the animation in the format of the path's suffix; of a .png its last picture.

    Raises
    ------
    UserError
        When nothing on this machine writes that format.
    """
    writer = WRITERS[Path(path).suffix]
    if writer not in writers.list():
        raise UserError(f"needs {writer} on PATH: install it, or ask for a .gif", file=path)
    with mpl.rc_context(style.RC), whole(path) as temporary:
        shown = animation(rub, title, last=Path(path).suffix == ".png")
        shown.save(temporary, writer=writer, fps=RATE, dpi=PIXELS)


def _panels(drawn: Figure, rub: Rub) -> list[Axes]:
    """The liner's surface and the tip over the angle; worn depth and the tip; displacement.

    The depth is over the casing angle, the displacement, at xi = 1/16, over the last revolutions
    up to now. Their lines have no data yet.
    """
    grid = drawn.add_gridspec(2, 2, width_ratios=(1, 1.3))
    places = grid[:, 0], grid[0, 1], grid[1, 1]
    around, profile, history = panels = [drawn.add_subplot(place) for place in places]
    for axes, look in (
        (around, {"label": "casing, not worn"} | NEW),
        (around, {"label": "liner"} | LINER),
        (around, {"label": "blade, tip at the gap"} | TIP),
        (profile, LINER),
        (history, {"color": style.BLACK, "linewidth": 0.8}),
        (history, {"color": style.BLACK, "marker": "o", "linestyle": "none"}),
    ):
        axes.plot([], [], **look)
    inward = rub.inward(0.0)
    outward = np.abs(inward).max() if rub.travels else max(0, -inward.min())
    limit = 1.02 * (1 + DRAWN * (outward + rub.wear.max()))
    around.set(aspect="equal", xlim=(-limit, limit), ylim=(-limit, limit))
    around.set_axis_off()
    around.legend(loc="center", fontsize=6.5)
    profile.axvline(0, **TIP)
    profile.set(
        xlabel=r"casing angle $\theta$ (deg)",
        ylabel=f"worn depth\n{style.OVER_GAP}",
        xlim=(0, 360),
        ylim=(0, 1.05 * rub.wear.max() or 1),
        xticks=range(0, 361, 90),
    )
    low, high = np.nanmin(rub.u_r), np.nanmax(rub.u_r)
    margin = 0.05 * (high - low) or 1.0
    history.set(
        xlabel="time (revolutions)",
        ylabel=rf"$u_r$ at {style.PLACE}," + f"\n{style.OVER_GAP}",
        ylim=(low - margin, high + margin),
    )
    return panels
