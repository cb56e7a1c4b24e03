"""What the figures say, in numbers: ``summary.json`` and the same as Markdown."""

from collections import Counter
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from geometry.files import whole, write_json
from simulate.observables import worn
from simulate.peaks import Peak
from simulate.twin import GAP_CHANGE, SENSITIVE_FROM
from workflow.figures import fig03_campbell
from workflow.figures.fig03_campbell import Campbell
from workflow.figures.response import Response, read_response
from workflow.markdown import table

CROSSINGS = (4, 5, 6)
ALWAYS = (4, 6)  # engine orders whose peak is reported of every scene, clear or not
HEAD = "scene", "k", "Ω_c / f₁(0)", "Ω_c / crossing", "‖Y‖ / gap", "worn / gap", "lobes", "seen"
SENSITIVE = (
    f"Sensitive, not predictable: a change of all gaps by {GAP_CHANGE:g} moves what is named by "
    f"over {100 * SENSITIVE_FROM:g} %."
)


def load(files: Any, scenes: Iterable[str]) -> tuple[Campbell, dict[str, Response]]:
    """Read ``files.rom``, ``files.check`` and ``files.sweeps``, one for each of ``scenes``."""
    (campbell,) = fig03_campbell.load(files)
    pairs = zip(scenes, files.sweeps, strict=True)
    return campbell, {scene: read_response(sweep, files.rom) for scene, sweep in pairs}


def summarise(campbell: Campbell, responses: Mapping[str, Response]) -> dict[str, Any]:
    """Speeds over f1(0) (rev/s over Hz), amplitudes and depths over the gap g."""
    speed, mode = campbell.worst
    return {
        "reduced_model": {
            "f1_Hz": round(campbell.f1, 2),
            "dofs": campbell.n,
            "largest_error": round(float(campbell.error[speed, mode]), 6),
            "largest_error_mode": mode + 1,
            "largest_error_speed": round(float(campbell.check_speeds[speed]), 4),
            "modes": campbell.error.shape[1],
            "speeds": len(campbell.check_speeds),
        },
        "crossings": {str(k): _rounded(campbell.crossings[k]) for k in CROSSINGS},
        "scenes": {name: _scene(response) for name, response in responses.items()},
    }


def write(summary: Mapping[str, Any], json_path: str | Path, markdown_path: str | Path) -> None:
    """Write the summary as JSON and as Markdown."""
    write_json(summary, json_path)
    with whole(markdown_path) as temporary:
        temporary.write_text(markdown(summary))


def markdown(summary: Mapping[str, Any]) -> str:
    """Render the summary: one list, then one table with a row for each peak."""
    model, crossings = summary["reduced_model"], summary["crossings"]
    scenes = summary["scenes"].items()
    rows = [_row(name, peak) for name, scene in scenes for peak in scene["peaks"]]
    lines = [
        f"f1(0) = {model['f1_Hz']} Hz. Reduced model: {model['dofs']} DoFs, largest error "
        f"{100 * model['largest_error']:+.2g} % (mode {model['largest_error_mode']} at "
        f"{model['largest_error_speed']:.2f}; modes 1 to {model['modes']}, "
        f"{model['speeds']} speeds).",
        "",
        "Linear crossings of f1: " + ", ".join(f"k = {k}: {at}" for k, at in crossings.items()),
        "",
        table(HEAD, rows),
        "",
        *(_away(name, scene) for name, scene in scenes),
    ]
    if any("sensitive" in scene["status"] for scene in summary["scenes"].values()):
        lines += ["", SENSITIVE]
    lines += against_paper(summary["scenes"])
    return "\n".join(lines) + "\n"


def against_paper(scenes: Mapping[str, Any]) -> list[str]:
    """Table of the paper's statements on its two coatings beside ours, where both were run."""
    if not {"paper-e1", "paper-e10"} <= set(scenes):
        return []
    e1, e10 = (
        {peak["k"]: peak for peak in scenes[name]["peaks"]} for name in ("paper-e1", "paper-e10")
    )
    rows = [
        ("Ω_c / crossing, E = 1, k = 4 and 6 (calibrated)", "1.129, 1.059", _shifts(e1)),
        ("Ω_c / crossing, E = 10, k = 4 and 6", "1.226, 1.176", _shifts(e10)),
        ("‖Y‖ at k = 4, E = 10 over E = 1", "> 1", _ratio(e10, e1, "amplitude")),
        ("deepest wear at k = 4, E = 10 over E = 1", "> 1", _ratio(e10, e1, "deepest_wear")),
    ]
    return ["", table(["", "paper", "here"], rows)]


def _shifts(peaks: Mapping[int, Any]) -> str:
    return ", ".join(
        f"{peaks[k]['over_crossing']:.3f}{_doubt(peaks[k])}" for k in ALWAYS if k in peaks
    )


def _ratio(peaks: Mapping[int, Any], base: Mapping[int, Any], key: str) -> str:
    both = 4 in peaks and 4 in base and key in peaks[4] and key in base[4]
    if not both:
        return ""
    return f"{peaks[4][key] / base[4][key]:.2f}{_doubt(peaks[4]) or _doubt(base[4])}"


def _doubt(peak: Mapping[str, Any]) -> str:
    return " (not predictable)" if "not_predictable" in peak else ""


def _scene(response: Response) -> dict[str, Any]:
    return {
        "status": dict(Counter(str(word) for word in response.status)),
        "peaks": [_peak(response, peak) for peak in _reported(response)],
        "away": _ends(response),
    }


def _reported(response: Response) -> list[Peak]:
    """Peaks in ascending k: those the figures mark and those always asked for."""
    return [peak for k, peak in response.by_order.items() if peak.told or k in ALWAYS]


def _peak(response: Response, peak: Peak) -> dict[str, Any]:
    seen = "peak" if peak.told else "no clear peak"
    return {
        "k": peak.k,
        "Omega_c": _rounded(peak.Omega_c),
        "over_crossing": _rounded(peak.over_crossing),
        "amplitude": _rounded(peak.amplitude),
        "seen": "sweep ends on the rise" if peak.at_end else seen,
        **_worn(response, peak.index),
        **_sensitive(response, peak.index),
    }


def _ends(response: Response) -> list[dict[str, Any]]:
    """First and last speed with a result: the paper finds the casing's own lobes there."""
    runs = np.flatnonzero(response.has_result)
    ends = runs[[0, -1]] if runs.size else []
    return [
        {
            "speed": _rounded(response.speeds[i]),
            **_worn(response, i),
            **_sensitive(response, i),
        }
        for i in ends
    ]


def _worn(response: Response, index: int) -> dict[str, Any]:
    if response.wear is None:
        return {}
    of = worn(response.wear[index])
    return {"lobes": of.lobes, "deepest_wear": _rounded(of.deepest)}


def _sensitive(response: Response, index: int) -> dict[str, list[str]]:
    """Name what cannot be predicted at this speed; nothing where all can."""
    names = response.sensitive_at(index)
    return {"not_predictable": names} if names else {}


def _rounded(value: float) -> float | None:
    """Four digits after the point; None for nan, which JSON does not know."""
    return round(float(value), 4) if np.isfinite(value) else None


def _row(name: str, peak: Mapping[str, Any]) -> list[Any]:
    return [
        name,
        peak["k"],
        f"{peak['Omega_c']:.3f}",
        f"{peak['over_crossing']:.3f}",
        f"{peak['amplitude']:.2f}",
        f"{peak['deepest_wear']:.2f}" if "deepest_wear" in peak else "",
        peak.get("lobes", ""),
        "; ".join([peak["seen"], *_unpredictable(peak)]),
    ]


def _unpredictable(entry: Mapping[str, Any]) -> list[str]:
    """Mark of a peak or a speed that is sensitive."""
    names = entry.get("not_predictable")
    return [f"not predictable: {', '.join(names)}"] if names else []


def _away(name: str, scene: Mapping[str, Any]) -> str:
    status = ", ".join(f"{count} {word}" for word, count in scene["status"].items())
    lobes = [
        " ".join(
            [f"{end['lobes']} at {end['speed']:.3f}", *(f"({m})" for m in _unpredictable(end))]
        )
        for end in scene["away"]
        if "lobes" in end
    ]
    away = f"; lobes away from resonance: {', '.join(lobes)}" if lobes else ""
    return f"- {name}: speeds {status}{away}."
