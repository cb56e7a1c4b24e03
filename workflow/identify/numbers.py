"""Functions of the rules of `identify`: from input files and settings to plain values or text."""

from typing import Any

import numpy as np

from geometry.files import read_json
from rom.model import Rom
from simulate.design_runs import load
from workflow.identify import emulator
from workflow.identify.fits import Drawn, fit
from workflow.identify.likelihood import FITS
from workflow.identify.posterior import mixture, systematic
from workflow.identify.priors import Points, Priors
from workflow.identify.table import design, joined, observed, settings, sobol, stiffness

SEED, SEED_OF_CANDIDATES = 1, 2
CANDIDATES = 2**16  # points at which the emulated posteriors are known


def csv(table: dict[str, Any]) -> str:
    """The table of a design that these points give."""
    return design({column: np.array(values) for column, values in table["settings"].items()})


def _table(files: Any, points: Points) -> dict[str, Any]:
    """Points, and the keys of the scene there."""
    ratio = stiffness(Rom.load(files.rom)) / stiffness(Rom.load(files.reference))
    columns = settings(Priors.load(files.priors), points, ratio)
    return {
        "points": points.tolist(),
        "settings": {column: values.tolist() for column, values in columns.items()},
    }


def prior(files: Any, number: int) -> dict[str, Any]:
    """Points drawn from the prior."""
    return _table(files, sobol(number, SEED))


def proposed(files: Any, number: int) -> dict[str, Any]:
    """Points drawn from equal parts of the emulated posteriors of all fits.

    Their density relative to the prior is that at the points of the prior, then at their own.
    """
    points, of_rows = np.array(read_json(files.points)["points"]), observed(load(files.rows))
    candidates = sobol(CANDIDATES, SEED_OF_CANDIDATES)
    everywhere = np.vstack([candidates, points])
    likelihoods = np.array(
        [
            emulator.likelihood(points, fit.deviations(of_rows.over_crossing), everywhere)
            for fit in FITS
        ]
    )
    density = mixture(likelihoods, likelihoods[:, :CANDIDATES].mean(axis=1))
    drawn = systematic(density[:CANDIDATES], number, np.random.default_rng(SEED))
    table = _table(files, candidates[drawn])
    return table | {"density": [*density[CANDIDATES:], *density[drawn]]}


def fits(files: Any) -> dict[str, Any]:
    """All fits from the two tables."""
    tables, parameters = [read_json(file) for file in files.points], Priors.load(files.priors)
    points = [np.array(table["points"]) for table in tables]
    drawn = Drawn(
        np.vstack(points),
        joined([observed(load(file)) for file in files.rows]),
        len(points[0]),
        np.array(tables[-1]["density"]),
    )
    values = parameters.values(drawn.points)
    return {
        "points": drawn.points.tolist(),
        "of_prior": drawn.of_prior,
        "values": {name: of.tolist() for name, of in values.items()},
        "fits": {of.name: fit(of, drawn, values) for of in FITS},
    }
