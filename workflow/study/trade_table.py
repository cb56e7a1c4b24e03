"""Tables of the study of accuracy and time, for the README."""

from collections.abc import Iterable, Sequence

from workflow.markdown import percent, table
from workflow.study.levels import (
    JUDGED,
    LEVELS,
    OBSERVABLES,
    OTHER_SCHEME,
    SCENES,
    Errors,
    levels,
    of_group,
    uncertainty,
)
from workflow.study.trade import Row

FLOOR = "uncertainty of the reference"
COUNTED = "lobes"  # given as a number, all others in per cent
SCHEMES = ("piecewise-exact", "central", "mass-scaled")

type Rows = Sequence[Row]  # of the experiment


def of_levels(rows: Rows) -> str:
    """Settings, largest error of each observable over all scenes, time per run and of `paper`.

    Errors are those of mesh, patches, natural modes, strips, step and rods together.
    """
    head = ["level", "settings", *_heads(), f"ms per run: {', '.join(SCENES)}", "paper, CPU min"]
    lines = [
        [
            _level(of),
            _settings(of["of"]),
            *_worst(row["errors"] for row in of["of"].values()),
            ", ".join(_ms(of["of"][scene]["cpu_s"]) for scene in SCENES if scene in of["of"]),
            f"{of['paper_min']:.0f}",
        ]
        for of in levels(rows)
    ]
    floor = _worst(uncertainty(rows, scene) for scene in SCENES)
    return table(head, [*lines, [FLOOR, "", *floor, "", ""]])


def schemes(rows: Rows) -> str:
    """CPU time (ms) of the cheapest run of each scheme that meets each level, by scene and error.

    Runs differ from their reference in scheme and step alone. The difference of two schemes at fine
    steps is the uncertainty.
    """
    columns = [f"{name} {allowed:.0%}" for allowed in LEVELS.values() for name in SCHEMES]
    tried, lines = of_group(rows, "scheme"), []
    for scene in SCENES:
        runs = [row for row in tried if row["scene"] == scene]
        for observable in JUDGED:
            cells = [
                _least([row for row in runs if scheme_of(row) == name], observable, allowed)
                for allowed in LEVELS.values()
                for name in SCHEMES
            ]
            unknown = [row["errors"][observable] for row in runs if row["row"] == OTHER_SCHEME]
            lines.append([scene, observable, *cells, *(_cell(observable, of) for of in unknown)])
    return table(["scene", "error of", *columns, "uncertainty"], lines)


def scheme_of(row: Row) -> str:
    """Scheme of a run: `piecewise-exact`, `central`, or `mass-scaled` central differences."""
    integrator = row["settings"]["integrator"]
    if integrator["scheme"] != "central-difference":
        return integrator["scheme"]
    return "central" if integrator.get("mass_scaling_hz") is None else "mass-scaled"


def interfaces(rows: Rows) -> str:
    """Errors of patches and strips, of natural modes and of the mesh, each against its finest."""
    of = of_group(rows, "interface", "modes", "mesh")
    lines = [
        [row["row"], scene, *_cells(row["errors"])]
        for scene in SCENES
        for row in of
        if row["scene"] == scene and row["row"] != row["against"]
    ]
    return table(["model", "scene", *_heads()], lines)


def requirements(rows: Rows) -> str:
    """Changes of each scene without a feature, and the ratio of CPU times."""
    times = {(row["scene"], row["row"]): row["cpu_s"] for row in rows}
    head = ["left out", "instead", "scene", *_heads(), "time ratio"]
    lines = [
        [
            *row["row"].split(": "),
            row["scene"],
            *_cells(row["errors"]),
            f"{row['cpu_s'] / times[row['scene'], row['against']]:.2f}",
        ]
        for row in of_group(rows, "feature")
    ]
    return table(head, sorted(lines, key=lambda line: line[0]))


def fewer_rounds(rows: Rows) -> str:
    """Error of the amplitude and CPU time of a run, by rounds before those of the spectrum."""
    of = {(row["row"], row["scene"]): row for row in of_group(rows, "rounds")}
    lines = [
        [
            name,
            *(_cell("amplitude", of[name, scene]["errors"]["amplitude"]) for scene in SCENES),
            ", ".join(_ms(of[name, scene]["cpu_s"]) for scene in SCENES),
        ]
        for name in dict.fromkeys(name for name, _ in of)
        if name != of[name, SCENES[0]]["against"]
    ]
    return table(["rounds before", *SCENES, "ms per run"], lines)


def fewer_speeds(rows: Rows) -> str:
    """Errors of the peaks and CPU times of full sweeps, and of coarse ones refined around peaks."""
    lines = [
        [
            row["row"],
            row["numbers"]["marches"],
            f"{row['cpu_s']:.1f}",
            *(_cell(name, row["numbers"]["errors"][name]) for name in ("Omega_c", "amplitude")),
        ]
        for row in rows
        if row["group"] == "speeds" and row["against"]
    ]
    return table(["sweep", "runs", "CPU s", "Omega c", "amplitude"], lines)


def _least(runs: Iterable[Row], observable: str, allowed: float) -> str:
    """Least CPU time of the runs that meet a level; runs without a result do not."""
    errors = ((run["cpu_s"], run["errors"][observable]) for run in runs)
    times = [seconds for seconds, error in errors if error is not None and error < allowed]
    return _ms(min(times)) if times else "-"


def _ms(seconds: float) -> str:
    return f"{1e3 * seconds:.0f}"


def _heads() -> list[str]:
    return [name.replace("_", " ") for name in OBSERVABLES]


def _level(of: Row) -> str:
    """The level and its error; if no setting meets it, a note that this is the most accurate."""
    level = f"{of['level']}, {of['allowed']:.0%}"
    return level if of["met"] else f"{level}: not met, most accurate setting"


def _settings(rows: dict[str, Row]) -> str:
    """Settings with a flat tip, and the rods with the tilted tip."""
    flat, tilted = rows[SCENES[0]], rows.get("tangential", rows[SCENES[0]])
    of, liner = flat["numbers"], flat["settings"]["liner"]
    rods = tilted["settings"]["liner"]["rods_per_round"]
    return (
        f"blade {flat['blade']}: {of['patches']} patches (n = {of['n']}), "
        f"{liner['strips']} strips, {of['steps']} steps, "
        f"{liner['rods_per_round']} rods ({rods} tilted)"
    )


def _worst(scenes: Iterable[Errors]) -> list[str]:
    """Largest error of each observable; a dash without any."""
    of = [*scenes]
    known = {name: [one[name] for one in of if one[name] is not None] for name in OBSERVABLES}
    return _cells({name: max(values, default=None) for name, values in known.items()})


def _cells(errors: Errors) -> list[str]:
    return [_cell(name, errors[name]) for name in OBSERVABLES]


def _cell(name: str, value: float | None) -> str:
    if name == COUNTED and value is not None:
        return f"{value:.0f}"
    return percent(value)
