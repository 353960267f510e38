"""How does the mechanism stand at the key instants of a beat, and when are they?

plot_timeline(run).savefig("timeline.pdf")
"""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from watchsim.analysis.forces import absolute, forces
from watchsim.analysis.timeline import Beat, shown_beats
from watchsim.analysis.timeline import title as phase_title
from watchsim.mechanism.compile import compile_scene
from watchsim.render import style
from watchsim.render.palette import FAINT, FORCE, INK, looks
from watchsim.render.parts import Posed, loops_of, outline
from watchsim.render.phase_bands import AFTER, around, beat_name, shade, spread
from watchsim.render.view import dense, placed, poses
from watchsim.scene.roles import hinged_pallets, with_anchor
from watchsim.simulation.trajectory import Array, Trajectory

MANY = 2  # beats
ACROSS = {True: 7, False: 4}  # pictures in a row: on a page, in a column
LINE = style.LEAD * style.SMALL * style.POINT  # mm, of a caption
GAP, TITLE, WORDS, CURVES, LEADS, FOOT, LEFT = 1.2, 5.0, 7.0, 20.0, 5.0, 9.0, 12.0  # mm
ROOM = 0.12  # of the lever's size, around it
TALLEST = 1.35  # of a picture's width
ARROW = 0.30  # of a picture's width: the largest force
SHORTEST = 0.025  # of it: a shorter arrow would be all head
END = "at rest"


@dataclass(frozen=True)
class Instant:
    """A time (s) with what happens then."""

    t: float
    words: str


def plot_timeline(
    run: Trajectory, window: Sequence[float] | None = None, width: float = style.FULL, beats: list[Beat] | None = None
) -> Figure:
    """The last two beats of a window: the mechanism around the lever amid each phase, with the contact forces on the lever,
    above the angles of lever and balance in those phases.

    ValueError where no beat was recorded whole.
    """
    beats_shown = (beats or shown_beats(run, window, rubbed=False))[-MANY:]
    across = ACROSS[width >= style.NARROW]
    instants = [key_instants(beat) for beat in beats_shown]
    box = _box(run, [one.t for own in instants for one in own])
    wide = (width - 2.0 * style.EDGE - (across - 1) * GAP) / across
    tall = wide * min((box[3] - box[2]) / (box[1] - box[0]), TALLEST)
    rows = [-(-len(one) // across) for one in instants]
    heights = [TITLE + count * (tall + WORDS) + LEADS + CURVES + FOOT for count in rows]
    made = style.figure(width, style.HEADING + sum(heights))
    style.heading(made, run.scene.title, f"Amid each phase; arrows: contact forces on the {' and '.join(_pushed_bodies(run))}")
    posed = Posed(run.scene, compile_scene(run.scene))
    pushed = _pushed(run, [one for own in instants for one in own])
    largest = max((float(np.hypot(*force.T).max(initial=0.0)) for _, force in pushed), default=0.0)
    longest = ARROW * (box[1] - box[0]) / largest if largest > 0.0 else 0.0
    arrows = iter([(points, longest * force) for points, force in pushed])
    top = style.HEADING
    for beat, own, count, height in zip(beats_shown, instants, rows, heights, strict=True):
        words = f"{beat_name(beat)}, {beat.first} at {beat.start:.6g} s"
        _words(made, style.EDGE, top + 0.5 * TITLE - 1.0, words, weight="bold")
        under = top + TITLE + count * (tall + WORDS)
        _pictures(made, (run, posed), [(one, *next(arrows)) for one in own], (top + TITLE, wide, tall), box, across)
        _curves(made, run, beat, own, under + LEADS)
        top += height
    return made


def key_instants(beat: Beat) -> list[Instant]:
    """The middle of every phase of a beat, and the rest that follows."""
    shown = [stage for stage in beat.stages if stage.name != "locked"]
    found = [Instant(0.5 * (stage.phase.start + stage.phase.end), phase_title(stage)) for stage in shown]
    way = shown[-1].phase.end - shown[0].phase.start
    return [*found, Instant(min(shown[-1].phase.end + AFTER * way, max(beat.end, shown[-1].phase.end)), END)]


def _pushed_bodies(run: Trajectory) -> tuple[str, ...]:
    """The lever or anchor, or the pallets that are hinged on the oscillator."""
    return hinged_pallets(run.scene) or (str(with_anchor(run.scene).lever),)


def _box(run: Trajectory, times: Sequence[float]) -> tuple[float, float, float, float]:
    """Least and largest x, least and largest y (mm) of what can touch of the lever at the start, with room around it.

    Of a balance or pendulum that the wheel touches itself at `times` (s), since it turns further.
    """
    parts = with_anchor(run.scene)
    instants = np.array(times) if parts.lever == parts.oscillator else run.t[:1]
    found, close = [], 1e-3 * max(compile_scene(run.scene).size, 1e-9)
    for name in _pushed_bodies(run):
        body = run.scene.body(name)
        found.append(placed(outline(body.loops or loops_of(body), close), poses(run, instants)[name]).reshape(-1, 2))
    x, y = np.concatenate(found).T
    side = ROOM * max(np.ptp(x), np.ptp(y))
    return tuple(1e3 * float(v) for v in (x.min() - side, x.max() + side, y.min() - side, y.max() + side))  # type: ignore[return-value]


def _pictures(
    made: Figure,
    drawn: tuple[Trajectory, Posed],
    shown: list[tuple[Instant, Array, Array]],
    place: tuple[float, float, float],
    box: tuple[float, float, float, float],
    across: int,
) -> None:
    """A row of pictures, or two, each with what happens."""
    run, posed = drawn
    top, wide, tall = place
    scale = max((box[1] - box[0]) / wide, (box[3] - box[2]) / tall)  # the same both ways, and all of the box in sight
    for k, (one, points, force) in enumerate(shown):
        left, up = style.EDGE + (k % across) * (wide + GAP), top + (k // across) * (tall + WORDS)
        axes = style.panel(made, left, up, wide, tall)
        axes.set_xlim(*_spread(box[0], box[1], scale * wide))
        axes.set_ylim(*_spread(box[2], box[3], scale * tall))
        axes.set_xticks([])
        axes.set_yticks([])
        axes.spines[:].set_color(FAINT)
        axes.spines[:].set_linewidth(style.HAIR)
        posed.draw(axes, absolute(posed.compiled, run.at(one.t)[0][None], False)[0])
        _arrows(axes, points, force)
        letters = max(int(wide / (style.LETTER * style.SMALL * style.POINT)), 10)
        for i, line in enumerate(textwrap.wrap(f"{k + 1} {one.words}", letters)[:2]):
            _words(made, left, up + tall + (i + 0.5) * LINE + 0.4, line)


def _spread(low: float, high: float, length: float) -> tuple[float, float]:
    """A stretch of that length about the same middle."""
    return 0.5 * (low + high - length), 0.5 * (low + high + length)


def _arrows(axes: Axes, points: Array, arrows: Array) -> None:
    """Forces in the picture's mm, their tips where they press."""
    head = "-|>,head_length=0.25,head_width=0.12"
    look: dict[str, Any] = {"arrowstyle": head, "color": FORCE, "linewidth": 1.0, "shrinkA": 0, "shrinkB": 0}
    for (x, y), (dx, dy) in zip(points, arrows, strict=True):
        if np.hypot(dx, dy) < SHORTEST * abs(np.subtract(*axes.get_xlim())):
            continue
        arrow = axes.annotate("", (x, y), (x - dx, y - dy), arrowprops=look, zorder=6, annotation_clip=True)
        if arrow.arrow_patch is not None:
            arrow.arrow_patch.set_clip_path(axes.patch)


def _pushed(run: Trajectory, instants: list[Instant]) -> list[tuple[Array, Array]]:
    """Where contacts press on the lever (mm) and how (N)."""
    names = _pushed_bodies(run)
    try:
        found = forces(run, [one.t for one in instants])
    except ValueError:
        return [(np.zeros((0, 2)), np.zeros((0, 2)))] * len(instants)
    across = np.stack((-found.direction[..., 1], found.direction[..., 0]), axis=-1)
    whole = found.normal[..., None] * found.direction + found.tangential[..., None] * across
    pairs = [run.pairs[int(contact)] for contact in found.pairs]
    # Forces are given for the first body of a pair.
    sides = np.array([float(one.body_a in names) - float(one.body_b in names) for one in pairs]).reshape(-1)
    held = np.isfinite(found.point[..., 0]) & (sides != 0.0)
    return [(1e3 * found.point[k, own], sides[own, None] * whole[k, own]) for k, own in enumerate(held)]


def _curves(made: Figure, run: Trajectory, beat: Beat, instants: list[Instant], top: float) -> None:
    """Angles of lever and balance (of an anchor and its wheel) with the phases shaded, and a number above each instant."""
    width = style.size_mm(made)[0]
    parts, worn = with_anchor(run.scene), looks(run.scene)
    wide = width - 2.0 * LEFT
    axes = style.panel(made, LEFT, top, wide, CURVES)
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
        own.set_ylabel(f"{name} (°)", color=worn[name].line, labelpad=1.5)
        style.ticks(own.yaxis, 4, [1, 2, 3, 5, 10])
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
        thin: dict[str, Any] = {"transform": axes.transAxes, "color": FAINT, "linewidth": style.HAIR, "clip_on": False}
        axes.plot((share, up), (1.0, 1.0 + 2.4 / CURVES), **thin)
        look: dict[str, Any] = {"ha": "center", "va": "bottom", "fontsize": style.SMALL, "color": INK}
        axes.text(up, 1.0 + 2.7 / CURVES, str(k + 1), transform=axes.transAxes, **look)


def _words(made: Figure, left: float, down: float, words: str, weight: str = "normal") -> None:
    """A line of text at a place in mm from the upper left corner."""
    width, height = style.size_mm(made)
    made.text(left / width, 1.0 - down / height, words, fontsize=style.SMALL, va="center", color=INK, weight=weight)
