"""Numbers in text: digits of a value, and of its uncertainty."""

import pytest

from workflow.markdown import Number, percent, two_digits


@pytest.mark.parametrize(
    ("number", "shown", "share"),
    [
        (Number(1.2345, 0.031), "1.23 ± 0.03", "±2.5%"),
        (Number(1234.5, 0.0), "1234 ± 0", "±0.01%"),  # no exponent; not below a hundredth of 1 %
        (Number(1.23456, 0.0012), "1.235 ± 0.001", "±0.097%"),  # within its uncertainty
        (Number(12345.6, 2.0), "12346 ± 2", "±0.016%"),
        (Number(1.2345, 0.096), "1.2 ± 0.1", "±7.8%"),
        (Number(999.7), "1000", "(no ±)"),
        (Number(-0.05, 0.01), "-0.05 ± 0.01", "±20%"),
        (Number(0.0, 0.1), "0 ± 0.1", ""),
        (Number(14.37, 0.76), "14.4 ± 0.8", "±5.3%"),
        (Number(17.12, 3.4), "17 ± 3", "±20%"),
        (Number(1234.5, 56.0), "1230 ± 60", "±4.5%"),
        (Number(0.234, 0.5), "0.2 ± 0.5", "±214%"),
        (Number(40.0, 4.4, least=True), "40 ± 4", "≥11%"),
        (Number(40.0), "40", "(no ±)"),
        (Number(40.0, float("inf")), "40 ± inf", "(no ±)"),
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
