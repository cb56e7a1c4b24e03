# What the editions of the paper consist of, and where their results are.
from workflow.paper.cases import E, REPEATS, RICHER, UNITS_PA
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
    """Name of the scene of one part; a repeat changes that of the reference."""
    blade = OTHER if edition == OTHER else "paper"
    return f"{blade}-{PARTS.get(part, part)}"


def of_part(edition, part):
    """The scene itself."""
    scene = SCENES[scene_of_part(edition, part)]
    return REPEATS[edition](scene) if edition in REPEATS else scene


def settings_of_part(edition, part):
    """Its settings, as the scripts take them."""
    return of_part(edition, part).model_dump(mode="json")


def rom_of_part(edition, part):
    """The reduced model of one part."""
    scene = of_part(edition, part)
    return f"results/{scene.blade}/rom-{scene.directions}.nc"


def sweep_of_part(edition, part):
    """Where one part's sweep is: repeats keep theirs apart."""
    name = scene_of_part(edition, part)
    if edition in REPEATS:
        return f"results/paper/{edition}/{name}.nc"
    return f"results/{SCENES[name].blade}/{name}/sweep.nc"


STUDIED = MARCH + sources(
    *(f"workflow/paper/{name}.py" for name in ("cases", "peaks")),
)


def blade_of_edition(file, variant=""):
    """A file of the edition's own blade, or of its variant: "-paper" is as the paper reduces it."""
    return lambda wildcards: f"results/{of_part(wildcards.edition, 'e1').blade}{variant}/{file}"


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
    "blade, mesh, reduced models": ["results/reference", "results/reference-paper"],
    "paper": folders(["reference"], ("paper", "peak")),
    "paper_uncertainty": [f"results/{RICHER}", *folders(REPEATS)],
    "paper_causes": ["results/reference-linear", *folders(["causes", "contact-map", "stiffness"])],
    "paper_rotor37": [
        "results/rotor37-fast",
        "results/rotor37-fast-paper",
        *folders([OTHER], (OTHER,)),
    ],
}


# The paper's figures that `figures.smk` does not draw, by their number: module, inputs, caption.
OF_REFERENCE = "results/reference/{}".format


def sweep_of(scene):
    """Sweep of one of the paper's scenes on its blade."""
    return OF_REFERENCE(f"paper-{scene}/sweep.nc")


GRID = "results/paper/reference/grid.json"
OF_CAUSES = ("calibration", "stiffness")  # figures that go with the causes
PAPER_CODE = sources(
    *(
        f"workflow/paper/{n}.py"
        for n in ("cases", "measure", "contact_map", "stiffness", "laws", "footprint")
    )
)
DRAWN_WITH = ("response", "curve", "marks", "views", "heat_map")
FIGURE_GIVEN = {"fig13-k6": {"order": 6}}  # what a figure's module is given beside its files
GAP = "Gap g is the initial gap, and displacement that, at the chord fraction xi = 1/16."
PAPER_FIGURES = {
    "fig02": (
        "fig02_blade",
        {"mesh": OF_REFERENCE("blade.msh"), "rom": OF_REFERENCE("rom-r.nc")},
        "(a) The blade, with the nodes of its patches on the camber line of the tip. (b) The tip, "
        "unrolled. (c) Hats of the patches along the chord, and where outputs are told.",
    ),
    "fig04": (
        "fig04_footprint",
        {
            "sweep": sweep_of("e1"),
            "rom": OF_REFERENCE("rom-r.nc"),
            "tilted": sweep_of("tilted"),
        },
        "The tip over the rods of its foremost strip, flat as in most scenes, and tilted as where "
        f"the tangential force is modelled. {GAP}",
    ),
    "fig05": ("fig05_laws", {}, "Laws of the liner as loops of stress and strain."),
    "fig06": (
        "fig06_casing",
        {"two": sweep_of("e1"), "two_five": sweep_of("two-five")},
        f"Shapes of the casing, two diameters, and two and five. {GAP}",
    ),
    "fig07": (
        "fig07_densities",
        {"coarse": sweep_of("density-1"), "fine": sweep_of("density-4")},
        "Depth worn by the leading eighth of the chord in twenty rounds, mean over it, for two "
        f"densities, on the k = 4 peak and off it. {GAP}",
    ),
    "fig08": (
        "fig08_displacement",
        {
            "coarse": sweep_of("density-1"),
            "fine": sweep_of("density-4"),
            "steps": [sweep_of(f"step-0{i}") for i in (8, 4, 2)],
        },
        "Radial displacement for two densities, and for three steps of the paper's scheme. "
        f"{GAP}",
    ),
    "fig13": (
        "fig13_grid",
        {"grid": GRID},
        f"Amplitude and critical speed of the k = 4 peak over the coatings of Table 1. {GAP}",
    ),
    "fig13-k6": (
        "fig13_grid",
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
        "Wear on a casing with two and five diameters, mean over the leading eighth of the chord. "
        f"{GAP}",
    ),
    "fig15": (
        "fig10_spectra",
        {"rom": OF_REFERENCE("rom-rt.nc"), "sweep": sweep_of("tangential")},
        f"Response with tangential force. {GAP}",
    ),
    "fig15-without": (
        "fig10_spectra",
        {"rom": OF_REFERENCE("rom-r.nc"), "sweep": sweep_of("tilted")},
        f"Response of the same tip without the tangential force. {GAP}",
    ),
    "fig16": (
        "fig16_spectrogram",
        {
            "without": sweep_of("tilted"),
            "withit": sweep_of("tangential"),
            "rom": OF_REFERENCE("rom-rt.nc"),
        },
        f"Spectrograms at the k = 4 peak without and with tangential force. {GAP}",
    ),
    "worst": (
        "worst",
        {"worst": "results/paper/reference/growth.json"},
        f"Worst coatings over 200 rounds, beside the bare casing. {GAP}",
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
        f"a window of it. {GAP}",
    ),
}
