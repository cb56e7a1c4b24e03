"""Slopes of the liner's laws, measured on their loops, over the closed form: claim C04."""

from workflow.figures.fig05_laws import COMPARED, slopes


def slopes_over_closed_form() -> dict[str, float]:
    """Loading over EK/(E + K), unloading over E, of each law that Fig. 5 compares."""
    found = {}
    for law, *_ in COMPARED:
        if law.kind != "plastic":
            continue
        closed = {"loading": law.E * law.K / (law.E + law.K), "unloading": law.E}
        for name, slope in closed.items():
            found[f"{name}, E = {law.E:g}, K = {law.K:g}"] = slopes(law)[name] / slope
    return found
