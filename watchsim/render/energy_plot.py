"""Where did the energy go, in the whole run and in each phase of a beat, and which torque gives it to the balance?

plot_energy(run).savefig("energy.pdf")
plot_torque(run).savefig("torque.pdf")
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Rectangle

from watchsim.analysis.flows import energy_shares
from watchsim.analysis.forces import absolute, forces, just_before
from watchsim.analysis.timeline import Beat, Stage, shown_beats
from watchsim.analysis.timeline import title as phase_title
from watchsim.mechanism.compile import Compiled, compile_scene
from watchsim.render import style
from watchsim.render.marks import spaced
from watchsim.render.palette import ENERGIES, FAINT, INK
from watchsim.render.phase_plots import bands, beat_name
from watchsim.render.view import recorded
from watchsim.scene.roles import is_driven, keeps_time, roles
from watchsim.scene.trains import Ride, rides
from watchsim.simulation.trajectory import Array, Trajectory, frames
from watchsim.units import metric, signed

LEFT, RIGHT, ROW, OVER, UNDER, KEY = 27.0, 4.0, 5.0, 6.0, 9.0, 4.0  # mm
WORDS = 27.0  # mm, beside a bar
PARTS = ("stored", "damping", "friction", "impacts")  # of what is supplied
HATCHES = {"friction": "////", "impacts": "xxxx"}
MANY = 2  # beats


def plot_energy(
    run: Trajectory,
    window: Sequence[float] | None = None,
    width: float = style.FULL,
    beats: list[Beat] | None = None,
    ax: Axes | None = None,
) -> Figure:
    """Bars: what the drive, springs and weights put in over the whole run and where it went; below, phase by phase of the last
    two beats of a window where there is an escapement.

    ValueError where nothing was put in: there is no share of nothing.
    """
    shares = energy_shares(run)
    if not shares.went_to:
        raise ValueError("no energy was put into this run, so there are no shares to draw")
    beats_shown = (_beats(run, window) if beats is None else beats)[-MANY:]
    stages = [[one for one in beat.stages if one.name != "locked"] for beat in beats_shown]
    across = len(stages) if width >= style.NARROW else 1
    rows = -(-len(stages) // across) if stages else 0
    whole = ROW * len(shares.went_to)
    each = ROW * max((len(own) for own in stages), default=0)
    step = OVER + each + UNDER
    made = style.figure(width, style.HEADING + OVER + whole + UNDER + (KEY if rows else 0.0) + rows * step, ax=ax)
    closes = f", the account closes to {abs(run.energy.get('residual_relative', 0.0)):.0e}"
    style.heading(made, run.scene.title, f"{metric(shares.supplied, 'J', 4)} put in over {run.simulated:.6g} s{closes}")
    top = style.HEADING + OVER
    _whole(style.panel(made, LEFT, top, width - LEFT - RIGHT, whole), shares.went_to, shares.supplied)
    top += whole + UNDER
    reach = max((abs(_sum(one)) for own in stages for one in own), default=0.0)
    panels = style.panels(
        made, width, [ROW * len(own) for own in stages], max(across, 1), (LEFT, RIGHT), top + KEY + OVER, step
    )
    for axes, beat, own in zip(panels, beats_shown, stages, strict=True):
        _phases(axes, own, reach)
        style.title(axes, beat_name(beat))
        if axes is panels[0]:
            _key(made, axes, top)
    return made


def _beats(run: Trajectory, window: Sequence[float] | None) -> list[Beat]:
    try:
        return shown_beats(run, window, rubbed=False)
    except ValueError:
        return []


def _whole(axes: Axes, went: dict[str, float], supplied: float) -> None:
    """A bar for each way that energy took, with its share and its amount."""
    style.dress(axes, grid="x")
    names = list(went)
    values = [100.0 * went[name] for name in names]
    colours = [ENERGIES.get(name, FAINT) for name in names]
    bars = axes.barh(range(len(names)), values, height=0.66, color=colours, edgecolor="white", linewidth=0.0)
    for bar, name, value in zip(bars, names, values, strict=True):
        bar.set_gid(f"energy {name}")
        bar.set_hatch(HATCHES.get(name))
        words = f"{signed(value, 1)} %, {style.minus(metric(went[name] * supplied, 'J', 4))}"
        place = (max(value, 0.0), bar.get_y() + 0.5 * bar.get_height())
        style.note(axes, words, place, (3, 0), va="center")
    axes.set_yticks(range(len(names)), names)
    axes.invert_yaxis()
    wide = style.width_mm(axes)
    axes.set_xlim(min(*values, 0.0) * 1.1, max(*values, 1e-9) * wide / (wide - WORDS))
    axes.axvline(0.0, color=FAINT, linewidth=style.HAIR)
    axes.set_xlabel("share of what was put in (%)", labelpad=1.5)
    axes.tick_params(axis="y", length=0.0, labelsize=style.LABEL)
    style.title(axes, "The whole run")


def _sum(stage: Stage) -> float:
    values = _parts(stage).values()
    return max(sum(max(value, 0.0) for value in values), -sum(min(value, 0.0) for value in values))


def _parts(stage: Stage) -> dict[str, float]:
    """What the work of the drive became in a phase, J."""
    e = stage.energy
    return {"stored": e.stored, "damping": e.damping, "friction": e.friction, "impacts": sum(e.impacts.values())}


def _phases(axes: Axes, stages: list[Stage], reach: float) -> None:
    """Stacked bars: what was taken to the right of zero, what stores gave to the left; a line where the drive's work ends."""
    style.dress(axes, grid="x")
    factor, unit = style.energy_unit(reach)
    for k, stage in enumerate(stages):
        ends = {True: 0.0, False: 0.0}
        for name, value in _parts(stage).items():
            up = value >= 0.0
            bar = axes.barh(
                k, factor * value, left=factor * ends[up], height=0.66, color=ENERGIES[name], gid=f"energy {k} {name}",
                hatch=HATCHES.get(name), edgecolor="white", linewidth=0.0,
            )  # fmt: skip
            bar[0].set_gid(f"energy {phase_title(stage)} {name}")
            ends[up] += value
        supplied = factor * stage.energy.supplied
        axes.plot([supplied, supplied], [k - 0.44, k + 0.44], color=INK, linewidth=1.2, gid=f"drive {phase_title(stage)}")
    axes.set_yticks(range(len(stages)), [phase_title(stage) for stage in stages])
    axes.set_ylim(len(stages) - 0.5, -0.5)
    low = min(0.0, *(factor * min(0.0, sum(min(v, 0.0) for v in _parts(stage).values())) for stage in stages))
    axes.set_xlim(1.08 * low - 0.02 * factor * reach, 1.08 * factor * reach)
    axes.axvline(0.0, color=FAINT, linewidth=style.HAIR)
    axes.set_xlabel(f"energy ({unit})", labelpad=1.5)
    axes.tick_params(axis="y", length=0.0, labelsize=style.LABEL)


def _key(made: Figure, axes: Axes, top: float) -> None:
    """What the parts of the bars stand for, above the first panel of phases."""
    handles: list[tuple[Any, str]] = [
        (Patch(facecolor=ENERGIES[name], hatch=HATCHES.get(name), edgecolor="white", linewidth=0.0), name) for name in PARTS
    ]
    handles.append((Line2D([], [], color=INK, linewidth=1.2), "work of the drive"))
    width, height = style.size_mm(made)
    corner = (style.EDGE / width, 1.0 - (top + KEY) / height)
    where: dict[str, Any] = {"bbox_to_anchor": corner, "bbox_transform": made.transSubfigure, "ncols": len(handles)}
    style.key(axes, handles, loc="lower left", borderaxespad=0.0, borderpad=0.0, **where)


WITHIN = 3  # instants in a step
FINE = 60  # steps of a phase at least
JUST = 1e-6  # of a step: so long before its end its contacts still hold


@dataclass(frozen=True)
class Push:
    """A phase with the torque in it.

    angle   of the balance, rad (n,), and `torque` of all contacts on it, N·m (n,)
    forces  work of the torque over the angle, J; `impacts` that of the impacts, J
    struck  angles (rad) at which the impacts hit, and the work of each, J
    way     +1 or -1: the direction of the swing
    """

    stage: Stage
    angle: Array
    torque: Array
    forces: float
    impacts: float
    struck: tuple[tuple[float, float], ...]
    way: float


def pushes(run: Trajectory, beats: Sequence[Beat]) -> list[list[Push]]:
    """Of every phase of some beats but the free oscillation."""
    name = roles(run.scene).oscillator
    assert name is not None
    stages = [[stage for stage in beat.stages if stage.name != "locked"] for beat in beats]
    times = [_instants(run, stage.phase.start, stage.phase.end) for own in stages for stage in own]
    whole = torque_on(run, name, np.concatenate(times))
    curves = zip(times, np.split(whole, np.cumsum([len(own) for own in times])[:-1]), strict=True)
    compiled = compile_scene(run.scene)
    return [[_push(run, name, compiled, stage, *next(curves)) for stage in own] for own in stages]


def _push(run: Trajectory, name: str, compiled: Compiled, stage: Stage, times: Array, torque: Array) -> Push:
    angle = run.positions(times, [run.slices[name].start])[:, 0]
    turned = frames(run.scene, run.slices, run.sample(times)[0])[name][:, 2]  # in the movement, whatever carries it
    work = float(np.sum(0.5 * (torque[1:] + torque[:-1]) * np.diff(turned)))
    struck = _impacts(run, name, compiled, stage)
    way = 1.0 if angle[-1] >= angle[0] else -1.0
    return Push(stage, angle, torque, work, sum(value for _, value in struck), struck, way)


def _instants(run: Trajectory, start: float, end: float) -> Array:
    """Of each step between rows its start, some instants within, and one just before its end."""
    inside = run.t[(run.t > start) & (run.t < end)]
    edges, longest = np.unique(np.concatenate(([start], inside, [end]))), (end - start) / FINE
    if len(edges) < 2:
        return np.array([start])
    counts = np.maximum(WITHIN, np.ceil(np.diff(edges) / longest).astype(int) + 1)
    stretches = zip(edges[:-1], np.maximum(just_before(edges, JUST), edges[:-1]), counts, strict=True)
    return np.concatenate([np.linspace(first, last, count) for first, last, count in stretches])


def torque_on(run: Trajectory, name: str, times: Array) -> Array:
    """Moment of all contact forces on a body about its pivot, N·m (n,), after what happens at these times (s).

    What presses on a body that turns on it, such as a hinged pallet, acts at the hinge.
    """
    found = forces(run, times)
    placed = frames(run.scene, run.slices, run.sample(times)[0])
    hung, names = rides(run.scene.bodies), [body.name for body in run.scene.bodies]
    total = np.zeros(len(times))
    for k, contact in enumerate(found.pairs.tolist()):
        pair = run.pairs[contact]
        for side, sign in ((pair.body_a, 1.0), (pair.body_b, -1.0)):
            hinge = _reached(hung, names.index(side), names.index(name))
            if hinge is None:
                continue
            at = found.point[:, k] if hinge < 0 else placed[names[hinge]][:, :2]
            arm, force = at - placed[name][:, :2], found.on_a[:, k]
            total += sign * np.nan_to_num(arm[:, 0] * force[:, 1] - arm[:, 1] * force[:, 0])
    return total


def _reached(hung: Sequence[Ride], side: int, body: int) -> int | None:
    """The body by whose hinge a force on `side` reaches a body; negative where it is a part of that one, None where it does not
    reach it."""
    hinge = -1
    while side >= 0:
        side = hung[side].part_of
        if side == body:
            return hinge
        hinge, side = side, hung[side].host
    return None


def _impacts(run: Trajectory, name: str, compiled: Compiled, stage: Stage) -> tuple[tuple[float, float], ...]:
    """Angle and work of every jump of the balance's velocity that the timeline counts with this phase."""
    column = run.slices[name].start
    low = np.searchsorted(run.t, stage.phase.start, "right" if stage.name == "run to banking" else "left")
    high = np.searchsorted(run.t, stage.phase.end, "right" if stage.name == "drop" else "left")
    rows = np.arange(max(int(low), 1), int(high) + 1)
    rows = rows[rows < len(run.t)]
    jumps = rows[(run.t[rows] == run.t[rows - 1]) & (rows - 1 >= low) & (rows < high)]
    inertia = float(compiled.model.coordinates[column].mass)
    before, after = (absolute(compiled, run.u[k], True)[:, column] for k in (jumps - 1, jumps))
    works = 0.5 * inertia * (after**2 - before**2)
    return tuple((float(run.q[k, column]), work) for k, work in zip(jumps.tolist(), works.tolist(), strict=True) if work)


TORQUE_TOP, TORQUE_LEFT, TORQUE_RIGHT, TORQUE_OVER, TALL, TORQUE_UNDER = 12.0, 12.0, 3.0, 5.0, 48.0, 11.0  # mm
LINE = style.LEAD * style.SMALL * style.POINT  # mm, of the table
COLUMNS = (0.0, 0.46, 0.64, 0.82, 1.0)  # of the panel's width: name, and the right sides of the numbers
LEAST = 0.02  # of the panel: an area narrower than this has its energy in the table only
SHOWN = 0.02  # of the largest: fainter energies are in the table only
HIT = 0.02  # of the largest work in the beat: fainter impacts have no mark


def plot_torque(
    run: Trajectory,
    window: Sequence[float] | None = None,
    width: float = style.FULL,
    beats: list[Beat] | None = None,
    ax: Axes | None = None,
) -> Figure:
    """The torque of all contacts on the balance over its angle, a panel for each of the last two beats of a window.

    Positive with the swing, whichever way it goes. The area under a phase is the work of its forces; written on it is what the
    phase gives to the balance in all, impacts included, as in phases.csv.

    Where nothing keeps time it is the torque, or force, that keeps each driven body in its motion, over its angle or path in
    the window, by default the last stretch recorded, with its work.

    ValueError where no beat was recorded whole, or the run knows no forces.
    """
    if beats is None and not (keeps_time(run.scene) and is_driven(run.scene)):
        names = [body.name for body in run.scene.bodies if body.prescribed is not None]
        if names:
            return _drives(run, names, window, width, ax)
    beats_shown = (beats or shown_beats(run, window, rubbed=False))[-MANY:]
    found = pushes(run, beats_shown)
    across = len(found) if width >= style.NARROW else 1
    rows = -(-len(found) // across)
    table = LINE * (2.5 + max(len(one) for one in found))
    step = TORQUE_OVER + TALL + TORQUE_UNDER + table
    made = style.figure(width, TORQUE_TOP + rows * step, ax=ax)
    name = spaced(roles(run.scene).oscillator or "")
    style.heading(made, run.scene.title, f"Torque on {name}, with its swing; triangles: impacts")
    largest = max((float(np.abs(one.torque).max()) for push in found for one in push), default=0.0) or 1.0
    factor, unit = style.scaled_unit(largest, "N·m")
    works = [value for push in found for one in push for value in (one.forces, one.impacts, one.stage.energy.to_balance)]
    joules = style.energy_unit(max(map(abs, works), default=0.0))
    span = [factor * one.way * value for push in found for one in push for value in (one.torque.min(), one.torque.max())]
    sides = (TORQUE_LEFT, TORQUE_RIGHT)
    panels = style.panels(made, width, [TALL] * len(found), across, sides, TORQUE_TOP + TORQUE_OVER, step)
    for axes, beat, push in zip(panels, beats_shown, found, strict=True):
        _curve(axes, push, factor)
        axes.set_ylim(min(*span, 0.0) - 0.16 * (max(span) - min(span)), max(*span, 0.0) + 0.16 * (max(span) - min(span)))
        style.title(axes, beat_name(beat))
        axes.set_xlabel(f"angle of {name} (°)", labelpad=1.5)
        axes.set_ylabel(f"torque ({unit})", labelpad=1.5)
        _energies(axes, push, factor, joules)
        _table(axes, push, (f"energy to {name} ({joules[1]})", joules[0]), (TALL + TORQUE_UNDER) / TALL, LINE / TALL)
    return made


def _drives(run: Trajectory, names: list[str], window: Sequence[float] | None, width: float, ax: Axes | None) -> Figure:
    """A panel for each driven body: the torque of its drive, or the force along its axis, positive with the motion."""
    start, end = recorded(run)[-1] if window is None else style.stretch(run, window)
    times = _instants(run, start, end)
    pushed, step = forces(run, times).drives, TORQUE_OVER + TALL + TORQUE_UNDER
    across = min(len(names), 2) if width >= style.NARROW else 1
    made = style.figure(width, TORQUE_TOP + -(-len(names) // across) * step, ax=ax)
    style.heading(made, run.scene.title, f"Drive between impacts, with its motion, {start:.6g} s to {end:.6g} s")
    sides = (TORQUE_LEFT, TORQUE_RIGHT)
    panels = style.panels(made, width, [TALL] * len(names), across, sides, TORQUE_TOP + TORQUE_OVER, step)
    for axes, name in zip(panels, names, strict=True):
        slides = run.scene.body(name).motion == "slide"
        moved, way = run.positions(times, [run.slices[name].start])[:, 0], 1.0
        steps = np.diff(moved)
        if np.all(steps <= 0.0) and np.any(steps):  # elsewhere a motion to and fro has a side for either way
            way = -1.0
            axes.xaxis.set_inverted(True)
        drive = way * pushed[name]
        factor, unit = style.scaled_unit(float(np.abs(drive).max()) or 1.0, "N" if slides else "N·m")
        work = float(np.sum(0.5 * (drive[1:] + drive[:-1]) * way * steps))
        style.dress(axes)
        axes.axhline(0.0, color=FAINT, linewidth=style.HAIR, zorder=2)
        axes.plot(
            1e3 * moved if slides else np.degrees(moved), factor * drive, color=INK, linewidth=style.CURVE, gid=f"drive {name}"
        )
        style.title(axes, f"{name}, work {style.minus(metric(work, 'J', 4))}")
        axes.set_xlabel(f"travel of {name} (mm)" if slides else f"angle of {name} (°)", labelpad=1.5)
        axes.set_ylabel(f"{'force' if slides else 'torque'} ({unit})", labelpad=1.5)
    return made


def _curve(axes: Axes, push: list[Push], factor: float) -> None:
    """Areas in the colours of the phases, the curve on top, and marks where impacts hit."""
    style.dress(axes)
    axes.axhline(0.0, color=FAINT, linewidth=style.HAIR, zorder=2)
    most = max((abs(one.stage.energy.to_balance) for one in push), default=0.0)
    for one, (_, colour) in zip(push, bands(one.stage.phase for one in push), strict=True):
        x, y = np.degrees(one.angle), factor * one.way * one.torque
        gid = f"area {phase_title(one.stage)}"
        axes.fill_between(x, y, 0.0, color=colour, linewidth=0.0, zorder=1, gid=gid)
        axes.plot(x, y, color=INK, linewidth=style.CURVE, zorder=3, gid=f"torque {phase_title(one.stage)}")
        for angle, work in one.struck:
            if abs(work) > HIT * most:
                mark = "^" if work > 0.0 else "v"
                axes.plot([math.degrees(angle)], [0.0], mark, color=INK, markersize=3.5, markerfacecolor="white",
                          markeredgewidth=0.6, zorder=4)  # fmt: skip
    low, high = axes.get_xlim()
    if push and push[0].angle[0] > push[-1].angle[-1]:  # time runs to the right
        axes.set_xlim(high, low)


def _energies(axes: Axes, push: list[Push], factor: float, joules: tuple[float, str]) -> None:
    """What each phase gives, in the unit of `joules`, written above its area, or below it where it takes."""
    low, high = sorted(axes.get_xlim())
    most = max(abs(one.stage.energy.to_balance) for one in push)
    for one in push:
        x, given = np.degrees(one.angle), one.stage.energy.to_balance
        if abs(x[-1] - x[0]) < LEAST * (high - low) or abs(given) < SHOWN * most:
            continue
        up = given >= 0.0
        torque = factor * one.way * one.torque
        edge = float(torque.max() if up else torque.min())
        text = style.minus(f"{joules[0] * given:+.1f} {joules[1]}")
        place = (0.5 * (x[0] + x[-1]), max(edge, 0.0) if up else min(edge, 0.0))
        style.note(axes, text, place, (0, 1.5 if up else -1.5), ha="center", va="bottom" if up else "top", zorder=5)


def _table(axes: Axes, push: list[Push], head: tuple[str, float], below: float, row: float) -> None:
    """Under the panel: work of forces and of impacts, phase by phase; heights are shares of the panel's.

    `head`: what is shown, and in how many to the joule.
    """
    rows: list[tuple[str, ...]] = [(head[0], "forces", "impacts", "together")]
    energies = [(one.forces, one.impacts, one.stage.energy.to_balance) for one in push]
    titles = (*(phase_title(one.stage) for one in push), "beat")
    sums = tuple(sum(values) for values in zip(*energies, strict=True))
    for title, values in zip(titles, (*energies, sums), strict=True):
        rows.append((title, *(style.minus(f"{round(head[1] * value, 2) + 0.0:.2f}") for value in values)))
    colours = [None, *(colour for _, colour in bands(one.stage.phase for one in push)), None]
    swatch = 2.2 / style.width_mm(axes)
    for k, (cells, colour) in enumerate(zip(rows, colours, strict=True)):
        y = 1.0 - below - (k + 0.5) * row
        if colour is not None:
            place = (COLUMNS[0], y - 0.35 * row)
            axes.add_patch(Rectangle(place, swatch, 0.7 * row, color=colour, lw=0.0, transform=axes.transAxes, clip_on=False))
        weight = "bold" if k in (0, len(rows) - 1) else "normal"
        for i, text in enumerate(cells):
            x = COLUMNS[0] + (1.6 * swatch if colour is not None else 0.0) if i == 0 else COLUMNS[i + 1]
            style.words(axes, x, y, text, ha="left" if i == 0 else "right", va="center", weight=weight)
