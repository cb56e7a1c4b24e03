include: "figure_names.smk"


rule fig03:
    input:
        code=drawn_by("fig03_campbell", "curve", "marks", "response"),
        rom=rom_of_blade(FIG03),
        check=rom_of_blade(FIG03, "rom-check"),
    output:
        png=picture("../report/fig03.rst", "Blade", "Campbell diagram"),
        pdf="results/figures/{figure}.pdf",
    log:
        "results/figures/logs/{figure}.log",
    wildcard_constraints:
        figure=one_of(FIG03),
    params:
        module="workflow.figures.fig03_campbell",
    message:
        "Campbell diagram {wildcards.figure}"
    script:
        "../scripts/figure.py"


rule fig09:
    input:
        code=drawn_by("fig09_modes", "views"),
        mesh=of_blade(FIG09, "blade.msh"),
        full=of_blade(FIG09, "full-model.nc"),
    output:
        png=picture("../report/fig09.rst", "Blade", "natural modes at rest"),
        pdf="results/figures/{figure}.pdf",
    log:
        "results/figures/logs/{figure}.log",
    wildcard_constraints:
        figure=one_of(FIG09),
    params:
        module="workflow.figures.fig09_modes",
    message:
        "Mode shapes {wildcards.figure}"
    script:
        "../scripts/figure.py"


rule fig10:
    input:
        code=drawn_by("fig10_spectra", "curve", "response", "marks"),
        rom=of_scene("spectrum_rounds", "results/{blade}/rom-{directions}.nc"),
        sweep=of_scene("spectrum_rounds", "results/{blade}/{scene}/sweep.nc"),
    output:
        png=picture("../report/fig10.rst", "Response", "response spectra"),
        pdf="results/figures/{figure}.pdf",
    log:
        "results/figures/logs/{figure}.log",
    wildcard_constraints:
        figure=one_of(OF_RECORD["spectrum_rounds"]),
    params:
        module="workflow.figures.fig10_spectra",
    message:
        "Response spectra {wildcards.figure}"
    script:
        "../scripts/figure.py"


rule fig11:
    input:
        code=drawn_by("fig11_wear", "curve", "response", "marks"),
        rom=of_scene("wear", "results/{blade}/rom-{directions}.nc"),
        sweep=of_scene("wear", "results/{blade}/{scene}/sweep.nc"),
    output:
        png=picture("../report/fig11.rst", "Wear", "wear map"),
        pdf="results/figures/{figure}.pdf",
    log:
        "results/figures/logs/{figure}.log",
    wildcard_constraints:
        figure=one_of(OF_RECORD["wear"]),
    params:
        module="workflow.figures.fig11_wear",
    message:
        "Wear map {wildcards.figure}"
    script:
        "../scripts/figure.py"


rule fig12:
    input:
        code=drawn_by("fig12_profiles", "curve", "response", "marks"),
        rom=f"results/{PAPER_BLADE}/rom-{directions_of(PAPER_BLADE)}.nc",
        sweeps=both_coatings,
    output:
        png=picture("../report/fig12.rst", "Wear", "worn profiles at the k = 4 peaks"),
        pdf="results/figures/{figure}.pdf",
    log:
        "results/figures/logs/{figure}.log",
    wildcard_constraints:
        figure="fig12",
    params:
        module="workflow.figures.fig12_profiles",
    message:
        "Worn profiles {wildcards.figure}"
    script:
        "../scripts/figure.py"


rule stress:
    input:
        code=drawn_by("stress", "views"),
        fields=of_scene("states_rounds", "results/{blade}/{scene}/peak.vtu"),
        numbers=of_scene("states_rounds", "results/{blade}/{scene}/peak.json"),
    output:
        png=picture("../report/stress.rst", "Response", "stress farthest beyond the gap"),
        pdf="results/figures/{figure}.pdf",
    log:
        "results/figures/logs/{figure}.log",
    wildcard_constraints:
        figure=one_of(OF_RECORD["states_rounds"]),
    params:
        module="workflow.figures.stress",
    message:
        "Stress on the deformed blade {wildcards.figure}"
    script:
        "../scripts/figure.py"


rule summary:
    input:
        code=drawn_by("summary", "fig03_campbell", "curve", "response", "marks")
        + sources("workflow/markdown.py"),
        rom=rom_of_blade(SUMMARIES),
        check=rom_of_blade(SUMMARIES, "rom-check"),
        sweeps=sweeps_of_summary,
    output:
        json="results/figures/{figure}.json",
        markdown=report(
            "results/figures/{figure}.md",
            caption="../report/summary.rst",
            category="Numbers",
            labels={"figure": "{figure}", "shows": "the figures' numbers"},
        ),
    log:
        "results/figures/logs/{figure}.log",
    wildcard_constraints:
        figure=one_of(SUMMARIES),
    params:
        scenes=scenes_of_summary,
    message:
        "Numbers of the figures: {wildcards.figure}"
    script:
        "../scripts/summary.py"


rule figures:
    input:
        all_figures(),
