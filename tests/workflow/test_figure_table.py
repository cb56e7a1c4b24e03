"""The table of figures: its rows, the files of a figure, what a plain run delivers; captions."""

from importlib import import_module
from inspect import signature
from math import log10
from types import SimpleNamespace as Made

import pytest
from projects import ROOT, TABLES
from refused import refused

from geometry.base import SettingsError
from simulate.errors.neighbours import GAP_CHANGE
from simulate.marching import SENSITIVE_FROM
from simulate.scene.casing import COUNTS
from simulate.signals import LOBE_PROMINENCE
from simulate.sweeps import peak as peaks
from workflow.figures import table

ROWS = table.read(*TABLES)


def scene(blade="thin", design=None, gaps="running", count=9, touches=True, stage=None, **record):
    return Made(
        blade=blade,
        directions="r",
        design=design,
        stage=stage,
        force=None,
        gaps=Made(vary=gaps == "rest"),
        speeds=Made(count=count),
        liner=Made(law=Made(touches=touches)),
        record=Made(
            **{"wear": False, "spectrum_rounds": 10, "states_rounds": 0, "gauges": None} | record
        ),
    )


SCENES = {
    "soft": scene(),
    "hard": scene(wear=True, gaps="rest"),
    "free": scene("given", touches=False),
    "staged": scene("given", stage=Made(count=2)),
    "drawn": scene(design="five.yaml"),
    "listed": scene(design="rows.csv"),
    "paper-e1": scene("paper", wear=True),
    "paper-e10": scene("paper", wear=True),
}


def figures_of(*configured):
    return table.Figures(
        ROWS,
        scenes=SCENES,
        delivered={name: SCENES[name] for name in configured},
        stressed=["hard"],
        directions=lambda blade: "rt",
        operating={"thin": {"design": 9e3}, "given": {}, "paper": {}}.get,
        blades=dict.fromkeys(["matrices", "mesh", "fatigue"], lambda name: name != "given"),
    )


@pytest.mark.parametrize("name", ROWS)
def test_a_row_draws_with_what_it_gives(name):
    row = ROWS[name]
    name, _, function = row.draw.partition(":")
    module = import_module(f"workflow.{name}")
    known = signature(getattr(module, function or "draw")).parameters
    assert {*row.given} <= {*known} and ("operating" in known or not row.operating)
    assert {*row.files} - {"rom"} <= {*known}
    wildcards = {"blade": "thin", "scene": "hard", "prior": "narrow"}
    for pattern in row.files.values():
        for path in [pattern] if isinstance(pattern, str) else pattern:
            path.format(**wildcards, directions="r", name=name, stressed="hard")
    assert f"{row.caption} {row.more}".format(**wildcards)


def test_files_are_those_of_the_scenes():
    of = figures_of("soft", "hard", "drawn", "free")
    assert of.files("spectra-{scene}", {"scene": "soft"}) == {
        "rom": "results/thin/rom-r.nc",
        "sweep": "results/thin/soft/sweep.nc",
    }
    loads = of.files("loads-{blade}", {"blade": "thin"})
    assert loads["rom"] == "results/thin/rom-rt.nc"
    assert loads["sweeps"] == [f"results/thin/{name}/sweep.nc" for name in ("soft", "hard")]
    assert loads["stress"] == ["results/thin/hard/stress.json"]


def test_only_a_design_over_seeds_has_their_distribution(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "workflow/scenes").mkdir(parents=True)
    for name, head in (("seeds", "stage.longer_um.seed"), ("rows", "liner.law.K")):
        (tmp_path / f"workflow/scenes/{name}.csv").write_text(f"{head}\n1\n2\n")
    monkeypatch.setitem(SCENES, "seeds", scene("given", design="seeds.csv"))
    monkeypatch.setitem(SCENES, "rows", scene("given", design="rows.csv"))
    drawn = figures_of("seeds", "rows").configured(lambda row: row.part == table.DELIVERED)
    assert drawn == ["design-seeds", "design-rows", "distribution-seeds"]


def test_a_figure_marks_the_operating_speeds_of_its_blade():
    of = figures_of("soft", "paper-e1")
    assert of.given("spectra-{scene}", {"scene": "soft"}) == {"operating": {"design": 9e3}}
    assert of.given("fig10a", {}) == {"part": "e1"}
    assert of.caption("fig10a", {}).endswith("the crossing of this blade.")


@pytest.mark.parametrize(
    ("configured", "delivered"),
    [
        (
            ["soft"],
            [
                "campbell-thin",
                "modes-thin",
                "spectra-soft",
                "loads-thin",
                "haigh-soft",
                "stress-soft",
            ],
        ),
        (["free"], ["spectra-free"]),
        (["staged"], ["spectra-staged", "blades-staged", "loads-given"]),
        (["drawn"], ["campbell-thin", "modes-thin", "design-drawn", "sensitivity-drawn"]),
        (["listed"], ["campbell-thin", "modes-thin", "design-listed"]),
        (
            ["paper-e1"],
            [
                "fig03",
                "fig09",
                "fig10a",
                "loads-paper",
                "haigh-paper-e1",
                "stress-paper-e1",
                "fig11a",
            ],
        ),
        (
            ["paper-e1", "paper-e10"],
            [
                *("fig03", "fig09", "fig10a", "fig10b", "loads-paper"),
                *("haigh-paper-e1", "haigh-paper-e10", "stress-paper-e1", "stress-paper-e10"),
                *("fig11a", "fig11b", "fig12"),
            ],
        ),
    ],
)
def test_a_plain_run_delivers_what_its_scenes_have(configured, delivered):
    found = figures_of(*configured).configured(lambda row: row.part == table.DELIVERED)
    assert sorted(found) == sorted(delivered)


@pytest.mark.parametrize(
    ("name", "wildcards", "file", "key"),
    [
        ("stress-{scene}", {"scene": "free"}, "workflow/blades/given.yaml", ""),
        ("gap-{scene}", {"scene": "soft"}, "workflow/scenes/soft.yaml", "gaps"),
        ("sensitivity-{scene}", {"scene": "soft"}, "workflow/scenes/soft.yaml", "design"),
        ("modes-{blade}", {"blade": "given"}, "workflow/blades/given.yaml", ""),
        ("loads-{blade}", {"blade": "given"}, "", ""),
    ],
)
def test_a_figure_of_what_is_not_there_is_refused(name, wildcards, file, key):
    error = refused(SettingsError, figures_of("soft", "free").files, name, wildcards)
    assert (error.file, error.key) == (file, key)


@pytest.mark.parametrize(
    ("text", "key"),
    [("{like: other}", "worn.like"), ("{title: a, caption: b, draws: c}", "draws")],
)
def test_a_fault_of_the_table_has_its_row_and_key(tmp_path, text, key):
    path = tmp_path / "figures.yaml"
    path.write_text(f"delivered:\n  Wear:\n    worn: {text}\n")
    assert key in [fault.key for fault in refused(SettingsError, table.read, path).faults]


TWIN = (f"one part in 10^{-log10(GAP_CHANGE):g}", f"over {100 * SENSITIVE_FROM:g} %")
CAPTIONS = {
    "spectra-{scene}": (
        f"reaches {peaks.LEAST:g} of the gap",
        f"by {peaks.PROMINENCE:g} of its height",
        f"at {peaks.LEAST_AT_END:g} gap or more",
        *TWIN,
    ),
    "wear-{scene}": (f"stand out by {LOBE_PROMINENCE:g} of its depth", *TWIN),
    "fig12": TWIN,
    "stress-{scene}": TWIN,
}


PAGE = (  # of simulate/README.md
    f"{100 * COUNTS:g} % of its largest",
    f"from {peaks.STIFFENED:g} (with a tangential force {peaks.SOFTENED:g}) to {peaks.HIGHEST:g}",
    f"both cross within {100 * peaks.NEAR:g} %",
)


def test_the_page_has_the_thresholds_of_the_code():
    page = " ".join((ROOT / "simulate/README.md").read_text().split())
    assert [words for words in PAGE if words not in page] == []


@pytest.mark.parametrize(("name", "said"), CAPTIONS.items())
def test_captions_have_the_thresholds_of_the_code(name, said):
    caption = " ".join(ROWS[name].caption.split())
    assert [words for words in said if words not in caption] == []
