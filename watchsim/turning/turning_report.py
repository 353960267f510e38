"""What is reported about a mechanism that was turned by hand: verdict, story, clearances; as text and as JSON."""

from __future__ import annotations

import math
from typing import Any

from watchsim.turning.couples import Couple
from watchsim.turning.happenings import Happening, happenings, passings, stretches
from watchsim.turning.turn import Turn, closes

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
    widths = {name: max(len(name) + 2, 10) for name in names}
    lines = [
        f"turned by hand: {found.names[found.cycle.led]} led, "
        + ", ".join(f"{found.names[number]} pressed on" for number in found.cycle.pressed)
        + "; no forces",
        "  " + "".join(f"{f'{name} {_unit(found, name)}':>{widths[name]}}" for name in names) + "   what happens",
    ]
    for one in happenings(found):
        values = _told(found, one.row)
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


def _told(found: Turn, row: int) -> dict[str, float]:
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
        for name, value in _told(found, row).items()
    }


def _coordinates_text(found: Turn, row: int) -> str:
    values = _told(found, row)
    parts = [f"{name} {values[name]:.3f}{_unit(found, name).replace('mm', ' mm')}" for name in _moving(found)]
    return ", ".join(parts).replace("-", "−")
