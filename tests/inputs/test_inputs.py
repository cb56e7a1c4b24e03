"""Whatever people write is read as it says, or refused in lines that name the file.

Hypothesis changes valid blades, scenes, configurations, tables, meshes and CAD files; the draws are
always the same. No input may end in a traceback, take ten seconds, or be read as something else.
"""

import pytest
from case import Case, Verdict, judge
from tester import count


@pytest.mark.nightly
def test_five_hundred_inputs_are_right_or_refused():
    counts = count(500)
    assert sum(sum(of.values()) for of in counts.kinds.values()) >= 0.95 * 500
    assert not counts.faults, "\n".join(counts.faults)
    assert all(len(of) == 2 for of in counts.kinds.values() if sum(of.values()) > 50), counts.kinds


def case_of(answer, must="either", fault=lambda value: ""):
    """A case whose reader gives or raises ``answer``."""

    def read(folder):
        if isinstance(answer, BaseException):
            raise answer
        return answer

    return Case("made", "made", {"a.yaml": b"x"}, read, must, fault)


def verdict(tmp_path, *case) -> Verdict:
    return judge(case_of(*case), tmp_path)


def test_the_tester_sees_each_kind_of_fault(tmp_path, monkeypatch):
    from geometry.errors import UserError

    assert verdict(tmp_path, KeyError("x")).name == "traceback"
    assert verdict(tmp_path, 1, "refuse").name == "silent"
    assert verdict(tmp_path, 1, "either", lambda value: "is 1").name == "silent"
    assert verdict(tmp_path, UserError("a.yaml: x"), "accept").name == "refused wrongly"
    assert verdict(tmp_path, UserError("a.yaml: x\n\na.yaml: y")).name == "unclear"
    assert verdict(tmp_path, UserError("no file: x")).name == "unclear"
    assert verdict(tmp_path, UserError("a.yaml: x\na.yaml: y")).name == "refused"
    assert verdict(tmp_path, 1, "accept").name == "right"


def test_the_tester_stops_what_hangs(tmp_path, monkeypatch):
    monkeypatch.setattr("case.TIME", 0.05)

    def read(folder):
        while True:
            try:
                sum(range(1000))
            except Exception:
                continue

    assert judge(Case("made", "made", {}, read, "either"), tmp_path).name == "hang"


@pytest.mark.parametrize(
    ("text", "value", "same"),
    [
        ("a: 010", {"a": 8}, False),
        ("a: 010", {"a": 10}, True),
        ("a: 1:30", {"a": 90}, False),
        ("a: 1.5e1", {"a": 15.0}, True),
        ("a: {b: [1, x]}", {"a": {"b": [1, "x"]}}, True),
        ("a: {b: [1, x]}", {"a": {"b": [1]}}, False),
        ("a: 1", {"a": 1, "b": 2}, False),
        ("a: yes", {"a": True}, True),
        ("a: [", {}, False),
    ],
)
def test_settings_are_compared_with_what_the_text_says(text, value, same):
    from yaml_oracle import differs

    assert (differs(text, value) == "") is same
