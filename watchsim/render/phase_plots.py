"""How are the phases of a beat shown: bands behind the curves, their names, and the mechanism at their key instants?

plot_phases(run).savefig("phases.pdf") draws wheel, lever and balance through the phases: angles and angular velocities.
plot_timeline(run).savefig("timeline.pdf") draws the mechanism during each phase, over the angles of lever and balance.
"""

from __future__ import annotations

import math
import textwrap
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from watchsim.analysis.forces import absolute, forces
from watchsim.analysis.phases import Phase
from watchsim.analysis.timeline import Beat, Stage, shown_beats, title
from watchsim.mechanism.compile import compile_scene
from watchsim.render import style
from watchsim.render.marks import round_below, spaced
from watchsim.render.palette import ELSE, FAINT, FORCE, INK, PHASE_LINES, PHASES, SECOND, looks
from watchsim.render.parts import Posed, loops_of, outline
from watchsim.render.view import Window, dense, placed, poses
from watchsim.scene.roles import hinged_pallets, partners, with_anchor
from watchsim.simulation.trajectory import Array, Trajectory
from watchsim.units import metric

SWATCH, AFTER_SWATCH, APART = 2.6, 1.0, 3.5  # mm; from one name to the next swatch
AGAIN = "second impulse"  # of a beat


def bands(phases: Iterable[Phase]) -> list[tuple[Phase, str]]:
    """The phases of one beat that are shaded, each with its colour."""
    found, impulses = [], 0
    for phase in phases:
        if phase.name == "locked":
            continue
        impulses += phase.name == "impulse"
        found.append((phase, shade_of(AGAIN if phase.name == "impulse" and impulses == 2 else phase.name)))
    return found


def shade_of(name: str) -> str:
    """The colour of a phase where it is a band."""
    return SECOND if name == AGAIN else PHASES.get(name, ELSE)


def strong(name: str) -> str:
    """The colour of a phase where it is a curve."""
    return PHASE_LINES.get(name, FAINT)


def names_in(beats: Iterable[Sequence[Phase]], banded: bool = True) -> dict[str, str]:
    """The phases that last, by the names of their colours, in the order of a beat; each with its words in a key.

    banded  an impulse that follows another has its own colour, and where its words are the same in all beats they say on what
    """
    words: dict[str, set[str]] = {}
    for beat in beats:
        impulses = 0
        for phase in beat:
            impulses += phase.name == "impulse"
            if phase.name == "locked" or not phase.end > phase.start:
                continue
            name = AGAIN if banded and phase.name == "impulse" and impulses == 2 else phase.name
            words.setdefault(name, set()).add(f"{phase.name} on {phase.on}" if banded and phase.on else name)
    found = {name: min(said) if len(said) == 1 else name for name, said in words.items()}
    order = [one for name in PHASES for one in ((name, AGAIN) if name == "impulse" else (name,))]
    return {name: found[name] for name in (*order, *found) if name in found}


def beat_name(beat: Beat) -> str:
    """Its number and what is unlocked in it."""
    return f"beat {beat.stages[0].beat}{f', {beat.pallet}' if beat.pallet else ''}"


def shade(axes: Axes, phases: Iterable[Phase], zero: float = 0.0, factor: float = 1e3, grey: bool = False) -> None:
    """A band for each phase of one beat, at (time - zero)·factor; the limits of the axes stay as they are."""
    place = axes.get_xaxis_transform(which="grid")
    for phase, colour in bands(phases):
        start, end = factor * (phase.start - zero), factor * (phase.end - zero)
        shown = "#dddddd" if grey else colour
        axes.add_artist(Rectangle((start, 0.0), end - start, 1.0, color=shown, linewidth=0.0, zorder=0, transform=place))


def name_above(axes: Axes, stages: Sequence[Stage], zero: float) -> None:
    """Names above the panel, spread where phases are short, with a line to the middle of each."""
    low, high = axes.get_xlim()
    shown = _lasting(stages)
    middles = [500.0 * (stage.phase.start + stage.phase.end - 2.0 * zero) for stage in shown]
    wide, tall = style.width_mm(axes), style.height_mm(axes)
    places = spread(middles, 4.2 * (high - low) / wide)
    for stage, middle, place in zip(shown, middles, places, strict=True):
        where, top = (middle - low) / (high - low), (place - low) / (high - low)
        lead(axes, where, top, 2.6 / tall, zorder=1)
        style.words(axes, top, 1.0 + 3.0 / tall, title(stage), rotation=90.0, ha="center", va="bottom")


def lead(axes: Axes, place: float, top: float, height: float, zorder: float = 2) -> None:
    """A thin line from a place on the upper edge of a panel to what stands above it; in shares of the panel."""
    thin: dict[str, Any] = {"transform": axes.transAxes, "clip_on": False, "zorder": zorder}
    axes.plot((place, top), (1.0, 1.0 + height), color=FAINT, linewidth=style.HAIR, **thin)


def name_key(figure: Figure, names: Mapping[str, str], top: float, lines: bool = False) -> float:
    """Swatches with words (`names_in`) from the upper left on, `top` mm below the upper edge; where they end, mm."""
    wide, high = style.size_mm(figure)
    row = style.LEAD * style.SMALL * style.POINT
    x, y = style.EDGE, top + 0.5 * row
    for name, words in names.items():
        own = SWATCH + AFTER_SWATCH + style.LETTER * style.SMALL * style.POINT * len(words)
        if x > style.EDGE and x + own > wide - style.EDGE:
            x, y = style.EDGE, y + 1.15 * row
        tall = 0.7 if lines else 0.7 * row
        colour = strong(name) if lines else shade_of(name)
        place, size = (x / wide, 1.0 - (y + 0.5 * tall) / high), (SWATCH / wide, tall / high)
        figure.add_artist(Rectangle(place, *size, color=colour, linewidth=0.0, transform=figure.transSubfigure))
        figure.text(
            (x + SWATCH + AFTER_SWATCH) / wide, 1.0 - y / high, words, fontsize=style.SMALL, va="center_baseline", color=INK
        )
        x += own + APART
    return y + 0.5 * row


def spread(places: Sequence[float], least: float) -> list[float]:
    """The places moved apart to a least distance, as a whole as little as possible."""
    moved = list(places)
    for _ in range(200):
        worst = 0.0
        for k in range(len(moved) - 1):
            lack = least - (moved[k + 1] - moved[k])
            if lack > 1e-12 * least:
                moved[k], moved[k + 1] = moved[k] - 0.5 * lack, moved[k + 1] + 0.5 * lack
                worst = max(worst, lack)
        if not worst > 1e-3 * least:
            break
    return moved if all(math.isfinite(place) for place in moved) else list(places)


PANEL, TOP, FOOT, LEFT, RIGHT, BETWEEN = 25.0, 14.5, 3.0, 13.5, 3.0, 11.0  # mm; above the panels the longest name is added
LABEL_AT = 10.5  # mm, of the label left of its panel
KILO = 1e3  # °/s: faster bodies have their velocity in thousands
BEFORE, AFTER = 0.08, 0.12  # of a beat's phases: what is shown besides
MANY = 2  # beats that are drawn one by one


def plot_phases(
    run: Trajectory,
    window: Sequence[float] | None = None,
    width: float = style.FULL,
    beats: list[Beat] | None = None,
    ax: Axes | None = None,
) -> Figure:
    """A figure `width` mm wide: left the whole window (s; default the last oscillation), then its last two beats at large.

    In a single column of text (less than 120 mm) only the beats. ValueError where no beat was recorded whole.
    """
    beats = beats or shown_beats(run, window, rubbed=False)
    span = (beats[0].start, beats[-1].end) if window is None else (float(window[0]), float(window[1]))
    span = (max(span[0], float(run.t[0])), min(span[1], float(run.t[-1])))
    columns = [*([None] if width >= style.NARROW else []), *beats[-MANY:]]
    parts = with_anchor(run.scene)
    names = list(dict.fromkeys(name for name in (parts.wheel, parts.lever, parts.oscillator) if name))
    rows = 2 * len(names)
    longest = max((len(title(stage)) for beat in beats[-MANY:] for stage in beat.stages if stage.name != "locked"), default=0)
    top = TOP + style.LETTER * style.SMALL * style.POINT * longest
    made = style.figure(width, top + rows * PANEL + FOOT, ax=ax)
    style.heading(made, run.scene.title, f"t = {span[0]:.4f} s to {span[1]:.4f} s")
    wide = (width - LEFT - RIGHT - (len(columns) - 1) * BETWEEN) / len(columns)
    for c, beat in enumerate(columns):
        left = LEFT + c * (wide + BETWEEN)
        panels = [style.panel(made, left, top + r * PANEL - 1.5, wide, PANEL - 5.0) for r in range(rows)]
        _column(panels, run, names, span if beat is None else around(beat, run), beat, beats, first=c == 0)
    return made


def around(beat: Beat, run: Trajectory) -> Window:
    """The beat without its free oscillation, and a little more."""
    end = max((stage.phase.end for stage in beat.stages if stage.name != "locked"), default=beat.end)
    way = end - beat.start
    return max(beat.start - BEFORE * way, float(run.t[0])), min(end + AFTER * way, float(run.t[-1]))


def _column(
    panels: list[Axes], run: Trajectory, names: list[str], span: Window, beat: Beat | None, beats: list[Beat], first: bool
) -> None:
    """Angle and velocity of each body over one stretch of time."""
    t, q, u, _ = dense(run, span)
    zero = span[0] if beat is None else beat.start
    x, shown = 1e3 * (t - zero), slice(*np.searchsorted(run.t, (beats[0].start, beats[-1].end)).tolist())
    worn = looks(run.scene)
    for k, name in enumerate(names):
        column, colour = run.slices[name].start, worn[name].line
        fast = bool(np.degrees(np.abs(run.u[shown, column]).max()) >= KILO)  # the same in all columns
        for axes, values, unit in (
            (panels[2 * k], np.degrees(q[:, column]), "°"),
            (panels[2 * k + 1], np.degrees(u[:, column]) / (KILO if fast else 1.0), f"{'1000 ' * fast}°/s"),
        ):
            axes.plot(x, values, color=colour, linewidth=style.CURVE, solid_joinstyle="round", zorder=3)
            axes.set_xlim(1e3 * (span[0] - zero), 1e3 * (span[1] - zero))
            style.dress(axes)
            style.limits(axes, float(values.min()), float(values.max()), 0.1)
            style.ticks(axes.xaxis, 5)
            style.ticks(axes.yaxis, 4, angle=unit == "°")
            axes.ticklabel_format(useOffset=False)
            axes.tick_params(labelsize=style.SMALL)
            if first:
                axes.set_ylabel(f"{spaced(name)} ({unit})", fontsize=style.SMALL, color=colour, weight="bold")
                axes.yaxis.set_label_coords(-LABEL_AT / style.width_mm(axes), 0.5)
    for axes in panels:
        for one in beats if beat is None else [beat]:
            shade(axes, (stage.phase for stage in one.stages), zero, grey=beat is None)
    for axes in panels[:-1]:
        axes.set_xticklabels([])
    # A detent's one stone need not be told from another.
    pallet = f", {beat.pallet}" if beat is not None and beat.pallet.startswith(("entry", "exit")) else ""
    words = f"ms after t = {zero:.4f} s" if beat is None else f"ms from {beat.first.removeprefix('beginning of the ')}{pallet}"
    panels[-1].set_xlabel(words, fontsize=style.SMALL, labelpad=1.5)
    if beat is not None:
        name_above(panels[0], beat.stages, zero)


ACROSS = {True: 7, False: 4}  # pictures in a row at most: on a page, in a column
LINE = style.LEAD * style.SMALL * style.POINT  # mm, of a caption
GAP, TITLE, WORDS, CURVES, LEADS, TIME, ANGLES = 1.2, 5.0, 7.0, 20.0, 5.0, 9.0, 12.0  # mm
ROOM = 0.12  # of the lever's size, around it
TALLEST, HIGHEST = 1.35, 45.0  # of a picture's width, and mm
ARROW = 0.30  # of a picture's width: the largest force
SHORTEST = 0.025  # of it: a shorter arrow would be all head
ARROWS: dict[str, Any] = {
    "arrowstyle": "-|>,head_length=0.25,head_width=0.12", "color": FORCE, "linewidth": 1.0, "shrinkA": 0, "shrinkB": 0
}  # fmt: skip


@dataclass(frozen=True)
class Instant:
    """A time (s) with what happens then."""

    t: float
    words: str


def plot_timeline(
    run: Trajectory,
    window: Sequence[float] | None = None,
    width: float = style.FULL,
    beats: list[Beat] | None = None,
    ax: Axes | None = None,
) -> Figure:
    """The last two beats of a window: the mechanism around the lever during each phase, with the contact forces on the lever,
    above the angles of lever and balance in those phases.

    ValueError where no beat was recorded whole.
    """
    beats_shown = (beats or shown_beats(run, window, rubbed=False))[-MANY:]
    instants = [key_instants(beat) for beat in beats_shown]
    most = max(map(len, instants))
    across = -(-most // -(-most // ACROSS[width >= style.NARROW]))  # rows of the same length: the pictures are larger
    around = _box(run, [one.t for own in instants for one in own])
    pushed = _pushed(run, [one for own in instants for one in own])
    largest = max((float(np.hypot(*force.T).max(initial=0.0)) for _, force in pushed), default=0.0)
    longest = ARROW * (around[1] - around[0]) / largest if largest > 0.0 else 0.0
    arrows = [(points, longest * force) for points, force in pushed]
    box = _with_arrows(around, arrows)
    wide = (width - 2.0 * style.EDGE - (across - 1) * GAP) / across
    tall = min(wide * min((box[3] - box[2]) / (box[1] - box[0]), TALLEST), HIGHEST)
    rows = [-(-len(one) // across) for one in instants]
    heights = [TITLE + count * (tall + WORDS) + LEADS + CURVES + TIME for count in rows]
    made = style.figure(width, style.HEADING + sum(heights), ax=ax)
    bodies = " and ".join(_pushed_bodies(run))
    wide_enough = width >= style.NARROW
    about = f"In the middle of each phase; arrows: contact forces on {bodies}" if wide_enough else f"Forces on {bodies}"
    style.heading(made, run.scene.title, about)
    posed = Posed(run.scene, compile_scene(run.scene))
    drawn, top = iter(arrows), style.HEADING
    for beat, own, count, height in zip(beats_shown, instants, rows, heights, strict=True):
        words = f"{beat_name(beat)}, {beat.first} at {beat.start:.6g} s"
        _words(made, style.EDGE, top + 0.5 * TITLE - 1.0, words, weight="bold")
        under = top + TITLE + count * (tall + WORDS)
        _pictures(made, (run, posed), [(one, *next(drawn)) for one in own], (top + TITLE, wide, tall), box, across)
        _curves(made, run, beat, own, under + LEADS)
        top += height
    if largest > 0.0:
        newtons = round_below(largest)
        _arrow_key(made, newtons, longest * newtons / _scale(box, wide, tall))
    return made


def key_instants(beat: Beat) -> list[Instant]:
    """The middle of every phase of a beat that lasts, and the rest that follows; a recoil ends with the next impulse."""
    shown = _lasting(beat.stages)
    found = [Instant(0.5 * (stage.phase.start + stage.phase.end), title(stage)) for stage in shown]
    if shown[-1].name == "recoil":
        return found
    way = shown[-1].phase.end - shown[0].phase.start
    return [*found, Instant(min(shown[-1].phase.end + AFTER * way, max(beat.end, shown[-1].phase.end)), "at rest")]


def _lasting(stages: Sequence[Stage]) -> list[Stage]:
    """Those with a length, without the free oscillation: a lever that is on its bank before the lock has no run to it."""
    return [stage for stage in stages if stage.name != "locked" and stage.phase.end > stage.phase.start]


def _pushed_bodies(run: Trajectory) -> tuple[str, ...]:
    """The lever or anchor, with the balance where the wheel pushes that itself; or the pallets hinged on the oscillator.

    Between two of them a force is shown on the first.
    """
    parts = with_anchor(run.scene)
    touched = partners(run.scene, str(parts.wheel))
    return hinged_pallets(run.scene) or (
        str(parts.lever),
        *(name for name in (parts.oscillator,) if name in touched and name != parts.lever),
    )


Box = tuple[float, float, float, float]


def _box(run: Trajectory, times: Sequence[float]) -> Box:
    """Least and largest x, least and largest y (mm) of what can touch of the lever at the start, with room around it.

    Of a balance or pendulum that the wheel touches itself at `times` (s), since it turns further, and of what is carried round.
    """
    parts = with_anchor(run.scene)
    carried = parts.lever is not None and run.scene.body(parts.lever).on is not None
    instants = np.array(times) if carried or parts.lever == parts.oscillator else run.t[:1]
    found, close = [], 1e-3 * max(compile_scene(run.scene).size, 1e-9)
    for name in _pushed_bodies(run):
        body = run.scene.body(name)
        found.append(placed(outline(body.loops or loops_of(body), close), poses(run, instants)[name]).reshape(-1, 2))
    x, y = np.concatenate(found).T
    side = ROOM * max(np.ptp(x), np.ptp(y))
    return tuple(1e3 * float(v) for v in (x.min() - side, x.max() + side, y.min() - side, y.max() + side))  # type: ignore[return-value]


def _with_arrows(box: Box, arrows: Sequence[tuple[Array, Array]]) -> Box:
    """The box with the tails of all arrows in it."""
    tails = np.concatenate([(points - force).reshape(-1, 2) for points, force in arrows])
    if not len(tails):
        return box
    air = ROOM / 3.0 * (box[1] - box[0])
    (left, low), (right, high) = tails.min(axis=0) - air, tails.max(axis=0) + air
    return min(box[0], float(left)), max(box[1], float(right)), min(box[2], float(low)), max(box[3], float(high))


def _scale(box: Box, wide: float, tall: float) -> float:
    """Millimetres of the movement to one of the picture: the same both ways, and all of the box in sight."""
    return max((box[1] - box[0]) / wide, (box[3] - box[2]) / tall)


def _arrow_key(made: Figure, newtons: float, length: float) -> None:
    """Which force an arrow of this length (mm) stands for, at the upper right."""
    width, height = style.size_mm(made)
    axes = style.panel(made, width - style.EDGE - length, 7.0, length, 3.0)
    axes.set_axis_off()
    axes.annotate("", (1.0, 0.5), (0.0, 0.5), arrowprops=ARROWS)
    look: dict[str, Any] = {"fontsize": style.SMALL, "color": INK, "ha": "right", "va": "center"}
    made.text((width - style.EDGE - length - 1.0) / width, 1.0 - 8.5 / height, metric(newtons, "N", 1), **look)


def _pictures(
    made: Figure,
    drawn: tuple[Trajectory, Posed],
    shown: list[tuple[Instant, Array, Array]],
    place: tuple[float, float, float],
    box: Box,
    across: int,
) -> None:
    """A row of pictures, or two, each with what happens."""
    run, posed = drawn
    top, wide, tall = place
    scale = _scale(box, wide, tall)
    for k, (one, points, force) in enumerate(shown):
        left, up = style.EDGE + (k % across) * (wide + GAP), top + (k // across) * (tall + WORDS)
        axes = style.panel(made, left, up, wide, tall)
        for limits, (low, high), length in ((axes.set_xlim, box[:2], wide), (axes.set_ylim, box[2:], tall)):
            limits(0.5 * (low + high - scale * length), 0.5 * (low + high + scale * length))
        axes.set_xticks([])
        axes.set_yticks([])
        axes.spines[:].set_color(FAINT)
        axes.spines[:].set_linewidth(style.HAIR)
        posed.draw(axes, absolute(posed.compiled, run.at(one.t)[0][None], False)[0])
        _arrows(axes, points, force)
        letters = max(int(wide / (style.LETTER * style.SMALL * style.POINT)), 10)
        for i, line in enumerate(textwrap.wrap(f"{k + 1} {one.words}", letters)[:2]):
            _words(made, left, up + tall + (i + 0.5) * LINE + 0.4, line)


def _arrows(axes: Axes, points: Array, arrows: Array) -> None:
    """Forces in the picture's mm, their tips where they press."""
    for point, way in zip(points, arrows, strict=True):
        if np.hypot(*way) < SHORTEST * abs(np.subtract(*axes.get_xlim())):
            continue
        arrow = axes.annotate("", point, point - way, arrowprops=ARROWS, zorder=6, annotation_clip=True)
        if arrow.arrow_patch is not None:
            arrow.arrow_patch.set_clip_path(axes.patch)


def _pushed(run: Trajectory, instants: list[Instant]) -> list[tuple[Array, Array]]:
    """Where contacts press on those bodies (mm) and how (N)."""
    names = _pushed_bodies(run)
    try:
        found = forces(run, [one.t for one in instants])
    except ValueError:
        return [(np.zeros((0, 2)), np.zeros((0, 2)))] * len(instants)
    pairs = [run.pairs[int(contact)] for contact in found.pairs]
    # Forces are given for the first body of a pair.
    rank = {name: len(names) - k for k, name in enumerate(names)}
    sides = np.sign([float(rank.get(one.body_a, 0) - rank.get(one.body_b, 0)) for one in pairs]).reshape(-1)
    held, on_a = np.isfinite(found.point[..., 0]) & (sides != 0.0), found.on_a
    return [(1e3 * found.point[k, own], sides[own, None] * on_a[k, own]) for k, own in enumerate(held)]


def _curves(made: Figure, run: Trajectory, beat: Beat, instants: list[Instant], top: float) -> None:
    """Angles of lever and balance (of an anchor and its wheel) with the phases shaded, and a number above each instant."""
    width = style.size_mm(made)[0]
    parts, worn = with_anchor(run.scene), looks(run.scene)
    wide = width - 2.0 * ANGLES
    axes = style.panel(made, ANGLES, top, wide, CURVES)
    other = axes.twinx()
    span = around(beat, run)
    t, q, _, _ = dense(run, span)
    x = 1e3 * (t - beat.start)
    beside = parts.wheel if parts.lever == parts.oscillator else parts.oscillator
    for own, name in ((axes, parts.lever), (other, beside)):
        assert name is not None
        style.dress(own, grid="x" if own is axes else "none")
        values = np.degrees(q[:, run.slices[name].start])
        own.plot(x, values, color=worn[name].line, linewidth=style.CURVE, gid=f"angle {name}", zorder=3)
        style.limits(own, float(values.min()), float(values.max()))
        own.set_ylabel(f"{spaced(name)} (°)", color=worn[name].line, labelpad=1.5)
        style.ticks(own.yaxis, 4, angle=True)
    other.spines["right"].set_visible(True)
    other.spines["right"].set_color(FAINT)
    other.spines["right"].set_linewidth(style.HAIR)
    shade(axes, (stage.phase for stage in beat.stages), beat.start)
    axes.set_xlim(*(1e3 * (end - beat.start) for end in span))
    axes.set_xlabel(f"time after the {beat.first} (ms)", labelpad=1.5)
    low, high = axes.get_xlim()
    at = [1e3 * (one.t - beat.start) for one in instants]
    for k, (where, moved) in enumerate(zip(at, spread(at, 3.4 * (high - low) / wide), strict=True)):
        share, up = (where - low) / (high - low), (moved - low) / (high - low)
        lead(axes, share, up, 2.4 / CURVES)
        style.words(axes, up, 1.0 + 2.7 / CURVES, str(k + 1), ha="center", va="bottom")


def _words(made: Figure, left: float, down: float, words: str, weight: str = "normal") -> None:
    """A line of text at a place in mm from the upper left corner."""
    width, height = style.size_mm(made)
    made.text(left / width, 1.0 - down / height, words, fontsize=style.SMALL, va="center", color=INK, weight=weight)
