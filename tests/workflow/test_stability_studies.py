"""Study of stability: sentences and figure of its results."""

import numpy as np
import pytest

from workflow.study.stability import told as stability

STEPS = ((4e-6, 0.08), (1e-6, 0.005), (2e-6, 0.02))  # and their errors of wear
ENGAGED = [
    {
        "scene": "engaged",
        "numbers": {"E": E, "limit": 5e-7 / E, "predicted": 6e-7 / E, "failed": 5.4e-7 / E},
    }
    for E in (1.0, 3.0, 10.0, 30.0)
]
INTERMITTENT = [
    {
        "scene": f"E = {E}",
        "settings": {"liner": {"law": {"E": E}}, "integrator": {"scheme": scheme}},
        "numbers": {"h": h, "limit": 5e-7, "wear": wear},
    }
    for E in (1.0, 10.0)
    for scheme in stability.SCHEMES
    for h, wear in STEPS
]


def test_the_sentence_has_the_distance_of_failures_from_prediction_and_limit():
    told = stability.limits([*ENGAGED, *INTERMITTENT])
    assert "E = 1 to 30, 4 always engaged liners: runs fail within 10.0% of" in told
    assert told.endswith("the limit allowed is 7.4% to 7% below.")  # 1 - 5 / (6 * 0.9)


def test_each_liner_has_the_steps_of_each_scheme_that_reach_a_level():
    reference = {"scene": "E = 1", "numbers": {"h": 1e-7, "limit": 5e-7}}
    found = stability.intermittent([*ENGAGED, reference, *INTERMITTENT])
    assert [(of["E"], of["limit"]) for of in found] == [(1.0, 5e-7), (10.0, 5e-7)]
    for scheme in stability.SCHEMES:
        assert found[1][f"{scheme} wear 0.01"] == pytest.approx(2**0.5 * 1e-6)
        assert found[1][f"{scheme} wear 0.1"] is None


def test_the_step_that_reaches_a_level_is_interpolated():
    h, error = np.transpose(STEPS)
    assert stability.passes(h, error, 0.01) == pytest.approx(np.sqrt(2) * 1e-6)
    assert stability.passes(h, error, 0.2) is None
    assert stability.passes(h, error, 0.001) is None
