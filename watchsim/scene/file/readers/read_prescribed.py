"""How is the motion of a driven body read?"""

from __future__ import annotations

import math
from dataclasses import dataclass

from watchsim.scene.file.keys.key_values import NAN, Table
from watchsim.scene.file.keys.schema import SWING
from watchsim.scene.prescribed import Prescribed, path, swing
from watchsim.units import ANGLE, LENGTH, TIME

DRIVEN = "driven"
LAWS = ("velocity", "swing", "path")
MOST_POINTS = 2000


@dataclass(frozen=True, slots=True)
class Read:
    """The law, and the velocity (rad/s or m/s) with which it starts."""

    law: Prescribed
    velocity: float


def read_prescribed(table: Table, start: float) -> Read | None:
    """The law of one body that starts at coordinate `start` (rad, or 0 m); None where nothing is prescribed."""
    if table.mapping.get("motion") != DRIVEN:
        for key in ("swing", "path"):
            if key in table:
                table.fault(key, f'belongs to motion = "{DRIVEN}"')
        return None
    given = [key for key in LAWS if key in table]
    if len(given) != 1:
        table.fault(
            given[1] if given else "",
            'a driven body needs one law: velocity = "60 rpm", swing = { amplitude = "10°", frequency = "2 Hz" } '
            'or path = [["0.1 s", "36°"], ["0.2 s", "36°"]]',
        )
    if "on" in table:
        table.fault("on", "a driven body cannot be carried: its motion is prescribed in the movement")
    if "swing" in table:
        return _swing(table, start)
    return _path(table) if "path" in table else Read(Prescribed(), table.quantity("velocity"))


def _swing(table: Table, start: float) -> Read:
    inner = Table(table.mapping["swing"], f"{table.path}.swing", SWING, table.faults, table.motion)
    first = "1 mm" if table.motion == "slide" else "10°"
    amplitude, phase = inner.quantity("amplitude", NAN), inner.quantity("phase")
    inner.lacks(("amplitude", "frequency"), f'swing = {{ amplitude = "{first}", frequency = "2 Hz" }}')
    frequency = inner.positive("frequency", "it says how often the body swings") if "frequency" in inner else NAN
    if not math.isfinite(amplitude + phase + frequency):
        return Read(Prescribed(), 0.0)
    law, _, velocity = swing(start - amplitude * math.sin(phase), amplitude, frequency, phase)
    return Read(law, velocity)


def _path(table: Table) -> Read:
    """Points of time and travel since the start, which is the point (0, 0)."""
    points = table.mapping["path"]
    if not isinstance(points, list) or not 1 <= len(points) <= MOST_POINTS:
        table.fault("path", f'a list of 1 to {MOST_POINTS} points is needed: path = [["0.1 s", "36°"], ["0.2 s", "36°"]]', True)
        return Read(Prescribed(), 0.0)
    way = LENGTH if table.motion == "slide" else ANGLE
    found = [(0.0, 0.0)]
    for i, point in enumerate(points):
        if not isinstance(point, list) or len(point) != 2:
            table.fault(f"path.{i}", 'a time and how far the body has gone by then: ["0.1 s", "36°"]')
            continue
        t, q = table.parsed(f"path.{i}.0", point[0], TIME), table.parsed(f"path.{i}.1", point[1], way)
        if t <= found[-1][0]:
            table.fault(f"path.{i}.0", "times must be above zero and increase")
        elif math.isfinite(t + q):
            found.append((t, q))
    if len(found) <= len(points):
        return Read(Prescribed(), 0.0)
    return Read(path(found), 0.0)
