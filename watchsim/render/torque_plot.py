"""Which torque acts on the balance over its angle, and what do unlocking and impulse take and give?

plot_torque(run).savefig("torque.pdf")

From the forces at the contacts and the jumps of the velocity; phases.csv has the same energies from the account of the balance
alone.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from watchsim.analysis.forces import forces
from watchsim.analysis.timeline import Beat, Stage, shown_beats
from watchsim.analysis.timeline import title as phase_title
from watchsim.mechanism.compile import compile_scene
from watchsim.render import style
from watchsim.render.palette import FAINT, INK
from watchsim.render.phase_bands import bands, beat_name
from watchsim.scene.roles import roles
from watchsim.simulation.trajectory import Array, Trajectory, frames

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
    inertia = float(compile_scene(run.scene).model.coordinates[run.slices[name].start].mass)
    return [[_push(run, name, inertia, stage, *next(curves)) for stage in own] for own in stages]


def _push(run: Trajectory, name: str, inertia: float, stage: Stage, times: Array, torque: Array) -> Push:
    angle = run.positions(times, [run.slices[name].start])[:, 0]
    work = float(np.sum(0.5 * (torque[1:] + torque[:-1]) * np.diff(angle)))
    struck = _impacts(run, name, inertia, stage)
    way = 1.0 if angle[-1] >= angle[0] else -1.0
    return Push(stage, angle, torque, work, sum(value for _, value in struck), struck, way)


def _instants(run: Trajectory, start: float, end: float) -> Array:
    """Of each step between rows its start, some instants within, and one just before its end."""
    inside = run.t[(run.t > start) & (run.t < end)]
    edges, longest = np.unique(np.concatenate(([start], inside, [end]))), (end - start) / FINE
    found = []
    for low, high in pairwise(edges.tolist()):
        count = max(WITHIN, int(np.ceil((high - low) / longest)) + 1) if high - low > longest else WITHIN
        last = high - max(JUST * (high - low), float(np.spacing(high)))
        found.append(np.linspace(low, max(last, low), count))
    return np.concatenate(found) if found else np.array([start])


def torque_on(run: Trajectory, name: str, times: Array) -> Array:
    """Moment of all contact forces on a body about its pivot, N·m (n,), after what happens at these times (s)."""
    told = forces(run, times)
    places = frames(run.scene, run.slices, run.sample(times)[0])[name]
    total = np.zeros(len(times))
    for k, contact in enumerate(told.pairs):
        pair = run.pairs[int(contact)]
        side = {pair.body_a: 1.0, pair.body_b: -1.0}.get(name, 0.0)
        if side == 0.0:
            continue
        normal = told.direction[:, k]
        across = np.stack((-normal[:, 1], normal[:, 0]), axis=1)
        force = told.normal[:, k, None] * normal + told.tangential[:, k, None] * across
        arm = told.point[:, k] - places[:, :2]
        total += side * np.nan_to_num(arm[:, 0] * force[:, 1] - arm[:, 1] * force[:, 0])
    return total


def _impacts(run: Trajectory, name: str, inertia: float, stage: Stage) -> tuple[tuple[float, float], ...]:
    """Angle and work of every jump of the balance's velocity that the timeline counts with this phase."""
    column = run.slices[name].start
    low = np.searchsorted(run.t, stage.phase.start, "right" if stage.name == "run to banking" else "left")
    high = np.searchsorted(run.t, stage.phase.end, "right" if stage.name == "drop" else "left")
    rows = np.arange(max(int(low), 1), int(high) + 1)
    rows = rows[rows < len(run.t)]
    jumps = rows[(run.t[rows] == run.t[rows - 1]) & (rows - 1 >= low) & (rows < high)]
    return tuple(
        (float(run.q[k, column]), 0.5 * inertia * float(run.u[k, column] ** 2 - run.u[k - 1, column] ** 2))
        for k in jumps.tolist()
        if run.u[k, column] != run.u[k - 1, column]
    )


TOP, LEFT, RIGHT, OVER, TALL, UNDER = 12.0, 12.0, 3.0, 5.0, 48.0, 11.0  # mm
MANY = 2  # beats, one for each stone
ROW = style.LEAD * style.SMALL * style.POINT  # mm, of the table
COLUMNS = (0.0, 0.46, 0.64, 0.82, 1.0)  # of the panel's width: name, and the right sides of the numbers
HEADS = ("forces", "impacts", "together")
LEAST = 0.02  # of the panel: an area narrower than this has its energy in the table only
SHOWN = 0.02  # of the largest: fainter energies are in the table only
HIT = 0.02  # of the largest work in the beat: fainter impacts have no mark
PREFIXES = ((1.0, "N·m"), (1e3, "mN·m"), (1e6, "µN·m"), (1e9, "nN·m"))


def plot_torque(
    run: Trajectory, window: Sequence[float] | None = None, width: float = style.FULL, beats: list[Beat] | None = None
) -> Figure:
    """The torque of all contacts on the balance over its angle, a panel for each of the last two beats of a window.

    Positive with the swing, whichever way it goes. The area under a phase is the work of its forces; written on it is what the
    phase gives to the balance in all, impacts included, as in phases.csv. ValueError where no beat was recorded whole, or the
    run knows no forces.
    """
    beats_shown = (beats or shown_beats(run, window, rubbed=False))[-MANY:]
    found = pushes(run, beats_shown)
    across = len(found) if width >= style.NARROW else 1
    rows = -(-len(found) // across)
    table = ROW * (2.5 + max(len(one) for one in found))
    step = OVER + TALL + UNDER + table
    made = style.figure(width, TOP + rows * step)
    name = roles(run.scene).oscillator
    style.heading(made, run.scene.title, f"Torque on {name}, with its swing; triangles: impacts")
    largest = max((float(np.abs(one.torque).max()) for push in found for one in push), default=0.0) or 1.0
    factor, unit = next(((f, u) for f, u in PREFIXES if largest * f >= 1.0), PREFIXES[-1])
    works = [value for push in found for one in push for value in (one.forces, one.impacts, one.stage.energy.to_balance)]
    joules = style.energy_unit(max(map(abs, works), default=0.0))
    wide = width / across - LEFT - RIGHT
    span = [factor * one.way * value for push in found for one in push for value in (one.torque.min(), one.torque.max())]
    for k, (beat, push) in enumerate(zip(beats_shown, found, strict=True)):
        left, top = (k % across) * (LEFT + wide + RIGHT) + LEFT, TOP + (k // across) * step + OVER
        axes = style.panel(made, left, top, wide, TALL)
        _curve(axes, push, factor)
        axes.set_ylim(min(*span, 0.0) - 0.16 * (max(span) - min(span)), max(*span, 0.0) + 0.16 * (max(span) - min(span)))
        style.title(axes, beat_name(beat))
        axes.set_xlabel(f"angle of {name} (°)", labelpad=1.5)
        axes.set_ylabel(f"torque ({unit})", labelpad=1.5)
        _energies(axes, push, factor, joules)
        _table(axes, push, (f"energy to {name} ({joules[1]})", joules[0]), (TALL + UNDER) / TALL, ROW / TALL)
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
        look: dict[str, Any] = {
            "ha": "center",
            "va": "bottom" if up else "top",
            "fontsize": style.SMALL,
            "color": INK,
            "zorder": 5,
        }
        place = (0.5 * (x[0] + x[-1]), max(edge, 0.0) if up else min(edge, 0.0))
        axes.annotate(text, place, (0, 1.5 if up else -1.5), textcoords="offset points", **look)


def _table(axes: Axes, push: list[Push], head: tuple[str, float], below: float, row: float) -> None:
    """Under the panel: work of forces and of impacts, phase by phase; heights are shares of the panel's.

    `head`: what is shown, and in how many to the joule.
    """
    rows: list[tuple[str, ...]] = [(head[0], *HEADS)]
    energies = [(one.forces, one.impacts, one.stage.energy.to_balance) for one in push]
    for one, values in zip(push, energies, strict=True):
        rows.append((phase_title(one.stage), *(_shown(value, head[1]) for value in values)))
    rows.append(("beat", *(_shown(sum(values), head[1]) for values in zip(*energies, strict=True))))
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
            side = "left" if i == 0 else "right"
            look: dict[str, Any] = {"va": "center", "fontsize": style.SMALL, "color": INK, "weight": weight}
            axes.text(x, y, text, transform=axes.transAxes, ha=side, **look)


def _shown(value: float, factor: float) -> str:
    return style.minus(f"{round(factor * value, 2) + 0.0:.2f}")
