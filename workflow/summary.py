"""The summary of a run in units of engines: ``results/summary.json``, ``.md`` and ``.csv``.

One row for each peak, with the uncertainty of each number or that it is not known.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import zip_longest
from math import ceil, isfinite, nan
from pathlib import Path
from textwrap import wrap
from typing import TYPE_CHECKING, Any, NamedTuple

from geometry.base import csv_text, printable, read_json
from geometry.blade import RPM_PER_HZ
from geometry.tip import JUDGED
from simulate.errors.model_errors import BEYOND
from simulate.errors.neighbour import CHAOTIC, ONE_MOTION, TWO_MOTIONS
from simulate.errors.schema import of_peaks
from simulate.scene import DYING_OUT, GROWING, STEADY, TRENDS
from simulate.sweeps.result_types import NO_CROSSING, OfBlades, Spread, numbers_of, order_name
from workflow import margins, markdown, stage_told, stress_told
from workflow.markdown import Number
from workflow.stress_told import ALL

if TYPE_CHECKING:  # a slow import, which Snakemake does without
    from simulate.sweeps.peak import Peak


class Column(NamedTuple):
    """A number of each peak."""

    name: str
    unit: str
    scale: float  # of the unit, from SI
    head: str  # in tables

    def number(self, value: float, error: float | None = None, least: bool = False) -> Number:
        """The number in its unit."""
        return Number(self.scale * value, error and self.scale * error, least)

    def shown(self, numbers: Mapping[str, float]) -> str:
        """The number in its unit; a dash where it is not known."""
        return self.number(numbers[self.name]).shown if self.name in numbers else "-"


OVER_F1 = ("Ω_c / f₁(0)", "Ω_c / crossing")  # heads of ``over_gap``
OVER_GAP = ("‖Y‖ / gap", "worn depth / gap")
PLACES = dict(zip(JUDGED, ("", " at ξ = 15/16", " at ξ = 1/2"), strict=True))
AT_END = ("at the end", "τ rev.", "mm³/rev.")  # heads
WORDS = {  # in the tables, beside the numbers
    "mode": "that from whose linear crossing with the order the peak rises, or several whose "
    "crossings are near",
    "after so many revolutions": "not all motions in the column are steady then: their numbers, "
    "with their ±, are those after so many revolutions, not those of the motion that they go to",
    "at ξ = 15/16": "on a casing that tapers the motion is u_r - s u_z, s = dr/dz, at ξ = 1/16 or "
    "15/16, whichever moves more",
    BEYOND: "it exceeds a tenth of the motion, or the tip moves along the axis by more than half a "
    "strip's width: to model it needs the square of the motion in the gap, and strips that the tip "
    "changes as it moves",
    stress_told.RISES: "the stress rises further, towards the part of the blade that is left out",
    "±": "root of the sum of squares of the changes by a twin (gaps changed by 1e-10), by models "
    "with frequencies off by their known errors, by a model with half the patches, and by a run "
    "with twice the steps, rods and strips (the last two not with central differences, with "
    "points, or in a run that continues from another); for the amplitude also the rise to "
    "the top between the speeds, by two runs halfway to its neighbours; for the speed the spacing "
    "of the sweep and the errors of the frequencies, without shifts by step, strips and patches",
    "≥": "as ±, but some of these are not known",
    AT_END[0]: f"whether the motion is {', '.join(TRENDS)}, by the range of u_r of each revolution",
    AT_END[1]: "time constant of the mode that responds, in which it dies out to 1/e",
    AT_END[2]: "volume worn in a revolution of the last quarter of the run",
    ONE_MOTION: "no second run leads to another motion; the motion need not be steady",
    TWO_MOTIONS: "small changes of the model lead to one motion or the other; both solutions are "
    "listed",
    CHAOTIC: "a change of all gaps by 1e-10 changes the numbers by over 1 %",
}
ENDS = ("most", "median", "least")  # of ``Spread``
OF_STATES = {"sigma"}  # of ``stress.json``: for second runs
FINER = {"finer", "companion"}  # second runs of other fineness: one of them
PARTS = {  # of uncertainties, that may not be known
    "twin": "change by a twin",
    "model": "error of the model",
    "mesh": "error of the mesh",
    "fineness": "error of step, strips and patches (no result of other fineness)",
    "speeds": "amplitude between the speeds of the sweep (peaks: adds speeds)",
}

# Values of a scene taken from its answers as they are.
COPIED = (
    *("scene", "blade", "f1_Hz", "gap_m", "dofs", "status", "reasons", "ends", "swept", "free"),
    *("checks", "model_error", "no_torque", "mu_crit", "sweep_s", "whirls", "blades", "assumed"),
)

COURSE = {  # of ``Course``: unit and its scale from SI
    "rounds": ("rounds", 1.0),
    "time_constant": ("rounds", 1.0),
    "largest_round": ("round", 1.0),
    "place": ("xi", 1.0),
    "wears": ("mm3 per round", 1e9),
    "grows": ("1", 1.0),
    "grows_in": ("rounds", 1.0),
}


type PeakRow = Mapping[str, Any]  # of a peak, as of ``_row``


def numbers(
    files: Any, operating: Mapping[str, Mapping[str, Any]], others: Sequence[str] = ()
) -> dict[str, Any]:
    """The summary of ``files.answers``, one for each scene, with their ``files.stress``.

    Margins of the speeds are of ``files.roms``, the model of each scene.

    ``operating``: what ``simulate.sweeps.crossings.critical`` seeks, by blade; ``others``: scenes
    that have results and are left out, for they may be of other settings or code.
    """
    from rom.model import Rom  # slow imports, which Snakemake does without
    from simulate.sweeps.crossings import critical

    stress = {row["scene"]: row for row in map(read_json, getattr(files, "stress", []))}
    return {
        "scenes": [
            _scene(
                results,
                stress.get(results["scene"]),
                critical(Rom.load(rom), operating[results["blade"]]),
            )
            for results, rom in zip(map(read_json, files.answers), files.roms, strict=True)
        ],
        "others": list(others),
    }


def _scene(
    results: Mapping[str, Any], stress: Mapping[str, Any] | None, campbell: Mapping[str, Any]
) -> dict[str, Any]:
    """One scene; ``stress``: as of ``stress.json``; ``campbell``: its linear crossings."""
    from simulate.sweeps.peak import Peak  # slow, as above

    stress_by_speed = {
        row["speed_over_f1"]: {key: row[key] for key in row.keys() - OF_STATES}
        for row in (stress["speeds"] if stress else [])
    }
    found, worst = ([*map(Peak.of, results[name])] for name in ("peaks", "worst"))
    rows, of_worst = (
        [_row(results, peak, stress_by_speed.get(peak.Omega_c, {})) for peak in peaks]
        for peaks in (found, worst)
    )
    rub_peaks = [
        {
            "what": _what(row),
            "modes": row["modes"],
            "k": row["k"],
            "rpm": row["rpm"],
            "quadratic_rpm": None,
            "bound": row["bound"],
            "rpm_error": row["rpm_error"],
            "least": row["least"],
        }
        for row in rows
        if row["k"]
    ]
    of_casing = margins.of_casing(results["whirls"])
    return {
        **{key: results[key] for key in COPIED},
        "answers_s": sum(peak.seconds for peak in [*found, *worst]),
        "runs": sum(peak.runs for peak in [*found, *worst]),
        "rows": rows,
        "worst": of_worst,
        "stress": stress and {**stress, "speeds": [*stress_by_speed.values()]},
        "operating": campbell,
        "margins": margins.rows(
            campbell,
            [*rub_peaks, *of_casing],
            _model_error(results),
            None in results["model_error"].values(),
            results["seen"],
        ),
    }


def _what(row: PeakRow) -> str:
    """What a peak is: of a blade that does not touch that of its forces."""
    kind = "forced peak" if row["status"] == "no-contact" else "rub peak"
    return f"{kind} ({row['course'].get('trend')})" if moves(row) else kind


def _row(results: Mapping[str, Any], peak: "Peak", stress: Mapping[str, Any]) -> PeakRow:
    """The row of a peak: speeds in rpm and over f1(0), all else in SI; None where it is not known.

    ``stress``: that of its speed, empty where it is not known.
    """
    f1, k, over_f1 = results["f1_Hz"], peak.k, peak.Omega_c
    values = peak.numbers | {name: stress[name] for name in of_peaks() if name in stress}
    unexplained = NO_CROSSING * bool(k and not peak.modes)
    return {
        "k": k,  # engine order, or f / Omega of a line on none; None without a peak
        "k_error": results["half_bin"],  # of the latter
        "modes": [*peak.modes],  # of which it may be; none where no crossing explains it
        "place": peak.place,  # chord fraction of its amplitude
        "rpm": RPM_PER_HZ * f1 * over_f1,
        "rpm_error": _speed_error(results, peak),
        "least": None in results["model_error"].values(),  # a part of that is not known
        "over_f1": over_f1,
        "hz": k and k * f1 * over_f1,
        "over_crossing": peak.over_crossing,
        "bound": peak.at_end,  # of the sweep
        "status": peak.status,
        # verdict of second runs, else the status
        "word": ", ".join(filter(None, [peak.verdict or peak.status, peak.beyond, unexplained])),
        "lobes": peak.lobes,
        "course": peak.course,
        "unknown": _unknown(results["model_error"], peak.parts),
        "over_gap": {  # as figures have them
            "amplitude": peak.amplitude,
            "wear": (wear := values.get("wear")) and wear / results["gap_m"],
        },
        "values": values,
        "rises": stress.get("rises", ""),  # end of the airfoil towards which its stress does
        "errors": peak.errors,
        "blades": peak.blades,  # of a stage: numbers of each
        "other": peak.other,  # of the second of two motions
    }


def _unknown(
    model_errors: Mapping[str, float | None], parts: Mapping[str, Any]
) -> dict[str, list[str]]:
    """Parts of the uncertainty that are not known: those of ``ALL`` numbers, and of the amplitude.

    ``parts``: relative changes by second run; None where this has no result.
    """
    failed = {name for name, changes in parts.items() if None in changes.values()}
    is_unknown = {
        "twin": "twin" in failed,
        "model": model_errors["basis"] is None or "model" in failed,
        "mesh": model_errors["mesh"] is None or "mesh" in failed,
        "fineness": bool((parts and not FINER & {*parts}) or failed & {*FINER, "patches"}),
    }
    return {
        ALL: [name for name, is_missing in is_unknown.items() if is_missing],
        "amplitude": ["speeds"] if "speeds" in failed else [],
    }


def _speed_error(results: Mapping[str, Any], peak: "Peak") -> float | None:
    """Uncertainty of a critical speed, rpm: spacing of the sweep, error of the frequencies."""
    if peak.k is None or peak.spacing is None or peak.at_end:
        return None
    off = peak.spacing + _model_error(results) * peak.Omega_c
    return RPM_PER_HZ * results["f1_Hz"] * off


def _model_error(results: Mapping[str, Any]) -> float:
    """Relative error of the frequencies, as far as it is known."""
    return (results["model_error"]["basis"] or 0.0) + (results["model_error"]["mesh"] or 0.0)


def table(summary: Mapping[str, Any]) -> str:
    """Markdown: a table for each scene, unknown parts, and the meaning of the numbers."""
    parts = ["# Summary", ""]
    for scene in summary["scenes"]:
        parts += [f"## {scene['scene']}", "", about(scene), ""]
        tables = [*shown(scene), (margins.HEADS, margins.table(scene["margins"]))]
        parts += [line for cells in tables if cells[1] for line in (markdown.table(*cells), "")]
        parts += [*notes(scene), ""]
    return "\n".join([*parts, *left_out(summary), meaning()]) + "\n"


def left_out(summary: Mapping[str, Any]) -> list[str]:
    """A line on scenes that have results and are not in the summary, if there are any."""
    return [
        f"Not in this summary, but with results: {', '.join(summary['others'])}. The summary holds "
        "the scenes of `scenes`.\n"
    ] * bool(summary["others"])


def meaning() -> str:
    """Meaning of the columns and of the words in the rows, as a list."""
    of_numbers = (one.legend for one in of_peaks().values() if one.legend)
    return "\n".join(f"- {name}: {text}." for name, text in [*of_numbers, *WORDS.items()])


def known_columns(peaks: Iterable[Mapping[str, float]]) -> list[Column]:
    """Columns of the numbers that any of the peaks has."""
    names = set().union(*peaks)
    return [column for column in all_columns() if column.name in names]


def all_columns() -> list[Column]:
    """Columns of all numbers of peaks."""
    return [Column(name, *one.shown, one.head) for name, one in of_peaks().items() if one.head]


def terminal(summary: Mapping[str, Any]) -> str:
    """The same for a terminal, in columns."""
    parts = []
    for scene in summary["scenes"]:
        tables = [cells for cells in shown(scene) if cells[1]]
        lines = [line for cells in tables for line in (*columns(*cells), "")]
        parts += ["", f"{scene['scene']}: {about(scene)}", *lines, *notes(scene)]
    return "\n".join([*parts, *left_out(summary)])


def panel(
    answers: Mapping[str, Any], campbell: Mapping[str, Any], stress: Mapping[str, Any] | None
) -> dict[str, Any]:
    """The same of one scene's ``answers`` for its page, with the speeds of the rows over f1(0).

    ``campbell``: as of ``simulate.sweeps.crossings.critical``; ``stress``: as of ``stress.json``.
    """
    scene = _scene(answers, stress, campbell)
    tables = [*shown(scene), (margins.HEADS, margins.table(scene["margins"]))]
    return {
        "about": about(scene),
        "tables": [{"heads": heads, "rows": rows} for heads, rows in tables],
        "notes": notes(scene),
        "speeds": [row["over_f1"] for row in scene["rows"]],
        "meaning": meaning(),
    }


def columns(heads: Sequence[str], rows: Iterable[Sequence[str]]) -> list[str]:
    """Lines of aligned cells, the first column to the left, all others to the right.

    Heads that are longer than the cells below them have several lines.
    """
    body = [*map(list, rows)]
    wrapped = [
        wrap(head, max(map(len, ["-", *head.split(), *cells])))
        for head, *cells in zip(heads, *body, strict=True)
    ]
    above = zip_longest(*(head[::-1] for head in wrapped), fillvalue="")  # from the lowest line
    table = [*map(list, above)][::-1] + body
    widths = [max(map(len, cells)) for cells in zip(*table, strict=True)]
    return [
        "  ".join(
            cell.ljust(width) if column in (0, len(cells) - 1) else cell.rjust(width)
            for column, (cell, width) in enumerate(zip(cells, widths, strict=True))
        ).rstrip()
        for cells in table
    ]


def shown(scene: Mapping[str, Any]) -> list[tuple[list[str], list[list[str]]]]:
    """Heads and rows of a scene's tables: motion and wear, loads, blades of a stage.

    Without empty columns.
    """
    kept, rows = known_columns(row["values"] for row in scene["rows"]), scene["rows"]
    known = of_peaks()
    motion, loads = (
        [column for column in kept if known[column.name].loads is among] for among in (False, True)
    )
    moving = (row["course"] for row in rows if row["course"].get("trend") != STEADY)
    most = max((ceil(course.get("rounds", 0)) for course in moving), default=0)
    # the revolutions after which numbers are told that change further
    after = f" after {most} revolutions" * (most > 0)
    heads = {column: column.head + after * known[column.name].goes_on for column in kept}
    return [
        (
            ["EO", "mode", "rpm", *(heads[column] for column in motion), *AT_END, ""],
            [
                [
                    *_names(row),
                    margins.speed(row),
                    *(_cell(row, column) for column in motion),
                    *_end_of_run(row),
                    row["word"],
                ]
                for row in rows
            ],
        ),
        (
            ["EO", "mode", "Ω / f₁(0)", "Hz", *(heads[column] for column in loads)],
            [
                [
                    *_names(row),
                    f"{row['over_f1']:.3f}",
                    f"{row['hz']:.1f}" if row["hz"] else "-",
                    *(_cell(row, column) for column in loads),
                ]
                for row in rows
            ],
        ),
        (
            stage_told.HEADS,
            [
                [
                    *(at if i == 0 else [""] * len(at)),
                    column.head,
                    *_spread(row["blades"], column, spread),
                ]
                for row in rows
                for at in [[*_names(row), margins.speed(row)]]
                for i, (column, spread) in enumerate(_over_blades(row))
            ],
        ),
    ]


def _over_blades(row: PeakRow) -> list[tuple[Column, Spread]]:
    """Each number that is told of the blades of a stage, and its spread; none of one blade."""
    numbers = row["blades"]["numbers"] if row["blades"] else {}
    return [
        (column, Spread.of(numbers[column.name]))
        for column in all_columns()
        if column.name in numbers
    ]


def _spread(of: OfBlades, column: Column, spread: Spread) -> list[str]:
    """Its cells: of the worst blade, the most, the median, the least; in brackets the blades."""
    blades = (of["worst"], spread.of_most, None, spread.of_least)
    values = (of["numbers"][column.name][of["worst"]], spread.most, spread.median, spread.least)
    return [
        column.number(value).shown + ("" if blade is None else f" ({blade})")
        for value, blade in zip(values, blades, strict=True)
    ]


def _names(row: PeakRow) -> list[str]:
    """Engine order and mode; of a line on no order f / Omega, known to half a bin."""
    k, modes = row["k"], numbers_of(row["modes"]) or "-"
    off = "" if not k or k % 1 == 0 else f" ±{row['k_error']:.2g} (f/Ω)"
    return [f"{k:.3g}{off}" if k else "-", modes]


def _cell(row: PeakRow, column: Column) -> str:
    """The number, that of another motion, its uncertainty in percent, and whether it goes on."""
    value, error, other = (row[kind].get(column.name) for kind in ("values", "errors", "other"))
    if value is None:
        return "-"
    in_part = [*row["unknown"][ALL], *row["unknown"].get(column.name, [])]
    number = column.number(value, error, least=bool(in_part))
    further = "" if other is None else f" or {column.number(other, error).shown}"
    if of_peaks()[column.name].exact:
        return number.shown
    bound = stress_told.bound(column.name, row["course"].get("trend"))
    rises = f" {stress_told.RISES}" * bool(row["rises"] and column.name == "alternating")
    goes_on = f", {row['course'].get('trend')}" if column.name == "amplitude" and moves(row) else ""
    where = PLACES.get(row["place"], "") * (column.name == "amplitude")
    revolution = row["course"].get("largest_round") if column.name == "displacement" else None
    revolution_text = f" (rev. {revolution:.0f})" if revolution else ""
    text = f"{bound}{number.shown}{further} {number.share}{goes_on}".rstrip()
    return text + rises + revolution_text + where


def moves(row: PeakRow) -> bool:
    """Whether the motion still grows or dies out at the end of the run."""
    return row["course"].get("trend") in (GROWING, DYING_OUT)


def _end_of_run(row: PeakRow) -> list[str]:
    """Whether the motion is steady, its time constant, and the wear still going on."""
    course = row["course"]
    numbers = course.get("time_constant"), (wears := course.get("wears")) and 1e9 * wears
    texts = [
        markdown.cell(number) if number is None or isfinite(number) else "-" for number in numbers
    ]
    at = course.get("trend") == STEADY and course.get("rounds")
    after = f" (after {at:.0f} rev.)" if at else ""
    return [stress_told.growing(course) + after, *texts]


def about(scene: Mapping[str, Any]) -> str:
    """Blade, frequency, gap, reduced model and how the runs ended, in one line."""
    ends = ", ".join(f"{count} {name}" for name, count in scene["status"].items())
    why = "".join(f"; no contact: {reason}" for reason in scene["reasons"])
    off = scene["model_error"]["basis"]
    within = "" if off is None else f" (frequencies within {markdown.percent(off)} of the full one)"
    blades = (
        f"{scene['blades']} blades: motion, stress and force of the worst, wear and torque of all; "
        if scene["blades"] > 1
        else ""
    )
    return (
        f"{blades}blade {scene['blade']}, f₁(0) = {scene['f1_Hz']:.2f} Hz, "
        f"gap {1e6 * scene['gap_m']:.3g} µm; reduced model: {scene['dofs']} DoFs{within}; "
        f"runs: {ends}{why}"
    )


def notes(scene: Mapping[str, Any]) -> list[str]:
    """Crossings, ends of the sweep, operating lines, unknown parts, cost of uncertainties."""
    campbell = scene["operating"]
    lines = [*_without_peaks(scene), *_blades(scene), *crossings_and_ends(scene)]
    lines += [f"{sentence}." for sentence in scene["assumed"]]
    lines += margins.fed(scene["whirls"])
    for name in campbell["lines"]:
        lines += margins.nearest(campbell, scene["margins"], name)
    lines.append(margins.covered(campbell))
    if scene["stress"]:
        rows = {row["over_f1"]: row for row in [*scene["worst"], *scene["rows"]]}
        lines += stress_told.worst(scene["stress"], rows.get(scene["stress"]["worst"]))
    numbers = {name for row in scene["rows"] for name in row["values"]}
    missing = {part for row in scene["rows"] for parts in row["unknown"].values() for part in parts}
    unknown = [PARTS[part] for part in PARTS if part in missing]
    without = [f"{row['rpm']:.0f}" for row in scene["rows"] if "alternating" not in row["values"]]
    if without:
        unknown.append(f"stress at {', '.join(without)} rpm, whose motion is not recorded")
    if "force" in numbers and scene["no_torque"]:
        unknown.append(f"torque ({scene['no_torque']})")
    if unknown:
        lines.append(f"Not known: {', '.join(unknown)}.")
    if scene["mu_crit"]:
        lines.append(f"The tip locks at a friction coefficient of {scene['mu_crit']:.3f} or more.")
    return [
        *lines,
        f"Error of the step: {scene['checks']}.",
        f"Uncertainties: {scene['runs']} runs, {scene['answers_s']:.1f} s of CPU time; the sweep: "
        f"{scene['sweep_s']:.0f} s.",
    ]


def _without_peaks(scene: Mapping[str, Any]) -> list[str]:
    """Where peaks were looked for, if there is none; free vibrations that are none."""
    swept = (RPM_PER_HZ * scene["f1_Hz"] * speed for speed in scene["swept"])
    speeds, free = sum(scene["status"].values()), scene["free"]
    if not scene["rows"]:
        return ["Rub peaks: none, as nothing moves the blade: it is at rest at all speeds."]
    none = speeds > 1 and not any(row["k"] for row in scene["rows"])
    return [f"Rub peaks: {margins.none_of(scene['operating'], *swept)}."] * none + [
        f"At {free} of {speeds} speeds the largest line is a free vibration of the start, which "
        "decays: it is no peak."
    ] * bool(free)


def _blades(scene: Mapping[str, Any]) -> list[str]:
    """Which blades of a stage rub at each peak, and the worst of them."""
    return [
        f"{order_name(row['k']) or 'Largest response'} at {row['rpm']:.0f} rpm: "
        f"{stage_told.worst(row['blades'])}."
        for row in scene["rows"]
        if row["blades"]
    ]


def crossings_and_ends(scene: Mapping[str, Any]) -> list[str]:
    """Linear crossings, and results at the ends of the sweep."""
    seen = {end["over_f1"]: _seen(end) for end in scene["ends"]}
    ends = "; ".join(
        f"{RPM_PER_HZ * scene['f1_Hz'] * over_f1:.0f} rpm ({over_f1:.3f}): {what}"
        for over_f1, what in seen.items()
        if what
    )
    return [*margins.met(scene["operating"]), *[f"Ends of the sweep: {ends}."] * bool(ends)]


def _seen(end: Mapping[str, Any]) -> str:
    """Lobes and gaps at an end of a sweep."""
    lobes = [] if end["lobes"] is None else [f"{end['lobes']} lobes"]
    gaps = " and ".join(f"{1e6 * gap:.1f}" for gap in end["gaps_m"])
    parts = lobes + [f"gap {gaps} µm at ξ = 1/16 and 15/16"] * bool(gaps)
    return ", ".join(parts + [end["status"]] * (end["status"] != "ok"))


def peaks(summary: Mapping[str, Any]) -> Iterator[tuple[Mapping[str, Any], PeakRow]]:
    """Each scene with each of its peaks along an engine order."""
    return ((scene, row) for scene in summary["scenes"] for row in scene["rows"] if row["k"])


def over_gap(row: PeakRow) -> list[str]:
    """Speed over f1(0) and crossing, amplitude and wear over the gap, as figures have them."""
    speeds = [f"{row[name] or nan:.3f}" for name in ("over_f1", "over_crossing")]
    return speeds + [
        "" if number is None else f"{number:.2f}" for number in row["over_gap"].values()
    ]


def csv(summary: Mapping[str, Any]) -> str:
    """One row for each peak, units in the header; cells are empty where nothing is known."""
    of_all = [(scene, row) for scene in summary["scenes"] for row in scene["rows"]]
    staged = any(row["blades"] for _, row in of_all)
    records = [_record(*of) | (_of_blades(*of) if staged else {}) for of in of_all]
    return csv_text([*records[:1], *(record.values() for record in records)])


def margins_csv(summary: Mapping[str, Any]) -> str:
    """One row for each scene, operating line and critical speed; empty cells as in ``csv``."""
    records = [
        {
            "scene": scene["scene"],
            "blade": scene["blade"],
            "mode": numbers_of(row["modes"]),
            **{
                name: _digits(value) if isinstance(value, float) else value
                for name, value in row.items()
                if name != "modes"
            },
        }
        for scene in summary["scenes"]
        for row in scene["margins"]
    ]
    return csv_text([*records[:1], *(record.values() for record in records)])


def _record(scene: Mapping[str, Any], row: PeakRow) -> dict[str, Any]:
    """Cells of a row of the CSV file by their head."""
    return {
        "scene": scene["scene"],
        "blade": scene["blade"],
        "engine order": row["k"],
        "mode": numbers_of(row["modes"]),
        "amplitude at xi": _digits(row["place"]) if row["k"] else "",
        "status": row["status"],
        "word": row["word"],
        "trend": row["course"].get("trend"),
        **{
            f"{name} ({unit})": _digits(row["course"].get(name), scale)
            for name, (unit, scale) in COURSE.items()
        },
        "not known of +-": " ".join(part for parts in row["unknown"].values() for part in parts),
        "speed (rpm)": _digits(row["rpm"]),
        "speed +- (rpm)": _digits(row["rpm_error"]),
        "speed over f1(0)": _digits(row["over_f1"]),
        "frequency (Hz)": _digits(row["hz"]),
        "speed over crossing": _digits(row["over_crossing"]),
        "at end of sweep": int(row["bound"]),
        "lobes": row["lobes"],
        "stress rises towards": row["rises"],
        **{
            f"{column.name}{what} ({column.unit})": _digits(row[key].get(column.name), column.scale)
            for column in all_columns()
            for what, key in (("", "values"), (" +-", "errors"), (" other", "other"))
        },
    }


def _of_blades(scene: Mapping[str, Any], row: PeakRow) -> dict[str, Any]:
    """Cells of a row on the blades; their number alone where no run told more of them."""
    of, spreads = row["blades"], {column.name: spread for column, spread in _over_blades(row)}
    worst = of and of["worst"]
    return {
        "blades": scene["blades"],
        "blades that rub": " ".join(map(str, of["rub"])) if of else "",
        "worst blade": worst,
        "worst blade longer (um)": _digits(of and of["longer"][worst], 1e6),
        "worst blade frequencies (%)": _digits(of and of["frequencies"][worst], 1e2),
        **{
            f"{column.name} {what}{unit}": _digits(
                getattr(spreads.get(column.name), key, None), scale
            )
            for column in all_columns()
            if of_peaks()[column.name].by_blade
            for what, key, unit, scale in (
                *((f"{end} of blades", end, f" ({column.unit})", column.scale) for end in ENDS),
                *((f"{end} blade", f"of_{end}", "", 1.0) for end in ENDS[::2]),
            )
        },
    }


def _digits(value: float | None, scale: float = 1.0) -> str:
    return "" if value is None or not isfinite(value) else f"{value * scale:.6g}"


def last_words(folder: str | Path) -> str:
    """The summary of a run for the terminal, and where its results are."""
    summary = read_json(Path(folder, "summary.json"))
    pages = sorted(str(path) for path in Path(folder).glob("*/*/explore.html"))
    where = [
        f"Summary: {folder}/summary.md, {folder}/summary.csv, {folder}/margins.csv.",
        f"Figures: {folder}/figures/.",
        *([f"To explore: {', '.join(pages)}."] if pages else []),
        f"Logs: {folder}/<blade>/logs/, {folder}/<blade>/<scene>/logs/.",
    ]
    return "\n".join(map(printable, [*terminal(summary).split("\n"), "", *where]))
