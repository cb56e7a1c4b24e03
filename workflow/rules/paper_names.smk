# What the editions of the paper consist of, and where their results are.
from workflow.paper.cases import E, REPEATS, UNITS_PA
from workflow.paper.causes import CAUSES, TIPS
from workflow.paper.stiffness import SCALES

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


def blade_of_edition(file):
    """A file of the edition's own blade."""
    return (
        lambda wildcards: f"results/{SCENES[scene_of_part(wildcards.edition, 'e1')].blade}/{file}"
    )


def more_of_edition(wildcards):
    """Numbers that are no part of a repeat."""
    if wildcards.edition in REPEATS:
        return []
    own = ["model", *(["settled"] if wildcards.edition == "reference" else [])]
    return [f"results/paper/{wildcards.edition}/{name}.json" for name in own]


def there(paths):
    """Those of the files, by name, that are there."""
    return {name: path for name, path in paths.items() if Path(path).is_file()}


def made_at(groups):
    """When those of the files that are there were made: the table takes in new ones."""
    files = [file for paths in groups.values() for file in there(paths).values()]
    return {file: Path(file).stat().st_mtime_ns for file in files}


# What the claims table takes in where it is there
REPEATED = {name: f"results/paper/{name}/numbers.json" for name in REPEATS}
ON_OTHER = {OTHER: f"results/paper/{OTHER}/numbers.json"}
CAUSED = {
    cause.name: f"results/paper/causes/{prefix}{i}.json"
    for prefix, causes in (("", CAUSES), ("tip-", TIPS))
    for i, cause in enumerate(causes)
}
BESIDE = {
    "repeats": REPEATED,
    "other": ON_OTHER,
    "causes": CAUSED,
    "map": {"map": "results/paper/contact-map.json"},
    "stiffness": {"map": "results/paper/stiffness.json"},
}


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
    "paper_causes": ["results/reference-linear", *folders(["causes", "contact-map", "stiffness"])],
    "paper_rotor37": ["results/rotor37-fast", *folders([OTHER], (OTHER,))],
}


# The paper's figures that `figures.smk` does not draw, by their number: module, inputs, caption.
OF_REFERENCE = "results/reference/{}".format


def sweep_of(scene):
    """Sweep of one of the paper's scenes on its blade."""
    return OF_REFERENCE(f"paper-{scene}/sweep.nc")


GRID = "results/paper/reference/grid.json"
OF_CAUSES = ("calibration", "stiffness")  # figures that go with the causes
PAPER_CODE = sources(
    *(f"workflow/paper/{n}.py" for n in ("cases", "measure", "contact_map", "stiffness"))
)
DRAWN_WITH = ("response", "curve", "marks", "views", "runs", "grid", "grid_map")
PAPER_FIGURES = {
    "fig02": (
        "fig02_blade",
        {"mesh": OF_REFERENCE("blade.msh")},
        "The blade with its interface nodes, numbered from the leading edge.",
    ),
    "fig04": (
        "fig04_footprint",
        {
            "sweep": sweep_of("e1"),
            "rom": OF_REFERENCE("rom-r.nc"),
            "tilted": sweep_of("tilted"),
        },
        "A node's footprint over its rods, flat as in most scenes, and tilted as where the "
        "tangential force is modelled.",
    ),
    "fig05": ("fig05_laws", {}, "Laws of the liner as loops of stress and strain."),
    "fig06": (
        "fig06_casing",
        {"two": sweep_of("e1"), "two_five": sweep_of("two-five")},
        "Shapes of the casing, two diameters, and two and five.",
    ),
    "fig07": (
        "fig07_densities",
        {"coarse": sweep_of("density-1"), "fine": sweep_of("density-4")},
        "Worn profiles after twenty rounds for two densities, on the k = 4 peak and off it.",
    ),
    "fig08": (
        "fig08_displacement",
        {
            "coarse": sweep_of("density-1"),
            "fine": sweep_of("density-4"),
            "steps": [sweep_of(f"step-0{i}") for i in (8, 4, 2)],
        },
        "Displacement of node 1 for two densities, and for three steps of the paper's scheme.",
    ),
    "fig13": (
        "fig13_grid",
        {"grid": GRID},
        "Amplitude and critical speed of the k = 4 peak over the coatings of Table 1.",
    ),
    "fig13-k6": (
        "fig13_k6",
        {"grid": GRID},
        "The same for the k = 6 peak, which the paper leaves out.",
    ),
    "predictable": (
        "status_grid",
        {"grid": GRID},
        "How the runs of each coating ended, and whether its peaks can be predicted.",
    ),
    "fig14": (
        "fig11_wear",
        {"rom": OF_REFERENCE("rom-r.nc"), "sweep": sweep_of("two-five")},
        "Wear on a casing with two and five diameters.",
    ),
    "fig15": (
        "fig10_spectra",
        {"rom": OF_REFERENCE("rom-rt.nc"), "sweep": sweep_of("tangential")},
        "Response with tangential force.",
    ),
    "fig15-without": (
        "fig10_spectra",
        {"rom": OF_REFERENCE("rom-r.nc"), "sweep": sweep_of("tilted")},
        "Response of the same tip without the tangential force.",
    ),
    "fig16": (
        "fig16_spectrogram",
        {
            "without": sweep_of("tilted"),
            "withit": sweep_of("tangential"),
            "rom": OF_REFERENCE("rom-rt.nc"),
        },
        "Spectrograms at the k = 4 peak without and with tangential force.",
    ),
    "worst": (
        "worst",
        {"worst": "results/paper/reference/growth.json"},
        "Worst coatings over 200 rounds, beside the bare casing.",
    ),
    "calibration": (
        "contact_map",
        {"map": "results/paper/contact-map.json"},
        "Unit of E and casing amplitude: the calibration, and where the paper's order of the two "
        "coatings holds.",
    ),
    "stiffness": (
        "stiffness",
        {"map": "results/paper/stiffness.json", "sweep": sweep_of("e1")},
        "Amplitude of the k = 4 peak over both moduli in Pa: the paper's table at any unit of E is "
        "a window of it.",
    ),
}
