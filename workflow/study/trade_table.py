"""Tables of the study of accuracy and time, for the README."""

from collections.abc import Collection, Iterable

from workflow.markdown import percent, table
from workflow.study.trade_levels import LEVELS, cost, scheme_of
from workflow.study.trade_runs import JUDGED, OBSERVABLES, Errors, Row

FLOOR = "uncertainty of the reference"
COUNTED = "lobes"  # given as a number, all others in per cent
SCHEMES = ("piecewise-exact", "central", "mass-scaled")


def levels(study: Row) -> str:
    """Settings, largest error of each observable over all scenes, time per run and of `paper`.

    Errors are those of mesh, patches, natural modes, strips, step and rods together.
    """
    names = list(study["scenes"])
    head = ["level", "settings", *_heads(), f"ms per run: {', '.join(names)}", "paper, CPU min"]
    rows = [
        [
            _level(row),
            _settings(row["settings"]),
            *_worst(row["errors"].values()),
            ", ".join(f"{1e3 * row['cpu_s'][name]:.0f}" for name in names),
            f"{row['paper_min']:.0f}",
        ]
        for row in study["levels"]
    ]
    floor = _worst([scene["uncertainty"] for scene in study["scenes"].values()])
    return table(head, [*rows, [FLOOR, "", *floor, "", ""]])


def schemes(study: Row) -> str:
    """CPU time (ms) of the cheapest run of each scheme that meets each level, by scene and error.

    Runs differ from their reference in scheme and step alone. The difference of two schemes at fine
    steps is the uncertainty.
    """
    columns = [f"{name} {allowed:.0%}" for allowed in LEVELS.values() for name in SCHEMES]
    rows = []
    for scene, about in study["scenes"].items():
        runs = [r for r in study["runs"] if (r["study"], r["scene"]) == ("scheme", scene)]
        for observable in JUDGED:
            cells = [
                _milliseconds([r for r in runs if scheme_of(r) == name], observable, allowed)
                for allowed in LEVELS.values()
                for name in SCHEMES
            ]
            unknown = _cell(observable, about["another_scheme"][observable])
            rows.append([scene, observable, *cells, unknown])
    return table(["scene", "error of", *columns, "uncertainty"], rows)


def interfaces(study: Row) -> str:
    """Errors of patches and strips, of natural modes and of the mesh, each against its finest."""
    rows = [
        [run["label"], run["scene"], *_cells(run["errors"])]
        for run in study["runs"]
        if run["study"] in ("interface", "modes", "mesh")
    ]
    return table(["model", "scene", *_heads()], rows)


def requirements(study: Row) -> str:
    """Changes of each scene without a feature, and the ratio of CPU times."""
    head = ["left out", "instead", "scene", *_heads(), "time ratio"]
    rows = [
        [
            row["feature"],
            row["instead"],
            row["scene"],
            *_cells(row["changes"]),
            f"{row['time_ratio']:.2f}",
        ]
        for row in sorted(study["features"], key=lambda row: row["feature"])
    ]
    return table(head, rows)


def fewer_rounds(study: Row) -> str:
    """Error of the amplitude and CPU time of a run, by rounds before those of the spectrum."""
    of = {(row["rounds_before"], row["scene"]): row for row in study["rounds"]}
    scenes = list(dict.fromkeys(name for _, name in of))
    rows = [
        [
            str(rounds),
            *(_cell("amplitude", of[rounds, name]["errors"]["amplitude"]) for name in scenes),
            ", ".join(f"{1e3 * cost(of[rounds, name]):.0f}" for name in scenes),
        ]
        for rounds in dict.fromkeys(rounds for rounds, _ in of)
    ]
    return table(["rounds before", *scenes, "ms per run"], rows)


def fewer_speeds(study: Row) -> str:
    """Errors of the peaks and CPU times of full sweeps, and of coarse ones refined around peaks."""
    rows = [
        [
            row["label"],
            str(row["marches"]),
            f"{row['cpu_s']:.1f}",
            _cell("Omega_c", row["errors"]["Omega_c"]),
            _cell("amplitude", row["errors"]["amplitude"]),
        ]
        for row in study["sweep"]
    ]
    return table(["sweep", "runs", "CPU s", "Omega c", "amplitude"], rows)


def _milliseconds(runs: Iterable[Row], observable: str, allowed: float) -> str:
    """Least CPU time of the runs that meet a level; runs without a result do not."""
    errors = ((cost(run), run["errors"][observable]) for run in runs)
    times = [seconds for seconds, error in errors if error is not None and error < allowed]
    return f"{1e3 * min(times):.0f}" if times else "-"


def _heads() -> list[str]:
    return [name.replace("_", " ") for name in OBSERVABLES]


def _level(row: Row) -> str:
    """The level and its error; if no setting meets it, a note that this is the most accurate."""
    level = f"{row['level']}, {row['allowed']:.0%}"
    return level if row["met"] else f"{level}: not met, most accurate setting"


def _settings(of: Row) -> str:
    rods = f"{of['rods']} rods ({of['rods_tilted']} tilted)"
    model = (
        f"mesh {of['mesh_mm']:g} mm, {of['patches']} patches, {of['modes']} modes (n = {of['n']})"
    )
    return f"{model}, {of['strips']} strips, {of['steps']} steps, {rods}"


def _worst(scenes: Collection[Errors]) -> list[str]:
    """Largest error of each observable; a dash without any."""
    known = {name: [of[name] for of in scenes if of[name] is not None] for name in OBSERVABLES}
    return _cells({name: max(values, default=None) for name, values in known.items()})


def _cells(errors: Errors) -> list[str]:
    return [_cell(name, errors[name]) for name in OBSERVABLES]


def _cell(name: str, value: float | None) -> str:
    if name == COUNTED and value is not None:
        return f"{value:.0f}"
    return percent(value)
