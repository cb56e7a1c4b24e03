"""The paper's claims, one function each: our values and statements that are compared with it.

Numbers are those of ``workflow.paper.measure``. The paper gives speeds to 0.01: a value agrees if
it rounds to the paper's.
"""

from math import degrees, log2, nan
from typing import Any

from simulate.signals import LOBE_BLUR
from workflow.paper.published import (
    CONSISTENT,
    CRITICAL,
    CROSSING,
    FORCE_RATIO,
    HALF_DIGIT,
    SHIFTS,
    E,
    K,
    shifts_of,
)
from workflow.paper.verdict import Claim, Finding, Numbers, Statement, Value, equal, less, more

INSIGNIFICANT = 0.05  # relative difference of two curves that look equal in print
# Of speeds next to a peak, over f1(0): peaks.within_over_f1 of paper-e1 and paper-e10. At draws,
# where only statements of claims are judged, it is coarser.
SPACING = 2e-4
SPACING_OF_TILTED = 1e-4  # of the scenes with a tilted tip
HARDLY = 0.5  # relative change of a computing time that still counts as independence
LIKE = 0.1  # relative difference up to which two amplitudes count as equal
COATING = {"e1": "E = 1", "e10": "E = 10"}
FALLEN = 0.5  # of its amplitude: a response below has left its peak
MINOR = 0.05, 0.5  # amplitude of a slight resonance: least, gaps; largest, over that of EO 4


def _peak(numbers: Numbers, part: str, k: int) -> dict[str, Any]:
    return numbers[part]["peaks"][str(k)]


def _rounded(name: str, ours: float, paper: float, **more: Any) -> Value:
    """A number that agrees if it rounds to the paper's two digits."""
    return Value(name, ours, paper - HALF_DIGIT, paper + HALF_DIGIT, **more)


def size(numbers: Numbers) -> Finding:
    """C01: the tolerance of the reduction is set for the paper's n.

    That n is at most 90 is no result: 8 nodes in 3 directions and 6 modes, at 3 speeds.
    """
    n = numbers["model"]["n"]
    return Finding(
        (Value("n", n, 84, 86, calibrated=True),),
        (less("n, at most 90", n, 90.5, calibrated=True),),
    )


def frequencies_of_rom(numbers: Numbers) -> Finding:
    """C02: the paper's basis exactly; the error of our own is shown as well."""
    model = numbers["model"]
    return Finding(
        (Value("error of the paper's basis, %", 100 * model["error"], 0, 1),),
        shown={"of ours": 100 * model["error_default"], "speeds": model["speeds"]},
        because="Its six fixed-interface modes at each speed are too few on this blade; with nine "
        "the error is below 1 % (workflow/study/kept/bases.csv).",
    )


def quadratic_term(numbers: Numbers) -> Finding:
    """C03."""
    return Finding(
        statements=(
            less("miss with 4/3", numbers["model"]["K2"]["4/3"], 1e-6),
            more("miss as printed, 3/4", numbers["model"]["K2"]["printed"], 1e-2),
        )
    )


def laws(numbers: Numbers) -> Finding:
    """C04: slopes over EK/(E + K) and over E."""
    off = max(abs(slope - 1) for slope in numbers["laws"].values())
    return Finding((Value("farthest of six slopes from its closed form", off, 0, 1e-6),))


def wear_by_density(numbers: Numbers) -> Finding:
    """C05."""
    on_peak, off = numbers["densities"]["wear"]
    return Finding(
        (
            Value("change of profile on the peak", on_peak, 0, INSIGNIFICANT),
            Value("off it", off, 0, INSIGNIFICANT),
        )
    )


def displacement_by_density(numbers: Numbers) -> Finding:
    """C06."""
    return Finding(
        (Value("change of u_r", numbers["densities"]["displacement"], 0, INSIGNIFICANT),)
    )


def displacement_by_step(numbers: Numbers) -> Finding:
    """C07."""
    first, last = numbers["steps"]["changes"]
    return Finding(
        (Value("change with the last halving", last, 0, INSIGNIFICANT),),
        (more("first over last change", first / last, 1),),
        {"observed order": log2(first / last)},
    )


def time_by_density(numbers: Numbers) -> Finding:
    """C08: reproduced in kind if the time grows by less than the square root of the density."""
    ratio = numbers["density_cost"]["ratio"]
    return Finding(
        (Value("time, 16 nu over nu", ratio, 1 - HARDLY, 1 + HARDLY),),
        (less("below sqrt(16)", ratio, 4),),
        because="Our steps without contact are so cheap that the cost of the rods under the tip "
        "matters.",
    )


def modes(numbers: Numbers) -> Finding:
    """C09: the paper gives pictures, no numbers."""
    return Finding(shown={f"f{i}/f1": numbers["model"]["frequencies"][i - 1] for i in (2, 3, 4, 5)})


def crossings(numbers: Numbers) -> Finding:
    """C10: the paper's 0.17 and 0.31 contradict each other under f1^2 = 1 + B Omega^2."""
    k4, k6 = (numbers["model"]["crossings"][k] for k in ("4", "6"))
    return Finding(
        (
            _rounded("crossing of k = 4", k4, CROSSING[4], calibrated=True),
            _rounded("crossing of k = 6", k6, CROSSING[6]),
        ),
        (
            less(
                "k = 6 off what k = 4 gives with f1^2 = 1 + B Omega^2",
                abs(k6 / (36 - 16 + k4**-2) ** -0.5 - 1),
                0.01,
            ),
        ),
    )


def shifts(numbers: Numbers) -> Finding:
    """C11: the data of the identification (workflow/paper.md)."""
    ours = {(part, k): _peak(numbers, part, int(k))["over_crossing"] for part, k in SHIFTS}
    resolution = {str(k): SPACING / crossing for k, crossing in CONSISTENT.items()}
    values = [
        Value(
            f"{COATING[part]}, k = {k}",
            ours[part, k],
            paper - digit,
            paper + digit,
            calibrated=True,
            resolution=resolution[k],
        )
        for (part, k), (paper, digit) in SHIFTS.items()
    ]
    statements = [
        more("least shift", min(ours.values()), 1, max(resolution.values()), calibrated=True),
        *(
            more(
                f"E = 10 over E = 1, k = {k}",
                ours["e10", k] / ours["e1", k],
                1,
                2 * resolution[k],
                calibrated=True,
            )
            for k in ("4", "6")
        ),
    ]
    return Finding(
        tuple(values),
        tuple(statements),
        {
            f"the paper's, {name}, k = 6, over {CONSISTENT[6]}": CRITICAL[part][6] / CONSISTENT[6]
            for part, name in COATING.items()
        },
    )


def higher_peak(numbers: Numbers) -> Finding:
    """C12: a datum of the identification."""
    soft, stiff = (_peak(numbers, part, 4) for part in ("e1", "e10"))
    name = "‖Y‖ at k = 4, E = 10 over E = 1"
    return Finding(
        statements=(more(name, stiff["amplitude"] / soft["amplitude"], 1, calibrated=True),),
        shown={"largest u_r there": stiff["largest"] / soft["largest"]},
    )


def odd_resonance(numbers: Numbers) -> Finding:
    """C13: a prominent maximum along EO 5."""
    odd, main = _peak(numbers, "e10", 5), _peak(numbers, "e10", 4)
    return Finding(
        (_rounded("Omega_c of k = 5", odd["Omega_c"], CRITICAL["e10"][5], resolution=SPACING),),
        (
            equal("stands out (1: yes)", odd["clear"], 1),
            more("‖Y‖ of k = 5 over gap", odd["amplitude"], MINOR[0]),
            less("‖Y‖ of k = 5 over k = 4", odd["amplitude"] / main["amplitude"], MINOR[1]),
        ),
    )


def superharmonics(numbers: Numbers) -> Finding:
    """C14: k worn lobes near the crossing of k; the peaks in the spectra are shown as well."""
    orders, peaks = (8, 10, 12, 14), numbers["e10"]["peaks"]
    seen = sum(k in numbers["e10"]["orders_in_wear"] for k in orders)
    return Finding(
        (Value("of k = 8, 10, 12, 14", seen, 4, 4),),
        (more("any of them", seen, 0.5),),
        {
            "as harmonic of the wear": sum(
                k in numbers["e10"]["orders_in_harmonics"] for k in orders
            ),
            "in the spectra": sum(peaks[str(k)]["clear"] for k in orders if str(k) in peaks),
        },
        "Away from k = 4 and 6 the tip wears where the casing is nearest, in marks of successive "
        "revolutions that overlap.",
    )


def lobes(numbers: Numbers) -> Finding:
    """C15."""
    statements, between = [], []
    for part, name in COATING.items():
        peaks = {k: _peak(numbers, part, k) for k in (4, 6)}
        counts = {
            **{where: (n, 2) for where, n in numbers[part]["lobes"].items()},
            **{f"at k = {k}": (peak["lobes"], k) for k, peak in peaks.items()},
        }
        statements += [equal(f"{name}, {where}", *count) for where, count in counts.items()]
        between += [peak["between_lobes"] for peak in peaks.values()]
    return Finding(
        statements=(
            *statements,
            less("wear between lobes over theirs, at most", max(between), 0.5),
        ),
        because="A tip that vibrates little wears only those of its k lobes that lie where the "
        "casing is near.",
    )


def deeper_wear(numbers: Numbers) -> Finding:
    """C16: a datum of the identification."""
    e1, e10 = (_peak(numbers, part, 4)["deepest_wear"] for part in ("e1", "e10"))
    return Finding(
        statements=(more("deepest wear, E = 10 over E = 1", e10 / e1, 1, calibrated=True),)
    )


def worst_case(numbers: Numbers) -> Finding:
    """C17: a maximum inside the table along both moduli, through the paper's worst case."""
    grid = numbers["grid"]
    worst, over = grid["worst"], grid["interior_over_ends"]
    return Finding(
        (
            Value(
                "‖Y‖ at (10, 4.55) over the worst", grid["paper_worst"] / worst["amplitude"], 1, 1
            ),
        ),
        (
            more("K = 4.55: highest between the ends of E over the higher end", over["E"], 1),
            more("E = 10: highest between the ends of K over the higher end", over["K"], 1),
        ),
        {
            "E of the worst": worst["E"],
            "K of the worst": worst["K"],
            "peaks that can be predicted, of 45": grid["predictable"],
        },
        "The maximum lies at another coating.",
    )


def corners(numbers: Numbers) -> Finding:
    """C18."""
    grid, rigid = numbers["grid"], numbers["long"]["rigid"]["amplitude"]
    soft, most = float(grid["softest"] / grid["worst"]["amplitude"]), 0.5
    stiff = float(grid["stiffest"] / rigid)
    return Finding(
        statements=(
            less(f"E = {E[0]:g}, K = {K[0]:g} over the worst, half at most", soft, most),
            Statement(
                f"E = {E[-1]:g}, K = {K[-1]:g} over the bare casing, within {100 * LIKE:g} %",
                stiff,
                LIKE - abs(stiff - 1),
            ),
        ),
        shown={"bare casing over gap": rigid},
        because="With this unit of E the smallest moduli are stiff contact. " * (soft > most)
        + "The stiffest coating still wears, and its gap grows." * (abs(stiff - 1) > LIKE),
    )


def stiffening(numbers: Numbers) -> Finding:
    """C19: rank correlation (Spearman 1904) of Omega_c with one modulus, the other constant."""
    ranks = numbers["grid"]["rank"]
    growing = {x: sum(rank > 0 for rank in ranks[x]) / len(ranks[x]) for x in ("E", "K")}
    mean = {x: sum(ranks[x]) / len(ranks[x]) for x in ("E", "K")}
    return Finding(
        tuple(
            Value(f"share of {held} at which it grows with {x}", growing[x], 1, 1)
            for x, held in (("E", "K"), ("K", "E"))
        ),
        tuple(more(f"rank correlation with {x}, mean", mean[x], 0) for x in ("E", "K")),
        {f"with E at K = {K[0]:g}": ranks["E"][0]},
        "With a small K a larger E only increases wear, the wear of a rod being about sigma/K: its "
        "peaks are low, and where they stand is hardly decided.",
    )


def imperfect_casing(numbers: Numbers) -> Finding:
    """C20: the casing is that of the medoid, on which no datum of the identification bears."""
    casing = numbers["two_five"]
    four, five, six = (casing["peaks"][k] for k in ("4", "5", "6"))
    return Finding(
        (
            _rounded(
                "Omega_c of k = 5", five["Omega_c"], CRITICAL["two_five"][5], resolution=SPACING
            ),
        ),
        (
            equal("most frequent lobes off resonance", casing["most_frequent_off_resonance"], 5),
            equal("lobes at k = 5", five["lobes"], 5),
            equal("lobes at k = 4", four["lobes"], 4),
            equal("lobes at k = 6", six["lobes"], 6),
            less("‖Y‖ of k = 4 over k = 5", four["amplitude"] / five["amplitude"], 1),
            less("‖Y‖ of k = 6 over k = 5", six["amplitude"] / five["amplitude"], 1),
            # more than the Gaussian that blurs a profile before lobes are counted
            more(
                "turn of the lobes near Omega_c of k = 5, deg",
                casing["turn_deg"],
                degrees(LOBE_BLUR),
            ),
        ),
        {"share of five lobes off resonance": casing["five_off_resonance"]},
        "Two of the five lobes of our casing close in by less than the gap: off resonance the tip "
        "rubs the other three.",
    )


def force_ratio(numbers: Numbers) -> Finding:
    """C21: the tilt of the tip is set to this ratio."""
    return Finding(
        (_rounded("mean ratio", numbers["tangential"]["ratio"], FORCE_RATIO, calibrated=True),),
        by_setting=True,
    )


def tangential_lowers(numbers: Numbers) -> Finding:
    """C22: the same tip with and without tangential force; ratios to the flat tip are shown."""
    statements, shown = [], {}
    for k in (4, 6):
        without, with_it = (_peak(numbers, part, k) for part in ("tilted", "tangential"))
        for name, key in (("‖Y‖", "amplitude"), ("Omega_c", "Omega_c")):
            ratio = with_it[key] / without[key]
            resolution = 2 * SPACING_OF_TILTED / without[key] if key == "Omega_c" else 0.0
            statements.append(less(f"{name} at k = {k}, with over without", ratio, 1, resolution))
            if "e10" in numbers:  # not with a choice changed
                flat = _peak(numbers, "e10", k)
                shown[f"{name} at k = {k}, with over the flat tip's"] = with_it[key] / flat[key]
    lean = numbers.get("model", {}).get("tangential_over_radial", nan)
    return Finding(
        statements=tuple(statements),
        shown=shown,
        because=f"In mode 1 the tip moves by u_t = {lean:.0f} u_r at 1/16 of the chord: with a "
        f"tangential force of {FORCE_RATIO:g} of the radial one the contact works "
        f"{abs(1 + FORCE_RATIO * lean):.1f} times as much on it.",
    )


def order_in_spectrogram(numbers: Numbers) -> Finding:
    """C23."""
    without, with_it = numbers["tilted"], numbers["tangential"]
    return Finding(
        statements=(
            more("share of mode 1 in the energy, without", without["mode_share"], 0.5),
            more("with", with_it["mode_share"], 0.5),
            less(
                "entropy of the amplitudes up to 20 f1, with over without",
                with_it["disorder"] / without["disorder"],
                1,
            ),
        ),
        because="The tangential force excites the blade more, including its higher modes.",
    )


def stress(numbers: Numbers) -> Finding:
    """C24."""
    return Finding(
        statements=(
            more("largest alternating stress, MPa", numbers["stress"]["alternating_MPa"], 0),
        )
    )


def above_bare_casing(numbers: Numbers) -> Finding:
    """C25."""
    return Finding(
        statements=(
            more(
                "‖Y‖ of the worst coating over the bare casing's",
                numbers["grid"]["worst"]["amplitude"] / numbers["long"]["rigid"]["amplitude"],
                1,
            ),
        )
    )


def growth(numbers: Numbers) -> Finding:
    """C26: growth at the critical speed found after twenty revolutions."""
    ratios = numbers["long"]["growth"]
    fallen = [name for name, ratio in ratios.items() if ratio < FALLEN]
    return Finding(
        statements=tuple(
            more(f"‖Y‖ after 200 revolutions (or all) over 20, {name}", ratio, 1 + INSIGNIFICANT)
            for name, ratio in ratios.items()
        ),
        because=f"Wear has detuned {' and '.join(fallen)}: the response has left the peak by then."
        if fallen
        else "With other steps or rods the motion is another one after 200 revolutions.",
    )


CLAIMS = (
    Claim("C01", "3.2", "8 nodes, 6 fixed-interface modes at 3 speeds: at most 90 DoFs, ends at 85",
          "85", "", size),
    Claim("C02", "3.2, Fig. 3", "first seven frequencies within 1 % over the speed range",
          "1 %", "fig03", frequencies_of_rom),
    Claim("C03", "Eq. 3", "K(Omega) through three speeds; its K2 is misprinted, 3/4 for 4/3",
          "3/4", "", quadratic_term),
    Claim("C04", "Fig. 5", "piecewise linear plastic laws of different ductility",
          "slopes EK/(E+K), E", "fig05", laws),
    Claim("C05", "Fig. 7", "worn profile independent of the density, at two speeds",
          "insignificant", "fig07", wear_by_density),
    Claim("C06", "Fig. 8a", "displacement independent of the density",
          "almost undistinguishable", "fig08", displacement_by_density),
    Claim("C07", "Fig. 8b", "displacement converges with the step", "three steps agree", "fig08",
          displacement_by_step),
    Claim("C08", "6.3", "computing time hardly depends on the density", "not highly dependent", "",
          time_by_density),
    Claim("C09", "Fig. 9", "first five modes at rest", "pictures only", "fig09", modes),
    Claim("C10", "7.1, Fig. 10",
          f"f1 crosses k = 4 and k = 6 at {CROSSING[4]} and {CROSSING[6]}",
          f"{CROSSING[4]}, {CROSSING[6]}", "fig03", crossings),
    Claim("C11", "7.1", "peaks above the crossings, more so for E = 10; Omega_c over crossing",
          "; ".join(f"{shifts_of(part)} ({name})" for part, name in COATING.items()), "fig10b",
          shifts),
    Claim("C12", "7.1", "the peak is higher for the less ductile coating", "> 1", "fig10b",
          higher_peak),
    Claim("C13", "7.1", f"slight odd resonance k = 5 at {CRITICAL['e10'][5]} for E = 10",
          f"{CRITICAL['e10'][5]}", "fig10b", odd_resonance),
    Claim("C14", "7.1, Fig. 11b", "k = 8, 10, 12, 14 visible in the wear map", "4 of 4", "fig11b",
          superharmonics),
    Claim("C15", "7.1, Fig. 11", "two worn lobes away from resonance, k at that of engine order k; "
          "contact does not move", "2, 4, 6", "fig11b", lobes),
    Claim("C16", "Fig. 12", "at k = 4 the less ductile coating is worn more", "> 1", "fig12",
          deeper_wear),
    Claim("C17", "Fig. 13a", "‖Y‖ over (E, K) is bell-shaped, worst at (10, 4.55)",
          "(10, 4.55)", "fig13", worst_case),
    Claim("C18", "Fig. 13a", "a liner of small E and K hardly interacts with the blade, one of the "
          "largest is like a rigid casing", "-", "fig13", corners),
    Claim("C19", "Fig. 13b", "Omega_c grows with E and K", "> 0", "fig13", stiffening),
    Claim("C20", "7.2.2, Fig. 14", "on a casing of two and five nodal diameters: five worn lobes "
          f"away from resonance, the largest peak at {CRITICAL['two_five'][5]} f1(0), lobes that "
          "turn near it", f"{CRITICAL['two_five'][5]}", "fig14", imperfect_casing),
    Claim("C21", "7.2.3", "mean tangential over radial force", f"{FORCE_RATIO}", "fig15",
          force_ratio),
    Claim("C22", "7.2.3, Fig. 15", "a tangential force lowers amplitudes and critical speeds",
          "< 1", "fig15", tangential_lowers),
    Claim("C23", "7.2.3, Fig. 16", "mode 1 dominates, and a tangential force makes the motion less "
          "disorganised", "< 1", "fig16", order_in_spectrogram),
    Claim("C24", "7", "stress in the blade at any time step", "-", "stress-paper-e10", stress),
    Claim("C25", "8", "a coating may give higher vibration than the bare casing", "> 1", "worst",
          above_bare_casing),
    Claim("C26", "7.2.1", "the vibration may grow further over more revolutions", "> 1", "worst",
          growth),
)  # fmt: skip
