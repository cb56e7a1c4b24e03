def all_figures():
    return []


rule figures:
    input:
        all_figures(),
