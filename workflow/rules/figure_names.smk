# Names of the figures, and their input files.
# Figures of the paper have the paper's numbers: those of its blade, with a and b for its two coatings.
# Figures of another blade or scene are named by what they show: campbell-<blade>, spectra-<scene>.
PAPER_BLADE = "reference"
PAPER_SCENES = {"paper-e1": "a", "paper-e10": "b"}


def figures_of_blades(of_paper, shows, names):
    """Blade by figure name."""
    return {of_paper if name == PAPER_BLADE else f"{shows}-{name}": name for name in names}


def figures_of_scenes(of_paper, shows):
    """Scene by figure name."""
    of_paper = {name: f"{of_paper}{letter}" for name, letter in PAPER_SCENES.items()}
    return {of_paper.get(name, f"{shows}-{name}"): name for name in SCENES}


# Figures of any blade; `all_figures` lists those of the blades that a scene uses.
FIG03 = figures_of_blades("fig03", "campbell", BLADE_FILES)
FIG09 = figures_of_blades("fig09", "modes", BLADE_FILES)
# Figures of any scene; `all_figures` lists those of outputs that a configured scene records. The stress
# is no figure of the paper: it always has the scene's name.
OF_RECORD = {
    "spectrum_rounds": figures_of_scenes("fig10", "spectra"),
    "wear": figures_of_scenes("fig11", "wear"),
    "states_rounds": {f"stress-{name}": name for name in SCENES},
}
GAPS = {f"gap-{name}": name for name in SCENES}  # of any scene that gives its gaps at rest
LOADS = {f"loads-{name}": name for name in BLADE_FILES}
SENSITIVITY = {f"sensitivity-{name}": name for name in SCENES}  # of any Sobol design
SUMMARIES = figures_of_blades(
    "summary", "summary", sorted({scene.blade for scene in SWEEPS.values()})
)


ROM = "results/{blade}/rom-{directions}.nc"
CHECK = "results/{blade}/rom-check-{directions}.nc"
SWEEP = "results/{blade}/{scene}/sweep.nc"


def of_blade(table, **patterns):
    """Files of the figure's blade, with the interface directions that its scenes need."""

    def files(wildcards):
        blade = table[wildcards.figure]
        of = {"blade": blade, "directions": directions_of(blade)}
        return {name: pattern.format(**of) for name, pattern in patterns.items()}

    return files


def of_scene(key, **patterns):
    """Files of the scene and blade of a figure that shows `record.<key>`."""

    def files(wildcards):
        name = OF_RECORD[key][wildcards.figure]
        require(name, key)
        scene = SCENES[name]
        of = {"blade": scene.blade, "scene": name, "directions": scene.directions}
        return {name: pattern.format(**of) for name, pattern in patterns.items()}

    return files


def require(name, key):
    """Refuse a figure of an output that a scene does not record."""
    if not getattr(SCENES[name].record, key):
        raise WorkflowError(
            f"workflow/scenes/{name}.yaml: record.{key}: must be set for this figure"
        )


def both_coatings(wildcards):
    """The reduced model and the sweeps of the paper's two coatings."""
    for name in PAPER_SCENES:
        require(name, "spectrum_rounds")
        require(name, "wear")
    return {
        "rom": f"results/{PAPER_BLADE}/rom-{directions_of(PAPER_BLADE)}.nc",
        "sweeps": [f"results/{PAPER_BLADE}/{name}/sweep.nc" for name in PAPER_SCENES],
    }


def files_of_summary(wildcards):
    """The reduced model, its check and the sweeps of a blade's scenes."""
    blade = SUMMARIES[wildcards.figure]
    sweeps = [f"results/{blade}/{name}/sweep.nc" for name in scenes_of_summary(wildcards)]
    patterns = {"rom": ROM} | ({} if blade in FOREIGN else {"check": CHECK})
    return of_blade(SUMMARIES, **patterns)(wildcards) | {"sweeps": sweeps}


def scenes_of_summary(wildcards):
    blade = SUMMARIES[wildcards.figure]
    return [name for name, scene in SWEEPS.items() if scene.blade == blade]


def loads_of(blade):
    """Scenes of a blade whose loads are drawn: sweeps over several speeds with a liner."""
    return [
        name
        for name, scene in SWEEPS.items()
        if scene.blade == blade and scene.speeds.count > 1 and scene.liner.law.touches
    ]


def files_of_loads(wildcards):
    """The reduced model, the sweeps and the answers; the stress of scenes with a page."""
    blade = LOADS[wildcards.figure]
    names = loads_of(blade)
    if not names:
        raise WorkflowError(f"no scene of blade {blade} in workflow/config.yaml has loads to draw")
    return {
        "rom": f"results/{blade}/rom-{directions_of(blade)}.nc",
        "sweeps": [f"results/{blade}/{name}/sweep.nc" for name in names],
        "answers": [f"results/{blade}/{name}/answers.json" for name in names],
        "stress": [f"results/{blade}/{name}/stress.json" for name in names if name in EXPLORED],
    }


def given_figure(wildcards):
    """What a figure marks: numbers that the paper prints, operating lines of its blade."""
    name = wildcards.figure
    scene = OF_RECORD["spectrum_rounds"].get(name)
    blade = FIG03.get(name) or LOADS.get(name) or (scene and SCENES[scene].blade)
    lines = blade_settings(blade).operating_rpm if blade else {}
    return PRINTED.get(name, {}) | ({"operating": lines} if lines else {})


# What figures of the paper's blade and scenes mark of the numbers that the paper prints.
PRINTED = {
    "fig03": {"printed": True},
    **{
        f"fig{n}{letter}": {"printed": f"e{E}"}
        for n in (10, 11)
        for letter, E in (("a", 1), ("b", 10))
    },
}


def picture(caption, category, shows):
    """The PNG of a figure, for the report."""
    labels = {"figure": "{figure}", "shows": shows}
    return report("results/figures/{figure}.png", caption=caption, category=category, labels=labels)


def of_sobol(wildcards):
    """The table of rows of the Sobol design of a figure."""
    name = SENSITIVITY[wildcards.figure]
    if not is_sobol(SCENES[name]):
        raise WorkflowError(f"{scene_file(name)}: design: must be a YAML file for this figure")
    return {"rows": f"results/{SCENES[name].blade}/{name}/design-rows.nc"}


def is_sobol(scene):
    """Whether the rows of the scene's design are drawn."""
    return scene.design is not None and scene.design.endswith((".yaml", ".yml"))


def of_gap(wildcards):
    """The reduced model and the sweep of a scene that gives its gaps at rest."""
    name = GAPS[wildcards.figure]
    scene = SCENES[name]
    if not scene.clearance.at_rest:
        raise WorkflowError(f"{scene_file(name)}: clearance.at: must be rest for this figure")
    of = {"blade": scene.blade, "scene": name, "directions": scene.directions}
    return {"rom": ROM.format(**of), "sweep": SWEEP.format(**of)}


FIGURES = {  # rule: module, its files, names of figures, category and title in the report
    "fig03": (
        "fig03_campbell",
        of_blade(FIG03, rom=ROM, check=CHECK),
        FIG03,
        "Blade",
        "Campbell diagram",
    ),
    "fig09": (
        "fig09_modes",
        of_blade(FIG09, mesh="results/{blade}/blade.msh", full="results/{blade}/full-model.nc"),
        FIG09,
        "Blade",
        "natural modes at rest",
    ),
    "fig10": (
        "fig10_spectra",
        of_scene("spectrum_rounds", rom=ROM, sweep=SWEEP),
        OF_RECORD["spectrum_rounds"],
        "Response",
        "response spectra",
    ),
    "fig11": (
        "fig11_wear",
        of_scene("wear", rom=ROM, sweep=SWEEP),
        OF_RECORD["wear"],
        "Wear",
        "wear map",
    ),
    "fig12": (
        "fig12_profiles",
        both_coatings,
        ["fig12"],
        "Wear",
        "worn profiles at the k = 4 peaks",
    ),
    "gap": (
        "gap",
        of_gap,
        GAPS,
        "Response",
        "gap over the speed",
    ),
    "loads": (
        "loads",
        files_of_loads,
        LOADS,
        "Response",
        "force, torque, worn volume and stress over the speed",
    ),
    "sensitivity": (
        "sensitivity",
        of_sobol,
        SENSITIVITY,
        "Sensitivity",
        "Sobol indices of a design",
    ),
    "stress": (
        "stress",
        of_scene(
            "states_rounds",
            fields="results/{blade}/{scene}/peak.vtu",
            numbers="results/{blade}/{scene}/peak.json",
        ),
        OF_RECORD["states_rounds"],
        "Response",
        "stress when the tip exceeds the gap most",
    ),
}


def all_figures():
    """Every figure as PNG and PDF, and the summaries."""
    of_blades = [n for n, blade in FIG03.items() if blade in BLADES and blade not in FOREIGN]
    of_blades += [n for n, blade in FIG09.items() if blade in BLADES and blade in MESHED]
    of_scenes = [
        figure
        for key, table in OF_RECORD.items()
        for figure, name in table.items()
        if name in SWEEPS and getattr(SWEEPS[name].record, key)
    ]
    of_scenes += [
        n for n, name in GAPS.items() if name in SWEEPS and SWEEPS[name].clearance.at_rest
    ]
    both = ["fig12"] if {"fig10a", "fig10b", "fig11a", "fig11b"} <= set(of_scenes) else []
    of_designs = [
        figure
        for figure, name in SENSITIVITY.items()
        if name in DELIVERED and is_sobol(DELIVERED[name])
    ]
    loads = [figure for figure, name in LOADS.items() if loads_of(name)]
    names = [*of_blades, *of_scenes, *both, *of_designs, *loads]
    return [
        *expand("results/figures/{name}.{suffix}", name=names, suffix=["png", "pdf"]),
        *expand("results/figures/{name}.{suffix}", name=SUMMARIES, suffix=["json", "md"]),
    ]
