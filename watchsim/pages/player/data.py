"""What does the player of a page need to know of a run?"""

from __future__ import annotations

from typing import Any

import numpy as np

from watchsim.analysis.timing.phases import Phase
from watchsim.pages.player.canvas_outlines import packed_part
from watchsim.pages.player.motion import Channel
from watchsim.pages.player.player_moments import heard, instants, named
from watchsim.pages.player.touching import touching
from watchsim.render.frame.coils import STUD, Hairspring, hairsprings
from watchsim.render.frame.filled_parts import Part, is_round, loops_of
from watchsim.render.frame.line_spring_shapes import SHARES, SIDES, Zigzag, zigzags
from watchsim.render.frame.marks.readouts import goes_round
from watchsim.render.frame.pose_history import Window, sampled
from watchsim.render.frame.view import Frame, View, room_of, size_of, view
from watchsim.render.movies.busy_stretches import busy
from watchsim.render.palette import BLUED, FIXED, Finish, looks
from watchsim.scene.body import Body
from watchsim.scene.carriers import carried_last, is_still
from watchsim.scene.roles import roles
from watchsim.simulation.record.trajectory import Array, Trajectory

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
        "coils": [_coil(spring, names) for spring in hairsprings(scene)],
        "line_springs": [_zigzag(spring, names) for spring in zigzags(scene)],
        "view": _view(run, window),
        "contacts": touching(run, window),
        "events": instants(run, window),
        "phases": named(phases, window),
        "busy": [list(span) for span in busy(run, phases, window)],
        "sound": heard(run, window),
        "ranks": [names.index(name) for name in (found.oscillator, found.lever, found.wheel) if name is not None],
    }


def _coil(spring: Hairspring, names: list[str]) -> dict[str, Any]:
    """A hairspring, and in which colours it, its collet and its stud are drawn (on light and on dark ground)."""
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
    """A spring between points, and in which colours it is drawn (on light and on dark ground)."""
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
    told: dict[str, Any] = {
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
        told["rows"] = rows
        own = sampled(run, body, window)[:, 2]
        carrier = 0.0 if body.on is None else sampled(run, scene.body(body.on), window)[:, 2]
        told["round"] = body.motion != "slide" and body.name != roles(scene).oscillator and goes_round(own - carrier)
    # Mass times acceleration is a force only where nothing else rides along.
    if body.on is None and not carries and body.motion != "fixed":
        told["inertia"] = body.inertia if body.motion == "pivot" else body.mass
    if loops_of(body) and is_round(body):
        told["spoke"] = _spoke(body)
    return told


def _spoke(body: Body) -> list[float]:
    """From where to where along its x axis a radius is drawn on a body whose turning could not be seen."""
    radii = [edge.radius for loop in loops_of(body) if loop.hole for edge in loop.edges if hasattr(edge, "radius")]
    bore, reach = max(radii, default=0.0), 0.5 * size_of(body)
    return [bore, bore + 0.9 * (reach - bore)]


def _view(run: Trajectory, window: Window) -> dict[str, Any]:
    """The room to be shown, and its turn; where a part is followed, its track and how much of it is in sight."""
    chosen: View = view(run, window, Frame(0.0, 0.0, WIDE, HIGH), None, None)
    points, _, traveller = room_of(run, window, None)
    free = not any(run.scene.gravity) and traveller is None
    told: dict[str, Any] = {
        "turn": chosen.turn,
        "free": free,  # up may be chosen to fit the screen
        "boxes": [[turn, *_box(points, turn)] for turn in ((0.0, -0.5 * np.pi) if free else (chosen.turn,))],
    }
    if chosen.follow is not None:
        told["follow"] = {
            "body": [body.name for body in run.scene.bodies].index(chosen.follow),
            "centre": list(chosen.centre),
            "track": list(chosen.track),
            "sight": HIGH / chosen.scale,
        }
    return told


def _box(points: Array, turn: float) -> list[float]:
    """Least and largest x and y (m) of the points as the turned picture shows them."""
    c, s = float(np.cos(turn)), float(np.sin(turn))
    seen = points @ np.array([[c, s], [-s, c]])
    return [*seen.min(axis=0).tolist(), *seen.max(axis=0).tolist()]
