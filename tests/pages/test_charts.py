"""Do the charts of the page measure what they say?"""

import re
from pathlib import Path

import pytest

from watchsim.pages import charts
from watchsim.pages.charts import bars
from watchsim.render.palette import ENERGIES


@pytest.mark.parametrize("shares", [(0.75, 0.25), (0.5, -0.25), (-0.2, -0.8), (1.0,), (0.0, -0.5)])
def test_bars_run_from_one_line_in_proportion(shares: tuple[float, ...]) -> None:
    """To the right what is positive, to the left what is negative, all between the names and the words of the longest one."""
    text = str(bars([(f"n{k}", share, "") for k, share in enumerate(shares)], "shares", {}))
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


def test_energy_kinds_have_the_colours_of_the_plots() -> None:
    style = (Path(charts.__file__).parent / "assets" / "page.css").read_text(encoding="utf-8")
    light = re.search(r"--s0: .*", style)
    assert light is not None
    own = dict(re.findall(r"--(s\d): (#\w+);", light.group()))
    text = str(bars([(kind, 0.2, "") for kind in ENERGIES], "shares", ENERGIES))
    assert [own[number] for number in re.findall(r'class="(s\d)"', text)] == list(ENERGIES.values())
