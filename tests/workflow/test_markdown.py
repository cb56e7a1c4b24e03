"""Numbers in text: digits of a value, and of its uncertainty."""

import pytest

from workflow.markdown import Number, percent, two_digits


@pytest.mark.parametrize(
    ("number", "shown", "share"),
    [
        (Number(1.2345, 0.031), "1.23 ± 0.03", "±2.5%"),
        (Number(1234.5, 0.0), "1234 ± 0", "±0.01%"),  # no exponent; not below a hundredth of 1 %
        (Number(-0.05, 0.01), "-0.05 ± 0.01", "±20%"),
        (Number(0.0, 0.1), "0 ± 0.1", ""),
        (Number(40.0), "40", "?"),
        (Number(40.0, float("inf")), "40 ± inf", "?"),
    ],
)
def test_a_number_with_its_uncertainty(number, shown, share):
    assert (str(number), number.share) == (shown, share)


@pytest.mark.parametrize(
    ("share", "text"),
    [(0.0, "0 %"), (0.0123, "1.2 %"), (0.1, "10 %"), (3e-5, "0.003 %"), (12.3, "1230 %")],
)
def test_a_share_has_two_digits(share, text):
    assert percent(share) == text and two_digits(100 * share) == text[:-2]
