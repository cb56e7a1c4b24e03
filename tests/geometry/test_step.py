import pytest

from geometry.cad import StepFile

SI = "#1 = ( LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT({},.METRE.) );\n"
INCH = """#2 = LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(25.4),#1);
#3 = ( CONVERSION_BASED_UNIT('INCH',#2)
LENGTH_UNIT() NAMED_UNIT(#4) );
"""
ANGLE = "#9 = ( CONVERSION_BASED_UNIT('DEGREE',#8) NAMED_UNIT(#7) PLANE_ANGLE_UNIT() );\n"


@pytest.mark.parametrize(
    ("text", "units"),
    [
        (SI.format("$"), {"m"}),
        (SI.format(".MILLI.") + ANGLE, {"mm"}),
        (SI.format(".MILLI.") + INCH, {"in"}),  # the inch is told in mm
        (SI.format(".MICRO."), {".MICRO.METRE"}),
        (ANGLE, set()),
    ],
)
def test_declared_unit(tmp_path, text, units):
    (tmp_path / "a.step").write_text(f"ISO-10303-21;\n{text}END-ISO-10303-21;\n")
    assert StepFile(tmp_path / "a.step").units == units
