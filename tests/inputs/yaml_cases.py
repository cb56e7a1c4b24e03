"""Blades, scenes and configurations in YAML, changed as people and accidents change them."""

from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import yaml
from case import Case
from changes import LONG, contents, cut, line, long
from hypothesis import strategies as st
from yaml_oracle import differ, differs, leaves, says

from geometry.blade import Blade
from simulate.scene import Scene
from workflow.config import read_config

WORKFLOW = Path(__file__).parents[2] / "workflow"

type Cases = st.SearchStrategy[Case]


class Seed(NamedTuple):
    """A valid file."""

    kind: str
    text: str
    load: Callable[[Path], Any]  # from the path of the file

    @property
    def file(self) -> str:
        return f"{self.kind}.yaml"

    def read(self, folder: Path) -> Any:
        return self.load(folder / self.file)

    def case(self, change: str, text: str, must: str = "either", data: Any = None) -> Case:
        """The seed with another text, which must be read as it says, if at all; ``data`` has it."""
        files = {self.file: text.encode() if data is None else data}
        return Case(self.kind, change, files, self.read, must, lambda v: differs(text, v))


SEEDS = [
    Seed("blade", (WORKFLOW / "blades/reference.yaml").read_text(), Blade.load),
    Seed("blade", (WORKFLOW / "blades/rotor37.yaml").read_text(), Blade.load),
    Seed("scene", (WORKFLOW / "scenes/paper.yaml").read_text(), Scene.load),
    Seed("config", (WORKFLOW / "config.yaml").read_text(), read_config),
]


def scalars(text: str) -> list[yaml.ScalarNode]:
    """Values of a text, without its keys."""
    found, waiting = [], [yaml.compose(text)]
    while waiting:
        node = waiting.pop()
        if isinstance(node, yaml.ScalarNode):
            found.append(node)
        else:
            mapping = isinstance(node, yaml.MappingNode)
            waiting += [item[1] for item in node.value] if mapping else node.value
    return sorted(found, key=lambda node: node.start_mark.index)


def put(text: str, node: yaml.Node, new: str) -> str:
    """The text with another value at a node."""
    return text[: node.start_mark.index] + new + text[node.end_mark.index :]


def is_number(node: yaml.ScalarNode) -> bool:
    return node.tag.endswith((":int", ":float"))


# what YAML 1.1 reads as something else, what other programs write, and what is no value
ODD = [
    *("010", "0140", "0o17", "0x1F", "0x_", "0b101", "0b", "1:30", "190:20:30", "1:30.5", "1_000"),
    *("2020-13-45", "2020-01-01", "!!int abc", "!!float x", "!!timestamp abc", "!!null abc"),
    *("!!python/object:os.system x", "!!binary x", "!!set {a}", "!!str 5", "!x 5", "nan", ".nan"),
    *(".inf", "-.inf", "1e400", "1.0D+01", "1,5", "1.5 mm", "'5'", "٣", "yes", "on", "~", "null"),
    *("", "{}", "[]", "[1]", "{a: 1}", "''", "-", "?", "|", ">", "&", "*", "&a [*a]", "*a", "%"),
    *("@", "`", "=", "<<", "true", "-1", "0", "-0.0", "1e-400", "1e308", "+5", ".5", "5.", "1e5"),
    *("1.e+3", '"\\u0000"', '"a\\nb"', "../x", "/etc/passwd", "a(b", "{x}", "a+b", "a: b: c"),
    *("1" * 131_072, "1_" * 65_536, "1:" * 65_536, *LONG.values()),
    *("1" * 5000, "[" * 3000, "[" * 40 + "]" * 40, "1" * 400, "x" * 3000, "- 1", "\t1", "#", "!"),
]
# keys, and factors on their values that nobody means: another unit, or a decimal point lost
SLIPS = {
    "blade": [
        ("young_modulus_GPa", 1e3),  # in MPa
        ("young_modulus_GPa", 1e9),  # in Pa
        ("density_kg_m3", 1e-3),  # in g/cm3
        ("density_kg_m3", 1e-12),  # in t/mm3
        ("max_speed_rpm", 60 / 6.283),  # rad/s taken for rpm
        ("thickness_mm", 10),
        ("poisson_ratio", 10),
        ("patches", 10),
        ("chord_mm", -1),
        ("chord_mm", 0),
        ("span_mm", 1e3),
        ("natural_modes", 100),
    ],
    "scene": [
        ("rounds", -1),
        ("rounds", 1e6),
        ("damping_ratio", 1e3),
        ("E", -1),
        ("thickness_mm", 1e6),
        ("footprint_mm", -1),
        ("strips", 100),
        ("rods_per_round", 1e5),
        ("steps_per_round", 1.001),
        ("samples_per_round", 1e-2),
        ("samples_per_round", 1e4),
        ("spectrum_rounds", 10),
        ("phase_deg", 100),
    ],
    "config": [("blocks", 1e4), ("blocks", 0), ("blocks", -1)],
}
NEUTRAL = {  # the same number, written otherwise
    "plus": lambda x: f"+{x!r}" if x >= 0 else repr(x),
    "exponent": lambda x: f"{x * 10!r}e-1" if "e" not in repr(x * 10) else repr(x),
    "zeros": lambda x: f"{x!r}000" if "." in repr(x) and "e" not in repr(x) else repr(x),
    "quotes": lambda x: f"'{x!r}'",
    "as it is": repr,
}
HEAVY = {  # what would take a parser's time or memory, or its stack
    "holds itself": "a: &a [*a]",
    "mapping that holds itself": "a: &a {b: *a}",
    "aliases of aliases": "a: &a [x,x,x,x,x,x,x,x,x]\n"
    + "\n".join(
        f"{chr(98 + i)}: &{chr(98 + i)} [{','.join(['*' + chr(97 + i)] * 9)}]" for i in range(9)
    ),
    "deep list": "a: " + "[" * 100_000,
    "deep mapping": "a: " + "{a: " * 2000,
    "deep indents": "\n".join("  " * i + "a:" for i in range(400)),
    "many values": "a: [" + "1," * 25_000 + "]",
    "long text": "a: " + "x" * 600_000,
    "many keys": "\n".join(f"k{i}: 1" for i in range(21_000)),
    "long key": "k" * 3000 + ": 1",
    "key of several lines": '"a\\nb": 1',
    "number as key": "7: 1",
    "list as key": "[a]: 1",
    "second document": "--- 1",
    "control character": "a: \x07",
    "merge of itself": "a: &a {<<: *a}",
}


@st.composite
def of_value(draw: st.DrawFn, seed: Seed) -> Case:
    """One value replaced by an odd one, or by random text."""
    node = draw(st.sampled_from(scalars(seed.text)))
    new = draw(st.sampled_from(ODD) | st.text(max_size=8))
    return seed.case("odd value", put(seed.text, node, new))


@st.composite
def of_slip(draw: st.DrawFn, seed: Seed) -> Case:
    """A number in another unit, of another sign or ten times what was meant."""
    key, factor = draw(st.sampled_from(SLIPS[seed.kind]))
    found = [n for n in scalars(seed.text) if is_number(n) and _key(seed.text, n) == key]
    of_mesh = key == "max_speed_rpm" and "sections:" not in seed.text  # with the tip's radius
    if not found or of_mesh:
        return seed.case("unchanged", seed.text, "accept")
    node = draw(st.sampled_from(found))
    value = float(node.value) * factor
    text = f"{int(value)}" if value == int(value) and abs(value) < 1e15 else f"{value:.6e}"
    return seed.case("slip of unit or sign", put(seed.text, node, text), "refuse")


def _key(text: str, node: yaml.Node) -> str:
    before = text[: node.start_mark.index].rstrip()
    return before.removesuffix(":").split()[-1].strip("{,") if before.endswith(":") else ""


@st.composite
def of_format(draw: st.DrawFn, seed: Seed) -> Case:
    """The same number in another format: it must be read, and be the same."""
    node = draw(st.sampled_from([n for n in scalars(seed.text) if is_number(n)]))
    whole = node.tag.endswith(":int")
    how = draw(st.sampled_from(["plus", "quotes", "as it is"] if whole else sorted(NEUTRAL)))
    value = (int if whole else float)(node.value)
    return seed.case("same number", put(seed.text, node, NEUTRAL[how](value)), "accept")


def of_text(seed: Seed) -> Cases:
    """Lines lost, exchanged or indented otherwise; the end, or all, lost."""
    lines = seed.text.split("\n")
    used = [i for i, line in enumerate(lines) if line.strip() and line.lstrip()[0] != "#"]
    changed = line(seed.text, used, "lost", "indented", "exchanged") | cut(seed.text)
    changed |= long(seed.text, used)
    return changed.map(lambda change: seed.case(*change))


@st.composite
def of_repeat(draw: st.DrawFn, seed: Seed) -> Case:
    """A key of the file a second time, with the same or another value."""
    key = draw(st.sampled_from(sorted(yaml.safe_load(seed.text))))
    value = draw(st.sampled_from(("1", "{}", "[]", "x", "")))
    return seed.case("key twice", f"{seed.text}\n{key}: {value}\n", "refuse")


@st.composite
def of_key(draw: st.DrawFn, seed: Seed) -> Case:
    """A key with a letter lost, added or changed."""
    root = yaml.compose(seed.text)
    key = draw(st.sampled_from([key for key, _ in root.value]))
    at = draw(st.integers(0, len(key.value) - 1))
    new = key.value[:at] + draw(st.sampled_from(("", "x", "_", "ü"))) + key.value[at + 1 :]
    must = "refuse" if new != key.value else "accept"
    return seed.case("misspelt key", put(seed.text, key, new or "x"), must)


@st.composite
def of_characters(draw: st.DrawFn, seed: Seed) -> Case:
    """Characters lost, changed or added anywhere."""
    text = seed.text
    for _ in range(draw(st.integers(1, 3))):
        at = draw(st.integers(0, len(text) - 1))
        new = draw(
            st.sampled_from(list(":{}[]&*!|>%@,#\t\x00-?'\"=0123456789.eE")) | st.text(max_size=2)
        )
        text = text[:at] + new + text[at + draw(st.integers(0, 2)) :]
    return seed.case("characters changed", text)


@st.composite
def of_heavy(draw: st.DrawFn, seed: Seed) -> Case:
    """Few characters that stand for much, or much of them."""
    name = draw(st.sampled_from(sorted(HEAVY)))
    text = f"{HEAVY[name]}\n{seed.text}" if draw(st.booleans()) else f"{seed.text}\n{HEAVY[name]}"
    return seed.case(f"heavy: {name}", text, "refuse")


def of_file(seed: Seed) -> Cases:
    """The same text in other encodings and ends of line, and what is no file or has none."""
    known = contents(seed.text) | {
        "Latin-1": (("# ü\n" + seed.text).encode("latin-1"), "refuse"),
        "comments alone": (b"# nothing\n", "refuse"),
    }

    def case(change: str) -> Case:
        data, must = known[change]
        return seed.case(change, seed.text, must, data)

    return st.sampled_from(sorted(known)).map(case)


ODD_NAMES = ("a(b", "{x}", "a+b", "a b", "..", "ü", "a" * 200, "[x]", "a.b", "-a", "x*", "a\\b")
BASES = ("../scene", "/etc/passwd", "x" * 300, "..", ".", "scene", "nowhere", "a/b", "7", "~")


def bases() -> Cases:
    """A scene on its bases: chains, cycles, names that are none, and a fault of the base."""
    scene = SEEDS[2]

    def case(change: str, files: dict[str, str], must: str, rounds: object = None) -> Case:
        """The scene's file among others; it holds what the seed says, with other rounds."""
        held = says(scene.text) | {("rounds",): str(rounds)}
        data = {name: text.encode() for name, text in files.items()}
        return Case("base", change, data, scene.read, must, lambda v: differ(held, leaves(v)))

    @st.composite
    def chain(draw: st.DrawFn) -> Case:
        n, rounds = draw(st.sampled_from((1, 2, 5, 19, 30, 60))), draw(st.integers(20, 90))
        files = {f"b{i}.yaml": f"base: b{i + 1}\n" for i in range(n - 1)}
        files |= {f"b{n - 1}.yaml": scene.text, "scene.yaml": f"base: b0\nrounds: {rounds}\n"}
        return case("chain", files, "accept" if n < 20 else "refuse", rounds)

    names = st.sampled_from(BASES + ODD_NAMES + tuple(ODD[:40]))
    odd = names.map(lambda n: case("odd", {"scene.yaml": f"base: {n}\n{scene.text}"}, "refuse"))

    def variant(rounds: str) -> Case:
        variants = f"scene: {{base: b, rounds: {rounds}}}"
        must = "accept" if rounds in ("20", "30") else "refuse"
        return case("variant", {"b.yaml": scene.text, "variants.yaml": variants}, must, rounds)

    return chain() | odd | st.sampled_from(("20", "30", "0", "010", "x")).map(variant)


def command_line() -> Cases:
    """Values given by --config, as Snakemake hands them on."""
    config = SEEDS[3]
    values = st.sampled_from(
        [0, -1, 3, 2.5, "x", "", None, True, ["paper"], ["../x"], [], [1], {}, {"a": 1}, "[a"]
    )

    @st.composite
    def case(draw: st.DrawFn) -> Case:
        key = draw(st.sampled_from(("scenes", "blocks", "explore", "block", "x")))
        value = draw(values)
        known = {
            "scenes": value == ["paper"],
            "explore": value in (["paper"], [], None),
            "blocks": type(value) is int and value > 0,
        }
        must = "accept" if known.get(key) or (value is None and key in ("x", "block")) else "refuse"

        def read(folder: Path) -> Any:
            return read_config(folder / "config.yaml", {key: value})

        def fault(found: Any) -> str:
            held = getattr(found, key, None)
            return "" if value is None or held == value else f"{value!r} is held as {held!r}"

        return Case(
            "config", "command line", {config.file: config.text.encode()}, read, must, fault
        )

    return case()


def yaml_cases() -> Cases:
    """All of these."""
    of_seed = (of_value, of_slip, of_format, of_text, of_repeat, of_key, of_characters)
    kinds = [of(seed) for seed in SEEDS for of in (*of_seed, of_heavy, of_file)]
    return st.one_of(*kinds, bases(), command_line())
