# The paper's figures that `figures.smk` does not draw, by their number: module, inputs, caption.
OF_REFERENCE = "results/reference/{}".format


def sweep_of(scene):
    """Sweep of one of the paper's scenes on its blade."""
    return OF_REFERENCE(f"paper-{scene}/sweep.nc")


GRID = "results/paper/reference/grid.json"
PAPER_FIGURES = {
    "fig02": (
        "fig02_blade",
        {"mesh": OF_REFERENCE("blade.msh"), "interface": OF_REFERENCE("interface.csv")},
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
}


rule paper_figure:
    input:
        unpack(lambda wildcards: PAPER_FIGURES[wildcards.figure][1]),
        code=lambda wildcards: drawn_by(PAPER_FIGURES[wildcards.figure][0], "response", "curve"),
    output:
        png=picture("../report/paper.rst", "The paper", "figure of the paper"),
        pdf="results/figures/{figure}.pdf",
    log:
        "results/figures/logs/{figure}.log",
    wildcard_constraints:
        figure=one_of(PAPER_FIGURES),
    params:
        module=lambda wildcards: PAPER_FIGURES[wildcards.figure][0],
        caption=lambda wildcards: PAPER_FIGURES[wildcards.figure][2],
    message:
        "Figure {wildcards.figure} of the paper"
    script:
        "../scripts/figure.py"


# Drawn by the default workflow too
SHARED_FIGURES = [
    "fig03",
    "fig09",
    "fig10a",
    "fig10b",
    "fig11a",
    "fig11b",
    "fig12",
    "stress-peak-e1",
]


rule paper:
    input:
        "results/paper/claims.md",
        "results/paper/cost.md",
        expand(
            "results/figures/{figure}.{suffix}",
            figure=[*SHARED_FIGURES, *(name for name in PAPER_FIGURES if name != "calibration")],
            suffix=["png", "pdf"],
        ),
