"""What is said of a mesh, against its blade's file; progress in words."""

import re
from dataclasses import replace

import pytest

from geometry.base import counted, duration, remaining


def test_span_radius_and_mass_are_those_of_the_blade(coarse_blade, coarse_mesh):
    found = coarse_mesh.summary
    sections = coarse_blade.sections
    assert found.span == pytest.approx(sections.span, rel=1e-3)
    assert found.tip_radius == pytest.approx(sections.tip_radius, rel=1e-6)
    # a trapezoid of sections: two thirds of chord times thickness and a sixth for the blunt edges
    assert found.mass == pytest.approx(4430 * 0.14 * 0.75 * 63e-3 * 4.2e-3, rel=0.05)
    # parabolic sections of 5.6 and 2.8 mm with edges of a quarter: three quarters of it in the mean
    assert found.thickness == pytest.approx(0.75 * 4.2e-3, rel=0.1)
    assert (
        found.through < 1 and "too few for bending, take mesh.element_size_mm" in found.blade_line()
    )
    # of the elements that there are, not of their mean edge
    wanted = float(re.search(r"below (\S+):?", found.blade_line())[1])
    assert wanted == pytest.approx(coarse_blade.mesh.element_size_mm * found.through, rel=0.05)
    of_file = replace(found, size=None).blade_line()
    assert "export elements with edges below 3.1 mm" in of_file and "element_size" not in of_file
    fine = replace(found, edge=found.thickness / 2)
    assert fine.blade_line().endswith("2.0 through the mean thickness of 3.1 mm: enough")


def test_progress_says_how_far_and_how_long():
    said = []
    assert list(counted("abc", 3, "speed", said.append)) == ["a", "b", "c"]
    assert said[0].startswith("speed 1 of 3, some ") and said[2] == "speed 3 of 3"
    assert remaining(1, 4, 60.0) == "1 of 4, some 3 min left"
    assert [duration(s) for s in (0.25, 59, 7200, 1e6)] == ["0.25 s", "59 s", "2 h", "12 days"]
