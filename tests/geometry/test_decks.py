"""Decks of Abaqus and CalculiX as programs write them: the same mesh and groups, or one line."""

import re

import exports
import pytest


def rows_of(text, card):
    """Lines of the deck from ``card`` to the next one."""
    return re.search(rf"^\*{card}.*\n([^*]*)", text, re.MULTILINE).group(1)


def in_two_lines(text):
    """Each element of the deck in two lines, the first with a comma at its end."""
    rows = rows_of(text, "ELEMENT")
    fives = re.sub(r"^((?:\d+, ){5})", r"\1\n", rows, flags=re.MULTILINE)
    return text.replace(rows, fives)


def ranges(text):
    rows = rows_of(text, "NSET, NSET=root")
    generated = "".join(f"{i} {i}, 1\n" for i in rows.split())
    return text.replace(f"NSET=root\n{rows}", f"NSET=root,\nGENERATE\n{generated}")


REFERENCE = (
    "*Node\n1, 0., 0., 0.\n*Nset, nset=RP, internal\n1,\n*Element, type=SPRING1, elset=m\n1, 1\n"
)
REFERENCE += "*Elset, elset=m2, generate\n1, 1, 1\n"


def assembly(text, sets, own=REFERENCE):
    """The deck as Abaqus/CAE writes it: a part, one instance, sets of the assembly."""
    mesh = text[: text.index("*NSET, NSET=root")]
    head = f"*Heading\n*Part, name=B\n{mesh}*End Part\n*Assembly, name=A\n"
    return f"{head}*Instance, name=B-1, part=B\n*End Instance\n{own}{sets}*End Assembly\n"


def of_instance(text):
    sets = text[text.index("*NSET, NSET=root") :]
    return re.sub(r"(NSET=\w+)\n", r"\1, instance=B-1\n", sets)


def by_dots(text):
    return re.sub(
        r"^(\d+),", r"B-1.\1,", text[text.index("*NSET, NSET=root") :], flags=re.MULTILINE
    )


SAME = {
    "comma at the end of all cards": lambda t: re.sub(r"^(\*.*)$", r"\1, ", t, flags=re.MULTILINE),
    "options in the next line": lambda t: t.replace("*NSET, NSET=root", "*NSET,\n NSET=root"),
    "flag in the next line": ranges,
    "set of a set behind a comma": lambda t: (
        t.replace("NSET=root", "NSET=nodes") + "*NSET, NSET=root,\nnodes,\n"
    ),
    "cards that are indented": lambda t: t.replace("*NSET", "  *NSET"),
    "numbers of Fortran": exports.fortran,
    "small letters": lambda t: exports.fortran(t).lower(),
    "tabs": lambda t: t.replace(", ", ",\t"),
    "elements in two lines": in_two_lines,
    "an assembly with a reference point": lambda t: assembly(t, of_instance(t)),
    "sets of the part that have the names of those of the assembly": lambda t: assembly(
        t.replace("*NODE", "*NSET, NSET=TIP, GENERATE\n1, 1659\n*NODE"), of_instance(t)
    ),
    "numbers with the instance": lambda t: assembly(t, by_dots(t)),
    "range beyond the last node": lambda t: t + "*NSET, NSET=all, GENERATE\n1, 9999999999\n",
    # the node and the spring are left out
    "a second card of nodes, which only a spring uses": lambda t: (
        t + "*NODE\n99999, 0., 0., 1e9\n** a comment\n"
        "*ELEMENT, TYPE=SPRINGA, ELSET=Spring\n88888, 99999, 1\n*BOUNDARY\nroot, 1, 3\n"
    ),
    "set of the nodes of a spring": lambda t: (
        t + "*NODE\n9999, 0, 0, 0\n*ELEMENT, TYPE=SPRING1, ELSET=s\n8888, 9999\n"
        "*ELSET, ELSET=more\n8888,\n*NSET, NSET=ends, ELSET=S\n"
    ),
}


@pytest.mark.parametrize("how", SAME)
def test_same_mesh_and_groups(how, parts, build, coarse_mesh):
    summary, found = build("blade.inp", exports.write_inp, *parts, change=SAME[how])
    assert (summary.nodes, summary.cells) == (len(parts.points), len(parts.cells))
    assert summary.volume == pytest.approx(coarse_mesh.summary.volume, rel=1e-12)
    assert exports.same_facets(found, parts)


def test_solid_elements_of_the_assembly(parts, refusal):
    """They name its own nodes, which are not read."""
    own = REFERENCE + "*Element, type=C3D4\n1, 1, 2, 3, 4\n"
    change = {"change": lambda deck: assembly(deck, of_instance(deck), own)}
    error = refusal("blade.inp", exports.write_inp, *parts, **change)
    assert "assembly itself" in error.text
