"""What jobs depend on, by the imports in their modules, against what Python imports."""

import ast
import json
import os
import re
import subprocess
import sys
from importlib import import_module
from inspect import signature
from pathlib import Path
from textwrap import dedent

import pytest
import yaml
from projects import PACKAGES, ROOT, make_project

import simulate
from geometry.base import check_settings, sources, sources_of
from geometry.elsewhere import MatricesElsewhere

PAGE = (ROOT / "rom/README.md").read_text()

PROJECT = {  # files of a made project
    "rooms/__init__.py": "",
    "rooms/plain.py": "import json",
    "rooms/inner/__init__.py": "",
    "rooms/inner/deep.py": "from ..plain import x",
    "rooms/late.py": "def f():\n    try:\n        import rooms.inner.deep\n    except E: pass",
    "rooms/cases.py": "match x:\n    case 1:\n        from rooms import plain",
    "laws/__init__.py": "",
    "laws/one.py": "",
    "face/__init__.py": "def __getattr__(name): ...",
    "face/part.py": "",
    "asks/__init__.py": "",
    "asks/face.py": "from face import run",
    "asks/part.py": "from face import part",
    "apart/tests/__init__.py": "",  # no package of PACKAGES
    "apart/tests/one.py": "from rooms.plain import x\nfrom apart.tests.two import y",
    "apart/tests/two.py": "",
    "rooms/round.py": "import rooms.again",
    "rooms/again.py": "import rooms.round",
}


@pytest.fixture
def made(tmp_path, project_at, monkeypatch):
    for name, text in PROJECT.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(dedent(text))
    project_at(tmp_path)
    monkeypatch.setattr(sources, "LOADING_ALL", ("laws",))
    monkeypatch.setattr(sources, "FACES", {"face": "rooms.plain"})


@pytest.mark.parametrize(
    ("module", "files"),
    [
        ("rooms.plain", "rooms/__init__ rooms/plain"),
        ("rooms.inner.deep", "rooms/__init__ rooms/inner/__init__ rooms/inner/deep rooms/plain"),
        (
            "rooms.late",
            "rooms/__init__ rooms/inner/__init__ rooms/inner/deep rooms/late rooms/plain",
        ),
        ("rooms.cases", "rooms/__init__ rooms/cases rooms/plain"),
        ("laws", "laws/__init__ laws/one"),
        ("asks.face", "asks/__init__ asks/face face/__init__ rooms/__init__ rooms/plain"),
        ("asks.part", "asks/__init__ asks/part face/__init__ face/part"),
        ("rooms.round", "rooms/__init__ rooms/again rooms/round"),
        ("apart.tests", "apart/tests/__init__"),
        (
            "apart.tests.one",
            "apart/tests/__init__ apart/tests/one apart/tests/two rooms/__init__ rooms/plain",
        ),
    ],
)
def test_all_forms_of_imports_are_followed(made, module, files):
    assert [file.removesuffix(".py") for file in sources_of(module)] == files.split()


@pytest.mark.parametrize("module", ["rooms.none", "none.there"])
def test_a_module_that_is_not_there_is_refused(made, module):
    with pytest.raises(ModuleNotFoundError, match=f"no module {module}"):
        sources_of("rooms.plain", module)


def test_all_that_the_face_of_the_simulator_gives_is_loaded_with_its_module():
    behind = {*sources_of(sources.FACES["simulate"])}
    assert all({*sources_of(module)} <= behind for module in simulate.FACE.values())


def test_sources_are_found_beside_a_users_module_of_the_name_of_a_package(tmp_path):
    (tmp_path / "fem.py").write_text("E = 2.1e11")
    asking = "from geometry.base import sources_of; print(*sources_of('simulate.runs'))"
    command, environment = [sys.executable, "-c", asking], os.environ | {"PYTHONPATH": str(ROOT)}
    done = subprocess.run(
        command, cwd=tmp_path, env=environment, capture_output=True, text=True, check=True
    )
    assert done.stdout.split() == list(sources_of("simulate.runs"))


# Targets that together need a job of every rule.
TARGETS = [
    *("all", "paper", "paper_beyond", "paper_uncertainty", "paper_causes", "paper_rotor37"),
    *("study_mesh", "study_rotor37", "stability", "trade"),
    *(f"results/paper/{name}" for name in ("one-percent/sweep.nc", "paper-e1/rub-0.3.gif")),
    *(f"results/paper/five-factors/{name}" for name in ("row-1.nc", "design.csv")),
    *(f"results/figures/{name}-foreign.png" for name in ("spectra", "wear")),
    *(f"results/figures/{name}-rotor37.png" for name in ("campbell", "modes", "mesh-convergence")),
    *(f"results/figures/{name}-five-factors.png" for name in ("design", "sensitivity")),
    "results/figures/gap-at-rest.png",
    *("results/interface/interface.md", "results/foreign/foreign/sweep.nc"),
    "results/experiments/interface/picture.png",
    *("results/matrices/rom-check-r.nc", "results/paper/conclusions.md"),
    *("results/paper/gauged/gauges.csv", "results/figures/gauges-gauged.png"),
    *("results/figures/blades-staged.png", "results/figures/distribution-scattered.png"),
    *("results/paper/scattered/quantiles.csv", "results/figures/forced-forced.png"),
]
FORCED = "base: paper-e1\nforce: {orders: [{order: 4, amplitude_um: 20}]}\n"
STAGED = "base: paper-e1\nstage: {count: 2, longer_um: {std_um: 1, seed: 1}}\n"
GAUGED = """
base: paper-e1
record: {gauges: [{name: root, at: [440, 1.8, 0], direction: [1, 0, 0]}]}
"""
# Writes a job of each rule: its script, what that loads by name, what it holds, its code.
HOOK = """
def write_jobs():
    import json

    found = {rule.name: None for rule in workflow.rules if rule.script}
    for job in workflow.dag.jobs:
        if job.rule.script:
            held = [
                f"{of}.{name}"
                for of in ("input", "output", "params", "wildcards")
                for name in dict(getattr(job, of).items())
            ]
            script = job.rule.script.rpartition("/")[-1].removesuffix(".py")
            code = list(map(str, job.input.code))
            cases = job.params.get("given", {}).get("cases", [])
            loaded = {of for case in cases for of in (case["function"], case["model"]) if of}
            loaded |= {of for of in [job.params.get("module")] if of}
            found[job.rule.name] = f"workflow.scripts.{script}", sorted(loaded), held, code
    with open("jobs.json", "w") as file:
        json.dump(found, file)

import atexit
atexit.register(write_jobs)
"""


@pytest.fixture(scope="module")
def jobs(tmp_path_factory):
    """A job of each rule."""
    project = make_project(tmp_path_factory.mktemp("jobs"))
    with (project.folder / "Snakefile").open("a") as snakefile:
        snakefile.write(HOOK)
    text = next(b for b in re.findall(r"```yaml\n(.*?)```", PAGE, re.DOTALL) if "M.mtx" in b)
    blades = project.folder / "workflow/blades"
    (blades / "matrices.yaml").write_text(text)
    for file in check_settings(MatricesElsewhere, yaml.safe_load(text), "").files:
        (blades / file).touch()
    (project.folder / "workflow/scenes/gauged.yaml").write_text(GAUGED)
    (project.folder / "workflow/scenes/forced.yaml").write_text(FORCED)
    (project.folder / "workflow/scenes/staged.yaml").write_text(STAGED)
    (project.folder / "workflow/scenes/scattered.yaml").write_text(f"{STAGED}design: seeds.csv\n")
    (project.folder / "workflow/scenes/seeds.csv").write_text("stage.longer_um.seed\n1\n2\n")
    project.run("-n", *TARGETS)
    return json.loads((project.folder / "jobs.json").read_text())


def modules_of(job):
    run, loaded, *_ = job
    return sorted({name.partition(":")[0] for name in (run, *loaded)})


def test_every_rule_has_what_its_script_asks_for(jobs):
    for rule, (module, loaded, held, _) in jobs.items():
        script = (ROOT / module.replace(".", "/")).with_suffix(".py").read_text()
        asked = re.findall(r"\bof\.((?:input|output|params|wildcards)\.(?!items\b)\w+)", script)
        assert {*asked} <= {*held}, rule
        for name in loaded:  # a module that draws, or functions of an experiment
            module, _, function = name.partition(":")
            assert hasattr(import_module(module), function or "draw"), rule


def calls(script):
    """Functions of the project that a script calls, each with the number of its arguments."""
    tree = ast.parse((ROOT / script.replace(".", "/")).with_suffix(".py").read_text())
    imports = [node for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)]
    found = {of.name: node.module for node in imports for of in node.names}
    for node in ast.walk(tree):
        name = node.func.id if isinstance(node, ast.Call) and hasattr(node.func, "id") else None
        if found.get(name, "adapter") != "adapter":
            starred = any(isinstance(argument, ast.Starred) for argument in node.args)
            yield getattr(import_module(found[name]), name), None if starred else len(node.args)


def test_every_script_gives_a_function_as_many_arguments_as_it_takes(jobs):
    scripts = {script for script, *_ in jobs.values()}
    assert len(scripts) > 35
    for script in scripts:
        called = list(calls(script))
        assert called, script
        for function, count in called:
            if count is not None:
                signature(function).bind(*range(count))


def test_every_rule_depends_on_what_its_script_imports(jobs):
    for rule, job in jobs.items():
        assert job[-1] == list(sources_of(*modules_of(job))), rule


# Prints, for each module, those of the project that Python has after its import in a new process.
# A script takes `snakemake` from Snakemake and calls `adapter.job`, which does nothing here.
IMPORTING = """
import builtins, json, sys
from importlib import import_module
from multiprocessing import get_context
from types import SimpleNamespace
import h5py, matplotlib, meshio, numba, pydantic, scipy.optimize, scipy.sparse.linalg, xarray

def imported(module):
    import_module(module)
    return [name for name in sys.modules if name.startswith(PACKAGES)]

PACKAGES = tuple(sys.argv[1].split())
builtins.snakemake = None
sys.modules["adapter"] = SimpleNamespace(job=lambda *given, **texts: None)
with get_context("fork").Pool(1, maxtasksperchild=1) as pool:
    print(json.dumps(dict(zip(sys.argv[2:], pool.map(imported, sys.argv[2:], chunksize=1)))))
"""


@pytest.mark.slow
def test_all_that_a_job_imports_is_among_its_sources(jobs):
    """Against Python itself, for the modules of all rules."""
    modules = sorted({module for job in jobs.values() for module in modules_of(job)})
    command = [sys.executable, "-c", IMPORTING, " ".join(PACKAGES), *modules]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True)
    imported = json.loads(done.stdout)
    assert {*imported} == {*modules} and len(modules) > 40
    for module, names in imported.items():
        sources = sources_of(module)
        missing = [name for name in names if not {*sources_of(name)} <= {*sources}]
        assert module in names and not missing, module


def test_imports_keep_the_contracts():
    """Nothing imports the paper but the pages; no part of the workflow has a way back."""
    command = [Path(sys.executable).parent / "lint-imports", "--no-cache"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout


def test_the_product_names_no_test():
    files = [file for of in PACKAGES for file in (ROOT / of).rglob("*.*")]
    code = [file for file in files if file.suffix in (".py", ".smk", ".yaml")]
    named = [file for file in code if re.search(r"\btests(\.\w|/\S+\.py)", file.read_text())]
    assert len(code) > 200 and not named


APART = {  # module of a job, and what no change of may run it again
    "workflow.jobs.mesh": ("fem/", "rom/", "simulate/"),
    "workflow.jobs.full_model": ("simulate/", "geometry/cad.py"),
    "workflow.jobs.reduced": ("simulate/", "fem/assemble.py", "rom/check.py"),
    "workflow.jobs.check_rom": ("simulate/",),
    "workflow.jobs.march": (
        *("fem/", "simulate/sweeps/peak.py", "simulate/sweeps/peak_results.py"),
        *("workflow/many/", "workflow/figures/"),
    ),
    "workflow.jobs.sweep": ("fem/", "simulate/sweeps/peak_results.py", "workflow/many/"),
    "workflow.paper.grid": ("workflow/paper/claims.py", "workflow/many/"),
}


@pytest.mark.parametrize("module", APART)
def test_what_comes_after_a_job_does_not_run_it_again(module):
    assert not [file for file in sources_of(module) if file.startswith(APART[module])]
