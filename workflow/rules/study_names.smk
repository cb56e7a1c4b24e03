# What the studies compute and draw, of which files.

# Sizes of the mesh study over the blade's own, coarse to fine.
MESH_FACTORS = (2.0, 2**0.5, 1.0, 0.5**0.5)
MESH_CONVERGENCE = figures_of_blades("mesh-convergence", BLADE_FILES)


def study_code(*names):
    """Modules of workflow/study."""
    return sources(*(f"{Path('workflow', 'study', *name.split('.'))}.py" for name in names))


def kept_beside(json, kind):
    """Log or benchmark of a file of numbers, in the folder of its blade or of the figures."""
    results, of, *name = Path(json).with_suffix("").parts
    return str(Path(results, of, f"{kind}s", "-".join(name)))


def given_blade(wildcards):
    return {"blade": blade_file(wildcards)}


def given_size(wildcards):
    return {"blade": blade_file(wildcards), "factor": MESH_FACTORS[int(wildcards.level)]}


def levels_of_mesh(wildcards):
    pattern = "results/{blade}/mesh-convergence/level-{level}.json"
    blade = MESH_CONVERGENCE[wildcards.figure]
    return {"levels": expand(pattern, blade=blade, level=range(len(MESH_FACTORS)))}


def full_model(wildcards):
    return {"full": f"results/{wildcards.blade}/full-model.nc"}


def models_of_bases(wildcards):
    """Matrices and full model of the blade, and as the paper reduces it where a file says so."""
    blade = wildcards.blade
    paper = f"{blade}-paper"
    files = ("matrices.h5", "full-model.nc")
    return {
        "matrices": f"results/{blade}/matrices.h5",
        **full_model(wildcards),
        "of_paper": [f"results/{paper}/{file}" for file in files if paper in BLADE_FILES],
    }


REMESHED = sources("geometry/*.py", "fem/*.py", "rom/modes.py") + study_code("variants")
# Numbers, by their rule: file, the module of workflow/study that computes them from `files` and
# what it is `given`, the code beside it, settings of the blade whose change repeats it.
STUDIES = {
    "mesh_level": {
        "json": "results/{blade}/mesh-convergence/level-{level}.json",
        "module": "mesh_level",
        "files": blade_source,
        "given": given_size,
        "code": REMESHED,
        "uses": FEM_USES,
        "message": "Blade {wildcards.blade} on mesh {wildcards.level} of its mesh study",
    },
    "mesh_convergence": {
        "json": "results/figures/{figure}.json",
        "module": "mesh",
        "files": levels_of_mesh,
        "given": {"own": MESH_FACTORS.index(1.0)},
        "message": "Limits of the mesh study {wildcards.figure}",
    },
    "mesh_error": {  # for scenes with an accuracy too
        "json": "results/{blade}/mesh-error.json",
        "module": "mesh_error",
        "files": lambda wildcards: blade_source(wildcards) | full_model(wildcards),
        "given": given_blade,
        "code": sources("geometry/mesh.py", "rom/compliance.py", "rom/full_model.py")
        + study_code("variants"),
        "message": "Blade {wildcards.blade}: what its mesh errs by, from a coarser one",
    },
    "compare_bases": {
        "json": "results/{blade}/bases.json",
        "module": "bases",
        "files": models_of_bases,
        "code": sources("rom/*.py", "fem/matrices.py"),
        "message": "Reduction bases of blade {wildcards.blade} against the full model",
    },
    "frequencies": {
        "json": "results/{blade}/frequencies.json",
        "module": "rotor37",
        "function": "prestresses",
        "files": lambda wildcards: {"mesh": f"results/{wildcards.blade}/blade.msh"},
        "given": given_blade,
        "code": REMESHED,
        "uses": FEM_USES,
        "message": "Frequencies of blade {wildcards.blade} with either prestress",
    },
    "edge_cuts": {
        "json": "results/{blade}/edge-cuts.json",
        "module": "rotor37",
        "function": "edge_cuts",
        "files": blade_source,
        "given": given_blade,
        "code": REMESHED,
        "uses": (*GEOMETRY_USES, "material"),
        "message": "Blade {wildcards.blade} with other cuts of its edges",
    },
    "map_stability": {
        "json": "results/figures/stability-map.json",
        "module": "stability.map",
        "files": lambda wildcards: {"rom": f"results/{PAPER_BLADE}/rom-r.nc"},
        "given": lambda wildcards: {"scene": SCENES["paper-e1"].model_dump(mode="json")},
        "code": MARCH,
        "message": "Stable and accurate steps over E",
    },
    "judge_stability": {
        "json": "results/figures/stability-matrix.json",
        "module": "stability.matrix",
        "files": lambda wildcards: {"rom": f"results/{PAPER_BLADE}/rom-rt.nc"},
        "code": MARCH + study_code("stability.cases", "stability.runs"),
        "message": "Cases at the extremes",
    },
}

# Pictures, by their rule: the module that draws, its numbers, the picture.
STUDY_PICTURES = {
    "draw_mesh_convergence": ("mesh", "{figure}", "{figure}"),
    "draw_stability": ("stability.report", "stability-map", "stability"),
}
