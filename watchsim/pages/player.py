"""What does the player of a page need of a run: shapes, rows of the motion, events, contacts with their forces?

Arrays travel as little-endian binary in base64: a fourth of the size of digits, and read back bit by bit.
"""

from __future__ import annotations

import base64
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from watchsim.analysis.forces import Forces, forces, just_before
from watchsim.analysis.phases import Phase
from watchsim.analysis.sound import another_beat_error, blows
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Arc
from watchsim.pages.solids import packed_solids
from watchsim.render.marks import ContactMarks, goes_round
from watchsim.render.movie import busy
from watchsim.render.opening import CLOSER, touching_room
from watchsim.render.palette import BLUED, FIXED, Finish, looks
from watchsim.render.part_names import Met, part_names
from watchsim.render.parts import Part, is_round, loops_of, outline, parts, spoke
from watchsim.render.rows import kept_rows, off_line
from watchsim.render.view import (
    COARSE,
    SHARES,
    SIDES,
    STUD,
    Frame,
    Hairspring,
    View,
    Window,
    Zigzag,
    bounds,
    hairsprings,
    recorded,
    room_of,
    sampled,
    size_of,
    stretch,
    view,
    zigzags,
)
from watchsim.scene.roles import frequency, keeps_time, only_presses, roles
from watchsim.scene.scene import Body, Scene
from watchsim.scene.trains import carried_last, is_still
from watchsim.simulation.state import EventKind
from watchsim.simulation.trajectory import Array, Trajectory, between
from watchsim.storage.columns import rows_where
from watchsim.units import metric


def doubles(values: ArrayLike) -> str:
    """Times: differences of nanoseconds must survive beside hours."""
    return _text(np.asarray(values, "<f8"))


def floats(values: ArrayLike) -> str:
    """Everything else, of which 7 digits are enough."""
    return _text(np.asarray(values, "<f4"))


def small(values: ArrayLike) -> str:
    """Codes from 0 to 255."""
    return _text(np.asarray(values, "u1"))


def _text(values: np.ndarray) -> str:
    return base64.b64encode(np.ascontiguousarray(values).tobytes()).decode("ascii")


# Parts are the very lines and arcs of the drawing, as codes and numbers for a canvas, and once more as a still picture in SVG,
# which prints, and which stands there where a mail program runs no scripts.

MOVE, LINE, ARC, CLOSE = range(4)
ROUGH = 1e-3  # of the picture: chords where only the order and the nesting of parts matter
HATCH = 0.01  # of the picture: distance of hatch strokes
MOST_STROKES = 4000  # along the longest open outline


def drawn_parts(scene: Scene, size: float) -> tuple[Part, ...]:
    """All parts of a scene, largest first; `size` (m) is that of the picture."""
    longest = max((loop.length for body in scene.bodies for loop in loops_of(body) if not loop.closed), default=0.0)
    return parts(scene, ROUGH * size, max(HATCH * size, longest / MOST_STROKES))


def packed_part(part: Part, bodies: Sequence[str]) -> dict[str, object]:
    """Codes and numbers of a part, in metres and radians in its body's frame."""
    codes, numbers = _instructions(part.outlines)
    found: dict[str, object] = {
        "body": bodies.index(part.body),
        "layer": part.layer,
        "fill": part.finish.fill,
        "edge": part.finish.edge,
        "codes": small(codes),
        "numbers": floats(numbers),
    }
    if part.finish.pale:
        found["pale"] = True
    if part.ground:
        strokes = np.zeros(0) if part.strokes is None else np.asarray(part.strokes.vertices).reshape(-1)
        found["ground"] = floats(strokes)
    return found


def _instructions(loops: Sequence[Loop]) -> tuple[list[int], list[float]]:
    """MOVE x y, LINE x y, ARC x y radius start sweep, CLOSE."""
    codes: list[int] = []
    numbers: list[float] = []
    for loop in loops:
        codes.append(MOVE)
        numbers += loop.edges[0].start
        for edge in loop.edges:
            if isinstance(edge, Arc):
                codes.append(ARC)
                numbers += (edge.x, edge.y, edge.radius, math.remainder(edge.start_angle, math.tau), edge.sweep)
            else:
                codes.append(LINE)
                numbers += edge.end
        if loop.closed:
            codes.append(CLOSE)
    return codes, numbers


def path_data(loops: Sequence[Loop]) -> str:
    """The same as SVG path data, in mm."""
    return "".join(piece for loop in loops for piece in _path(loop))


def _path(loop: Loop) -> Iterator[str]:
    yield f"M{_place(loop.edges[0].start)}"
    for edge in loop.edges:
        if not isinstance(edge, Arc):
            yield f"L{_place(edge.end)}"
            continue
        radius, turn = _number(edge.radius), int(edge.sweep > 0.0)
        # An arc is given by its ends: of a circle they are the same, and near half a turn they say little about the centre.
        pieces = math.ceil(abs(edge.sweep) / (0.75 * math.pi))
        for k in range(1, pieces + 1):
            yield f"A{radius} {radius} 0 0 {turn} {_place(edge.point(k / pieces))}"
    if loop.closed:
        yield "Z"


def _place(point: tuple[float, float]) -> str:
    return f"{_number(point[0])} {_number(point[1])}"


def _number(metres: float) -> str:
    return f"{1e3 * metres:.6f}".rstrip("0").rstrip(".")


# Each body keeps rows of its own: a locked wheel needs none while the balance swings. Between rows the page interpolates as
# `Trajectory.sample` does, by quintics through q, u and a.

FINE, COARSEST = 5e-7, 1e-3  # of the picture's size: what outlines may be off, at first, and where there is too much to keep
LEAST_ARM = 0.25  # of the picture's size
STEP = 4.0  # from one try to the next coarser one
MOST_MOTION = 360_000  # bytes of motion, before they are put into text
SLOPE, CURVE = 1e-4, 2e-3  # of their largest values: what velocities and accelerations may be off where FINE holds


class TooMuch(ValueError):
    """The window holds more motion than a page can."""


@dataclass(frozen=True)
class Channel:
    """Rows of one body: t (s), and for its coordinates q - base, u, a, (rows, 3n)."""

    body: str
    t: Array
    base: Array
    values: Array

    @property
    def bytes(self) -> int:
        return 8 * len(self.t) + 4 * self.values.size

    def packed(self) -> dict[str, object]:
        return {"t": doubles(self.t), "base": self.base.tolist(), "rows": floats(self.values)}


def channels(run: Trajectory, window: Window, size: float) -> tuple[list[Channel], float]:
    """Rows of every moving body for a window, and how far outlines are off at most (m); `size` (m) is the picture's.

    TooMuch where that would be more than a thousandth of the picture.
    """
    first = max(int(np.searchsorted(run.t, window[0], side="right")) - 1, 0)
    last = min(int(np.searchsorted(run.t, window[1], side="left")) + 1, len(run.t))
    t = run.t[first:last]
    middle = 0.5 * (t[:-1] + t[1:])
    halfway = run.sample(middle)
    kept = slice(first, last)
    bodies = [body for body in run.scene.bodies if body.name in run.slices]
    share = FINE
    while share <= COARSEST:
        found, taken = [], 0
        for body in bodies:
            found.append(_channel(run, body, kept, (middle, *halfway), size, share))
            taken += found[-1].bytes
            if taken > MOST_MOTION:
                break
        if taken <= MOST_MOTION:
            return found, share * size
        share *= STEP
    raise TooMuch(
        f"{window[0]:.9g} s to {window[1]:.9g} s hold more motion than a page can, which is {MOST_MOTION / 1e3:.0f} kB of it; "
        "choose a shorter window"
    )


def _channel(
    run: Trajectory, body: Body, kept: slice, halfway: tuple[Array, Array, Array], size: float, share: float
) -> Channel:
    """Of the rows `kept` those that one body needs, so that its outlines are off by no more than a `share` of the picture.

    `halfway`: t, q and u between all these rows; `size` (m) of the picture. Velocities are as much looser as outlines.
    """
    own, off, looser = run.slices[body.name], share * size, share / FINE
    t, q, u, a = run.t[kept], run.q[kept, own], run.u[kept, own], run.a[kept, own]
    middle, q_middle, u_middle = halfway[0], halfway[1][:, own], halfway[2][:, own]
    weight = _weights(run, body, LEAST_ARM * size)
    largest = [np.maximum(np.abs(values).max(axis=0, initial=0.0), 1e-300) for values in (u, a)]
    noise = np.zeros(q.shape[1])

    def fits(i: int, j: int) -> bool:
        h = t[j] - t[i]
        if h <= 0.0:
            return True  # rows of one instant, between which nothing of note has happened to this body
        times = np.concatenate((t[i + 1 : j], middle[i:j]))
        s = ((times - t[i]) / h)[:, None]
        place, rate = between(s, np.full_like(s, h), (q[i], u[i], a[i]), (q[j], u[j], a[j]), noise)
        if np.max(np.abs(place - np.concatenate((q[i + 1 : j], q_middle[i:j]))) @ weight) > off:
            return False
        if np.any(np.abs(rate - np.concatenate((u[i + 1 : j], u_middle[i:j]))) > looser * SLOPE * largest[0]):
            return False
        pull = a[i] + s[: j - i - 1] * (a[j] - a[i])  # as the page draws force and torque: a jump of the speed is neither
        return not np.any(np.abs(pull - a[i + 1 : j]) > looser * CURVE * largest[1])

    # Both rows of an impact that this body has felt; those of the others' are rows like any.
    felt = np.any(np.abs(np.diff(u, axis=0)) > looser * SLOPE * largest[0], axis=1)
    felt |= np.any(np.abs(np.diff(a, axis=0)) > looser * CURVE * largest[1], axis=1)
    jumps = np.flatnonzero((np.diff(t) <= 0.0) & felt)
    rows = kept_rows(len(t), fits, (*jumps.tolist(), *(jumps + 1).tolist()))
    rows = _without_repeats(rows, q, u, a)
    base = q[0] if len(q) else np.zeros(q.shape[1])
    return Channel(body.name, t[rows], base, np.hstack((q[rows] - base, u[rows], a[rows])))


def _without_repeats(kept: NDArray[np.int64], q: Array, u: Array, a: Array) -> NDArray[np.int64]:
    """Without the rows of events at which this body did not notice anything, if those around them show the same rest."""
    if len(kept) < 3:
        return kept
    values = np.hstack((q[kept], u[kept], a[kept]))
    same = np.all(values[1:] == values[:-1], axis=1) & np.all(u[kept][1:] == 0.0, axis=1) & np.all(a[kept][1:] == 0.0, axis=1)
    inner = np.concatenate(([False], same[:-1] & same[1:], [False]))
    return kept[~inner]


def _weights(run: Trajectory, body: Body, least: float) -> Array:
    """How far (m) an outline of the body, or of one that it carries, moves per unit of each coordinate.

    Angles count as if every body reached at least `least` metres: they are read as numbers, too.
    """
    if body.motion == "slide":
        return np.ones(1)
    arm = max(_reach(run, body), least)
    return np.array([arm]) if body.motion == "pivot" else np.array([1.0, 1.0, arm])


def _reach(run: Trajectory, body: Body) -> float:
    """The largest distance (m) of a point that moves with the body from its origin."""
    loops = loops_of(body)
    points = outline(loops, COARSE * size_of(body)) if loops else np.zeros((1, 2))
    carried = (one for one in run.scene.bodies if one.on == body.name)
    loads = [float(np.hypot(*one.position)) + _reach(run, one) for one in carried]
    return max(float(np.hypot(points[:, 0], points[:, 1]).max()), *loads, 0.0)


WORDS = {
    EventKind.IMPACT: "impact",
    EventKind.CLOSE: "closes",
    EventKind.OPEN: "opens",
    EventKind.STICK: "sticks",
    EventKind.SLIDE: "slides",
    EventKind.ACCUMULATION: "comes to rest after rebounds",
    EventKind.TURN: "turning point",
    EventKind.CROSS: "rest position",
    EventKind.JAM: "jams",
}
MOST_MOMENTS = 3000  # instants
NAMED = 3  # events of one instant that are put into words
FAINT = 1e-4  # of the loudest noise: cannot be heard


def instants(run: Trajectory, window: Window) -> list[list[Any]]:
    """[t (s), what happens] for every instant with events, in order; the faintest left out where there are too many."""
    start, end = window
    events = rows_where(
        run.events, lambda part: (part["t"] >= start) & (part["t"] <= end) & (part["kind"] != EventKind.HANDOVER)
    )
    times, place = np.unique(events["t"], return_inverse=True)
    if len(times) > MOST_MOMENTS:
        loud = np.zeros(len(times))
        np.maximum.at(loud, place, np.where(events["kind"] == EventKind.IMPACT, events["energy_lost"], np.inf))
        chosen = np.zeros(len(times), bool)
        chosen[np.argsort(-loud, kind="stable")[:MOST_MOMENTS]] = True
        events, times = events[chosen[place]], times[chosen]
    names, met = [body.name for body in run.scene.bodies], Met(run)
    starts = np.searchsorted(events["t"], times)
    return [
        [float(t), _words(met, events[i:j], names)]
        for t, (i, j) in zip(times, pairwise([*starts.tolist(), len(events)]), strict=True)
    ]


def _words(met: Met, events: Any, names: list[str]) -> str:
    found = list(dict.fromkeys(_one(met, event, names) for event in events))
    more = len(found) - NAMED
    return "; ".join(found[:NAMED]) + (f"; {more} more" if more > 0 else "")


def _one(met: Met, event: Any, names: list[str]) -> str:
    kind = EventKind(int(event["kind"]))
    if event["contact"] < 0:
        return f"{names[event['body']]}: {WORDS[kind]}" if event["body"] >= 0 else WORDS[kind]
    lost = f", {metric(float(event['energy_lost']), 'J', 2)} lost" if kind == EventKind.IMPACT else ""
    return f"{met.words(int(event['contact']), float(event['t']))}: {WORDS[kind]}{lost}"


def heard(run: Trajectory, window: Window) -> dict[str, str]:
    """Noises of the window: t (s) and loudness, 1 for the loudest; energies (J) go with the square of it. `note`: what an
    instrument makes of them, where it is not what the balance does."""
    times, energies = blows(run, *window)
    energies = np.maximum(energies, 0.0)
    loudest = float(energies.max(initial=0.0))
    if loudest <= 0.0:
        return {"t": doubles([]), "loud": floats([])}
    audible = energies >= FAINT * loudest
    loud = floats(np.sqrt(energies[audible] / loudest))
    return {"t": doubles(times[audible]), "loud": loud, "note": another_beat_error(run, window)}


def named(found: list[Phase], window: Window) -> list[list[Any]]:
    """[name, start, end] of the phases that reach into the window."""
    return [[phase.name, phase.start, phase.end] for phase in found if phase.end > window[0] and phase.start < window[1]]


BEATS = 10
WHOLE = 0.95  # of what was recorded: nearly all of it is shown as all of it


def shown(run: Trajectory, window: Sequence[float] | None) -> Window:
    """As asked; by default the last ten beats, or all of the last unbroken stretch where nothing keeps time.

    ValueError where the window is empty or was not recorded.
    """
    if window is not None:
        return stretch(run, window)
    start, end = recorded(run)[-1]
    hertz = frequency(run.scene) if keeps_time(run.scene) and not only_presses(run.scene) else None
    beats = 0.5 * BEATS / hertz if hertz else 0.0
    if 0.0 < beats < WHOLE * (end - start):
        start = end - beats
    return stretch(run, (start, end)) if start < end else stretch(run, None)


EVENLY = 600  # instants besides those of rows and events at which forces are asked for
MOST_TOUCHING = 6000  # instants in all
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
    crowd = sum(end - start for stretches in closed.values() for start, end in stretches) / (window[1] - window[0])
    found = None if crowd > CROWD else _forces(run, window, closed)
    names = [body.name for body in run.scene.bodies]
    listed = []
    for number, stretches in closed.items():
        # The circle of the one, and the circle or line of the other, in their bodies' frames.
        (a, b), pair = marks.sides(number), run.pairs[number]
        one: dict[str, Any] = {"a": [names.index(a.body), a.x, a.y, a.radius], "b": [names.index(b.body), b.x, b.y, b.side]}
        if b.normal is not None:
            one["normal"] = list(b.normal)
        one["name"] = f"{pair.body_a}.{pair.layer_a} / {pair.body_b}.{pair.layer_b}"
        one["closed"] = doubles(np.array(stretches).reshape(-1))
        listed.append(one if found is None else one | _samples(found, number, stretches))
    return listed


def _forces(run: Trajectory, window: Window, closed: dict[int, list[Window]]) -> Forces | None:
    """Forces at rows, right after and right before every event, and evenly between."""
    changes = np.unique([t for stretches in closed.values() for stretch in stretches for t in stretch])
    edges = np.unique(np.concatenate(([window[0]], changes[(changes > window[0]) & (changes < window[1])], [window[1]])))
    before = just_before(edges, JUST)
    rows = run.t[(run.t > window[0]) & (run.t < window[1])]
    rows = rows[:: max(1, len(rows) // (MOST_TOUCHING // 2))]
    times = np.unique(np.concatenate((edges[:-1], before, rows, np.linspace(*window, EVENLY))))
    times = times[:: max(1, len(times) // MOST_TOUCHING)]
    try:
        return forces(run, times)
    except ValueError:
        return None


def _samples(found: Forces, number: int, stretches: list[Window]) -> dict[str, str]:
    """Time, normal and tangential force (N) while the contact is closed, as few as straight lines between them allow."""
    column = np.flatnonzero(found.pairs == number)
    if len(column) == 0:
        return {}
    values = np.column_stack((found.normal[:, column[0]], found.tangential[:, column[0]]))
    held = np.isfinite(found.point[:, column[0], 0])
    rows: list[NDArray[np.int64]] = []
    for start, end in stretches:
        inside = np.flatnonzero(held & (found.t >= start) & (found.t < end))
        if len(inside):
            t, own = found.t[inside], values[inside]
            allowed = OFF * max(float(np.abs(own).max()), 1e-300)
            rows.append(inside[kept_rows(len(t), partial(_on_line, t, own, allowed))])
    if not rows:
        return {}
    kept = np.concatenate(rows)
    return {"t": doubles(found.t[kept]), "force": floats(values[kept])}


def _on_line(t: Array, values: Array, allowed: float, i: int, j: int) -> bool:
    return bool(np.all(off_line(t, values, i, j) <= allowed))


WIDE, HIGH = 1280.0, 720.0  # of the picture by which up and the part to follow are chosen


def picture_size(run: Trajectory, window: Window) -> float:
    """The width (m) of what is in sight."""
    return WIDE / view(run, window, Frame(0.0, 0.0, WIDE, HIGH), None, None).scale


def player_data(
    run: Trajectory, window: Window, moved: list[Channel], parts: tuple[Part, ...], phases: list[Phase], opening: float
) -> dict[str, Any]:
    """Everything that is drawn, played, plotted and heard; lengths in metres, angles in radians, times in seconds."""
    scene = run.scene
    names = [body.name for body in scene.bodies]
    rows = {channel.body: channel.packed() for channel in moved}
    found = roles(scene)
    return {
        "title": scene.title,
        "window": list(window),
        "opening": opening,
        "bodies": [_body(run, window, body, looks(scene)[body.name], rows.get(body.name)) for body in scene.bodies],
        "order": [names.index(body.name) for body in carried_last(scene.bodies)],
        "parts": [packed_part(part, names) for part in parts],
        "solids": packed_solids(scene, picture_size(run, window)),
        "coils": [_coil(spring, names) for spring in hairsprings(scene)],
        "line_springs": [_zigzag(spring, names) for spring in zigzags(scene)],
        "names": [[one.text, -1 if one.body is None else names.index(one.body), *one.point] for one in part_names(scene)],
        "view": _view(run, window),
        "contacts": touching(run, window),
        "events": instants(run, window),
        "phases": named(phases, window),
        "busy": [list(span) for span in busy(run, phases, window)],
        "sound": heard(run, window),
        "ranks": [names.index(name) for name in (found.oscillator, found.lever, found.wheel) if name is not None],
    }


def _coil(spring: Hairspring, names: list[str]) -> dict[str, Any]:
    """A hairspring, and in which colours it, its collet and its stud are drawn (on a light and on a dark background)."""
    coil = spring.coil
    return {
        "body": names.index(spring.body),
        "on": -1 if spring.on is None else names.index(spring.on),
        "rest": spring.rest,
        "inner": coil.inner,
        "outer": coil.outer,
        "turns": coil.turns,
        "stud": coil.stud,
        "width": coil.width,
        "block": STUD,
        "colours": [BLUED.line, BLUED.fill],
        "held": FIXED.fill,
    }


def _zigzag(spring: Zigzag, names: list[str]) -> dict[str, Any]:
    """A spring between points, and in which colours it is drawn (on a light and on a dark background)."""
    return {
        "bodies": [-1 if name is None else names.index(name) for name in spring.between],
        "points": [point.tolist() for point in spring.points],
        "half": spring.half,
        "shares": SHARES.tolist(),
        "sides": SIDES.tolist(),
        "colours": [BLUED.line, BLUED.fill],
    }


def _body(run: Trajectory, window: Window, body: Body, look: Finish, rows: dict[str, object] | None) -> dict[str, Any]:
    scene = run.scene
    carries = any(other.on == body.name for other in scene.bodies)
    found: dict[str, Any] = {
        "name": body.name,
        "motion": body.motion,
        "on": -1 if body.on is None else [one.name for one in scene.bodies].index(body.on),
        "at": [*body.position, body.angle],
        "axis": list(body.axis),
        "still": is_still(scene, body),
        "line": look.line,
        "fill": look.fill,
        "size": size_of(body) if loops_of(body) else 0.0,
    }
    if rows is not None:
        found["rows"] = rows
        own = sampled(run, body, window)[:, 2]
        carrier = 0.0 if body.on is None else sampled(run, scene.body(body.on), window)[:, 2]
        found["round"] = body.motion != "slide" and body.name != roles(scene).oscillator and goes_round(own - carrier)
    # Mass times acceleration is a force only where nothing else rides along.
    if body.on is None and not carries and body.motion != "fixed":
        found["inertia"] = body.inertia if body.motion == "pivot" else body.mass
    if loops_of(body) and is_round(body):
        found["spoke"] = list(spoke(body, size_of(body)))
    return found


def _view(run: Trajectory, window: Window) -> dict[str, Any]:
    """The room to be shown, and its turn; where a part is followed, its track and how much of it is in sight."""
    chosen: View = view(run, window, Frame(0.0, 0.0, WIDE, HIGH), None, None)
    points, _, traveller = room_of(run, window, None)
    free = not any(run.scene.gravity) and traveller is None
    turns = (0.0, -0.5 * np.pi) if free else (chosen.turn,)
    found: dict[str, Any] = {
        "turn": chosen.turn,
        "closer": CLOSER,
        "free": free,  # up may be chosen to fit the screen
        "boxes": [[turn, *np.concatenate(bounds(points, turn)).tolist()] for turn in turns],
    }
    close = None if traveller is not None else touching_room(run, window)
    if close is not None:
        found["close"] = [np.concatenate(bounds(close, turn)).tolist() for turn in turns]
    if chosen.follow is not None:
        found["follow"] = {
            "body": [body.name for body in run.scene.bodies].index(chosen.follow),
            "centre": list(chosen.centre),
            "track": list(chosen.track),
            "sight": HIGH / chosen.scale,
        }
    return found
