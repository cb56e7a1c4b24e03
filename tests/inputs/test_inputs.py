"""Whatever people write is read as it says, or refused in lines that name the file.

Hypothesis changes valid blades, scenes, configurations, tables, meshes, CAD files, matrices, models
and results; the draws are always the same. No input may end in a traceback or a crash, take ten
seconds or two gigabytes, or be read as something else.
"""

import os
import re
from pathlib import Path

import numpy as np
import pytest
from case import Case, judge
from tester import count
from yaml_oracle import differs

from geometry.base import UserError


@pytest.mark.nightly
def test_five_hundred_inputs_are_right_or_refused():
    counts = count(500)
    assert sum(sum(of.values()) for of in counts.kinds.values()) >= 0.95 * 500
    assert not counts.faults, "\n".join(counts.faults)
    assert all(len(of) == 2 for of in counts.kinds.values() if sum(of.values()) > 50), counts.kinds


TWO = "a.yaml: x\na.yaml: y"


@pytest.mark.parametrize(
    ("answer", "must", "fault", "verdict"),
    [
        (KeyError("x"), "either", "", "traceback"),
        (1, "refuse", "", "silent"),
        (1, "either", "is 1", "silent"),
        (1, "accept", "", "right"),
        (UserError("a.yaml: x"), "accept", "", "refused wrongly"),
        (UserError("a.yaml: x", "", "a.yaml: y"), "either", "", "unclear"),
        (UserError("no file: x"), "either", "", "unclear"),
        (UserError(TWO), "either", "", "refused"),
    ],
)
def test_the_tester_sees_each_kind_of_fault(tmp_path, answer, must, fault, verdict):
    def read(folder):
        if isinstance(answer, BaseException):
            raise answer
        return answer

    case = Case("made", "made", {"a.yaml": b"x"}, read, must, lambda value: fault)
    assert judge(case, tmp_path).name == verdict


def busy(folder):
    while True:
        try:
            sum(range(1000))
        except Exception:
            continue


def backtracking(folder):
    return re.fullmatch(r"(x+x+)+y", 40 * "x")


def waiting(folder):
    return Path(folder, "pipe").read_text()


@pytest.mark.parametrize("read", [busy, backtracking, waiting])
def test_the_tester_stops_what_hangs(tmp_path, monkeypatch, read):
    monkeypatch.setattr("case.TIME", 1)
    monkeypatch.setattr("case.WAITS", 3)
    case = Case("made", "made", {"pipe": "pipe"}, read, "either")
    assert judge(case, tmp_path).name == "hang"


@pytest.mark.parametrize(
    ("read", "verdict"),
    [
        (lambda folder: np.ones(100 * 2**27), "memory"),  # 100 GB
        (lambda folder: [bytearray(2**20) for _ in range(2**12)], "memory"),
        (lambda folder: np.ones(2**27).sum(), "right"),
        (lambda folder: os.abort(), "crash"),
    ],
)
def test_the_tester_sees_what_takes_memory_or_crashes(tmp_path, read, verdict):
    assert judge(Case("made", "made", {}, read, "either"), tmp_path).name == verdict


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
    assert (differs(text, value) == "") is same
