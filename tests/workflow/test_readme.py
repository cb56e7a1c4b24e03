"""README files: generated blocks, links, and the paths, targets and code that they name."""

import re
import shlex
import shutil
from importlib.util import module_from_spec, spec_from_file_location
from types import SimpleNamespace

import numpy as np
import pytest
import yaml
from made_sweeps import ROOT, save_runs
from projects import TABLES, make_project
from runs import marched
from scenes import EXACT, RUBBING, scene

from geometry.base import check_settings, read_json
from geometry.blade import Blade
from simulate.marching import WITH_RESULT, check_scene
from simulate.scene import Scene
from simulate.scene.laws.plastic import Plastic
from workflow.figures import table
from workflow.jobs.figure import read
from workflow.paper.conclusions import coatings, verdicts
from workflow.readme import (
    COMPUTED,
    PAGES,
    BlockError,
    generated,
    read_pages,
    require_blocks,
    settings_table,
)

TEXTS = read_pages(ROOT)
each_page = pytest.mark.parametrize("page", PAGES)


def blocks(page, language):
    """Code blocks of a page in a language, dedented as lists indent them."""
    of = rf"^( *)```{language}\n(.*?)^ *```"
    found = re.findall(of, TEXTS[page], re.DOTALL | re.MULTILINE)
    return [re.sub(f"^{indent}", "", code, flags=re.MULTILINE) for indent, code in found]


def prose(page):
    """The page without code blocks."""
    return re.sub(r"^ *```.*?^ *```", "", TEXTS[page], flags=re.DOTALL | re.MULTILINE)


def anchors(text):
    """Anchors of the headings of a page, as GitHub makes them."""
    headings = re.findall(
        r"^#+ (.+)$", re.sub(r"^ *```.*?^ *```", "", text, flags=re.S | re.M), re.M
    )
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


@pytest.mark.parametrize(
    "row",
    [
        "| `integrator.fraction_of_limit` | `central-difference`: Step over the stability limit "
        "with contact | > 0, <= 1 |  |",
        "| `liner.law.curve.stress_MPa` | `table`: Stress at these strains (MPa), from 0 |  "
        "| required |",
        "| `casing.harmonics[].order` | Nodal diameters | >= 0, <= 200 | required |",
        "| `record.samples_per_round` | Samples per revolution, for spectrum, history and states "
        "| >= 64, <= 1000000 | `2048` |",
    ],
)
def test_a_row_has_meaning_range_and_default(row):
    assert row in settings_table(Scene).splitlines()


def test_what_the_page_says_a_scene_can_say_is_one():
    """Its lines, put into a scene of ours."""
    (example,) = [code for code in blocks("simulate/README.md", "yaml") if "edge_drop_um" in code]
    shown = yaml.safe_load(example)
    scene = yaml.safe_load((ROOT / "workflow/scenes/paper.yaml").read_text())
    liner = scene["liner"] | shown["liner"]
    check_settings(Scene, scene | shown | {"liner": liner}, "simulate/README.md")


def test_the_stage_that_the_page_shows_is_one():
    """Its lines, put into a scene of ours."""
    (shown,) = [code for code in blocks("simulate/README.md", "yaml") if "stage:" in code]
    of = Scene.load(ROOT / "workflow/scenes/paper-e10.yaml").but(**yaml.safe_load(shown))
    assert of.stage and of.stage.count == 36 and of.record.blades == [0, 7]


@pytest.mark.parametrize("keys", ["casing: {scale: 2.0}", "accuracy: 0.01"])
def test_scenes_on_a_base_that_the_page_shows_are_read(keys, tmp_path):
    (shown,) = [code for code in blocks("simulate/README.md", "yaml") if keys in code]
    shutil.copy(ROOT / "workflow/scenes/paper.yaml", tmp_path)
    (tmp_path / "mine.yaml").write_text(shown)
    Scene.load(tmp_path / "mine.yaml")


def test_sources_of_geometry_that_the_page_shows_are_read():
    """Each put into a blade of ours."""
    blade = yaml.safe_load((ROOT / "workflow/blades/reference.yaml").read_text())
    rest = {key: value for key, value in blade.items() if key not in ("sections", "mesh")}
    codes = blocks("geometry/README.md", "yaml")
    shown = [yaml.safe_load(code) for code in codes if "frequencies_Hz" not in code]
    keys = [check_settings(Blade, rest | one, "geometry/README.md").source_key for one in shown]
    assert keys == ["sections", "section_table", "cad", "mesh_file"]


@pytest.mark.parametrize("key", ["damping_ratio:", "force:", "unbalance:"])
def test_each_scene_of_what_an_engine_adds_runs(coarse_rom, key):
    """Every example of the key, beside the scene of the tests, marches to its end."""
    examples = [code for code in blocks("simulate/README.md", "yaml") if code.startswith(key)]
    assert examples
    for code in examples:
        case = scene(**RUBBING | {"integrator": EXACT}, speeds__over_f1=[0.25]).but(
            **yaml.safe_load(code)
        )
        check_scene(case, coarse_rom)
        assert marched(case, coarse_rom, 0.25).status in WITH_RESULT


def test_measured_frequencies_are_those_of_a_blade():
    """The example is a key of a blade."""
    (code,) = [code for code in blocks("geometry/README.md", "yaml") if "frequencies_Hz" in code]
    rest = yaml.safe_load((ROOT / "workflow/blades/reference.yaml").read_text())
    blade = check_settings(Blade, rest | yaml.safe_load(code), "geometry/README.md")
    assert blade.settings_of_model()["frequencies_Hz"] == {"1": 612.0, "2": 1480.0}


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"rom/README.md": ""}, "block bases: on no page; add .* to one of README.md, geometry"),
        (
            {"fem/README.md": TEXTS["fem/README.md"] + TEXTS["rom/README.md"]},
            "block bases: should be once on one page, is in fem/README.md and rom/README.md",
        ),
        ({"README.md": TEXTS["README.md"] * 2}, "is in README.md and README.md"),
        (
            {"tests/README.md": "<!-- speed: x -->\n<!-- /speed -->"},
            "block speed: tests/README.md has it, but nothing fills it",
        ),
        (
            {"rom/README.md": TEXTS["rom/README.md"].replace("<!-- /bases -->", "")},
            "block bases: has no end `<!-- /bases -->`",
        ),
    ],
)
def test_a_block_that_is_on_no_page_or_on_two_or_unknown_or_without_end_is_named(change, words):
    require_blocks(TEXTS)
    with pytest.raises(BlockError, match=words):
        generated(TEXTS | change)


def test_pages_without_results_keep_their_numbers_and_have_the_settings_of_the_models(tmp_path):
    assert generated(TEXTS, tmp_path) == TEXTS
    assert len(COMPUTED) == len({name for name, *_ in COMPUTED})


@pytest.mark.parametrize("name", ["inputs", "bricks"])
def test_numbers_that_are_kept_with_the_tests_are_those_of_the_page(name):
    ((file, table_of),) = [(file, of) for block, file, of in COMPUTED if block == name]
    assert any(table_of(read_json(ROOT / file)) in text for text in TEXTS.values())


def test_the_paragraph_on_the_paper_counts_claims_and_names_those_that_do_not_hold():
    """Of 10 on the model 9 hold; of 8 others 2 were data, 4 hold, one differs, one may hold."""
    given = [*["reproduced"] * 9, "not comparable", *["calibrated"] * 2, "differs"]
    given += ["reproduced in kind"] * 4 + ["undecided"]
    judged = [{"verdict": verdict, "says": f"claim {i}"} for i, verdict in enumerate(given)]
    said = verdicts(judged).replace("\n", " ")
    assert re.findall(r"\d+", said) == ["10", "9", "1", "8", "2", "6", "4", "4", "12", "17"]
    assert said.count(". ") == 2 and said.endswith(
        'undecided, within the error of our runs: "claim 17".'
    )
    assert verdicts(judged[:-1]).endswith("runs: none.")


def test_found_has_both_coatings_at_both_orders_beside_the_papers_shifts():
    told = {"over_crossing": 1.1, "over_gap": {"amplitude": 2, "wear": 0.5}}
    rows = [{"k": k, "modes": [1], "over_f1": k / 10} | told for k in (4, 5, 6)]
    scenes = [{"scene": f"paper-{part}", "rows": rows} for part in ("e1", "e10", "other")]
    first, *_, last = shown = coatings({"scenes": scenes}).splitlines()[2:]
    assert len(shown) == 4
    assert first == "| E = 1 | 4 | 0.400 | 1.100 | 1.129 | 2.00 | 0.50 |"
    assert last == "| E = 10 | 6 | 0.600 | 1.100 | 1.176 | 2.00 | 0.50 |"


@each_page
def test_links_lead_to_files_and_headings_that_exist(page):
    links = [link for link in re.findall(r"\]\(([^)\s]+)\)", prose(page)) if "://" not in link]
    assert [link for link in links if not leads_somewhere(page, link)] == []


def leads_somewhere(page, link):
    path, _, anchor = link.partition("#")
    file = (ROOT / page).parent / path if path else ROOT / page
    return file.exists() and (not anchor or anchor in anchors(file.read_text()))


@each_page
def test_paths_that_a_page_names_exist(page):
    """In backticks, from the root of the project; results are made, names in <> are the user's."""
    named = re.findall(
        r"`((?:geometry|fem|rom|simulate|workflow|tests|\.ci)/[\w./*-]*)`", TEXTS[page]
    )
    assert [path for path in named if not list(ROOT.glob(path))] == []


@pytest.fixture(scope="module")
def rules(tmp_path_factory):
    """Names of the workflow's rules, and patterns of the files that it makes."""
    names = make_project(tmp_path_factory.mktemp("rules")).run("--list-rules").split()
    text = "\n".join(file.read_text() for file in (ROOT / "workflow/rules").glob("*.smk"))
    figures = table.read(*TABLES)
    made = re.findall(r"\"(results/[^\"]+)\"", text)
    made += [f"{table.path_of(name)}.{suffix}" for name in figures for suffix in ("png", "pdf")]
    return names, [re.sub(r"\\\{.*?\\\}", "[^/]+", re.escape(path)) for path in made]


def targets(page):
    """Targets of all calls of Snakemake on a page, in code blocks and in backticks."""
    calls = re.findall(r"\./run snakemake([^`\n]*)", TEXTS[page])
    for call in calls:
        words = iter(shlex.split(call.split(" #")[0]))
        for word in words:
            if word in ("--report", "--config", "--cores", "--workflow-profile"):
                next(words)
            elif not word.startswith("-") and "=" not in word:  # further values of --config
                yield word


@each_page
def test_targets_that_a_page_names_exist(page, rules):
    names, patterns = rules
    assert len(names) > 50 and len(patterns) > 50
    unknown = [
        target
        for target in targets(page)
        if target not in names
        and not any(re.fullmatch(pattern, re.sub("<.*?>", "x", target)) for pattern in patterns)
    ]
    assert unknown == []


def example(page, words, tmp_path):
    """The one Python block of a page that holds ``words``, as a module."""
    (code,) = [code for code in blocks(page, "python") if words in code]
    path = tmp_path / "example.py"
    path.write_text(code)
    module = module_from_spec(spec := spec_from_file_location("example", path))
    spec.loader.exec_module(module)
    return module


def test_the_law_that_the_page_adds_is_one(tmp_path):
    """The plastic one without hardening, to round-off."""
    law = example("CONTRIBUTING.md", "class Perfect", tmp_path).Perfect
    numbers = {"E": 2, "sigma_Y": 1e-3, "unit_MPa": 1000}
    own, known = law(kind="perfect", **numbers), Plastic(kind="plastic", K=0, **numbers)
    assert own.modulus == known.modulus
    for eps, eps_p in ((1e-4, 0.0), (1e-3, 0.0), (1e-3, 8e-4), (1e-3, 2e-3), (0.3, 0.1)):
        ours, expected = (law.stress(law.parameters, eps, eps_p) for law in (own, known))
        np.testing.assert_allclose(ours, expected, rtol=1e-12)
    works = [law.plastic_work(law.parameters, 0.1, 0.3) for law in (own, known)]
    assert works[0] == pytest.approx(works[1], rel=1e-12)


def test_the_observable_that_the_page_adds_is_a_number(tmp_path):
    rms = example("CONTRIBUTING.md", "def rms", tmp_path).rms
    assert rms(1 + np.sin(np.linspace(0, 2 * np.pi, 1000, endpoint=False))) == pytest.approx(
        0.5**0.5
    )


def test_the_figure_that_the_page_adds_is_drawn(tmp_path):
    figure = example("CONTRIBUTING.md", "def draw", tmp_path)
    save_runs(tmp_path / "sweep.nc", [0.3, 0.35], wear=[[1.0, 3.0], [0.0, 0.0]])
    files = SimpleNamespace(sweep=tmp_path / "sweep.nc", rom=None)
    (axes,) = figure.draw(*read(figure, files)).axes
    drawn = axes.lines[0].get_xydata()
    np.testing.assert_allclose(drawn, [[0.3, 2], [0.35, 0]], rtol=1e-6)  # single precision


@pytest.mark.parametrize(
    ("words", "file", "count"),
    [
        ("C12", "workflow/paper/claims.py", 2),
        ("rule mesh_error", "workflow/rules/study.smk", 1),
        ("study.mesh_error", "workflow/scripts/mesh_error.py", 1),
        ("worn_per_pass", "simulate/errors/schema.py", 1),
    ],
)
def test_claim_study_and_column_that_the_page_shows_are_those_of_the_code(words, file, count):
    code = re.sub(r"\s", "", (ROOT / file).read_text())
    shown = [block for block in blocks("CONTRIBUTING.md", "(?:python|text)") if words in block]
    assert len(shown) == count
    assert [block for block in shown if re.sub(r"\s", "", block) not in code] == []
