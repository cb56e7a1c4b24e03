"""Functions of the rules of `identify`: fits, and numbers at draws."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from geometry.project import Say, silent
from rom.model import Rom
from simulate.scene import Scene
from simulate.scene.design import Design
from simulate.sweeps.design_runs import Rows
from workflow.experiment.engine import march_block
from workflow.identify.fits import (
    DRAWS,
    POSTERIORS,
    PRIOR,
    drawn,
    fit,
    of_fit,
    off_medoid,
    posterior_of,
    prior_numbers,
)
from workflow.identify.likelihood import FITS, K_OF_E1, SHIFTS, WITH_ORDER
from workflow.identify.measured import cases, scenes_at
from workflow.identify.points import TablePoints, marched
from workflow.identify.priors import Priors
from workflow.identify.proposal import served
from workflow.identify.table import COATINGS
from workflow.paper.editions import growth_of, numbers_of


def fits(points: list[TablePoints], rows: list[Rows], priors: Priors) -> dict[str, Any]:
    """All fits from all tables."""
    tables = marched(points, rows)
    every = drawn(tables)
    values = priors.values(every["points"].values)
    return {
        "values": {name: samples.tolist() for name, samples in values.items()},
        "served": served(tables[0]),
        "prior": prior_numbers(priors),
        "fits": {each_fit.name: fit(each_fit, every, values) for each_fit in FITS},
    }


def of_scene(
    points: list[TablePoints],
    fits: Mapping[str, Any],
    priors: Priors,
    parameters: Mapping[str, float],
) -> dict[str, float | None]:
    """How near to the medoid of the fit that they are taken from the parameters of a scene are."""
    every = np.vstack([table["points"] for table in points])
    return {"off_medoid": off_medoid(fits, every, priors.point(parameters))}


def blades(fits: list[dict[str, Any]], names: Sequence[str]) -> dict[str, dict[str, Any]]:
    """Fits of the reading that the draws served, by blade and by K of the coating with E = 1."""
    return {name: _served_fits(numbers) for name, numbers in zip(names, fits, strict=True)}


def _served_fits(numbers: Mapping[str, Any]) -> dict[str, Any]:
    fits = {f"{K:g}": of_fit(numbers, K) for K in K_OF_E1}
    return {
        "served": numbers["served"],
        "fits": {
            K: {
                "chi_squared": fit_numbers["chi_squared"],
                **{
                    key: fit_numbers[SHIFTS][key]
                    for key in ("met", "effective", "evidence", "ranges")
                },
                "evidence_with_order": fit_numbers[WITH_ORDER]["evidence"],
            }
            for K, fit_numbers in fits.items()
        },
    }


def at_draws(
    fits: list[dict[str, Any]],
    tables: list[str],
    rom: Rom,
    scene: Scene,
    parts: Mapping[str, Any],
    draws: str,
    block: int,
    blocks: int,
    folder: str,
    tell: Say = silent,
) -> list[dict[str, Any]]:
    """Numbers at every ``blocks``-th of the draws, of the prior or of a posterior, from ``block``.

    ``fits``: those of the posterior, if it is one; ``scene``: of the ``tables``; ``parts``: of the
    claims, by part; ``folder``: of the rows that are done.
    """
    point_scenes = _scenes(tables, scene)
    scenes = {part: Scene.model_validate(given) for part, given in parts.items()}
    K_of_E1 = K_OF_E1 if draws == PRIOR else [POSTERIORS[draws][0]]
    drawn_points = posterior_of(*fits, draws)["draws"] if fits else range(DRAWS)
    block_points = drawn_points[block::blocks]
    rows = [
        row
        for i in dict.fromkeys(block_points)  # a point may be drawn twice
        for row in cases(str(i), scenes_at(scenes, point_scenes[i], rom.span), K_of_E1)
    ]
    done = march_block(rows, folder, tell=tell)
    by_point = numbers_of(done, growth_of(done))
    return [{"point": i} | by_point[str(i)] for i in block_points]


def _scenes(tables: list[str], scene: Scene) -> list[Scene]:
    """A scene of each point: that of its first coating."""
    designs = [Design.of(scene.but(design=Path(file).name), Path(file)) for file in tables]
    return [row for each in designs for row in each.scenes[:: len(COATINGS)]]
