"""Every figure, drawn from made data: axes named with units, no text cut off or over another."""

from dataclasses import replace

import pytest
from test_convergence_figures import densities, histories  # noqa: F401
from test_figures import bent, check, rom, seen, stressed, sweep, twinned  # noqa: F401
from test_figures_setup import blade, footprint_files, footprints, paper, shapes  # noqa: F401
from test_gap_figure import response  # noqa: F401
from test_grid_figures import read  # noqa: F401
from test_long_times import (
    cases,  # noqa: F401
    files as long_files,  # noqa: F401
)
from test_mesh_convergence import summary  # noqa: F401
from test_scaling import study as cost  # noqa: F401
from test_spectrogram import files as spectrogram_files  # noqa: F401
from test_stability_studies import ENGAGED
from test_trade_figures import features, study  # noqa: F401
from tidy import faults

from workflow.figures import (
    fig02_blade,
    fig03_campbell,
    fig04_footprint,
    fig05_laws,
    fig06_casing,
    fig07_densities,
    fig08_displacement,
    fig10_spectra,
    fig11_wear,
    fig12_profiles,
    fig13_grid,
    fig16_spectrogram,
    gap,
    long_times,
    status_grid,
    stress,
    style,
    trade,
    trade_features,
    trade_steps,
    worst,
)
from workflow.jobs.figure import read as read_files
from workflow.study import mesh, scaling
from workflow.study.stability import report


def apart(model):
    """The model with its third mode above the second, whose names would meet."""
    K = model.K.copy()
    K[0, 2, 2] *= 2
    return replace(model, K=K)


def drawn(figure, files):
    """A figure, of files."""
    return figure.draw(*read_files(figure, files))


SCHEMES = ("central-difference", "piecewise-exact")
PASSED = {scheme: {"wear": {"0.01": 1e-7, "0.1": None}} for scheme in SCHEMES}
INTERMITTENT = [{"E": E, "limit": 5e-7} | PASSED for E in (1, 10)]
FIGURES = {
    "fig02": lambda get: fig02_blade.draw(get("blade")),
    "fig03": lambda get: fig03_campbell.draw(apart(get("rom")), get("check")),
    "fig04": lambda get: fig04_footprint.draw(*get("footprints")),
    "fig05": lambda get: fig05_laws.draw(),
    "fig06": lambda get: fig06_casing.draw(*get("shapes")),
    "fig07": lambda get: drawn(fig07_densities, get("densities")),
    "fig08": lambda get: drawn(fig08_displacement, get("histories")),
    "fig10": lambda get: fig10_spectra.draw(get("seen")),
    "fig10 with twins": lambda get: fig10_spectra.draw(get("twinned")),
    "fig11": lambda get: fig11_wear.draw(get("seen")),
    "fig11 with twins": lambda get: fig11_wear.draw(get("twinned")),
    "fig12": lambda get: fig12_profiles.draw(get("seen"), get("twinned")),
    "fig13": lambda get: drawn(fig13_grid, get("read")),
    "fig16": lambda get: fig16_spectrogram.draw(
        *read_files(fig16_spectrogram, get("spectrogram_files"))
    ),
    "gap": lambda get: gap.draw(get("response")),
    "long times": lambda get: drawn(long_times, get("long_files")),
    "states of the grid": lambda get: drawn(status_grid, get("read")),
    "stress": lambda get: stress.draw(*stressed(bent, lambda mesh: 4e8 * (mesh[:, 1] == 1))),
    "trade": lambda get: trade.draw(get("study")),
    "features": lambda get: trade_features.draw(get("features")),
    "steps": lambda get: trade_steps.draw(get("study")),
    "mesh": lambda get: mesh.draw(get("summary")),
    "cost": lambda get: scaling.draw(get("cost")),
    "stability": lambda get: report.draw({"engaged": ENGAGED, "intermittent": INTERMITTENT}),
    "worst": lambda get: drawn(worst, get("cases")),
}


@pytest.mark.parametrize("name", FIGURES)
def test_a_figure_has_its_labels_and_nothing_is_cut_or_hidden(name, request):
    assert faults(FIGURES[name](request.getfixturevalue)) == []


def test_faults_of_a_figure_are_found():
    drawn, axes = style.subplots(style.SINGLE, 2.0)
    axes.text(0.5, 0.5, "one")
    axes.text(0.5, 0.5, "another")
    axes.text(0.9, 0.9, "far beyond the edge of the figure").set_in_layout(False)
    axes.set_xlabel("speed")
    found = [fault.split(":")[0] for fault in faults(drawn)]
    assert found == ["cut off", "over one another", "no unit", "no label"]
