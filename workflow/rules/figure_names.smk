# Which figures there are, and what each is made of.
import re

# The paper's figures keep the paper's numbers: those of its blade, and a and b for its two coatings.
# Figures of another blade or scene carry its name behind the number: fig03-<blade>, fig10-<scene>.
PAPER_BLADE = "reference"
PAPER_SCENES = {"paper-e1": "a", "paper-e10": "b"}


def figures_of_blades(number, names):
    """Blade by figure name."""
    return {number if name == PAPER_BLADE else f"{number}-{name}": name for name in names}


def figures_of_scenes(number, recorded):
    """Scene by figure name, for the scenes that record what the figure shows."""
    return {
        f"{number}{PAPER_SCENES.get(name, f'-{name}')}": name
        for name, scene in SCENES.items()
        if recorded(scene.record)
    }


# Any blade has these figures; `all_figures` wants them of the blades that a scene uses.
FIG03 = figures_of_blades("fig03", BLADE_FILES)
FIG09 = figures_of_blades("fig09", BLADE_FILES)
FIG10 = figures_of_scenes("fig10", lambda record: record.spectrum_rounds)
FIG11 = figures_of_scenes("fig11", lambda record: record.wear)
# Both coatings in one figure, when both are configured and record what it needs.
FIG12 = (
    {"fig12": PAPER_SCENES}
    if PAPER_SCENES.keys() <= SCENES.keys()
    and {"fig10a", "fig10b"} <= FIG10.keys()
    and {"fig11a", "fig11b"} <= FIG11.keys()
    else {}
)
# Not of the paper: always with the scene's name.
STRESS = {f"stress-{name}": name for name, scene in SCENES.items() if scene.record.states_rounds}
SUMMARIES = figures_of_blades("summary", BLADES)


def one_of(names):
    """Pattern of a wildcard that is one of ``names``; without names it matches nothing."""
    return "|".join(map(re.escape, names)) or "(?!)"


def of_blade(table, file):
    """``file`` of the figure's blade."""
    return lambda wildcards: f"results/{table[wildcards.figure]}/{file}"


def rom_of_blade(table, file="rom"):
    """The reduced model that the scenes of the figure's blade need, or its check."""

    def path(wildcards):
        blade = table[wildcards.figure]
        return f"results/{blade}/{file}-{directions_of(blade)}.nc"

    return path


def of_scene(table, pattern):
    """``pattern`` with the figure's scene and its blade."""

    def path(wildcards):
        scene = table[wildcards.figure]
        of = SCENES[scene]
        return pattern.format(blade=of.blade, scene=scene, directions=of.directions)

    return path


def scenes_of_summary(wildcards):
    blade = SUMMARIES[wildcards.figure]
    return [name for name, scene in DELIVERED.items() if scene.blade == blade]


def sweeps_of_summary(wildcards):
    blade = SUMMARIES[wildcards.figure]
    return [f"results/{blade}/{name}/sweep.nc" for name in scenes_of_summary(wildcards)]


def drawn_by(*modules):
    """Files that a figure is drawn by: an edit to one of them redraws it and runs nothing else."""
    return sources(
        *(f"workflow/figures/{name}.py" for name in ("style", "origins", *modules)),
        "geometry/provenance.py",
        *(f"simulate/{name}.py" for name in ("observables", "places")),
    )


def picture(caption, category, shows):
    """The PNG of a figure, for the report."""
    labels = {"figure": "{figure}", "shows": shows}
    return report("results/figures/{figure}.png", caption=caption, category=category, labels=labels)


def all_figures():
    """Every figure as PNG and PDF, and the summaries."""
    of_blades = [name for table in (FIG03, FIG09) for name in table if table[name] in BLADES]
    of_scenes = [
        name for table in (FIG10, FIG11, STRESS) for name in table if table[name] in DELIVERED
    ]
    both = FIG12 if PAPER_SCENES.keys() <= DELIVERED.keys() else ()
    names = [*of_blades, *of_scenes, *both]
    return [
        *expand("results/figures/{name}.{suffix}", name=names, suffix=["png", "pdf"]),
        *expand("results/figures/{name}.{suffix}", name=SUMMARIES, suffix=["json", "md"]),
    ]
