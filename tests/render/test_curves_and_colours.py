"""Does a thinned curve look like the whole one, and does every spike survive?"""

import io
import itertools
import math
import re
from collections.abc import Sequence
from itertools import combinations
from pathlib import Path

import numpy as np
import pytest
from analysis.made_beats import PERIOD, PIN, balance_only, steady_swings, swiss
from hypothesis import given, settings
from hypothesis import strategies as st
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_hex, to_rgb, to_rgba
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.text import Text
from render.colour_vision import VISIONS, lab, least_difference, linear
from render.fake_runs import watch_run
from render.read_back import faults, width_mm

import watchsim as ws
from watchsim.analysis.timegrapher import tape
from watchsim.commands.pictures import KINDS, Request
from watchsim.render.kinematics_plot import plot_kinematics
from watchsim.render.movie import frame
from watchsim.render.palette import (
    BLUED,
    BRASS,
    DARK,
    FIXED,
    INK,
    LIGHT,
    NIGHT,
    OTHERS,
    PHASE_LINES,
    RUBY,
    SECOND,
    STEEL,
    Style,
    contrast,
    dark,
    looks,
    mixed,
    on_dark,
)
from watchsim.render.rows import COLUMNS, bands, distinct, reduced
from watchsim.render.study_plot import ENGINES, plot_speed
from watchsim.render.style import SERIES, figure, key, ticks
from watchsim.render.timing_plot import PAPER, plot_tape
from watchsim.simulation.simulate import simulate
from watchsim.simulation.state import EventKind

Areas = Sequence[tuple[np.ndarray, np.ndarray, np.ndarray]]  # x, lower and upper edge

MILLION = 1_000_000
X = np.linspace(0.0, 180.0, MILLION)
QUIET = np.sin(3.0 * X)


@given(st.integers(0, MILLION - 1), st.sampled_from([-50.0, 3.0, 1e6]))
@settings(max_examples=25)
def test_a_spike_of_one_sample_in_a_million_survives(place: int, height: float) -> None:
    y = QUIET.copy()
    y[place] = height
    x, kept = reduced(X, y)
    assert len(x) <= 4 * COLUMNS + 8
    assert (X[place], height) in set(zip(x[kept == height].tolist(), kept[kept == height].tolist(), strict=True))
    assert np.all(np.diff(x) >= 0.0)


def pixels(x: np.ndarray, y: np.ndarray, columns: int, areas: Areas = ()) -> np.ndarray:
    """A curve and areas over the whole width, edges one dot thick and without shades between ink and paper."""
    figure = Figure(figsize=(columns / 100.0, 3.0), dpi=100)
    FigureCanvasAgg(figure)
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    axes.axis("off")
    (line,) = axes.plot(x, y, color="black", linewidth=0.72, antialiased=False)
    line.get_path().should_simplify = False  # matplotlib's own thinning is not what is tested
    for area in areas:
        axes.fill_between(*area, color="black", linewidth=0.72, antialiased=False)
    axes.set_xlim(0.0, 180.0)
    axes.set_ylim(-5.0, 5.0)
    out = io.BytesIO()
    figure.savefig(out, format="raw")
    return np.frombuffer(out.getvalue(), np.uint8).reshape(300, columns, 4)[..., 0]


def test_the_picture_is_that_of_all_points() -> None:
    rng = np.random.default_rng(7)
    y = QUIET + 0.3 * rng.standard_normal(MILLION) * (rng.random(MILLION) > 0.999)
    dots = 800
    assert len(reduced(X, y)[0]) < MILLION / 50
    whole, thin = pixels(X, y, dots), pixels(*reduced(X, y), dots)
    assert np.mean(whole == 0) > 0.02 and np.mean(whole != thin) < 5e-3  # rounding at the edges of the ink


@pytest.mark.parametrize("swings", [0.5, 20.0, 200.0, 5000.0])
def test_an_area_covers_what_the_curve_covers(swings: float) -> None:
    rng = np.random.default_rng(9)
    y = np.sin(2.0 * np.pi * swings / 180.0 * X) + 3.0 * (rng.random(MILLION) > 0.99999)
    dots = 400
    areas = bands(X, y, 2 * dots)
    whole, filled = pixels(X, y, dots), pixels(X[:0], y[:0], dots, areas)
    assert len(areas) == 1 and len(areas[0][0]) == 2 * dots
    ink, other = whole == 0, whole != filled
    # Only dots at an edge may differ: those with paper and ink around them.
    around = [np.roll(ink, (i, j), (0, 1)) for i in (-1, 0, 1) for j in (-1, 0, 1)]
    at_edge = np.any(around, axis=0) & ~np.all(around, axis=0)
    assert not np.any(other & ~at_edge) and np.mean(other) < 2e-2


def test_areas_end_at_gaps_and_few_points_are_a_curve() -> None:
    y = QUIET.copy()
    y[300_000:600_000] = np.nan
    (first, low, high), (second, *_) = bands(X, y)
    assert (first[0], second[-1]) == (X[0], X[-1])
    assert abs(first[-1] - X[299_999]) < 180.0 / COLUMNS and abs(second[0] - X[600_000]) < 180.0 / COLUMNS
    assert np.nanmin(low) >= -1.0 and np.nanmax(high) <= 1.0 and np.all(low <= high)
    assert bands(X[:1000], QUIET[:1000]) == [] == bands(X[:0], QUIET[:0])


def test_every_column_reaches_as_far_as_with_all_points() -> None:
    y = QUIET + 0.3 * np.random.default_rng(8).standard_normal(MILLION)
    x, kept = reduced(X, y)

    def reaches(t: np.ndarray, values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        begins = np.searchsorted(t, np.linspace(0.0, 180.0, COLUMNS + 1)[:-1] + 1e-12)
        return np.minimum.reduceat(values, begins), np.maximum.reduceat(values, begins)

    for whole, thin in zip(reaches(X, y), reaches(x, kept), strict=True):
        assert np.array_equal(whole, thin)


def test_gaps_stay_gaps_and_short_curves_stay_whole() -> None:
    y = QUIET.copy()
    y[300_000:300_003] = np.nan
    x, kept = reduced(X, y)
    gap = np.flatnonzero(np.isnan(kept))
    assert len(gap) and X[300_000] in x[gap]
    assert X[299_999] in x and X[300_003] in x
    few = reduced(X[:1000], QUIET[:1000])
    assert few[0] is not None and len(few[0]) == 1000


def test_an_impact_keeps_both_its_velocities() -> None:
    x = np.sort(np.concatenate((X, [90.0, 90.0])))
    y = np.where(x < 90.0, 1.0, 2.0)
    first = int(np.searchsorted(x, 90.0))
    y[first] = 1.0
    kept_x, kept = reduced(x, y)
    assert {1.0, 2.0} <= set(kept[kept_x == 90.0].tolist())


def test_a_closed_curve_keeps_every_dot_it_visits() -> None:
    angle = np.linspace(0.0, 2000.0, MILLION)
    x, y = np.cos(angle), np.sin(angle)
    y[777_777] = 40.0
    kept_x, kept_y = distinct(x, y)
    assert kept_y.max() == 40.0 and len(kept_x) <= MILLION
    still = distinct(np.full(MILLION, 1.0), np.full(MILLION, 2.0))
    assert len(still[0]) <= 2


@pytest.mark.parametrize("count", [0, 1, 2])
def test_nothing_to_thin(count: int) -> None:
    x, y = reduced(X[:count], QUIET[:count])
    assert len(x) == count and len(y) == count


def ticking(period: float, late: float = 0.0, count: int = 80):
    """Beats of a period of its own, every other one late (s)."""
    events = steady_swings(count, 4.7, period=period)
    for k in range(count):
        if k % 10 != 3:  # one in ten is not heard
            events.touch((k + 0.5) * 0.5 * period - 4e-3 + late * (k % 2), EventKind.IMPACT, PIN, 1e-9)
    return balance_only(events, count * 0.5 * period)


def test_a_dot_for_each_beat_that_is_heard():
    rate, late = 60.0, 3e-4
    written = tape(ticking(PERIOD / (1.0 + rate / 86400.0), late))
    assert len(written.t) == 71  # of 79 whole half swings
    slope = np.polyfit(written.t[written.forward], written.gain_ms[written.forward], 1)[0]
    assert 86.4 * slope == pytest.approx(rate, rel=1e-3)
    known = np.isfinite(written.rate_s_per_d)
    assert written.rate_s_per_d[known] == pytest.approx(rate, abs=1e-6) and 50 < known.sum() < 60
    assert written.beat_error_ms[np.isfinite(written.beat_error_ms)] == pytest.approx(1e3 * late, abs=1e-9)
    # Two lines, apart by the delay.
    apart = np.interp(written.t, written.t[written.forward], written.gain_ms[written.forward]) - written.gain_ms
    assert apart[~written.forward][1:-1] == pytest.approx(1e3 * late, abs=1e-3)


def test_the_picture_holds_both_traces_and_three_curves():
    run = simulate(swiss(springs_0_rest="1.5°"), 5.0)
    figure = plot_tape(run)
    paper, rate, amplitude, beat_error = figure.axes
    ticks, tocks = (line.get_ydata() for line in paper.get_lines()[:2])
    assert abs(len(ticks) - len(tocks)) <= 1 and np.mean(ticks) - np.mean(tocks) == pytest.approx(0.43, abs=0.01)
    assert "not settled" in figure.texts[-1].get_text()
    assert amplitude.get_lines()[0].get_ydata()[-1] == pytest.approx(275.0, abs=1.5)
    assert rate.get_ylabel() == "rate (s/d)" and beat_error.get_ylabel() == "beat error (ms)"
    few = plot_tape(run, (2.0, 3.0))
    assert sum(len(line.get_xdata()) for line in few.axes[0].get_lines()[:2]) == 8


def test_what_leaves_the_paper_comes_back_on_the_other_side():
    figure = plot_tape(ticking(PERIOD / (1.0 + 100.0 / 86400.0)))
    assert figure.axes[0].get_ylim() != (-0.5 * PAPER, 0.5 * PAPER)
    figure = plot_tape(ticking(PERIOD / (1.0 + 6000.0 / 86400.0)), width=85.0)
    assert figure.axes[0].get_ylim() == (-0.5 * PAPER, 0.5 * PAPER)
    for line in figure.axes[0].get_lines()[:2]:
        assert np.abs(line.get_ydata()).max() <= 0.5 * PAPER
    assert "wrapped" in figure.axes[0].get_title(loc="left")
    assert faults(figure) == []


def test_without_beats_there_is_no_paper():
    with pytest.raises(ValueError, match="no beat of balance is heard"):
        plot_tape(balance_only(steady_swings(20, 4.7), 2.5))
    with pytest.raises(ValueError, match="no beat is heard from 8 s to 9 s"):
        plot_tape(ticking(PERIOD, count=20), (8.0, 9.0))


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
    assert [len(set(looks)) for looks in zip(*ENGINES.values(), strict=True)] == [5, 5, 5]


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


PROFILES = sorted(path.name for path in Path(str(ws.profiles_dir())).iterdir() if (path / "scene.toml").is_file())
WITHOUT_BEATS = {
    "geneva",
    "geneva_stop",
    "cycloidal_pair",
    "incline",
    "involute_pair",
    "balance",
    "cam",
    "jumper",
    "ratchet",
    "snail",
    "winding_click",
    "verge",
    "governor",
}
TWO_PALLETS = {"grasshopper"}  # each a body of its own: which phase a beat is in, no table knows
# s: slow pendulums, and wheels that stand still in every other half swing; a second of all others
DURATION = {"graham": 4.0, "recoil_anchor": 4.0, "pin_wheel": 8.0, "detent": 2.0, "grasshopper": 4.0, "duplex": 2.0}


@pytest.mark.slow
@pytest.mark.parametrize("profile", PROFILES)
def test_nothing_is_clipped(profile: str, caplog: pytest.LogCaptureFixture) -> None:
    scene = ws.load(ws.profiles_dir() / profile)
    run = ws.simulate(scene, duration=DURATION.get(profile, min(1.0, scene.duration)), record="all")
    drawn = set()
    for width in (170.0, 85.0):
        request = Request(run, None, ("angle", "velocity", "acceleration"), None, width)
        for kind in KINDS:
            try:
                figure = request.figure(kind)
            except ValueError:
                continue
            assert width_mm(figure) == pytest.approx(width)
            assert faults(figure) == [], kind
            drawn.add(kind)
    assert caplog.messages == []  # what matplotlib would say to the user
    assert {"kinematics", "phase-portrait", "forces"} <= drawn
    of_beats = {"energy", "timing", "tape"} | ({"phases", "timeline", "torque"} if profile not in TWO_PALLETS else set())
    assert profile in WITHOUT_BEATS or drawn >= of_beats, set(KINDS) - drawn


def test_the_measure_knows_what_is_confused() -> None:
    assert least_difference(("#000000", "#ffffff"), "usual") == pytest.approx(100.0, abs=0.01)
    assert least_difference(("#ff0000", "#ff0000"), "usual") == 0.0
    red_and_green = ("#c04040", "#708030")  # one lightness to a deuteranope
    assert least_difference(red_and_green, "deuteranopia") < 0.5 * least_difference(red_and_green, "usual")


@pytest.mark.parametrize("vision", VISIONS)
def test_colours_of_curves_are_distinct(vision: str) -> None:
    assert least_difference(SERIES, vision) > 15.0
    assert least_difference(dict.fromkeys(PHASE_LINES.values()), vision) > 15.0


PAGE = {"light": "#fffdf9", "dark": "#1c2025"}  # behind the plots of a page


@pytest.mark.parametrize("style", (LIGHT, DARK), ids=lambda style: style.name)
def test_shades_of_phases_are_distinct_and_keep_their_hue(style: Style) -> None:
    own = list(dict.fromkeys(style.phases.values()))
    css = (Path(ws.__file__).parent / "pages" / "assets" / "page.css").read_text()
    on_page = re.findall(r"--b(\d: #\w+);", css.split(f"--card: {PAGE[style.name]}")[1])[:5]
    assert [f"{k}: {colour}" for k, colour in enumerate(own)] == on_page
    second = SECOND if style is LIGHT else to_hex(on_dark(SECOND, face=True))  # of a co-axial, whose beats have two impulses
    for vision, ground in itertools.product(VISIONS, (PAGE[style.name], "#ffffff" if style is LIGHT else style.background)):
        assert least_difference((*own, second, ground), vision) > 8.0
    chips = re.findall(r"--s[0-4]: (#\w+);", css.split(f"--card: {PAGE[style.name]}")[1])[:5]
    again = mixed("#000000", chips[2], 0.7)  # `.s8`
    assert all(least_difference((*chips, again, PAGE[style.name]), vision) > 8.0 for vision in VISIONS)
    for name, shade in (*style.phases.items(), ("impulse", second)):
        (_, a, b), (_, c, d) = lab(linear(shade)), lab(linear(PHASE_LINES[name]))
        assert abs(math.remainder(math.atan2(b, a) - math.atan2(d, c), math.tau)) < 0.55, name


def test_a_key_has_every_colour_that_lies_behind_forces() -> None:
    """A Swiss lever has an impulse on the stone and another on the tooth, in two greens."""
    made = ws.plot_forces(ws.simulate("profiles/swiss_lever", 1.0))
    shades = {to_rgba(one.get_facecolor()) for axes in made.axes for one in axes.patches}
    assert len(shades) > 4 and shades <= {to_rgba(one.get_facecolor()) for one in made.artists if isinstance(one, Patch)}
    assert {"impulse on stone", "impulse on tooth"} <= {one.get_text() for one in made.texts}
    recoiling = ws.plot_forces(ws.simulate("profiles/grasshopper", 3.0))
    assert {"impulse", "recoil"} <= {one.get_text() for one in recoiling.texts}


@pytest.mark.parametrize("vision", VISIONS)
@pytest.mark.parametrize("profile", ["swiss_lever", "bench_lever", "coaxial", "graham", "geneva"])
def test_parts_in_one_panel_are_distinct(profile: str, vision: str) -> None:
    scene = ws.load(ws.profiles_dir() / profile)
    worn = looks(scene)
    moving = [worn[body.name].line for body in scene.bodies if body.motion != "fixed"]
    assert least_difference(moving, vision) > 15.0


GROUND = to_rgb(DARK.background)


@pytest.mark.parametrize(
    ("one", "other", "expected"), [("white", "black", 21.0), ("#777777", "white", 4.48), ("red", "red", 1.0)]
)
def test_contrast_is_that_of_the_guidelines(one, other, expected):
    assert contrast(to_rgb(one), to_rgb(other)) == pytest.approx(expected, abs=0.005)


def test_every_word_and_curve_of_a_plot_can_be_read():
    made = plot_kinematics(watch_run())
    shown = made.axes[0].lines[0]
    axes = made.add_axes((0.8, 0.8, 0.1, 0.1))
    lines = [axes.plot([0, 1], [k, k + 1], color=colour)[0] for k, colour in enumerate((*SERIES, "#222222", "navy", "#777777"))]
    key(axes, [(line, "a curve") for line in lines])
    axes.annotate("here", (0.5, 0.5), (0.1, 0.1), color="darkred", arrowprops={"arrowstyle": "-", "color": "darkred"})
    before = len(made.findobj())
    assert dark(made) is made and len(made.findobj()) == before
    words = [one for one in made.findobj(Text) if one.get_text() and one.get_visible()]
    ruled = {id(line) for one in made.axes for axis in (one.xaxis, one.yaxis) for line in axis.get_gridlines()}
    curves = [one for one in made.findobj(Line2D) if len(one.get_xdata()) > 1 and id(one) not in ruled]
    assert len(words) > 10 and shown in curves
    for one in (*words, *curves):
        assert contrast(to_rgb(one.get_color()), GROUND) >= 4.45, one
    arrow = axes.texts[-1].arrow_patch
    assert contrast(arrow.get_edgecolor()[:3], GROUND) >= 4.45
    pixels = np.asarray(made.canvas.buffer_rgba()) if made.canvas.draw() is None else None
    assert pixels is not None and tuple(pixels[0, 0, :3]) == tuple(round(255 * part) for part in GROUND)


def test_parts_keep_what_they_wear_and_what_is_clear_stays_clear():
    for look in (BRASS, STEEL, RUBY):
        assert on_dark(look.fill, face=True) == to_rgba(look.fill)
    made = figure()
    axes = made.subplots()
    (clear,) = axes.bar([0.0], [1.0], color="none", edgecolor=INK)
    (plain,) = axes.bar([1.0], [1.0], color=BRASS.fill, edgecolor="none", alpha=0.8)
    dark(made)
    assert clear.get_facecolor()[3] == 0.0 and clear.get_edgecolor() == to_rgba(DARK.ink)
    assert plain.get_facecolor() == to_rgba(BRASS.fill, 0.8)


STYLES = (LIGHT, DARK)
READ, SEEN, PALE_SEEN = 4.5, 3.0, 1.25  # contrasts: of words and of marks as WCAG 2.2 asks for; of what is meant to recede


def luminance(colour: str) -> float:
    """Relative luminance (WCAG 2.2)."""
    parts = [value / 12.92 if value <= 0.04045 else ((value + 0.055) / 1.055) ** 2.4 for value in to_rgb(colour)]
    return float(np.dot(parts, (0.2126, 0.7152, 0.0722)))


def contrast_grounds(one: str, other: str) -> float:
    low, high = sorted((luminance(one), luminance(other)))
    return (high + 0.05) / (low + 0.05)


@pytest.mark.parametrize("style", STYLES, ids=lambda style: style.name)
def test_words_and_marks_stand_out(style: Style) -> None:
    assert contrast_grounds("#000000", "#ffffff") == pytest.approx(21.0)
    for words in (style.ink, style.faint):
        assert contrast_grounds(words, style.background) >= READ
    for mark in (style.contact, style.force, style.line(FIXED), *(style.curve(look) for look in OTHERS)):
        assert contrast_grounds(mark, style.background) >= SEEN, mark
    for shade in style.phases.values():
        assert contrast_grounds(style.curve(BLUED), shade) >= SEEN  # a curve over it
        assert contrast_grounds(style.ink, shade) >= READ


@pytest.mark.parametrize("style", STYLES, ids=lambda style: style.name)
def test_parts_are_seen_by_face_or_by_edge(style: Style) -> None:
    for look in (BRASS, STEEL, RUBY, BLUED, NIGHT, FIXED, *OTHERS):
        assert max(contrast_grounds(look.fill, style.background), contrast_grounds(look.edge, style.background)) >= SEEN, look


@pytest.mark.parametrize("style", STYLES, ids=lambda style: style.name)
def test_what_cannot_touch_recedes_and_is_still_seen(style: Style) -> None:
    pale = style.worn(type(BRASS)(BRASS.fill, BRASS.edge, BRASS.line, pale=True))
    assert (
        PALE_SEEN
        <= contrast_grounds(pale.fill, style.background)
        < contrast_grounds(BRASS.edge if style is LIGHT else BRASS.fill, style.background)
    )
    assert style.worn(BRASS) is BRASS


def test_fixed_parts_are_unlike_all_that_move() -> None:
    for look in {BRASS, STEEL, RUBY, BLUED, NIGHT, *OTHERS}:
        apart = np.abs(np.array(to_rgb(look.fill)) - np.array(to_rgb(FIXED.fill))).max()
        assert apart > 0.15, look
    for one, other in combinations(OTHERS, 2):
        assert one.fill != other.fill


def test_a_frame_on_dark_ground_has_the_same_parts_in_the_same_places() -> None:
    run = watch_run()
    light, dark = (frame(run, 0.7, (640, 360), dark=on) for on in (False, True))
    for colour in (BRASS.fill, RUBY.fill, FIXED.fill):
        wanted = np.round(255 * np.array(to_rgb(colour)))
        one, other = (np.all(picture == wanted, axis=2) for picture in (light, dark))
        assert one.sum() > 20 and np.sum(one != other) <= 0.01 * one.sum()  # edges may mix to the very colour
    for picture, style in ((light, LIGHT), (dark, DARK)):
        assert np.all(picture[0, 0] == np.round(255 * np.array(to_rgb(style.background))))


def test_mixing_goes_from_one_colour_to_the_other() -> None:
    assert mixed("#102030", "#ffffff", 0.0) == "#102030" and mixed("#102030", "#fefefe", 1.0) == "#fefefe"
    assert mixed("#000000", "#ffffff", 0.5) == "#808080"


@pytest.mark.parametrize("columns", [1, 7, 100])
def test_every_column_keeps_its_first_last_least_and_largest(columns: int) -> None:
    """Columns divide the whole width evenly: by plain counting, one column after the other."""
    x = np.arange(40.0 * columns)
    y = np.random.default_rng(3).standard_normal(len(x))
    kept = set(reduced(x, y, columns)[0].tolist())
    place = np.minimum(np.floor(columns * x / x[-1]), columns - 1)
    expected = set()
    for k in range(columns):
        own = np.flatnonzero(place == k)
        expected |= {float(i) for i in (own[0], own[-1], own[np.argmin(y[own])], own[np.argmax(y[own])])}
    assert kept == expected
    assert [len(low) for _, low, _ in bands(x, y, columns)] == [columns]


@pytest.mark.parametrize("most", [4, 5, 9])
@pytest.mark.parametrize("across", [0.3, 4.0, 15.0, 31.0, 44.0, 76.0, 130.0, 300.0, 560.0, 900.0, 5736.0, 28800.0, 1e6])
def test_numbers_of_angles_are_parts_of_a_turn(across: float, most: int) -> None:
    axes = figure().add_subplot()
    axes.set_ylim(-0.37 * across, 0.63 * across)
    ticks(axes.yaxis, most, angle=True)
    places = np.array([place for place in axes.get_yticks() if -0.37 * across <= place <= 0.63 * across])
    step = places[1] - places[0]
    assert 2 <= len(places) <= most + 1 and np.allclose(np.remainder(places / step + 0.5, 1.0), 0.5)
    decimal = np.isclose(step / 10.0 ** np.floor(np.log10(step * 1.0001)), (1.0, 2.0, 5.0)).any()
    divides = np.isclose(360.0 / step, round(360.0 / step)) and step >= 10.0
    turns = np.isclose(step / 360.0 % 1.0, 0.0)
    assert (decimal and step <= 10.0) or divides or turns, step
