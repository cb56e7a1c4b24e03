"""Values shown in the figures: ``summary.json``, and the same as Markdown."""

from collections import Counter
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from rom.check import RomCheck
from rom.model import Rom
from simulate.errors.neighbours import GAP_CHANGE
from simulate.errors.signals import lobes, worn
from simulate.marching import SENSITIVE_FROM
from simulate.sweeps.peak import Peak, crossing
from workflow import markdown
from workflow.figures.response import Response
from workflow.paper.printed import shifts_of

CROSSED = (4, 5, 6)
ALWAYS = (4, 6)  # engine orders whose peak is reported for every scene, clear or not
HEAD = (
    "scene",
    "k",
    "Ω_c / f₁(0)",
    "Ω_c / crossing",
    "‖Y‖ / gap",
    "worn depth / gap",
    "lobes",
    "response",
)
SENSITIVE = (
    f"Sensitive, not predictable: a relative change of all gaps by {GAP_CHANGE:g} changes the "
    f"output named by over {100 * SENSITIVE_FROM:g} %."
)


def numbers(files: Any, scenes: Iterable[str]) -> dict[str, Any]:
    """The summary from ``files.rom``, ``files.check`` and ``files.sweeps``, one for each scene.

    A reduced model from elsewhere has no check.
    """
    rom, of_check = Rom.load(files.rom), getattr(files, "check", None)
    check = RomCheck.load(of_check) if of_check else None
    responses = [Response.read(sweep, files.rom) for sweep in files.sweeps]
    return summarise(rom, check, dict(zip(scenes, responses, strict=True)))


def summarise(
    rom: Rom, check: RomCheck | None, responses: Mapping[str, Response]
) -> dict[str, Any]:
    """Speeds over f1(0) (rev/s over Hz), amplitudes and depths over the gap g."""
    of_check = _error(rom, check) if check else {}
    return {
        "reduced_model": {"f1_Hz": round(rom.f1, 2), "dofs": rom.n} | of_check,
        "crossings": {str(k): _rounded(crossing(rom, k)) for k in CROSSED},
        "scenes": {name: _scene(response) for name, response in responses.items()},
    }


def _error(rom: Rom, check: RomCheck) -> dict[str, Any]:
    """Largest frequency error of the reduced model against the full one."""
    speed, mode = check.worst
    speeds, modes = check.error.shape
    return {
        "largest_error": round(float(check.error[speed, mode]), 6),
        "largest_error_mode": mode + 1,
        "largest_error_speed": _rounded(check.speeds[speed] / rom.omega1),
        "modes": modes,
        "speeds": speeds,
    }


def table(summary: Mapping[str, Any]) -> str:
    """Render the summary: one list, then one table with a row for each peak."""
    model, crossings = summary["reduced_model"], summary["crossings"]
    scenes = summary["scenes"].items()
    rows = [_row(name, peak) for name, scene in scenes for peak in scene["peaks"]]
    lines = [
        f"f1(0) = {model['f1_Hz']} Hz. Reduced model: {model['dofs']} DoFs, {_told(model)}.",
        "",
        "Linear crossings of f1: " + ", ".join(f"k = {k}: {at}" for k, at in crossings.items()),
        "",
        markdown.table(HEAD, rows),
        "",
        *(_away(name, scene) for name, scene in scenes),
    ]
    if any("sensitive" in scene["status"] for scene in summary["scenes"].values()):
        lines += ["", SENSITIVE]
    lines += against_paper(summary["scenes"])
    return "\n".join(lines) + "\n"


def _told(model: Mapping[str, Any]) -> str:
    """The error of the reduced model, in words."""
    if "largest_error" not in model:
        return "from elsewhere, its error is not known"
    return (
        f"largest error {100 * model['largest_error']:+.2g} % (mode {model['largest_error_mode']} "
        f"at {model['largest_error_speed']:.2f}; modes 1 to {model['modes']}, {model['speeds']} "
        f"speeds)"
    )


def against_paper(scenes: Mapping[str, Any]) -> list[str]:
    """Table of the paper's values for its two coatings and of ours, where both were run."""
    if not {"paper-e1", "paper-e10"} <= set(scenes):
        return []
    e1, e10 = (
        {peak["k"]: peak for peak in scenes[name]["peaks"]} for name in ("paper-e1", "paper-e10")
    )
    rows = [
        ("Ω_c / crossing, E = 1, k = 4 and 6", shifts_of("e1"), _shifts(e1)),
        ("Ω_c / crossing, E = 10, k = 4 and 6", shifts_of("e10"), _shifts(e10)),
        ("‖Y‖ at k = 4, E = 10 over E = 1", "> 1", _ratio(e10, e1, "amplitude")),
        ("deepest wear at k = 4, E = 10 over E = 1", "> 1", _ratio(e10, e1, "deepest_wear")),
    ]
    return ["", markdown.table(["", "paper", "here"], rows)]


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
    """Peaks that the figures mark and those of ``ALWAYS``; first and last run with a result.

    At these two speeds, away from resonance, the paper finds the lobes of the casing.
    """
    asked = [peak for k, peak in response.by_order.items() if peak.reported or k in ALWAYS]
    ends = np.flatnonzero(response.has_result)[[0, -1]] if response.has_result.any() else []
    return (
        _gaps(response)
        | _friction(response.sweep)
        | {
            "status": dict(Counter(map(str, response.status))),
            "reasons": sorted({*map(str, response.reason)} - {""}),
            "peaks": [_peak(peak) | _at(response, peak.index) for peak in asked],
            "away": [{"speed": _rounded(response.speeds[i])} | _at(response, i) for i in ends],
        }
    )


def _gaps(response: Response) -> dict[str, Any]:
    """Gaps at the first and last speed, um, of a scene that gives them at rest; else none."""
    if response.gaps is None:
        return {}
    ends = zip(response.speeds[[0, -1]], 1e6 * response.gaps[[0, -1]], strict=True)
    return {"gap_um": [{"speed": _rounded(at), "gap": np.round(of, 2).tolist()} for at, of in ends]}


def _friction(sweep: Any) -> dict[str, float | None]:
    """Least friction at which strips lock, and least sliding speed; without friction none."""
    names = [name for name in ("mu_crit", "least_sliding") if name in sweep]
    return {name: _rounded(sweep[name].values.min()) for name in names}


def _peak(peak: Peak) -> dict[str, Any]:
    seen, of = "peak" if peak.reported else "no clear peak", peak.plain()
    return {
        "k": peak.k,
        **{name: _rounded(of[name]) for name in ("Omega_c", "over_crossing", "amplitude")},
        "seen": "sweep ends on the rise" if peak.at_end else seen,
    }


def _at(response: Response, index: int) -> dict[str, Any]:
    """Wear at a speed, and the names of the observables that cannot be predicted there, if any."""
    wear: dict[str, Any] = {}
    if "wear" in response.sweep:
        profile = worn(response.wear[index])
        wear = {"lobes": profile.lobes, "deepest_wear": _rounded(profile.deepest)}
        if found := lobes(response.wear[index]):
            wear["lobe_width_deg"] = [round(float(np.degrees(lobe.width)), 1) for lobe in found]
            wear["lobe_height"] = [_rounded(lobe.height) for lobe in found]
    names = [name for name in response.observables if response.sensitive(name)[index]]
    return wear | ({"not_predictable": names} if names else {})


def _rounded(value: float) -> float | None:
    """Four digits after the point; None for nan, which JSON does not have."""
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
    """Note on a sensitive peak or speed: the observables that cannot be predicted."""
    names = entry.get("not_predictable")
    return [f"not predictable: {', '.join(names)}"] if names else []


def _away(name: str, scene: Mapping[str, Any]) -> str:
    status = ", ".join(f"{count} {word}" for word, count in scene["status"].items())
    counts = [
        " ".join(
            [f"{end['lobes']} at {end['speed']:.3f}", *map("({})".format, _unpredictable(end))]
        )
        for end in scene["away"]
        if "lobes" in end
    ]
    why = "".join(f"; no contact: {reason}" for reason in scene.get("reasons", []))
    away = f"; lobes away from resonance: {', '.join(counts)}" if counts else ""
    gaps = [
        f"{' and '.join(f'{gap:.1f}' for gap in at['gap'])} at {at['speed']:.3f}"
        for at in scene.get("gap_um", [])
    ]
    at_rest = f"; gap at ξ = 1/16 and 15/16 (µm): {', '.join(gaps)}" if gaps else ""
    locks = f"; locks from friction {scene['mu_crit']}" if scene.get("mu_crit") else ""
    return f"- {name}: speeds {status}{why}{away}{at_rest}{locks}."
