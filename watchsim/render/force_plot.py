"""Which forces act at contacts and pivots over time?

plot_forces(run).savefig("forces.pdf")
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from watchsim.analysis.flows import pair_name
from watchsim.analysis.forces import Forces, forces, just_before
from watchsim.analysis.phases import Phase
from watchsim.analysis.timeline import BEGINNING, RESTING
from watchsim.render import style
from watchsim.render.marks import clock, spaced
from watchsim.render.palette import looks
from watchsim.render.phase_plots import name_key, names_in, shade
from watchsim.render.rows import reduced
from watchsim.render.view import Window
from watchsim.scene.scene import Scene
from watchsim.simulation.trajectory import Array, Trajectory

MOST_INSTANTS = 12_000  # instants; each takes a quarter of a millisecond
FINE = 400  # instants at least
JUST = 1e-6  # of a step: so long before its end its contacts still hold


@dataclass(frozen=True)
class Curves:
    """Forces at the times t (s, n): normal and tangential by pair of bodies, and those of the bearings, N (n,)."""

    t: Array
    normal: dict[str, Array]
    tangential: dict[str, Array]
    pivots: dict[str, Array]


def curves(run: Trajectory, spans: Sequence[Window]) -> list[Curves]:
    """Forces over some stretches of time: right after every row, just before the next, and between."""
    times = [_instants(run, span) for span in spans]
    count = sum(map(len, times))
    if count > MOST_INSTANTS:
        raise ValueError(
            f"{spans[0][0]:.9g} s to {spans[-1][1]:.9g} s hold {count} instants at which forces would have to be worked out, "
            f"more than {MOST_INSTANTS}; choose a shorter window"
        )
    found = forces(run, np.concatenate(times))
    ends = np.cumsum([0, *map(len, times)]).tolist()
    return [_summed(run, found, slice(first, last)) for first, last in pairwise(ends)]


def _summed(run: Trajectory, found: Forces, own: slice) -> Curves:
    """By pair of bodies: several points may touch at once, and what they press, and what they rub, adds up."""
    normal: dict[str, Array] = {}
    tangential: dict[str, Array] = {}
    for k, contact in enumerate(found.pairs):
        name = pair_name(run, int(contact))
        normal[name] = normal.get(name, 0.0) + found.normal[own, k]
        tangential[name] = tangential.get(name, 0.0) + found.tangential[own, k]
    loads = {name: np.hypot(*force[own].T) for name, force in found.pivots.items()}
    return Curves(found.t[own], normal, tangential, loads)


def _instants(run: Trajectory, span: Window) -> Array:
    inside = run.t[(run.t > span[0]) & (run.t < span[1])]
    edges = np.unique(np.concatenate(([span[0]], inside, [span[1]])))
    before = just_before(edges, JUST)
    return np.unique(np.concatenate((edges[:-1], before, np.linspace(span[0], before[-1], FINE))))


LEFT, RIGHT, OVER, TALL, BETWEEN, FOOT = 13.0, 3.0, 5.0, 23.0, 3.0, 7.0  # mm
BEARINGS = "bearings"
KEY = 5.0  # mm, of the names of phases
FLAT = 1e-2  # a range smaller than this part of the largest force is not magnified
ROOMY = 50.0  # mm, a panel over which name and key stand side by side
LINE, BEFORE_NAME = 3.2, 2.8  # mm, of a line of names in a key; letters wide, the line before a name and the gap behind it
BEFORE, AFTER = 0.08, 0.12  # of a beat's phases: what is shown besides
DASHES = ("-", (0, (4, 1.2)), (0, (1.2, 1.0)), (0, (5, 1, 1, 1)))


@dataclass(frozen=True)
class Layout:
    """What rows there are, and what all columns have in common."""

    pairs: list[str]
    pivots: list[str]
    bearings: str  # title of the last row
    units: dict[str, tuple[float, str]]
    columns: int  # of the names of bearings
    raised: bool  # they stand above the title
    wide: bool  # name and key stand side by side over a panel


def plot_forces(
    run: Trajectory, window: Sequence[float] | None = None, width: float = style.FULL, ax: Axes | None = None
) -> Figure:
    """Normal and friction force by pair of bodies, and the load of every bearing, over time.

    window  (from, to) in seconds; default the last two beats without their free oscillation, side by side, or where there are
            none the last oscillation, or all of the last stretch recorded

    Impacts are no forces and not shown. ValueError for a run that knows no forces, and for a window with more than 12 000
    instants to look at.
    """
    cycle = style.shown(run, window)
    spans = [cycle.window] if window is not None else beat_spans(run, cycle)
    found = curves(run, spans)
    pairs = list(dict.fromkeys(name for one in found for name in one.normal))
    pivots = list(dict.fromkeys(name for one in found for name in one.pivots))
    names = names_in(cycle.phases)
    rows = len(pairs) + bool(pivots)
    if not rows:
        raise ValueError("no contact is closed there, and nothing turns on a pivot: there are no forces to plot")
    top = style.HEADING + (KEY if width >= style.NARROW else 2.0 * KEY) * bool(names)
    wide = width / len(spans) - LEFT - RIGHT
    bearings = BEARINGS + left_out(run.scene)
    columns, lines = _key_beside(bearings, pivots, wide if wide >= ROOMY else width - LEFT - RIGHT)
    layout = Layout(pairs, pivots, bearings, _units(found), columns, raised=lines > 0, wide=wide >= ROOMY)
    tops = [top + k * (OVER + TALL + BETWEEN) + OVER for k in range(rows)]
    tops[-1] += lines * LINE
    made = style.figure(width, tops[-1] + TALL + BETWEEN + FOOT, ax=ax)
    style.heading(made, run.scene.title, "Forces at contacts, and loads of bearings")
    if names:
        name_key(made, names, style.HEADING)
    for c, (span, one) in enumerate(zip(spans, found, strict=True)):
        own = [beat for beat in cycle.phases if beat[-1].end > span[0] and beat[0].start < span[1]]
        left = c * (LEFT + wide + RIGHT) + LEFT
        column = [style.panel(made, left, top, wide, TALL) for top in tops]
        _column(column, run, span, one, own, layout, first=c == 0)
    for k in range(rows):  # panels side by side show the same range
        row = made.axes[k::rows]
        low, high = min(axes.get_ylim()[0] for axes in row), max(axes.get_ylim()[1] for axes in row)
        for axes in row:
            axes.set_ylim(low, high)
            style.ticks(axes.yaxis, 4)
            style.ticks(axes.xaxis, 5)
    return made


def _key_beside(words: str, names: Sequence[str], room: float) -> tuple[int, int]:
    """(how many names of bearings stand beside each other in `room` mm, lines above the title; 0 where all fit beside it)."""
    letter = style.LETTER * style.SMALL * style.POINT
    widths = [BEFORE_NAME * style.SMALL * style.POINT + letter * len(name) for name in names]
    if not names or sum(widths) + style.LETTER * style.LABEL * style.POINT * len(words) <= room:
        return len(names), 0
    columns = max(1, int(room / max(widths)))
    return columns, -(-len(names) // columns)


def left_out(scene: Scene) -> str:
    """What acts on pivoted bodies and is in no contact: its share of their bearings' loads is not known here."""
    geared = not scene.rigid_gears and any(body.geared is not None for body in scene.bodies)  # a scene made in Python
    unknown = [word for word, there in (("gears", geared), ("line springs", bool(scene.line_springs))) if there]
    return f", without {' and '.join(unknown)}" if unknown else ""


def beat_spans(run: Trajectory, cycle: style.Shown) -> list[Window]:
    """The beats of a cycle where they are whole, without their free oscillation; or the cycle."""
    found = []
    for beat in (beat for beat in cycle.phases if beat[0].name in BEGINNING):
        end = max(one.end for one in beat if one.name not in RESTING)
        way = end - beat[0].start
        found.append((max(beat[0].start - BEFORE * way, float(run.t[0])), min(end + AFTER * way, float(run.t[-1]))))
    return found[-2:] or [cycle.window]


def _column(
    axes: list[Axes], run: Trajectory, span: Window, one: Curves, phases: list[list[Phase]], layout: Layout, first: bool
) -> None:
    wide, worn, time = layout.wide, looks(run.scene), clock(span)
    x = time.at(one.t)
    nothing = np.zeros(len(x))
    groups: list[tuple[str, list[tuple[str, Array, str, Any]]]] = [
        (name, [("normal", one.normal.get(name, nothing), style.SERIES[0], "-"),
                ("friction", one.tangential.get(name, nothing), style.SERIES[1], DASHES[1])])
        for name in layout.pairs
    ]  # fmt: skip
    if layout.pivots:
        loads = [(n, one.pivots[n], worn[n].line, DASHES[k % len(DASHES)]) for k, n in enumerate(layout.pivots)]
        groups.append((BEARINGS, loads))
    for panel_axes, (name, lines) in zip(axes, groups, strict=True):
        style.dress(panel_axes)
        factor, unit = layout.units[name]
        handles = []
        for label, values, colour, dashes in lines:
            look: dict[str, Any] = {"linestyle": dashes, "color": colour, "gid": f"force {name} {label}", "zorder": 3}
            handles += panel_axes.plot(*reduced(x, factor * values), linewidth=style.CURVE, **look)
        drawn = np.concatenate([factor * values for _, values, _, _ in lines])
        style.limits(panel_axes, float(drawn.min()), float(drawn.max()), 0.05, FLAT, 1.0)
        panel_axes.ticklabel_format(axis="y", useOffset=False)
        if first or wide:
            style.title(panel_axes, spaced(name) if name != BEARINGS else layout.bearings)
        if first:
            panel_axes.set_ylabel(f"force ({unit})", labelpad=1.5)
        low, columns = (OVER / TALL * layout.raised, layout.columns) if name == BEARINGS else (0.0, len(lines))
        where: dict[str, Any] = {"loc": "lower right", "bbox_to_anchor": (1.0, 1.0 + low), "borderaxespad": 0.0}
        if wide or not first:  # side by side in a column of text: names on the left, keys on the right
            style.key(
                panel_axes, [(h, spaced(line[0])) for h, line in zip(handles, lines, strict=True)], ncols=columns, **where
            )
        panel_axes.set_xlim(*map(time.at, span))
        for beat in phases:
            shade(panel_axes, beat, time.base, time.factor)
    for panel_axes in axes[:-1]:
        panel_axes.set_xticklabels([])
    axes[-1].set_xlabel(time.label if wide or not time.base else f"{time.unit} after {time.base:.9g} s", labelpad=1.5)


def _units(found: Sequence[Curves]) -> dict[str, tuple[float, str]]:
    """Factor and unit of each row of panels, the same for the beats side by side."""
    rows: dict[str, list[Array]] = {}
    for one in found:
        for name, values in (*one.normal.items(), *one.tangential.items()):
            rows.setdefault(name, []).append(values)
        rows.setdefault(BEARINGS, []).extend(one.pivots.values())
    largest = {name: max((float(np.abs(one).max(initial=0.0)) for one in own), default=0.0) for name, own in rows.items()}
    return {name: style.scaled_unit(most, "N", otherwise=1) for name, most in largest.items()}
