"""Does the picture of speed over error show each engine's figures in the panel of its scene?"""

from __future__ import annotations

from pathlib import Path

import pytest
from matplotlib.figure import Figure

from watchsim.render.phase_bands import COLOURS, MARKS, NAMES, plot_speed


def row(scene: str, method: str, time: float, error: float, note: str = "") -> dict[str, object]:
    times = {"wall_s_per_simulated_s": time, "wall_least": 0.9 * time, "wall_largest": 1.3 * time}
    return {"scene": scene, "method": method, **times, "error_state": None, "error_amplitude_deg": error, "note": note}


def test_every_figure_in_its_place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    saved: list[Figure] = []
    monkeypatch.setattr(Figure, "savefig", lambda self, path, **_: saved.append(self))
    rows = [
        *(row("a", "pfeiffer-glocker", 0.004, 1e-5), row("a", "pfeiffer-glocker", 0.005, 0.0), row("a", "moreau", 0.5, 0.01)),
        *(row("a", "moreau", 0.9, 0.02, "does not run"), row("b", "pfeiffer-glocker", 0.1, 1e-3), row("b", "moreau", 0.2, 0.3)),
        row("alone", "pfeiffer-glocker", 1.0, 1.0),
    ]
    plot_speed(rows, tmp_path / "speed.png")
    panels = saved[0].axes
    assert [axes.get_title(loc="left") for axes in panels] == ["a", "b"]
    points = [[(*bars[0].get_xdata(), *bars[0].get_ydata()) for bars in axes.containers] for axes in panels]
    assert points == [[(1e-5, 1e-14, 0.004, 0.005), (0.01, 0.5)], [(1e-3, 0.1), (0.3, 0.2)]]
    low, high = panels[0].containers[1].lines[2][0].get_segments()[0][:, 1]
    assert (low, high) == pytest.approx((0.45, 0.65))
    assert panels[0].get_ylabel() and not panels[1].get_ylabel()


def test_every_engine_has_a_look_of_its_own() -> None:
    assert len(set(COLOURS.values())) == len(set(MARKS.values())) == len(set(NAMES.values())) == 5
    assert set(COLOURS) == set(MARKS) == set(NAMES)


def test_panels_stand_three_to_a_row(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Rows are 62 mm high; what the last one lacks stays empty, and each engine is named once below them."""
    saved: list[Figure] = []
    monkeypatch.setattr(Figure, "savefig", lambda self, path, **_: saved.append(self))
    rows = [row(scene, method, 0.1, 0.01) for scene in "abcd" for method in ("moreau", "pymunk")]
    rows[3]["error_state"] = 3e-5  # of b: what the other one has no such error for is not drawn
    plot_speed(rows, tmp_path / "speed.png")
    panels = saved[0].axes
    assert [axes.get_title(loc="left") for axes in panels] == [*"abcd", "", ""]
    assert [axes.axison for axes in panels] == [True] * 4 + [False] * 2
    assert [bool(axes.get_ylabel()) for axes in panels] == [True, False, False, True, False, False]
    assert [axes.get_xlabel().split()[3] for axes in panels[:4]] == ["amplitude", "place", "amplitude", "amplitude"]
    assert [axes.get_xscale() + axes.get_yscale() for axes in panels[:4]] == ["loglog"] * 4
    assert [bars[0].get_xdata()[0] for bars in panels[1].containers] == [3e-5]
    assert saved[0].get_figheight() * 25.4 == pytest.approx(124.0)
    (legend,) = saved[0].legends
    assert [text.get_text() for text in legend.get_texts()] == ["watchsim, Moreau's time stepping", "pymunk"]
