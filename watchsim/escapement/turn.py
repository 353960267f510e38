"""Which bodies are led and pressed when a scene is turned by hand, and how far?

With an oscillator: it is led through one whole oscillation and the driven wheel is pressed. Without one: the driven wheel is
led by one pitch, and what springs pull is pressed (a click on its ratchet).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

import numpy as np

from watchsim.contact.symmetry import turn_symmetry
from watchsim.escapement.couples import Couple
from watchsim.escapement.measure import measure
from watchsim.escapement.turned_cycle import Cycle, assembly
from watchsim.geometry.primitives import Point
from watchsim.mechanism.compile import compile_scene
from watchsim.scene.errors import Fault, SceneError
from watchsim.scene.roles import Oscillator, drive_direction, keeps_time, oscillators
from watchsim.scene.scene import Body, Scene
from watchsim.scene.trains import goes_with
from watchsim.tolerances import CLEARANCE

SWING = math.radians(180.0)  # of a balance whose scene starts nearer to rest
BALANCE = math.radians(60.0)  # what starts further from rest swings as far as it starts, and so does an anchor
CLOSED = 1e-3  # of a pitch, or rad: a cycle that ends so close to where it began is closed


@dataclass(frozen=True)
class Turn:
    """A scene turned by hand: its cycle, and the row from which the last whole cycle counts."""

    scene: Scene
    cycle: Cycle
    teeth: int
    oscillator: str | None
    wheel: str
    first: int

    @property
    def names(self) -> tuple[str, ...]:
        return tuple(body.name for body in self.scene.bodies)

    @property
    def advanced(self) -> float:
        """Teeth by which the wheel went on over the last cycle, in the direction of its drive, or in which it was led."""
        number = self.names.index(self.wheel)
        q = self.cycle.q
        teeth = float((q[-1, number] - q[self.first, number]) / self.cycle.pitch)
        return abs(teeth) if self.oscillator is None else drive_direction(self.scene, self.wheel) * teeth


def turn(scene: Scene, swing: float | None = None) -> Turn:
    """Lead the scene through a cycle; `swing` (rad, or m) is how far the oscillator goes to either side of its rest.

    SceneError where nothing is driven, or where a part moves in a way that one coordinate does not tell.
    """
    _refuse(scene)
    oscillator = swinging(scene)
    name = None if oscillator is None else oscillator.body
    wheel = _driven(scene, name)
    names = [body.name for body in scene.bodies]
    parts = assembly(scene)
    sign, number = drive_direction(scene, wheel), names.index(wheel)
    teeth = _teeth(scene, wheel)
    pitch = math.tau / teeth
    if oscillator is None:
        cycle = _led_wheel(scene, number, sign * pitch)
        if cycle.jam is not None:  # a click holds it that way, and lets it pass the other way
            other = _led_wheel(scene, number, -sign * pitch)
            cycle = cycle if other.jam is not None else other
        return Turn(scene, cycle, teeth, None, wheel, cycle.turned[1] if len(cycle.turned) > 1 else 0)
    led = names.index(oscillator.body)
    parts.stay.update(parts.train(led))
    start = parts.q[led] - oscillator.rest
    as_started = (
        abs(start) > BALANCE or _hangs(scene, led) or (start and measure(scene, few=1, fork_too=False).swung is not None)
    )
    reach = swing if swing is not None else abs(start) if as_started else SWING
    far, near = oscillator.rest + math.copysign(reach, start or -1.0), oscillator.rest - math.copysign(reach, start or -1.0)
    cycle = Cycle(parts, led, {number: sign}, pitch)
    ends = [far] if parts.q[led] != far else []
    cycle.follow([*ends, near, far])
    first = cycle.turned[len(ends)] if len(cycle.turned) > len(ends) else 0
    return Turn(scene, cycle, teeth, oscillator.body, wheel, first)


def _led_wheel(scene: Scene, number: int, pitch: float) -> Cycle:
    """A wheel led by two pitches, the sprung bodies pressed on: the first brings the parts to where every further one does."""
    parts = assembly(scene)
    names = [body.name for body in scene.bodies]
    rests = {names.index(one.body): one.rest if one.stop is None else one.stop for one in scene.springs}
    pressed = {i: math.copysign(1.0, one.rest - parts.q[i]) for i, one in zip(rests, scene.springs, strict=True)}
    parts.stay.update(parts.train(number))
    start, cycle = parts.q[number], Cycle(parts, number, pressed, abs(pitch), rests)
    cycle.follow([start + pitch, start + 2.0 * pitch])
    return cycle


def swinging(scene: Scene) -> Oscillator | None:
    """The oscillator that an escapement keeps going; not the click that a spring presses on a ratchet."""
    found = next(iter(oscillators(scene)), None)
    return found if found is not None and (found.spring == 0.0 or keeps_time(scene)) else None


def closes(found: Turn) -> bool:
    """Does the cycle end as it began, but for whole teeth?"""
    q = found.cycle.q
    back = np.abs(q[-1] - q[found.first])
    train = goes_with(found.scene, found.wheel)
    others = [back[i] for i, body in enumerate(found.scene.bodies) if body.motion != "fixed" and body.name not in train]
    return abs(found.advanced - round(found.advanced)) < CLOSED and all(way < CLOSED for way in others)


PITCH_RESOLUTION = 1e-6  # m: edges of a rack whose lengths differ by less are alike


def _driven(scene: Scene, oscillator: str | None) -> str:
    """The wheel that is pressed: what is driven, or the first in its train that may touch something."""
    driven = next(torque.body for torque in scene.torques if torque.body != oscillator)
    touching = {side.body for contact in scene.contacts for side in contact.sides}
    return next((name for name in goes_with(scene, driven) if name in touching and scene.body(name).motion == "pivot"), driven)


def _swings_as_started(scene: Scene, led: int, start: float) -> bool:
    """A pendulum does, and an anchor on a spring: led further it would jam between the teeth."""
    if abs(start) > BALANCE or _hangs(scene, led):
        return True
    return start != 0.0 and measure(scene, few=1, fork_too=False).swung is not None


def _hangs(scene: Scene, led: int) -> bool:
    """Does it swing without a spring, as a pendulum does?"""
    return all(spring.body != scene.bodies[led].name for spring in scene.springs)


def _teeth(scene: Scene, wheel: str) -> int:
    """By how many parts of a turn the wheel's outer outlines come back onto themselves; windows between arms do not count.

    Of a wheel without outlines, the teeth of a rack that goes with it, as of a crown wheel seen from its side, in one turn.
    """
    bodies = tuple(
        replace(body, loops=tuple(loop for loop in body.loops if not loop.hole)) if body.name == wheel else body
        for body in scene.bodies
    )
    if not scene.body(wheel).loops:
        racks = {name: way for name, way in goes_with(scene, wheel).items() if scene.body(name).motion == "slide"}
        pitches = ((_rack_pitch(scene.body(name)), way) for name, way in racks.items())
        return next((max(1, round(math.tau * abs(way) / pitch)) for pitch, way in pitches if pitch > 0.0), 1)
    compiled = compile_scene(replace(scene, bodies=bodies))
    number = [body.name for body in scene.bodies].index(wheel)
    own = compiled.model.primitives[compiled.model.primitives.body == number]
    return turn_symmetry(own, 0.5 * CLEARANCE * compiled.size).fold


def _rack_pitch(body: Body) -> float:
    """How far apart (m) edges of one length and direction follow each other along a rack's axis; 0 where none come again."""
    c, s = math.cos(body.angle), math.sin(body.angle)
    along = (c * body.axis[0] + s * body.axis[1], c * body.axis[1] - s * body.axis[0])
    alike: dict[tuple[float, ...], list[float]] = {}
    for edge in (edge for loop in body.loops for edge in loop.edges):
        shape = (edge.length / PITCH_RESOLUTION, *(100.0 * way for way in edge.tangent(0.5)))
        place = edge.point(0.5)
        alike.setdefault(tuple(round(one) for one in shape), []).append(along[0] * place[0] + along[1] * place[1])
    gaps = np.diff(np.sort(max(alike.values(), key=len, default=[])))
    return float(np.median(gaps)) if len(gaps) else 0.0


def _refuse(scene: Scene) -> None:
    """SceneError with all that keeps a scene from being turned by hand."""
    faults = []
    found = swinging(scene)
    name = None if found is None else found.body
    if not any(torque.body != name for torque in scene.torques):
        faults.append(
            Fault(
                "torques",
                "nothing is driven: --turn presses a driven wheel against what holds it. Add [[torques]] on the wheel",
            )
        )
    touching = {side.body for contact in scene.contacts for side in contact.sides}
    for body in scene.bodies:
        if body.motion == "free" and body.name in touching:
            faults.append(
                Fault(
                    f"bodies.{body.name}.motion", "free: --turn leads bodies along one coordinate; give it a pivot or an axis"
                )
            )
        if body.on is not None:
            faults.append(
                Fault(f"bodies.{body.name}.on", f'"{body.on}": --turn does not know carried bodies; put them on the movement')
            )
    if faults:
        raise SceneError(faults)


# What happens in a cycle, in the order in which it does: what meets, parts, goes free, and passes by how little.

PASSING = 1.5e-4  # m: what comes closer without a touch is reported
ALIKE = 5e-7  # m: passings of the same layers that differ by less are one
FORGOTTEN = 3  # rows: a touch that comes back so soon was never lost


@dataclass(frozen=True)
class Stretch:
    """Two layers in touch from row `first` to row `last`, sliding along each other by `slid` (m)."""

    couple: int
    first: int
    last: int
    slid: float


@dataclass(frozen=True)
class Passing:
    """Two layers that came within `distance` (m) of each other at row `row` without a touch there."""

    couple: int
    row: int
    distance: float


@dataclass(frozen=True)
class Happening:
    """One line of the story: `kind` is meets, leaves, face (the touch goes over to another edge), free (the pressed body goes
    `way` without being held) or back (it stands furthest back, having recoiled by `way`)."""

    kind: str
    row: int
    couple: int | None
    way: float = 0.0
    place: Point | None = None


def stretches(found: Turn) -> list[Stretch]:
    """All touches of the last cycle."""
    cycle = found.cycle
    out: list[Stretch] = []
    for k in range(len(cycle.assembly.couples)):
        rows = [row for row in range(found.first, len(cycle.rows)) if any(touch.couple == k for touch in cycle.touches[row])]
        if not rows:
            continue
        cuts = [0, *(i for i in range(1, len(rows)) if rows[i] - rows[i - 1] > FORGOTTEN), len(rows)]
        for begin, end in pairwise(cuts):
            first, last = rows[begin], rows[end - 1]
            out.append(Stretch(k, first, last, sum(cycle.slid[row][k] for row in range(first + 1, last + 1))))
    return sorted(out, key=lambda one: (one.first, one.last))


def passings(found: Turn) -> list[Passing]:
    """Where two layers pass closely: the smallest distance of each stretch apart that neither begins nor ends there."""
    cycle = found.cycle
    out: list[Passing] = []
    distances = np.array(cycle.distances)[found.first :]
    for k in range(len(cycle.assembly.couples)):
        d = distances[:, k]
        for row in range(1, len(d) - 1):
            around = d[max(0, row - 40) : row + 41]
            closest = 2e-8 < d[row] < PASSING and d[row] == around.min() and d[row] < min(around[0], around[-1])
            if closest and not any(one.couple == k and abs(one.distance - d[row]) < ALIKE for one in out):
                out.append(Passing(k, found.first + row, float(d[row])))
    return sorted(out, key=lambda one: one.distance)


def happenings(found: Turn) -> list[Happening]:
    """The story of the last cycle."""
    cycle = found.cycle
    out: list[Happening] = []
    for one in stretches(found):
        place = {touch.couple: touch.place for touch in cycle.touches[one.first]}
        if one.first > found.first:
            out.append(Happening("meets", one.first, one.couple, 0.0, place[one.couple]))
        if one.last < len(cycle.rows) - 1:
            end = {touch.couple: touch.place for touch in cycle.touches[one.last]}
            out.append(Happening("leaves", one.last, one.couple, one.slid, end[one.couple]))
        out += _faces(found, one)
    for leap in cycle.leaps:
        if leap.row >= found.first:
            held = [
                touch
                for touch in cycle.touches[min(leap.row, len(cycle.rows) - 1)]
                if leap.body in _bodies(found, touch.couple)
            ]
            out.append(Happening("free", leap.row, held[0].couple if held else None, leap.way, held[0].place if held else None))
    out += _recoils(found)
    order = {"leaves": 0, "back": 1, "free": 2, "meets": 3, "face": 4}
    return sorted(out, key=lambda one: (one.row, order[one.kind]))


def _faces(found: Turn, one: Stretch) -> list[Happening]:
    """Where a touch goes over from one edge to another and stays there."""
    cycle = found.cycle
    out: list[Happening] = []
    seen = [
        (row, touch.faces, touch.place)
        for row in range(one.first, one.last + 1)
        for touch in cycle.touches[row]
        if touch.couple == one.couple and touch.faces != (-1, -1)
    ]
    face = seen[0][1] if seen else None
    for (row, now, place), (_, then, _), (_, later, _) in zip(seen, seen[1:], seen[2:], strict=False):
        if now != face and now == then == later:
            out.append(Happening("face", row, one.couple, 0.0, place))
            face = now
    return out


def _bodies(found: Turn, couple: int) -> tuple[int, int]:
    one = found.cycle.assembly.couples[couple]
    return one.a, one.b


def _recoils(found: Turn) -> list[Happening]:
    """Where a pressed body stands furthest back before it goes on."""
    cycle = found.cycle
    out: list[Happening] = []
    q = cycle.q
    for number, sign in cycle.pressed.items():
        way = sign * q[:, number]
        high, low = way[found.first], way[found.first]
        row_low = found.first
        for row in range(found.first, len(way)):
            if way[row] < low:
                low, row_low = way[row], row
            if way[row] > low + 1e-5 and high - low > 5e-4:
                out.append(Happening("back", row_low, None, high - low))
                high = low = way[row]
            if way[row] > high:
                high = low = way[row]
                row_low = row
    return out


# What is reported about a mechanism that was turned by hand: verdict, story, clearances; as text and as JSON.

PASSES, JAMS, RUNS_AWAY, STANDS, OPEN = "passes", "jams", "runs away", "stands", "does not close"


def verdict(found: Turn) -> tuple[str, str]:
    """One word, and the sentence that says where and why."""
    cycle = found.cycle
    here = _coordinates_text(found, len(cycle.rows) - 1)
    if cycle.jam is not None:
        x, y = (1e3 * value for value in cycle.jam.place)
        way = ", ".join(_names(found, one) for one in dict.fromkeys(cycle.jam.passed_on))
        through = f" (pushed through {way})" if way else ""
        return JAMS, f"jams at {here}: {_names(found, cycle.jam.couple)} at ({x:.4f}, {y:.4f}) mm; {cycle.jam.why}{through}"
    if cycle.runaway is not None:
        return RUNS_AWAY, f"runs away at {here}: nothing holds {found.names[cycle.runaway]} there"
    if not closes(found):
        return OPEN, f"the cycle does not close: {found.advanced:.4f} teeth on at its end, or a part did not come back"
    teeth = round(found.advanced)
    whole = "oscillation" if found.oscillator else "pitch"
    if teeth < 1:
        return STANDS, f"{found.wheel} is not let on: {teeth} teeth in a whole {whole}"
    return PASSES, f"{found.wheel} passes: {teeth} of {found.teeth} teeth in a whole {whole}"


def turn_report(found: Turn) -> dict[str, Any]:
    """The JSON object."""
    word, sentence = verdict(found)
    led = found.names[found.cycle.led]
    return {
        "verdict": word,
        "message": sentence,
        "led": led,
        "pressed": [found.names[number] for number in found.cycle.pressed],
        "teeth": found.teeth,
        "pitch_deg": 360.0 / found.teeth,
        "teeth_per_cycle": found.advanced,
        "steps": len(found.cycle.rows),
        "happenings": [_happening(found, one) for one in happenings(found)],
        "touches": [
            {
                "between": list(_pair(found, found.cycle.assembly.couples[one.couple])),
                "from": _coordinates(found, one.first),
                "to": _coordinates(found, one.last),
                "slid_um": 1e6 * one.slid,
            }
            for one in stretches(found)
        ],
        "passings": [
            {
                "between": list(_pair(found, found.cycle.assembly.couples[one.couple])),
                "distance_um": 1e6 * one.distance,
                "at": _coordinates(found, one.row),
            }
            for one in passings(found)
        ],
    }


def turn_text(found: Turn) -> str:
    """The same for people."""
    _, sentence = verdict(found)
    names = _moving(found)
    widths = {name: max(len(f"{name} {_unit(found, name)}") + 2, 10) for name in names}
    pressed = [f"{found.names[number]} pressed on" for number in found.cycle.pressed]
    lines = [
        ", ".join([f"turned by hand: {found.names[found.cycle.led]} led", *pressed]) + "; no forces",
        "  " + "".join(f"{f'{name} {_unit(found, name)}':>{widths[name]}}" for name in names) + "   what happens",
    ]
    for one in happenings(found):
        values = _values_of(found, one.row)
        lines.append("  " + "".join(f"{values[name]:>{widths[name]}.3f}" for name in names) + "   " + _words(found, one))
    near = passings(found)
    if near:
        lines.append("  passes without a touch:")
        for passing in near:
            place = _coordinates_text(found, passing.row)
            couple = found.cycle.assembly.couples[passing.couple]
            lines.append(f"    {1e6 * passing.distance:7.1f} µm  {_names(found, couple)}, {place}")
    return "\n".join([*lines, sentence])


def _words(found: Turn, one: Happening) -> str:
    pair = "" if one.couple is None else _names(found, found.cycle.assembly.couples[one.couple])
    if one.kind == "meets":
        return f"{pair} meet"
    if one.kind == "face":
        return f"{pair} go over to another face or corner"
    if one.kind == "leaves":
        return f"{pair} part, having slid {1e6 * one.way:.0f} µm along each other"
    pressed = " and ".join(found.names[number] for number in found.cycle.pressed)
    if one.kind == "back":
        return f"{pressed} furthest back, by {math.degrees(one.way):.3f}°"
    return f"{pressed} free for {math.degrees(one.way):.3f}°" + (f", until {pair} meet" if pair else "")


def _happening(found: Turn, one: Happening) -> dict[str, Any]:
    pair = None if one.couple is None else list(_pair(found, found.cycle.assembly.couples[one.couple]))
    way = {"leaves": {"slid_um": 1e6 * one.way}, "meets": {}, "face": {}}.get(one.kind, {"way_deg": math.degrees(one.way)})
    place = None if one.place is None else [1e3 * one.place[0], 1e3 * one.place[1]]
    return {"kind": one.kind, "between": pair, **_coordinates(found, one.row), **way, "place_mm": place}


def _pair(found: Turn, couple: Couple) -> tuple[str, str]:
    return f"{found.names[couple.a]}.{couple.layers[0]}", f"{found.names[couple.b]}.{couple.layers[1]}"


def _names(found: Turn, couple: Couple) -> str:
    return " and ".join(_pair(found, couple))


def _moving(found: Turn) -> list[str]:
    """The led body first, the pressed ones last."""
    numbers = [i for i, body in enumerate(found.scene.bodies) if body.motion != "fixed"]
    rank = {found.cycle.led: 0, **dict.fromkeys(found.cycle.pressed, 2)}
    return [found.names[i] for i in sorted(numbers, key=lambda i: rank.get(i, 1))]


def _unit(found: Turn, name: str) -> str:
    return "mm" if found.scene.body(name).motion == "slide" else "°"


def _values_of(found: Turn, row: int) -> dict[str, float]:
    """Coordinates in degrees or millimetres."""
    q = found.cycle.rows[min(row, len(found.cycle.rows) - 1)]
    return {
        name: 1e3 * q[i] if found.scene.body(name).motion == "slide" else math.degrees(q[i])
        for i, name in enumerate(found.names)
        if found.scene.body(name).motion != "fixed"
    }


def _coordinates(found: Turn, row: int) -> dict[str, float]:
    return {
        f"{name}_{'travel_mm' if found.scene.body(name).motion == 'slide' else 'angle_deg'}": value
        for name, value in _values_of(found, row).items()
    }


def _coordinates_text(found: Turn, row: int) -> str:
    values = _values_of(found, row)
    parts = [f"{name} {values[name]:.3f}{_unit(found, name).replace('mm', ' mm')}" for name in _moving(found)]
    return ", ".join(parts).replace("-", "−")
