"""What do runs, scenes, beats and studies show of themselves in a notebook, and how is a run played there?

The page of `report` without its sheet and its files, in a frame of its own that may run its scripts and nothing else.
"""

from __future__ import annotations

import io
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from watchsim.analysis.headlines import AVERAGED, with_error
from watchsim.analysis.timing import Averages, Beats, averages, beats, last_window
from watchsim.mechanism.compile import compile_scene
from watchsim.pages.charts import scatter
from watchsim.pages.html import Markup, card, element, image, table
from watchsim.pages.player import shown
from watchsim.pages.report_page import player_text
from watchsim.pages.timing_sheet import both_ways
from watchsim.render.positions_plot import plot_positions
from watchsim.render.stage import Stage, at_rest
from watchsim.render.study_plot import axis_label, output_label, plot_sensitivity, plot_sweep, usual_value
from watchsim.render.style import minus, small_png
from watchsim.render.tolerance_plot import plot_tolerance
from watchsim.render.view import Window, poses
from watchsim.scene.roles import frequency, swings
from watchsim.scene.scene import Scene
from watchsim.simulation.trajectory import Trajectory
from watchsim.studies.cycle import Cycle
from watchsim.studies.fit import Fit
from watchsim.studies.goals import Better
from watchsim.studies.point import OUTPUTS
from watchsim.studies.positions import Positions
from watchsim.studies.sensitivity import Sensitivity
from watchsim.studies.study_report import POSITION_HEAD, poise_words, positions_rows
from watchsim.studies.sweep import Sweep
from watchsim.studies.tolerance_result import ToleranceStudy

ROWS = 12  # of a table; the rest is counted
DOTS_STUDY_CARDS, SHOWN = 560, 420  # of a picture, and how wide it is shown
PRINTED = 85.0  # mm, for which the letters are large enough


def cycle_html(cycle: Cycle) -> str:
    """Verdict, amplitude, rate, beat error and stability."""
    lines = _means(cycle)
    if cycle.multipliers:
        lines.append(f"multiplier {', '.join(f'{value:.4g}' for value in cycle.multipliers)}")
    return card("Limit cycle" if cycle.found else f"No limit cycle: {cycle.verdict}", [*lines, cycle.message])


def sweep_html(sweep: Sweep) -> str:
    """The first rows as a table, and the plot."""
    count = len(sweep.rows)
    lines = [f"{count} {'point' if count == 1 else 'points'}", "" if sweep.whole else "interrupted: points are missing"]
    if not count:
        return card(f"Sweep of {sweep.title}", lines)
    head = [*map(axis_label, sweep.axes), *map(output_label, sweep.outputs), "verdict"]
    rows = []
    for row in sweep.rows[:ROWS]:
        values = (_value(usual_value(axis, row[axis.key]), 6) for axis in sweep.axes)
        rows.append([*values, *(_value(row[one.column], 5) for one in sweep.outputs), row["verdict"] or ""])
    shown = table(head, rows, f"the first {ROWS} of {count} points" if count > ROWS else "")
    try:
        figure = plot_sweep(sweep, PRINTED)
    except ValueError:  # keys without numbers
        return card(f"Sweep of {sweep.title}", lines, shown)
    curves = image(small_png(figure, DOTS_STUDY_CARDS), "The sweep as curves", SHOWN)
    return card(f"Sweep of {sweep.title}", lines, shown, element("div", curves))


def sensitivity_html(found: Sensitivity) -> str:
    """What matters most, and the plot."""
    count, outputs = len(found.effects), found.outputs
    lines = [f"{count} {'quantity' if count == 1 else 'quantities'}", "" if found.whole else "interrupted: some are missing"]
    if not count:
        return card(f"What matters in {found.title}", lines)
    head = ["change", *map(output_label, outputs)]
    rows = []
    for one in found.effects[:ROWS]:
        values = (_value(one.of(output.column, one.quantity.change), 5) for output in outputs)
        rows.append([f"{one.quantity.key} +{one.quantity.change_words}", *values])
    shown = table(head, rows, f"the first {ROWS} of {count} quantities" if count > ROWS else "")
    bars = small_png(plot_sensitivity(found, PRINTED), DOTS_STUDY_CARDS)
    return card(f"What matters in {found.title}", lines, shown, element("div", image(bars, "Effects as bars", SHOWN)))


def tolerancestudy_html(study: ToleranceStudy) -> str:
    """The yield, what the watches do, and the plots."""
    rows = [
        [output_label(output), *(_value(one, 5) for one in (spread.mean, spread.sigma, spread.cpk)), str(spread.count)]
        for output, spread in ((one, study.outputs[one.column]) for one in OUTPUTS.values() if one.column in study.outputs)
    ]
    shown = table(["output", "mean", "σ", "Cpk", "samples"], rows, "what the watches do")
    plots = small_png(plot_tolerance(study, PRINTED), DOTS_STUDY_CARDS)
    return card(
        f"Tolerances of {study.title}", [f"{study.message}."], shown, element("div", image(plots, study.message, SHOWN))
    )


def better_html(found: Better) -> str:
    """What was changed, and what holds it back."""
    rows = [[knob.key, *map(knob.shown, found.keys[knob.key])] for knob in found.knobs if knob.key in found.keys]
    shown = table(["", "old", "new"], rows, "what was changed") if rows else None
    return card(f"{'Better' if found.found else 'No better'} {found.title}", [found.message, *found.active], shown)


def fit_html(found: Fit) -> str:
    """The fitted values with their intervals, and what cannot be distinguished."""
    rows = []
    for knob in found.knobs:
        one = found.keys.get(knob.key)
        if one is not None:
            ends = ("not bounded" if end is None else knob.shown(end) for end in (one.low, one.high))
            rows.append([knob.key, knob.shown(one.old), knob.shown(one.value), *ends])
    shown = (
        table(["", "scene", "fitted", "from", "to"], rows, f"{found.measured.count} readings, 95 % intervals") if rows else None
    )
    return card(f"{found.title}, fitted to {found.measured.name}", [found.message, *found.words], shown)


def positions_html(found: Positions) -> str:
    """What a timing machine shows, the poise error, and the dials."""
    shown = table(("at home", *POSITION_HEAD), positions_rows(found, [found.home]), "just wound, as near to 23 °C as there is")
    dials = small_png(plot_positions(found, PRINTED), DOTS_STUDY_CARDS)
    pictures = element("div", image(dials, "rate and amplitude on dials", SHOWN))
    return card(f"Positions of {found.title}", [f"{poise_words(found)}."], shown, pictures)


def _value(value: float | str | None, digits: int) -> str:
    return "" if value is None else value if isinstance(value, str) else minus(f"{value:.{digits}g}")


SIZE = (560, 315)
COLOURS = 40  # of a picture: a palette makes it small
NAMED = 8  # bodies
DOTS = 120  # of a series of a chart


def scene_html(scene: Scene) -> str:
    """Title, bodies, contacts, frequency, and the mechanism at its start."""
    names = [body.name for body in scene.bodies]
    listed = f"{', '.join(names[:NAMED])}{f' and {len(names) - NAMED} more' if len(names) > NAMED else ''}"
    lines = [
        f"{_count(len(names), 'body', 'bodies')}: {listed}",
        f"{_count(len(scene.contacts), 'contact', 'contacts')} declared",
    ]
    hertz = frequency(scene) if swings(scene) else None
    if hertz:
        lines.append(f"{hertz:.6g} Hz, {7200.0 * hertz:.6g} vph")
    return card(scene.title, lines, _picture(at_rest(scene, compile_scene(scene)), (0.0, 1.0), 0.0))


def trajectory_html(run: Trajectory) -> str:
    """Title, amplitude, rate and beat error, how it ended, and the mechanism at the end."""
    lines = [f"{run.simulated:g} s simulated, {len(run.t)} rows, {len(run.events)} events"]
    if swings(run.scene):
        found = beats(run)
        lines.append(", ".join(_means(averages(found, last_window(run, found.nominal_period)))))
    lines.append(run.stop.sentence)
    try:
        window = shown(run, None)
    except ValueError:  # no rows were kept
        return card(run.scene.title, lines, None)
    return card(run.scene.title, lines, _picture(run, window, window[1]))


def beats_html(found: Beats) -> str:
    """How many, the last of them, and a chart of the amplitude."""
    if len(found) < 3:
        return card(f"Beats of {found.body}", [_count(len(found), "half swing", "half swings")], None)
    unit, scale = ("°", float(np.degrees(1.0))) if found.angular else ("mm", 1e3)
    dots = both_ways(found, found.t, scale * found.amplitude)
    chart = scatter(dots, "time (s)", f"amplitude ({unit})", f"Amplitude of {len(found)} half swings", DOTS)
    return card(f"Beats of {found.body}", repr(found).strip("<>").split(": ", 1)[1].split("; "), chart)


def _means(found: Cycle | Averages) -> list[str]:
    """Amplitude, rate and beat error, each with its error, as far as they are known."""
    lines = []
    for name, label, unit in AVERAGED:
        value, error = getattr(found, name), getattr(found, f"{name}_error")
        if value is not None:
            lines.append(" ".join(filter(None, (label, *with_error(value, error, unit)))))
    return lines


def _count(number: int, one: str, more: str) -> str:
    return f"{number} {one if number == 1 else more}"


def _picture(run: Trajectory, window: Window, t: float) -> Markup | None:
    """The mechanism at the instant `t` (s) as a small PNG; None where there is nothing to draw."""
    from PIL import Image

    frames = {name: rows[0] for name, rows in poses(run, np.array([t])).items()}
    try:
        pixels = Stage(run, SIZE, window).draw(t, frames)[..., :3]
    except ValueError:  # no body has an outline
        return None
    out = io.BytesIO()
    Image.fromarray(np.ascontiguousarray(pixels)).quantize(COLOURS).save(out, "PNG", optimize=True)
    return image(out.getvalue(), f"The mechanism at {t:g} s", SIZE[0] // 4 * 3)


HEIGHT = 640  # dots: picture, buttons, and the first plot


@dataclass(frozen=True)
class Player:
    """A page that plays, as text, and how high it is shown (dots)."""

    title: str
    page: str = field(repr=False)
    height: int = HEIGHT

    def __repr__(self) -> str:
        return f"<Player of {self.title!r}: {len(self.page.encode()) / 1e3:.0f} kB>"

    def _repr_html_(self) -> str:
        look, rights = f"width:100%;height:{self.height}px;border:0", "allow-scripts allow-downloads"
        title = f"Player of {self.title}"
        return element("iframe", srcdoc=self.page, sandbox=rights, title=title, loading="lazy", style=look)


def show(run: Trajectory, window: Sequence[float] | None = None, *, height: int = HEIGHT) -> Player:
    """A player that a notebook shows under its cell: the last beats, or a window (s) of the run.

    ValueError for a window that was not recorded, or that holds too much motion for a page.
    """
    return Player(run.scene.title, player_text(run, window), height)
