# The paper, figure by figure and claim by claim: run when asked for, no part of `rule all`.
from workflow.paper.cases import CAUSES, E, REPEATS, UNITS_PA

# Parts that every edition has, by the scene that gives them.
PARTS = {
    "e1": "e1",
    "e10": "e10",
    "two_five": "two-five",
    "tilted": "tilted",
    "tangential": "tangential",
    "rigid": "rigid",
}
SWEPT = [part for part in PARTS if part != "rigid"]  # that goes with the long runs
# Editions of the paper: on its blade, on another, and on its blade with what shows the uncertainty.
OTHER = "rotor37"
EDITIONS = ("reference", OTHER, *REPEATS)


def scene_of_part(edition, part):
    """The scene of one part; a repeat changes that of the reference."""
    blade = OTHER if edition == OTHER else "paper"
    return f"{blade}-{PARTS.get(part, part)}"


def settings_of_part(edition, part):
    """Its settings, as the scripts take them."""
    scene = SCENES[scene_of_part(edition, part)]
    return REPEATS.get(edition, lambda scene: scene)(scene).model_dump(mode="json")


def rom_of_part(edition, part):
    """The reduced model of one part."""
    scene = SCENES[scene_of_part(edition, part)]
    blade = "reference-rich" if edition == "richer-basis" else scene.blade
    return f"results/{blade}/rom-{scene.directions}.nc"


def sweep_of_part(edition, part):
    """Where one part's sweep is: repeats keep theirs apart."""
    name = scene_of_part(edition, part)
    if edition in REPEATS:
        return f"results/paper/{edition}/{name}.nc"
    return f"results/{SCENES[name].blade}/{name}/sweep.nc"


STUDIED = MARCH + sources(
    *(f"workflow/paper/{name}.py" for name in ("cases", "peaks")),
)


wildcard_constraints:
    edition="|".join(EDITIONS),
    repeat="|".join(REPEATS),
    part="|".join(PARTS.values()),
    row=r"\d+",


rule repeat_sweep:
    input:
        code=MARCH,
        rom=lambda wildcards: rom_of_part(wildcards.repeat, wildcards.part),
    output:
        sweep="results/paper/{repeat}/paper-{part}.nc",
    log:
        "results/paper/{repeat}/logs/paper-{part}.log",
    benchmark:
        "results/paper/{repeat}/benchmarks/paper-{part}.tsv"
    params:
        scene=lambda wildcards: settings_of_part(wildcards.repeat, wildcards.part),
    message:
        "Scene paper-{wildcards.part} with {wildcards.repeat}"
    script:
        "../scripts/repeat_sweep.py"


rule grid_row:
    input:
        code=STUDIED + sources("workflow/paper/grid.py"),
        rom=lambda wildcards: rom_of_part(wildcards.edition, "grid"),
    output:
        json="results/paper/{edition}/grid-{row}.json",
    log:
        "results/paper/{edition}/logs/grid-{row}.log",
    benchmark:
        "results/paper/{edition}/benchmarks/grid-{row}.tsv"
    params:
        table="grid",
        scene=lambda wildcards: settings_of_part(wildcards.edition, "grid"),
        value=lambda wildcards: E[int(wildcards.row)],
    message:
        "Coatings of Table 1, E number {wildcards.row}, {wildcards.edition}"
    script:
        "../scripts/paper_rows.py"


rule grid:
    input:
        rows=expand("results/paper/{{edition}}/grid-{row}.json", row=range(len(E))),
    output:
        json="results/paper/{edition}/grid.json",
    log:
        "results/paper/{edition}/logs/grid.log",
    params:
        table="grid",
    message:
        "Table 1, {wildcards.edition}"
    script:
        "../scripts/paper_table.py"


rule growth:
    input:
        code=STUDIED + sources("workflow/paper/worst.py"),
        grid="results/paper/{edition}/grid.json",
        rom=lambda wildcards: rom_of_part(wildcards.edition, "grid"),
        rigid=lambda wildcards: sweep_of_part(wildcards.edition, "rigid"),
    output:
        json="results/paper/{edition}/growth.json",
    log:
        "results/paper/{edition}/logs/growth.log",
    benchmark:
        "results/paper/{edition}/benchmarks/growth.tsv"
    params:
        scene=lambda wildcards: settings_of_part(wildcards.edition, "grid"),
    message:
        "Worst coatings over 200 rounds, {wildcards.edition}"
    script:
        "../scripts/paper_growth.py"


def blade_of_edition(file):
    """A file of the edition's own blade."""
    return (
        lambda wildcards: f"results/{SCENES[scene_of_part(wildcards.edition, 'e1')].blade}/{file}"
    )


rule paper_model:
    input:
        code=sources("rom/*.py", "fem/matrices.py", "workflow/paper/measure.py"),
        matrices=blade_of_edition("matrices.h5"),
        full=blade_of_edition("full-model.nc"),
        rom=blade_of_edition("rom-r.nc"),
        check=blade_of_edition("rom-check-r.nc"),
    output:
        json="results/paper/{edition}/model.json",
    log:
        "results/paper/{edition}/logs/model.log",
    benchmark:
        "results/paper/{edition}/benchmarks/model.tsv"
    message:
        "The paper's reduced model, {wildcards.edition}"
    script:
        "../scripts/paper_model.py"


rule paper_settled:
    input:
        code=STUDIED
        + sources(
            "workflow/paper/measure.py", "workflow/paper/laws.py", "workflow/figures/fig05_laws.py"
        ),
        rom="results/reference/rom-r.nc",
        densities=[f"results/reference/paper-density-{i}/sweep.nc" for i in (1, 4)],
        steps=[f"results/reference/paper-step-0{i}/sweep.nc" for i in (8, 4, 2)],
        peak="results/reference/peak-e1/peak.json",
    output:
        json="results/paper/reference/settled.json",
    log:
        "results/paper/reference/logs/settled.log",
    benchmark:
        "results/paper/reference/benchmarks/settled.tsv"
    params:
        scene=SCENES["paper-density-1"].model_dump(mode="json"),
    message:
        "Densities, steps, laws, cost of the density, stress"
    script:
        "../scripts/paper_settled.py"


def more_of_edition(wildcards):
    """Numbers that are no part of a repeat."""
    if wildcards.edition in REPEATS:
        return []
    own = ["model", *(["settled"] if wildcards.edition == "reference" else [])]
    return [f"results/paper/{wildcards.edition}/{name}.json" for name in own]


rule paper_numbers:
    input:
        unpack(lambda wildcards: {part: sweep_of_part(wildcards.edition, part) for part in PARTS}),
        code=STUDIED + sources("workflow/paper/grid.py", "workflow/paper/measure.py"),
        rom=lambda wildcards: rom_of_part(wildcards.edition, "e1"),
        grid="results/paper/{edition}/grid.json",
        growth="results/paper/{edition}/growth.json",
        more=more_of_edition,
    output:
        json="results/paper/{edition}/numbers.json",
    log:
        "results/paper/{edition}/logs/numbers.log",
    params:
        parts=SWEPT,
    message:
        "Numbers of the claims, {wildcards.edition}"
    script:
        "../scripts/paper_numbers.py"


rule cause:
    input:
        code=STUDIED + sources("workflow/paper/causes.py", "workflow/paper/measure.py"),
        rom=lambda wildcards: "results/{0.blade}/rom-{0.directions}.nc".format(
            CAUSES[int(wildcards.row)]
        ),
    output:
        json="results/paper/causes/{row}.json",
    log:
        "results/paper/causes/logs/{row}.log",
    benchmark:
        "results/paper/causes/benchmarks/{row}.tsv"
    params:
        scene=SCENES["paper"].model_dump(mode="json"),
        cause=lambda wildcards: int(wildcards.row),
    message:
        "Both coatings, cause {wildcards.row}"
    script:
        "../scripts/paper_cause.py"


use rule grid_row as contact_map_row with:
    input:
        code=STUDIED + sources("workflow/paper/contact_map.py"),
        rom="results/reference/rom-r.nc",
    output:
        json="results/paper/contact-map/row-{row}.json",
    log:
        "results/paper/contact-map/logs/row-{row}.log",
    benchmark:
        "results/paper/contact-map/benchmarks/row-{row}.tsv"
    params:
        table="contact_map",
        scene=SCENES["paper-grid"].changed(integrator__steps_per_round=8192).model_dump(mode="json"),
        value=lambda wildcards: UNITS_PA[int(wildcards.row)],
    message:
        "Contact stiffness number {wildcards.row} over casing amplitudes"


use rule grid as contact_map with:
    input:
        code=sources("workflow/paper/contact_map.py"),
        rows=expand("results/paper/contact-map/row-{row}.json", row=range(len(UNITS_PA))),
    output:
        json="results/paper/contact-map.json",
    log:
        "results/paper/contact-map/logs/contact-map.log",
    params:
        table="contact_map",
    message:
        "Map of contact stiffness and casing amplitude"


def there(paths):
    """Those of the files, by name, that are there, and when they were made."""
    return {name: path for name, path in paths.items() if Path(path).is_file()}


REPEATED = {name: f"results/paper/{name}/numbers.json" for name in REPEATS}
ON_OTHER = {OTHER: f"results/paper/{OTHER}/numbers.json"}
CAUSED = {cause.name: f"results/paper/causes/{i}.json" for i, cause in enumerate(CAUSES)}
BESIDE = {**REPEATED, **ON_OTHER, **CAUSED}


rule paper_claims:
    input:
        code=sources(*(f"workflow/paper/{n}.py" for n in ("claims", "verdict", "report"))),
        numbers="results/paper/reference/numbers.json",
    output:
        json="results/paper/claims.json",
        markdown="results/paper/claims.md",
    log:
        "results/paper/logs/claims.log",
    params:
        repeats=there(REPEATED),
        other=there(ON_OTHER),
        causes=there(CAUSED),
        made={name: Path(path).stat().st_mtime_ns for name, path in there(BESIDE).items()},
    message:
        "Verdicts on the paper's claims"
    script:
        "../scripts/paper_claims.py"


def folders(editions, scenes=""):
    """Folders whose jobs are of some editions, and of scenes whose names begin so."""
    of_scenes = [
        f"results/{scene.blade}/{name}"
        for name, scene in SCENES.items()
        if scenes and name.startswith(scenes)
    ]
    return [f"results/paper/{edition}" for edition in editions] + of_scenes


TARGETS = {
    "blade, mesh, reduced models": ["results/reference"],
    "paper": folders(["reference"], ("paper", "peak")),
    "paper_uncertainty": ["results/reference-rich", *folders(REPEATS)],
    "paper_causes": ["results/reference-linear", *folders(["causes", "contact-map"])],
    "paper_rotor37": ["results/rotor37-fast", *folders([OTHER], (OTHER,))],
}


rule paper_cost:
    input:
        code=sources("workflow/paper/cost.py"),
        claims="results/paper/claims.json",
    output:
        markdown="results/paper/cost.md",
    log:
        "results/paper/logs/cost.log",
    params:
        targets=TARGETS,
    message:
        "What the paper's targets cost"
    script:
        "../scripts/paper_cost.py"


rule paper_uncertainty:
    input:
        REPEATED.values(),


rule paper_causes:
    input:
        CAUSED.values(),
        "results/figures/calibration.png",


rule paper_rotor37:
    input:
        ON_OTHER.values(),
