"""Functions of the rules of `identify`: points, fits, and numbers at draws."""

from collections.abc import Mapping
from typing import Any

from geometry.project import Say, silent
from simulate.scene import Scene
from workflow.experiment.engine import march_block
from workflow.identify.blades import BladeNumbers
from workflow.identify.fits import K_TAKEN, drawn, fit, posterior_of, prior_numbers
from workflow.identify.likelihood import FITS
from workflow.identify.measured import cases, scenes_at
from workflow.identify.points import Blades, TablePoints, drawn_cube, parameters_at
from workflow.identify.priors import Priors
from workflow.identify.proposal import SEED, drawn as proposed, served
from workflow.identify.table import TableRows, tables
from workflow.paper.editions import growth_of, numbers_of


def table(
    rows: list[TableRows],
    blades: list[BladeNumbers],
    priors: Priors,
    number: int,
    data: str | None = None,
) -> TablePoints:
    """Points of a table: of the prior, or drawn by ``data`` from the tables before it."""
    before = tables(rows, Blades.of(blades, priors))
    new = drawn_cube(number, SEED) if data is None else proposed(before, number, data)
    return {"data": data, "cube": new.tolist()}


def fits(rows: list[TableRows], blades: list[BladeNumbers], priors: Priors) -> dict[str, Any]:
    """All fits from all tables."""
    marched = tables(rows, Blades.of(blades, priors))
    every = drawn(marched)
    values = priors.values(every["points"].values)
    return {
        "values": {name: samples.tolist() for name, samples in values.items()},
        "blade": every["number"].values.tolist(),
        "served": served(marched[0]),
        "prior": prior_numbers(priors),
        "fits": {each_fit.name: fit(each_fit, every, values) for each_fit in FITS},
    }


def at_draws(
    fits: Mapping[str, Any],
    parts: Mapping[str, Any],
    names: dict[str, str],
    blocks: int,
    folder: str,
    tell: Say = silent,
) -> dict[str, dict[str, Any]]:
    """Numbers at every ``blocks``-th of the points that are judged, from that of the block on.

    These are the medoid and the draws. ``parts``: scenes of the claims, by part; ``folder``: of the
    rows that are done.
    """
    scenes = {part: Scene.model_validate(given) for part, given in parts.items()}
    posterior = posterior_of(fits)
    points = [*dict.fromkeys([posterior["medoid"], *posterior["draws"]])]
    rows = [
        row
        for i in points[int(names["block"]) :: blocks]
        for row in cases(
            str(i),
            scenes_at(
                scenes, parameters_at(fits["values"], i), f"{names['prior']}-{fits['blade'][i]}"
            ),
            K_TAKEN,
        )
    ]
    done = march_block(rows, folder, tell=tell)
    return numbers_of(done, growth_of(done))
