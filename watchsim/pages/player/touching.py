"""Which contacts are closed while a page plays, where, and how hard do they press?"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from watchsim.analysis.contact_forces import Forces, forces
from watchsim.pages.player.packed import doubles, floats
from watchsim.render.fewest_rows import kept_rows
from watchsim.render.frame.marks.touching_points import ContactMarks, Side
from watchsim.render.frame.pose_history import Window
from watchsim.simulation.record.trajectory import Array, Trajectory

EVENLY = 600  # instants besides those of rows and events at which forces are asked for
MOST = 6000  # instants in all
JUST = 1e-7  # of the time between two events: so long before the second the first one's contacts still hold
OFF = 2e-3  # of a contact's largest force: what a force may be off between the instants that are kept
CROWD = 16.0  # contacts closed at a time, on average: forces of a heap take minutes, and nobody could read them


def touching(run: Trajectory, window: Window) -> list[dict[str, Any]]:
    """For every contact that is closed some time in the window: its two sides, from when to when, and forces there.

    Forces are left out of a heap, and where the run does not hold them (steps of fixed length, events not kept).
    """
    try:
        marks = ContactMarks(run)
    except ValueError:
        return []
    closed = {number: marks.stretches(number, window) for number in marks.numbers}
    closed = {number: found for number, found in closed.items() if found}
    told = None if _crowd(closed, window) > CROWD else _forces(run, window, closed)
    names = [body.name for body in run.scene.bodies]
    return [
        {
            **_sides(marks.sides(number), names),
            "name": _name(run, number),
            "closed": doubles(np.array(stretches).reshape(-1)),
            **(_samples(told, number, stretches) if told is not None else {}),
        }
        for number, stretches in closed.items()
    ]


def _crowd(closed: dict[int, list[Window]], window: Window) -> float:
    """How many contacts are closed at a time, on average."""
    return sum(end - start for stretches in closed.values() for start, end in stretches) / (window[1] - window[0])


def _sides(sides: tuple[Side, Side], names: Sequence[str]) -> dict[str, Any]:
    """The circle of the one, and the circle or line of the other, in their bodies' frames."""
    a, b = sides
    found: dict[str, Any] = {"a": [names.index(a.body), a.x, a.y, a.radius], "b": [names.index(b.body), b.x, b.y, b.side]}
    if b.normal is not None:
        found["normal"] = list(b.normal)
    return found


def _name(run: Trajectory, number: int) -> str:
    pair = run.pairs[number]
    return f"{pair.body_a}.{pair.layer_a} / {pair.body_b}.{pair.layer_b}"


def _forces(run: Trajectory, window: Window, closed: dict[int, list[Window]]) -> Forces | None:
    """Forces at rows, right after and right before every event, and evenly between."""
    changes = np.unique([t for stretches in closed.values() for stretch in stretches for t in stretch])
    edges = np.unique(np.concatenate(([window[0]], changes[(changes > window[0]) & (changes < window[1])], [window[1]])))
    before = edges[1:] - np.maximum(JUST * np.diff(edges), np.spacing(edges[1:]))
    rows = run.t[(run.t > window[0]) & (run.t < window[1])]
    rows = rows[:: max(1, len(rows) // (MOST // 2))]
    times = np.unique(np.concatenate((edges[:-1], before, rows, np.linspace(*window, EVENLY))))
    times = times[:: max(1, len(times) // MOST)]
    try:
        return forces(run, times)
    except ValueError:
        return None


def _samples(told: Forces, number: int, stretches: list[Window]) -> dict[str, str]:
    """Time, normal and tangential force (N) while the contact is closed, as few as straight lines between them allow."""
    column = np.flatnonzero(told.pairs == number)
    if len(column) == 0:
        return {}
    t, values = told.t, np.column_stack((told.normal[:, column[0]], told.tangential[:, column[0]]))
    held = np.isfinite(told.point[:, column[0], 0])
    rows: list[NDArray[np.int64]] = []
    for start, end in stretches:
        inside = np.flatnonzero(held & (t >= start) & (t < end))
        if len(inside):
            rows.append(inside[_thinned(t[inside], values[inside])])
    if not rows:
        return {}
    kept = np.concatenate(rows)
    return {"t": doubles(t[kept]), "force": floats(values[kept])}


def _thinned(t: Array, values: Array) -> NDArray[np.int64]:
    allowed = OFF * max(float(np.abs(values).max()), 1e-300)

    def fits(i: int, j: int) -> bool:
        s = ((t[i + 1 : j] - t[i]) / (t[j] - t[i]))[:, None]
        return bool(np.all(np.abs(values[i] + s * (values[j] - values[i]) - values[i + 1 : j]) <= allowed))

    return kept_rows(len(t), fits)
