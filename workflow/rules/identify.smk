# The identification: what the tables of the engine, of numbers.yaml, say of the parameters.
wildcard_constraints:
    sample=one_of(TABLES),
    identified=one_of(IDENTIFIED),
    draws=one_of(DRAWS),


rule identify:
    input:
        expand(
            "results/identify/{identified}/{file}",
            identified=IDENTIFIED,
            file=["fits.json", "posterior.png"],
        ),
        "results/identify/blades.json",
        expand(
            "results/identify/{identified}/{file}",
            identified=JUDGED_ON,
            file=["scene.json", "shares.json", "together.png"],
        ),
