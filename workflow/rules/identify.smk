# The identification: what the tables of the engine, of numbers.yaml, say of the parameters.
wildcard_constraints:
    prior=one_of(PRIORS),
    number=r"\d+",
    sample=one_of(TABLES),


rule identify:
    input:
        expand(
            "results/identify/{prior}/{file}",
            prior=PRIORS,
            file=["fits.json", "posterior.png", "shares.json", "together.png"],
        ),
