"""Do the charts of the page measure what they say?"""

from __future__ import annotations

import re

import pytest

from watchsim.pages.charts import bars


@pytest.mark.parametrize("shares", [(0.75, 0.25), (0.5, -0.25), (-0.2, -0.8), (1.0,), (0.0, -0.5)])
def test_bars_run_from_one_line_in_proportion(shares: tuple[float, ...]) -> None:
    """To the right what is positive, to the left what is negative, all between the names and the words of the longest one."""
    text = str(bars([(f"n{k}", share, "") for k, share in enumerate(shares)], "shares"))
    drawn = [(float(x), float(width)) for x, width in re.findall(r'<rect[^>]* x="?([\d.-]+)"?[^>]* width="?([\d.]+)"?', text)]
    assert len(drawn) == len(shares)
    zeros = {round(x if share >= 0.0 else x + width, 1) for (x, width), share in zip(drawn, shares, strict=True)}
    assert max(zeros) - min(zeros) <= 0.8  # a share of nothing is a thin mark
    longest = max(map(abs, shares))
    unit = max(width for _, width in drawn) / longest
    for (x, width), share in zip(drawn, shares, strict=True):
        assert width == pytest.approx(max(unit * abs(share), 0.8), abs=0.02)
        assert x >= 204.9
    assert max(x + width for x, width in drawn) - min(x for x, _ in drawn) == pytest.approx(
        unit * (max(0.0, *shares, 0.0) - min(0.0, *shares, 0.0)), abs=0.9
    )
